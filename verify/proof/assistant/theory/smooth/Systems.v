(** Systems of analysis: any smooth Hamiltonian on an open set is one of Flow.v's, among them the
    pendulum and Kepler's.

    Coordinates 0 .. n-1 are p, n .. 2n-1 are q, and 2n is the time, as in Flow.v. *)

From Coq Require Import Reals Lra Lia PeanoNat.
From AreaPreservation Require Import Sums Differential Rings Totals Flow Smooth Functions.
Open Scope R_scope.

Lemma smooth_own_slope : forall n U (HU : is_open (2 * n + 1) U) i, (i <= 2 * n)%nat ->
  @same (smooth_ring _ U HU) (@by_coordinate (smooth_ring _ U HU) i (smooth_coordinate i))
    (@one (smooth_ring _ U HU)).
Proof.
  intros n U HU i Hi. pose proof (derivation_coordinate _ U HU i i) as D.
  rewrite Nat.eqb_refl in D. apply D; lia.
Qed.

Lemma smooth_other_slope : forall n U (HU : is_open (2 * n + 1) U) i j,
  (i <= 2 * n)%nat -> (j <= 2 * n)%nat -> i <> j ->
  @same (smooth_ring _ U HU) (@by_coordinate (smooth_ring _ U HU) i (smooth_coordinate j))
    (@zero (smooth_ring _ U HU)).
Proof.
  intros n U HU i j Hi Hj Ne. pose proof (derivation_coordinate _ U HU i j) as D.
  rewrite (proj2 (Nat.eqb_neq i j) Ne) in D. apply D; lia.
Qed.

(** Any smooth function of p, q and t is a Hamiltonian. *)
Definition smooth_system (n : nat) (U : point -> Prop) (HU : is_open (2 * n + 1) U)
    (H : smooth (2 * n + 1) U) : system (smooth_ring (2 * n + 1) U HU) :=
  Build_system (smooth_ring (2 * n + 1) U HU) n smooth_coordinate H
    (smooth_own_slope n U HU) (smooth_other_slope n U HU).

Lemma value_total : forall N U (HU : is_open N U) m (f : nat -> smooth N U) x,
  value (@total (smooth_ring N U HU) m f) x = sum m (fun i => value (f i) x).
Proof.
  intros N U HU m f x. induction m as [|m IH]; [reflexivity|].
  exact (f_equal (fun t => t + value (f m) x) IH).
Qed.

(** The rate at which a function changes along the flow is the one of analysis. *)
Theorem value_along_flow : forall n U (HU : is_open (2 * n + 1) U) H (f : smooth (2 * n + 1) U) x,
  value (along_flow _ (smooth_system n U HU H) f) x
  = value (smooth_derivative (2 * n) f) x
    + sum n (fun i =>
        value (smooth_derivative i H) x * value (smooth_derivative (n + i) f) x
        - value (smooth_derivative (n + i) H) x * value (smooth_derivative i f) x).
Proof.
  intros n U HU H f x. exact (f_equal (Rplus _) (value_total _ U HU n _ x)).
Qed.

Definition everywhere (x : point) : Prop := True.

Lemma everywhere_is_open : forall N, is_open N everywhere.
Proof. intros N x _. exists 1. split; [lra|]. intros y _. exact I. Qed.

(** The pendulum, H = p^2 / 2 - cos q: one degree of freedom, (p, q, t). *)
Definition pendulum_energy : smooth 3 everywhere :=
  smooth_add
    (smooth_mul (smooth_constant (1 / 2)) (smooth_mul (smooth_coordinate 0) (smooth_coordinate 0)))
    (smooth_opp (smooth_cos (smooth_coordinate 1))).

Definition pendulum : system (smooth_ring 3 everywhere (everywhere_is_open 3)) :=
  smooth_system 1 everywhere (everywhere_is_open 3) pendulum_energy.

Lemma value_pendulum : forall x, value pendulum_energy x = (x 0%nat)^2 / 2 - cos (x 1%nat).
Proof. intro x. unfold value. simpl. unfold coordinate_family. simpl. field. Qed.

(** Its equations of motion are p' = - sin q and q' = p. *)
Theorem pendulum_moves : forall x,
  value (along_flow _ pendulum (smooth_coordinate 0)) x = - sin (x 1%nat) /\
  value (along_flow _ pendulum (smooth_coordinate 1)) x = x 0%nat.
Proof.
  intro x. unfold pendulum. split; (etransitivity; [apply value_along_flow|]);
    unfold value; simpl; unfold derivative_family, coordinate_family, pick; simpl; field.
Qed.

(** Kepler's problem in the plane, H = p^2 / 2 - 1 / |q|: (p_1, p_2, q_1, q_2, t). *)
Definition radius_squared {U} : smooth 5 U :=
  smooth_add (smooth_mul (smooth_coordinate 2) (smooth_coordinate 2))
    (smooth_mul (smooth_coordinate 3) (smooth_coordinate 3)).

Definition away_from_centre (x : point) : Prop :=
  everywhere x /\ 0 < @value 5 everywhere radius_squared x.

Lemma away_from_centre_means : forall x,
  away_from_centre x <-> 0 < (x 2%nat)^2 + (x 3%nat)^2.
Proof.
  intro x. unfold away_from_centre, everywhere, value. simpl. unfold coordinate_family. simpl.
  rewrite !Rmult_1_r. tauto.
Qed.

Lemma away_from_centre_is_open : is_open 5 away_from_centre.
Proof. exact (positive_is_open 5 everywhere radius_squared (everywhere_is_open 5)). Qed.

Lemma radius_positive : forall x, away_from_centre x ->
  0 < value (@radius_squared away_from_centre) x.
Proof. intros x [_ P]. exact P. Qed.

Definition kepler_energy : smooth 5 away_from_centre :=
  smooth_add
    (smooth_mul (smooth_constant (1 / 2))
      (smooth_add (smooth_mul (smooth_coordinate 0) (smooth_coordinate 0))
        (smooth_mul (smooth_coordinate 1) (smooth_coordinate 1))))
    (smooth_opp (smooth_power radius_squared (- / 2) radius_positive)).

Definition kepler : system (smooth_ring 5 away_from_centre away_from_centre_is_open) :=
  smooth_system 2 away_from_centre away_from_centre_is_open kepler_energy.

Lemma value_kepler : forall x, away_from_centre x ->
  value kepler_energy x
  = ((x 0%nat)^2 + (x 1%nat)^2) / 2 - / sqrt ((x 2%nat)^2 + (x 3%nat)^2).
Proof.
  intros x [_ P]. unfold kepler_energy. etransitivity.
  { exact (f_equal (fun t => _ + - t)
      (value_power 5 _ radius_squared (- / 2) radius_positive x)). }
  rewrite Rpower_Ropp, Rpower_sqrt by exact P.
  unfold value. simpl. unfold coordinate_family. simpl. rewrite !Rmult_1_r. field.
  apply Rgt_not_eq, sqrt_lt_R0, P.
Qed.

Lemma power_by_root : forall y, 0 < y -> Rpower y (- / 2 - 1) = / sqrt y ^ 3.
Proof.
  intros y Hy. unfold Rminus.
  rewrite Rpower_plus, !Rpower_Ropp, Rpower_1, Rpower_sqrt by assumption.
  pose proof (sqrt_lt_R0 y Hy). rewrite <- (sqrt_sqrt y) at 2 by lra. field. lra.
Qed.

(** Its equations of motion are p' = - q / |q|^3 and q' = p. *)
Theorem kepler_moves : forall x i, away_from_centre x -> (i < 2)%nat ->
  value (along_flow _ kepler (smooth_coordinate i)) x
    = - x (2 + i)%nat / sqrt ((x 2%nat)^2 + (x 3%nat)^2) ^ 3 /\
  value (along_flow _ kepler (smooth_coordinate (2 + i))) x = x i.
Proof.
  intros x i Hx Hi. assert (i = 0 \/ i = 1)%nat as [-> | ->] by lia;
  (assert (E : Rpower (value (@radius_squared away_from_centre) x) (- / 2 - 1)
     = / sqrt ((x 2%nat)^2 + (x 3%nat)^2) ^ 3); [
    rewrite power_by_root by exact (radius_positive x Hx); do 3 f_equal;
    unfold value; simpl; unfold coordinate_family; simpl; ring|];
  revert E; unfold Rdiv; generalize (/ sqrt ((x 2%nat)^2 + (x 3%nat)^2) ^ 3);
  intros c E; split; (etransitivity; [apply value_along_flow|]); revert E;
  unfold value; simpl; unfold derivative_family, coordinate_family, power_derivative, pick; simpl;
  intro E; rewrite E; field).
Qed.

(** Control: the ring is not trivial where the set has a point, so its laws say something. *)
Lemma smooth_ring_not_trivial : forall N U (HU : is_open N U) x, U x ->
  ~ @same (smooth_ring N U HU) (@zero (smooth_ring N U HU)) (@one (smooth_ring N U HU)).
Proof. intros N U HU x Hx E. specialize (E x Hx). unfold value in E. simpl in E. lra. Qed.
