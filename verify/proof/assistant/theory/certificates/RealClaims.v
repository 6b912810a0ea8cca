(** The theorems of a certificate for one H, over the real numbers. *)

From Coq Require Import Reals QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Orders Rings Totals Flow Taylor Formulas Calculation Smooth Systems Solutions Symplectic Identities Certified RealFormulas RealNames OneHamiltonian RealMaps RealDefect.
Import ListNotations.
Local Open Scope R_scope.

(** A certificate for H, the formula [energy] in the names of [v], that the check accepts. *)
Record sound (v : vocabulary) (energy : formula) (x : certificate)
    (factors : list (list (nat * formula))) : Prop := {
  sound_names : well_made v = true;
  sound_size : dimension v = (2 * of_degrees x + 1)%nat;
  sound_slopes : slope_of_name x = slope_of_real v;
  sound_known : has_slope x = (fun _ => true);
  sound_energy : all_vanish (relations_of v)
    (map (fun a => Minus (slope_of_energy x a) (derivative (slope_of_real v a) energy))
       (seq 0 (2 * of_degrees x))) [] = true;
  sound_gaps : accepted x (relations_of v) factors = true;
}.

Section RealClaims.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).
  Notation size := (sound_size v energy x factors checked).
  Notation names_ok := (sound_names v energy x factors checked).
  Notation slopes_ok := (sound_slopes v energy x factors checked).
  Notation U := (inside v given).
  Notation U_open := (inside_is_open v names_ok given enough n size).
  Notation sys := (system_of_energy v names_ok given enough n size energy).
  Notation K := (smooth_ring (2 * n + 1) U U_open).

  Lemma vanish_in_reals : forall gaps by_factors,
    all_vanish (relations_of v) gaps by_factors = true ->
    forall z, U z -> forall f, In f gaps -> value_at z f = 0.
  Proof.
    intros gaps by_factors E z I. apply (calculated real_numbers _ _ _ _) with (2 := E).
    exact (relations_hold v names_ok given enough z I).
  Qed.

  Lemma energy_slope : forall a z, (a < 2 * n)%nat -> U z ->
    value_at z (slope_of_energy x a) = value_at z (derivative (slope_of_real v a) energy).
  Proof.
    intros a z L I. apply gap_is_closed.
    apply (vanish_in_reals _ _ (sound_energy v energy x factors checked) z I).
    apply in_map_iff. exists a. split; [reflexivity|]. apply in_seq. lia.
  Qed.

  (** The formulas H_p and H_q of the certificate are the derivatives of H. *)
  Theorem energy_derivable : forall a z, (a < 2 * n)%nat -> U z ->
    derivable_pt_lim (fun s => value_at (moved z a s) energy) (z a)
      (value_at z (slope_of_energy x a)).
  Proof.
    intros a z L I. rewrite (energy_slope a z L I). rewrite <- slopes_ok.
    apply (value_of_slope_is v names_ok given enough x size slopes_ok z I energy a). lia.
  Qed.

  Lemma meaning : interprets K sys x (elements v names_ok given enough n size).
  Proof.
    apply one_interprets; [reflexivity|exact slopes_ok|apply sound_known with (1 := checked)|].
    intros a z L I. apply energy_slope; assumption.
  Qed.

  Lemma gaps_vanish : forall z, U z -> forall f,
    In f (flow_gaps x ++ defect_gaps x ++ primitive_gaps x) -> value_at z f = 0.
  Proof.
    assert (E := sound_gaps v energy x factors checked). unfold accepted in E.
    apply andb_prop in E. exact (vanish_in_reals _ _ (proj2 E)).
  Qed.

  Lemma all_sloped : all_have_slopes x = true.
  Proof.
    assert (E := sound_gaps v energy x factors checked). unfold accepted in E.
    apply andb_prop in E. exact (proj1 E).
  Qed.

  Lemma starts_at_identity : forall z c, U z -> (c < 2 * n)%nat -> value_at z (term x 0 c) = z c.
  Proof.
    intros z c I L. transitivity (value_at z (coordinate_name c)).
    - apply gap_is_closed, (gaps_vanish z I). apply in_app_iff. left. unfold flow_gaps.
      apply in_flat_map. exists c. rewrite in_seq. split; [lia|left; reflexivity].
    - simpl. rewrite named_is_nth, (names_first v given enough) by (rewrite size; lia).
      rewrite app_nth1 by (rewrite map_length, seq_length, size; lia).
      rewrite (nth_indep _ 0 (z 0%nat)) by (rewrite map_length, seq_length, size; lia).
      rewrite map_nth, seq_nth by (rewrite size; lia). reflexivity.
  Qed.

  (** What Hamilton's equations say of a curve of 2n coordinates and the time. *)
  Definition solves_equations (w : nat -> R -> R) (r : R) : Prop :=
    forall s, Rabs s < r -> U (fun j => w j s) /\
      (forall i, (i < n)%nat ->
        derivable_pt_lim (w i) s (- value_at (fun j => w j s) (slope_of_energy x (n + i))) /\
        derivable_pt_lim (w (n + i)%nat) s (value_at (fun j => w j s) (slope_of_energy x i))) /\
      derivable_pt_lim (w (2 * n)%nat) s 1.

  (** The map agrees with every solution of Hamilton's equations up to h^agreement. *)
  Theorem agrees_with_solutions : forall w r c, 0 < r -> solves_equations w r -> (c < 2 * n)%nat ->
    exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 ->
      Rabs (w c h - sum (S (agreement x)) (fun k => value_at (fun j => w j 0) (term x k c) * h ^ k))
      <= C * Rabs h ^ (S (agreement x)).
  Proof.
    intros w r c P E L.
    assert (S : solves n U (element v names_ok given enough n size energy) w r).
    { intros s Ls. destruct (E s Ls) as [I [D T]]. split; [exact I|split; [|exact T]].
      intros i Li. destruct (D i Li) as [D1 D2].
      rewrite !slope_of_formula by lia. rewrite <- !energy_slope by (lia || exact I).
      split; assumption. }
    destruct (taylor_remainder n U U_open _ w r c (agreement x) P S L) as [C [h0 [PC [Ph B]]]].
    exists C, h0. split; [exact PC|split; [exact Ph|]]. intros h Lh.
    rewrite (sum_of_equals _ _ (fun k => value (flow_series _ sys k c) (fun j => w j 0) * h ^ k));
      [exact (B h Lh)|].
    intros k Lk. f_equal.
    assert (I : U (fun j => w j 0)).
    { apply (E 0). rewrite Rabs_R0. exact P. }
    assert (zero_gaps : forall f, In f (flow_gaps x) ->
      @same K (@value_of K (elements v names_ok given enough n size) f) (@zero K)).
    { intros f F y Y. rewrite value_of_element. apply (gaps_vanish y Y).
      apply in_app_iff. left. exact F. }
    rewrite <- (agrees_with_flow K sys x _ meaning all_sloped zero_gaps k c ltac:(lia) L _ I).
    symmetry. apply value_of_element.
  Qed.

  Lemma defect_coefficients : forall z m a b, U z -> (m <= known x)%nat ->
    (a < b)%nat -> (b < 2 * n)%nat ->
    value_at z (defect_formula x m a b)
    = match m with O => pairing n a b | S _ => value_at z (expected x m a b) end.
  Proof.
    intros z m a b I Lm L Lb. destruct m as [|m].
    - apply (defect_at_start v names_ok given enough x size slopes_ok z a b I); try assumption.
      intros c Lc y Y. apply starts_at_identity; assumption.
    - apply gap_is_closed, (gaps_vanish z I). apply in_app_iff. right. apply in_app_iff. left.
      unfold defect_gaps. apply in_flat_map. exists (S m). rewrite in_seq. split; [lia|].
      apply in_map_iff. exists (a, b). split; [reflexivity|].
      apply pair_listed; assumption.
  Qed.

  (** Its defect is leading * h^order + O(h^(order + 1)), whatever is left out of it. *)
  Theorem defect_has_order : forall r, order x = Some r -> (1 <= r <= known x)%nat ->
    forall z, U z -> forall (rest_slope : nat -> nat -> R -> R) B,
    (forall c a h, (c < 2 * n)%nat -> (a < 2 * n)%nat -> Rabs h <= 1 ->
      Rabs (rest_slope c a h) <= B) ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat -> exists C, forall h, Rabs h <= 1 ->
      Rabs (defect_entry n (fun c a => polynomial_slope v given x z c a h
              + h ^ S (known x) * rest_slope c a h) a b
            - value_at z (leading_entry x a b) * h ^ r) <= C * Rabs h ^ S r.
  Proof.
    intros r Er Lr z I rest_slope B bounded a b L Lb.
    assert (E := defect_expands v given x z a b (fun c a h => polynomial_slope v given x z c a h
              + h ^ S (known x) * rest_slope c a h)).
    assert (F := expands_difference _ _ _ _ _ (E (fun c a Lc La => expands_with_remainder _ _
        (fun k => value_at z (slope x a (term x k c))) (rest_slope c a) B
        (fun h _ => eq_refl) (fun h Lh => bounded c a h Lc La Lh)) ltac:(lia) Lb)
      (expands_constant (known x) (pairing n a b))).
    destruct (expands_first _ r _ _ F (proj2 Lr)) as [C bound].
    - intros k Lk. rewrite defect_coefficients by (assumption || lia).
      destruct k as [|k]; [lra|]. unfold expected. rewrite Er.
      rewrite (proj2 (Nat.eqb_neq (S k) r)) by lia. simpl. unfold real_of. simpl. lra.
    - exists C. intros h Lh. specialize (bound h Lh). cbv beta in bound.
      rewrite defect_coefficients in bound by (assumption || lia).
      destruct r as [|r]; [lia|]. unfold expected in bound. rewrite Er, Nat.eqb_refl in bound.
      rewrite Rminus_0_r in bound. exact bound.
  Qed.
End RealClaims.
