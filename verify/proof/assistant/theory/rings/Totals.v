(** Finite sums of elements of a ring. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings.
Local Open Scope nat_scope.

Fixpoint total {K : rational_ring} (n : nat) (f : nat -> K) : K :=
  match n with
  | O => zero
  | S k => add (total k f) (f k)
  end.

(** f_0 + f_1 h + .. + f_(m-1) h^(m-1). *)
Definition partial_sum (K : rational_ring) (h : K) (f : nat -> K) (m : nat) : K :=
  total m (fun k => mul (power K h k) (f k)).

Section Totals.
  Context (K : rational_ring).
  Add Ring totals : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Lemma total_same : forall n (f g : nat -> K),
    (forall i, (i < n)%nat -> f i == g i) -> total n f == total n g.
  Proof.
    induction n as [|n IH]; intros f g E; simpl; [reflexivity|].
    rewrite (IH f g), (E n) by (intros; try apply E; lia). reflexivity.
  Qed.

  Lemma total_zero : forall n (f : nat -> K),
    (forall i, (i < n)%nat -> f i == zero) -> total n f == zero.
  Proof.
    induction n as [|n IH]; intros f E; simpl; [reflexivity|].
    rewrite IH, E by (intros; try apply E; lia). ring.
  Qed.

  Lemma total_add : forall n (f g : nat -> K),
    total n (fun i => f i + g i) == total n f + total n g.
  Proof. induction n as [|n IH]; intros f g; simpl; [ring|]. rewrite IH. ring. Qed.

  Lemma total_opp : forall n (f : nat -> K), total n (fun i => - f i) == - total n f.
  Proof. induction n as [|n IH]; intro f; simpl; [ring|]. rewrite IH. ring. Qed.

  Lemma total_sub : forall n (f g : nat -> K),
    total n (fun i => f i - g i) == total n f - total n g.
  Proof. induction n as [|n IH]; intros f g; simpl; [ring|]. rewrite IH. ring. Qed.

  Lemma total_scaled : forall n (x : K) f, total n (fun i => x * f i) == x * total n f.
  Proof. induction n as [|n IH]; intros x f; simpl; [ring|]. rewrite IH. ring. Qed.

  Lemma total_of_four : forall n (u v w x : K) f g h k,
    total n (fun i => u * f i - v * g i + (w * h i - x * k i))
    == u * total n f - v * total n g + (w * total n h - x * total n k).
  Proof. induction n as [|n IH]; intros u v w x f g h k; simpl; [ring|]. rewrite IH. ring. Qed.

  Lemma total_times_total : forall m n (f g : nat -> K),
    total m f * total n g == total m (fun k => total n (fun l => f k * g l)).
  Proof.
    intros m n f g. transitivity (total n g * total m f); [ring|].
    rewrite <- total_scaled. apply total_same. intros k _. rewrite total_scaled. ring.
  Qed.

  Lemma total_first : forall n (f : nat -> K),
    total (S n) f == f 0%nat + total n (fun i => f (S i)).
  Proof.
    induction n as [|n IH]; intro f; [simpl; ring|].
    transitivity (total (S n) f + f (S n)); [reflexivity|]. rewrite IH. simpl. ring.
  Qed.

  Lemma total_swap : forall m n (f : nat -> nat -> K),
    total m (fun i => total n (f i)) == total n (fun j => total m (fun i => f i j)).
  Proof.
    induction m as [|m IH]; intros n f; simpl.
    - symmetry. apply total_zero. reflexivity.
    - rewrite IH, total_add. reflexivity.
  Qed.

  (** Terms that are zero from [n] on do not count. *)
  Lemma total_cut : forall m n (f : nat -> K),
    (n <= m)%nat -> (forall i, (n <= i)%nat -> f i == zero) -> total m f == total n f.
  Proof.
    intros m n f L Z. induction L as [|m L IH]; [reflexivity|].
    simpl. rewrite IH, Z by exact L. ring.
  Qed.

  Lemma total_split : forall m k (f : nat -> K),
    total (m + k)%nat f == total m f + total k (fun i => f (m + i)%nat).
  Proof.
    intros m k f. induction k as [|k IH].
    - replace (m + 0)%nat with m by lia. simpl. ring.
    - replace (m + S k)%nat with (S (m + k)) by lia. simpl. rewrite IH. ring.
  Qed.

  Lemma total_one : forall n k (f : nat -> K), (k < n)%nat ->
    (forall i, (i < n)%nat -> i <> k -> f i == zero) -> total n f == f k.
  Proof.
    induction n as [|n IH]; intros k f L Z; [lia|]. simpl.
    destruct (Nat.eq_dec k n) as [->|N].
    - rewrite (total_zero n) by (intros; apply Z; lia). ring.
    - rewrite (IH k), (Z n) by (intros; try apply Z; lia). ring.
  Qed.

  (** The terms of a product of two sums, by the sum of their numbers. *)
  Lemma total_triangle : forall n (g : nat -> nat -> K),
    total n (fun m => total (S m) (fun k => g k (m - k)%nat))
    == total n (fun k => total (n - k)%nat (g k)).
  Proof.
    induction n as [|n IH]; intro g; [reflexivity|].
    change (total n (fun m => total (S m) (fun k => g k (m - k)%nat))
      + total (S n) (fun k => g k (n - k)%nat) == total (S n) (fun k => total (S n - k)%nat (g k))).
    rewrite (IH g). symmetry.
    change (total n (fun k => total (S n - k)%nat (g k)) + total (S n - n)%nat (g n)
      == total n (fun k => total (n - k)%nat (g k))
         + (total n (fun k => g k (n - k)%nat) + g n (n - n)%nat)).
    rewrite (total_same n _ (fun k => total (n - k)%nat (g k) + g k (n - k)%nat)).
    - rewrite total_add. replace (S n - n)%nat with 1%nat by lia.
      replace (n - n)%nat with O by lia. simpl. ring.
    - intros k L. replace (S n - k)%nat with (S (n - k)) by lia. reflexivity.
  Qed.

  Lemma total_product : forall n (g : nat -> nat -> K),
    (forall k l, (n <= k \/ n <= l)%nat -> g k l == zero) ->
    total n (fun k => total n (g k))
    == total (n + n)%nat (fun m => total (S m) (fun k => g k (m - k)%nat)).
  Proof.
    intros n g Z. rewrite total_triangle. symmetry.
    rewrite (total_cut (n + n) n) by
      (try lia; intros i L; apply total_zero; intros; apply Z; lia).
    apply total_same. intros k L. apply total_cut; [lia|]. intros i M. apply Z. lia.
  Qed.

  Lemma partial_sum_same : forall h f g m, (forall k, (k < m)%nat -> f k == g k) ->
    partial_sum K h f m == partial_sum K h g m.
  Proof. intros h f g m E. apply total_same. intros k L. rewrite (E k L). reflexivity. Qed.

  Lemma partial_sum_ends : forall h f m l, (forall k, (m <= k)%nat -> f k == zero) -> (m <= l)%nat ->
    partial_sum K h f l == partial_sum K h f m.
  Proof. intros h f m l E L. apply total_cut; [exact L|]. intros k Lk. rewrite E by exact Lk. ring. Qed.

  (** Where no terms stand between that of h^0 and that of h^r. *)
  Lemma partial_sum_first : forall h f r l, (1 <= r)%nat ->
    (forall k, (1 <= k < r)%nat -> f k == zero) ->
    partial_sum K h f (S r + l)
    == f O + h ^ r * f r + h ^ S r * partial_sum K h (fun k => f (S r + k)%nat) l.
  Proof.
    intros h f r l L Z. unfold partial_sum. rewrite total_split, <- total_scaled.
    apply add_extends.
    - change (total (S r) (fun k => h ^ k * f k)) with (total r (fun k => h ^ k * f k) + h ^ r * f r).
      rewrite (total_one r 0) by (first [lia | intros k Lk N; rewrite Z by lia; ring]).
      simpl. ring.
    - apply total_same. intros k _. rewrite (power_add K). ring.
  Qed.
End Totals.

Section DerivedTotals.
  Context (K : differential_ring).
  Local Open Scope ring_of_functions.

  Lemma derivation_total : forall i n (f : nat -> K),
    by_coordinate i (total n f) == total n (fun k => by_coordinate i (f k)).
  Proof.
    intros i n f. induction n as [|n IH]; simpl; [apply derivation_zero|].
    rewrite derivation_add, IH. reflexivity.
  Qed.
End DerivedTotals.
