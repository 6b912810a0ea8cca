(** The value of a series that ends, at a number h. Values respect sums, products, determinants. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Determinants Series.
Local Open Scope nat_scope.

Section Values.
  Context (K : differential_ring).
  Add Ring values : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation power := (power K).

  (** The series f ends before h^m. *)
  Definition ends (f : series K) (m : nat) : Prop := forall k, (m <= k)%nat -> f k == zero.

  Notation partial_sum := (partial_sum K).

  Definition has_value (h : K) (f : series K) (x : K) : Prop :=
    exists m, ends f m /\ x == partial_sum h f m.

  Lemma value_unique : forall h f x m, has_value h f x -> ends f m -> x == partial_sum h f m.
  Proof.
    intros h f x m [l [El ->]] Em.
    rewrite <- (partial_sum_ends K h f m (m + l)), <- (partial_sum_ends K h f l (m + l)) by
      (try assumption; lia). reflexivity.
  Qed.

  Lemma value_of_sum : forall h f g x y, has_value h f x -> has_value h g y ->
    has_value h (@add (series K) f g) (x + y).
  Proof.
    intros h f g x y [m [Em E]] [l [El F]]. exists (m + l)%nat. split.
    - intros k L. simpl. rewrite Em, El by lia. ring.
    - rewrite E, F. rewrite <- (partial_sum_ends K h f m (m + l)), <- (partial_sum_ends K h g l (m + l)) by
        (try assumption; lia).
      unfold Totals.partial_sum. rewrite <- total_add. apply total_same. intros k _. simpl. ring.
  Qed.

  Lemma value_of_product : forall h f g x y, has_value h f x -> has_value h g y ->
    has_value h (@mul (series K) f g) (x * y).
  Proof.
    intros h f g x y [m [Em E]] [l [El F]]. set (w := (m + l)%nat). exists (w + w)%nat. split.
    - intros k L. apply (product_ends K m l); try assumption. unfold w in L. lia.
    - rewrite E, F. rewrite <- (partial_sum_ends K h f m w), <- (partial_sum_ends K h g l w) by
        (try assumption; unfold w; lia).
      unfold Totals.partial_sum. rewrite total_times_total, total_product.
      + apply total_same. intros i _. simpl mul. rewrite product_is, <- total_scaled.
        apply total_same. intros k L.
        assert (P : power h i == power h k * power h (i - k)%nat).
        { rewrite <- power_add. replace (k + (i - k))%nat with i by lia. reflexivity. }
        rewrite P. ring.
      + intros a b [L|L]; [rewrite (Em a)|rewrite (El b)]; try ring; unfold w in L; lia.
  Qed.

  Lemma value_of_determinant : forall h k (M : nat -> nat -> series K) N,
    (forall r c, (r < k)%nat -> (c < k)%nat -> has_value h (M r c) (N r c)) ->
    has_value h (determinant k M) (determinant k N).
  Proof.
    intro h. apply determinants_related.
    - exists O. split; [intros k _|]; reflexivity.
    - exists 1%nat. split; [intros [|k] L; [lia|reflexivity]|]. unfold Totals.partial_sum. simpl. ring.
    - intros f x [m [Em E]]. exists m. split.
      + intros k L. simpl. rewrite Em by exact L. ring.
      + rewrite E. unfold Totals.partial_sum. rewrite <- total_opp. apply total_same.
        intros k _. simpl. ring.
    - intros f f' x x'. apply value_of_sum.
    - intros f f' x x'. apply value_of_product.
  Qed.
End Values.
