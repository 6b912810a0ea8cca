(** Formulas at rational numbers: their values are calculated there, and are those over the real
    numbers. *)

From Coq Require Import Reals Qreduction Qfield Qreals List.
From AreaPreservation Require Import Differential Rings Formulas RealFormulas.
Import ListNotations.
Local Open Scope nat_scope.

(** The rational numbers, as fractions that are reduced at each step. *)
Definition rational_numbers : rational_ring.
Proof.
  refine {| carrier := Q; same := Qeq; zero := 0%Q; one := 1%Q; add := reduced_add; mul := reduced_mul;
    sub := reduced_sub; opp := Qopp; rational := fun a => a |}.
  - split; unfold reduced_add, reduced_mul; intros x y E z w F || intros x y E;
      rewrite ?Qred_correct, E, ?F; reflexivity.
  - split; intros; unfold reduced_add, reduced_mul, reduced_sub; rewrite ?Qred_correct; ring.
  - intros a b E. exact E.
  - reflexivity.
  - intros a b. symmetry. apply Qred_correct.
  - intros a b. symmetry. apply Qred_correct.
Defined.

Lemma real_of_same : forall a b, a == b -> real_of a = real_of b.
Proof. exact (rational_extends real_numbers). Qed.

Lemma same_real_of : forall a b, real_of a = real_of b -> a == b.
Proof. intros a b E. rewrite !real_of_is in E. apply eqR_Qeq, E. Qed.

Lemma reduced_value : forall a, real_of (Qred a) = real_of a.
Proof. intro a. apply real_of_same, Qred_correct. Qed.

Theorem value_is_rational : forall (names : list Q) f,
  @value_of real_numbers (map real_of names) f = real_of (@value_of rational_numbers names f).
Proof.
  intros names f. induction f as [a|k|f1 E1 f2 E2|f1 E1 f2 E2|f1 E1 f2 E2|f E|f E k]; cbn [value_of].
  - reflexivity.
  - rewrite (positive_is k), named_is_nth.
    rewrite (nth_at_position rational_numbers names).
    exact (map_nth real_of names 0%Q _).
  - rewrite E1, E2. symmetry. etransitivity; [apply reduced_value|apply (rational_add real_numbers)].
  - rewrite E1, E2. symmetry. etransitivity; [apply reduced_value|apply (rational_sub real_numbers)].
  - rewrite E1, E2. symmetry. etransitivity; [apply reduced_value|apply (rational_mul real_numbers)].
  - rewrite E. symmetry. apply (rational_opp real_numbers).
  - rewrite E. induction k as [|k IH]; cbn [power]; [reflexivity|].
    rewrite IH. symmetry. etransitivity; [apply reduced_value|apply (rational_mul real_numbers)].
Qed.

(** The point with these coordinates. *)
Definition rational_point (l : list Q) : point := fun j => nth j (map real_of l) 0%R.

Lemma coordinates_of_point : forall l, map (rational_point l) (seq 0 (length l)) = map real_of l.
Proof.
  intro l. unfold rational_point. rewrite <- (map_length real_of l). generalize (map real_of l). clear l.
  induction l as [|a l IH]; [reflexivity|]. simpl. f_equal. rewrite <- seq_shift, map_map. exact IH.
Qed.

(** Whether two lists have the same numbers in them. *)
Fixpoint same_numbers (l m : list Q) : bool :=
  match l, m with
  | [], [] => true
  | a :: l', b :: m' => Qeq_bool a b && same_numbers l' m'
  | _, _ => false
  end.

Lemma same_numbers_same : forall l m, same_numbers l m = true -> map real_of l = map real_of m.
Proof.
  induction l as [|a l IH]; intros [|b m] E; try discriminate; [reflexivity|].
  simpl in E. apply andb_prop in E. destruct E as [A E]. simpl. f_equal; [|exact (IH m E)].
  apply real_of_same, Qeq_bool_eq, A.
Qed.
