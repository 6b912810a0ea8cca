(** A certificate by coefficients: rational numbers, and polynomials in algebraic ones. *)

From Coq Require Import Reals QArith List Bool Lia Lra.
From AreaPreservation Require Import Rings Formulas Calculation RealFormulas RungeKutta StageSchemes.
Import ListNotations.
Local Open Scope nat_scope.

Section Coefficients.
  Context (numbers : list R) (relations : list formula).
  Context (hold : forall f, In f relations -> @value_of real_numbers numbers f = 0%R).
  Notation value f := (@value_of real_numbers numbers f).

  (** One coefficient after the other: kick, drift, share of p', share of q', time. *)
  Definition stage_of (row : list formula) : stage :=
    let at_ k := value (nth k row (Number 0)) in
    {| kick_by := at_ 0; drift_by := at_ 1; share_p := at_ 2; share_q := at_ 3; moment := at_ 4 |}.

  Definition stage_gaps (separable : bool) (row : list formula) : list formula :=
    let at_ k := nth k row (Number 0) in
    [Times (Times (at_ 0) (at_ 1)) (Minus (Minus (Number 1) (at_ 2)) (at_ 3));
     if separable then Number 0 else Minus (at_ 0) (at_ 1)].

  Theorem stages_hold : forall separable rows factors,
    all_vanish relations (flat_map (stage_gaps separable) rows) factors = true ->
    Forall (stage_holds separable) (map stage_of rows).
  Proof.
    intros separable rows factors E. apply Forall_forall. intros s S.
    apply in_map_iff in S. destruct S as [row [<- I]].
    assert (Z : forall f, In f (stage_gaps separable row) -> value f = 0%R).
    { intros f F. apply (calculated real_numbers numbers relations _ factors hold E).
      apply in_flat_map. exists row. split; assumption. }
    split.
    - exact (Z _ (or_introl eq_refl)).
    - intros ->. assert (D := Z _ (or_intror (or_introl eq_refl))). simpl in D. simpl. lra.
  Qed.

  (** b_i a_ij + b_j a_ji - b_i b_j. *)
  Definition weight_gap (a : list (list formula)) (b : list formula) (i j : nat) : formula :=
    let a_ i j := nth j (nth i a []) (Number 0) in
    let b_ i := nth i b (Number 0) in
    Minus (Plus (Times (b_ i) (a_ i j)) (Times (b_ j) (a_ j i))) (Times (b_ i) (b_ j)).

  Definition weight_gaps (a : list (list formula)) (b : list formula) : list formula :=
    let all := seq 0 (length b) in
    map (fun ij => weight_gap a b (fst ij) (snd ij)) (list_prod all all).

  Definition matrix_of (a : list (list formula)) (i j : nat) : R :=
    nth j (nth i (map (map (fun f => value f)) a) []) 0%R.

  Definition weights_of (b : list formula) (i : nat) : R := nth i (map (fun f => value f) b) 0%R.

  Lemma weight_is : forall b i, weights_of b i = value (nth i b (Number 0)).
  Proof.
    intros b i. unfold weights_of. change 0%R with (value (Number 0)).
    apply (map_nth (fun f => value f)).
  Qed.

  Lemma matrix_is : forall a i j, matrix_of a i j = value (nth j (nth i a []) (Number 0)).
  Proof.
    intros a i j. unfold matrix_of.
    replace (nth i (map (map (fun f => value f)) a) []) with (map (fun f => value f) (nth i a []))
      by (symmetry; exact (map_nth (map (fun f => value f)) a [] i)).
    exact (weight_is (nth i a []) j).
  Qed.

  Theorem weights_are_symplectic : forall a b factors,
    all_vanish relations (weight_gaps a b) factors = true ->
    symplectic_weights (length b) (matrix_of a) (weights_of b).
  Proof.
    intros a b factors E i j Li Lj. rewrite !weight_is, !matrix_is.
    apply (calculated real_numbers numbers relations _ factors hold E (weight_gap a b i j)).
    apply in_map_iff. exists (i, j). split; [reflexivity|]. apply in_prod; apply in_seq; lia.
  Qed.
End Coefficients.
