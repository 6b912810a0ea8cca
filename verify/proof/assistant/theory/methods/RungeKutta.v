(** Runge-Kutta methods whose weights satisfy b_i a_ij + b_j a_ji = b_i b_j are symplectic. *)

From Coq Require Import Reals Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Symplectic Stages.
Local Open Scope R_scope.

(** From the gradient (H_p, H_q) to the field (-H_q, H_p). *)
Definition turned (n : nat) (g : point) (c : nat) : R :=
  if Nat.ltb c n then - g (n + c)%nat else g (c - n)%nat.

(** The equations of a method with m stages at the point [y]: [Z i y] is the point of stage i and
    [H1 i c] the slope of H along coordinate c, for H at the time of stage i. *)
Definition solves_method (n m : nat) (h : R) (A : nat -> nat -> R) (b : nat -> R)
    (H1 : nat -> nat -> point -> R) (Z : nat -> point -> point) (F : nat -> point -> R)
    (y : point) : Prop :=
  (forall i c, (i < m)%nat -> (c < 2 * n)%nat ->
    Z i y c = y c + h * sum m (fun j => A i j * turned n (fun l => H1 j l (Z j y)) c)) /\
  (forall c, (c < 2 * n)%nat ->
    F c y = y c + h * sum m (fun j => b j * turned n (fun l => H1 j l (Z j y)) c)).

Definition symplectic_weights (m : nat) (A : nat -> nat -> R) (b : nat -> R) : Prop :=
  forall i j, (i < m)%nat -> (j < m)%nat -> b i * A i j + b j * A j i - b i * b j = 0.

Lemma skew_with_turned : forall n u g,
  skew n u (turned n g) = sum (2 * n) (fun c => u c * g c).
Proof.
  intros n u g. replace (2 * n)%nat with (n + n)%nat by lia.
  rewrite sum_in_two_parts, <- sum_of_sum. apply sum_of_equals. intros i L. unfold turned.
  rewrite (proj2 (Nat.ltb_lt i n) L), (proj2 (Nat.ltb_ge (n + i) n) ltac:(lia)).
  replace (n + i - n)%nat with i by lia. ring.
Qed.

(** Each stage by itself keeps the form, to first order. *)
Lemma stage_keeps_form : forall n S u v, symmetric (2 * n) S ->
  skew n u (turned n (image (2 * n) S v)) + skew n (turned n (image (2 * n) S u)) v = 0.
Proof.
  intros n S u v E. rewrite (skew_swapped n _ v), !skew_with_turned, (symmetric_product _ S u v E).
  ring.
Qed.

(** What the stages add to the form together, [W i j] being the form on their fields. *)
Lemma weights_cancel : forall m A b (W : nat -> nat -> R), symplectic_weights m A b ->
  sum m (fun i => b i * (sum m (fun j => A i j * W j i) + sum m (fun j => A i j * W i j)
                         - sum m (fun j => b j * W i j))) = 0.
Proof.
  intros m A b W M.
  rewrite (sum_of_equals m _ (fun i => sum m (fun j => b i * A i j * W j i)
    + sum m (fun j => (b i * A i j - b i * b j) * W i j))).
  - rewrite sum_of_sum, sum_swapped, <- sum_of_sum. apply sum_of_zeros. intros i I.
    rewrite <- sum_of_sum. apply sum_of_zeros. intros j L. specialize (M i j I L).
    replace (b j * A j i * W i j + (b i * A i j - b i * b j) * W i j)
      with ((b i * A i j + b j * A j i - b i * b j) * W i j) by ring.
    rewrite M. ring.
  - intros i _. rewrite <- !sum_of_sum, <- sum_of_difference, <- sum_of_multiple.
    apply sum_of_equals. intros. ring.
Qed.

(** The equations for slopes: J those of the new coordinates, Z i those of the point of stage i,
    S i the second derivative of H there. *)
Lemma method_matrix : forall n m h A b (S Z : nat -> nat -> nat -> R) (J : nat -> nat -> R),
  symplectic_weights m A b ->
  (forall i, (i < m)%nat -> symmetric (2 * n) (S i)) ->
  (forall i c a, (i < m)%nat -> (c < 2 * n)%nat -> (a < 2 * n)%nat -> Z i c a =
     pick c a + h * sum m (fun j => A i j * turned n (image (2 * n) (S j) (fun l => Z j l a)) c)) ->
  (forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat -> J c a =
     pick c a + h * sum m (fun j => b j * turned n (image (2 * n) (S j) (fun l => Z j l a)) c)) ->
  preserves_form n J.
Proof.
  intros n m h A b S Z J M E EZ EJ a a' La La'.
  rewrite <- (identity_preserves_form n a a' La La').
  set (K := fun a j => turned n (image (2 * n) (S j) (fun l => Z j l a))).
  set (e := fun a c => pick c a). set (W := fun i j => skew n (K a i) (K a' j)).
  set (new := fun c => e a' c + h * sum m (fun j => b j * K a' j c)).
  change (skew n (fun c => J c a) (fun c => J c a') = skew n (e a) (e a')).
  rewrite (skew_of_equals n _ _ (fun c => e a c + h * sum m (fun j => b j * K a j c)) new)
    by (intros; apply EJ; assumption).
  assert (split : forall u, skew n u new
    = skew n u (e a') + h * sum m (fun j => b j * skew n u (K a' j))).
  { intros u. unfold new. rewrite skew_right, skew_sum_right. reflexivity. }
  rewrite skew_left, skew_sum_left, split.
  match goal with |- ?x + h * ?s + h * ?t = ?x =>
    cut (s + t = 0); [ intros sum_zero; replace (x + h * s + h * t) with (x + h * (s + t)) by ring;
                       rewrite sum_zero; ring | ] end.
  replace 0 with (- h * 0) by ring. rewrite <- (weights_cancel m A b W M).
  rewrite <- sum_of_multiple, <- sum_of_sum. apply sum_of_equals. intros i I. rewrite split.
  assert (left : skew n (e a) (K a' i)
    = skew n (fun c => Z i c a) (K a' i) + - h * sum m (fun j => A i j * W j i)).
  { unfold W. rewrite <- (skew_sum_left n m (K a)), <- skew_left.
    apply skew_of_equals; [ | reflexivity ]. intros c C. rewrite (EZ i c a I C La).
    unfold e, K. ring. }
  assert (right : skew n (K a i) (e a')
    = skew n (K a i) (fun c => Z i c a') + - h * sum m (fun j => A i j * W i j)).
  { unfold W. rewrite <- (skew_sum_right n m (K a')), <- skew_right.
    apply skew_of_equals; [ reflexivity | ]. intros c C. rewrite (EZ i c a' I C La').
    unfold e, K. ring. }
  pose proof (stage_keeps_form n (S i) (fun l => Z i l a) (fun l => Z i l a') (E i I)) as P.
  change (skew n (fun c => Z i c a) (K a' i) + skew n (K a i) (fun c => Z i c a') = 0) in P.
  rewrite left, right. unfold W.
  replace (skew n (fun c => Z i c a) (K a' i)) with (- skew n (K a i) (fun c => Z i c a')) by lra.
  ring.
Qed.

(** * The theorem for methods *)

Lemma slopes_of_turned : forall n f x (g : nat -> point),
  (forall j, (j < 2 * n)%nat -> has_slopes (2 * n) (f j) x (g j)) ->
  forall c, (c < 2 * n)%nat ->
    has_slopes (2 * n) (fun y => turned n (fun j => f j y) c) x
      (fun a => turned n (fun j => g j a) c).
Proof.
  intros n f x g E c L. unfold turned. destruct (Nat.ltb_spec c n).
  - apply slopes_of_opposite, E. lia.
  - apply E. lia.
Qed.

(** Stages and new coordinates are only asked to have some slopes. *)
Theorem method_symplectic : forall n m h A b (H1 : nat -> nat -> point -> R)
    (Z : nat -> point -> point) (F : nat -> point -> R) (x : point) (H2 : nat -> nat -> nat -> R),
  near (2 * n) x (solves_method n m h A b H1 Z F) ->
  (forall i c, (i < m)%nat -> (c < 2 * n)%nat ->
     exists g, has_slopes (2 * n) (fun y => Z i y c) x g) ->
  (forall i j, (i < m)%nat -> (j < 2 * n)%nat -> has_slopes (2 * n) (H1 i j) (Z i x) (H2 i j)) ->
  (forall i, (i < m)%nat -> symmetric (2 * n) (H2 i)) ->
  symplectic_weights m A b ->
  symplectic_at n F x.
Proof.
  intros n m h A b H1 Z F x H2 Eq Some Second E M.
  assert (SZ : exists zeta : nat -> nat -> point, forall i c, (i < m)%nat -> (c < 2 * n)%nat ->
    has_slopes (2 * n) (fun y => Z i y c) x (zeta i c)).
  { apply choice_of_matrices. exact Some. }
  destruct SZ as (zeta & SZ).
  set (K := fun j c a => turned n (image (2 * n) (H2 j) (fun l => zeta j l a)) c).
  assert (SK : forall j c, (j < m)%nat -> (c < 2 * n)%nat ->
    has_slopes (2 * n) (fun y => turned n (fun l => H1 j l (Z j y)) c) x (K j c)).
  { intros j c I C. apply (slopes_of_turned n (fun l y => H1 j l (Z j y)) x
      (fun l a => image (2 * n) (H2 j) (fun l => zeta j l a) l)); [ | exact C ].
    intros l L. apply (slopes_of_composition (2 * n) (2 * n) (H1 j l) (fun c y => Z j y c));
      [ apply Second; assumption | intros; apply SZ; assumption ]. }
  assert (SS : forall c (w : point), (c < 2 * n)%nat -> has_slopes (2 * n)
    (fun y => y c + h * sum m (fun j => w j * turned n (fun l => H1 j l (Z j y)) c)) x
    (fun a => pick c a + h * sum m (fun j => w j * K j c a))).
  { intros c w C. apply (slopes_of_sum (2 * n) (fun y => y c)); [ apply slopes_of_coordinate, C | ].
    apply slopes_of_multiple, slopes_of_finite_sum. intros j I.
    apply slopes_of_multiple, SK; assumption. }
  exists (fun c a => pick c a + h * sum m (fun j => b j * K j c a)). split.
  - intros c C. refine (slopes_of_equal_near _ _ _ _ _ (SS c b C) _).
    refine (near_weaker _ _ _ _ _ Eq). intros y (_ & Y). apply Y, C.
  - apply (method_matrix n m h A b H2 zeta); try assumption; [ | reflexivity ].
    intros i c a I C La.
    apply (slopes_unique (2 * n) (fun y => Z i y c) x (zeta i c)
             (fun a => pick c a + h * sum m (fun j => A i j * K j c a)));
      [ apply SZ; assumption | | exact La ].
    refine (slopes_of_equal_near _ _ _ _ _ (SS c (A i) C) _).
    refine (near_weaker _ _ _ _ _ Eq). intros y (Y & _). apply Y; assumption.
Qed.

(** The implicit midpoint rule: z' = z + h (-H_q, H_p)((z + z')/2). *)
Theorem midpoint_symplectic : forall n h (H1 : nat -> point -> R) (F : nat -> point -> R)
    (x : point) (H2 : nat -> nat -> R),
  let middle := fun y c => (y c + F c y) / 2 in
  near (2 * n) x (fun y => forall c, (c < 2 * n)%nat ->
    F c y = y c + h * turned n (fun l => H1 l (middle y)) c) ->
  (forall c, (c < 2 * n)%nat -> exists g, has_slopes (2 * n) (F c) x g) ->
  (forall j, (j < 2 * n)%nat -> has_slopes (2 * n) (H1 j) (middle x) (H2 j)) ->
  symmetric (2 * n) H2 ->
  symplectic_at n F x.
Proof.
  intros n h H1 F x H2 middle Eq Some Second E.
  apply (method_symplectic n 1 h (fun _ _ => / 2) (fun _ => 1) (fun _ => H1) (fun _ => middle) F x
           (fun _ => H2)).
  - refine (near_weaker _ _ _ _ _ Eq). intros y Y. split.
    + intros i c _ C. unfold middle at 1. rewrite (Y c C). simpl. field.
    + intros c C. rewrite (Y c C) at 1. simpl. ring.
  - intros i c _ C. destruct (Some c C) as (g & G).
    exists (fun a => / 2 * (pick c a + g a)).
    apply (slopes_of_equal (2 * n) (fun y => / 2 * (y c + F c y)));
      [ intros; unfold middle; field | ].
    apply slopes_of_multiple, slopes_of_sum; [ apply slopes_of_coordinate, C | exact G ].
  - intros. apply Second. assumption.
  - intros. exact E.
  - intros i j _ _. field.
Qed.

(** * Control: the condition on the weights is needed *)

(** Explicit Euler, with weight b = 1 and a = 0, for H = (p^2 + q^2)/2. *)
Definition euler (h : R) (i a : nat) : R :=
  match i, a with
  | O, O => 1
  | O, _ => - h
  | _, O => h
  | _, _ => 1
  end.

Lemma euler_solves : forall h y,
  solves_method 1 1 h (fun _ _ => 0) (fun _ => 1) (fun _ j z => z j) (fun _ y => y)
    (linear (euler h)) y.
Proof.
  intros h y. split.
  - intros i c _ _. simpl. ring.
  - intros [ | [ | c ] ] C; try lia; unfold linear, turned; simpl; ring.
Qed.

(** Its determinant is 1 + h^2. *)
Theorem euler_not_symplectic : forall h x, h <> 0 -> ~ symplectic_at 1 (linear (euler h)) x.
Proof.
  intros h x h_nonzero S. apply linear_map_symplectic in S. simpl in S.
  pose proof (Rsqr_pos_lt h h_nonzero) as P. unfold Rsqr in P. lra.
Qed.
