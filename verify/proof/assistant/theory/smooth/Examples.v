(** The pendulum and Kepler's problem are smooth systems, and move as they should: the theorems
    about every smooth H speak of them. *)

From Coq Require Import Reals Lra Lia PeanoNat.
From AreaPreservation Require Import Sums Differential Rings Totals Flow Smooth Functions Systems.
Local Open Scope R_scope.

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
