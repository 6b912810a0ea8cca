(** The plane: the bracket of two functions, which is what det J is of p' and q'. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor.
Local Open Scope nat_scope.

Section Bracket.
  Context (K : differential_ring) (s : system K) (plane : degrees s = 1).
  Add Ring bracket_ring : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation d := by_coordinate.
  Notation z := (coordinate s).

  (** {a, b} = a_p b_q - a_q b_p, which is what det J is of p' and q'. *)
  Definition bracket (a b : K) : K := d 0%nat a * d 1%nat b - d 1%nat a * d 0%nat b.

  Lemma pairs_in_plane : forall A B, pairs K s A B 0 1 == bracket (A 0%nat) (B 1%nat).
  Proof. intros A B. unfold pairs. rewrite plane. simpl. unfold wedge, bracket. ring. Qed.

  Lemma canonical_in_plane : canonical K s 0 1 == one.
  Proof.
    unfold canonical. rewrite pairs_in_plane. unfold bracket.
    rewrite !own_slope, !other_slope by (rewrite ?plane; lia). ring.
  Qed.
End Bracket.
