(** Formulas without the sums and products with 0 and 1 that taking derivatives leaves. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Qreduction Lia.
From AreaPreservation Require Import Rings Formulas.
Local Open Scope nat_scope.

Definition is_number (f : formula) : option Q :=
  match f with
  | Number a => Some a
  | _ => None
  end.

Definition simple_sum (x y : formula) : formula :=
  match is_number x, is_number y with
  | Some a, Some b => Number (Qred (a + b))
  | Some a, None => if Qeq_bool a 0 then y else Plus x y
  | None, Some b => if Qeq_bool b 0 then x else Plus x y
  | None, None => Plus x y
  end.

Definition simple_product (x y : formula) : formula :=
  match is_number x, is_number y with
  | Some a, Some b => Number (Qred (a * b))
  | Some a, None => if Qeq_bool a 0 then Number 0 else if Qeq_bool a 1 then y else Times x y
  | None, Some b => if Qeq_bool b 0 then Number 0 else if Qeq_bool b 1 then x else Times x y
  | None, None => Times x y
  end.

Fixpoint simplified (f : formula) : formula :=
  match f with
  | Number _ | Name _ => f
  | Plus x y => simple_sum (simplified x) (simplified y)
  | Minus x y => simple_sum (simplified x) (simple_product (Number (-1)) (simplified y))
  | Times x y => simple_product (simplified x) (simplified y)
  | Negative x => simple_product (Number (-1)) (simplified x)
  | Power x k => match k with O => Number 1 | S O => simplified x | _ => Power (simplified x) k end
  end.

Section Simplified.
  Context (K : rational_ring) (names : list K).
  Add Ring simplified_ring : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.
  Notation value f := (@value_of K names f).

  Lemma number_found : forall f b, is_number f = Some b -> f = Number b.
  Proof. intros f b E. destruct f; simpl in E; congruence. Qed.

  Lemma number_same : forall a b, Qeq_bool a b = true -> @rational K a == rational b.
  Proof. intros a b E. apply rational_extends, Qeq_bool_eq, E. Qed.

  Lemma value_of_simple_sum : forall x y, value (simple_sum x y) == value x + value y.
  Proof.
    intros x y. unfold simple_sum.
    destruct (is_number x) as [a|] eqn:A, (is_number y) as [b|] eqn:B;
      try (apply number_found in A; subst x); try (apply number_found in B; subst y); cbn [value_of].
    - rewrite <- rational_add. apply rational_extends, Qred_correct.
    - destruct (Qeq_bool a 0) eqn:Z; [|reflexivity].
      rewrite (number_same _ _ Z), (rational_zero K). ring.
    - destruct (Qeq_bool b 0) eqn:Z; [|reflexivity].
      rewrite (number_same _ _ Z), (rational_zero K). ring.
    - reflexivity.
  Qed.

  Lemma value_of_simple_product : forall x y, value (simple_product x y) == value x * value y.
  Proof.
    intros x y. unfold simple_product.
    destruct (is_number x) as [a|] eqn:A, (is_number y) as [b|] eqn:B;
      try (apply number_found in A; subst x); try (apply number_found in B; subst y); cbn [value_of].
    - rewrite <- rational_mul. apply rational_extends, Qred_correct.
    - destruct (Qeq_bool a 0) eqn:Z.
      + rewrite (number_same _ _ Z). cbn [value_of]. rewrite (rational_zero K). ring.
      + destruct (Qeq_bool a 1) eqn:U; [|reflexivity].
        rewrite (number_same _ _ U), rational_one. ring.
    - destruct (Qeq_bool b 0) eqn:Z.
      + rewrite (number_same _ _ Z). cbn [value_of]. rewrite (rational_zero K). ring.
      + destruct (Qeq_bool b 1) eqn:U; [|reflexivity].
        rewrite (number_same _ _ U), rational_one. ring.
    - reflexivity.
  Qed.

  Lemma minus_one : @rational K (-1) == - one.
  Proof. rewrite (rational_extends K (-1) (Qopp 1)), (rational_opp K), rational_one; reflexivity. Qed.

  Theorem simplified_same : forall f, value (simplified f) == value f.
  Proof.
    induction f as [a|i|x X y Y|x X y Y|x X y Y|x X|x X k]; simpl; try reflexivity.
    - rewrite value_of_simple_sum, X, Y. reflexivity.
    - rewrite value_of_simple_sum, value_of_simple_product, X, Y. cbn [value_of]. rewrite minus_one. ring.
    - rewrite value_of_simple_product, X, Y. reflexivity.
    - rewrite value_of_simple_product, X. cbn [value_of]. rewrite minus_one. ring.
    - destruct k as [|[|k]].
      + simpl. apply rational_one.
      + simpl. rewrite X. ring.
      + assert (same_powers : forall j, power K (value (simplified x)) j == power K (value x) j).
        { induction j as [|j IH]; simpl; [reflexivity|]. rewrite IH, X. reflexivity. }
        apply (same_powers (S (S k))).
  Qed.
End Simplified.
