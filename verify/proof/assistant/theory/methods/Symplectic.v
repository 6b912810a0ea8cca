(** What it is for a map of phase space to be symplectic at a point.

    With n degrees of freedom the coordinates 0 .. n-1 are the momenta p_1 .. p_n, and n .. 2n-1 are
    the positions q_1 .. q_n. A map is given by its 2n components, F i being the new coordinate of
    number i. *)

From Coq Require Import Reals Lra Lia List.
From AreaPreservation Require Import Sums Differential Slopes.
Local Open Scope R_scope.

(** The canonical form dp^dq in the directions of the coordinates a and b, for a, b < 2n: the first
    condition then says that a is a momentum and b its position, the second the reverse. *)
Definition pairing (n a b : nat) : R :=
  if Nat.eqb b (n + a) then 1 else if Nat.eqb a (n + b) then -1 else 0.

(** The canonical form on two vectors. *)
Definition skew (n : nat) (u v : point) : R :=
  sum n (fun i => u i * v (n + i)%nat - v i * u (n + i)%nat).

(** [J i a] is the slope of the new coordinate i along the old coordinate a. *)
Definition preserves_form (n : nat) (J : nat -> nat -> R) : Prop :=
  forall a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    sum n (fun i => J i a * J (n + i)%nat b - J i b * J (n + i)%nat a) = pairing n a b.

Definition symplectic_at (n : nat) (F : nat -> point -> R) (x : point) : Prop :=
  exists J : nat -> nat -> R,
    (forall i, (i < 2 * n)%nat -> has_slopes (2 * n) (F i) x (J i)) /\ preserves_form n J.

(** What holds for all points of a ball around [x]. *)
Definition near (N : nat) (x : point) (P : point -> Prop) : Prop :=
  exists delta, 0 < delta /\ forall y, distance N x y < delta -> P y.

Lemma near_weaker : forall N x (P Q : point -> Prop),
  (forall y, P y -> Q y) -> near N x P -> near N x Q.
Proof. intros N x P Q I (d & D & H). exists d. split; [ exact D | ]. intros y Y. apply I, H, Y. Qed.

Lemma near_everywhere : forall N x (P : point -> Prop), (forall y, P y) -> near N x P.
Proof. intros N x P H. exists 1. split; [ lra | intros; apply H ]. Qed.

(** * The form is bilinear and alternating *)

Lemma skew_of_equals : forall n u v u' v',
  (forall i, (i < 2 * n)%nat -> u i = u' i) -> (forall i, (i < 2 * n)%nat -> v i = v' i) ->
  skew n u v = skew n u' v'.
Proof.
  intros n u v u' v' U V. apply sum_of_equals. intros i L. rewrite !U, !V by lia. reflexivity.
Qed.

Lemma skew_swapped : forall n u v, skew n u v = - skew n v u.
Proof. intros. unfold skew. rewrite <- sum_of_opposite. apply sum_of_equals. intros. ring. Qed.

Lemma skew_left : forall n u v w c,
  skew n (fun i => u i + c * v i) w = skew n u w + c * skew n v w.
Proof.
  intros. unfold skew. rewrite <- sum_of_multiple, <- sum_of_sum.
  apply sum_of_equals. intros. ring.
Qed.

Lemma skew_right : forall n u v w c,
  skew n u (fun i => v i + c * w i) = skew n u v + c * skew n u w.
Proof.
  intros. rewrite skew_swapped, skew_left, (skew_swapped n v), (skew_swapped n w). ring.
Qed.

Lemma skew_sum_left : forall n m (K : nat -> point) (b v : point),
  skew n (fun i => sum m (fun j => b j * K j i)) v = sum m (fun j => b j * skew n (K j) v).
Proof.
  intros n m K b v. induction m; simpl.
  - apply sum_of_zeros. intros. ring.
  - rewrite skew_left, IHm. reflexivity.
Qed.

Lemma skew_sum_right : forall n m (K : nat -> point) (b u : point),
  skew n u (fun i => sum m (fun j => b j * K j i)) = sum m (fun j => b j * skew n u (K j)).
Proof.
  intros. rewrite skew_swapped, skew_sum_left, <- sum_of_opposite. apply sum_of_equals.
  intros j _. rewrite (skew_swapped n u). ring.
Qed.

(** All cases of which numbers of coordinates are equal. *)
Ltac compare_numbers :=
  repeat match goal with |- context [Nat.eqb ?a ?b] => destruct (Nat.eqb_spec a b) end;
  try lia; lra.

Lemma identity_preserves_form : forall n, preserves_form n pick.
Proof.
  assert (half : forall n a b, (b < 2 * n)%nat ->
    sum n (fun i => pick i a * pick (n + i) b) = if Nat.eqb b (n + a) then 1 else 0).
  { intros n a b B. destruct (Nat.lt_ge_cases a n) as [ L | L ].
    - etransitivity; [ | exact (sum_picks n a (fun i => pick (n + i) b) L) ].
      apply sum_of_equals. intros i _. f_equal. unfold pick. rewrite Nat.eqb_sym. reflexivity.
    - rewrite (proj2 (Nat.eqb_neq b (n + a))) by lia. apply sum_of_zeros. intros i I.
      unfold pick. rewrite (proj2 (Nat.eqb_neq a i)) by lia. apply Rmult_0_l. }
  intros n a b A B. unfold pairing. rewrite sum_of_difference, !half by assumption.
  destruct (Nat.eqb_spec b (n + a)); destruct (Nat.eqb_spec a (n + b)); lia || lra.
Qed.

(** A matrix that preserves the form in the directions of the coordinates does so in all. *)
Lemma skew_of_images : forall n J u v, preserves_form n J ->
  skew n (fun i => sum (2 * n) (fun a => u a * J i a))
    (fun i => sum (2 * n) (fun a => v a * J i a))
    = skew n u v.
Proof.
  assert (expand : forall n J u v, preserves_form n J ->
    skew n (fun i => sum (2 * n) (fun a => u a * J i a))
      (fun i => sum (2 * n) (fun a => v a * J i a))
      = sum (2 * n) (fun a => u a * sum (2 * n) (fun b => v b * pairing n a b))).
  { intros n J u v P. rewrite (skew_sum_left n (2 * n) (fun a i => J i a)).
    apply sum_of_equals. intros a A. f_equal.
    rewrite (skew_sum_right n (2 * n) (fun a i => J i a)).
    apply sum_of_equals. intros b B. f_equal. apply P; assumption. }
  intros n J u v P. rewrite (expand n J u v P), <- (expand n pick u v (identity_preserves_form n)).
  apply skew_of_equals; intros i L.
  - rewrite <- (sum_picks _ i u L). apply sum_of_equals. intros a _. unfold pick.
    rewrite Nat.eqb_sym. ring.
  - rewrite <- (sum_picks _ i v L). apply sum_of_equals. intros a _. unfold pick.
    rewrite Nat.eqb_sym. ring.
Qed.

(** * Compositions *)

Lemma identity_symplectic : forall n x, symplectic_at n (fun i z => z i) x.
Proof.
  intros n x. exists pick. split; [ | apply identity_preserves_form ].
  intros i L. apply slopes_of_equal_slopes with (pick i); [ apply slopes_of_coordinate, L | ].
  reflexivity.
Qed.

Theorem composition_symplectic : forall n (F G : nat -> point -> R) x,
  symplectic_at n F x -> symplectic_at n G (fun j => F j x) ->
  symplectic_at n (fun i z => G i (fun j => F j z)) x.
Proof.
  intros n F G x (J & SJ & PJ) (K & SK & PK).
  exists (fun i a => sum (2 * n) (fun j => K i j * J j a)). split.
  - intros i L. apply (slopes_of_composition (2 * n)); [ apply SK, L | exact SJ ].
  - intros a b A B. rewrite <- (PJ a b A B).
    pose proof (skew_of_images n K (fun j => J j a) (fun j => J j b) PK) as E. unfold skew in E.
    rewrite <- E. apply sum_of_equals. intros i _.
    f_equal; f_equal; apply sum_of_equals; intros; ring.
Qed.

(** One step after another, the first of the list first. *)
Fixpoint steps_of (l : list (nat -> point -> R)) (i : nat) (z : point) : R :=
  match l with
  | nil => z i
  | F :: rest => steps_of rest i (fun j => F j z)
  end.

(** Each step is symplectic at the point that the steps before it lead to. *)
Fixpoint each_symplectic (n : nat) (l : list (nat -> point -> R)) (x : point) : Prop :=
  match l with
  | nil => True
  | F :: rest => symplectic_at n F x /\ each_symplectic n rest (fun j => F j x)
  end.

Theorem steps_symplectic : forall n l x,
  each_symplectic n l x -> symplectic_at n (steps_of l) x.
Proof.
  intros n l. induction l as [ | F rest IH ]; intros x E.
  - apply identity_symplectic.
  - destruct E as (HF & HR). exact (composition_symplectic n F (steps_of rest) x HF (IH _ HR)).
Qed.

(** It does not matter which slopes are looked at, since there is but one choice. *)
Theorem any_slopes_preserve_form : forall n F x J, symplectic_at n F x ->
  (forall i, (i < 2 * n)%nat -> has_slopes (2 * n) (F i) x (J i)) -> preserves_form n J.
Proof.
  intros n F x J (K & SK & P) SJ a b A B. rewrite <- (P a b A B).
  assert (E : forall i c, (i < 2 * n)%nat -> (c < 2 * n)%nat -> J i c = K i c).
  { intros i c I C.
    apply (slopes_unique (2 * n) (F i) x); [ apply SJ, I | apply SK, I | exact C ]. }
  apply sum_of_equals. intros i I. rewrite !E by lia. reflexivity.
Qed.

(** * One degree of freedom: area *)

(** The determinant of the slopes of a symplectic map is 1. *)
Theorem determinant_one : forall F x J, symplectic_at 1 F x ->
  (forall i, (i < 2)%nat -> has_slopes 2 (F i) x (J i)) ->
  J 0%nat 0%nat * J 1%nat 1%nat - J 0%nat 1%nat * J 1%nat 0%nat = 1.
Proof.
  intros F x J S SJ.
  pose proof (any_slopes_preserve_form 1 F x J S SJ 0%nat 1%nat ltac:(lia) ltac:(lia)) as D.
  unfold pairing in D. simpl in D. lra.
Qed.

(** The slopes of the new momentum and position along the old ones, and their determinant. *)
Theorem area_preserved : forall F x, symplectic_at 1 F x ->
  exists A B C D : R,
    derivable_pt_lim (fun s => F 0%nat (moved x 0 s)) (x 0%nat) A /\
    derivable_pt_lim (fun s => F 0%nat (moved x 1 s)) (x 1%nat) B /\
    derivable_pt_lim (fun s => F 1%nat (moved x 0 s)) (x 0%nat) C /\
    derivable_pt_lim (fun s => F 1%nat (moved x 1 s)) (x 1%nat) D /\
    A * D - B * C = 1.
Proof.
  intros F x S. pose proof S as (J & SJ & P).
  exists (J 0%nat 0%nat), (J 0%nat 1%nat), (J 1%nat 0%nat), (J 1%nat 1%nat).
  repeat split; try (apply (derivative_along_coordinate 2); [ apply SJ; lia | lia ]).
  apply (determinant_one F x); assumption.
Qed.

(** The linear map of a matrix with two rows; its area is the determinant. *)
Definition linear (M : nat -> nat -> R) (i : nat) (z : point) : R :=
  M i 0%nat * z 0%nat + M i 1%nat * z 1%nat.

Lemma slopes_of_linear_map : forall M x i, has_slopes 2 (linear M i) x (M i).
Proof. intros. apply slopes_of_linear. intros y. unfold linear. simpl. ring. Qed.

(** So a map that changes the area is not symplectic: controls in the later files rest on this. *)
Theorem linear_map_symplectic : forall M x, symplectic_at 1 (linear M) x <->
  M 0%nat 0%nat * M 1%nat 1%nat - M 0%nat 1%nat * M 1%nat 0%nat = 1.
Proof.
  intros M x. split; intros H.
  - apply (determinant_one (linear M) x); [ exact H | ]. intros. apply slopes_of_linear_map.
  - exists M. split; [ intros; apply slopes_of_linear_map | ]. unfold preserves_form, pairing.
    intros [ | [ | a ] ] [ | [ | b ] ] A B; try lia; simpl; lra.
Qed.
