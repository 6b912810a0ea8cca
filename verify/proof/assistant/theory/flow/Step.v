(** A step of lie_eta with a number h, in any number of degrees of freedom. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor LieScheme.
Local Open Scope nat_scope.

Section Step.
  Context (K : differential_ring) (s : system K) (eta : nat).
  Add Ring step : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (degrees s).
  Notation power := (power K).

  (** The new value of the coordinate i: sum_(k <= eta) h^k D^k z_i / k!. *)
  Definition new_value (h : K) (i : nat) : K :=
    partial_sum K h (fun k => flow_series K s k i) (S eta).

  (** S = sum_i dp_i' /\ dq_i' - sum_i dp_i /\ dq_i, which is J^T Omega J - Omega. *)
  Definition step_defect (h : K) : form K := fun a b =>
    pairs K s (new_value h) (new_value h) a b - canonical K s a b.

  Lemma new_value_is : forall h i, new_value h i == at_number K h (scheme_series K s eta) (S eta) i.
  Proof.
    intros h i. apply partial_sum_same. intros k L. unfold scheme_series.
    rewrite (proj2 (Nat.leb_le _ _)) by lia. reflexivity.
  Qed.

  (** What is left beyond h^(eta+1), divided by h^(eta+2). *)
  Definition rest (h : K) : form K := fun a b =>
    partial_sum K h (fun m => defect K s eta (S (S eta) + m) a b) eta.

  (** The defect of a step of lie_eta, for every H in n degrees of freedom. *)
  Theorem defect_of_step : forall h a b, is_constant K h -> (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    step_defect h a b
    == power h (S eta) * leading K s eta a b + power h (S (S eta)) * rest h a b.
  Proof.
    intros h a b C La Lb. unfold step_defect.
    rewrite (pairs_same K s (new_value h) _ (new_value h) _ a b (new_value_is h) (new_value_is h)).
    rewrite pairs_at_number by (try exact C; intros k i L; unfold scheme_series;
      rewrite (proj2 (Nat.leb_gt _ _)) by lia; reflexivity).
    replace (S eta + S eta)%nat with (S (S eta) + eta)%nat by lia.
    rewrite partial_sum_first by (first [lia | intros [|m] Lm;
      [lia|apply no_defect_below; (assumption || lia)]]).
    change (defect_coefficient K s (scheme_series K s eta)) with (defect K s eta).
    rewrite defect_at_0, first_defect by assumption. unfold rest. ring.
  Qed.
End Step.
