(** What a certificate for one H says of maps over the real numbers: their derivatives, and the
    order in h of S = J^T Omega J - Omega. *)

From Coq Require Import Reals QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Orders Rings Totals Flow Taylor Formulas Smooth Systems Symplectic Identities Certified RealFormulas RealNames OneHamiltonian RealMaps.
Import ListNotations.
Local Open Scope R_scope.

Lemma total_is_sum : forall m (f : nat -> R), @total real_numbers m f = sum m f.
Proof. induction m as [|m IH]; intro f; simpl; [reflexivity|]. rewrite IH. reflexivity. Qed.

Section RealDefect.
  Context (v : vocabulary) (made_well : well_made v = true) (given : list R).
  Context (enough : length given = parameters v) (x : certificate).
  Notation n := (of_degrees x).
  Context (size : dimension v = (2 * n + 1)%nat).
  Context (its_slopes : slope_of_name x = slope_of_real v).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).
  Notation slope_at z c a k := (value_at z (slope x a (term x k c))).

  (** A map in h with these coefficients: what it does to the coordinate c. *)
  Definition polynomial_map (c : nat) (h : R) (z : point) : R :=
    sum (S (known x)) (fun k => value_at z (term x k c) * h ^ k).

  (** The slope of that by the coordinate a. *)
  Definition polynomial_slope (z : point) (c a : nat) (h : R) : R :=
    sum (S (known x)) (fun k => value_at z (slope x a (term x k c)) * h ^ k).

  Lemma value_of_slope_is : forall z, defined_at v given z -> forall f a, (a < 2 * n + 1)%nat ->
    derivable_pt_lim (fun s => value_at (moved z a s) f) (z a) (value_at z (slope x a f)).
  Proof.
    intros z I f a L. unfold slope. rewrite its_slopes.
    apply (derivative_along_coordinate (dimension v) (fun y => value_at y f) z
      (fun a => value_at z (derivative (slope_of_real v a) f))); [|rewrite size; exact L].
    apply formulas_have_slopes; assumption.
  Qed.

  Theorem polynomial_map_derivable : forall z, defined_at v given z -> forall c a h,
    (a < 2 * n)%nat ->
    derivable_pt_lim (fun s => polynomial_map c h (moved z a s)) (z a) (polynomial_slope z c a h).
  Proof.
    intros z I c a h L. unfold polynomial_map, polynomial_slope.
    induction (S (known x)) as [|m IH]; simpl sum.
    - apply derivable_pt_lim_const.
    - apply (derivable_pt_lim_plus _ (fun s => value_at (moved z a s) (term x m c) * h ^ m));
        [exact IH|].
      replace (value_at z (slope x a (term x m c)) * h ^ m) with
        (value_at z (slope x a (term x m c)) * h ^ m
         + value_at (moved z a (z a)) (term x m c) * 0) by ring.
      apply (derivable_pt_lim_mult (fun s => value_at (moved z a s) (term x m c)) (fun _ => h ^ m)).
      + apply value_of_slope_is; [exact I|lia].
      + apply derivable_pt_lim_const.
  Qed.

  Lemma value_of_defect_formula : forall z m a b, value_at z (defect_formula x m a b)
    = sum n (fun i => sum (S m) (fun k => slope_at z i a k * slope_at z (n + i)%nat b (m - k)%nat)
                    - sum (S m) (fun k => slope_at z i b k * slope_at z (n + i)%nat a (m - k)%nat)).
  Proof.
    intros z m a b. unfold defect_formula. rewrite (value_of_sum_up_to real_numbers), total_is_sum.
    rewrite (sum_of_equals (S m) _ (fun k => sum n (fun i =>
      slope_at z i a k * slope_at z (n + i)%nat b (m - k)%nat
      - slope_at z i b k * slope_at z (n + i)%nat a (m - k)%nat))).
    - rewrite sum_swapped. apply sum_of_equals. intros i _. apply sum_of_difference.
    - intros k _. rewrite (value_of_sum_up_to real_numbers), total_is_sum. reflexivity.
  Qed.

  (** The defect of a Jacobian whose entries expand so does it with these coefficients. *)
  Lemma defect_expands : forall z a b (J : nat -> nat -> R -> R),
    (forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat ->
      expands (known x) (J c a) (fun k => slope_at z c a k)) ->
    (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    expands (known x) (fun h => sum n (fun i => J i a h * J (n + i)%nat b h - J i b h * J (n + i)%nat a h))
      (fun m => value_at z (defect_formula x m a b)).
  Proof.
    intros z a b J E La Lb. apply expands_same with
      (3 := expands_pairs _ n J (fun k c a => slope_at z c a k) a b E La Lb); [reflexivity|].
    intros m _. symmetry. apply value_of_defect_formula.
  Qed.

  Lemma gap_is_closed : forall z f g, value_at z (Minus f g) = 0 -> value_at z f = value_at z g.
  Proof. intros z f g E. simpl in E. lra. Qed.

  (** At h = 0 the map is the identity. *)
  Lemma defect_at_start : forall z a b, defined_at v given z ->
    (forall c, (c < 2 * n)%nat -> forall y, defined_at v given y -> value_at y (term x 0 c) = y c) ->
    (a < b)%nat -> (b < 2 * n)%nat -> value_at z (defect_formula x 0 a b) = pairing n a b.
  Proof.
    intros z a b I E L Lb.
    assert (delta : forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat ->
      value_at z (slope x a (term x 0 c)) = pick c a).
    { intros c a' Lc La. unfold slope. rewrite its_slopes.
      apply (slopes_unique (dimension v) (fun y => value_at y (term x 0 c)) z
        (fun a => value_at z (derivative (slope_of_real v a) (term x 0 c))) (pick c));
        [apply formulas_have_slopes; assumption| |rewrite size; lia].
      apply (slopes_of_equal_on_open (dimension v) (defined_at v given) (fun y => y c)).
      - apply defined_is_open; assumption.
      - exact I.
      - intros y Y. apply E; assumption.
      - apply slopes_of_coordinate. rewrite size. lia. }
    rewrite value_of_defect_formula, <- (identity_preserves_form n a b ltac:(lia) Lb).
    apply sum_of_equals. intros i Li. simpl sum. rewrite !Rplus_0_l, !delta by lia. reflexivity.
  Qed.
End RealDefect.
