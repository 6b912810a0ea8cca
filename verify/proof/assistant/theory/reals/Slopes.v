(** The rules by which slopes are calculated: sums, products, powers, inverses. *)

From Coq Require Import Reals Lra Lia.
From AreaPreservation Require Import Sums Differential.
Local Open Scope R_scope.

(** A function that differs from a linear one by nothing. *)
Lemma slopes_of_linear : forall N f x g,
  (forall y, f y - f x = sum N (fun i => g i * (y i - x i))) -> has_slopes N f x g.
Proof.
  intros N f x g E eps Eps. exists 1. split; [ lra | ]. intros y _.
  rewrite (E y), Rminus_diag_eq, Rabs_R0 by reflexivity.
  apply Rmult_le_pos; [ lra | apply distance_nonnegative ].
Qed.

Lemma slopes_of_constant : forall N c x, has_slopes N (fun _ => c) x (fun _ => 0).
Proof.
  intros. apply slopes_of_linear. intros y. rewrite sum_of_zeros; [ ring | intros; ring ].
Qed.

Lemma slopes_of_coordinate : forall N i x, (i < N)%nat -> has_slopes N (fun z => z i) x (pick i).
Proof.
  intros N i x L. apply slopes_of_linear. intros y.
  rewrite (sum_picks N i (fun i => y i - x i) L). reflexivity.
Qed.

(** The sum and the product of two functions follow from those of two numbers. *)
Lemma slopes_of_pair : forall N (op : R -> R -> R) f k x g h u v,
  has_slopes 2 (fun z => op (z 0%nat) (z 1%nat)) (fun j => match j with O => f x | _ => k x end)
    (fun j => match j with O => u | _ => v end) ->
  has_slopes N f x g -> has_slopes N k x h ->
  has_slopes N (fun z => op (f z) (k z)) x (fun i => u * g i + v * h i).
Proof.
  intros N op f k x g h u v O F K.
  set (two := fun j : nat => match j with O => f | _ => k end).
  set (slopes := fun j : nat => match j with O => g | _ => h end).
  assert (O' : has_slopes 2 (fun z => op (z 0%nat) (z 1%nat)) (fun j => two j x)
                 (fun j => match j with O => u | _ => v end)).
  { apply (slopes_at_same_point 2 _ _ _ _ O). intros [ | j ] _; reflexivity. }
  pose proof (slopes_of_composition 2 N _ two x _ slopes O') as C.
  apply slopes_of_equal_slopes with (1 := C ltac:(intros [ | j ] _; assumption)).
  intros i _. simpl. ring.
Qed.

Lemma slopes_of_sum : forall N f k x g h, has_slopes N f x g -> has_slopes N k x h ->
  has_slopes N (fun z => f z + k z) x (fun i => g i + h i).
Proof.
  intros N f k x g h F K. apply slopes_of_equal_slopes with (fun i => 1 * g i + 1 * h i).
  - apply (slopes_of_pair N Rplus); try assumption. apply slopes_of_linear. intros y. simpl. ring.
  - intros. ring.
Qed.

Lemma slopes_of_difference : forall N f k x g h, has_slopes N f x g -> has_slopes N k x h ->
  has_slopes N (fun z => f z - k z) x (fun i => g i - h i).
Proof.
  intros N f k x g h F K. apply slopes_of_equal_slopes with (fun i => 1 * g i + (-1) * h i).
  - apply (slopes_of_pair N Rminus); try assumption. apply slopes_of_linear. intros y. simpl. ring.
  - intros. ring.
Qed.

Lemma slopes_of_product : forall N f k x g h, has_slopes N f x g -> has_slopes N k x h ->
  has_slopes N (fun z => f z * k z) x (fun i => g i * k x + f x * h i).
Proof.
  intros N f k x g h F K. apply slopes_of_equal_slopes with (fun i => k x * g i + f x * h i).
  - apply (slopes_of_pair N Rmult); try assumption. intros eps Eps. exists eps.
    split; [ exact Eps | ]. unfold distance. simpl. intros y Y.
    match goal with |- Rabs ?e <= _ =>
      replace e with ((y 0%nat - f x) * (y 1%nat - k x)) by ring end.
    rewrite Rabs_mult. pose proof (Rabs_pos (y 0%nat - f x)). pose proof (Rabs_pos (y 1%nat - k x)).
    apply Rmult_le_compat; lra.
  - intros. ring.
Qed.

Lemma slopes_of_real_function : forall N phi l f x g,
  has_slopes N f x g -> derivable_pt_lim phi (f x) l ->
  has_slopes N (fun z => phi (f z)) x (fun i => l * g i).
Proof.
  intros N phi l f x g F D.
  apply slopes_of_equal_slopes with (fun i => sum 1 (fun _ => l * g i)).
  - apply (slopes_of_composition 1 N (fun z => phi (z 0%nat)) (fun _ => f) x (fun _ => l)
             (fun _ => g)); [ apply slopes_of_derivative; exact D | intros; exact F ].
  - intros. simpl. ring.
Qed.

Lemma slopes_of_multiple : forall N c f x g, has_slopes N f x g ->
  has_slopes N (fun z => c * f z) x (fun i => c * g i).
Proof.
  intros N c f x g F. apply (slopes_of_real_function N (fun t => c * t)); [ exact F | ].
  pose proof (derivable_pt_lim_scal id c (f x) 1 (derivable_pt_lim_id (f x))) as D.
  rewrite Rmult_1_r in D. exact D.
Qed.

Lemma slopes_of_opposite : forall N f x g, has_slopes N f x g ->
  has_slopes N (fun z => - f z) x (fun i => - g i).
Proof.
  intros N f x g F. apply slopes_of_equal_slopes with (fun i => -1 * g i); [ | intros; ring ].
  apply (slopes_of_equal N (fun z => -1 * f z)); [ intros; ring | ].
  apply slopes_of_multiple, F.
Qed.

Lemma slopes_of_power : forall N f x g m, has_slopes N f x g ->
  has_slopes N (fun z => f z ^ m) x (fun i => INR m * f x ^ pred m * g i).
Proof.
  intros N f x g m F. apply (slopes_of_real_function N (fun t => t ^ m)); [ exact F | ].
  apply derivable_pt_lim_pow.
Qed.

Lemma slopes_of_inverse : forall N f x g, has_slopes N f x g -> f x <> 0 ->
  has_slopes N (fun z => / f z) x (fun i => - / (f x * f x) * g i).
Proof.
  intros N f x g F nonzero. apply (slopes_of_real_function N Rinv); [ exact F | ].
  pose proof (derivable_pt_lim_div (fun _ => 1) id (f x) 0 1 (derivable_pt_lim_const 1 (f x))
                (derivable_pt_lim_id (f x)) nonzero) as D.
  unfold div_fct, id, Rsqr in D. replace (- / (f x * f x)) with ((0 * f x - 1 * 1) / (f x * f x)).
  - intros eps Eps. destruct (D eps Eps) as [d H]. exists d. intros h h0 hd.
    specialize (H h h0 hd). unfold Rdiv in *. rewrite !Rmult_1_l in *. exact H.
  - field. exact nonzero.
Qed.

Lemma slopes_of_finite_sum : forall N M (f : nat -> point -> R) x (g : nat -> point),
  (forall j, (j < M)%nat -> has_slopes N (f j) x (g j)) ->
  has_slopes N (fun z => sum M (fun j => f j z)) x (fun i => sum M (fun j => g j i)).
Proof.
  intros N M f x g. induction M; intros E; simpl.
  - apply slopes_of_constant.
  - apply slopes_of_sum; [ apply IHM; intros | ]; apply E; lia.
Qed.

(** Finitely many functions that have slopes have them as one matrix. *)
Lemma choice_of_slopes : forall N M (f : nat -> point -> R) x,
  (forall j, (j < M)%nat -> exists g, has_slopes N (f j) x g) ->
  exists J : nat -> nat -> R, forall j, (j < M)%nat -> has_slopes N (f j) x (J j).
Proof.
  intros N M f x. induction M; intros E.
  - exists (fun _ _ => 0). intros. lia.
  - destruct IHM as (J & S); [ intros; apply E; lia | ]. destruct (E M) as (g & G); [ lia | ].
    exists (fun j => if Nat.eqb j M then g else J j). intros j L.
    destruct (Nat.eqb_spec j M) as [ -> | ]; [ exact G | apply S; lia ].
Qed.

Lemma choice_of_matrices : forall N M L (f : nat -> nat -> point -> R) x,
  (forall i j, (i < M)%nat -> (j < L)%nat -> exists g, has_slopes N (f i j) x g) ->
  exists J : nat -> nat -> nat -> R,
    forall i j, (i < M)%nat -> (j < L)%nat -> has_slopes N (f i j) x (J i j).
Proof.
  intros N M L f x. induction M; intros E.
  - exists (fun _ _ _ => 0). intros. lia.
  - destruct IHM as (J & S); [ intros; apply E; lia | ].
    destruct (choice_of_slopes N L (f M) x) as (G & SG); [ intros; apply E; lia | ].
    exists (fun i => if Nat.eqb i M then G else J i). intros i j I K.
    destruct (Nat.eqb_spec i M) as [ -> | ]; [ apply SG, K | apply S; lia ].
Qed.
