(** A check of Determinant.v: with one degree of freedom it speaks of what Plane.v speaks of. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow Bracket LieScheme Plane Volume Determinant.
Local Open Scope nat_scope.

Section DeterminantInPlane.
  Context (K : differential_ring) (s : system K) (plane : degrees s = 1) (eta : nat).
  Add Ring determinant_in_plane : (ring_laws K)
    (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  (** det J by its definition. *)
  Theorem same_determinant : forall h,
    Determinants.determinant (2 * degrees s) (jacobian K s eta h) == Plane.determinant K s eta h.
  Proof.
    intro h. rewrite plane. change (2 * 1)%nat with 2%nat. rewrite Determinants.determinant_of_two.
    unfold Plane.determinant, bracket, jacobian. ring.
  Qed.

  (** Its first coefficient. *)
  Theorem same_first_coefficient : first_coefficient K s eta == first_of_determinant K s eta.
  Proof.
    unfold first_coefficient, first_of_determinant. apply opp_extends, mul_extends; [reflexivity|].
    unfold divergence, divergence_of_field, field. rewrite plane. simpl total.
    rewrite (iterated_same K s eta _ _ (field_of_p K s plane)).
    rewrite (iterated_same K s eta _ _ (field_of_q K s plane)). ring.
  Qed.
End DeterminantInPlane.
