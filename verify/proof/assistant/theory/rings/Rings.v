(** Commutative rings that hold the rational numbers, with commuting derivations.

    Equality is an equivalence, so that functions are an instance without an axiom that makes those
    equal that agree everywhere (see Smooth.v). *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
Local Open Scope nat_scope.

Record rational_ring := {
  carrier :> Type;
  same : carrier -> carrier -> Prop;
  zero : carrier;
  one : carrier;
  add : carrier -> carrier -> carrier;
  mul : carrier -> carrier -> carrier;
  sub : carrier -> carrier -> carrier;
  opp : carrier -> carrier;
  rational : Q -> carrier;

  same_equivalence : Equivalence same;
  operations_extend : ring_eq_ext add mul opp same;
  ring_laws : ring_theory zero one add mul sub opp same;
  rational_extends : forall a b, a == b -> same (rational a) (rational b);
  rational_one : same (rational 1) one;
  rational_add : forall a b, same (rational (a + b)) (add (rational a) (rational b));
  rational_mul : forall a b, same (rational (a * b)) (mul (rational a) (rational b));
}.

Record differential_ring := {
  functions :> rational_ring;
  by_coordinate : nat -> functions -> functions;

  derivation_extends : forall i x y,
    same functions x y -> same functions (by_coordinate i x) (by_coordinate i y);
  derivation_add : forall i x y, same functions
    (by_coordinate i (add functions x y))
    (add functions (by_coordinate i x) (by_coordinate i y));
  derivation_mul : forall i x y, same functions
    (by_coordinate i (mul functions x y))
    (add functions (mul functions (by_coordinate i x) y) (mul functions x (by_coordinate i y)));
  derivations_commute : forall i j x, same functions
    (by_coordinate i (by_coordinate j x)) (by_coordinate j (by_coordinate i x));
}.

Arguments same {_}.
Arguments zero {_}.
Arguments one {_}.
Arguments add {_}.
Arguments mul {_}.
Arguments sub {_}.
Arguments opp {_}.
Arguments rational {_}.
Arguments by_coordinate {_}.

Declare Scope ring_of_functions.
Delimit Scope ring_of_functions with F.
Notation "x == y" := (same x y) : ring_of_functions.
Notation "x + y" := (add x y) : ring_of_functions.
Notation "x * y" := (mul x y) : ring_of_functions.
Notation "x - y" := (sub x y) : ring_of_functions.
Notation "- x" := (opp x) : ring_of_functions.

Fixpoint power (K : rational_ring) (x : K) (k : nat) : K :=
  match k with
  | O => one
  | S j => mul x (power K x j)
  end.

Notation "x ^ k" := (power _ x k%nat) : ring_of_functions.

#[export] Instance same_is_equivalence (K : rational_ring) : Equivalence (@same K).
Proof. exact (same_equivalence K). Qed.
#[export] Instance add_extends (K : rational_ring) : Proper (same ==> same ==> same) (@add K).
Proof. exact (Radd_ext (operations_extend K)). Qed.
#[export] Instance mul_extends (K : rational_ring) : Proper (same ==> same ==> same) (@mul K).
Proof. exact (Rmul_ext (operations_extend K)). Qed.
#[export] Instance opp_extends (K : rational_ring) : Proper (same ==> same) (@opp K).
Proof. exact (Ropp_ext (operations_extend K)). Qed.
#[export] Instance sub_extends (K : rational_ring) : Proper (same ==> same ==> same) (@sub K).
Proof.
  intros x x' Hx y y' Hy.
  rewrite (Rsub_def (ring_laws K)), (Rsub_def (ring_laws K) x' y'), Hx, Hy. reflexivity.
Qed.
#[export] Instance rational_proper (K : rational_ring) : Proper (Qeq ==> same) (@rational K).
Proof. intros a b. apply rational_extends. Qed.
Section Consequences.
  Context (K : rational_ring).
  Add Ring consequences : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Lemma cancel : forall x y z : K, x + z == y + z -> x == y.
  Proof.
    intros x y z E. transitivity (x + z - z); [ring|]. rewrite E. ring.
  Qed.

  Lemma rational_zero : rational 0 == @zero K.
  Proof.
    apply (cancel _ _ (rational 0)). rewrite <- rational_add. ring_simplify.
    apply rational_extends. reflexivity.
  Qed.

  Lemma rational_opp : forall a, @rational K (- a)%Q == - rational a.
  Proof.
    intro a. apply (cancel _ _ (rational a)). rewrite <- rational_add.
    transitivity (@rational K 0%Q); [apply rational_extends; ring|rewrite rational_zero; ring].
  Qed.

  Lemma rational_sub : forall a b, @rational K (a - b)%Q == rational a - rational b.
  Proof. intros a b. unfold Qminus. rewrite rational_add, rational_opp. ring. Qed.

  Lemma power_add : forall (h : K) k l, h ^ (k + l) == h ^ k * h ^ l.
  Proof. intros h k l. induction k as [|k IH]; simpl; [|rewrite IH]; ring. Qed.
End Consequences.

#[export] Instance derivation_proper (K : differential_ring) (i : nat) :
  Proper (same ==> same) (@by_coordinate K i).
Proof. intros x y. apply derivation_extends. Qed.

Section Derivations.
  Context (K : differential_ring).
  Add Ring derivations : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Lemma derivation_zero : forall i, by_coordinate i (@zero K) == zero.
  Proof.
    intro i. apply (cancel K _ _ (by_coordinate i zero)). rewrite <- derivation_add.
    transitivity (by_coordinate i (@zero K)); [apply derivation_extends|]; ring.
  Qed.

  Lemma derivation_opp : forall i (x : K), by_coordinate i (- x) == - by_coordinate i x.
  Proof.
    intros i x. apply (cancel K _ _ (by_coordinate i x)). rewrite <- derivation_add.
    transitivity (by_coordinate i (@zero K)); [apply derivation_extends; ring|].
    rewrite derivation_zero. ring.
  Qed.

  Lemma derivation_sub : forall i (x y : K),
    by_coordinate i (x - y) == by_coordinate i x - by_coordinate i y.
  Proof.
    intros i x y. transitivity (by_coordinate i (x + - y)); [apply derivation_extends; ring|].
    rewrite derivation_add, derivation_opp. ring.
  Qed.

  Lemma derivation_one : forall i, by_coordinate i (@one K) == zero.
  Proof.
    intro i. apply (cancel K _ _ (by_coordinate i one)).
    transitivity (by_coordinate i (@one K) * one + one * by_coordinate i one); [ring|].
    rewrite <- derivation_mul. transitivity (by_coordinate i (@one K)); [|ring].
    apply derivation_extends. ring.
  Qed.

  (** What no derivation sees, as it does not see a number h. *)
  Definition is_constant (h : K) : Prop := forall i, by_coordinate i h == zero.

  Lemma power_constant : forall h k, is_constant h -> is_constant (h ^ k).
  Proof.
    intros h k C i. induction k as [|k IH]; simpl; [apply derivation_one|].
    rewrite derivation_mul, IH, (C i). ring.
  Qed.

  (** Rational numbers are constants: b (a/b) = a is one, as a sum of ones is. *)
  Lemma derivation_rational : forall i a, by_coordinate i (@rational K a) == zero.
  Proof.
    assert (whole : forall i (n : positive), by_coordinate i (@rational K (Zpos n # 1)) == zero).
    { intros i n. induction n as [|n IH] using Pos.peano_ind.
      - transitivity (by_coordinate i (@one K)); [|apply derivation_one].
        apply derivation_extends, rational_one.
      - transitivity (by_coordinate i (@rational K (1 + (Zpos n # 1)))).
        + apply derivation_extends, rational_extends. unfold Qeq, Qplus. cbn [Qnum Qden]. lia.
        + rewrite rational_add, derivation_add, IH, rational_one, derivation_one. ring. }
    assert (any : forall i (z : Z), by_coordinate i (@rational K (z # 1)) == zero).
    { intros i [|n|n].
      - transitivity (by_coordinate i (@zero K)); [|apply derivation_zero].
        apply derivation_extends. exact (rational_zero K).
      - apply whole.
      - transitivity (by_coordinate i (- @rational K (Zpos n # 1))).
        + apply derivation_extends. exact (rational_opp K (Zpos n # 1)).
        + rewrite derivation_opp, whole. ring. }
    intros i [a b].
    assert (product : by_coordinate i (rational (a # b)) * @rational K (Zpos b # 1) == zero).
    { transitivity (by_coordinate i (rational (a # b) * @rational K (Zpos b # 1))).
      - rewrite derivation_mul, any. ring.
      - rewrite <- rational_mul, (rational_extends K ((a # b) * (Zpos b # 1)) (a # 1)); [apply any|].
        unfold Qeq, Qmult. cbn [Qnum Qden]. lia. }
    transitivity (by_coordinate i (rational (a # b)) * @rational K ((Zpos b # 1) * (1 # b))).
    - rewrite (rational_extends K ((Zpos b # 1) * (1 # b)) 1); [rewrite rational_one; ring|].
      unfold Qeq, Qmult. cbn [Qnum Qden]. lia.
    - rewrite rational_mul.
      transitivity (by_coordinate i (rational (a # b)) * @rational K (Zpos b # 1)
        * rational (1 # b)); [ring|]. rewrite product. ring.
  Qed.
End Derivations.
