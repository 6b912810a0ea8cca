(** A certificate without an order, for a map that is a polynomial in h: the map is symplectic
    exactly, at every h. *)

From Coq Require Import Reals QArith List Lia.
From AreaPreservation Require Import Differential Totals Formulas Identities RealFormulas OneHamiltonian RealMaps RealDefect RealClaims.
Import ListNotations.
Local Open Scope R_scope.

(** Whether the map ends at h^d, and no coefficient of its defect is said to be other than 0: the
    defect ends at h^(2d), so that it has to be known up to there. *)
Definition short_series (x : certificate) (d : nat) : bool :=
  of_length x (S d) && (2 * d <=? known x)%nat
  && match order x with None => true | Some _ => false end.

Lemma short_series_means : forall x d, short_series x d = true ->
  (forall k c, (d < k)%nat -> term x k c = Number 0) /\ (2 * d <= known x)%nat /\ order x = None.
Proof.
  intros x d E. unfold short_series in E. rewrite !andb_true_iff in E. destruct E as [[E L] O].
  split; [|split; [apply Nat.leb_le, L|destruct (order x); [discriminate|reflexivity]]].
  intros k c Lk. unfold term. apply nth_overflow.
  destruct (Nat.lt_ge_cases c (length (series x))) as [M|M].
  - unfold of_length in E. rewrite forallb_forall in E. specialize (E _ (nth_In _ [] M)).
    apply Nat.leb_le in E. lia.
  - rewrite (nth_overflow (series x)) by exact M. simpl. lia.
Qed.

(** The product of two polynomials of degree d. *)
Lemma product_of_polynomials : forall d m (f g : nat -> R) h, (d <= m)%nat ->
  (forall k, (d < k)%nat -> f k = 0) -> (forall k, (d < k)%nat -> g k = 0) ->
  sum (S m) (fun k => f k * h ^ k) * sum (S m) (fun k => g k * h ^ k)
  = sum (S (2 * d)) (fun j => sum (S j) (fun k => f k * g (j - k)%nat) * h ^ j).
Proof.
  intros d m f g h L F G.
  assert (cut : forall u : nat -> R, (forall k, (d < k)%nat -> u k = 0) ->
    sum (S m) (fun k => u k * h ^ k) = @total real_numbers (S d) (fun k => u k * h ^ k)).
  { intros u Z. rewrite <- total_is_sum. apply (total_cut real_numbers); [lia|].
    intros i Li. change (u i * h ^ i = 0). rewrite Z by lia. ring. }
  rewrite (cut f F), (cut g G).
  etransitivity; [exact (total_times_total real_numbers (S d) (S d) _ _)|].
  assert (beyond : forall k l, (S d <= k \/ S d <= l)%nat -> f k * g l = 0).
  { intros k l [M|M]; [rewrite F|rewrite G]; lia || ring. }
  etransitivity; [apply (total_product real_numbers (S d) (fun k l => f k * h ^ k * (g l * h ^ l)))|].
  - intros k l M. change (f k * h ^ k * (g l * h ^ l) = 0).
    transitivity (f k * g l * (h ^ k * h ^ l)); [ring|]. rewrite (beyond k l M). ring.
  - rewrite total_is_sum. replace (S d + S d)%nat with (S (2 * d) + 1)%nat by lia.
    rewrite sum_in_two_parts. rewrite <- (Rplus_0_r (sum (S (2 * d)) (fun j => _ * h ^ j))). f_equal.
    + apply sum_of_equals. intros j _. rewrite total_is_sum, <- sum_times.
      apply sum_of_equals. intros k Lk. replace (h ^ j) with (h ^ k * h ^ (j - k)); [ring|].
      rewrite <- pow_add. f_equal. lia.
    + apply sum_of_zeros. intros i _. rewrite total_is_sum. apply sum_of_zeros. intros k Lk.
      match goal with |- f ?k * _ * (g ?l * _) = 0 => assert (Z := beyond k l ltac:(lia)) end.
      match goal with |- ?a * ?p * (?b * ?q) = 0 =>
        transitivity (a * b * (p * q)); [ring|rewrite Z; ring] end.
Qed.

Section RealExact.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).
  Notation U := (inside v given).
  Notation slope_at z c a k := (value_at z (slope x a (term x k c))).

  (** The map is symplectic: its defect is 0, and not of some order alone. *)
  Theorem exactly_symplectic : forall d, short_series x d = true ->
    forall z, U z -> forall h a b, (a < b)%nat -> (b < 2 * n)%nat ->
    defect_entry n (fun c a => polynomial_slope v given x z c a h) a b = 0.
  Proof.
    intros d E z I h a b L Lb. destruct (short_series_means x d E) as [ends [Ld O]].
    assert (beyond : forall c a k, (d < k)%nat -> slope_at z c a k = 0).
    { intros c a' k Lk. rewrite ends by exact Lk. simpl. unfold real_of. simpl. ring. }
    unfold defect_entry, polynomial_slope.
    rewrite (sum_of_equals n _ (fun i => sum (S (2 * d)) (fun m =>
      (sum (S m) (fun k => slope_at z i a k * slope_at z (n + i)%nat b (m - k)%nat)
       - sum (S m) (fun k => slope_at z i b k * slope_at z (n + i)%nat a (m - k)%nat)) * h ^ m))).
    - rewrite sum_swapped, (sum_of_single _ 0); [|lia|].
      + rewrite sum_times, <- (value_of_defect_formula v given x z 0).
        rewrite (defect_coefficients v energy x factors checked given enough) by (assumption || lia).
        simpl. ring.
      + intros m Lm N. rewrite sum_times, <- (value_of_defect_formula v given x z m).
        rewrite (defect_coefficients v energy x factors checked given enough) by (assumption || lia).
        destruct m as [|m]; [lia|]. unfold expected. rewrite O. simpl. unfold real_of. simpl. ring.
    - intros i _.
      rewrite !(product_of_polynomials d (known x)) by (lia || (intros; apply beyond; lia)).
      rewrite <- sum_of_difference. apply sum_of_equals. intros m _. ring.
  Qed.
End RealExact.
