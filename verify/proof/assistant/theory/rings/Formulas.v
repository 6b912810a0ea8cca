(** Formulas in names with rational numbers: their values in any ring, their derivatives, and a
    check by calculation that one is 0 whatever the names stand for. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory Ring_polynom QArith Qreduction Nnat BinList List Lia.
From AreaPreservation Require Import Rings Totals.
Import ListNotations.
Local Open Scope nat_scope.

Inductive formula :=
| Number (a : Q)
| Name (i : positive)
| Plus (x y : formula)
| Minus (x y : formula)
| Times (x y : formula)
| Negative (x : formula)
| Power (x : formula) (k : nat).

Declare Scope formula_scope.
Delimit Scope formula_scope with formula.
Bind Scope formula_scope with formula.
Notation "x + y" := (Plus x y) : formula_scope.
Notation "x - y" := (Minus x y) : formula_scope.
Notation "x * y" := (Times x y) : formula_scope.
Notation "- x" := (Negative x) : formula_scope.
Notation "x ^ k" := (Power x k%nat) : formula_scope.

Section Values.
  Context {K : rational_ring} (names : list K).

  (** The names are numbered from 1, in the order of the list. *)
  Definition named (i : positive) : K := BinList.nth zero i names.

  Fixpoint value_of (f : formula) : K :=
    match f with
    | Number a => rational a
    | Name i => named i
    | Plus x y => add (value_of x) (value_of y)
    | Minus x y => sub (value_of x) (value_of y)
    | Times x y => mul (value_of x) (value_of y)
    | Negative x => opp (value_of x)
    | Power x k => power K (value_of x) k
    end.
End Values.

Lemma nth_at_position : forall (K : rational_ring) (l : list K) j,
  named l (Pos.of_succ_nat j) = nth j l zero.
Proof.
  intros K. unfold named.
  assert (next : forall p (l : list K), BinList.nth zero (Pos.succ p) l
    = BinList.nth zero p (tl l)).
  { intros p l. change l with (tl (zero :: l)) at 1. rewrite !nth_jump, jump_succ.
    simpl jump at 1. rewrite jump_tl. reflexivity. }
  intros l j. revert l. induction j as [|j IH]; intro l; simpl Pos.of_succ_nat.
  - destruct l; reflexivity.
  - rewrite next, IH. destruct l; [destruct j|]; reflexivity.
Qed.

(** The derivative, where [slope i] is that of the name i. *)
Fixpoint derivative (slope : positive -> formula) (f : formula) : formula :=
  match f with
  | Number _ => Number 0
  | Name i => slope i
  | Plus x y => Plus (derivative slope x) (derivative slope y)
  | Minus x y => Minus (derivative slope x) (derivative slope y)
  | Times x y => Plus (Times (derivative slope x) y) (Times x (derivative slope y))
  | Negative x => Negative (derivative slope x)
  | Power x O => Number 0
  | Power x (S j) =>
      Times (Times (Number (Z.of_nat (S j) # 1)) (Power x j)) (derivative slope x)
  end.

(** Whether all names of the formula are among these. *)
Fixpoint uses (known : positive -> bool) (f : formula) : bool :=
  match f with
  | Number _ => true
  | Name i => known i
  | Plus x y | Minus x y | Times x y => uses known x && uses known y
  | Negative x | Power x _ => uses known x
  end.

Definition sum_of (terms : list formula) : formula := fold_right Plus (Number 0) terms.

Definition sum_up_to (m : nat) (f : nat -> formula) : formula := sum_of (map f (seq 0 m)).

(** As the library's normal form of polynomials takes them. *)
Fixpoint as_polynomial (f : formula) : PExpr Q :=
  match f with
  | Number a => PEc a
  | Name i => PEX Q i
  | Plus x y => PEadd (as_polynomial x) (as_polynomial y)
  | Minus x y => PEsub (as_polynomial x) (as_polynomial y)
  | Times x y => PEmul (as_polynomial x) (as_polynomial y)
  | Negative x => PEopp (as_polynomial x)
  | Power x k => PEpow (as_polynomial x) (N.of_nat k)
  end.

Definition reduced_add (a b : Q) : Q := Qred (a + b).
Definition reduced_mul (a b : Q) : Q := Qred (a * b).
Definition reduced_sub (a b : Q) : Q := Qred (a - b).

Definition normal_form (f : formula) : Pol Q :=
  norm_aux 0%Q 1%Q reduced_add reduced_mul reduced_sub Qopp Qeq_bool (as_polynomial f).

(** Whether the formula is 0 as a polynomial in its names. *)
Definition vanishes (f : formula) : bool := Peq Qeq_bool (normal_form f) (Pc 0%Q).

Section Soundness.
  Context (K : rational_ring).
  Add Ring soundness : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Lemma rational_is_morphism : ring_morph (@zero K) one add mul sub opp same
    0%Q 1%Q reduced_add reduced_mul reduced_sub Qopp Qeq_bool rational.
  Proof.
    constructor; intros.
    - apply rational_zero.
    - apply rational_one.
    - rewrite <- rational_add. apply rational_extends, Qred_correct.
    - rewrite <- (rational_sub K). apply rational_extends, Qred_correct.
    - rewrite <- rational_mul. apply rational_extends, Qred_correct.
    - apply rational_opp.
    - apply rational_extends, Qeq_bool_eq. assumption.
  Qed.

  Lemma power_is_power : power_theory one mul (@same K) N.to_nat (power K).
  Proof.
    constructor. intros r [|n]; [reflexivity|]. simpl.
    induction n as [|n IH] using Pos.peano_ind; [simpl; ring|].
    rewrite Pos2Nat.inj_succ. simpl. rewrite IH.
    symmetry. apply pow_pos_succ; [exact (same_equivalence K)| |].
    - exact (mul_extends K).
    - exact (Rmul_assoc (ring_laws K)).
  Qed.

  Lemma value_of_polynomial : forall names f,
    PEeval zero one add mul sub opp rational N.to_nat (power K) names (as_polynomial f)
    == @value_of K names f.
  Proof.
    intros names f. induction f as [| |f1 E1 f2 E2|f1 E1 f2 E2|f1 E1 f2 E2|f E|f E k]; simpl;
      rewrite ?E1, ?E2, ?E; try reflexivity.
    rewrite Nat2N.id. induction k as [|k IH]; simpl; [reflexivity|]. rewrite IH, E. reflexivity.
  Qed.

  (** What is 0 by calculation is 0 in every ring that holds the rational numbers. *)
  Theorem vanishes_everywhere : forall names f,
    vanishes f = true -> value_of names f == @zero K.
  Proof.
    intros names f E. rewrite <- value_of_polynomial.
    rewrite (norm_aux_spec (same_equivalence K) (operations_extend K)
      (Rth_ARth (same_equivalence K) (operations_extend K) (ring_laws K))
      rational_is_morphism power_is_power).
    etransitivity; [exact (Peq_ok (same_equivalence K) (operations_extend K)
      rational_is_morphism _ _ E names)|].
    simpl. apply rational_zero.
  Qed.

  Lemma value_of_terms : forall names l l',
    value_of names (sum_of (l ++ l')) == @value_of K names (sum_of l) + value_of names (sum_of l').
  Proof.
    intros names l l'. induction l as [|f l IH]; simpl; [rewrite (rational_zero K); ring|].
    rewrite IH. ring.
  Qed.

  Lemma value_of_sum_up_to : forall names m f,
    value_of names (sum_up_to m f) == total m (fun i => @value_of K names (f i)).
  Proof.
    intros names m f. unfold sum_up_to. induction m as [|m IH]; [apply rational_zero|].
    rewrite seq_S, map_app, value_of_terms, IH. simpl. rewrite (rational_zero K). ring.
  Qed.

  Lemma value_of_sum : forall names terms,
    (forall f, In f terms -> value_of names f == @zero K) ->
    value_of names (sum_of terms) == @zero K.
  Proof.
    intros names terms. induction terms as [|f terms IH]; intro E; simpl; [apply rational_zero|].
    rewrite IH, (E f) by (intros; try apply E; simpl; auto). ring.
  Qed.
End Soundness.

Section Derivatives.
  Context (K : differential_ring).
  Add Ring derivatives : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Lemma derivation_power : forall i (x : K) k,
    by_coordinate i (power K x (S k))
    == rational (Z.of_nat (S k) # 1) * power K x k * by_coordinate i x.
  Proof.
    intros i x k. induction k as [|k IH].
    - simpl. rewrite derivation_mul, derivation_one.
      change (1 # 1) with 1%Q. rewrite rational_one. ring.
    - change (power K x (S (S k))) with (x * power K x (S k)).
      rewrite derivation_mul, IH.
      rewrite (rational_extends K (Z.of_nat (S (S k)) # 1) (1 + (Z.of_nat (S k) # 1))%Q).
      + rewrite rational_add, rational_one. simpl power. ring.
      + unfold Qeq, Qplus. cbn [Qnum Qden]. lia.
  Qed.

  (** [derivative] is the derivative, of formulas whose names have the slopes that are told. *)
  Theorem derivative_is : forall i names slope known,
    (forall k, known k = true ->
      by_coordinate i (named names k) == value_of names (slope k)) ->
    forall f, uses known f = true ->
    by_coordinate i (value_of names f) == @value_of K names (derivative slope f).
  Proof.
    intros i names slope known E f.
    induction f as [a|k|f1 E1 f2 E2|f1 E1 f2 E2|f1 E1 f2 E2|f IH|f IH k]; simpl; intro U;
      try (apply andb_prop in U; destruct U as [U1 U2]; specialize (E1 U1); specialize (E2 U2)).
    - rewrite derivation_rational, (rational_zero K). reflexivity.
    - apply E, U.
    - rewrite derivation_add, E1, E2. reflexivity.
    - rewrite derivation_sub, E1, E2. reflexivity.
    - rewrite derivation_mul, E1, E2. reflexivity.
    - rewrite derivation_opp, IH by exact U. reflexivity.
    - destruct k as [|k]; [simpl; rewrite derivation_one, (rational_zero K); reflexivity|].
      rewrite derivation_power, IH by exact U. reflexivity.
  Qed.
End Derivatives.
