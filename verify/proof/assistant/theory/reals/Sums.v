(** Finite sums of real numbers. *)

From Coq Require Import Reals Lra Lia.
Local Open Scope R_scope.

Fixpoint sum (n : nat) (f : nat -> R) : R :=
  match n with
  | O => 0
  | S k => sum k f + f k
  end.

Lemma sum_of_equals : forall n f g,
  (forall i, (i < n)%nat -> f i = g i) -> sum n f = sum n g.
Proof.
  induction n; intros f g E; simpl; [ reflexivity | ].
  rewrite (IHn f g), E; [ reflexivity | lia | intros; apply E; lia ].
Qed.

Lemma sum_of_zeros : forall n f, (forall i, (i < n)%nat -> f i = 0) -> sum n f = 0.
Proof.
  induction n; intros f E; simpl; [ reflexivity | ].
  rewrite IHn, E; [ lra | lia | intros; apply E; lia ].
Qed.

Lemma sum_of_sum : forall n f g, sum n (fun i => f i + g i) = sum n f + sum n g.
Proof. induction n; intros; simpl; [ lra | rewrite IHn; lra ]. Qed.

Lemma sum_of_difference : forall n f g, sum n (fun i => f i - g i) = sum n f - sum n g.
Proof. induction n; intros; simpl; [ lra | rewrite IHn; lra ]. Qed.

Lemma sum_of_opposite : forall n f, sum n (fun i => - f i) = - sum n f.
Proof. induction n; intros; simpl; [ lra | rewrite IHn; lra ]. Qed.

Lemma sum_of_multiple : forall n c f, sum n (fun i => c * f i) = c * sum n f.
Proof. induction n; intros; simpl; [ lra | rewrite IHn; lra ]. Qed.

Lemma sum_times : forall n c f, sum n (fun i => f i * c) = sum n f * c.
Proof. induction n; intros; simpl; [ lra | rewrite IHn; lra ]. Qed.

(** The order of two summations does not matter. *)
Lemma sum_swapped : forall n m f,
  sum n (fun i => sum m (fun j => f i j)) = sum m (fun j => sum n (fun i => f i j)).
Proof.
  induction n; intros m f; simpl.
  - symmetry. apply sum_of_zeros. reflexivity.
  - rewrite IHn. symmetry. apply sum_of_sum.
Qed.

(** A sum in which a single term can differ from zero is that term. *)
Lemma sum_of_single : forall n k f,
  (k < n)%nat -> (forall i, (i < n)%nat -> i <> k -> f i = 0) -> sum n f = f k.
Proof.
  induction n; intros k f L E; [ lia | ]. simpl.
  destruct (Nat.eq_dec k n) as [ -> | D ].
  - rewrite sum_of_zeros; [ lra | intros; apply E; lia ].
  - rewrite (IHn k), (E n); [ lra | lia | lia | lia | intros; apply E; lia ].
Qed.

(** The factor that picks one term out of a sum. *)
Definition pick (k i : nat) : R := if Nat.eqb i k then 1 else 0.

Lemma sum_picks : forall n k f, (k < n)%nat -> sum n (fun i => pick k i * f i) = f k.
Proof.
  intros n k f L. rewrite (sum_of_single n k); [ | exact L | ]; unfold pick.
  - rewrite Nat.eqb_refl. lra.
  - intros i _ D. apply Nat.eqb_neq in D. rewrite D. lra.
Qed.

Lemma sum_in_two_parts : forall n m f,
  sum (n + m) f = sum n f + sum m (fun i => f (n + i)%nat).
Proof.
  intros n m f. induction m; simpl.
  - rewrite Nat.add_0_r. lra.
  - rewrite Nat.add_succ_r. simpl. rewrite IHm. lra.
Qed.

Lemma sum_of_less : forall n f g, (forall i, (i < n)%nat -> f i <= g i) -> sum n f <= sum n g.
Proof.
  induction n; intros f g E; simpl; [ lra | ].
  apply Rplus_le_compat; [ apply IHn; intros | ]; apply E; lia.
Qed.

Lemma sum_nonnegative : forall n f, (forall i, (i < n)%nat -> 0 <= f i) -> 0 <= sum n f.
Proof.
  intros n f E. rewrite <- (sum_of_zeros n (fun _ => 0)); [ | reflexivity ].
  apply sum_of_less. exact E.
Qed.

Lemma term_below_sum : forall n f k,
  (forall i, (i < n)%nat -> 0 <= f i) -> (k < n)%nat -> f k <= sum n f.
Proof.
  intros n f k E L. rewrite <- (sum_picks n k f L). apply sum_of_less. intros i I.
  unfold pick. specialize (E i I). destruct (Nat.eqb i k); lra.
Qed.

Lemma size_of_sum : forall n f, Rabs (sum n f) <= sum n (fun i => Rabs (f i)).
Proof.
  induction n; intros f; simpl; [ rewrite Rabs_R0; lra | ].
  apply Rle_trans with (1 := Rabs_triang _ _). specialize (IHn f). lra.
Qed.

(** Cauchy and Schwarz, against ones: what the mean of squares says of the sum. *)
Theorem square_of_sum : forall n f, sum n f ^ 2 <= INR n * sum n (fun i => f i ^ 2).
Proof.
  induction n as [ | n IH ]; intros f; [ simpl; lra | ].
  rewrite S_INR. change (sum (S n) f) with (sum n f + f n).
  change (sum (S n) (fun i => f i ^ 2)) with (sum n (fun i => f i ^ 2) + f n ^ 2).
  specialize (IH f). set (a := sum n f) in *. set (s := sum n (fun i => f i ^ 2)) in *.
  assert (both : 2 * a * f n <= s + INR n * f n ^ 2).
  { destruct n as [ | n ]; [ subst a s; simpl in *; lra | ].
    assert (P : 0 < INR (S n)) by (apply lt_0_INR; lia).
    assert (square : 0 <= (a - INR (S n) * f (S n)) ^ 2) by apply pow2_ge_0.
    apply (Rmult_le_reg_l (INR (S n)) _ _ P). nra. }
  nra.
Qed.

(** Control: it is attained, so no smaller factor than n will do. *)
Lemma square_of_sum_attained : forall n c,
  sum n (fun _ => c) ^ 2 = INR n * sum n (fun _ => c ^ 2).
Proof.
  assert (constant : forall n c, sum n (fun _ => c) = INR n * c).
  { induction n as [ | n IH ]; intros c; [ simpl; ring | ]. rewrite S_INR. simpl. rewrite IH. ring. }
  intros n c. rewrite !constant. ring.
Qed.
