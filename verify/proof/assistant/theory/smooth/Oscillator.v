(** The oscillator H = (p^2 + q^2)/2: for every odd eta the first coefficient of lie_eta does not
    telescope along its flow; for even eta it is 0.

    For eta = 2j + 1 it is the number 2 (-1)^j / (2j+2)!, while X G is 0 where p = q = 0. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory Reals Lra Lia PeanoNat.
From AreaPreservation Require Import Sums Rings Flow LieScheme Plane Smooth Systems Solutions.
Local Open Scope nat_scope.

(** What is calculated in any ring where H_p = p, H_q = q and H_t = 0. *)
Section Turning.
  Context (K : differential_ring) (s : system K) (plane : degrees s = 1).
  Add Ring turning : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation H := (hamiltonian s).
  Notation d := by_coordinate.
  Notation z := (coordinate s).
  Notation D := (along_flow K s).
  Notation iterated := (iterated K s).
  Notation sign := (sign K).

  Context (slope_p : d 0%nat H == z 0%nat) (slope_q : d 1%nat H == z 1%nat).

  Lemma along_flow_opp : forall f, D (- f) == - D f.
  Proof.
    intro f. apply (cancel K _ _ (D f)). rewrite <- along_flow_add.
    transitivity (D zero); [apply along_flow_proper; ring|].
    rewrite along_flow_zero. ring.
  Qed.

  Lemma iterated_opp : forall k f, iterated k (- f) == - iterated k f.
  Proof.
    induction k as [|k IH]; intro f; simpl; [reflexivity|]. rewrite IH. apply along_flow_opp.
  Qed.

  Lemma flow_of_p : D (z 0%nat) == - z 1%nat.
  Proof. rewrite field_of_p, slope_q by exact plane. reflexivity. Qed.

  Lemma flow_of_q : D (z 1%nat) == z 0%nat.
  Proof. rewrite field_of_q, slope_p by exact plane. reflexivity. Qed.

  (** D D z = - z. *)
  Lemma iterated_evenly : forall j i, (i < 2)%nat -> iterated (2 * j) (z i) == sign j * z i.
  Proof.
    induction j as [|j IH]; intros i L.
    - unfold LieScheme.sign. simpl. ring.
    - replace (2 * S j)%nat with (S (S (2 * j))) by lia. rewrite !iterated_next, sign_next.
      assert (twice : D (D (z i)) == - z i).
      { assert (i = 0 \/ i = 1)%nat as [-> | ->] by lia.
        - rewrite flow_of_p, along_flow_opp, flow_of_q. reflexivity.
        - rewrite flow_of_q. apply flow_of_p. }
      rewrite (iterated_same K s _ _ _ twice), iterated_opp, IH by exact L. ring.
  Qed.

  Lemma slope_of_signed : forall a j x, d a (sign j * x) == sign j * d a x.
  Proof.
    intros a j x. rewrite derivation_mul. unfold LieScheme.sign.
    destruct (Nat.even j); rewrite ?derivation_opp, derivation_one; ring.
  Qed.

  Lemma slopes_of_coordinates : d 0%nat (z 0%nat) == one /\ d 1%nat (z 1%nat) == one
    /\ d 0%nat (z 1%nat) == zero /\ d 1%nat (z 0%nat) == zero.
  Proof. repeat split; first [apply own_slope | apply other_slope]; rewrite ?plane; lia. Qed.

  (** For odd eta the coefficient is a number, and not 0. *)
  Theorem first_for_odd : forall j, first_of_determinant K s (2 * j + 1)
    == inverse_factorial K (2 * j + 2) * (sign j + sign j).
  Proof.
    intro j. destruct slopes_of_coordinates as (p_p & q_q & _ & _).
    unfold first_of_determinant, divergence_of_field.
    replace (S (2 * j + 1)) with (2 * j + 2)%nat by lia.
    replace (2 * j + 1)%nat with (S (2 * j)) by lia.
    rewrite iterated_opp, (iterated_same K s _ _ _ slope_p), (iterated_same K s _ _ _ slope_q).
    rewrite !iterated_next, (iterated_same K s _ _ _ flow_of_p), iterated_opp.
    rewrite (iterated_same K s _ _ _ flow_of_q), !iterated_evenly by lia.
    rewrite !derivation_opp, !slope_of_signed, p_p, q_q. ring.
  Qed.

  (** Control: for even eta it is 0. *)
  Theorem first_for_even : forall j, first_of_determinant K s (2 * j) == zero.
  Proof.
    intro j. destruct slopes_of_coordinates as (_ & _ & p_q & q_p).
    unfold first_of_determinant, divergence_of_field.
    rewrite iterated_opp, (iterated_same K s _ _ _ slope_p), (iterated_same K s _ _ _ slope_q).
    rewrite !iterated_evenly by lia. rewrite derivation_opp, !slope_of_signed, p_q, q_p. ring.
  Qed.

  (** X G = p G_q - q G_p. *)
  Lemma field_turns : forall G, along_field K s G == z 0%nat * d 1%nat G - z 1%nat * d 0%nat G.
  Proof.
    intro G. unfold along_field. rewrite plane. simpl. rewrite slope_p, slope_q. ring.
  Qed.
End Turning.

Local Open Scope R_scope.

Definition oscillator_energy : smooth 3 everywhere :=
  smooth_mul (smooth_constant (1 / 2))
    (smooth_add (smooth_mul (smooth_coordinate 0) (smooth_coordinate 0))
      (smooth_mul (smooth_coordinate 1) (smooth_coordinate 1))).

Local Notation space := (smooth_ring 3 everywhere (everywhere_is_open 3)).

Definition oscillator : system space :=
  smooth_system 1 everywhere (everywhere_is_open 3) oscillator_energy.

Lemma value_oscillator : forall x, value oscillator_energy x = ((x 0%nat)^2 + (x 1%nat)^2) / 2.
Proof. intro x. unfold value. simpl. unfold coordinate_family. simpl. field. Qed.

Lemma oscillator_slopes : forall i, (i < 2)%nat ->
  @same space (@by_coordinate space i oscillator_energy) (smooth_coordinate i).
Proof.
  intros i L x _. assert (i = 0 \/ i = 1)%nat as [-> | ->] by lia;
    unfold value; simpl; unfold derivative_family, coordinate_family, pick; simpl; field.
Qed.

(** Its equations of motion are p' = - q and q' = p. *)
Theorem oscillator_moves : forall x,
  value (along_flow _ oscillator (smooth_coordinate 0)) x = - x 1%nat /\
  value (along_flow _ oscillator (smooth_coordinate 1)) x = x 0%nat.
Proof.
  intro x. split.
  - exact (flow_of_p space oscillator eq_refl (oscillator_slopes 1 ltac:(lia)) x I).
  - exact (flow_of_q space oscillator eq_refl (oscillator_slopes 0 ltac:(lia)) x I).
Qed.

(** Control: p = cos s, q = sin s is a solution in the sense of Solutions.v. *)
Lemma oscillation_solves : forall r, solves 1 everywhere oscillator_energy
  (fun j => match j with O => cos | S O => sin | _ => id end) r.
Proof.
  intros r s _. split; [exact I|split; [|apply derivable_pt_lim_id]].
  intros i L. replace i with O by lia.
  pose proof (oscillator_slopes 0 ltac:(lia)) as P.
  pose proof (oscillator_slopes 1 ltac:(lia)) as Q.
  change (2 * 1 + 1)%nat with 3%nat.
  change (@by_coordinate space) with (@smooth_derivative 3 everywhere) in P, Q.
  split; [rewrite (Q _ I)|rewrite (P _ I)]; rewrite value_coordinate by lia.
  - apply derivable_pt_lim_cos.
  - apply derivable_pt_lim_sin.
Qed.

(** The first coefficient is 2 (-1)^j / (2j+2)! for eta = 2j + 1. *)
Theorem oscillator_first_for_odd : forall j x,
  value (first_of_determinant _ oscillator (2 * j + 1)) x = 2 * (-1) ^ j / INR (fact (2 * j + 2)).
Proof.
  intros j x.
  rewrite (first_for_odd space oscillator eq_refl (oscillator_slopes 0 ltac:(lia))
    (oscillator_slopes 1 ltac:(lia)) j x I).
  rewrite value_mul, value_add, value_inverse_factorial.
  assert (E : value (sign space j) x = (-1) ^ j).
  { induction j as [|j IH]; [reflexivity|]. rewrite (sign_next space j x I), value_opp, IH.
    simpl. ring. }
  rewrite E. unfold Rdiv. ring.
Qed.

Theorem oscillator_first_for_even : forall eta x, Nat.Even eta ->
  value (first_of_determinant _ oscillator eta) x = 0.
Proof.
  intros eta x [j ->].
  exact (first_for_even space oscillator eq_refl (oscillator_slopes 0 ltac:(lia))
    (oscillator_slopes 1 ltac:(lia)) j x I).
Qed.

Theorem oscillator_first_not_zero : forall eta x, Nat.Odd eta ->
  value (first_of_determinant _ oscillator eta) x <> 0.
Proof.
  intros eta x [j ->]. rewrite oscillator_first_for_odd. unfold Rdiv.
  repeat apply Rmult_integral_contrapositive_currified; [lra|apply pow_nonzero; lra|].
  apply Rinv_neq_0_compat, INR_fact_neq_0.
Qed.

(** For no odd eta is there a G with X G equal to the first coefficient. *)
Theorem odd_does_not_telescope : forall eta, Nat.Odd eta ->
  ~ exists G, @same space (along_field _ oscillator G) (first_of_determinant _ oscillator eta).
Proof.
  intros eta odd [G E]. set (x := fun _ : nat => 0).
  apply (oscillator_first_not_zero eta x odd). rewrite <- (E x I).
  rewrite (field_turns space oscillator eq_refl (oscillator_slopes 0 ltac:(lia))
    (oscillator_slopes 1 ltac:(lia)) G x I).
  rewrite value_sub, !value_mul. simpl coordinate. rewrite !value_coordinate by lia.
  unfold x. ring.
Qed.

(** Nor, of course, a G without time with D G equal to it. *)
Corollary odd_does_not_telescope_along_flow : forall eta, Nat.Odd eta ->
  ~ exists G, @same space (@by_coordinate space 2 G) (@zero space) /\
    @same space (along_flow _ oscillator G) (first_of_determinant _ oscillator eta).
Proof.
  intros eta odd (G & still & E). apply (odd_does_not_telescope eta odd). exists G.
  intros x X. rewrite <- (E x X). unfold along_flow. rewrite value_add.
  change (2 * degrees oscillator)%nat with 2%nat. rewrite (still x X), value_zero. ring.
Qed.
