(** Schwarz's theorem: the second derivatives of a function are symmetric. *)

From Coq Require Import Reals Lra Lia PeanoNat.
From AreaPreservation Require Import Sums Differential.
Local Open Scope R_scope.

(** The point [x] with [a] added to coordinate [i] and [b] to coordinate [j]. *)
Definition shifted (x : point) (i j : nat) (a b : R) : point :=
  fun k => x k + (pick i k * a + pick j k * b).

(** The second difference of [H] over a square of side [s]. *)
Definition second_difference (H : point -> R) (x : point) (i j : nat) (s : R) : R :=
  (H (shifted x i j s s) - H (shifted x i j s 0))
  - (H (shifted x i j 0 s) - H (shifted x i j 0 0)).

Lemma distance_shifted : forall N x i j a b,
  (i < N)%nat -> (j < N)%nat -> 0 <= a -> 0 <= b -> distance N x (shifted x i j a b) = a + b.
Proof.
  intros N x i j a b Hi Hj Ha Hb.
  transitivity (sum N (fun k => pick i k * a + pick j k * b)).
  2: { now rewrite sum_of_sum, (sum_picks N i (fun _ => a)), (sum_picks N j (fun _ => b)). }
  apply sum_of_equals. intros k _. unfold shifted.
  rewrite Rabs_right; [ring|]. unfold pick. destruct (Nat.eqb k i), (Nat.eqb k j); lra.
Qed.

Lemma slopes_shifted : forall N x i j a b g, (i < N)%nat -> (j < N)%nat ->
  sum N (fun k => g k * (shifted x i j a b k - x k)) = g i * a + g j * b.
Proof.
  intros N x i j a b g Hi Hj.
  transitivity (sum N (fun k => pick i k * (g k * a) + pick j k * (g k * b))).
  2: { now rewrite sum_of_sum, (sum_picks N i (fun k => g k * a)),
         (sum_picks N j (fun k => g k * b)). }
  apply sum_of_equals. intros k _. unfold shifted. ring.
Qed.

Lemma slope_along_shift : forall N f x i j b c g, (i < N)%nat ->
  has_slopes N f (shifted x i j c b) g ->
  derivable_pt_lim (fun t => f (shifted x i j t b)) c (g i).
Proof.
  intros N f x i j b c g Hi S. rewrite <- (sum_picks N i g Hi).
  rewrite (sum_of_equals N _ (fun k => g k * pick i k)) by (intros; ring).
  apply (derivative_along_curve N f (fun k t => shifted x i j t b k)); [exact S|].
  intros k _. replace (pick i k) with (0 + (pick i k * 1 + 0)) by ring. unfold shifted.
  apply (derivable_pt_lim_plus (fun _ => x k) (fun t => pick i k * t + pick j k * b));
    [apply derivable_pt_lim_const|].
  apply (derivable_pt_lim_plus (fun t => pick i k * t) (fun _ => pick j k * b));
    [|apply derivable_pt_lim_const].
  apply (derivable_pt_lim_scal id), derivable_pt_lim_id.
Qed.

(** The second difference by the square of the side comes close to the second derivative. *)
Lemma second_difference_close : forall N (H : point -> R) (H1 : nat -> point -> R) x r i j g,
  0 < r -> (i < N)%nat -> (j < N)%nat ->
  (forall y, distance N x y < r -> has_slopes N H y (fun k => H1 k y)) ->
  has_slopes N (H1 i) x g ->
  forall eps, 0 < eps -> exists d, 0 < d /\ forall s, 0 < s < d ->
    Rabs (second_difference H x i j s - g j * (s * s)) <= 3 * eps * (s * s).
Proof.
  intros N H H1 x r i j g Hr Hi Hj S S1 eps He.
  destruct (S1 eps He) as (d & Hd & B).
  exists (Rmin (d / 2) (r / 2)). split; [apply Rmin_pos; lra|]. intros s [Hs Hsd].
  pose proof (Rmin_l (d / 2) (r / 2)). pose proof (Rmin_r (d / 2) (r / 2)).
  assert (Along : forall b c, 0 <= b <= s -> 0 <= c <= s ->
    derivable_pt_lim (fun t => H (shifted x i j t b)) c (H1 i (shifted x i j c b))).
  { intros b c Hb Hc.
    apply (slope_along_shift N H x i j b c (fun k => H1 k (shifted x i j c b)) Hi).
    apply S. rewrite distance_shifted; lra || assumption. }
  destruct (MVT_cor2 (fun t => H (shifted x i j t s) - H (shifted x i j t 0))
    (fun t => H1 i (shifted x i j t s) - H1 i (shifted x i j t 0)) 0 s Hs) as (c & E & Hc).
  { intros c Hc. apply (derivable_pt_lim_minus (fun t => H (shifted x i j t s))
      (fun t => H (shifted x i j t 0))); apply Along; lra. }
  cbv beta in E. unfold second_difference. rewrite E.
  pose proof (B (shifted x i j c s)) as B1. pose proof (B (shifted x i j c 0)) as B2.
  rewrite slopes_shifted, distance_shifted in B1, B2 by (lra || assumption).
  specialize (B1 ltac:(lra)). specialize (B2 ltac:(lra)).
  set (u := H1 i (shifted x i j c s)) in *. set (v := H1 i (shifted x i j c 0)) in *.
  replace ((u - v) * (s - 0) - g j * (s * s)) with ((u - v - g j * s) * s) by ring.
  rewrite Rabs_mult, (Rabs_right s) by lra.
  replace (3 * eps * (s * s)) with ((3 * eps * s) * s) by ring.
  apply Rmult_le_compat_r; [lra|].
  replace (u - v - g j * s)
    with ((u - H1 i x - (g i * c + g j * s)) - (v - H1 i x - (g i * c + g j * 0))) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
  assert (eps * c <= eps * s) by (apply Rmult_le_compat_l; lra). lra.
Qed.

Theorem second_slopes_symmetric : forall N (H : point -> R) (H1 : nat -> point -> R)
    (H2 : nat -> nat -> R) x r,
  0 < r ->
  (forall y, distance N x y < r -> has_slopes N H y (fun i => H1 i y)) ->
  (forall i, (i < N)%nat -> has_slopes N (H1 i) x (H2 i)) ->
  forall i j, (i < N)%nat -> (j < N)%nat -> H2 i j = H2 j i.
Proof.
  intros N H H1 H2 x r Hr S S1 i j Hi Hj.
  destruct (Req_dec (H2 i j) (H2 j i)) as [|Different]; [assumption|exfalso].
  pose proof (Rabs_pos_lt (H2 i j - H2 j i) ltac:(lra)) as P.
  set (gap := Rabs (H2 i j - H2 j i)) in *.
  destruct (second_difference_close N H H1 x r i j (H2 i) Hr Hi Hj S (S1 i Hi) (gap / 7))
    as (d & Hd & B); [lra|].
  destruct (second_difference_close N H H1 x r j i (H2 j) Hr Hj Hi S (S1 j Hj) (gap / 7))
    as (e & He & C); [lra|].
  set (s := Rmin (r / 3) (Rmin (d / 2) (e / 2))).
  assert (Hs : 0 < s) by (unfold s; repeat apply Rmin_pos; lra).
  assert (s <= r / 3 /\ s <= d / 2 /\ s <= e / 2) as (Hsr & Hsd & Hse).
  { unfold s. pose proof (Rmin_l (r / 3) (Rmin (d / 2) (e / 2))).
    pose proof (Rmin_r (r / 3) (Rmin (d / 2) (e / 2))).
    pose proof (Rmin_l (d / 2) (e / 2)). pose proof (Rmin_r (d / 2) (e / 2)). lra. }
  specialize (B s ltac:(lra)). specialize (C s ltac:(lra)).
  assert (Swap : forall a b, 0 <= a <= s -> 0 <= b <= s ->
    H (shifted x j i b a) = H (shifted x i j a b)).
  { intros a b Ha Hb. eapply value_at_same_point.
    - apply S. rewrite distance_shifted; lra || assumption.
    - intros k _. unfold shifted. ring. }
  replace (second_difference H x j i s) with (second_difference H x i j s) in C
    by (unfold second_difference; rewrite !Swap by lra; ring).
  set (D := second_difference H x i j s) in *.
  assert (L : gap * (s * s) <= 6 / 7 * gap * (s * s)).
  { unfold gap at 1. rewrite <- (Rabs_right (s * s)) at 1 by nra. rewrite <- Rabs_mult.
    replace ((H2 i j - H2 j i) * (s * s))
      with ((D - H2 j i * (s * s)) - (D - H2 i j * (s * s))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
  assert (0 < gap * (s * s)) by (apply Rmult_lt_0_compat; nra). lra.
Qed.
