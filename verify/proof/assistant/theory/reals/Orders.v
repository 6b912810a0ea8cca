(** What O(h^(m+1)) means, and how it is calculated with.

    [expands m F a] says that F h is sum_(k <= m) a_k h^k up to O(h^(m+1)), for |h| <= 1. *)

From Coq Require Import Reals Lra Lia PeanoNat.
From AreaPreservation Require Import Sums.
Local Open Scope R_scope.

Definition expands (m : nat) (F : R -> R) (a : nat -> R) : Prop :=
  exists C, forall h, Rabs h <= 1 ->
    Rabs (F h - sum (S m) (fun k => a k * h ^ k)) <= C * Rabs h ^ (S m).

(** * Sizes *)

Lemma power_nonnegative : forall h k, 0 <= Rabs h ^ k.
Proof. intros. apply pow_le, Rabs_pos. Qed.

(** The constant of an estimate cannot be negative, as h = 1 shows. *)
Lemma bound_nonnegative : forall (E : R -> R) C k,
  (forall h, Rabs h <= 1 -> Rabs (E h) <= C * Rabs h ^ k) -> 0 <= C.
Proof.
  intros E C k B. specialize (B 1). rewrite Rabs_R1, pow1 in B.
  pose proof (Rabs_pos (E 1)). lra.
Qed.

(** * What an expansion depends on *)

(** F and the coefficients up to that of h^m count, and nothing else. *)
Lemma expands_same : forall m F G a b,
  (forall h, Rabs h <= 1 -> F h = G h) -> (forall k, (k <= m)%nat -> a k = b k) ->
  expands m F a -> expands m G b.
Proof.
  intros m F G a b EF Ea [C B]. exists C. intros h L. rewrite <- (EF h L).
  rewrite <- (sum_of_equals (S m) (fun k => a k * h ^ k)); [ exact (B h L) | ].
  intros k K. rewrite Ea by lia. reflexivity.
Qed.

(** A polynomial of degree m with a remainder. *)
Lemma expands_with_remainder : forall m F a r B,
  (forall h, Rabs h <= 1 -> F h = sum (S m) (fun k => a k * h ^ k) + h ^ (S m) * r h) ->
  (forall h, Rabs h <= 1 -> Rabs (r h) <= B) -> expands m F a.
Proof.
  intros m F a r B E bound. exists B. intros h L. rewrite (E h L).
  set (P := sum (S m) (fun k => a k * h ^ k)). replace (P + _ - P) with (r h * h ^ (S m)) by ring.
  rewrite Rabs_mult, <- RPow_abs.
  apply Rmult_le_compat_r; [ apply power_nonnegative | exact (bound h L) ].
Qed.

(** What is known up to h^m is known up to every lower power. *)
Lemma expands_less : forall r m F a, (r <= m)%nat -> expands m F a -> expands r F a.
Proof.
  intros r m F a L. induction L as [ | m L IH ]; [ trivial | ]. intros [C B]. apply IH.
  pose proof (bound_nonnegative _ _ _ B) as C_nonnegative.
  exists (C + Rabs (a (S m))). intros h small. specialize (B h small).
  change (sum (S (S m)) (fun k => a k * h ^ k))
    with (sum (S m) (fun k => a k * h ^ k) + a (S m) * h ^ (S m)) in B.
  set (P := sum (S m) (fun k => a k * h ^ k)) in *.
  replace (F h - P) with (F h - (P + a (S m) * h ^ S m) + a (S m) * h ^ S m) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  rewrite (Rabs_mult (a (S m))), <- RPow_abs, Rmult_plus_distr_r.
  apply Rplus_le_compat_r. apply Rle_trans with (1 := B). simpl.
  apply Rmult_le_compat_l; [ exact C_nonnegative | ].
  pose proof (power_nonnegative h (S m)) as P0. simpl in P0.
  rewrite <- (Rmult_1_l (Rabs h * Rabs h ^ m)) at 2. apply Rmult_le_compat_r; assumption.
Qed.

(** A function that has an expansion is bounded. *)
Lemma expands_bounded : forall m F a, expands m F a ->
  exists B, forall h, Rabs h <= 1 -> Rabs (F h) <= B.
Proof.
  intros m F a E. destruct (expands_less 0 m F a (Nat.le_0_l m) E) as [C B].
  pose proof (bound_nonnegative _ _ _ B) as C_nonnegative.
  exists (C + Rabs (a 0%nat)). intros h L. specialize (B h L). simpl in B.
  replace (F h) with (F h - (0 + a 0%nat * 1) + a 0%nat) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat_r.
  apply Rle_trans with (1 := B). rewrite <- (Rmult_1_r C) at 2. apply Rmult_le_compat_l; lra.
Qed.

(** * Rules *)

Lemma expands_constant : forall m c,
  expands m (fun _ => c) (fun k => match k with O => c | _ => 0 end).
Proof.
  intros m c. apply (expands_with_remainder m _ _ (fun _ => 0) 0).
  - intros h _. rewrite (sum_of_single (S m) 0); [ simpl; ring | lia | ].
    intros [ | k ] _ N; [ lia | ring ].
  - intros h _. rewrite Rabs_R0. lra.
Qed.

Lemma expands_sum : forall m F G a b, expands m F a -> expands m G b ->
  expands m (fun h => F h + G h) (fun k => a k + b k).
Proof.
  intros m F G a b [C B] [D E]. exists (C + D). intros h L. specialize (B h L). specialize (E h L).
  rewrite (sum_of_equals (S m) _ (fun k => a k * h ^ k + b k * h ^ k)) by (intros; ring).
  rewrite sum_of_sum.
  match goal with |- Rabs (?f + ?g - (?p + ?q)) <= _ =>
    replace (f + g - (p + q)) with (f - p + (g - q)) by ring end.
  apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

Lemma expands_multiple : forall m c F a, expands m F a ->
  expands m (fun h => c * F h) (fun k => c * a k).
Proof.
  intros m c F a [C B]. exists (Rabs c * C). intros h L. specialize (B h L).
  rewrite (sum_of_equals (S m) _ (fun k => c * (a k * h ^ k))) by (intros; ring).
  rewrite sum_of_multiple, <- Rmult_minus_distr_l, Rabs_mult, Rmult_assoc.
  apply Rmult_le_compat_l; [ apply Rabs_pos | exact B ].
Qed.

Lemma expands_opposite : forall m F a, expands m F a ->
  expands m (fun h => - F h) (fun k => - a k).
Proof.
  intros m F a E. apply expands_same with (3 := expands_multiple m (-1) F a E); intros; ring.
Qed.

Lemma expands_difference : forall m F G a b, expands m F a -> expands m G b ->
  expands m (fun h => F h - G h) (fun k => a k - b k).
Proof.
  intros m F G a b E E'. exact (expands_sum m F _ a _ E (expands_opposite m G b E')).
Qed.

Lemma expands_finite_sum : forall m n (F : nat -> R -> R) (a : nat -> nat -> R),
  (forall i, (i < n)%nat -> expands m (F i) (a i)) ->
  expands m (fun h => sum n (fun i => F i h)) (fun k => sum n (fun i => a i k)).
Proof.
  intros m n F a. induction n as [ | n IH ]; intros E; simpl.
  - apply expands_same with (3 := expands_constant m 0); [ | intros [ | k ] _ ]; reflexivity.
  - apply expands_sum; [ apply IH; intros | ]; apply E; lia.
Qed.

(** A factor h^j moves the coefficients up by j. *)
Lemma expands_times_power : forall m j F a, expands m F a ->
  expands m (fun h => h ^ j * F h) (fun k => if Nat.ltb k j then 0 else a (k - j)%nat).
Proof.
  intros m j F a E. induction j as [ | j IH ].
  - apply expands_same with (3 := E); [ intros; simpl; ring | ].
    intros k _. simpl. rewrite Nat.sub_0_r. reflexivity.
  - set (b := fun k => if Nat.ltb k j then 0 else a (k - j)%nat) in *.
    apply (expands_same m (fun h => h * (h ^ j * F h)) _
      (fun k => match k with O => 0 | S i => b i end)).
    + intros h _. simpl. ring.
    + intros [ | k ] _; reflexivity.
    + destruct IH as [C B]. exists (C + Rabs (b m)). intros h L. specialize (B h L).
      replace (sum (S m) (fun k => match k with O => 0 | S i => b i end * h ^ k))
        with (h * sum m (fun k => b k * h ^ k)).
      2: { rewrite <- sum_of_multiple. rewrite (sum_in_two_parts 1 m). simpl.
           rewrite !Rmult_0_l, !Rplus_0_l. apply sum_of_equals. intros. ring. }
      change (sum (S m) (fun k => b k * h ^ k))
        with (sum m (fun k => b k * h ^ k) + b m * h ^ m) in B.
      set (P := sum m (fun k => b k * h ^ k)) in *. set (f := h ^ j * F h) in *.
      replace (h * f - h * P) with (h * (f - (P + b m * h ^ m)) + b m * h ^ S m)
        by (simpl; ring).
      apply Rle_trans with (1 := Rabs_triang _ _).
      rewrite (Rabs_mult (b m)), <- RPow_abs, Rmult_plus_distr_r. apply Rplus_le_compat_r.
      rewrite Rabs_mult. apply Rle_trans with (2 := B).
      rewrite <- (Rmult_1_l (Rabs (f - _))) at 2. apply Rmult_le_compat_r; [ apply Rabs_pos | ].
      exact L.
Qed.

(** The rule of Cauchy for products. *)
Theorem expands_product : forall m F G a b, expands m F a -> expands m G b ->
  expands m (fun h => F h * G h) (fun j => sum (S j) (fun k => a k * b (j - k)%nat)).
Proof.
  intros m F G a b [C B] E. destruct (expands_bounded m G b E) as [D bound].
  set (P := fun h => sum (S m) (fun k => a k * h ^ k)) in *.
  assert (polynomial : expands m (fun h => P h * G h)
      (fun j => sum (S m) (fun k => a k * (if Nat.ltb j k then 0 else b (j - k)%nat)))).
  { apply expands_same with (3 := expands_finite_sum m (S m) _ _
      (fun k _ => expands_multiple m (a k) _ _ (expands_times_power m k G b E))).
    - intros h _. unfold P. rewrite <- sum_times. apply sum_of_equals. intros. ring.
    - reflexivity. }
  assert (rest : expands m (fun h => (F h - P h) * G h) (fun _ => 0)).
  { exists (C * D). intros h L. rewrite sum_of_zeros by (intros; ring).
    rewrite Rminus_0_r, Rabs_mult, Rmult_assoc, (Rmult_comm D), <- Rmult_assoc.
    apply Rmult_le_compat; try apply Rabs_pos; [ exact (B h L) | exact (bound h L) ]. }
  apply expands_same with (3 := expands_sum m _ _ _ _ polynomial rest); [ intros; ring | ].
  intros j J. rewrite Rplus_0_r. replace (S m) with (S j + (m - j))%nat by lia.
  rewrite sum_in_two_parts, (sum_of_zeros (m - j)).
  - rewrite Rplus_0_r. apply sum_of_equals. intros k K.
    rewrite (proj2 (Nat.ltb_ge j k)) by lia. reflexivity.
  - intros i I. rewrite (proj2 (Nat.ltb_lt j (S j + i))) by lia. ring.
Qed.

(** What S = J^T Omega J - Omega is made of, where the entries J c a have the coefficients j _ c a. *)
Lemma expands_pairs : forall m n (J : nat -> nat -> R -> R) (j : nat -> nat -> nat -> R) a b,
  (forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat -> expands m (J c a) (fun k => j k c a)) ->
  (a < 2 * n)%nat -> (b < 2 * n)%nat ->
  expands m (fun h => sum n (fun i => J i a h * J (n + i)%nat b h - J i b h * J (n + i)%nat a h))
    (fun l => sum n (fun i => sum (S l) (fun k => j k i a * j (l - k)%nat (n + i)%nat b)
                            - sum (S l) (fun k => j k i b * j (l - k)%nat (n + i)%nat a))).
Proof.
  intros m n J j a b E La Lb.
  apply (expands_finite_sum m n (fun i h => J i a h * J (n + i)%nat b h - J i b h * J (n + i)%nat a h)
    (fun i l => sum (S l) (fun k => j k i a * j (l - k)%nat (n + i)%nat b)
              - sum (S l) (fun k => j k i b * j (l - k)%nat (n + i)%nat a))).
  intros i L. apply expands_difference.
  - apply (expands_product m _ _ (fun k => j k i a) (fun k => j k (n + i)%nat b)); apply E; lia.
  - apply (expands_product m _ _ (fun k => j k i b) (fun k => j k (n + i)%nat a)); apply E; lia.
Qed.

(** * Conclusions *)

(** If the coefficients below that of h^r are 0, then F h = a_r h^r + O(h^(r+1)). *)
Theorem expands_first : forall m r F a, expands m F a -> (r <= m)%nat ->
  (forall k, (k < r)%nat -> a k = 0) ->
  exists C, forall h, Rabs h <= 1 -> Rabs (F h - a r * h ^ r) <= C * Rabs h ^ (S r).
Proof.
  intros m r F a E L Z. destruct (expands_less r m F a L E) as [C B]. exists C.
  intros h small. specialize (B h small). rewrite (sum_of_single (S r) r) in B; [ exact B | lia | ].
  intros k K N. rewrite Z by lia. ring.
Qed.

(** The order is exact where a is not 0: what is a h^r + O(h^(r+1)) is at least of the size of h^r. *)
Theorem order_is_exact : forall r a C, a <> 0 -> exists h0 c, 0 < h0 /\ 0 < c /\
  forall h x, Rabs h <= h0 -> Rabs (x - a * h ^ r) <= C * Rabs h ^ (S r) -> c * Rabs h ^ r <= Rabs x.
Proof.
  intros r a C N. pose proof (Rabs_pos_lt a N) as A. pose proof (Rle_abs C) as C_less.
  pose proof (Rabs_pos C) as C_nonnegative. set (D := Rabs C + 1).
  assert (D_positive : 0 < D) by (unfold D; lra).
  exists (Rabs a / 2 / D), (Rabs a / 2). split; [ | split; [ lra | ] ].
  - apply Rdiv_lt_0_compat; lra.
  - intros h x L B. pose proof (power_nonnegative h r) as P. pose proof (Rabs_pos h) as P1.
    assert (small : D * Rabs h <= Rabs a / 2).
    { replace (Rabs a / 2) with (D * (Rabs a / 2 / D)) by (field; lra).
      apply Rmult_le_compat_l; lra. }
    apply (Rmult_le_compat_r _ _ _ P) in small.
    assert (size : Rabs (a * h ^ r) = Rabs a * Rabs h ^ r) by (rewrite Rabs_mult, RPow_abs; reflexivity).
    pose proof (Rabs_triang x (- (x - a * h ^ r))) as T. rewrite Rabs_Ropp in T.
    replace (x + - (x - a * h ^ r)) with (a * h ^ r) in T by ring. simpl in B.
    assert (more : C * (Rabs h * Rabs h ^ r) <= D * Rabs h * Rabs h ^ r).
    { rewrite Rmult_assoc. apply Rmult_le_compat_r; [ apply Rmult_le_pos; lra | unfold D; lra ]. }
    lra.
Qed.
