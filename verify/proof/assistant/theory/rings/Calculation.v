(** Formulas seen to be 0 by calculation, where relations between the names hold. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith List Bool Lia.
From AreaPreservation Require Import Rings Totals Formulas.
Import ListNotations.
Local Open Scope nat_scope.

(** A gap is seen to be 0 by what it is less a sum of factors times relations that are 0. *)
Definition reduced (relations : list formula) (gap : formula) (by_factors : list (nat * formula)) :=
  Minus gap (sum_of (map (fun jf => Times (snd jf) (nth (fst jf) relations (Number 0))) by_factors)).

Fixpoint all_vanish (relations gaps : list formula) (factors : list (list (nat * formula))) : bool :=
  match gaps with
  | [] => true
  | gap :: others =>
      vanishes (reduced relations gap (hd [] factors)) && all_vanish relations others (tl factors)
  end.

Section Calculation.
  Context (K : rational_ring).
  Add Ring calculation : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  (** The calculation that shows it, where the relations are 0. *)
  Theorem calculated : forall names relations gaps factors,
    (forall f, In f relations -> @value_of K names f == zero) ->
    all_vanish relations gaps factors = true -> forall f, In f gaps -> @value_of K names f == zero.
  Proof.
    intros names relations gaps. induction gaps as [|gap gaps IH]; intros factors R E f F; [destruct F|].
    simpl in E. apply andb_prop in E. destruct E as [E E'].
    destruct F as [<-|F]; [|exact (IH (tl factors) R E' f F)].
    assert (Z := vanishes_everywhere K names _ E). unfold reduced in Z. cbn [value_of] in Z.
    rewrite (value_of_sum K) in Z; [transitivity (value_of names gap - zero); [ring|exact Z]|].
    intros g G. apply in_map_iff in G. destruct G as [[j c] [<- _]]. cbn [value_of fst snd].
    destruct (Nat.lt_ge_cases j (length relations)) as [L|L].
    - rewrite (R _ (nth_In _ _ L)). ring.
    - rewrite (nth_overflow relations) by exact L. cbn [value_of]. rewrite (rational_zero K). ring.
  Qed.
End Calculation.
