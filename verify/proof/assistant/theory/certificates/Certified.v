(** What follows for the elements of a ring when the formulas of a certificate are 0 there. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith List Bool Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor Formulas Identities.
Import ListNotations.
Local Open Scope nat_scope.

(** The names of a certificate stand for these elements, the coordinates first. *)
Record interprets (K : differential_ring) (s : system K) (x : certificate) (names : list K) := {
  same_degrees : degrees s = of_degrees x;
  names_coordinates : forall c, c <= 2 * of_degrees x ->
    same (named names (Pos.of_succ_nat c)) (coordinate s c);
  names_slopes : forall a k, a <= 2 * of_degrees x -> has_slope x k = true ->
    same (by_coordinate a (named names k)) (value_of names (slope_of_name x a k));
  names_energy : forall a, a < 2 * of_degrees x ->
    same (value_of names (slope_of_energy x a)) (by_coordinate a (hamiltonian s));
}.

Section Certified.
  Context (K : differential_ring) (s : system K) (x : certificate) (names : list K).
  Context (meaning : interprets K s x names) (sloped : all_have_slopes x = true).
  Add Ring certified : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (of_degrees x).
  Notation D := (along_flow K s).
  Notation value := (@value_of K names).

  Notation ok := (uses (has_slope x)).

  Lemma term_ok : forall k c, ok (term x k c) = true.
  Proof.
    intros k c. unfold all_have_slopes in sloped. rewrite !andb_true_iff in sloped.
    destruct sloped as [[series_ok _] _]. unfold term.
    destruct (Nat.lt_ge_cases c (length (series x))) as [L|L].
    - rewrite forallb_forall in series_ok.
      assert (row_ok := series_ok _ (nth_In _ [] L)). rewrite forallb_forall in row_ok.
      destruct (Nat.lt_ge_cases k (length (nth c (series x) []))) as [M|M].
      + apply row_ok, nth_In, M.
      + rewrite (nth_overflow (nth c (series x) [])) by exact M. reflexivity.
    - rewrite (nth_overflow (series x)) by exact L. destruct k; reflexivity.
  Qed.

  Lemma energy_ok : forall a, (a < 2 * n)%nat -> ok (slope_of_energy x a) = true.
  Proof.
    intros a L. unfold all_have_slopes in sloped. rewrite !andb_true_iff in sloped.
    destruct sloped as [[_ energy_ok] _]. rewrite forallb_forall in energy_ok.
    apply energy_ok, in_seq. lia.
  Qed.

  Lemma pair_listed : forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    In (a, b) (pairs_of_coordinates n).
  Proof.
    intros a b L Lb. unfold pairs_of_coordinates. apply filter_In. split.
    - apply in_prod; apply in_seq; lia.
    - apply Nat.ltb_lt, L.
  Qed.

  Lemma form_ok : forall w a b, primitive x = Some w -> (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    ok (form_formula w a b) = true.
  Proof.
    intros w a b W La Lb. unfold all_have_slopes in sloped. rewrite !andb_true_iff, W in sloped.
    destruct sloped as [_ entries_ok]. rewrite forallb_forall in entries_ok. unfold two_form.
    destruct (Nat.ltb_spec a b) as [L|L].
    - exact (entries_ok _ (pair_listed a b L Lb)).
    - destruct (Nat.ltb_spec b a) as [M|M]; [|reflexivity].
      exact (entries_ok _ (pair_listed b a M La)).
  Qed.

  Lemma value_of_slope : forall a f, (a <= 2 * n)%nat -> ok f = true ->
    by_coordinate a (value f) == value (slope x a f).
  Proof.
    intros a f L. apply derivative_is. intro k. apply (names_slopes _ _ _ _ meaning), L.
  Qed.

  Lemma value_of_flow : forall f, ok f = true -> D (value f) == value (flow_formula x f).
  Proof.
    intros f F. unfold along_flow, along_field, flow_formula. rewrite (same_degrees _ _ _ _ meaning).
    cbn [value_of]. rewrite value_of_slope by (lia || exact F). apply add_extends; [reflexivity|].
    rewrite (value_of_sum_up_to K). apply total_same. intros i L. cbn [value_of].
    rewrite !(names_energy _ _ _ _ meaning), !value_of_slope by (lia || exact F). reflexivity.
  Qed.

  Lemma value_of_wedge : forall f g a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    ok f = true -> ok g = true ->
    wedge K (value f) (value g) a b == value (wedge_formula x f g a b).
  Proof.
    intros f g a b La Lb F G. unfold wedge, wedge_formula. cbn [value_of].
    rewrite !value_of_slope by (lia || assumption). reflexivity.
  Qed.

  Lemma value_of_defect : forall m a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    defect_coefficient K s (fun k c => value (term x k c)) m a b == value (defect_formula x m a b).
  Proof.
    intros m a b La Lb. unfold defect_coefficient, defect_formula, paired, pairs.
    rewrite (value_of_sum_up_to K). apply total_same. intros k _.
    rewrite (value_of_sum_up_to K), (same_degrees _ _ _ _ meaning). apply total_same. intros i _.
    apply value_of_wedge; assumption || apply term_ok.
  Qed.

  Lemma value_of_lie : forall w a b, primitive x = Some w ->
    (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    lie_derivative K s (fun a b => value (form_formula w a b)) a b == value (lie_formula x w a b).
  Proof.
    intros w a b W La Lb. unfold lie_derivative, lie_formula. cbn [value_of].
    rewrite value_of_flow by (apply form_ok; assumption). apply add_extends; [reflexivity|].
    rewrite (value_of_sum_up_to K), (same_degrees _ _ _ _ meaning). apply total_same. intros i L.
    assert (E : forall c d, (c <= 2 * n)%nat -> (d < 2 * n)%nat -> by_coordinate c
        (by_coordinate d (hamiltonian s)) == value (slope x c (slope_of_energy x d))).
    { intros c d Lc Ld. etransitivity; [|apply value_of_slope; [exact Lc|apply energy_ok, Ld]].
      apply derivation_extends. symmetry. apply (names_energy _ _ _ _ meaning), Ld. }
    cbn [value_of].
    apply add_extends; apply sub_extends; apply mul_extends; reflexivity || (apply E; lia).
  Qed.

  (** A gap is 0 where the two sides are the same. *)
  Lemma gap_closed : forall f g, value (Minus f g) == zero -> value f == value g.
  Proof.
    intros f g E. cbn [value_of] in E. transitivity (value f - value g + value g); [ring|].
    rewrite E. ring.
  Qed.

  Theorem agrees_with_flow : (forall f, In f (flow_gaps x) -> value f == zero) ->
    forall k c, (k <= agreement x)%nat -> (c < 2 * n)%nat ->
    value (term x k c) == flow_series K s k c.
  Proof.
    intros E k c Lk Lc. unfold flow_series. induction k as [|k IH].
    - transitivity (value (coordinate_name c)).
      + apply gap_closed, E. unfold flow_gaps. apply in_flat_map. exists c.
        rewrite in_seq. split; [lia|left; reflexivity].
      + apply (names_coordinates _ _ _ _ meaning). lia.
    - apply (no_torsion_same K k). rewrite <- along_flow_coefficient, <- IH by lia.
      rewrite value_of_flow by apply term_ok.
      apply (gap_closed (Times (Number (Z.of_nat (S k) # 1)) (term x (S k) c))), E.
      unfold flow_gaps. apply in_flat_map. exists c. rewrite in_seq. split; [lia|right].
      apply in_map_iff. exists k. rewrite in_seq.
      split; [reflexivity|lia].
  Qed.

  Lemma defect_of_same : forall A B m a b,
    (forall k c, (k <= m)%nat -> (c < 2 * n)%nat -> A k c == B k c) ->
    defect_coefficient K s A m a b == defect_coefficient K s B m a b.
  Proof.
    intros A B m a b E. apply total_same. intros k L. unfold paired, pairs.
    rewrite (same_degrees _ _ _ _ meaning). apply total_same. intros i Li.
    rewrite (E k i), (E (m - k)%nat (n + i)%nat) by lia. reflexivity.
  Qed.

  (** Of every map that has these coefficients up to the last known one. *)
  Theorem defect_is_known : (forall f, In f (defect_gaps x) -> value f == zero) ->
    forall A : nat -> nat -> K,
    (forall k c, (k <= known x)%nat -> (c < 2 * n)%nat -> A k c == value (term x k c)) ->
    forall m a b, (1 <= m <= known x)%nat -> (a < b)%nat -> (b < 2 * n)%nat ->
    defect_coefficient K s A m a b == value (expected x m a b).
  Proof.
    intros E A EA m a b Lm L Lb.
    rewrite (defect_of_same A (fun k c => value (term x k c))) by (intros; apply EA; lia).
    rewrite value_of_defect by lia. apply gap_closed, E. unfold defect_gaps.
    apply in_flat_map. exists m. rewrite in_seq. split; [lia|].
    apply in_map_iff. exists (a, b). split; [reflexivity|]. apply pair_listed; assumption.
  Qed.

  Theorem primitive_is : forall w, primitive x = Some w ->
    (forall f, In f (primitive_gaps x) -> value f == zero) ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    lie_derivative K s (fun a b => value (form_formula w a b)) a b == value (leading_entry x a b).
  Proof.
    intros w W E a b L Lb. rewrite value_of_lie by (exact W || lia). apply gap_closed, E.
    unfold primitive_gaps. rewrite W. apply in_map_iff. exists (a, b).
    split; [reflexivity|]. apply pair_listed; assumption.
  Qed.
End Certified.
