(** The determinant of many steps: how far a product of numbers near one can lie from one. *)

From Coq Require Import Reals Lra Lia.
Open Scope R_scope.

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
