(** A stage of a one-step method, in which momentum and position are taken at points between the old
    and the new values, is symplectic.

    With the Hamiltonian H, the stage maps y to F y by
      p' = p - h k H_q(P, Q),   q' = q + h d H_p(P, Q),
      P = p + s (p' - p),       Q = q + u (q' - q).
    The conditions are k d (1 - s - u) = 0, and either k = d or H a sum T(p) + V(q). *)

From Coq Require Import Reals Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Symplectic.
Local Open Scope R_scope.

(** [s] for the numbers of momenta and [u] for those of positions. *)
Definition weight (n : nat) (s u : R) (j : nat) : R := if Nat.ltb j n then s else u.

Definition stage_point (n : nat) (s u : R) (F : nat -> point -> R) (y : point) : point :=
  fun j => y j + weight n s u j * (F j y - y j).

(** The equations of the stage at the point [y]; [H1 j] is the slope of H along coordinate j. *)
Definition solves_stage (n : nat) (h k d s u : R) (H1 F : nat -> point -> R) (y : point) : Prop :=
  forall i, (i < n)%nat ->
    F i y = y i - h * k * H1 (n + i)%nat (stage_point n s u F y) /\
    F (n + i)%nat y = y (n + i)%nat + h * d * H1 i (stage_point n s u F y).

Definition symmetric (m : nat) (S : nat -> nat -> R) : Prop :=
  forall j l, (j < m)%nat -> (l < m)%nat -> S j l = S l j.

(** No momentum meets a position: H is a sum of a function of p and a function of q. *)
Definition separated (n : nat) (S : nat -> nat -> R) : Prop :=
  forall i j, (i < n)%nat -> (j < n)%nat -> S i (n + j)%nat = 0 /\ S (n + i)%nat j = 0.

(** The value of a matrix on a vector. *)
Definition image (m : nat) (S : nat -> nat -> R) (v : point) : point :=
  fun j => sum m (fun l => S j l * v l).

Lemma symmetric_product : forall m S u v, symmetric m S ->
  sum m (fun j => u j * image m S v j) = sum m (fun j => v j * image m S u j).
Proof.
  intros m S u v E. unfold image.
  rewrite (sum_of_equals m _ (fun j => sum m (fun l => u j * S j l * v l))).
  - rewrite sum_swapped. apply sum_of_equals. intros l L. rewrite <- sum_of_multiple.
    apply sum_of_equals. intros j J. rewrite (E j l) by assumption. ring.
  - intros j _. rewrite <- sum_of_multiple. apply sum_of_equals. intros. ring.
Qed.

(** Momenta and positions apart. *)
Lemma separated_image : forall n S v i, separated n S -> (i < n)%nat ->
  image (2 * n) S v i = image n S v i /\
  image (2 * n) S v (n + i)%nat
    = image n (fun j l => S (n + j)%nat (n + l)%nat) (fun l => v (n + l)%nat) i.
Proof.
  intros n S v i E I. unfold image. replace (2 * n)%nat with (n + n)%nat by lia.
  rewrite !sum_in_two_parts. split.
  - rewrite (sum_of_zeros n (fun j => S i (n + j)%nat * _)); [ ring | ].
    intros j J. destruct (E i j I J) as [ -> _ ]. ring.
  - rewrite (sum_of_zeros n (fun j => S (n + i)%nat j * _)); [ ring | ].
    intros j J. destruct (E i j I J) as [ _ -> ]. ring.
Qed.

(** What a stage adds to the form, when [g] and [g'] are the changes of the gradient that go with
    the changes [z] and [z'] of the stage's point. *)
Lemma gradients_cancel : forall n k d S z z', symmetric (2 * n) S -> k = d \/ separated n S ->
  d * sum n (fun i => z i * image (2 * n) S z' i - z' i * image (2 * n) S z i) +
  k * sum n (fun i => z (n + i)%nat * image (2 * n) S z' (n + i)%nat
                    - z' (n + i)%nat * image (2 * n) S z (n + i)%nat) = 0.
Proof.
  intros n k d S z z' E [ <- | Sep ].
  - rewrite <- Rmult_plus_distr_l.
    pose proof (symmetric_product (2 * n) S z z' E) as P.
    replace (2 * n)%nat with (n + n)%nat in * by lia. rewrite !sum_in_two_parts in P.
    rewrite !sum_of_difference. match goal with |- _ * ?e = 0 => replace e with 0 by lra end. ring.
  - rewrite (sum_of_equals n _ (fun i => z i * image n S z' i - z' i * image n S z i)).
    2: { intros i I. rewrite !(proj1 (separated_image n S _ i Sep I)). reflexivity. }
    set (T := fun j l => S (n + j)%nat (n + l)%nat).
    rewrite (sum_of_equals n (fun i => z (n + i)%nat * _ - _)
      (fun i => z (n + i)%nat * image n T (fun l => z' (n + l)%nat) i
              - z' (n + i)%nat * image n T (fun l => z (n + l)%nat) i)).
    2: { intros i I. rewrite !(proj2 (separated_image n S _ i Sep I)). reflexivity. }
    rewrite !sum_of_difference, (symmetric_product n S z z').
    2: { intros j l J L. apply E; lia. }
    rewrite (symmetric_product n T (fun l => z (n + l)%nat) (fun l => z' (n + l)%nat)).
    2: { intros j l J L. apply E; lia. }
    ring.
Qed.

(** The stage's equations for slopes: J those of the new coordinates, Z those of the stage's point,
    S the second derivative of H there. *)
Lemma stage_matrix : forall n h k d s u (S J Z : nat -> nat -> R),
  symmetric (2 * n) S -> k * d * (1 - s - u) = 0 -> k = d \/ separated n S ->
  (forall j a, (j < 2 * n)%nat -> (a < 2 * n)%nat ->
     Z j a = pick j a + weight n s u j * (J j a - pick j a)) ->
  (forall i a, (i < n)%nat -> (a < 2 * n)%nat ->
     J i a = pick i a - h * k * image (2 * n) S (fun l => Z l a) (n + i)%nat /\
     J (n + i)%nat a = pick (n + i)%nat a + h * d * image (2 * n) S (fun l => Z l a) i) ->
  preserves_form n J.
Proof.
  intros n h k d s u S J Z E C KD EZ EJ a b A B. rewrite <- (identity_preserves_form n a b A B).
  pose proof (gradients_cancel n k d S (fun l => Z l a) (fun l => Z l b) E KD) as G.
  apply Rminus_diag_uniq. rewrite <- sum_of_difference.
  match goal with |- ?e = 0 => replace e with (h * 0); [ ring | ] end. rewrite <- G.
  rewrite Rmult_plus_distr_l, <- !sum_of_multiple, <- sum_of_sum.
  apply sum_of_equals. intros i I.
  pose proof (EZ i a ltac:(lia) A) as Za. pose proof (EZ i b ltac:(lia) B) as Zb.
  pose proof (EZ (n + i)%nat a ltac:(lia) A) as Ya.
  pose proof (EZ (n + i)%nat b ltac:(lia) B) as Yb.
  unfold weight in *. rewrite (proj2 (Nat.ltb_lt i n) I) in *.
  rewrite (proj2 (Nat.ltb_ge (n + i) n) ltac:(lia)) in *.
  destruct (EJ i a I A) as (Ja & La). destruct (EJ i b I B) as (Jb & Lb).
  set (ga := image (2 * n) S (fun l => Z l a)) in *.
  set (gb := image (2 * n) S (fun l => Z l b)) in *.
  cbv beta. rewrite Za, Zb, Ya, Yb, Ja, Jb, La, Lb.
  match goal with |- ?x = ?y => apply Rminus_diag_uniq;
    replace (x - y) with (- h * h * (ga i * gb (n + i)%nat - gb i * ga (n + i)%nat)
                            * (k * d * (1 - s - u))) by ring end.
  rewrite C. ring.
Qed.

(** * The stage theorem *)

(** The slopes of the stage's point. *)
Lemma slopes_of_stage_point : forall n s u F x (J : nat -> nat -> R),
  (forall i, (i < 2 * n)%nat -> has_slopes (2 * n) (F i) x (J i)) ->
  forall j, (j < 2 * n)%nat ->
    has_slopes (2 * n) (fun y => stage_point n s u F y j) x
      (fun a => pick j a + weight n s u j * (J j a - pick j a)).
Proof.
  intros n s u F x J SJ j L. apply slopes_of_sum; [ apply slopes_of_coordinate, L | ].
  apply slopes_of_multiple, slopes_of_difference; [ apply SJ, L | apply slopes_of_coordinate, L ].
Qed.

(** The new coordinates are only asked to have some slopes; which ones follows from the equations,
    that need not be solved for this. *)
Theorem stage_symplectic : forall n h k d s u (H1 F : nat -> point -> R) (x : point)
    (H2 : nat -> nat -> R),
  near (2 * n) x (solves_stage n h k d s u H1 F) ->
  (forall i, (i < 2 * n)%nat -> exists g, has_slopes (2 * n) (F i) x g) ->
  (forall j, (j < 2 * n)%nat -> has_slopes (2 * n) (H1 j) (stage_point n s u F x) (H2 j)) ->
  symmetric (2 * n) H2 ->
  k * d * (1 - s - u) = 0 ->
  k = d \/ separated n H2 ->
  symplectic_at n F x.
Proof.
  intros n h k d s u H1 F x H2 Eq Some Second E C KD.
  destruct (choice_of_slopes (2 * n) (2 * n) F x Some) as (J & SJ).
  exists J. split; [ exact SJ | ].
  set (Z := fun j a => pick j a + weight n s u j * (J j a - pick j a)).
  assert (SG : forall j, (j < 2 * n)%nat ->
    has_slopes (2 * n) (fun y => H1 j (stage_point n s u F y)) x
      (fun a => image (2 * n) H2 (fun l => Z l a) j)).
  { intros j L. apply (slopes_of_composition (2 * n) (2 * n) (H1 j)
                         (fun l y => stage_point n s u F y l)); [ apply Second, L | ].
    apply slopes_of_stage_point, SJ. }
  apply (stage_matrix n h k d s u H2 J Z E C KD); [ reflexivity | ].
  intros i a I A. split.
  - apply (slopes_unique (2 * n) (F i) x (J i)
             (fun a => pick i a - h * k * image (2 * n) H2 (fun l => Z l a) (n + i)%nat));
      [ apply SJ; lia | | exact A ].
    apply (slopes_of_equal_near (2 * n)
             (fun y => y i - h * k * H1 (n + i)%nat (stage_point n s u F y))).
    + apply (slopes_of_difference (2 * n) (fun y => y i)); [ apply slopes_of_coordinate; lia | ].
      apply slopes_of_multiple, SG. lia.
    + refine (near_weaker _ _ _ _ _ Eq). intros y Y. apply (Y i I).
  - apply (slopes_unique (2 * n) (F (n + i)%nat) x (J (n + i)%nat)
             (fun a => pick (n + i) a + h * d * image (2 * n) H2 (fun l => Z l a) i));
      [ apply SJ; lia | | exact A ].
    apply (slopes_of_equal_near (2 * n)
             (fun y => y (n + i)%nat + h * d * H1 i (stage_point n s u F y))).
    + apply (slopes_of_sum (2 * n) (fun y => y (n + i)%nat)); [ apply slopes_of_coordinate; lia | ].
      apply slopes_of_multiple, SG. lia.
    + refine (near_weaker _ _ _ _ _ Eq). intros y Y. apply (Y i I).
Qed.

(** * Controls: the conditions are met by something, and each is needed *)

(** The stage for H = (p^2 + q^2)/2 as a map, when it can be solved. *)
Definition oscillator_stage (h k d s u : R) (i a : nat) : R :=
  let e := 1 + s * u * (h * h * k * d) in
  match i, a with
  | O, O => 1 - h * h * k * d * u / e
  | O, _ => - (h * k / e)
  | _, O => h * d / e
  | _, _ => 1 - h * h * k * d * s / e
  end.

Lemma oscillator_stage_solves : forall h k d s u y, 1 + s * u * (h * h * k * d) <> 0 ->
  solves_stage 1 h k d s u (fun j z => z j) (linear (oscillator_stage h k d s u)) y.
Proof.
  intros h k d s u y E i L. replace i with 0%nat by lia.
  unfold stage_point, weight, linear, oscillator_stage. simpl. split; field; exact E.
Qed.

Theorem condition_on_weights_exact : forall h k d s u x,
  1 + s * u * (h * h * k * d) <> 0 -> h <> 0 ->
  symplectic_at 1 (linear (oscillator_stage h k d s u)) x <-> k * d * (1 - s - u) = 0.
Proof.
  intros h k d s u x E h_nonzero. split; intros C.
  - apply linear_map_symplectic in C. simpl in C.
    set (e := 1 + s * u * (h * h * k * d)) in *.
    apply (f_equal (fun t => (t - 1) * e / (h * h))) in C.
    replace ((1 - 1) * e / (h * h)) with 0 in C by (field; exact h_nonzero).
    rewrite <- C. unfold e in *. field. split; assumption.
  - apply (stage_symplectic 1 h k d s u (fun j z => z j) _ x pick).
    + apply near_everywhere. intros y. apply oscillator_stage_solves, E.
    + intros i _. exists (oscillator_stage h k d s u i). apply slopes_of_linear_map.
    + intros j L. apply slopes_of_coordinate, L.
    + intros j l _ _. unfold pick. rewrite Nat.eqb_sym. reflexivity.
    + exact C.
    + right. intros i j I L. unfold pick. split; compare_numbers.
Qed.

(** The stage for H = p q with d = 0, s = u = 0: explicit in p, and q stays. *)
Definition mixed_stage (h k : R) (i a : nat) : R :=
  match i, a with
  | O, O => 1 - h * k
  | O, _ => 0
  | _, O => 0
  | _, _ => 1
  end.

Lemma mixed_stage_solves : forall h k y,
  solves_stage 1 h k 0 0 0 (fun j z => z (1 - j)%nat) (linear (mixed_stage h k)) y.
Proof.
  intros h k y i L. replace i with 0%nat by lia.
  unfold stage_point, weight, linear, mixed_stage. simpl. split; ring.
Qed.

Theorem condition_on_mixed_needed : forall h k x,
  h <> 0 -> symplectic_at 1 (linear (mixed_stage h k)) x -> k = 0.
Proof.
  intros h k x h_nonzero S. apply linear_map_symplectic in S. simpl in S.
  apply Rmult_eq_reg_l with h; [ lra | exact h_nonzero ].
Qed.
