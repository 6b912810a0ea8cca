(** The determinant of many steps: how far a product of numbers near one can lie from one. *)

From Coq Require Import Reals Lra Lia.
From AreaPreservation Require Import Sums.
Local Open Scope R_scope.

(** The product of the first [n] numbers. *)
Fixpoint product (n : nat) (d : nat -> R) : R :=
  match n with
  | O => 1
  | S k => product k d * d k
  end.

Lemma power_at_least_one : forall n eps, 0 <= eps -> 1 <= (1 + eps) ^ n.
Proof. intros n eps He. apply pow_R1_Rle. lra. Qed.

(** The errors of the steps grow like a compound interest. *)
Theorem product_near_one : forall N d eps, 0 <= eps ->
  (forall k, (k < N)%nat -> Rabs (d k - 1) <= eps) ->
  Rabs (product N d - 1) <= (1 + eps) ^ N - 1.
Proof.
  induction N as [|N IH]; intros d eps He B; simpl.
  - rewrite Rminus_eq_0, Rabs_R0. lra.
  - specialize (IH d eps He (fun k Hk => B k ltac:(lia))). specialize (B N ltac:(lia)).
    replace (product N d * d N - 1)
      with ((product N d - 1) * (d N - 1) + (product N d - 1) + (d N - 1)) by ring.
    eapply Rle_trans; [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite Rabs_mult.
    assert (Rabs (product N d - 1) * Rabs (d N - 1) <= ((1 + eps) ^ N - 1) * eps)
      by (apply Rmult_le_compat; auto using Rabs_pos).
    lra.
Qed.

Lemma one_plus_below_exp : forall x, 1 + x <= exp x.
Proof.
  intro x. destruct (Req_dec x 0) as [->|Ne]; [rewrite exp_0; lra|].
  left. now apply exp_ineq1.
Qed.

Lemma power_below_exp : forall n eps, 0 <= eps -> (1 + eps) ^ n <= exp (INR n * eps).
Proof.
  induction n as [|n IH]; intros eps He; [simpl; rewrite Rmult_0_l, exp_0; lra|].
  rewrite S_INR. replace ((INR n + 1) * eps) with (eps + INR n * eps) by ring.
  rewrite exp_plus. simpl. apply Rmult_le_compat; try lra.
  - pose proof (power_at_least_one n eps He). lra.
  - apply one_plus_below_exp.
  - now apply IH.
Qed.

Corollary product_near_one_by_exp : forall N d eps, 0 <= eps ->
  (forall k, (k < N)%nat -> Rabs (d k - 1) <= eps) ->
  Rabs (product N d - 1) <= exp (INR N * eps) - 1.
Proof.
  intros N d eps He B. pose proof (product_near_one N d eps He B).
  pose proof (power_below_exp N eps He). lra.
Qed.

(** Area kept in every step is area kept over all of them. *)
Corollary product_of_ones : forall N d, (forall k, (k < N)%nat -> d k = 1) -> product N d = 1.
Proof.
  intros N d E. assert (B : Rabs (product N d - 1) <= (1 + 0) ^ N - 1).
  { apply product_near_one; [lra|]. intros k Hk. rewrite E, Rminus_eq_0, Rabs_R0; lra || auto. }
  rewrite Rplus_0_r, pow1, Rminus_eq_0 in B.
  destruct (Req_dec (product N d) 1) as [|Ne]; [assumption|].
  pose proof (Rabs_pos_lt (product N d - 1)). lra.
Qed.

(** Control: the bound is attained, so no smaller one holds for all steps. *)
Lemma bound_attained : forall N eps, 0 <= eps ->
  Rabs (product N (fun _ => 1 + eps) - 1) = (1 + eps) ^ N - 1.
Proof.
  intros N eps He. replace (product N (fun _ => 1 + eps)) with ((1 + eps) ^ N).
  - apply Rabs_right. pose proof (power_at_least_one N eps He). lra.
  - induction N as [|N IH]; simpl; [reflexivity|]. rewrite <- IH. ring.
Qed.

(** Control: errors do add up, so the bound of one step is not one for two. *)
Lemma one_step_bound_fails_for_two : forall eps, 0 < eps ->
  exists d, (forall k, Rabs (d k - 1) <= eps) /\ eps < Rabs (product 2 d - 1).
Proof.
  intros eps He. exists (fun _ => 1 + eps). split.
  - intros _. rewrite Rabs_right; lra.
  - rewrite bound_attained by lra. simpl. nra.
Qed.

(** * Steps of different errors *)

(** What all steps add up to bounds what they make of a product. *)
Theorem product_near_one_by_sum : forall N d,
  Rabs (product N d - 1) <= exp (sum N (fun k => Rabs (d k - 1))) - 1.
Proof.
  induction N as [|N IH]; intro d; simpl.
  - rewrite Rminus_eq_0, Rabs_R0, exp_0. lra.
  - specialize (IH d). set (s := sum N (fun k => Rabs (d k - 1))) in *. rewrite exp_plus.
    pose proof (one_plus_below_exp (Rabs (d N - 1))) as E. pose proof (Rabs_pos (d N - 1)) as P.
    replace (product N d * d N - 1) with ((product N d - 1) * d N + (d N - 1)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult.
    assert (B : Rabs (d N) <= 1 + Rabs (d N - 1)).
    { replace (d N) with (1 + (d N - 1)) at 1 by ring.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_R1. lra. }
    pose proof (Rabs_pos (d N)). pose proof (Rabs_pos (product N d - 1)). pose proof (exp_pos s).
    assert (Rabs (product N d - 1) * Rabs (d N) <= (exp s - 1) * (1 + Rabs (d N - 1)))
      by (apply Rmult_le_compat; assumption).
    assert (exp s * (1 + Rabs (d N - 1)) <= exp s * exp (Rabs (d N - 1)))
      by (apply Rmult_le_compat_l; lra).
    lra.
Qed.

(** Where no step shrinks, the product is above what they add up to. *)
Theorem product_above_sum : forall N x, (forall k, (k < N)%nat -> 0 <= x k) ->
  1 + sum N x <= product N (fun k => 1 + x k).
Proof.
  induction N as [|N IH]; intros x P; simpl; [lra|].
  specialize (IH x (fun k Hk => P k ltac:(lia))). specialize (P N ltac:(lia)) as last.
  assert (0 <= sum N x) by (apply sum_nonnegative; intros; apply P; lia). nra.
Qed.

(** An error that each step multiplies by 1 + x, and adds c to. *)
Theorem errors_add_up : forall N e x c, 0 < x -> e O <= 0 ->
  (forall k, (k < N)%nat -> e (S k) <= (1 + x) * e k + c) ->
  e N <= c * (((1 + x) ^ N - 1) / x).
Proof.
  induction N as [|N IH]; intros e x c Hx E0 E; simpl.
  - unfold Rdiv. rewrite Rminus_eq_0. lra.
  - specialize (IH e x c Hx E0 (fun k Hk => E k ltac:(lia))). specialize (E N ltac:(lia)).
    assert ((1 + x) * e N <= (1 + x) * (c * (((1 + x) ^ N - 1) / x)))
      by (apply Rmult_le_compat_l; lra).
    replace (c * (((1 + x) * (1 + x) ^ N - 1) / x))
      with ((1 + x) * (c * (((1 + x) ^ N - 1) / x)) + c) by (field; lra).
    lra.
Qed.

(** The same with an own c for each step. *)
Theorem errors_sum_up : forall N e a c, 0 <= a ->
  (forall k, (k < N)%nat -> e (S k) <= a * e k + c k) ->
  e N <= a ^ N * e O + sum N (fun k => a ^ (N - 1 - k) * c k).
Proof.
  induction N as [|N IH]; intros e a c Ha E; simpl; [lra|].
  specialize (IH e a c Ha (fun k Hk => E k ltac:(lia))). specialize (E N ltac:(lia)).
  assert (shifts : sum N (fun k => a ^ (N - 0 - k) * c k)
    = a * sum N (fun k => a ^ (N - 1 - k) * c k)).
  { rewrite <- sum_of_multiple. apply sum_of_equals. intros k Hk.
    replace (N - 0 - k)%nat with (S (N - 1 - k)) by lia. simpl. ring. }
  rewrite shifts. replace (N - 0 - N)%nat with O by lia. simpl.
  assert (a * e N <= a * (a ^ N * e O + sum N (fun k => a ^ (N - 1 - k) * c k)))
    by (apply Rmult_le_compat_l; assumption).
  lra.
Qed.

(** Control: it is attained, so no smaller number will do. *)
Lemma errors_add_up_attained : forall N x, 0 < x ->
  exists e : nat -> R, e O = 0 /\ (forall k, e (S k) = (1 + x) * e k + 1) /\
    e N = ((1 + x) ^ N - 1) / x.
Proof.
  intros N x Hx. exists (fun k => ((1 + x) ^ k - 1) / x).
  split; [simpl; field; lra|]. split; [|reflexivity]. intro k. simpl. field. lra.
Qed.

Corollary errors_below_exp : forall N e x c, 0 < x -> 0 <= c -> e O <= 0 ->
  (forall k, (k < N)%nat -> e (S k) <= (1 + x) * e k + c) ->
  e N <= c * ((exp (INR N * x) - 1) / x).
Proof.
  intros N e x c Hx Hc E0 E. pose proof (errors_add_up N e x c Hx E0 E) as B.
  pose proof (power_below_exp N x (Rlt_le _ _ Hx)) as P.
  assert (c * (((1 + x) ^ N - 1) / x) <= c * ((exp (INR N * x) - 1) / x)); [|lra].
  apply Rmult_le_compat_l; [assumption|]. unfold Rdiv. apply Rmult_le_compat_r; [|lra].
  left. now apply Rinv_0_lt_compat.
Qed.
