(** A step of lie_eta with a number h, and what the theorem says in the plane: of det J. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor LieScheme.
Local Open Scope nat_scope.

Section Step.
  Context (K : differential_ring) (s : system K) (eta : nat).
  Add Ring step : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (degrees s).
  Notation H := (hamiltonian s).
  Notation d := by_coordinate.
  Notation z := (coordinate s).
  Notation D := (along_flow K s).
  Notation X := (along_field K s).
  Notation power := (power K).

  (** The new value of the coordinate i: sum_(k <= eta) h^k D^k z_i / k!. *)
  Definition new_value (h : K) (i : nat) : K :=
    total (S eta) (fun k => power h k * flow_series K s k i).

  (** S = sum_i dp_i' /\ dq_i' - sum_i dp_i /\ dq_i, which is J^T Omega J - Omega. *)
  Definition step_defect (h : K) : form K := fun a b =>
    pairs K s (new_value h) (new_value h) a b - canonical K s a b.

  (** Derivations do not see h. *)
  Definition constant (h : K) : Prop := forall i, d i h == zero.

  Lemma power_constant : forall h k, constant h -> constant (power h k).
  Proof.
    intros h k C i. induction k as [|k IH]; simpl; [apply derivation_one|].
    rewrite derivation_mul, IH, (C i). ring.
  Qed.

  Lemma power_add : forall h k l, power h (k + l)%nat == power h k * power h l.
  Proof. intros h k l. induction k as [|k IH]; simpl; [|rewrite IH]; ring. Qed.

  (** The defect as a polynomial in h. *)
  Lemma pairs_of_series : forall h a b, constant h ->
    pairs K s (new_value h) (new_value h) a b
    == total (S eta + S eta)%nat (fun m => power h m * defect K s eta m a b).
  Proof.
    intros h a b C.
    set (T := fun k i => power h k * scheme_series K s eta k i).
    assert (cut : forall a j, d a (new_value h j) == total (S eta) (fun k => d a (T k j))).
    { intros c j. unfold new_value. rewrite derivation_total. apply total_same. intros k L.
      apply derivation_extends. unfold T, scheme_series.
      rewrite (proj2 (Nat.leb_le _ _)) by lia. reflexivity. }
    transitivity (total (S eta) (fun k => total (S eta) (fun l => pairs K s (T k) (T l) a b))).
    - unfold pairs. rewrite (total_same K n _ (fun i => total (S eta) (fun k => total (S eta)
        (fun l => wedge K (T k i) (T l (n + i)%nat) a b)))).
      + rewrite total_swap. apply total_same. intros k _. apply total_swap.
      + intros i _. unfold wedge. rewrite !cut, !total_times_total, <- total_sub.
        apply total_same. intros k _. symmetry. apply total_sub.
    - rewrite total_product.
      + apply total_same. intros m _. unfold defect, defect_coefficient.
        rewrite <- total_scaled. apply total_same. intros k L. unfold paired, pairs.
        rewrite <- total_scaled. apply total_same. intros i _. unfold wedge, T.
        assert (E : power h m == power h k * power h (m - k)%nat).
        { rewrite <- power_add. replace (k + (m - k))%nat with m by lia. reflexivity. }
        rewrite E, !derivation_mul, !(power_constant h) by exact C. ring.
      + intros k l over. apply pairs_of_zero. unfold T, scheme_series.
        destruct over; [left|right]; intro i; rewrite (proj2 (Nat.leb_gt _ _)) by lia; ring.
  Qed.

  (** What is left beyond h^(eta+1), divided by h^(eta+2). *)
  Definition rest (h : K) : form K := fun a b =>
    total eta (fun m => power h m * defect K s eta (S (S eta) + m) a b).

  Lemma total_split : forall m k (f : nat -> K),
    total (m + k)%nat f == total m f + total k (fun i => f (m + i)%nat).
  Proof.
    intros m k f. induction k as [|k IH].
    - replace (m + 0)%nat with m by lia. simpl. ring.
    - replace (m + S k)%nat with (S (m + k)) by lia. simpl. rewrite IH. ring.
  Qed.

  (** The defect of a step of lie_eta, for every H in n degrees of freedom. *)
  Theorem defect_of_step : forall h a b, constant h -> (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    step_defect h a b
    == power h (S eta) * leading K s eta a b + power h (S (S eta)) * rest h a b.
  Proof.
    intros h a b C La Lb. unfold step_defect. rewrite pairs_of_series by exact C.
    replace (S eta + S eta)%nat with (S (S eta) + eta)%nat by lia.
    rewrite total_split.
    change (total (S (S eta)) (fun m => power h m * defect K s eta m a b)) with
      (total (S eta) (fun m => power h m * defect K s eta m a b)
       + power h (S eta) * defect K s eta (S eta) a b).
    rewrite first_defect by assumption.
    rewrite (total_one K (S eta) 0) by (first [lia | intros [|m] Lm N;
      [lia|rewrite no_defect_below by (assumption || lia); ring]]).
    rewrite defect_at_0. unfold rest. rewrite <- total_scaled.
    rewrite (total_same K eta (fun i => power h (S (S eta) + i) * _)
      (fun m => power h (S (S eta)) * (power h m * defect K s eta (S (S eta) + m) a b))).
    - simpl power at 1. ring.
    - intros m _. rewrite power_add. ring.
  Qed.
End Step.
