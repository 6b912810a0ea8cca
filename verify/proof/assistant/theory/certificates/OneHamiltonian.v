(** A certificate for one H over the real numbers: what its formulas say of the functions of the
    point, where no denominator is 0. *)

From Coq Require Import Reals Rtrigo_reg QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Rings Totals Flow Formulas Taylor Smooth Systems Identities Certified RealFormulas RealNames.
Import ListNotations.
Local Open Scope nat_scope.

Section OneHamiltonian.
  Context (v : vocabulary) (made_well : well_made v = true) (given : list R).
  Context (enough : length given = parameters v).
  Context (n : nat) (size : dimension v = 2 * n + 1) (energy : formula).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).

  Definition inside : point -> Prop := defined_at v given.

  Lemma inside_is_open : is_open (2 * n + 1) inside.
  Proof. rewrite <- size. apply defined_is_open; assumption. Qed.

  Definition derived_formula (l : list nat) (f : formula) : formula :=
    fold_left (fun g a => derivative (slope_of_real v a) g) l f.

  Lemma family_of_formula : forall f,
    is_family (2 * n + 1) inside (fun l x => value_at x (derived_formula l f)).
  Proof.
    intros f l x I. unfold derived_formula.
    apply (slopes_of_equal_slopes _ _ _ (fun a => value_at x
      (derivative (slope_of_real v a) (derived_formula l f)))).
    - rewrite <- size. apply formulas_have_slopes; assumption.
    - intros i _. rewrite fold_left_app. reflexivity.
  Qed.

  (** The function that a formula is. *)
  Definition element (f : formula) : smooth (2 * n + 1) inside :=
    {| family := fun l x => value_at x (derived_formula l f); family_slopes := family_of_formula f |}.

  Lemma slope_of_formula : forall a f x, a <= 2 * n ->
    value (smooth_derivative a (element f)) x = value_at x (derivative (slope_of_real v a) f).
  Proof.
    intros a f x L. transitivity ((if a <? 2 * n + 1
      then fun x => value_at x (derivative (slope_of_real v a) f) else fun _ => 0%R) x).
    - reflexivity.
    - rewrite (proj2 (Nat.ltb_lt a (2 * n + 1))) by lia. reflexivity.
  Qed.

  Notation K := (smooth_ring (2 * n + 1) inside inside_is_open).

  Definition system_of_energy : system K := smooth_system n inside inside_is_open (element energy).

  Definition elements : list K :=
    map (fun j => element (Name (Pos.of_succ_nat j))) (seq 0 (2 * n + 1 + parameters v + length (made v))).

  Lemma value_of_named_element : forall k x,
    value (@named K elements k) x = @named real_numbers (names_at v given x) k.
  Proof.
    intros k x. rewrite (positive_is k). set (j := pred (Pos.to_nat k)).
    rewrite named_is_nth.
    assert (E : @named K elements (Pos.of_succ_nat j)
      = nth j elements (@zero K)) by (exact (nth_at_position K elements j)).
    rewrite E. unfold elements.
    destruct (Nat.lt_ge_cases j (2 * n + 1 + parameters v + length (made v))) as [L|L].
    - rewrite (nth_indep _ (@zero K) (element (Name (Pos.of_succ_nat 0)))) by
        (rewrite map_length, seq_length; exact L).
      rewrite (map_nth (fun j => element (Name (Pos.of_succ_nat j)))), seq_nth by exact L.
      simpl. unfold value, element, derived_formula. simpl. apply named_is_nth.
    - rewrite !nth_overflow; [reflexivity| |].
      + rewrite names_length by assumption. rewrite size. exact L.
      + rewrite map_length, seq_length. exact L.
  Qed.

  (** The value of a formula in the ring of functions is that formula of the values. *)
  Theorem value_of_element : forall f x,
    value (@value_of K elements f) x = value_at x f.
  Proof.
    intros f x. induction f; simpl value_of.
    - symmetry. apply real_of_is.
    - apply value_of_named_element.
    - rewrite <- IHf1, <- IHf2. reflexivity.
    - rewrite <- IHf1, <- IHf2. reflexivity.
    - rewrite <- IHf1, <- IHf2. reflexivity.
    - rewrite <- IHf. reflexivity.
    - rewrite <- IHf. clear IHf. induction k as [|k IH]; [reflexivity|].
      change (value (@value_of K elements f) x * value (power K (@value_of K elements f) k) x
        = value (@value_of K elements f) x
          * power real_numbers (value (@value_of K elements f) x) k)%R.
      apply f_equal. exact IH.
  Qed.

  Lemma slope_of_element : forall a f, a <= 2 * n -> forall x, inside x ->
    value (@by_coordinate K a (@value_of K elements f)) x
    = value_at x (derivative (slope_of_real v a) f).
  Proof.
    intros a f L x I.
    transitivity (value (@by_coordinate K a (element f)) x).
    - apply (derivation_extends K a (@value_of K elements f) (element f)); [|exact I].
      intros y _. apply value_of_element.
    - apply slope_of_formula, L.
  Qed.

  (** The formulas mean what they say. *)
  Theorem one_interprets : forall x,
    of_degrees x = n -> slope_of_name x = slope_of_real v -> has_slope x = (fun _ => true) ->
    (forall a z, a < 2 * n -> inside z ->
      value_at z (slope_of_energy x a) = value_at z (derivative (slope_of_real v a) energy)) ->
    interprets K system_of_energy x elements.
  Proof.
    intros x En Es Ek Eh. constructor; rewrite ?En, ?Es, ?Ek.
    - reflexivity.
    - intros c L y I. rewrite value_of_named_element, named_is_nth.
      rewrite (names_first v given enough) by (rewrite size; lia).
      rewrite app_nth1 by (rewrite map_length, seq_length, size; lia).
      rewrite (nth_indep _ 0%R (y 0)) by (rewrite map_length, seq_length, size; lia).
      rewrite map_nth, seq_nth by (rewrite size; lia). symmetry.
      apply value_coordinate. lia.
    - intros a k L _ y I. rewrite value_of_element.
      exact (slope_of_element a (Name k) L y I).
    - intros a L y I. rewrite value_of_element, (Eh a y L I). symmetry.
      apply slope_of_formula. lia.
  Qed.

End OneHamiltonian.
