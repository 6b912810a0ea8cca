(** The functions with derivatives of every order on an open set are a differential ring.

    A smooth function is given with all its iterated derivatives, one for each list of coordinates.
    Two are the same if they have the same values on the set. *)

From Coq Require Import Reals Lra Lia PeanoNat List Setoid Ring_theory Qreals.
From AreaPreservation Require Import Sums Differential Slopes Schwarz Rings.
Import ListNotations.
Local Open Scope R_scope.

(** The member of a list is the derivative along its coordinates, the head being taken first;
    that of the empty list is the function itself. *)
Definition is_family (N : nat) (U : point -> Prop) (F : list nat -> point -> R) : Prop :=
  forall l x, U x -> has_slopes N (F l) x (fun i => F (l ++ [i]) x).

Record smooth (N : nat) (U : point -> Prop) := {
  family : list nat -> point -> R;
  family_slopes : is_family N U family;
}.
Arguments family {N U}.
Arguments family_slopes {N U}.

Definition value {N U} (f : smooth N U) : point -> R := family f [].

Definition smooth_same {N U} (f g : smooth N U) : Prop :=
  forall x, U x -> value f x = value g x.

(** Constants and coordinates. *)
Definition constant_family (c : R) (l : list nat) : point -> R :=
  match l with [] => fun _ => c | _ => fun _ => 0 end.

Lemma constant_is_family : forall N U c, is_family N U (constant_family c).
Proof. intros N U c [|i l] x _; apply slopes_of_constant. Qed.

Definition smooth_constant {N U} (c : R) : smooth N U := {|
  family := constant_family c;
  family_slopes := constant_is_family N U c |}.

(** A coordinate past the first N stands for zero. *)
Definition coordinate_family (N j : nat) (l : list nat) : point -> R :=
  if Nat.ltb j N then
    match l with
    | [] => fun x => x j
    | [i] => fun _ => pick j i
    | _ => fun _ => 0
    end
  else fun _ => 0.

Lemma coordinate_is_family : forall N U j, is_family N U (coordinate_family N j).
Proof.
  intros N U j l x _. unfold coordinate_family.
  destruct (Nat.ltb_spec j N) as [L|_]; [|apply slopes_of_constant].
  destruct l as [|i [|k l]]; [now apply slopes_of_coordinate|apply slopes_of_constant..].
Qed.

Definition smooth_coordinate {N U} (j : nat) : smooth N U := {|
  family := coordinate_family N j;
  family_slopes := coordinate_is_family N U j |}.

(** Sum, opposite and product. *)
Lemma sum_is_family : forall N U F G, is_family N U F -> is_family N U G ->
  is_family N U (fun l x => F l x + G l x).
Proof. intros N U F G HF HG l x Hx. apply slopes_of_sum; auto. Qed.

Definition smooth_add {N U} (f g : smooth N U) : smooth N U := {|
  family := fun l x => family f l x + family g l x;
  family_slopes := sum_is_family N U _ _ (family_slopes f) (family_slopes g) |}.

Lemma opposite_is_family : forall N U F, is_family N U F -> is_family N U (fun l x => - F l x).
Proof. intros N U F HF l x Hx. apply slopes_of_opposite; auto. Qed.

Definition smooth_opp {N U} (f : smooth N U) : smooth N U := {|
  family := fun l x => - family f l x;
  family_slopes := opposite_is_family N U _ (family_slopes f) |}.

(** The product rule, once for each member of the list. *)
Fixpoint product_family (F G : list nat -> point -> R) (l : list nat) : point -> R :=
  match l with
  | [] => fun x => F [] x * G [] x
  | i :: r => fun x =>
      product_family (fun k => F (i :: k)) G r x + product_family F (fun k => G (i :: k)) r x
  end.

Lemma derivative_is_family : forall N U F i, is_family N U F -> is_family N U (fun l => F (i :: l)).
Proof. intros N U F i HF l x Hx. exact (HF (i :: l) x Hx). Qed.

Lemma product_is_family : forall N U F G, is_family N U F -> is_family N U G ->
  is_family N U (product_family F G).
Proof.
  intros N U F G HF HG l. revert F G HF HG. induction l as [|i l IH]; intros F G HF HG x Hx.
  - exact (slopes_of_product N _ _ x _ _ (HF [] x Hx) (HG [] x Hx)).
  - apply slopes_of_sum; apply IH; auto using derivative_is_family.
Qed.

Definition smooth_mul {N U} (f g : smooth N U) : smooth N U := {|
  family := product_family (family f) (family g);
  family_slopes := product_is_family N U _ _ (family_slopes f) (family_slopes g) |}.

(** The derivative along a coordinate; zero along those past the first N. *)
Definition derivative_family (N i : nat) (F : list nat -> point -> R) (l : list nat) : point -> R :=
  if Nat.ltb i N then F (i :: l) else fun _ => 0.

Lemma derivative_family_is_family : forall N U i F, is_family N U F ->
  is_family N U (derivative_family N i F).
Proof.
  intros N U i F HF l x Hx. unfold derivative_family.
  destruct (Nat.ltb i N); [exact (HF (i :: l) x Hx)|apply slopes_of_constant].
Qed.

Definition smooth_derivative {N U} (i : nat) (f : smooth N U) : smooth N U := {|
  family := derivative_family N i (family f);
  family_slopes := derivative_family_is_family N U i _ (family_slopes f) |}.

(** The laws. *)
Lemma smooth_same_equivalence : forall N U, Equivalence (@smooth_same N U).
Proof.
  intros N U. split.
  - intros f x _. reflexivity.
  - intros f g E x Hx. now rewrite E.
  - intros f g h E E' x Hx. now rewrite E, E'.
Qed.

Lemma smooth_operations_extend : forall N U,
  ring_eq_ext (@smooth_add N U) smooth_mul smooth_opp smooth_same.
Proof.
  intros N U. split.
  - intros f f' E g g' E' x Hx. exact (f_equal2 Rplus (E x Hx) (E' x Hx)).
  - intros f f' E g g' E' x Hx. exact (f_equal2 Rmult (E x Hx) (E' x Hx)).
  - intros f f' E x Hx. exact (f_equal Ropp (E x Hx)).
Qed.

Lemma smooth_ring_laws : forall N U,
  ring_theory (@smooth_constant N U 0) (smooth_constant 1) smooth_add smooth_mul
    (fun f g => smooth_add f (smooth_opp g)) smooth_opp smooth_same.
Proof. intros N U. split; repeat intro; unfold value; simpl; ring. Qed.

Lemma smooth_rational_extends : forall N U a b, (a == b)%Q ->
  smooth_same (@smooth_constant N U (Q2R a)) (smooth_constant (Q2R b)).
Proof. intros N U a b E x _. exact (Qeq_eqR a b E). Qed.

Lemma smooth_rational_one : forall N U,
  smooth_same (@smooth_constant N U (Q2R 1)) (smooth_constant 1).
Proof. intros N U x _. unfold value, Q2R. simpl. field. Qed.

Lemma smooth_rational_add : forall N U a b,
  smooth_same (@smooth_constant N U (Q2R (a + b)))
    (smooth_add (smooth_constant (Q2R a)) (smooth_constant (Q2R b))).
Proof. intros N U a b x _. exact (Q2R_plus a b). Qed.

Lemma smooth_rational_mul : forall N U a b,
  smooth_same (@smooth_constant N U (Q2R (a * b)))
    (smooth_mul (smooth_constant (Q2R a)) (smooth_constant (Q2R b))).
Proof. intros N U a b x _. exact (Q2R_mult a b). Qed.

(** Functions with the same values on an open set have the same slopes there. *)
Lemma smooth_derivation_extends : forall N U, is_open N U -> forall i (f g : smooth N U),
  smooth_same f g -> smooth_same (smooth_derivative i f) (smooth_derivative i g).
Proof.
  intros N U HU i f g E x Hx. unfold value; simpl; unfold derivative_family.
  destruct (Nat.ltb_spec i N) as [L|_]; [|reflexivity].
  apply (slopes_unique N (family g []) x (fun a => family f [a] x) (fun a => family g [a] x));
    [|exact (family_slopes g [] x Hx)|exact L].
  apply (slopes_of_equal_on_open N U (family f [])); [exact HU|exact Hx| |].
  - intros y Hy. symmetry. exact (E y Hy).
  - exact (family_slopes f [] x Hx).
Qed.

Lemma smooth_derivation_add : forall N U i (f g : smooth N U),
  smooth_same (smooth_derivative i (smooth_add f g))
    (smooth_add (smooth_derivative i f) (smooth_derivative i g)).
Proof.
  intros N U i f g x _. unfold value; simpl; unfold derivative_family.
  destruct (Nat.ltb i N); simpl; ring.
Qed.

Lemma smooth_derivation_mul : forall N U i (f g : smooth N U),
  smooth_same (smooth_derivative i (smooth_mul f g))
    (smooth_add (smooth_mul (smooth_derivative i f) g) (smooth_mul f (smooth_derivative i g))).
Proof.
  intros N U i f g x _. unfold value; simpl; unfold derivative_family.
  destruct (Nat.ltb i N); simpl; ring.
Qed.

Lemma smooth_derivations_commute : forall N U, is_open N U -> forall i j (f : smooth N U),
  smooth_same (smooth_derivative i (smooth_derivative j f))
    (smooth_derivative j (smooth_derivative i f)).
Proof.
  intros N U HU i j f x Hx. unfold value; simpl; unfold derivative_family.
  destruct (Nat.ltb_spec i N) as [Hi|_], (Nat.ltb_spec j N) as [Hj|_]; try reflexivity.
  destruct (HU x Hx) as (r & Hr & B).
  apply (second_slopes_symmetric N (family f []) (fun a => family f [a])
    (fun a b => family f [a; b] x) x r Hr); auto.
  - intros y Hy. exact (family_slopes f [] y (B y Hy)).
  - intros a _. exact (family_slopes f [a] x Hx).
Qed.

Definition smooth_functions (N : nat) (U : point -> Prop) : rational_ring := {|
  carrier := smooth N U;
  same := smooth_same;
  zero := smooth_constant 0;
  one := smooth_constant 1;
  add := smooth_add;
  mul := smooth_mul;
  sub := fun f g => smooth_add f (smooth_opp g);
  opp := smooth_opp;
  rational := fun q => smooth_constant (Q2R q);
  same_equivalence := smooth_same_equivalence N U;
  operations_extend := smooth_operations_extend N U;
  ring_laws := smooth_ring_laws N U;
  rational_extends := smooth_rational_extends N U;
  rational_one := smooth_rational_one N U;
  rational_add := smooth_rational_add N U;
  rational_mul := smooth_rational_mul N U |}.

Definition smooth_ring (N : nat) (U : point -> Prop) (HU : is_open N U) : differential_ring := {|
  functions := smooth_functions N U;
  by_coordinate := smooth_derivative;
  derivation_extends := smooth_derivation_extends N U HU;
  derivation_add := smooth_derivation_add N U;
  derivation_mul := smooth_derivation_mul N U;
  derivations_commute := smooth_derivations_commute N U HU |}.

(** What the operations of the ring do to the values. *)

Lemma value_zero : forall N U (HU : is_open N U) x, value (@zero (smooth_ring N U HU)) x = 0.
Proof. reflexivity. Qed.

Lemma value_add : forall N U (HU : is_open N U) f g x,
  value (@add (smooth_ring N U HU) f g) x = value f x + value g x.
Proof. reflexivity. Qed.

Lemma value_mul : forall N U (HU : is_open N U) f g x,
  value (@mul (smooth_ring N U HU) f g) x = value f x * value g x.
Proof. reflexivity. Qed.

Lemma value_sub : forall N U (HU : is_open N U) f g x,
  value (@sub (smooth_ring N U HU) f g) x = value f x - value g x.
Proof. reflexivity. Qed.

Lemma value_opp : forall N U (HU : is_open N U) f x,
  value (@opp (smooth_ring N U HU) f) x = - value f x.
Proof. reflexivity. Qed.

Lemma value_rational : forall N U (HU : is_open N U) q x,
  value (@rational (smooth_ring N U HU) q) x = Q2R q.
Proof. reflexivity. Qed.

Lemma value_coordinate : forall N U j x, (j < N)%nat -> value (@smooth_coordinate N U j) x = x j.
Proof.
  intros N U j x L. unfold value; simpl; unfold coordinate_family.
  now rewrite (proj2 (Nat.ltb_lt j N) L).
Qed.

(** The derivation of the ring is the derivative of analysis. *)
Theorem derivation_has_slopes : forall N U (HU : is_open N U) f x, U x ->
  has_slopes N (value f) x (fun i => value (@by_coordinate (smooth_ring N U HU) i f) x).
Proof.
  intros N U HU f x Hx.
  refine (slopes_of_equal_slopes N _ x _ _ (family_slopes f [] x Hx) _).
  intros i L. unfold value; simpl; unfold derivative_family.
  now rewrite (proj2 (Nat.ltb_lt i N) L).
Qed.

Theorem derivation_is_slope : forall N U (HU : is_open N U) f x i, U x -> (i < N)%nat ->
  derivable_pt_lim (fun s => value f (moved x i s)) (x i)
    (value (@by_coordinate (smooth_ring N U HU) i f) x).
Proof.
  intros N U HU f x i Hx L.
  exact (derivative_along_coordinate N _ x _ i (derivation_has_slopes N U HU f x Hx) L).
Qed.

Lemma derivation_constant : forall N U (HU : is_open N U) i c,
  @same (smooth_ring N U HU) (@by_coordinate (smooth_ring N U HU) i (smooth_constant c))
    (@zero (smooth_ring N U HU)).
Proof.
  intros N U HU i c x _. unfold value; simpl; unfold derivative_family.
  now destruct (Nat.ltb i N).
Qed.

Lemma derivation_coordinate : forall N U (HU : is_open N U) i j, (i < N)%nat -> (j < N)%nat ->
  @same (smooth_ring N U HU) (@by_coordinate (smooth_ring N U HU) i (smooth_coordinate j))
    (if Nat.eqb i j then @one (smooth_ring N U HU) else @zero (smooth_ring N U HU)).
Proof.
  intros N U HU i j Hi Hj x _. unfold value; simpl.
  unfold derivative_family, coordinate_family, pick.
  rewrite (proj2 (Nat.ltb_lt i N) Hi), (proj2 (Nat.ltb_lt j N) Hj).
  now destruct (Nat.eqb i j).
Qed.
