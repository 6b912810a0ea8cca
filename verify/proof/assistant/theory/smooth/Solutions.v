(** The Taylor coefficients of every solution of Hamilton's equations: those of the flow's own
    series in Taylor.v.

    A curve is its coordinates as functions of a real number s: p, then q, then the time. *)

From Coq Require Import Reals Lra Lia PeanoNat Qreals.
From AreaPreservation Require Import Sums Differential Rings Flow Taylor LieScheme Smooth Systems.
Local Open Scope R_scope.

(** For |s| < r the curve [w] is in [U] and p' = - H_q, q' = H_p, t' = 1. *)
Definition solves (n : nat) (U : point -> Prop) (H : smooth (2 * n + 1) U)
    (w : nat -> R -> R) (r : R) : Prop :=
  forall s, Rabs s < r -> U (fun j => w j s) /\
    (forall i, (i < n)%nat ->
      derivable_pt_lim (w i) s (- value (smooth_derivative (n + i) H) (fun j => w j s)) /\
      derivable_pt_lim (w (n + i)%nat) s (value (smooth_derivative i H) (fun j => w j s))) /\
    derivable_pt_lim (w (2 * n)%nat) s 1.

(** A sum over p, q and t. *)
Lemma sum_over_coordinates : forall n f,
  sum (2 * n + 1) f = f (2 * n)%nat + sum n (fun i => f i + f (n + i)%nat).
Proof.
  intros n f. replace (2 * n + 1)%nat with (S (n + n)) by lia.
  change (sum (S (n + n)) f) with (sum (n + n) f + f (n + n)%nat).
  rewrite sum_in_two_parts, sum_of_sum. replace (n + n)%nat with (2 * n)%nat by lia. ring.
Qed.

(** A function f(p, q, t) changes along a solution at the rate D f = f_t + H_p f_q - H_q f_p. *)
Theorem rate_along_solution : forall n U (HU : is_open (2 * n + 1) U) H w r (f : smooth _ U) s,
  solves n U H w r -> Rabs s < r ->
  derivable_pt_lim (fun t => value f (fun j => w j t)) s
    (value (along_flow _ (smooth_system n U HU H) f) (fun j => w j s)).
Proof.
  intros n U HU H w r f s W L. destruct (W s L) as (inside & motion & clock).
  set (x := fun j => w j s) in *.
  set (v := fun j => if Nat.ltb j n then - value (smooth_derivative (n + j) H) x
    else if Nat.ltb j (2 * n) then value (smooth_derivative (j - n) H) x else 1).
  assert (V : forall j, (j < 2 * n + 1)%nat -> derivable_pt_lim (w j) s (v j)).
  { intros j J. unfold v. destruct (Nat.ltb_spec j n) as [ A | A ]; [ apply motion, A | ].
    destruct (Nat.ltb_spec j (2 * n)) as [ B | B ].
    - destruct (motion (j - n)%nat) as [ _ Q ]; [ lia | ].
      replace (n + (j - n))%nat with j in Q by lia. exact Q.
    - replace j with (2 * n)%nat by lia. exact clock. }
  pose proof (derivative_along_curve _ (value f) w s _ v
    (derivation_has_slopes _ U HU f x inside) V) as D.
  assert (E : sum (2 * n + 1)
      (fun j => value (@by_coordinate (smooth_ring _ U HU) j f) x * v j)
    = value (along_flow _ (smooth_system n U HU H) f) x); [ | rewrite <- E; exact D ].
  etransitivity; [ | symmetry; apply value_along_flow ].
  rewrite sum_over_coordinates. unfold v at 1.
  rewrite (proj2 (Nat.ltb_ge _ _)), (proj2 (Nat.ltb_ge _ _)), Rmult_1_r by lia. f_equal.
  apply sum_of_equals. intros i I. unfold v.
  rewrite (proj2 (Nat.ltb_lt i n) I), (proj2 (Nat.ltb_ge (n + i) n)) by lia.
  rewrite (proj2 (Nat.ltb_lt (n + i) (2 * n))) by lia.
  replace (n + i - n)%nat with i by lia.
  change (@by_coordinate (smooth_ring _ U HU)) with (@smooth_derivative (2 * n + 1) U). ring.
Qed.

(** * Taylor coefficients *)

Lemma value_inverse_factorial : forall N U (HU : is_open N U) k x,
  value (inverse_factorial (smooth_ring N U HU) k) x = / INR (fact k).
Proof.
  intros N U HU k x. unfold inverse_factorial. rewrite value_rational. unfold Q2R. cbn [Qnum Qden].
  change (IZR (Zpos (Pos.of_nat (fact k)))) with (IPR (Pos.of_nat (fact k))).
  rewrite <- INR_IPR, Nat2Pos.id by apply fact_neq_0. ring.
Qed.

(** k! times the coefficient D^k f / k! is D^k f. *)
Lemma value_iterated : forall n U (HU : is_open (2 * n + 1) U) H k (f : smooth _ U) x, U x ->
  value (iterated _ (smooth_system n U HU H) k f) x
  = INR (fact k) * value (coefficient _ (smooth_system n U HU H) k f) x.
Proof.
  intros n U HU H k f x inside. pose proof (INR_fact_neq_0 k) as nonzero.
  rewrite (coefficient_is _ (smooth_system n U HU H) k f x inside).
  rewrite (value_mul _ U HU), value_inverse_factorial. field. exact nonzero.
Qed.

(** Along a solution the k-th derivative of f(p, q, t) is D^k f. *)
Theorem derivatives_along_solution : forall n U (HU : is_open (2 * n + 1) U) H w r
    (f : smooth _ U) k s, solves n U H w r -> Rabs s < r ->
  derivable_pt_lim
    (fun t => value (iterated _ (smooth_system n U HU H) k f) (fun j => w j t)) s
    (value (iterated _ (smooth_system n U HU H) (S k) f) (fun j => w j s)).
Proof. intros. apply (rate_along_solution n U HU H w r); assumption. Qed.

(** The k-th derivative of the coordinate c at s = 0 is k! times the flow's coefficient. *)
Theorem solution_has_coefficients : forall n U (HU : is_open (2 * n + 1) U) H w r c,
  0 < r -> solves n U H w r -> (c < 2 * n)%nat ->
  exists X : nat -> R -> R,
    (forall s, Rabs s < r -> X 0%nat s = w c s) /\
    (forall k s, Rabs s < r -> derivable_pt_lim (X k) s (X (S k) s)) /\
    (forall k, X k 0 = INR (fact k)
      * value (flow_series _ (smooth_system n U HU H) k c) (fun j => w j 0)).
Proof.
  intros n U HU H w r c r_positive W C.
  exists (fun k s => value (iterated _ (smooth_system n U HU H) k (smooth_coordinate c))
    (fun j => w j s)).
  split; [ | split ].
  - intros s _. apply value_coordinate. lia.
  - intros k s L. apply (derivatives_along_solution n U HU H w r _ k s W L).
  - intros k. apply value_iterated. apply (W 0). rewrite Rabs_R0. exact r_positive.
Qed.

(** * The remainder *)

(** A function is bounded near a place where it has a derivative. *)
Lemma bounded_near : forall f l, derivable_pt_lim f 0 l ->
  exists B d, 0 <= B /\ 0 < d /\ forall h, Rabs h <= d -> Rabs (f h) <= B.
Proof.
  intros f l D. destruct (change_bounded 1 _ (fun _ => 0) _ (slopes_of_derivative f _ l D))
    as (d & d_positive & B).
  assert (bound : forall h, Rabs h <= d / 2 -> Rabs (f h) <= Rabs (f 0) + (1 + Rabs l) * d).
  { intros h L. specialize (B (fun _ => h)). unfold distance in B. simpl in B.
    rewrite Rminus_0_r in B. specialize (B ltac:(lra)). pose proof (Rabs_pos l) as P.
    replace (f h) with (f 0 + (f h - f 0)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat_l.
    apply Rle_trans with (1 := B). apply Rmult_le_compat; pose proof (Rabs_pos h); lra. }
  exists (Rabs (f 0) + (1 + Rabs l) * d), (d / 2). split; [ | split; [ lra | exact bound ] ].
  apply Rle_trans with (2 := bound 0 ltac:(rewrite Rabs_R0; lra)). apply Rabs_pos.
Qed.

(** By the mean value theorem, a slope of the size of h^n makes a change of the size of h^(n+1). *)
Lemma size_by_slope : forall f f' C n d, f 0 = 0 -> 0 <= C ->
  (forall h, Rabs h <= d -> derivable_pt_lim f h (f' h)) ->
  (forall h, Rabs h <= d -> Rabs (f' h) <= C * Rabs h ^ n) ->
  forall h, Rabs h <= d -> Rabs (f h) <= C * Rabs h ^ (S n).
Proof.
  intros f f' C n d Z C_nonnegative D B h L.
  assert (middle : exists c, Rabs c <= Rabs h /\ f h = f' c * h).
  { destruct (Rtotal_order h 0) as [ N | [ E | P ] ].
    - rewrite (Rabs_left h) in * by exact N.
      destruct (MVT_cor2 f f' h 0 N) as (c & E & I).
      + intros c I. apply D. rewrite Rabs_left1; lra.
      + exists c. rewrite (Rabs_left1 c) by lra. lra.
    - exists 0. rewrite E, Z, Rabs_R0. lra.
    - rewrite (Rabs_right h) in * by lra.
      destruct (MVT_cor2 f f' 0 h P) as (c & E & I).
      + intros c I. apply D. rewrite Rabs_right; lra.
      + exists c. rewrite (Rabs_right c) by lra. lra. }
  destruct middle as (c & I & ->). specialize (B c ltac:(lra)). rewrite Rabs_mult.
  replace (C * Rabs h ^ S n) with (C * Rabs h ^ n * Rabs h) by (simpl; ring).
  apply Rmult_le_compat_r; [ apply Rabs_pos | ]. apply Rle_trans with (1 := B).
  apply Rmult_le_compat_l; [ exact C_nonnegative | ].
  apply pow_incr. split; [ apply Rabs_pos | exact I ].
Qed.

Lemma derivative_of_polynomial : forall n c s,
  derivable_pt_lim (fun s => sum (S n) (fun k => c k * s ^ k)) s
    (sum n (fun k => INR (S k) * c (S k) * s ^ k)).
Proof.
  intros n c s. induction n as [ | n IH ].
  - apply derivable_pt_lim_ext with (fun _ => c 0%nat); [ intros; simpl; ring | ].
    apply derivable_pt_lim_const.
  - apply (derivable_pt_lim_plus (fun s => sum (S n) (fun k => c k * s ^ k)) _ s _ _ IH).
    replace (INR (S n) * c (S n) * s ^ n) with (c (S n) * (INR (S n) * s ^ pred (S n)))
      by (simpl pred; ring).
    apply (derivable_pt_lim_scal (fun s => s ^ S n)). apply derivable_pt_lim_pow.
Qed.

(** Taylor's theorem at 0, for functions each of which is the derivative of the one before. *)
Theorem taylor : forall n r (X : nat -> R -> R) c, 0 < r ->
  (forall k s, Rabs s < r -> derivable_pt_lim (X k) s (X (S k) s)) ->
  (forall k, X k 0 = INR (fact k) * c k) ->
  exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 ->
    Rabs (X 0%nat h - sum n (fun k => c k * h ^ k)) <= C * Rabs h ^ n.
Proof.
  induction n as [ | n IH ]; intros r X c r_positive D V.
  - destruct (bounded_near (X 0%nat) _ (D 0%nat 0 ltac:(rewrite Rabs_R0; exact r_positive)))
      as (B & d & B_nonnegative & d_positive & bound).
    exists B, d. split; [ exact B_nonnegative | split; [ exact d_positive | ] ]. intros h L.
    simpl. rewrite Rminus_0_r, Rmult_1_r. exact (bound h L).
  - destruct (IH r (fun k => X (S k)) (fun k => INR (S k) * c (S k)) r_positive) as
      (C & h0 & C_nonnegative & h0_positive & bound).
    + intros k s L. apply D, L.
    + intros k. rewrite V, fact_simpl, mult_INR. ring.
    + exists C, (Rmin h0 (r / 2)).
      split; [ exact C_nonnegative | split; [ apply Rmin_pos; lra | ] ].
      pose proof (Rmin_l h0 (r / 2)). pose proof (Rmin_r h0 (r / 2)).
      apply (size_by_slope (fun h => X 0%nat h - sum (S n) (fun k => c k * h ^ k))
        (fun h => X 1%nat h - sum n (fun k => INR (S k) * c (S k) * h ^ k)));
        [ | exact C_nonnegative | intros h L | intros h L; apply bound; lra ].
      * rewrite (sum_of_single (S n) 0); [ rewrite V; simpl; ring | lia | ].
        intros k _ K. rewrite pow_i by lia. ring.
      * apply (derivable_pt_lim_minus (X 0%nat)); [ apply D; lra | ].
        apply derivative_of_polynomial.
Qed.

(** A solution is the flow's series, up to O(h^(m+1)). *)
Theorem taylor_remainder : forall n U (HU : is_open (2 * n + 1) U) H w r c m,
  0 < r -> solves n U H w r -> (c < 2 * n)%nat ->
  exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 ->
    Rabs (w c h - sum (S m) (fun k =>
      value (flow_series _ (smooth_system n U HU H) k c) (fun j => w j 0) * h ^ k))
    <= C * Rabs h ^ (S m).
Proof.
  intros n U HU H w r c m r_positive W L.
  destruct (solution_has_coefficients n U HU H w r c r_positive W L) as (X & X0 & D & V).
  destruct (taylor (S m) r X _ r_positive D V) as (C & h0 & C_nonnegative & h0_positive & B).
  exists C, (Rmin h0 (r / 2)).
  split; [ exact C_nonnegative | split; [ apply Rmin_pos; lra | ] ].
  intros h small. pose proof (Rmin_l h0 (r / 2)). pose proof (Rmin_r h0 (r / 2)).
  rewrite <- X0 by lra. apply B. lra.
Qed.
