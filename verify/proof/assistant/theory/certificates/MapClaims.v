(** What a certificate for one H says, in the words of its file: of maps that are written as series
    in h, and of any remainder. *)

From Coq Require Import Reals QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Orders Rings Formulas Calculation Symplectic Identities RealFormulas RealNames OneHamiltonian RealMaps RealDefect RealClaims.
Import ListNotations.
Local Open Scope R_scope.

Section MapClaims.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).

  (** The coefficients of the coordinate c. *)
  Definition coefficients_at (z : point) (c : nat) : list R :=
    nth c (map (map (fun f => value_at z f)) (series x)) [].

  Lemma series_is : of_length x (S (known x)) = true -> forall z c h,
    in_powers h (coefficients_at z c) = polynomial_map v given x c h z.
  Proof.
    intros E z c h.
    replace (coefficients_at z c) with (map (fun f => value_at z f) (nth c (series x) [])) by
      (symmetry; exact (map_nth (map (fun f => value_at z f)) (series x) [] c)).
    rewrite (in_powers_is h _ (S (known x))).
    - apply sum_of_equals. intros k _. unfold term.
      change 0 with (@value_of real_numbers (names_at v given z) (Number 0)).
      rewrite (map_nth (fun f => value_at z f)). reflexivity.
    - rewrite map_length. unfold of_length in E. rewrite forallb_forall in E.
      destruct (Nat.lt_ge_cases c (length (series x))) as [L|L].
      + apply Nat.leb_le, E, nth_In, L.
      + rewrite nth_overflow by exact L. simpl. lia.
  Qed.

  (** The order of the defect, for every remainder. *)
  Theorem order_of_defect : forall r, order x = Some r -> (1 <= r <= known x)%nat ->
    of_length x (S (known x)) = true -> forall z, inside v given z -> forall rest, slopes_bounded n rest z ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    exists C, forall h, Rabs h <= 1 -> exists J,
      has_jacobian n (fun c y => in_powers h (coefficients_at y c) + h ^ S (known x) * rest c h y) z J /\
      Rabs (defect_entry n J a b - value_at z (leading_entry x a b) * h ^ r) <= C * Rabs h ^ S r.
  Proof.
    intros r Er Lr short z I rest [J [B bounded]] a b L Lb.
    destruct (defect_has_order v energy x factors checked given enough r Er Lr z I J B
      (fun c a h Lc La Lh => proj2 (bounded h Lh) c a Lc La) a b L Lb) as [C bound].
    exists C. intros h Lh.
    exists (fun c a => polynomial_slope v given x z c a h + h ^ S (known x) * J c a h).
    split; [|exact (bound h Lh)]. intros c a' Lc La. cbv beta.
    apply (derivable_pt_lim_ext (fun s => polynomial_map v given x c h (moved z a' s)
      + h ^ S (known x) * rest c h (moved z a' s))).
    - intro s. rewrite series_is by exact short. reflexivity.
    - apply (derivable_pt_lim_plus (fun s => polynomial_map v given x c h (moved z a' s))
        (fun s => h ^ S (known x) * rest c h (moved z a' s))).
      + apply (polynomial_map_derivable v (sound_names _ _ _ _ checked) given enough x
          (sound_size _ _ _ _ checked) (sound_slopes _ _ _ _ checked) z I c a' h La).
      + apply (derivable_pt_lim_scal (fun s => rest c h (moved z a' s))).
        apply (proj1 (bounded h Lh)); assumption.
  Qed.

  (** In the plane: of det J - 1, for a map that is written with functions of p and q. *)
  Theorem order_of_determinant : forall r, order x = Some r -> (1 <= r <= known x)%nat ->
    of_length x (S (known x)) = true -> n = 1%nat -> forall (P Q : R -> R -> R -> R) p q t,
    (forall h y, y 2%nat = t -> P h (y 0%nat) (y 1%nat) = in_powers h (coefficients_at y 0)) ->
    (forall h y, y 2%nat = t -> Q h (y 0%nat) (y 1%nat) = in_powers h (coefficients_at y 1)) ->
    inside v given (at_point [p; q; t]) -> forall u w,
    plane_slopes_bounded u p q -> plane_slopes_bounded w p q ->
    exists C, forall h, Rabs h <= 1 -> exists det,
      has_determinant (fun p q => P h p q + h ^ S (known x) * u h p q)
        (fun p q => Q h p q + h ^ S (known x) * w h p q) p q det /\
      Rabs (det - 1 - value_at (at_point [p; q; t]) (leading_entry x 0 1) * h ^ r)
        <= C * Rabs h ^ S r.
  Proof.
    intros r Er Lr short N P Q p q t P_is Q_is I u w U W. set (z := at_point [p; q; t]).
    assert (small := plane_map_bounded u w z U W). rewrite <- N in small.
    destruct (order_of_defect r Er Lr short _ I _ small 0 1 ltac:(lia) ltac:(lia)) as [C bound].
    exists C. intros h Lh. destruct (bound h Lh) as [J [D E]]. rewrite N in D, E.
    exists (defect_entry 1 J 0 1 + 1). split.
    - refine (plane_determinant _ _ _ z J _ _ D); intros y Y; simpl plane_map;
        rewrite ?P_is, ?Q_is by exact Y; reflexivity.
    - replace (defect_entry 1 J 0 1 + 1 - 1) with (defect_entry 1 J 0 1) by ring. exact E.
  Qed.
End MapClaims.
