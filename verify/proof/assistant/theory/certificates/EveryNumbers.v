(** The theorems of a certificate for every H at each number h, and not of coefficients alone: of
    det J, or of S = J^T Omega J - Omega, of the map as a whole and of whatever is left out of it. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith List Bool Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor Bracket Formulas Identities EveryHamiltonian EveryClaims.
Import ListNotations.
Local Open Scope nat_scope.

(** c_0 + c_1 h + c_2 h^2 + ... *)
Fixpoint polynomial {K : rational_ring} (h : K) (l : list K) : K :=
  match l with
  | [] => zero
  | c :: others => add c (mul h (polynomial h others))
  end.

(** The coefficients of a list, and 0 beyond it. *)
Definition coefficients {K : rational_ring} (l : list K) (k : nat) : K := nth k l zero.

Section EveryNumbers.
  Context (e : family_of_energies) (x : certificate) (checked : sound_for_every e x).
  Context (K : differential_ring) (s : system K) (member : belongs s e).
  Add Ring every_numbers : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.
  Notation n := (of_degrees x).
  Notation value f := (@value_of K (names_for_every K s e) f).
  Notation elements := (elements_of e x K s).
  Notation A := (fun k c => coefficients (elements c) k).

  Lemma polynomial_is : forall (h : K) l m, (length l <= m)%nat ->
    polynomial h l == partial_sum K h (coefficients l) m.
  Proof.
    intros h l. induction l as [|c l IH]; intros m L.
    - symmetry. apply total_zero. intros k _. unfold coefficients. destruct k; simpl; ring.
    - destruct m as [|m]; [simpl in L; lia|]. simpl polynomial.
      rewrite (IH m) by (simpl in L; lia). unfold partial_sum. rewrite total_first, <- total_scaled.
      apply add_extends; [unfold coefficients; simpl; ring|].
      apply total_same. intros k _. unfold coefficients. simpl. ring.
  Qed.

  Lemma length_of_elements : forall m, of_length x m = true -> forall c, (length (elements c) <= m)%nat.
  Proof.
    intros m short c. unfold elements_of. change (@nil K) with (map (fun f => value f) []).
    rewrite (map_nth (map (fun f => value f))), map_length.
    destruct (Nat.lt_ge_cases c (length (series x))) as [L|L].
    - unfold of_length in short. rewrite forallb_forall in short. apply Nat.leb_le, short, nth_In, L.
    - rewrite nth_overflow by exact L. simpl. lia.
  Qed.

  Lemma elements_end : forall m, of_length x m = true -> forall k c, (m <= k)%nat -> A k c == zero.
  Proof.
    intros m short k c L. unfold coefficients.
    rewrite nth_overflow by (assert (B := length_of_elements m short c); lia). reflexivity.
  Qed.

  (** The new value of the coordinate c at h, as far as the coefficients tell. *)
  Definition told (h : K) (c : nat) : K := polynomial h (elements c).

  Lemma pairs_told : forall m h a b, of_length x m = true -> is_constant K h ->
    pairs K s (told h) (told h) a b
    == partial_sum K h (fun j => defect_coefficient K s A j a b) (m + m).
  Proof.
    intros m h a b short C. rewrite <- pairs_at_number by (exact C || exact (elements_end m short)).
    apply pairs_same; intro c; apply polynomial_is, length_of_elements, short.
  Qed.

  Lemma coefficients_end : forall m j a b, of_length x m = true -> (m + m <= S j)%nat ->
    defect_coefficient K s A j a b == zero.
  Proof.
    intros m j a b short L.
    exact (defect_coefficient_ends K s A m (elements_end m short) j a b L).
  Qed.

  Lemma is_told : forall k c, (k <= known x)%nat -> (c < 2 * n)%nat -> A k c == value (term x k c).
  Proof. intros k c _ _. symmetry. apply element_is. Qed.

  (** S of a map: L h^r, the l coefficients that are left, and what the part u h^(known+1) of the map
      adds, of which nothing is told. *)
  Theorem form_at_number : forall r m l, order x = Some r -> (1 <= r <= known x)%nat ->
    of_length x m = true -> (m + m <= S (S r + l))%nat -> forall h u, is_constant K h ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    pairs K s (fun c => told h c + h ^ S (known x) * u c) (fun c => told h c + h ^ S (known x) * u c) a b
    == canonical K s a b + h ^ r * value (leading_entry x a b)
       + h ^ S r * partial_sum K h (fun k => defect_coefficient K s A (S r + k) a b) l
       + h ^ S (known x) * (pairs K s (told h) u a b + pairs K s u (told h) a b
                            + h ^ S (known x) * pairs K s u u a b).
  Proof.
    intros r m l E R short L h u C a b La Lb.
    rewrite pairs_with_remainder by (apply power_constant, C). rewrite (pairs_told m h a b short C).
    assert (ends := fun k Lk => coefficients_end m k a b short Lk).
    rewrite <- (partial_sum_ends K h _ (m + m) (m + m + (S r + l))),
      (partial_sum_ends K h _ (S r + l)) by (try lia; intros k Lk; apply ends; lia).
    rewrite partial_sum_first by
      (try lia; intros k Lk; apply (every_defect_before e x checked K s member A is_told r);
       assumption || lia).
    rewrite (every_defect_start e x checked K s member A is_told).
    rewrite (every_defect_first e x checked K s member A is_told r) by assumption. reflexivity.
  Qed.

  (** Where no order is told no coefficient is left, of a map that is known as a whole. *)
  Theorem coefficients_vanish : forall m, order x = None -> of_length x m = true ->
    (m + m <= S (S (known x)))%nat -> forall j a b, (1 <= j)%nat -> (a < b)%nat -> (b < 2 * n)%nat ->
    defect_coefficient K s A j a b == zero.
  Proof.
    intros m E short L j a b Lj La Lb. destruct (Nat.le_gt_cases j (known x)) as [M|M].
    - rewrite (every_defect e x checked K s member A is_told) by (assumption || lia).
      unfold expected. rewrite E. apply rational_zero.
    - apply (coefficients_end m); [exact short|lia].
  Qed.

  (** So it keeps the form at each number h. *)
  Theorem form_is_kept : forall m, order x = None -> of_length x m = true ->
    (m + m <= S (S (known x)))%nat -> forall h, is_constant K h ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    pairs K s (told h) (told h) a b == canonical K s a b.
  Proof.
    intros m E short L h C a b La Lb. rewrite (pairs_told m h a b short C).
    rewrite <- (partial_sum_ends K h _ (m + m) (S (m + m))) by
      (first [lia | intros k Lk; apply (coefficients_end m k a b short); lia]).
    unfold partial_sum. rewrite (total_one K _ 0) by
      (first [lia | intros k Lk N; rewrite (coefficients_vanish m) by (assumption || lia); ring]).
    rewrite (every_defect_start e x checked K s member A is_told). simpl. ring.
  Qed.

  (** * The plane *)

  Context (plane : degrees s = 1%nat).
  Notation P h := (polynomial h (elements 0)).
  Notation Q h := (polynomial h (elements 1)).
  Notation det_coefficient :=
    (determinant_coefficient (coefficients (elements 0)) (coefficients (elements 1))).

  Theorem determinant_at_number : forall r m l, order x = Some r -> (1 <= r <= known x)%nat ->
    of_length x m = true -> (m + m <= S (S r + l))%nat -> forall h u w, is_constant K h ->
    bracket K (P h + h ^ S (known x) * u) (Q h + h ^ S (known x) * w)
    == one + h ^ r * value (leading_entry x 0 1)
       + h ^ S r * partial_sum K h (fun k => det_coefficient (S r + k)%nat) l
       + h ^ S (known x) * (bracket K (P h) w + bracket K u (Q h) + h ^ S (known x) * bracket K u w).
  Proof.
    intros r m l E R short L h u w C. assert (N := one_degree e x checked K s member plane).
    assert (F := form_at_number r m l E R short L h (fun c => match c with O => u | _ => w end) C 0 1
      ltac:(lia) ltac:(lia)).
    rewrite !(pairs_in_plane K s plane), (canonical_in_plane K s plane) in F.
    unfold told in F. rewrite F. rewrite (partial_sum_same K h _ (fun k => det_coefficient (S r + k)%nat));
      [ring|]. intros k _. apply (determinant_coefficient_is K s plane).
  Qed.

  Theorem determinant_coefficients_vanish : forall m, order x = None -> of_length x m = true ->
    (m + m <= S (S (known x)))%nat ->
    det_coefficient 0 == one /\ forall j, (1 <= j)%nat -> det_coefficient j == zero.
  Proof.
    intros m E short L. assert (N := one_degree e x checked K s member plane).
    assert (is := determinant_coefficient_is K s plane A). split.
    - rewrite <- (is 0%nat), (every_defect_start e x checked K s member A is_told).
      apply (canonical_in_plane K s plane).
    - intros j Lj. rewrite <- (is j). apply (coefficients_vanish m); assumption || lia.
  Qed.

  Theorem determinant_is_one : forall m, order x = None -> of_length x m = true ->
    (m + m <= S (S (known x)))%nat -> forall h, is_constant K h -> bracket K (P h) (Q h) == one.
  Proof.
    intros m E short L h C. assert (N := one_degree e x checked K s member plane).
    rewrite <- (pairs_in_plane K s plane (told h) (told h)).
    rewrite (form_is_kept m E short L h C 0 1) by lia. apply (canonical_in_plane K s plane).
  Qed.
End EveryNumbers.
