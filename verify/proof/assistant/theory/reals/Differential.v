(** Functions of several real variables, and what their derivative at a point is.

    A point is a sequence of numbers, of which the first N are looked at. The derivative is that of
    Frechet, in the sum norm; along a coordinate it is the standard library's. The rules for sums,
    products, powers and inverses are in Slopes.v. *)

From Coq Require Import Reals Lra Lia.
From AreaPreservation Require Import Sums.
Export Sums.
Local Open Scope R_scope.

Definition point := nat -> R.

Definition distance (N : nat) (x y : point) : R := sum N (fun i => Rabs (y i - x i)).

(** [g] holds the slopes of [f] at [x] along the first N coordinates. *)
Definition has_slopes (N : nat) (f : point -> R) (x g : point) : Prop :=
  forall eps, 0 < eps -> exists delta, 0 < delta /\
    forall y, distance N x y < delta ->
      Rabs (f y - f x - sum N (fun i => g i * (y i - x i))) <= eps * distance N x y.

(** The point [x] with [s] as its coordinate of number [i]. *)
Definition moved (x : point) (i : nat) (s : R) : point :=
  fun j => if Nat.eqb j i then s else x j.

(** Every point of [U] has a ball around it that lies in [U]. *)
Definition is_open (N : nat) (U : point -> Prop) : Prop :=
  forall x, U x -> exists delta, 0 < delta /\ forall y, distance N x y < delta -> U y.

(** * Distances *)

Lemma distance_nonnegative : forall N x y, 0 <= distance N x y.
Proof. intros. apply sum_nonnegative. intros. apply Rabs_pos. Qed.

Lemma coordinate_below_distance : forall N x y i,
  (i < N)%nat -> Rabs (y i - x i) <= distance N x y.
Proof.
  intros N x y i L. apply (term_below_sum N (fun i => Rabs (y i - x i))); [ | exact L ].
  intros. apply Rabs_pos.
Qed.

Lemma distance_zero : forall N x y, (forall i, (i < N)%nat -> y i = x i) -> distance N x y = 0.
Proof.
  intros N x y E. apply sum_of_zeros. intros i L. rewrite (E i L), Rminus_diag_eq; trivial.
  apply Rabs_R0.
Qed.

Lemma distance_to_itself : forall N x, distance N x x = 0.
Proof. intros. apply distance_zero. reflexivity. Qed.

Lemma slopes_bound_change : forall N g x y,
  Rabs (sum N (fun i => g i * (y i - x i))) <= sum N (fun i => Rabs (g i)) * distance N x y.
Proof.
  intros. apply Rle_trans with (1 := size_of_sum _ _). rewrite <- sum_times.
  apply sum_of_less. intros i L. rewrite Rabs_mult.
  apply Rmult_le_compat_l; [ apply Rabs_pos | apply coordinate_below_distance; exact L ].
Qed.

(** What holds on a ball for each of finitely many numbers holds on one ball for all of them. *)
Lemma common_ball : forall N x M (P : nat -> point -> Prop),
  (forall j, (j < M)%nat -> exists delta, 0 < delta /\ forall y, distance N x y < delta -> P j y) ->
  exists delta, 0 < delta /\
    forall y, distance N x y < delta -> forall j, (j < M)%nat -> P j y.
Proof.
  intros N x M P. induction M; intros E.
  - exists 1. split; [ lra | intros; lia ].
  - destruct IHM as (d & D & IH); [ intros; apply E; lia | ].
    destruct (E M) as (e & e_positive & H); [ lia | ].
    exists (Rmin d e). split; [ apply Rmin_pos; assumption | ].
    intros y Y j J. pose proof (Rmin_l d e). pose proof (Rmin_r d e).
    destruct (Nat.eq_dec j M) as [ -> | ]; [ apply H; lra | apply IH; [ lra | lia ] ].
Qed.

(** * What the slopes depend on *)

(** Two points that agree in the first N coordinates have the same value. *)
Lemma value_at_same_point : forall N f x g y,
  has_slopes N f x g -> (forall i, (i < N)%nat -> y i = x i) -> f y = f x.
Proof.
  intros N f x g y S E. destruct (S 1 Rlt_0_1) as (d & D & H).
  specialize (H y). rewrite (distance_zero N x y E) in H. specialize (H D).
  rewrite sum_of_zeros in H by (intros i L; rewrite (E i L); ring).
  rewrite Rmult_0_r in H. pose proof (Rabs_pos (f y - f x - 0)).
  destruct (Req_dec (f y - f x - 0) 0) as [ Z | Z ]; [ lra | ].
  apply Rabs_pos_lt in Z. lra.
Qed.

Lemma slopes_at_same_point : forall N f x g y,
  has_slopes N f x g -> (forall i, (i < N)%nat -> y i = x i) -> has_slopes N f y g.
Proof.
  intros N f x g y S E eps Eps. destruct (S eps Eps) as (d & D & H). exists d. split; [ exact D | ].
  intros z Z. assert (same : distance N x z = distance N y z).
  { apply sum_of_equals. intros i L. rewrite (E i L). reflexivity. }
  rewrite (value_at_same_point N f x g y S E), <- same.
  rewrite (sum_of_equals N _ (fun i => g i * (z i - x i))).
  - apply H. lra.
  - intros i L. rewrite (E i L). reflexivity.
Qed.

Lemma slopes_of_equal_slopes : forall N f x g k,
  has_slopes N f x g -> (forall i, (i < N)%nat -> g i = k i) -> has_slopes N f x k.
Proof.
  intros N f x g k S E eps Eps. destruct (S eps Eps) as (d & D & H). exists d. split; [ exact D | ].
  intros y Y. rewrite (sum_of_equals N _ (fun i => g i * (y i - x i))); [ apply H, Y | ].
  intros i L. rewrite (E i L). reflexivity.
Qed.

(** Functions that agree on a ball around a point have the same slopes there. *)
Lemma slopes_of_equal_near : forall N f k x g,
  has_slopes N f x g ->
  (exists delta, 0 < delta /\ forall y, distance N x y < delta -> k y = f y) ->
  has_slopes N k x g.
Proof.
  intros N f k x g S (e & e_positive & E) eps Eps. destruct (S eps Eps) as (d & D & H).
  exists (Rmin d e). split; [ apply Rmin_pos; assumption | ].
  intros y Y. pose proof (Rmin_l d e). pose proof (Rmin_r d e).
  rewrite (E y), (E x); [ apply H; lra | rewrite distance_to_itself; lra | lra ].
Qed.

Lemma slopes_of_equal_on_open : forall N (U : point -> Prop) f k x g,
  is_open N U -> U x -> (forall y, U y -> k y = f y) -> has_slopes N f x g -> has_slopes N k x g.
Proof.
  intros N U f k x g O X E S. apply (slopes_of_equal_near N f); [ exact S | ].
  destruct (O x X) as (d & D & H). exists d. split; [ exact D | ]. intros y Y. apply E, H, Y.
Qed.

Lemma slopes_of_equal : forall N f k x g,
  (forall y, k y = f y) -> has_slopes N f x g -> has_slopes N k x g.
Proof.
  intros N f k x g E S. apply (slopes_of_equal_near N f); [ exact S | ].
  exists 1. split; [ lra | intros; apply E ].
Qed.

(** * The chain rule *)

(** Near [x] the change of [f] is at most a fixed multiple of the distance. *)
Lemma change_bounded : forall N f x g, has_slopes N f x g ->
  exists delta, 0 < delta /\ forall y, distance N x y < delta ->
    Rabs (f y - f x) <= (1 + sum N (fun i => Rabs (g i))) * distance N x y.
Proof.
  intros N f x g S. destruct (S 1 Rlt_0_1) as (d & D & H). exists d. split; [ exact D | ].
  intros y Y. specialize (H y Y). pose proof (slopes_bound_change N g x y) as B.
  set (s := sum N (fun i => g i * (y i - x i))) in *.
  replace (f y - f x) with (f y - f x - s + s) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

Lemma continuous_where_slopes : forall N f x g, has_slopes N f x g ->
  forall eps, 0 < eps -> exists delta, 0 < delta /\
    forall y, distance N x y < delta -> Rabs (f y - f x) < eps.
Proof.
  intros N f x g S eps Eps. destruct (change_bounded N f x g S) as (d & D & H).
  set (L := 1 + sum N (fun i => Rabs (g i))) in *.
  assert (0 < L).
  { pose proof (sum_nonnegative N (fun i => Rabs (g i)) (fun i _ => Rabs_pos _)). unfold L. lra. }
  assert (0 < eps / L) by (apply Rdiv_lt_0_compat; assumption).
  exists (Rmin d (eps / L)). split; [ apply Rmin_pos; assumption | ].
  intros y Y. pose proof (Rmin_l d (eps / L)). pose proof (Rmin_r d (eps / L)).
  apply Rle_lt_trans with (1 := H y ltac:(lra)).
  replace eps with (L * (eps / L)) by (field; lra). apply Rmult_lt_compat_l; lra.
Qed.

Theorem slopes_of_composition : forall M N (f : point -> R) (F : nat -> point -> R) x g J,
  has_slopes M f (fun j => F j x) g ->
  (forall j, (j < M)%nat -> has_slopes N (F j) x (J j)) ->
  has_slopes N (fun z => f (fun j => F j z)) x (fun i => sum M (fun j => g j * J j i)).
Proof.
  intros M N f F x g J Sf SF eps Eps.
  set (L := 1 + sum M (fun j => 1 + sum N (fun i => Rabs (J j i)))).
  set (G := 1 + sum M (fun j => Rabs (g j))).
  assert (L1 : 1 <= L).
  { unfold L. enough (0 <= sum M (fun j => 1 + sum N (fun i => Rabs (J j i)))) by lra.
    apply sum_nonnegative. intros j _.
    enough (0 <= sum N (fun i => Rabs (J j i))) by lra.
    apply sum_nonnegative. intros. apply Rabs_pos. }
  assert (G1 : 1 <= G).
  { unfold G. enough (0 <= sum M (fun j => Rabs (g j))) by lra.
    apply sum_nonnegative. intros. apply Rabs_pos. }
  assert (e1 : 0 < eps / 2 / L) by (apply Rdiv_lt_0_compat; lra).
  assert (e2 : 0 < eps / 2 / G) by (apply Rdiv_lt_0_compat; lra).
  destruct (Sf _ e1) as (d1 & D1 & Hf).
  destruct (common_ball N x M _ (fun j l => SF j l _ e2)) as (d2 & D2 & HF).
  destruct (common_ball N x M _ (fun j l => change_bounded N (F j) x (J j) (SF j l)))
    as (d3 & D3 & HL).
  assert (D4 : 0 < d1 / L) by (apply Rdiv_lt_0_compat; lra).
  exists (Rmin (d1 / L) (Rmin d2 d3)). split; [ repeat apply Rmin_pos; assumption | ].
  intros y Y.
  pose proof (Rmin_l (d1 / L) (Rmin d2 d3)). pose proof (Rmin_r (d1 / L) (Rmin d2 d3)).
  pose proof (Rmin_l d2 d3). pose proof (Rmin_r d2 d3).
  specialize (HF y ltac:(lra)). specialize (HL y ltac:(lra)).
  pose proof (distance_nonnegative N x y) as Pos.
  set (r := distance N x y) in *.
  assert (image : distance M (fun j => F j x) (fun j => F j y) <= L * r).
  { unfold L. rewrite Rmult_plus_distr_r, <- sum_times.
    apply Rle_trans with (1 := sum_of_less M _ _ HL). lra. }
  assert (near : distance M (fun j => F j x) (fun j => F j y) < d1).
  { apply Rle_lt_trans with (1 := image). replace d1 with (L * (d1 / L)) by (field; lra).
    apply Rmult_lt_compat_l; lra. }
  specialize (Hf _ near).
  replace (sum N (fun i => sum M (fun j => g j * J j i) * (y i - x i)))
    with (sum M (fun j => g j * sum N (fun i => J j i * (y i - x i)))).
  2: { rewrite (sum_of_equals M _ (fun j => sum N (fun i => g j * J j i * (y i - x i)))).
       - rewrite sum_swapped. apply sum_of_equals. intros i _. apply sum_times.
       - intros j _. rewrite <- sum_of_multiple. apply sum_of_equals. intros. ring. }
  set (T := sum M (fun j => g j * (F j y - F j x))) in *.
  set (V := sum M (fun j => g j * sum N (fun i => J j i * (y i - x i)))).
  assert (rest : Rabs (T - V) <= eps / 2 * r).
  { unfold T, V. rewrite <- sum_of_difference.
    apply Rle_trans with (1 := size_of_sum _ _).
    apply Rle_trans with (sum M (fun j => Rabs (g j) * (eps / 2 / G * r))).
    - apply sum_of_less. intros j l. rewrite <- Rmult_minus_distr_l, Rabs_mult.
      apply Rmult_le_compat_l; [ apply Rabs_pos | apply HF, l ].
    - rewrite sum_times. replace (eps / 2 * r) with (G * (eps / 2 / G * r)) by (field; lra).
      apply Rmult_le_compat_r; [ | unfold G; lra ]. apply Rmult_le_pos; lra. }
  replace (f (fun j => F j y) - f (fun j => F j x) - V)
    with (f (fun j => F j y) - f (fun j => F j x) - T + (T - V)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  enough (eps / 2 / L * distance M (fun j => F j x) (fun j => F j y) <= eps / 2 * r) by lra.
  replace (eps / 2 * r) with (eps / 2 / L * (L * r)) by (field; lra).
  apply Rmult_le_compat_l; lra.
Qed.

(** * One real variable *)

Lemma slopes_of_derivative : forall phi (x : point) l,
  derivable_pt_lim phi (x 0%nat) l -> has_slopes 1 (fun z => phi (z 0%nat)) x (fun _ => l).
Proof.
  intros phi x l D eps Eps. destruct (D eps Eps) as [d H]. exists (pos d).
  split; [ apply cond_pos | ]. unfold distance. simpl. intros y Y.
  set (h := y 0%nat - x 0%nat) in *.
  replace (y 0%nat) with (x 0%nat + h) by (unfold h; ring).
  destruct (Req_dec h 0) as [ -> | h_nonzero ].
  - rewrite Rabs_R0, Rplus_0_r. match goal with |- Rabs ?e <= _ => replace e with 0 by ring end.
    rewrite Rabs_R0. lra.
  - specialize (H h h_nonzero ltac:(lra)).
    match goal with |- Rabs ?e <= _ =>
      replace e with (((phi (x 0%nat + h) - phi (x 0%nat)) / h - l) * h) by (field; assumption) end.
    rewrite Rabs_mult, Rplus_0_l. apply Rmult_le_compat_r; [ apply Rabs_pos | lra ].
Qed.

Lemma derivative_of_slopes : forall phi (x g : point),
  has_slopes 1 (fun z => phi (z 0%nat)) x g -> derivable_pt_lim phi (x 0%nat) (g 0%nat).
Proof.
  intros phi x g S eps Eps. destruct (S (eps / 2)) as (d & D & H); [ lra | ].
  exists (mkposreal d D). simpl. intros h h_nonzero h_small.
  specialize (H (fun _ => x 0%nat + h)). unfold distance in H. simpl in H.
  replace (x 0%nat + h - x 0%nat) with h in H by ring. specialize (H ltac:(lra)).
  pose proof (Rabs_pos_lt h h_nonzero) as Pos.
  replace ((phi (x 0%nat + h) - phi (x 0%nat)) / h - g 0%nat)
    with ((phi (x 0%nat + h) - phi (x 0%nat) - (0 + g 0%nat * h)) / h) by (field; assumption).
  unfold Rdiv. rewrite Rabs_mult, Rabs_inv.
  apply Rle_lt_trans with (eps / 2 * (0 + Rabs h) * / Rabs h).
  - apply Rmult_le_compat_r; [ left; apply Rinv_0_lt_compat; exact Pos | exact H ].
  - replace (eps / 2 * (0 + Rabs h) * / Rabs h) with (eps / 2) by (field; lra). lra.
Qed.

Theorem derivative_along_curve : forall N f (z : nat -> R -> R) s (g v : point),
  has_slopes N f (fun j => z j s) g ->
  (forall j, (j < N)%nat -> derivable_pt_lim (z j) s (v j)) ->
  derivable_pt_lim (fun t => f (fun j => z j t)) s (sum N (fun j => g j * v j)).
Proof.
  intros N f z s g v S D.
  apply (derivative_of_slopes (fun t => f (fun j => z j t)) (fun _ => s)
           (fun _ => sum N (fun j => g j * v j))).
  apply (slopes_of_composition N 1 f (fun j w => z j (w 0%nat)) (fun _ => s) g (fun j _ => v j)).
  - exact S.
  - intros j L. apply slopes_of_derivative. apply D, L.
Qed.

Theorem derivative_along_coordinate : forall N f x g i,
  has_slopes N f x g -> (i < N)%nat -> derivable_pt_lim (fun s => f (moved x i s)) (x i) (g i).
Proof.
  intros N f x g i S L.
  replace (g i) with (sum N (fun j => g j * pick i j)).
  2: { rewrite <- (sum_picks N i g L). apply sum_of_equals. intros. ring. }
  apply (derivative_along_curve N f (fun j s => moved x i s j)).
  - apply (slopes_at_same_point N f x); [ exact S | ]. intros j _. unfold moved.
    destruct (Nat.eqb_spec j i) as [ -> | ]; reflexivity.
  - intros j _. unfold moved, pick.
    destruct (Nat.eqb j i); [ apply derivable_pt_lim_id | apply derivable_pt_lim_const ].
Qed.

Theorem slopes_unique : forall N f x g k,
  has_slopes N f x g -> has_slopes N f x k -> forall i, (i < N)%nat -> g i = k i.
Proof.
  intros N f x g k G K i L. apply (uniqueness_limite (fun s => f (moved x i s)) (x i)).
  - apply (derivative_along_coordinate N); assumption.
  - apply (derivative_along_coordinate N); assumption.
Qed.
