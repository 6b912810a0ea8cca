(** One degree of freedom: the determinant of lie_eta for every H(p, q, t) and every eta. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor Bracket LieScheme Step.
Local Open Scope nat_scope.

Section Plane.
  Context (K : differential_ring) (s : system K) (plane : degrees s = 1) (eta : nat).
  Add Ring plane : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation H := (hamiltonian s).
  Notation d := by_coordinate.
  Notation z := (coordinate s).
  Notation D := (along_flow K s).
  Notation X := (along_field K s).
  Notation iterated := (iterated K s).

  Lemma field_of_p : D (z 0%nat) == - d 1%nat H.
  Proof.
    destruct (along_flow_coordinate K s 0) as [E _]; [rewrite plane; lia|].
    rewrite E, plane. reflexivity.
  Qed.

  Lemma field_of_q : D (z 1%nat) == d 0%nat H.
  Proof.
    destruct (along_flow_coordinate K s 0) as [_ E]; [rewrite plane; lia|].
    rewrite plane in E. exact E.
  Qed.

  Lemma iterated_same : forall k f g, f == g -> iterated k f == iterated k g.
  Proof. induction k as [|k IH]; intros f g E; simpl; [|rewrite (IH f g E)]; easy. Qed.

  Lemma iterated_next : forall k f, iterated (S k) f == iterated k (D f).
  Proof. induction k as [|k IH]; intro f; [reflexivity|]. simpl. rewrite <- IH. reflexivity. Qed.

  (** - div(D^eta f) / (eta+1)! of the vector field f = (- H_q, H_p). *)
  Definition divergence_of_field : K :=
    d 0%nat (iterated eta (- d 1%nat H)) + d 1%nat (iterated eta (d 0%nat H)).

  Definition first_of_determinant : K := - (inverse_factorial K (S eta) * divergence_of_field).

  Lemma leading_in_plane : leading K s eta 0 1 == first_of_determinant.
  Proof.
    unfold leading, first_of_determinant, divergence_of_field.
    rewrite !(pairs_in_plane K s plane). unfold bracket, flow_series.
    rewrite !coefficient_is, !iterated_next.
    rewrite (iterated_same eta _ _ field_of_p), (iterated_same eta _ _ field_of_q).
    unfold inverse_factorial. rewrite !derivation_mul, !derivation_rational.
    rewrite !own_slope, !other_slope by (rewrite ?plane; lia). ring.
  Qed.

  (** det J of a step. *)
  Definition determinant (h : K) : K := bracket K (new_value K s eta h 0) (new_value K s eta h 1).

  (** The first power of h in det J - 1 is h^(eta+1), with this coefficient. *)
  Theorem determinant_of_step : forall h, is_constant K h ->
    determinant h == one + power K h (S eta) * first_of_determinant
      + power K h (S (S eta)) * rest K s eta h 0 1.
  Proof.
    intros h C.
    assert (E := defect_of_step K s eta h 0 1 C).
    rewrite plane in E. specialize (E ltac:(lia) ltac:(lia)).
    rewrite leading_in_plane in E. unfold step_defect in E.
    rewrite (pairs_in_plane K s plane), (canonical_in_plane K s plane) in E. fold (determinant h) in E.
    transitivity (determinant h - one + one); [ring|]. rewrite E. ring.
  Qed.

  (** - 1/(eta+1)! sum_k (-1)^k {D^(eta-k) p, D^k q}. *)
  Definition G : K := - (inverse_factorial K (S eta) * total (S eta) (fun k =>
    sign K k * bracket K (iterated (eta - k) (z 0%nat)) (iterated k (z 1%nat)))).

  (** For even eta the coefficient is D G, so that it telescopes along the flow. *)
  Theorem telescopes_for_even : Nat.Even eta -> D G == first_of_determinant.
  Proof.
    intro even.
    assert (E := even_telescopes K s eta even 0 1).
    rewrite plane in E. specialize (E ltac:(lia) ltac:(lia)). rewrite leading_in_plane in E.
    rewrite <- E. unfold lie_derivative. rewrite plane. simpl total.
    assert (G_is : potential K s eta 0 1 == G).
    { unfold potential, G. apply opp_extends, mul_extends; [reflexivity|].
      apply total_same. intros k _. rewrite (pairs_in_plane K s plane). reflexivity. }
    assert (none : forall a, potential K s eta a a == zero).
    { intro a. unfold potential. rewrite total_zero; [ring|]. intros k _.
      unfold pairs. rewrite total_zero; [ring|]. intros i _. unfold wedge. ring. }
    rewrite G_is, !none, (derivations_commute K 0 1 H). ring.
  Qed.

End Plane.
