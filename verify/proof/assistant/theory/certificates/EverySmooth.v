(** A certificate for every H over the real numbers: H is any smooth function on an open set, h is a
    number, and what is left out of the map is any function whose slopes stay bounded. *)

From Coq Require Import Reals QArith List Lra Lia.
From AreaPreservation Require Import Sums Differential Symplectic Orders Rings Totals Flow Taylor Bracket Formulas Smooth Systems Identities RealMaps EveryHamiltonian EveryClaims EveryNumbers.
Import ListNotations.
Local Open Scope R_scope.

(** The values at a point. *)
Definition values_at {N U} (y : point) (l : list (smooth N U)) : list R := map (fun f => value f y) l.

Section SmoothMaps.
  Context (n : nat) (U : point -> Prop) (U_open : is_open (2 * n + 1) U) (H : smooth (2 * n + 1) U).
  Notation K := (smooth_ring (2 * n + 1) U U_open).
  Notation s := (smooth_system n U U_open H).
  Notation slope a f z := (value (@by_coordinate K a f) z).

  Lemma value_of_pairs : forall (A B : nat -> K) a b z, value (pairs K s A B a b) z
    = sum n (fun i => slope a (A i) z * slope b (B (n + i)%nat) z
                    - slope b (A i) z * slope a (B (n + i)%nat) z).
  Proof. intros A B a b z. exact (value_total _ U U_open n _ z). Qed.

  Lemma value_of_coefficient : forall (A : nat -> nat -> K) m a b z,
    value (defect_coefficient K s A m a b) z = sum n (fun i =>
      sum (S m) (fun k => slope a (A k i) z * slope b (A (m - k)%nat (n + i)%nat) z)
      - sum (S m) (fun k => slope b (A k i) z * slope a (A (m - k)%nat (n + i)%nat) z)).
  Proof.
    intros A m a b z. etransitivity; [exact (value_total _ U U_open (S m) _ z)|].
    etransitivity; [apply sum_of_equals; intros k _; apply value_of_pairs|].
    rewrite sum_swapped. apply sum_of_equals. intros i _. apply sum_of_difference.
  Qed.

  Lemma value_of_canonical : forall a b z, U z -> (a < b)%nat -> (b < 2 * n)%nat ->
    value (canonical K s a b) z = pairing n a b.
  Proof.
    intros a b z I L Lb. unfold canonical. rewrite value_of_pairs.
    rewrite <- (identity_preserves_form n a b ltac:(lia) Lb). apply sum_of_equals. intros i Li.
    assert (delta : forall c j, (c < 2 * n)%nat -> (j < 2 * n)%nat ->
      slope c (coordinate s j) z = pick j c).
    { intros c j Lc Lj.
      etransitivity; [exact (derivation_coordinate _ U U_open c j ltac:(lia) ltac:(lia) z I)|].
      unfold pick. destruct (Nat.eqb c j); reflexivity. }
    rewrite !delta by lia. reflexivity.
  Qed.

  (** The slope by the coordinate a of a sum of powers of h. *)
  Lemma polynomial_derivable : forall (l : list K) h a z, U z -> (a < 2 * n)%nat ->
    derivable_pt_lim (fun t => in_powers h (values_at (moved z a t) l)) (z a)
      (sum (length l) (fun k => slope a (coefficients l k) z * h ^ k)).
  Proof.
    intros l h a z I La. replace (sum _ _) with (in_powers h (map (fun f => slope a f z) l)).
    - induction l as [|f l IH]; [apply derivable_pt_lim_const|].
      apply (derivable_pt_lim_plus (fun t => value f (moved z a t))
        (fun t => h * in_powers h (values_at (moved z a t) l))).
      + apply derivation_is_slope; [exact I|lia].
      + apply (derivable_pt_lim_scal (fun t => in_powers h (values_at (moved z a t) l))), IH.
    - rewrite (in_powers_is h _ (length l)) by (rewrite map_length; apply le_n).
      apply sum_of_equals. intros k Lk. unfold coefficients.
      rewrite (nth_indep _ 0 (slope a (@zero K) z)) by (rewrite map_length; exact Lk).
      rewrite (map_nth (fun f => slope a f z)). reflexivity.
  Qed.

  (** Of a map with these coefficients, and any remainder. *)
  Theorem smooth_map_has_order : forall (l : nat -> list K) m r z, U z ->
    (forall c, (length (l c) <= S m)%nat) -> (r <= m)%nat ->
    let A := fun k c => coefficients (l c) k in
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    @same K (defect_coefficient K s A 0 a b) (canonical K s a b) ->
    (forall k, (1 <= k < r)%nat -> @same K (defect_coefficient K s A k a b) (@zero K)) ->
    forall rest, slopes_bounded n rest z -> (1 <= r)%nat ->
    exists C, forall h, Rabs h <= 1 -> exists J,
      has_jacobian n (fun c y => in_powers h (values_at y (l c)) + h ^ S m * rest c h y) z J /\
      Rabs (defect_entry n J a b - value (defect_coefficient K s A r a b) z * h ^ r) <= C * Rabs h ^ S r.
  Proof.
    intros l m r z I short Lr A a b L Lb start before rest [J [B bounded]] R.
    assert (further : forall c a h, (c < 2 * n)%nat -> (a < 2 * n)%nat ->
      sum (length (l c)) (fun k => slope a (A k c) z * h ^ k)
      = sum (S m) (fun k => slope a (A k c) z * h ^ k)).
    { intros c a' h _ La. replace (S m) with (length (l c) + (S m - length (l c)))%nat by
        (specialize (short c); lia).
      rewrite sum_in_two_parts, (sum_of_zeros (S m - length (l c))); [ring|]. intros k _.
      unfold A, coefficients. rewrite nth_overflow by lia.
      rewrite (derivation_zero K a' z I). unfold value. simpl. ring. }
    assert (E := expands_pairs m n (fun c a h => sum (S m) (fun k => slope a (A k c) z * h ^ k)
      + h ^ S m * J c a h) (fun k c a => slope a (A k c) z) a b
      (fun c a Lc La => expands_with_remainder _ _ (fun k => slope a (A k c) z) (J c a) B
        (fun h _ => eq_refl) (fun h Lh => proj2 (bounded h Lh) c a Lc La)) ltac:(lia) Lb).
    destruct (expands_first m r _ _ (expands_difference _ _ _ _ _ E
      (expands_constant m (pairing n a b))) Lr) as [C bound].
    - intros k Lk. rewrite <- (value_of_coefficient A k a b z). destruct k as [|k].
      + rewrite (start z I), value_of_canonical by assumption. ring.
      + rewrite (before (S k) ltac:(lia) z I). unfold value. simpl. ring.
    - exists C. intros h Lh. exists (fun c a => sum (S m) (fun k => slope a (A k c) z * h ^ k)
        + h ^ S m * J c a h). split.
      + intros c a' Lc La. cbv beta. rewrite <- (further c a' h Lc La).
        apply (derivable_pt_lim_plus (fun t => in_powers h (values_at (moved z a' t) (l c)))
          (fun t => h ^ S m * rest c h (moved z a' t))).
        * apply polynomial_derivable; assumption.
        * apply (derivable_pt_lim_scal (fun t => rest c h (moved z a' t))).
          apply (proj1 (bounded h Lh)); assumption.
      + specialize (bound h Lh). cbv beta in bound.
        rewrite <- (value_of_coefficient A r a b z) in bound.
        destruct r as [|r]; [lia|]. rewrite Rminus_0_r in bound. exact bound.
  Qed.

  (** A number is an element that no derivation sees. *)
  Definition number (h : R) : K := smooth_constant h.

  Lemma number_is_constant : forall h, is_constant K (number h).
  Proof. intros h i. apply derivation_constant. Qed.

  Lemma value_of_polynomial : forall h (l : list K) y,
    value (polynomial (number h) l) y = in_powers h (values_at y l).
  Proof.
    intros h l y. induction l as [|f l IH]; [reflexivity|].
    exact (f_equal (fun v => value f y + h * v) IH).
  Qed.

  (** A map that keeps the form as an element at each number. *)
  Theorem smooth_map_keeps_form : forall (l : nat -> list K),
    (forall h, is_constant K h -> forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
      @same K (pairs K s (fun c => polynomial h (l c)) (fun c => polynomial h (l c)) a b)
        (canonical K s a b)) ->
    forall z, U z -> forall h, exists J,
      has_jacobian n (fun c y => in_powers h (values_at y (l c))) z J /\
      forall a b, (a < b)%nat -> (b < 2 * n)%nat -> defect_entry n J a b = 0.
  Proof.
    intros l E z I h. exists (fun c a => slope a (polynomial (number h) (l c)) z). split.
    - intros c a _ La.
      apply (derivable_pt_lim_ext (fun t => value (polynomial (number h) (l c)) (moved z a t))).
      + intro t. apply value_of_polynomial.
      + apply derivation_is_slope; [exact I|lia].
    - intros a b L Lb. unfold defect_entry.
      rewrite <- (value_of_canonical a b z I L Lb), <- (E _ (number_is_constant h) a b L Lb z I).
      rewrite value_of_pairs. ring.
  Qed.
End SmoothMaps.

Section EverySmooth.
  Context (e : family_of_energies) (x : certificate) (checked : sound_for_every e x).
  Notation n := (energy_degrees e).
  Context (U : point -> Prop) (U_open : is_open (2 * n + 1) U) (H : smooth (2 * n + 1) U).
  Notation K := (smooth_ring (2 * n + 1) U U_open).
  Notation s := (smooth_system n U U_open H).
  Context (member : @belongs K s e).
  Notation elements := (elements_of e x K s).
  Notation leading a b := (@value_of K (names_for_every K s e) (leading_entry x a b)).
  (** As they stand in the exported file: there they are seen to be the same in any ring, where
      nothing of smooth functions is unfolded. *)
  Context (next : nat -> list K) (next_is : forall c, elements c = next c).

  (** S = L h^r + O(h^(r+1)), whatever is left out of the map. *)
  Theorem smooth_form_has_order : forall r, order x = Some r -> (1 <= r <= known x)%nat ->
    of_length x (S (known x)) = true -> forall z, U z ->
    forall rest, slopes_bounded n rest z -> forall a b L, leading a b = L ->
    (a < b)%nat -> (b < 2 * n)%nat -> exists C, forall h, Rabs h <= 1 -> exists J,
      has_jacobian n (fun c y => in_powers h (values_at y (next c)) + h ^ S (known x) * rest c h y) z J /\
      Rabs (defect_entry n J a b - value L z * h ^ r) <= C * Rabs h ^ S r.
  Proof.
    intros r E Lr short z I rest small a b L <- Lab Lb.
    set (A := fun k c => coefficients (elements c) k).
    destruct (form_has_order e x checked K s member r E Lr A (fun k c _ _ => reflexivity _) a b Lab
      ltac:(rewrite (every_degrees e x checked); exact Lb)) as [start [before first]].
    destruct (smooth_map_has_order n U U_open H elements (known x) r z I
      (length_of_elements e x K s _ short) (proj2 Lr) a b Lab Lb start before rest small (proj1 Lr))
      as [C bound].
    exists C. intros h Lh. destruct (bound h Lh) as [J [D B]]. exists J. split.
    - intros c a' Lc La. rewrite <- (next_is c). exact (D c a' Lc La).
    - rewrite <- (first z I). exact B.
  Qed.

  (** In the plane: det J = 1 + L h^r + O(h^(r+1)). *)
  Theorem smooth_determinant_has_order : n = 1%nat -> forall r, order x = Some r ->
    (1 <= r <= known x)%nat -> of_length x (S (known x)) = true -> forall L, leading 0%nat 1%nat = L ->
    forall z, U z -> forall rest, slopes_bounded n rest z ->
    exists C, forall h, Rabs h <= 1 -> exists J,
      has_jacobian n (fun c y => in_powers h (values_at y (next c)) + h ^ S (known x) * rest c h y) z J /\
      Rabs (J 0%nat 0%nat * J 1%nat 1%nat - J 0%nat 1%nat * J 1%nat 0%nat - 1 - value L z * h ^ r)
        <= C * Rabs h ^ S r.
  Proof.
    intros plane r E Lr short L L_is z I rest small.
    destruct (smooth_form_has_order r E Lr short z I rest small 0 1 L L_is ltac:(lia) ltac:(lia))
      as [C bound].
    exists C. intros h Lh. destruct (bound h Lh) as [J [D B]]. exists J. split; [exact D|].
    rewrite <- (entry_in_plane n J plane). exact B.
  Qed.

  (** Where no order is told: S = 0 at each h. *)
  Theorem smooth_form_is_kept : forall m, order x = None -> of_length x m = true ->
    (m + m <= S (S (known x)))%nat -> forall z, U z -> forall h, exists J,
      has_jacobian n (fun c y => in_powers h (values_at y (next c))) z J /\
      forall a b, (a < b)%nat -> (b < 2 * n)%nat -> defect_entry n J a b = 0.
  Proof.
    intros m E short Lm z I h.
    destruct (smooth_map_keeps_form n U U_open H elements) with (z := z) (h := h) as [J [D B]];
      [|exact I|].
    - intros g C a b L Lb. apply (form_is_kept e x checked K s member m E short Lm g C a b L).
      rewrite (every_degrees e x checked). exact Lb.
    - exists J. split; [|exact B]. intros c a Lc La. rewrite <- (next_is c). exact (D c a Lc La).
  Qed.

  Theorem smooth_determinant_is_one : n = 1%nat -> forall m, order x = None -> of_length x m = true ->
    (m + m <= S (S (known x)))%nat -> forall z, U z -> forall h, exists J,
      has_jacobian n (fun c y => in_powers h (values_at y (next c))) z J /\
      J 0%nat 0%nat * J 1%nat 1%nat - J 0%nat 1%nat * J 1%nat 0%nat = 1.
  Proof.
    intros plane m E short L z I h. destruct (smooth_form_is_kept m E short L z I h) as [J [D B]].
    exists J. split; [exact D|]. specialize (B 0%nat 1%nat ltac:(lia) ltac:(lia)).
    rewrite (entry_in_plane n J plane) in B. lra.
  Qed.
End EverySmooth.
