(** Kicks and drifts, the steps of splitting methods, and any list of them. *)

From Coq Require Import Reals Lra Lia List Bool.
From AreaPreservation Require Import Sums Differential Slopes Symplectic Stages.
Local Open Scope R_scope.

(** p' = p - h k H_q(q), where H depends on q only; [H1 j] is its slope along coordinate j. *)
Definition kick (n : nat) (h k : R) (H1 : nat -> point -> R) (i : nat) (y : point) : R :=
  if Nat.ltb i n then y i - h * k * H1 (n + i)%nat y else y i.

(** q' = q + h d H_p(p), where H depends on p only. *)
Definition drift (n : nat) (h d : R) (H1 : nat -> point -> R) (i : nat) (y : point) : R :=
  if Nat.ltb i n then y i else y i + h * d * H1 (i - n)%nat y.

Lemma image_of_unit : forall m S a j, (a < m)%nat -> image m S (fun l => pick l a) j = S j a.
Proof.
  intros m S a j A. unfold image. rewrite <- (sum_picks m a (S j) A). apply sum_of_equals.
  intros l _. unfold pick. rewrite Nat.eqb_sym. ring.
Qed.

(** The numbers of coordinates told apart. *)
Ltac sides :=
  repeat match goal with
    | |- context [Nat.ltb ?a ?b] => destruct (Nat.ltb_spec a b); try lia; simpl
    end.

Theorem kick_symplectic : forall n h k H1 x (H2 : nat -> nat -> R),
  (forall i, (i < n)%nat -> has_slopes (2 * n) (H1 (n + i)%nat) x (H2 (n + i)%nat)) ->
  (forall i j, (i < n)%nat -> (j < n)%nat -> H2 (n + i)%nat j = 0 /\
     H2 (n + i)%nat (n + j)%nat = H2 (n + j)%nat (n + i)%nat) ->
  symplectic_at n (kick n h k H1) x.
Proof.
  intros n h k H1 x H2 Second E.
  exists (fun i a => if Nat.ltb i n then pick i a - h * k * H2 (n + i)%nat a else pick i a). split.
  - intros i I. unfold kick. destruct (Nat.ltb_spec i n) as [ L | G ].
    + apply slopes_of_difference; [ apply slopes_of_coordinate, I | ].
      apply slopes_of_multiple, Second, L.
    + apply slopes_of_coordinate, I.
  - apply (stage_matrix n h k 0 0 0
             (fun j l => if Nat.ltb j n || Nat.ltb l n then 0 else H2 j l) _ pick).
    + intros j l J L. sides; try reflexivity.
      replace j with (n + (j - n))%nat by lia. replace l with (n + (l - n))%nat by lia.
      apply E; lia.
    + ring.
    + right. intros i j I J. sides. split; reflexivity.
    + intros. unfold weight. sides; ring.
    + intros i a I A. rewrite !image_of_unit by exact A. sides; split; try ring.
      rewrite (proj1 (E i a I ltac:(assumption))). ring.
Qed.

Theorem drift_symplectic : forall n h d H1 x (H2 : nat -> nat -> R),
  (forall i, (i < n)%nat -> has_slopes (2 * n) (H1 i) x (H2 i)) ->
  (forall i j, (i < n)%nat -> (j < n)%nat -> H2 i (n + j)%nat = 0 /\ H2 i j = H2 j i) ->
  symplectic_at n (drift n h d H1) x.
Proof.
  intros n h d H1 x H2 Second E.
  exists (fun i a => if Nat.ltb i n then pick i a else pick i a + h * d * H2 (i - n)%nat a). split.
  - intros i I. unfold drift. destruct (Nat.ltb_spec i n) as [ L | G ].
    + apply slopes_of_coordinate, I.
    + apply slopes_of_sum; [ apply slopes_of_coordinate, I | ].
      apply slopes_of_multiple, Second. lia.
  - apply (stage_matrix n h 0 d 0 0
             (fun j l => if Nat.ltb j n && Nat.ltb l n then H2 j l else 0) _ pick).
    + intros j l J L. sides; try reflexivity. apply E; assumption.
    + ring.
    + right. intros i j I J. sides. split; reflexivity.
    + intros. unfold weight. sides; ring.
    + intros i a I A. rewrite !image_of_unit by exact A. replace (n + i - n)%nat with i by lia.
      sides; split; try ring.
      replace a with (n + (a - n))%nat by lia. rewrite (proj1 (E i (a - n)%nat I ltac:(lia))). ring.
Qed.

(** A control: with two degrees of freedom, p_1' = p_1 - h q_2 is no kick with a gradient, and is
    symplectic for h = 0 only. *)
Theorem kick_without_gradient : forall h x,
  symplectic_at 2 (kick 2 h 1 (fun j z => match j with 2%nat => z 3%nat | _ => 0 end)) x -> h = 0.
Proof.
  intros h x S.
  set (slopes := fun i a => match i with O => pick 0 a - h * 1 * pick 3 a | _ => pick i a end).
  assert (SJ : forall i, (i < 2 * 2)%nat -> has_slopes (2 * 2)
    (kick 2 h 1 (fun j z => match j with 2%nat => z 3%nat | _ => 0 end) i) x (slopes i)).
  { intros [ | [ | i ] ] I.
    - apply (slopes_of_difference 4 (fun z => z 0%nat)); [ apply slopes_of_coordinate; lia | ].
      apply slopes_of_multiple, slopes_of_coordinate. lia.
    - apply (slopes_of_equal 4 (fun z => z 1%nat));
        [ intros; unfold kick; simpl; ring | apply slopes_of_coordinate; lia ].
    - apply slopes_of_coordinate, I. }
  pose proof (any_slopes_preserve_form 2 _ x slopes S SJ 2%nat 3%nat ltac:(lia) ltac:(lia)) as P.
  unfold pairing, slopes, pick in P. simpl in P. lra.
Qed.
