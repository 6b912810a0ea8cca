(** The scheme lie_eta, z' = sum h^k/k! D^k z up to k = eta, for every H and every eta: the
    coefficients of h^1 .. h^eta in its defect vanish, and the next is told. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow.
Local Open Scope nat_scope.

Definition whole {K : rational_ring} (k : nat) : K := rational (Z.of_nat k # 1).
Definition fraction {K : rational_ring} (k : nat) : K := rational (1 # Pos.of_nat k).

Section Taylor.
  Context (K : differential_ring) (s : system K).
  Add Ring taylor : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (degrees s).
  Notation H := (hamiltonian s).
  Notation d := by_coordinate.
  Notation D := (along_flow K s).
  Notation lie := (lie_derivative K s).
  Notation pairs := (pairs K s).

  Lemma whole_fraction : forall k, @whole K (S k) * fraction (S k) == one.
  Proof.
    intro k. unfold whole, fraction. rewrite <- rational_mul, <- rational_one.
    apply rational_extends. unfold Qeq, Qmult. cbn [Qnum Qden]. lia.
  Qed.

  Lemma whole_add : forall k l, @whole K (k + l) == whole k + whole l.
  Proof.
    intros k l. unfold whole. rewrite <- rational_add. apply rational_extends.
    unfold Qeq, Qplus. cbn [Qnum Qden]. lia.
  Qed.

  Lemma no_torsion : forall k (x : K), whole (S k) * x == zero -> x == zero.
  Proof.
    intros k x E. transitivity (fraction (S k) * (whole (S k) * x)); [|rewrite E; ring].
    transitivity (whole (S k) * fraction (S k) * x); [rewrite whole_fraction|]; ring.
  Qed.

  Lemma no_torsion_same : forall k (x y : K), whole (S k) * x == whole (S k) * y -> x == y.
  Proof.
    intros k x y E. transitivity (x - y + y); [ring|].
    rewrite (no_torsion k (x - y)); [ring|].
    transitivity (whole (S k) * x - whole (S k) * y); [|rewrite E]; ring.
  Qed.

  (** D^k f / k!. *)
  Fixpoint coefficient (k : nat) (f : K) : K :=
    match k with
    | O => f
    | S j => fraction (S j) * D (coefficient j f)
    end.

  Lemma along_flow_coefficient : forall k f,
    D (coefficient k f) == whole (S k) * coefficient (S k) f.
  Proof.
    intros k f. simpl.
    transitivity (whole (S k) * fraction (S k) * D (coefficient k f)); [|ring].
    rewrite whole_fraction. ring.
  Qed.

  (** The coefficients of two series up to h^k, paired as the form pairs p and q. *)
  Definition paired (A : nat -> nat -> K) (k l : nat) : form K := pairs (A k) (A l).

  (** That of h^m in sum_i dp_i' /\ dq_i'. *)
  Definition defect_coefficient (A : nat -> nat -> K) (m : nat) : form K := fun a b =>
    total (S m) (fun k => paired A k (m - k) a b).

  (** Of the flow's own series. *)
  Definition flow_series (k i : nat) : K := coefficient k (coordinate s i).

  Definition canonical : form K := pairs (coordinate s) (coordinate s).

  Lemma pairs_same : forall A A' B B' a b,
    (forall i, A i == A' i) -> (forall i, B i == B' i) -> pairs A B a b == pairs A' B' a b.
  Proof.
    intros A A' B B' a b E F. apply total_same. intros i _. rewrite (E i), (F (n + i)%nat).
    reflexivity.
  Qed.

  (** The new value of the coordinate i at a number h: the terms before h^m. *)
  Definition at_number (h : K) (A : nat -> nat -> K) (m i : nat) : K :=
    partial_sum K h (fun k => A k i) m.

  Lemma pairs_of_zero : forall A B a b, (forall i, A i == zero) \/ (forall i, B i == zero) ->
    pairs A B a b == zero.
  Proof.
    intros A B a b [E|E]; apply total_zero; intros i _; unfold wedge; rewrite E;
      rewrite !derivation_zero; ring.
  Qed.

  (** Where the map ends before h^m its coefficients end before h^(2m - 1). *)
  Lemma defect_coefficient_ends : forall A m, (forall k i, (m <= k)%nat -> A k i == zero) ->
    forall j a b, (m + m <= S j)%nat -> defect_coefficient A j a b == zero.
  Proof.
    intros A m E j a b L. apply total_zero. intros k Lk. apply pairs_of_zero.
    destruct (Nat.le_gt_cases m k) as [M|M]; [left|right]; intro i; apply E; lia.
  Qed.

  (** So sum_i dp_i' /\ dq_i' is the sum of its coefficients, at each number h. *)
  Theorem pairs_at_number : forall h A m a b, is_constant K h ->
    (forall k i, (m <= k)%nat -> A k i == zero) ->
    pairs (at_number h A m) (at_number h A m) a b
    == partial_sum K h (fun j => defect_coefficient A j a b) (m + m).
  Proof.
    intros h A m a b C E. set (T := fun k i => power K h k * A k i).
    assert (slope : forall k c x, d c (power K h k * x) == power K h k * d c x).
    { intros k c x. rewrite derivation_mul, (power_constant K h k C c). ring. }
    transitivity (total m (fun k => total m (fun l => pairs (T k) (T l) a b))).
    - unfold Flow.pairs. rewrite (total_same K n _ (fun i => total m (fun k => total m
        (fun l => wedge K (T k i) (T l (n + i)%nat) a b)))).
      + rewrite total_swap. apply total_same. intros k _. apply total_swap.
      + intros i _. unfold wedge, at_number, partial_sum.
        rewrite !derivation_total, !total_times_total, <- total_sub.
        apply total_same. intros k _. symmetry. apply total_sub.
    - rewrite total_product.
      + apply total_same. intros j _. unfold defect_coefficient.
        rewrite <- total_scaled. apply total_same. intros k L. unfold paired, Flow.pairs.
        rewrite <- total_scaled. apply total_same. intros i _. unfold wedge, T.
        assert (P : power K h j == power K h k * power K h (j - k)%nat).
        { rewrite <- power_add. replace (k + (j - k))%nat with j by lia. reflexivity. }
        rewrite P, !slope. ring.
      + intros k l over. apply pairs_of_zero. unfold T.
        destruct over; [left|right]; intro i; rewrite E by assumption; ring.
  Qed.

  (** What is added to a map with a factor g, a number, adds this. *)
  Lemma pairs_with_remainder : forall g A u a b, is_constant K g ->
    pairs (fun i => A i + g * u i) (fun i => A i + g * u i) a b
    == pairs A A a b + g * (pairs A u a b + pairs u A a b + g * pairs u u a b).
  Proof.
    intros g A u a b C. unfold Flow.pairs. rewrite <- (total_scaled K n g), <- !total_add.
    rewrite <- total_scaled, <- total_add. apply total_same. intros i _.
    assert (slope : forall c x y, d c (x + g * y) == d c x + g * d c y).
    { intros c x y. rewrite derivation_add, derivation_mul, (C c). ring. }
    unfold wedge. rewrite !slope. ring.
  Qed.

  Lemma pairs_scaled : forall x A B a b,
    pairs (fun i => rational x * A i) B a b == rational x * pairs A B a b
    /\ pairs A (fun i => rational x * B i) a b == rational x * pairs A B a b.
  Proof.
    intros x A B a b. unfold Flow.pairs. rewrite <- !total_scaled.
    split; apply total_same; intros i _; unfold wedge;
      rewrite !derivation_mul, !derivation_rational; ring.
  Qed.

  (** A number for each coordinate, picked by the slopes of the coordinates. *)
  Lemma picked : forall (g : nat -> K) a, (a < 2 * n)%nat ->
    total n (fun i => g i * d a (coordinate s i) + g (n + i)%nat * d a (coordinate s (n + i)))
    == g a.
  Proof.
    intros g a L. destruct (Nat.lt_ge_cases a n) as [La|La].
    - rewrite (total_one K n a) by
        (try exact La; intros i Li N; rewrite !other_slope by lia; ring).
      rewrite own_slope, other_slope by lia. ring.
    - rewrite (total_one K n (a - n)) by
        (try lia; intros i Li N; rewrite !other_slope by lia; ring).
      replace (n + (a - n))%nat with a by lia.
      rewrite own_slope, other_slope by lia. ring.
  Qed.

  Lemma along_flow_coordinate : forall i, (i < n)%nat ->
    D (coordinate s i) == - d (n + i)%nat H /\ D (coordinate s (n + i)) == d i H.
  Proof.
    intros i L. unfold along_flow, along_field. split.
    - rewrite (total_one K n i) by
        (try exact L; intros k Lk N; rewrite !other_slope by lia; ring).
      rewrite own_slope, !other_slope by lia. ring.
    - rewrite (total_one K n i) by
        (try exact L; intros k Lk N; rewrite !other_slope by lia; ring).
      rewrite own_slope, !other_slope by lia. ring.
  Qed.

  (** The flow keeps the canonical form. *)
  Lemma canonical_is_kept : forall a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    lie canonical a b == zero.
  Proof.
    intros a b La Lb. unfold canonical. rewrite lie_derivative_of_pairs.
    transitivity (d b (d a H) - d a (d b H)); [|rewrite (derivations_commute K a b H); ring].
    rewrite <- (picked (fun i => d b (d i H)) a La) at 1.
    rewrite <- (picked (fun i => d a (d i H)) b Lb).
    unfold Flow.pairs. rewrite <- total_add, <- total_sub. apply total_same. intros i L.
    unfold wedge. destruct (along_flow_coordinate i L) as [-> ->].
    rewrite !derivation_opp. ring.
  Qed.

  (** L_D of the m-th coefficient is m + 1 times the next: D (D^k/k!) = (k + 1) D^(k+1)/(k+1)!. *)
  Lemma lie_derivative_of_coefficient : forall m a b,
    lie (defect_coefficient flow_series m) a b
    == whole (S m) * defect_coefficient flow_series (S m) a b.
  Proof.
    intros m a b. unfold defect_coefficient. rewrite lie_derivative_total.
    set (W := fun k l => paired flow_series k l a b).
    transitivity (total (S m) (fun k => whole (S k) * W (S k) (m - k)%nat
      + whole (S (m - k)) * W k (S (m - k)))).
    - apply total_same. intros k L. unfold paired. rewrite lie_derivative_of_pairs.
      apply add_extends.
      + etransitivity; [|exact (proj1 (pairs_scaled _ _ _ a b))]. apply pairs_same; [|reflexivity].
        intro i. apply along_flow_coefficient.
      + etransitivity; [|exact (proj2 (pairs_scaled _ _ _ a b))]. apply pairs_same; [reflexivity|].
        intro i. apply along_flow_coefficient.
    - rewrite total_add, <- total_scaled.
      rewrite (total_same K (S (S m)) _ (fun k => whole k * W k (S m - k)%nat
        + whole (S m - k) * W k (S m - k)%nat)).
      + rewrite total_add. apply add_extends.
        * rewrite (total_first K (S m) (fun k => whole k * W k (S m - k)%nat)).
          unfold whole at 2. change (Z.of_nat 0 # 1) with 0%Q. rewrite rational_zero.
          simpl Nat.sub. ring.
        * change (total (S (S m)) (fun k => whole (S m - k) * W k (S m - k)%nat)) with
            (total (S m) (fun k => whole (S m - k) * W k (S m - k)%nat)
             + whole (S m - S m) * W (S m) (S m - S m)%nat).
          replace (S m - S m)%nat with O by lia. unfold whole at 3.
          change (Z.of_nat 0 # 1) with 0%Q. rewrite rational_zero.
          rewrite (total_same K (S m) (fun k => whole (S m - k) * W k (S m - k)%nat)
            (fun k => whole (S (m - k)) * W k (S (m - k)))); [ring|].
          intros k L. replace (S m - k)%nat with (S (m - k)) by lia. reflexivity.
      + intros k L. fold (W k (S m - k)%nat).
        replace (S m) with (k + (S m - k))%nat at 1 by lia. rewrite whole_add. ring.
  Qed.

  (** All of them but the first are 0, as the flow keeps the form. *)
  Theorem flow_has_no_defect : forall m a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    defect_coefficient flow_series (S m) a b == zero.
  Proof.
    induction m as [|m IH]; intros a b La Lb.
    - apply (no_torsion 0). rewrite <- lie_derivative_of_coefficient.
      rewrite (lie_derivative_same K s _ canonical) by
        (try assumption; intros; unfold defect_coefficient, paired; simpl; ring_simplify;
         reflexivity).
      apply canonical_is_kept; assumption.
    - apply (no_torsion (S m)). rewrite <- lie_derivative_of_coefficient.
      rewrite (lie_derivative_same K s _ (fun _ _ => zero)) by assumption.
      apply lie_derivative_zero.
  Qed.
End Taylor.
