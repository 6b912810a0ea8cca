(** What a certificate for one H says of H's derivatives and of the solutions of Hamilton's
    equations, in the words of its file. *)

From Coq Require Import Reals QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Orders Rings Formulas Identities RealFormulas RealNames OneHamiltonian RealMaps RealDefect RealClaims MapClaims.
Import ListNotations.
Local Open Scope R_scope.

Section FlowClaims.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).

  (** H_p and H_q, in a list. *)
  Theorem energy_has_slopes : forall slopes,
    slope_of_energy x = (fun a => nth a slopes (Number 0)) ->
    forall z a, inside v given z -> (a < 2 * n)%nat ->
    derivable_pt_lim (fun s => value_at (moved z a s) energy) (z a)
      (nth a (map (fun f => value_at z f) slopes) 0).
  Proof.
    intros slopes E z a I L. change 0 with (value_at z (Number 0)).
    rewrite (map_nth (fun f => value_at z f)).
    replace (nth a slopes (Number 0)) with (slope_of_energy x a) by (rewrite E; reflexivity).
    exact (energy_derivable v energy x factors checked given enough a z L I).
  Qed.

  (** The map is as near to each solution as the order says. *)
  Theorem near_solutions : (agreement x <= known x)%nat -> of_length x (S (known x)) = true ->
    forall w r, 0 < r -> solves_equations v x given w r -> forall c, (c < 2 * n)%nat ->
    exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 ->
      Rabs (w c h - in_powers h (coefficients_at v x given (fun j => w j 0) c))
      <= C * Rabs h ^ S (agreement x).
  Proof.
    intros A short w r P W c L.
    destruct (agrees_with_solutions v energy x factors checked given enough w r c P W L)
      as [C [h0 [PC [Ph near]]]].
    set (a := fun k => value_at (fun j => w j 0) (term x k c)).
    assert (E : expands (known x)
      (fun h => in_powers h (coefficients_at v x given (fun j => w j 0) c)) a).
    { apply (expands_with_remainder _ _ _ (fun _ => 0) 0).
      - intros h _. rewrite (series_is v x given enough short). unfold polynomial_map, a. ring.
      - intros h _. rewrite Rabs_R0. apply Rle_refl. }
    destruct (expands_less (agreement x) _ _ _ A E) as [D far].
    assert (PD : 0 <= D) by exact (bound_nonnegative _ D _ far).
    exists (C + D), (Rmin h0 1). split; [lra|split; [apply Rmin_pos; lra|]].
    intros h Lh. assert (L1 := Rmin_l h0 1). assert (L2 := Rmin_r h0 1).
    specialize (near h ltac:(lra)). specialize (far h ltac:(lra)). cbv beta in far.
    assert (T := Rabs_triang (w c h - sum (S (agreement x)) (fun k => a k * h ^ k))
      (- (in_powers h (coefficients_at v x given (fun j => w j 0) c)
          - sum (S (agreement x)) (fun k => a k * h ^ k)))).
    rewrite Rabs_Ropp in T.
    replace (w c h - sum (S (agreement x)) (fun k => a k * h ^ k)
      + - (in_powers h (coefficients_at v x given (fun j => w j 0) c)
          - sum (S (agreement x)) (fun k => a k * h ^ k)))
      with (w c h - in_powers h (coefficients_at v x given (fun j => w j 0) c)) in T by ring.
    rewrite Rmult_plus_distr_r.
    exact (Rle_trans _ _ _ T (Rplus_le_compat _ _ _ _ near far)).
  Qed.
End FlowClaims.

(** One bound for the two coordinates of a plane. *)
Lemma both_near : forall (e1 e2 : R -> R) k,
  (exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 -> Rabs (e1 h) <= C * Rabs h ^ k) ->
  (exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 -> Rabs (e2 h) <= C * Rabs h ^ k) ->
  exists C h0, 0 <= C /\ 0 < h0 /\ forall h, Rabs h <= h0 ->
    Rabs (e1 h) <= C * Rabs h ^ k /\ Rabs (e2 h) <= C * Rabs h ^ k.
Proof.
  intros e1 e2 k [C [g [PC [Pg E1]]]] [D [h0 [PD [Ph E2]]]].
  exists (C + D), (Rmin g h0). split; [lra|split; [apply Rmin_pos; assumption|]].
  intros h L. assert (L1 := Rmin_l g h0). assert (L2 := Rmin_r g h0).
  specialize (E1 h ltac:(lra)). specialize (E2 h ltac:(lra)).
  assert (P := power_nonnegative h k).
  assert (0 <= C * Rabs h ^ k) by (apply Rmult_le_pos; assumption).
  assert (0 <= D * Rabs h ^ k) by (apply Rmult_le_pos; assumption).
  rewrite Rmult_plus_distr_r. split; lra.
Qed.
