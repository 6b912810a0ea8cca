(** The scheme lie_eta for every H and every eta: its defect begins with h^(eta+1), and for even
    eta the first coefficient telescopes, with a G in closed form. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor.
Local Open Scope nat_scope.

Section LieScheme.
  Context (K : differential_ring) (s : system K) (eta : nat).
  Add Ring lie_scheme : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (degrees s).
  Notation H := (hamiltonian s).
  Notation d := by_coordinate.
  Notation z := (coordinate s).
  Notation D := (along_flow K s).
  Notation pairs := (pairs K s).
  Notation flow_series := (flow_series K s).
  Notation coefficient := (coefficient K s).

  Fixpoint iterated (k : nat) (f : K) : K :=
    match k with
    | O => f
    | S j => D (iterated j f)
    end.

  Definition inverse_factorial (k : nat) : K := rational (1 # Pos.of_nat (fact k)).

  Lemma coefficient_is : forall k f, coefficient k f == inverse_factorial k * iterated k f.
  Proof.
    induction k as [|k IH]; intro f.
    - simpl. unfold inverse_factorial. change (1 # Pos.of_nat (fact 0)) with 1%Q.
      rewrite rational_one. ring.
    - simpl Taylor.coefficient. rewrite IH. unfold inverse_factorial at 1.
      rewrite along_flow_scaled by (intro i; apply derivation_rational). simpl iterated.
      transitivity (fraction (S k) * rational (1 # Pos.of_nat (fact k)) * D (iterated k f)); [ring|].
      apply mul_extends; [|reflexivity].
      unfold fraction, inverse_factorial. rewrite <- rational_mul. apply rational_extends.
      unfold Qeq, Qmult. cbn [Qnum Qden].
      change (fact (S k)) with (S k * fact k)%nat.
      rewrite Nat2Pos.inj_mul by (try apply fact_neq_0; lia). lia.
  Qed.

  (** The series of the scheme, cut off after h^eta. *)
  Definition scheme_series (k i : nat) : K := if (k <=? eta)%nat then flow_series k i else zero.

  Definition defect := defect_coefficient K s scheme_series.

  (** The first coefficient that is left. *)
  Definition leading : form K := fun a b =>
    - (pairs (flow_series (S eta)) z a b + pairs z (flow_series (S eta)) a b).

  (** The map is symplectic at h = 0. *)
  Theorem defect_at_0 : forall a b, defect 0 a b == canonical K s a b.
  Proof.
    intros a b. unfold defect, defect_coefficient, paired. simpl total.
    rewrite (pairs_same K s (scheme_series 0) z (scheme_series 0) z); [unfold canonical; ring|..];
      reflexivity.
  Qed.

  Theorem no_defect_below : forall m a b, (a < 2 * n)%nat -> (b < 2 * n)%nat -> (S m <= eta)%nat ->
    defect (S m) a b == zero.
  Proof.
    intros m a b La Lb L. rewrite <- (flow_has_no_defect K s m a b La Lb).
    apply total_same. intros k Lk. apply pairs_same; intro i; unfold scheme_series;
      rewrite (proj2 (Nat.leb_le _ _)) by lia; reflexivity.
  Qed.

  Theorem first_defect : forall a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    defect (S eta) a b == leading a b.
  Proof.
    intros a b La Lb. apply (cancel K _ _ (pairs z (flow_series (S eta)) a b
      + pairs (flow_series (S eta)) z a b)).
    transitivity (defect_coefficient K s flow_series (S eta) a b).
    - unfold defect, defect_coefficient, paired. symmetry.
      rewrite total_first. symmetry. rewrite total_first.
      change (total (S eta) (fun i => pairs (scheme_series (S i)) (scheme_series (S eta - S i)) a b))
        with (total eta (fun i => pairs (scheme_series (S i)) (scheme_series (S eta - S i)) a b)
          + pairs (scheme_series (S eta)) (scheme_series (S eta - S eta)) a b).
      change (total (S eta) (fun i => pairs (flow_series (S i)) (flow_series (S eta - S i)) a b))
        with (total eta (fun i => pairs (flow_series (S i)) (flow_series (S eta - S i)) a b)
          + pairs (flow_series (S eta)) (flow_series (S eta - S eta)) a b).
      assert (over : forall i, scheme_series (S eta) i == zero).
      { intro i. unfold scheme_series. rewrite (proj2 (Nat.leb_gt _ _)) by lia. reflexivity. }
      rewrite (pairs_of_zero K s (scheme_series (S eta))) by (left; exact over).
      replace (S eta - 0)%nat with (S eta) by lia.
      rewrite (pairs_of_zero K s (scheme_series 0)) by (right; exact over).
      replace (S eta - S eta)%nat with O by lia.
      rewrite (total_same K eta (fun i => pairs (scheme_series _) (scheme_series _) a b)
        (fun i => pairs (flow_series (S i)) (flow_series (S eta - S i)) a b)).
      + change (pairs (flow_series 0) (flow_series (S eta)) a b) with
          (pairs z (flow_series (S eta)) a b).
        change (pairs (flow_series (S eta)) (flow_series 0) a b) with
          (pairs (flow_series (S eta)) z a b). ring.
      + intros k L. apply pairs_same; intro i; unfold scheme_series;
          rewrite (proj2 (Nat.leb_le _ _)) by lia; reflexivity.
    - rewrite flow_has_no_defect by assumption. unfold leading. ring.
  Qed.

  (** (-1)^k. *)
  Definition sign (k : nat) : K := if Nat.even k then one else - one.

  Lemma sign_next : forall k, sign (S k) == - sign k.
  Proof.
    intro k. unfold sign. rewrite Nat.even_succ, <- Nat.negb_even.
    destruct (Nat.even k); simpl; ring.
  Qed.

  (** - 1/(eta+1)! sum_k (-1)^k sum_i d(D^(eta-k) p_i) /\ d(D^k q_i). *)
  Definition potential : form K := fun a b => - (inverse_factorial (S eta) * total (S eta) (fun k =>
    sign k * pairs (fun i => iterated (eta - k) (z i)) (fun i => iterated k (z i)) a b)).

  Lemma sign_constant : forall k, is_constant K (sign k).
  Proof.
    intros k i. unfold sign. destruct (Nat.even k); rewrite ?derivation_opp, derivation_one; ring.
  Qed.

  Theorem even_telescopes : Nat.Even eta -> forall a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    lie_derivative K s potential a b == leading a b.
  Proof.
    intros even a b La Lb. unfold potential.
    set (V := fun k l => pairs (fun i => iterated k (z i)) (fun i => iterated l (z i))).
    assert (opposite : is_constant K (- one)).
    { intro i. rewrite derivation_opp, derivation_one. ring. }
    assert (factorial : is_constant K (inverse_factorial (S eta))).
    { intro i. apply derivation_rational. }
    transitivity (- one * (inverse_factorial (S eta) * total (S eta) (fun k =>
      sign k * (V (S (eta - k)) k a b + V (eta - k)%nat (S k) a b)))).
    - rewrite <- (lie_derivative_same K s (fun a b => - one * (inverse_factorial (S eta) *
        total (S eta) (fun k => sign k * V (eta - k)%nat k a b)))) by
        (try assumption; intros; unfold V; ring).
      rewrite (lie_derivative_scaled K s (- one)), (lie_derivative_scaled K s _ _ a b factorial) by
        exact opposite.
      apply mul_extends; [reflexivity|]. rewrite lie_derivative_total.
      apply mul_extends; [reflexivity|]. apply total_same. intros k _.
      rewrite lie_derivative_scaled by apply sign_constant.
      unfold V. rewrite lie_derivative_of_pairs. reflexivity.
    - assert (partial : forall m, (m <= S eta)%nat -> total m (fun k =>
          sign k * (V (S (eta - k)) k a b + V (eta - k)%nat (S k) a b))
          == V (S eta) 0%nat a b - sign m * V (S eta - m)%nat m a b).
      { induction m as [|m IH]; intro L.
        - simpl. unfold sign. simpl. ring.
        - simpl total. rewrite IH by lia. rewrite sign_next.
          replace (S eta - m)%nat with (S (eta - m)) by lia.
          replace (S eta - S m)%nat with (eta - m)%nat by lia. ring. }
      rewrite partial by lia. replace (S eta - S eta)%nat with O by lia.
      rewrite sign_next. unfold sign.
      rewrite (proj2 (Nat.even_spec eta) even). unfold leading.
      rewrite (pairs_same K s (flow_series (S eta))
        (fun i => inverse_factorial (S eta) * iterated (S eta) (z i)) z z) by
        (intro i; try reflexivity; apply coefficient_is).
      rewrite (pairs_same K s z z (flow_series (S eta))
        (fun i => inverse_factorial (S eta) * iterated (S eta) (z i))) by
        (intro i; try reflexivity; apply coefficient_is).
      unfold inverse_factorial. rewrite (proj1 (pairs_scaled K s _ _ z a b)).
      rewrite (proj2 (pairs_scaled K s _ z _ a b)).
      change (V (S eta) 0%nat a b) with (pairs (fun i => iterated (S eta) (z i)) z a b).
      change (V 0%nat (S eta) a b) with (pairs z (fun i => iterated (S eta) (z i)) a b).
      ring.
  Qed.
End LieScheme.
