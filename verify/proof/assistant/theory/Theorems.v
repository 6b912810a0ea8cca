(** What the theory proves, in one place. Each theorem stands here as a whole: with what it speaks
    of, for all eta and all n at once. At the end stand the controls: that the theorems speak of
    something, and that what they ask for is needed.

    K is any ring that holds the rational numbers, with derivations by the coordinates that commute
    (Rings.v); the smooth functions on an open set are one ([smooth_functions_are_a_ring]). A system s
    has n degrees of freedom, coordinates p, q and t, and a Hamiltonian H(p, q, t), an element of K
    (Flow.v).
    D = d/dt + X is the derivation along the flow. *)

From Coq Require Import Reals QArith List.
From AreaPreservation Require Import Sums Orders Differential Symplectic Stages Shears Hamiltonians RungeKutta SymplecticMethods StageSchemes ImplicitSolutions Product Rings Totals Flow Taylor Bracket LieScheme Step Plane Determinants Values Volume Determinant Smooth Systems Solutions Oscillator.
Import ListNotations.
Local Open Scope nat_scope.

(** ** The scheme lie_eta: z' = sum of h^k/k! D^k z up to k = eta

    S = J^T Omega J - Omega is h^(eta+1) [leading] and terms of higher order, where [leading] is
    - sum_i (d(D^(eta+1) p_i) /\ dq_i + dp_i /\ d(D^(eta+1) q_i)) / (eta+1)!. *)
Theorem defect_of_lie : forall (K : differential_ring) (s : system K) (eta : nat) (h : K) (a b : nat),
  is_constant K h -> (a < 2 * degrees s)%nat -> (b < 2 * degrees s)%nat ->
  same (step_defect K s eta h a b)
    (add (mul (power K h (S eta)) (leading K s eta a b))
         (mul (power K h (S (S eta))) (rest K s eta h a b))).
Proof. exact defect_of_step. Qed.

(** The coefficients of h^1 .. h^eta in det J vanish, and the next is - div(D^eta f)/(eta+1)!, in any
    number of degrees of freedom: these are the coefficients of det J as a polynomial in h. *)
Theorem determinant_of_lie : forall (K : differential_ring) (s : system K) (eta : nat),
  same (volume K s eta 0) one /\
  (forall m, (S m <= eta)%nat -> same (volume K s eta (S m)) zero) /\
  same (volume K s eta (S eta)) (first_coefficient K s eta) /\
  exists m, ends K (volume K s eta) m /\ forall h, is_constant K h ->
    same (Determinants.determinant (2 * degrees s) (jacobian K s eta h))
      (add (add one (mul (power K h (S eta)) (first_coefficient K s eta)))
           (mul (power K h (S (S eta)))
             (partial_sum K h (fun k => volume K s eta (S (S eta) + k)) m))).
Proof.
  intros K s eta. split; [apply volume_at_0|]. split; [apply volume_below|].
  split; [apply volume_first|apply determinant_of_jacobian].
Qed.

(** In the plane. *)
Theorem determinant_of_lie_in_plane :
  forall (K : differential_ring) (s : system K), degrees s = 1%nat -> forall (eta : nat) (h : K),
  is_constant K h ->
  same (Plane.determinant K s eta h)
    (add (add one (mul (power K h (S eta)) (first_of_determinant K s eta)))
         (mul (power K h (S (S eta))) (rest K s eta h 0 1))).
Proof. exact determinant_of_step. Qed.

(** ** Telescoping: for even eta the leading 2-form is the Lie derivative of one in closed form,
    - 1/(eta+1)! sum_k (-1)^k sum_i d(D^(eta-k) p_i) /\ d(D^k q_i); in the plane it is D G. *)
Theorem lie_telescopes_for_even : forall (K : differential_ring) (s : system K) (eta : nat),
  Nat.Even eta -> forall a b, (a < 2 * degrees s)%nat -> (b < 2 * degrees s)%nat ->
  same (lie_derivative K s (potential K s eta) a b) (leading K s eta a b).
Proof. exact even_telescopes. Qed.

Theorem lie_telescopes_in_plane_for_even :
  forall (K : differential_ring) (s : system K), degrees s = 1%nat -> forall eta : nat,
  Nat.Even eta -> same (along_flow K s (G K s eta)) (first_of_determinant K s eta).
Proof. exact telescopes_for_even. Qed.

(** For every odd eta there is an H for which it does not: no smooth G has X G = that coefficient. *)
Theorem lie_does_not_telescope_for_odd : forall eta : nat, Nat.Odd eta ->
  ~ exists g, same (along_field _ oscillator g) (first_of_determinant _ oscillator eta).
Proof. exact odd_does_not_telescope. Qed.

(** ** Methods that are symplectic, for every H that is twice differentiable where it is looked at *)

Local Open Scope R_scope.

(** Compositions of kicks and drifts. *)
Theorem shears_are_symplectic : forall n h l x, shears_of_hamiltonian n h l x ->
  symplectic_at n (steps_of (map (shear_map n h) l)) x.
Proof. exact shears_symplectic. Qed.

(** The implicit midpoint rule. *)
Theorem midpoint_is_symplectic : forall n h (H : point -> R) (H1 F : nat -> point -> R) x,
  let middle := fun y c => (y c + F c y) / 2 in
  near (2 * n) x (fun y => forall c, (c < 2 * n)%nat ->
    F c y = y c + h * turned n (fun l => H1 l (middle y)) c) ->
  (forall c, (c < 2 * n)%nat -> exists g, has_slopes (2 * n) (F c) x g) ->
  twice_differentiable (2 * n) H H1 (middle x) -> symplectic_at n F x.
Proof. exact midpoint_of_hamiltonian. Qed.

(** Runge-Kutta methods with b_i a_ij + b_j a_ji - b_i b_j = 0. *)
Theorem runge_kutta_is_symplectic : forall n m h A b (H : nat -> point -> R)
    (H1 : nat -> nat -> point -> R) (Z : nat -> point -> point) (F : nat -> point -> R) (x : point),
  near (2 * n) x (solves_method n m h A b H1 Z F) ->
  (forall i c, (i < m)%nat -> (c < 2 * n)%nat ->
     exists g, has_slopes (2 * n) (fun y => Z i y c) x g) ->
  (forall i, (i < m)%nat -> twice_differentiable (2 * n) (H i) (H1 i) (Z i x)) ->
  symplectic_weights m A b -> symplectic_at n F x.
Proof. exact method_of_hamiltonian. Qed.

(** In the plane a symplectic map has det J = 1. *)
Theorem symplectic_is_area_preserving : forall F x J, symplectic_at 1 F x ->
  (forall i, (i < 2)%nat -> has_slopes 2 (F i) x (J i)) ->
  J 0%nat 0%nat * J 1%nat 1%nat - J 0%nat 1%nat * J 1%nat 0%nat = 1.
Proof. exact determinant_one. Qed.

(** ** Over many steps: |det J_k - 1| <= eps for N steps gives |product - 1| <= exp(N eps) - 1. *)
Theorem error_over_many_steps : forall N d eps, 0 <= eps ->
  (forall k, (k < N)%nat -> Rabs (d k - 1) <= eps) ->
  Rabs (product N d - 1) <= exp (INR N * eps) - 1.
Proof. exact product_near_one_by_exp. Qed.

(** ** The map and the flow: what every solution of Hamilton's equations has in common with it. *)
Theorem flow_has_taylor_series : forall n U (HU : is_open (2 * n + 1) U) H w r c m,
  0 < r -> solves n U H w r -> (c < 2 * n)%nat ->
  exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 ->
    Rabs (w c h - sum (S m) (fun k =>
      value (flow_series _ (smooth_system n U HU H) k c) (fun j => w j 0) * h ^ k))
    <= C * Rabs h ^ (S m).
Proof. exact taylor_remainder. Qed.

(** ** Controls *)

(** The smooth functions on an open set U are such a ring, in which to be the same is to have the same
    values on U, and the derivations are the derivatives; it is not trivial where U has a point. *)
Definition smooth_functions_are_a_ring : forall N (U : point -> Prop), is_open N U ->
  differential_ring := smooth_ring.

Theorem smooth_functions_are_as_they_should : forall N U (HU : is_open N U),
  let K := smooth_functions_are_a_ring N U HU in
  (forall f g : K, same f g <-> forall x, U x -> value f x = value g x) /\
  (forall (f : K) x i, U x -> (i < N)%nat -> derivable_pt_lim (fun s => value f (moved x i s)) (x i)
     (value (by_coordinate i f) x)) /\
  ((exists x, U x) -> ~ same (@zero K) (@one K)).
Proof.
  intros N U HU K. split; [|split].
  - intros f g. reflexivity.
  - exact (derivation_is_slope N U HU).
  - intros [x Ux]. exact (smooth_ring_not_trivial N U HU x Ux).
Qed.

(** Any smooth function of p, q and t is an H of such a system. *)
Theorem smooth_functions_are_hamiltonians : forall n U (HU : is_open (2 * n + 1) U)
    (H : smooth (2 * n + 1) U), exists s : system (smooth_functions_are_a_ring (2 * n + 1) U HU),
  degrees s = n /\ hamiltonian s = H /\
  forall c x, (c < 2 * n + 1)%nat -> value (coordinate s c) x = x c.
Proof.
  intros n U HU H. exists (smooth_system n U HU H). split; [reflexivity|split; [reflexivity|]].
  intros c x. apply value_coordinate.
Qed.

(** What is a h^r + O(h^(r+1)), a not 0, is of no higher order: of det J - 1 = L h^r + O(h^(r+1)) where
    L is not 0. *)
Theorem orders_are_exact : forall r a C, a <> 0 -> exists h0 c, 0 < h0 /\ 0 < c /\
  forall h x, Rabs h <= h0 -> Rabs (x - a * h ^ r) <= C * Rabs h ^ (S r) -> c * Rabs h ^ r <= Rabs x.
Proof. exact order_is_exact. Qed.

(** The leading coefficient of lie_eta on the oscillator: not 0 for odd eta, and 0 for even eta. *)
Theorem leading_on_the_oscillator : forall eta x,
  (Nat.Odd eta -> value (first_of_determinant _ oscillator eta) x <> 0) /\
  (Nat.Even eta -> value (first_of_determinant _ oscillator eta) x = 0).
Proof.
  intros eta x. split; [apply oscillator_first_not_zero|apply oscillator_first_for_even].
Qed.

(** The solutions that [flow_has_taylor_series] speaks of exist: p = cos t, q = sin t is one. *)
Theorem oscillator_has_solutions : forall r, solves 1 everywhere oscillator_energy
  (fun j => match j with O => cos | S O => sin | _ => id end) r.
Proof. exact oscillation_solves. Qed.

(** The equations of implicit methods have solutions that are smooth, at every h: of stages... *)
Theorem stages_have_solutions : forall h t x,
  solves_scheme 1 h t (fun _ => harmonic) (fun _ => harmonic_slopes)
    [midpoint] [midpoint_map h] x.
Proof. exact midpoint_has_solutions. Qed.

(** ... and of a Runge-Kutta method of two stages, with weights that fit. *)
Theorem runge_kutta_has_solutions : forall h x, exists A b Z F, symplectic_weights 2 A b /\
  near 2 x (solves_method 1 2 h A b (fun _ => harmonic_slopes) Z F) /\
  (forall i c, (i < 2)%nat -> (c < 2)%nat -> exists g, has_slopes 2 (fun y => Z i y c) x g) /\
  (forall i, (i < 2)%nat ->
    twice_differentiable 2 harmonic harmonic_slopes (Z i x)).
Proof.
  intros h x. exists (gauss_entry (sqrt 3)), gauss_weight, (gauss_stage (sqrt 3) h), (gauss_map h).
  split; [apply gauss_is_symplectic|].
  apply gauss_has_solutions, sqrt_sqrt. apply IZR_le. discriminate.
Qed.

(** Where the weights do not fit the method is not symplectic: explicit Euler; a stage is so exactly
    where k d (1 - s - u) = 0; a kick by what is no gradient is so for h = 0 alone. *)
Theorem euler_is_not_symplectic : forall h x, h <> 0 -> ~ symplectic_at 1 (linear (euler h)) x.
Proof. exact euler_not_symplectic. Qed.

Theorem stages_are_symplectic_exactly : forall h k d s u x,
  1 + s * u * (h * h * k * d) <> 0 -> h <> 0 ->
  symplectic_at 1 (linear (oscillator_stage h k d s u)) x <-> k * d * (1 - s - u) = 0.
Proof. exact condition_on_weights_exact. Qed.

Theorem kick_by_no_gradient_is_not_symplectic : forall h x,
  symplectic_at 2 (kick 2 h 1 (fun j z => match j with 2%nat => z 3%nat | _ => 0 end)) x -> h = 0.
Proof. exact kick_without_gradient. Qed.

(** The bound of a product is attained. *)
Theorem product_bound_is_attained : forall N eps, 0 <= eps ->
  Rabs (product N (fun _ => 1 + eps) - 1) = (1 + eps) ^ N - 1.
Proof. exact bound_attained. Qed.
