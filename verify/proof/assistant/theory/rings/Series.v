(** Formal power series in h over a ring of functions, as their coefficients. They are a ring of the
    same kind, so that all that is said of such rings is said of series. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Taylor Determinants.
Local Open Scope nat_scope.

(** The product of two series: (f_0 + h f') g = f_0 g + h f' g. *)
Fixpoint convolution {K : differential_ring} (f g : nat -> K) (m : nat) : K :=
  match m with
  | O => mul (f O) (g O)
  | S l => add (mul (f O) (g (S l))) (convolution (fun k => f (S k)) g l)
  end.

(** A series that is a number. *)
Definition number {K : differential_ring} (x : K) (k : nat) : K :=
  match k with
  | O => x
  | S _ => zero
  end.

Section Products.
  Context (K : differential_ring).
  Add Ring products : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Implicit Types f g e : nat -> K.

  Lemma times_zero : forall x : K, x * zero == zero.
  Proof. intro x. ring. Qed.

  Lemma product_is : forall m f g,
    convolution f g m == total (S m) (fun k => f k * g (m - k)%nat).
  Proof.
    induction m as [|m IH]; intros f g; [simpl; ring|].
    rewrite total_first. simpl convolution. rewrite IH. reflexivity.
  Qed.

  Lemma product_same : forall m f f' g g', (forall k, f k == f' k) -> (forall k, g k == g' k) ->
    convolution f g m == convolution f' g' m.
  Proof.
    intros m f f' g g' E F. rewrite !product_is. apply total_same. intros k _.
    rewrite E, F. reflexivity.
  Qed.

  Lemma product_add_left : forall m f f' g,
    convolution (fun k => f k + f' k) g m == convolution f g m + convolution f' g m.
  Proof. induction m as [|m IH]; intros f f' g; simpl; [|rewrite IH]; ring. Qed.

  Lemma product_scaled : forall m x f g,
    convolution (fun k => x * f k) g m == x * convolution f g m.
  Proof. induction m as [|m IH]; intros x f g; simpl; [|rewrite IH]; ring. Qed.

  Lemma product_zero : forall m f g, (forall k, f k == zero) -> convolution f g m == zero.
  Proof.
    intros m f g Z. rewrite product_is. apply total_zero. intros k _. rewrite Z. ring.
  Qed.

  Lemma product_of_number : forall m x g, convolution (number x) g m == x * g m.
  Proof.
    intros [|m] x g; simpl; [reflexivity|]. rewrite product_zero by reflexivity. ring.
  Qed.

  Lemma product_last : forall m f g,
    convolution f g (S m) == convolution f (fun k => g (S k)) m + f (S m) * g O.
  Proof.
    induction m as [|m IH]; intros f g; [simpl; ring|].
    change (f O * g (S (S m)) + convolution (fun k => f (S k)) g (S m)
      == f O * g (S (S m)) + convolution (fun k => f (S k)) (fun k => g (S k)) m
        + f (S (S m)) * g O).
    rewrite IH. ring.
  Qed.

  Lemma product_commutes : forall m f g, convolution f g m == convolution g f m.
  Proof.
    induction m as [|m IH]; intros f g; [simpl; ring|].
    rewrite product_last. simpl. rewrite (IH f). ring.
  Qed.

  Lemma product_associates : forall m f g e,
    convolution f (convolution g e) m == convolution (convolution f g) e m.
  Proof.
    induction m as [|m IH]; intros f g e; [simpl; ring|].
    change (f O * (g O * e (S m) + convolution (fun k => g (S k)) e m)
        + convolution (fun k => f (S k)) (convolution g e) m
      == f O * g O * e (S m)
        + convolution (fun k => f O * g (S k) + convolution (fun k => f (S k)) g k) e m).
    rewrite product_add_left, product_scaled, IH. ring.
  Qed.

  (** A derivation of the coefficients, one by one. *)
  Lemma product_derived : forall delta, derivation K delta -> forall m f g,
    delta (convolution f g m)
    == convolution (fun k => delta (f k)) g m + convolution f (fun k => delta (g k)) m.
  Proof.
    intros delta [extends adds multiplies]. induction m as [|m IH]; intros f g; simpl;
      [apply multiplies|]. rewrite adds, multiplies, IH. ring.
  Qed.

  (** d/dh. *)
  Definition slope_in_h f (k : nat) : K := whole (S k) * f (S k).

  Lemma whole_next : forall k, @whole K (S k) == one + whole k.
  Proof.
    intro k. change (S k) with (1 + k)%nat. rewrite whole_add.
    apply add_extends; [apply rational_one|reflexivity].
  Qed.

  Lemma whole_zero : @whole K 0 == zero.
  Proof. apply rational_zero. Qed.

  Lemma product_slope_in_h : forall m f g,
    slope_in_h (convolution f g) m
    == convolution (slope_in_h f) g m + convolution f (slope_in_h g) m.
  Proof.
    induction m as [|m IH]; intros f g.
    - unfold slope_in_h. simpl. rewrite whole_next, whole_zero. ring.
    - assert (E := IH (fun k => f (S k)) g). unfold slope_in_h at 1 in E.
      unfold slope_in_h at 1. rewrite (whole_next (S m)).
      change (convolution f g (S (S m))) with (f O * g (S (S m))
        + (f 1%nat * g (S m) + convolution (fun k => f (S (S k))) g m)).
      change (convolution (slope_in_h f) g (S m)) with (whole 1 * f 1%nat * g (S m)
        + convolution (fun k => whole (S (S k)) * f (S (S k))) g m).
      change (convolution f (slope_in_h g) (S m)) with (f O * (whole (S (S m)) * g (S (S m)))
        + convolution (fun k => f (S k)) (slope_in_h g) m).
      rewrite (product_same m (fun k => whole (S (S k)) * f (S (S k))) (fun k => f (S (S k))
        + slope_in_h (fun k => f (S k)) k) g g) by
        (try reflexivity; intro k; unfold slope_in_h; rewrite (whole_next (S k)); ring).
      rewrite product_add_left.
      transitivity (f O * g (S (S m)) + whole (S m) * f O * g (S (S m))
        + (f 1%nat * g (S m) + convolution (fun k => f (S (S k))) g m)
        + whole (S m) * convolution (fun k => f (S k)) g (S m)); [simpl convolution; ring|].
      rewrite E, (whole_next (S m)), (whole_next 0), whole_zero. ring.
  Qed.

  (** h^k times a series begins with h^k. *)
  Lemma product_below : forall l m f g, (forall k, (k < l)%nat -> f k == zero) -> (m <= l)%nat ->
    convolution f g m == if (m =? l)%nat then f l * g O else zero.
  Proof.
    induction l as [|l IH]; intros m f g Z L.
    - replace m with O by lia. reflexivity.
    - destruct m as [|m]; simpl; rewrite Z by lia; [ring|].
      rewrite (IH m (fun k => f (S k))) by (try (intros; apply Z); lia). ring.
  Qed.

  (** Where both end so does the product. *)
  Lemma product_ends : forall m n f g, (forall k, (m <= k)%nat -> f k == zero) ->
    (forall k, (n <= k)%nat -> g k == zero) ->
    forall k, (m + n <= k)%nat -> convolution f g k == zero.
  Proof.
    intros m n f g E F k L. rewrite product_is. apply total_zero. intros i Li.
    destruct (Nat.le_gt_cases m i) as [M|M]; [rewrite E by exact M|rewrite F by lia]; ring.
  Qed.
End Products.

(** The ring of series. *)
Definition rational_series (K : differential_ring) : rational_ring.
Proof.
  refine {|
    carrier := nat -> K;
    same := fun f g => forall k, same (f k) (g k);
    zero := fun _ => zero;
    one := number one;
    add := fun f g k => add (f k) (g k);
    mul := convolution;
    sub := fun f g k => sub (f k) (g k);
    opp := fun f k => opp (f k);
    rational := fun a => number (rational a);
  |}.
  - split.
    + intros f k. reflexivity.
    + intros f g E k. symmetry. apply E.
    + intros f g e E F k. rewrite (E k). apply F.
  - split.
    + intros f f' E g g' F k. rewrite (E k), (F k). reflexivity.
    + intros f f' E g g' F k. apply product_same; assumption.
    + intros f f' E k. rewrite (E k). reflexivity.
  - split; intros.
    + apply (Radd_0_l (ring_laws K)).
    + apply (Radd_comm (ring_laws K)).
    + apply (Radd_assoc (ring_laws K)).
    + rewrite product_of_number. apply (Rmul_1_l (ring_laws K)).
    + apply product_commutes.
    + apply product_associates.
    + apply product_add_left.
    + apply (Rsub_def (ring_laws K)).
    + apply (Ropp_def (ring_laws K)).
  - intros a b E [|k]; [apply rational_extends, E|reflexivity].
  - intros [|k]; [apply rational_one|reflexivity].
  - intros a b [|k]; [apply rational_add|symmetry; apply (Radd_0_l (ring_laws K))].
  - intros a b k. rewrite product_of_number. destruct k as [|k]; [apply rational_mul|].
    symmetry. apply times_zero.
Defined.

Definition series (K : differential_ring) : differential_ring.
Proof.
  refine {| functions := rational_series K; by_coordinate := fun i f k => by_coordinate i (f k) |}.
  - intros i f g E k. apply derivation_extends, E.
  - intros i f g k. apply derivation_add.
  - intros i f g k. apply product_derived.
    split; [apply derivation_extends|apply derivation_add|apply derivation_mul].
  - intros i j f k. apply derivations_commute.
Defined.

Section Series.
  Context (K : differential_ring).
  Local Open Scope ring_of_functions.

  (** The first coefficient of a determinant. *)
  Lemma determinant_at_0 : forall k (M : nat -> nat -> series K),
    determinant k M O == determinant k (fun r c => M r c O).
  Proof.
    intros k M.
    apply (determinants_related (series K) K (fun f x => f O == x)); try reflexivity.
    - intros f x E. simpl. rewrite E. reflexivity.
    - intros f f' x x' E F. simpl. rewrite E, F. reflexivity.
    - intros f f' x x' E F. simpl. rewrite E, F. reflexivity.
  Qed.

  Lemma coefficient_of_total : forall m (f : nat -> series K) k,
    total m f k == total m (fun i => f i k).
  Proof. induction m as [|m IH]; intros f k; [reflexivity|]. simpl. rewrite IH. reflexivity. Qed.
End Series.
