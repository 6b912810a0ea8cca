(** What a certificate for one H says, in the words of its file: of maps that are written as series
    in h, and of any remainder. *)

From Coq Require Import Reals QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Orders Rings Formulas Calculation Symplectic Identities RealFormulas RealNames OneHamiltonian RealDefect RealClaims.
Import ListNotations.
Local Open Scope R_scope.

(** sum c_k h^k. *)
Fixpoint in_powers (h : R) (coefficients : list R) : R :=
  match coefficients with
  | [] => 0
  | c :: others => c + h * in_powers h others
  end.

(** The point with these coordinates. *)
Definition at_point (coordinates : list R) : point := fun j => nth j coordinates 0.

Definition has_jacobian (n : nat) (F : nat -> point -> R) (z : point) (J : nat -> nat -> R) : Prop :=
  forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat ->
    derivable_pt_lim (fun s => F c (moved z a s)) (z a) (J c a).

(** J^T Omega J - Omega, entry by entry. *)
Definition defect_entry (n : nat) (J : nat -> nat -> R) (a b : nat) : R :=
  sum n (fun i => J i a * J (n + i)%nat b - J i b * J (n + i)%nat a) - pairing n a b.

(** What is left out of a map has slopes that stay bounded for |h| <= 1. *)
Definition slopes_bounded (n : nat) (rest : nat -> R -> point -> R) (z : point) : Prop :=
  exists (J : nat -> nat -> R -> R) B, forall h, Rabs h <= 1 ->
    has_jacobian n (fun c => rest c h) z (fun c a => J c a h) /\
    forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat -> Rabs (J c a h) <= B.

(** In the plane: the determinant of the map (P, Q) at (p, q). *)
Definition has_determinant (P Q : R -> R -> R) (p q det : R) : Prop := exists P_p P_q Q_p Q_q,
  derivable_pt_lim (fun s => P s q) p P_p /\ derivable_pt_lim (fun s => P p s) q P_q /\
  derivable_pt_lim (fun s => Q s q) p Q_p /\ derivable_pt_lim (fun s => Q p s) q Q_q /\
  det = P_p * Q_q - P_q * Q_p.

Definition plane_slopes_bounded (u : R -> R -> R -> R) (p q : R) : Prop :=
  exists (u_p u_q : R -> R) B, forall h, Rabs h <= 1 ->
    derivable_pt_lim (fun s => u h s q) p (u_p h) /\ derivable_pt_lim (fun s => u h p s) q (u_q h) /\
    Rabs (u_p h) <= B /\ Rabs (u_q h) <= B.

Lemma in_powers_is : forall h l m, (length l <= m)%nat ->
  in_powers h l = sum m (fun k => nth k l 0 * h ^ k).
Proof.
  intros h l. induction l as [|c l IH]; intros m L; simpl in_powers.
  - symmetry. apply sum_of_zeros. intros k _. destruct k; simpl; ring.
  - destruct m as [|m]; [simpl in L; lia|]. rewrite (IH m) by (simpl in L; lia).
    assert (first : forall f, sum (S m) f = f O + sum m (fun k => f (S k))).
    { clear. induction m as [|m IH]; intro f; simpl; [ring|]. simpl in IH. rewrite IH. ring. }
    rewrite first. simpl nth. simpl pow. rewrite <- sum_of_multiple.
    replace (c * 1) with c by ring. f_equal. apply sum_of_equals. intros k _. ring.
Qed.

Section MapClaims.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).

  (** The coefficients of the coordinate c. *)
  Definition coefficients_at (z : point) (c : nat) : list R :=
    nth c (map (map (fun f => value_at z f)) (series x)) [].

  Definition not_longer : bool := forallb (fun l => length l <=? S (known x))%nat (series x).

  Lemma series_is : not_longer = true -> forall z c h,
    in_powers h (coefficients_at z c) = polynomial_map v given x c h z.
  Proof.
    intros E z c h.
    replace (coefficients_at z c) with (map (fun f => value_at z f) (nth c (series x) [])) by
      (symmetry; exact (map_nth (map (fun f => value_at z f)) (series x) [] c)).
    rewrite (in_powers_is h _ (S (known x))).
    - apply sum_of_equals. intros k _. unfold term.
      change 0 with (@value_of real_numbers (names_at v given z) (Number 0)).
      rewrite (map_nth (fun f => value_at z f)). reflexivity.
    - rewrite map_length. unfold not_longer in E. rewrite forallb_forall in E.
      destruct (Nat.lt_ge_cases c (length (series x))) as [L|L].
      + apply Nat.leb_le, E, nth_In, L.
      + rewrite nth_overflow by exact L. simpl. lia.
  Qed.

  (** The order of the defect, for every remainder. *)
  Theorem order_of_defect : forall r, order x = Some r -> (1 <= r <= known x)%nat ->
    not_longer = true -> forall z, inside v given z -> forall rest, slopes_bounded n rest z ->
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
    not_longer = true -> n = 1%nat -> forall (P Q : R -> R -> R -> R) p q t,
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
    intros r Er Lr short N P Q p q t P_is Q_is I u w [u_p [u_q [B1 U]]] [w_p [w_q [B2 W]]].
    set (z := at_point [p; q; t]).
    set (rest := fun (c : nat) (h : R) (y : point) =>
      match c with O => u h (y 0%nat) (y 1%nat) | _ => w h (y 0%nat) (y 1%nat) end).
    assert (small : slopes_bounded n rest z).
    { exists (fun c a h => match c, a with O, O => u_p h | O, _ => u_q h | _, O => w_p h | _, _ => w_q h end),
        (Rmax B1 B2). intros h Lh. destruct (U h Lh) as [U1 [U2 [U3 U4]]].
      destruct (W h Lh) as [W1 [W2 [W3 W4]]].
      assert (M1 := Rmax_l B1 B2). assert (M2 := Rmax_r B1 B2). rewrite N. split.
      - intros [|[|c]] [|[|a]] Lc La; try lia; assumption.
      - intros [|[|c]] [|[|a]] Lc La; try lia; lra. }
    destruct (order_of_defect r Er Lr short _ I rest small 0 1 ltac:(lia) ltac:(lia)) as [C bound].
    exists C. intros h Lh. destruct (bound h Lh) as [J [D E]]. rewrite N in D.
    exists (defect_entry n J 0 1 + 1). split; [|replace (defect_entry n J 0 1 + 1 - 1) with
      (defect_entry n J 0 1) by ring; exact E].
    exists (J 0%nat 0%nat), (J 0%nat 1%nat), (J 1%nat 0%nat), (J 1%nat 1%nat).
    split; [|split; [|split; [|split]]].
    - apply (derivable_pt_lim_ext _ _ _ _ (fun s => f_equal (fun m => m + h ^ S (known x) * u h s q)
        (eq_sym (P_is h (moved z 0 s) eq_refl))) (D 0%nat 0%nat ltac:(lia) ltac:(lia))).
    - apply (derivable_pt_lim_ext _ _ _ _ (fun s => f_equal (fun m => m + h ^ S (known x) * u h p s)
        (eq_sym (P_is h (moved z 1 s) eq_refl))) (D 0%nat 1%nat ltac:(lia) ltac:(lia))).
    - apply (derivable_pt_lim_ext _ _ _ _ (fun s => f_equal (fun m => m + h ^ S (known x) * w h s q)
        (eq_sym (Q_is h (moved z 0 s) eq_refl))) (D 1%nat 0%nat ltac:(lia) ltac:(lia))).
    - apply (derivable_pt_lim_ext _ _ _ _ (fun s => f_equal (fun m => m + h ^ S (known x) * w h p s)
        (eq_sym (Q_is h (moved z 1 s) eq_refl))) (D 1%nat 1%nat ltac:(lia) ltac:(lia))).
    - unfold defect_entry, pairing. rewrite N. simpl. ring.
  Qed.
End MapClaims.
