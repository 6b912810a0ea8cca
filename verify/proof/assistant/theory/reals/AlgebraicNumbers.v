(** Real roots of polynomials with whole coefficients: where the values at two rational numbers have
    two signs there is one between. *)

From Coq Require Import Reals QArith Qreals List Lra.
Import ListNotations.
Local Open Scope R_scope.

Fixpoint polynomial_at (coefficients : list Z) (x : R) : R :=
  match coefficients with
  | [] => 0
  | c :: others => IZR c + x * polynomial_at others x
  end.

Fixpoint rational_value (coefficients : list Z) (x : Q) : Q :=
  match coefficients with
  | [] => 0
  | c :: others => ((c # 1) + x * rational_value others x)%Q
  end.

Lemma rational_value_is : forall l x, Q2R (rational_value l x) = polynomial_at l (Q2R x).
Proof.
  intros l x. induction l as [|c l IH]; simpl; [unfold Q2R; simpl; lra|].
  rewrite Q2R_plus, Q2R_mult, IH. unfold Q2R at 1. simpl. lra.
Qed.

Lemma polynomial_continuous : forall l, continuity (polynomial_at l).
Proof.
  induction l as [|c l IH]; intro x.
  - apply continuity_pt_const. intros y z. reflexivity.
  - apply (continuity_pt_plus (fun _ => IZR c) (fun x => x * polynomial_at l x)).
    + apply continuity_pt_const. intros y z. reflexivity.
    + apply (continuity_pt_mult (fun x => x) (polynomial_at l));
        [apply derivable_continuous, derivable_id|apply IH].
Qed.

Definition has_two_signs (l : list Z) (low high : Q) : bool :=
  Qle_bool low high && Qle_bool (rational_value l low * rational_value l high) 0.

Theorem root_between : forall l low high, has_two_signs l low high = true ->
  exists x, Q2R low <= x <= Q2R high /\ polynomial_at l x = 0.
Proof.
  intros l low high E. apply andb_prop in E. destruct E as [L S].
  apply Qle_bool_imp_le in L. apply Qle_bool_imp_le in S.
  apply Qle_Rle in L. apply Qle_Rle in S. rewrite Q2R_mult, !rational_value_is in S.
  destruct (IVT_cor (polynomial_at l) _ _ (polynomial_continuous l) L) as [x X].
  - replace 0 with (Q2R 0) by (unfold Q2R; simpl; lra). exact S.
  - exists x. exact X.
Qed.
