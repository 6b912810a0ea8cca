(** What the names of a vocabulary stand for has the slopes that are told, where no denominator is
    0; and that is an open set. *)

From Coq Require Import Reals Rtrigo_reg QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Rings Formulas RealFormulas.
Import ListNotations.
Local Open Scope nat_scope.

Section RealNames.
  Context (v : vocabulary) (made_well : well_made v = true) (given : list R).
  Context (enough : length given = parameters v).
  Notation N := (dimension v).
  Notation base := (dimension v + parameters v).
  Notation names := (names_at v given).
  Notation value := (@value_of real_numbers).

  Lemma extended_length : forall l known,
    length (fold_left extended l known) = length known + length l.
  Proof.
    induction l as [|m l IH]; intro known; simpl; [lia|].
    rewrite IH. unfold extended. rewrite app_length. simpl. lia.
  Qed.

  Lemma first_length : forall x, length (map x (seq 0 N) ++ given) = base.
  Proof. intro x. rewrite app_length, map_length, seq_length, enough. reflexivity. Qed.

  Lemma names_length : forall x, length (names x) = base + length (made v).
  Proof. intro x. unfold names_at. rewrite extended_length, first_length. reflexivity. Qed.

  (** Later functions leave the names before them alone. *)
  Lemma extended_prefix : forall l known i, i < length known ->
    nth i (fold_left extended l known) 0%R = nth i known 0%R.
  Proof.
    induction l as [|m l IH]; intros known i L; simpl; [reflexivity|].
    rewrite IH by (unfold extended; rewrite app_length; simpl; lia).
    unfold extended. apply app_nth1, L.
  Qed.

  Lemma names_first : forall x i, i < base -> nth i (names x) 0%R = nth i (map x (seq 0 N) ++ given) 0%R.
  Proof. intros x i L. apply extended_prefix. rewrite first_length. exact L. Qed.

  Lemma well_made_at : forall j m, nth_error (made v) j = Some m ->
    uses (fun k => pred (Pos.to_nat k) <? base + j) (snd m) = true /\
    match fst m with
    | Sine c => is_at v c (fun k => match k with Cosine _ => true | _ => false end) (snd m) = true
    | Cosine s => is_at v s (fun k => match k with Sine _ => true | _ => false end) (snd m) = true
    | _ => True
    end.
  Proof.
    intros j m E. unfold well_made in made_well. rewrite forallb_forall in made_well.
    assert (I : In (j, m) (combine (seq 0 (length (made v))) (made v))).
    { assert (L : j < length (made v)) by (apply nth_error_Some; rewrite E; discriminate).
      assert (P : nth j (combine (seq 0 (length (made v))) (made v)) (0, m) = (j, m)).
      { rewrite combine_nth by apply seq_length. rewrite seq_nth by exact L.
        rewrite (nth_error_nth _ _ _ E). reflexivity. }
      rewrite <- P. apply nth_In. rewrite combine_length, seq_length. lia. }
    specialize (made_well _ I). simpl in made_well. apply andb_prop in made_well.
    destruct made_well as [U W]. split; [exact U|]. destruct (fst m); exact W || exact Logic.I.
  Qed.

  (** Each function has the value that it says. *)
  Lemma names_made : forall x j m, nth_error (made v) j = Some m ->
    nth (base + j) (names x) 0%R = applied (fst m) (value (names x) (snd m)).
  Proof.
    intros x j m E.
    assert (S := E). apply nth_error_split in S. destruct S as [l [r [made_is L]]].
    set (known := fold_left extended l (map x (seq 0 N) ++ given)).
    assert (K : length known = base + j).
    { unfold known. rewrite extended_length, first_length, L. reflexivity. }
    assert (all : names x = fold_left extended r (extended known m)).
    { unfold names_at, known. rewrite made_is, fold_left_app. reflexivity. }
    transitivity (applied (fst m) (value known (snd m))).
    - rewrite all, extended_prefix by (unfold extended; rewrite app_length; simpl; lia).
      unfold extended. rewrite app_nth2 by lia. replace (base + j - length known) with 0 by lia.
      reflexivity.
    - f_equal. destruct (well_made_at j m E) as [U _].
      apply (value_of_same_names _ _ _ _ U). intros k Lk. apply Nat.ltb_lt in Lk.
      rewrite !named_is, all, extended_prefix by (unfold extended; rewrite app_length; simpl; lia).
      unfold extended. symmetry. apply app_nth1. lia.
  Qed.

  Lemma partner : forall j m k right, nth_error (made v) j = Some m ->
    is_at v k right (snd m) = true -> exists m' : kind * formula, right (fst m') = true /\
    forall x, @named real_numbers (names x) k = applied (fst m') (value (names x) (snd m)).
  Proof.
    intros j m k right E A. unfold is_at in A. apply andb_prop in A. destruct A as [B A].
    apply Nat.leb_le in B.
    destruct (nth_error (made v) (pred (Pos.to_nat k) - base)) as [m'|] eqn:E'; [|discriminate].
    apply andb_prop in A. destruct A as [Rt A]. apply equal_formulas_equal in A.
    exists m'. split; [exact Rt|]. intro x. rewrite named_is.
    replace (pred (Pos.to_nat k)) with (base + (pred (Pos.to_nat k) - base)) by lia.
    rewrite (names_made x _ _ E'), A. reflexivity.
  Qed.

  (** The relations hold. *)
  Theorem relations_hold : forall x, defined_at v given x -> forall f, In f (relations_of v) ->
    value (names x) f = 0%R.
  Proof.
    intros x D f F. unfold relations_of in F. apply in_map_iff in F.
    destruct F as [[j m] [<- I]]. simpl.
    assert (E : nth_error (made v) j = Some m).
    { apply In_nth with (d := (0, m)) in I. destruct I as [i [L P]].
      rewrite combine_length, seq_length in L.
      rewrite combine_nth, seq_nth in P by (try apply seq_length; lia).
      injection P as P1 P2. simpl in P1. subst i. rewrite <- P2. apply nth_error_nth'. lia. }
    assert (own : @named real_numbers (names x) (Pos.of_succ_nat (base + j))
      = applied (fst m) (value (names x) (snd m))).
    { rewrite named_is_nth. apply names_made, E. }
    destruct (well_made_at j m E) as [_ W]. unfold relation_of.
    destruct m as [[c|s| |] argument]; simpl fst in *; simpl snd in *; cbn [value_of];
      change (@zero real_numbers) with 0%R; simpl; unfold real_of; simpl.
    - destruct (partner j _ c _ E W) as [[[]] [Rt Pt]]; try discriminate Rt.
      rewrite own, Pt. simpl. assert (T := sin2_cos2 (value (names x) argument)).
      unfold Rsqr in T. lra.
    - destruct (partner j _ s _ E W) as [[[]] [Rt Pt]]; try discriminate Rt.
      rewrite own, Pt. simpl. assert (T := sin2_cos2 (value (names x) argument)).
      unfold Rsqr in T. lra.
    - lra.
    - rewrite own. simpl. assert (Z := D _ (nth_error_In _ _ E) eq_refl). simpl in Z.
      rewrite Rinv_l by exact Z. lra.
  Qed.

  Definition slope_of_real (a : nat) (k : positive) : formula := looked_up (slope_table v a) k.

  Lemma table_length : forall l table, length (fold_left with_slope l table) = length table + length l.
  Proof.
    induction l as [|m l IH]; intro table; simpl; [lia|].
    rewrite IH. unfold with_slope. rewrite app_length. simpl. lia.
  Qed.

  Lemma table_prefix : forall l table i, i < length table ->
    nth i (fold_left with_slope l table) (Number 0) = nth i table (Number 0).
  Proof.
    induction l as [|m l IH]; intros table i L; simpl; [reflexivity|].
    rewrite IH by (unfold with_slope; rewrite app_length; simpl; lia).
    unfold with_slope. apply app_nth1, L.
  Qed.

  Lemma derivative_same : forall slope slope' known f, uses known f = true ->
    (forall k, known k = true -> slope k = slope' k) -> derivative slope f = derivative slope' f.
  Proof.
    intros slope slope' known f U E. induction f; simpl in *;
      try (apply andb_prop in U; destruct U as [U1 U2]; rewrite (IHf1 U1), (IHf2 U2)); try reflexivity.
    - apply E, U.
    - rewrite (IHf U). reflexivity.
    - destruct k; [reflexivity|]. rewrite (IHf U). reflexivity.
  Qed.

  Definition table_start (a : nat) : list formula :=
    map (fun c => Number (if c =? a then 1 else 0)) (seq 0 N)
    ++ map (fun _ => Number 0) (seq 0 (parameters v)).

  Lemma start_length : forall a, length (table_start a) = base.
  Proof. intro a. unfold table_start. rewrite app_length, !map_length, !seq_length. reflexivity. Qed.

  Lemma slope_of_made : forall a j m, nth_error (made v) j = Some m ->
    nth (base + j) (slope_table v a) (Number 0)
    = outer_slope (base + j) (fst m) (derivative (slope_of_real a) (snd m)).
  Proof.
    intros a j m E. assert (S := E). apply nth_error_split in S. destruct S as [l [r [made_is L]]].
    set (table := fold_left with_slope l (table_start a)).
    assert (T : length table = base + j).
    { unfold table. rewrite table_length, start_length, L. reflexivity. }
    assert (all : slope_table v a = fold_left with_slope r (with_slope table m)).
    { unfold slope_table, table. rewrite made_is, fold_left_app. reflexivity. }
    rewrite all, table_prefix by (unfold with_slope; rewrite app_length; simpl; lia).
    unfold with_slope. rewrite app_nth2 by lia. replace (base + j - length table) with 0 by lia.
    simpl. rewrite T. f_equal. destruct (well_made_at j m E) as [U _].
    apply (derivative_same _ _ _ _ U). intros k Lk. apply Nat.ltb_lt in Lk.
    unfold slope_of_real, looked_up. rewrite all, table_prefix.
    - unfold with_slope. symmetry. apply app_nth1. lia.
    - unfold with_slope. rewrite app_length. simpl. lia.
  Qed.

  Lemma slope_of_first : forall a i, i < base ->
    nth i (slope_table v a) (Number 0) = nth i (table_start a) (Number 0).
  Proof. intros a i L. apply table_prefix. rewrite start_length. exact L. Qed.

  Lemma nth_of_zeros : forall (l : list nat) i,
    nth i (map (fun _ => Number 0) l) (Number 0) = Number 0.
  Proof. induction l as [|c l IH]; intros [|i]; simpl; auto. Qed.

  (** Every name has the slopes that are told, where no denominator is 0. *)
  Theorem names_have_slopes : forall x, defined_at v given x -> forall k,
    has_slopes N (fun y => @named real_numbers (names y) k) x
      (fun a => value (names x) (slope_of_real a k)).
  Proof.
    intros x D.
    assert (by_number : forall i, has_slopes N (fun y => nth i (names y) 0%R) x
      (fun a => value (names x) (nth i (slope_table v a) (Number 0)))).
    { induction i as [i IH] using lt_wf_ind.
      destruct (Nat.lt_ge_cases i base) as [L|L].
      - apply (slopes_of_equal N (fun y => nth i (map y (seq 0 N) ++ given) 0%R));
          [intro y; apply names_first, L|].
        destruct (Nat.lt_ge_cases i N) as [M|M].
        + apply (slopes_of_equal N (fun y => y i)).
          { intro y. rewrite app_nth1 by (rewrite map_length, seq_length; exact M).
            rewrite (nth_indep _ 0%R (y 0)) by (rewrite map_length, seq_length; exact M).
            rewrite map_nth, seq_nth by exact M. reflexivity. }
          apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_coordinate N i x M)).
          intros a _. rewrite slope_of_first by exact L. unfold table_start.
          rewrite app_nth1 by (rewrite map_length, seq_length; exact M).
          set (g := fun c => Number (if c =? a then 1 else 0)).
          rewrite (nth_indep _ (Number 0) (g 0)) by (rewrite map_length, seq_length; exact M).
          rewrite map_nth, seq_nth by exact M. simpl. unfold pick.
          rewrite (Nat.eqb_sym a i). destruct (i =? a); unfold real_of; simpl; lra.
        + apply (slopes_of_equal N (fun _ => nth (i - N) given 0%R)).
          { intro y. rewrite app_nth2; rewrite map_length, seq_length; [reflexivity|exact M]. }
          apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_constant N _ x)).
          intros a _. rewrite slope_of_first by exact L. unfold table_start.
          rewrite app_nth2; rewrite map_length, seq_length; [|exact M].
          rewrite nth_of_zeros. simpl. unfold real_of. simpl. lra.
      - destruct (nth_error (made v) (i - base)) as [m|] eqn:E.
        + replace i with (base + (i - base)) by lia. set (j := i - base) in *.
          apply (slopes_of_equal N (fun y => applied (fst m) (value (names y) (snd m))));
            [intro y; apply names_made, E|].
          destruct (well_made_at j m E) as [U W].
          assert (inner : has_slopes N (fun y => value (names y) (snd m)) x
            (fun a => value (names x) (derivative (slope_of_real a) (snd m)))).
          { apply (slopes_of_formula N names slope_of_real _ x) with (2 := U).
            intros k Lk. apply Nat.ltb_lt in Lk.
            apply (slopes_of_equal N (fun y => nth (pred (Pos.to_nat k)) (names y) 0%R));
              [intro y; apply named_is|]. apply IH. lia. }
          assert (own : @named real_numbers (names x) (Pos.of_succ_nat (base + j))
            = applied (fst m) (value (names x) (snd m))).
          { rewrite named_is_nth. apply names_made, E. }
          destruct m as [kind argument]. simpl fst in *. simpl snd in *.
          destruct kind as [c|s| |]; simpl in inner |- *.
          * destruct (partner j _ c _ E W) as [[[]] [Rt Pt]]; try discriminate Rt.
            apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_real_function N sin _ _ x _ inner
              (derivable_pt_lim_sin _))).
            intros a _. rewrite (slope_of_made a j _ E). simpl. rewrite Pt. reflexivity.
          * destruct (partner j _ s _ E W) as [[[]] [Rt Pt]]; try discriminate Rt.
            apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_real_function N cos _ _ x _ inner
              (derivable_pt_lim_cos _))).
            intros a _. rewrite (slope_of_made a j _ E). simpl. rewrite Pt. simpl. ring.
          * apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_real_function N exp _ _ x _ inner
              (derivable_pt_lim_exp _))).
            intros a _. rewrite (slope_of_made a j _ E). simpl. rewrite own. reflexivity.
          * assert (Z := D _ (nth_error_In _ _ E) eq_refl). simpl in Z.
            apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_inverse N _ x _ inner Z)).
            intros a _. rewrite (slope_of_made a j _ E). simpl. rewrite own. simpl. field. exact Z.
        + apply (slopes_of_equal N (fun _ => 0%R)).
          { intro y. apply nth_overflow. rewrite names_length. apply nth_error_None in E. lia. }
          apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_constant N _ x)).
          intros a _. rewrite nth_overflow; [simpl; unfold real_of; simpl; lra|].
          unfold slope_table. fold (table_start a). rewrite table_length, start_length.
          apply nth_error_None in E. lia. }
    intro k. apply (slopes_of_equal N (fun y => nth (pred (Pos.to_nat k)) (names y) 0%R));
      [intro y; apply named_is|]. apply by_number.
  Qed.

  Lemma formulas_have_slopes : forall x, defined_at v given x -> forall f,
    has_slopes N (fun y => value (names y) f) x
      (fun a => value (names x) (derivative (slope_of_real a) f)).
  Proof.
    intros x D f. apply (slopes_of_formula N names slope_of_real (fun _ => true)).
    - intros k _. apply names_have_slopes, D.
    - induction f; simpl; rewrite ?IHf1, ?IHf2; auto.
  Qed.

  Theorem defined_is_open : is_open N (defined_at v given).
  Proof.
    intros x D.
    destruct (common_ball N x (length (made v)) (fun j y => forall m, nth_error (made v) j = Some m ->
      fst m = Inverse -> value (names y) (snd m) <> 0%R)) as [delta [P B]].
    - intros j L. destruct (nth_error (made v) j) as [m|] eqn:E.
      + destruct (fst m) eqn:F; try (exists 1%R; split; [lra|]; intros y _ m' E' F'; congruence).
        assert (Z := D m (nth_error_In _ _ E) F).
        destruct (continuous_where_slopes N _ x _ (formulas_have_slopes x D (snd m))
          (Rabs (value (names x) (snd m)))) as [delta [P C]]; [apply Rabs_pos_lt, Z|].
        exists delta. split; [exact P|]. intros y Y m' E' _ Zero.
        injection E' as <-. specialize (C y Y). rewrite Zero in C.
        rewrite Rminus_0_l, Rabs_Ropp in C. lra.
      + exists 1%R. split; [lra|]. intros y _ m' E'. discriminate.
    - exists delta. split; [exact P|]. intros y Y m I F.
      apply In_nth_error in I. destruct I as [j E].
      apply (B y Y j) with (m := m); [|exact E|exact F]. apply nth_error_Some. rewrite E. discriminate.
  Qed.
End RealNames.
