(** Determinants over a commutative ring.

    The determinant is expanded along its first column. It is linear in each column, zero where two
    columns are equal, and one of the identity; a derivation acts on it column by column. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals.
Local Open Scope nat_scope.

(** The numbers without i, in order. *)
Definition past (i r : nat) : nat := if r <? i then r else S r.

(** sum_i (-1)^i M_(i,0) det(M without the row i and the column 0). *)
Fixpoint determinant {K : differential_ring} (k : nat) (M : nat -> nat -> K) : K :=
  match k with
  | O => one
  | S m => total (S m) (fun i =>
      mul (power K (opp one) i) (mul (M i 0) (determinant m (fun r c => M (past i r) (S c)))))
  end.

(** M with the column j replaced. *)
Definition with_column {K : differential_ring} (M : nat -> nat -> K) (j : nat) (v : nat -> K) :
  nat -> nat -> K := fun r c => if c =? j then v r else M r c.

Definition identity {K : differential_ring} (r c : nat) : K := if r =? c then one else zero.

Record derivation (K : differential_ring) (delta : K -> K) : Prop := {
  it_extends : forall x y, same x y -> same (delta x) (delta y);
  it_adds : forall x y, same (delta (add x y)) (add (delta x) (delta y));
  it_multiplies : forall x y, same (delta (mul x y)) (add (mul (delta x) y) (mul x (delta y)));
}.

Lemma past_below : forall i r m, (i < S m)%nat -> (r < m)%nat -> (past i r < S m)%nat.
Proof. intros i r m Li Lr. unfold past. destruct (r <? i); lia. Qed.

(** Two numbers are left out in either order. *)
Lemma past_past : forall i l r, let j := past i l in
  past i (past l r) = past (Nat.max i j) (past (Nat.min i j) r).
Proof.
  intros i l r j. unfold j, past.
  destruct (Nat.ltb_spec l i);
    [replace (Nat.max i l) with i by lia; replace (Nat.min i l) with l by lia; reflexivity|].
  replace (Nat.max i (S l)) with (S l) by lia. replace (Nat.min i (S l)) with i by lia.
  destruct (Nat.ltb_spec r l), (Nat.ltb_spec r i), (Nat.ltb_spec (S r) i), (Nat.ltb_spec r (S l)),
    (Nat.ltb_spec (S r) (S l)); lia.
Qed.

(** Relations that respect the operations respect determinants. *)
Lemma determinants_related : forall (K L : differential_ring) (R : K -> L -> Prop),
  R zero zero -> R one one -> (forall x y, R x y -> R (opp x) (opp y)) ->
  (forall x x' y y', R x y -> R x' y' -> R (add x x') (add y y')) ->
  (forall x x' y y', R x y -> R x' y' -> R (mul x x') (mul y y')) ->
  forall k (M : nat -> nat -> K) (N : nat -> nat -> L),
  (forall r c, r < k -> c < k -> R (M r c) (N r c)) -> R (determinant k M) (determinant k N).
Proof.
  intros K L R R_zero R_one R_opp R_add R_mul.
  assert (R_total : forall n f g, (forall i, i < n -> R (f i) (g i)) -> R (total n f) (total n g)).
  { induction n as [|n IH]; intros f g E; simpl; [exact R_zero|].
    apply R_add; [apply IH; intros i Li|]; apply E; lia. }
  induction k as [|k IH]; intros M N E; [exact R_one|].
  apply R_total. intros i Li. apply R_mul.
  - clear Li. induction i as [|i IHi]; [exact R_one|]. apply R_mul; [apply R_opp, R_one|exact IHi].
  - apply R_mul; [apply E; lia|].
    apply IH. intros r c Lr Lc. apply E; [apply past_below; assumption|lia].
Qed.

Section Determinants.
  Context (K : differential_ring).
  Add Ring determinants : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Implicit Types M N : nat -> nat -> K.
  Notation sign := (power K (- one)).

  Lemma determinant_same : forall k M N,
    (forall r c, (r < k)%nat -> (c < k)%nat -> M r c == N r c) ->
    determinant k M == determinant k N.
  Proof.
    apply determinants_related; try reflexivity.
    - intros x y E. rewrite E. reflexivity.
    - intros x x' y y' E F. rewrite E, F. reflexivity.
    - intros x x' y y' E F. rewrite E, F. reflexivity.
  Qed.

  (** A check of the signs. *)
  Lemma determinant_of_two : forall M,
    determinant 2 M == M 0%nat 0%nat * M 1%nat 1%nat - M 0%nat 1%nat * M 1%nat 0%nat.
  Proof. intro M. simpl. unfold past. simpl. ring. Qed.

  Lemma determinant_of_identity : forall k M,
    (forall r c, (r < k)%nat -> (c < k)%nat -> M r c == identity r c) -> determinant k M == one.
  Proof.
    induction k as [|k IH]; intros M E; [reflexivity|]. cbn [determinant].
    rewrite (total_one K (S k) 0) by
      (first [lia | intros [|i] Li N; [lia|rewrite E by lia; unfold identity; simpl; ring]]).
    rewrite IH by (intros r c Lr Lc; apply (E (S r) (S c)); lia).
    rewrite E by lia. unfold identity. simpl. ring.
  Qed.

  (** In each column the determinant is linear. *)
  Lemma determinant_linear : forall k M j x y u v, (j < k)%nat ->
    determinant k (with_column M j (fun r => x * u r + y * v r))
    == x * determinant k (with_column M j u) + y * determinant k (with_column M j v).
  Proof.
    induction k as [|k IH]; intros M j x y u v L; [lia|]. cbn [determinant].
    rewrite <- !total_scaled, <- total_add. apply total_same. intros i _.
    destruct j as [|j].
    - unfold with_column. simpl. ring.
    - assert (minor : forall w, determinant k (fun r c => with_column M (S j) w (past i r) (S c))
        == determinant k (with_column (fun r c => M (past i r) (S c)) j (fun r => w (past i r))))
        by reflexivity.
      rewrite !minor, IH by lia. unfold with_column at 1 4 6. simpl. ring.
  Qed.

  Lemma determinant_of_combination : forall k M j m x u, (j < k)%nat ->
    determinant k (with_column M j (fun r => total m (fun b => x b * u b r)))
    == total m (fun b => x b * determinant k (with_column M j (u b))).
  Proof.
    intros k M j m x u L. induction m as [|m IH]; simpl.
    - transitivity (determinant k (with_column M j (fun r => zero * zero + zero * zero))).
      + apply determinant_same. intros r c _ _. unfold with_column. destruct (c =? j); ring.
      + rewrite (determinant_linear k M j zero zero (fun _ => zero) (fun _ => zero)) by exact L.
        ring.
    - rewrite <- IH.
      transitivity (determinant k (with_column M j (fun r =>
        one * total m (fun b => x b * u b r) + x m * u m r))).
      + apply determinant_same. intros r c _ _. unfold with_column. destruct (c =? j); ring.
      + rewrite (determinant_linear k M j one (x m)) by exact L. ring.
  Qed.

  (** Two rows i and j left out in either order: the signs differ. *)
  Lemma terms_cancel : forall n (g : nat -> nat -> K), (forall i j, g i j == g j i) ->
    total (S n) (fun i => total n (fun l => sign i * sign l * g i (past i l))) == zero.
  Proof.
    intros n g symmetric. induction n as [|n IH]; [simpl; ring|].
    change (total (S n) (fun i => total n (fun l => sign i * sign l * g i (past i l))
        + sign i * sign n * g i (past i n))
      + total (S n) (fun l => sign (S n) * sign l * g (S n) (past (S n) l)) == zero).
    rewrite total_add, IH.
    transitivity (total (S n) (fun i => sign i * sign n * g i (past i n)
      + sign (S n) * sign i * g (S n) (past (S n) i))); [rewrite total_add; ring|].
    apply total_zero. intros i L. unfold past.
    rewrite (proj2 (Nat.ltb_ge n i)), (proj2 (Nat.ltb_lt i (S n))) by lia.
    rewrite (symmetric (S n) i). simpl. ring.
  Qed.

  Lemma first_columns_equal : forall k M, (forall r, (r < S (S k))%nat -> M r 0%nat == M r 1%nat) ->
    determinant (S (S k)) M == zero.
  Proof.
    intros k M E.
    set (g := fun i j => M i 0%nat * M j 0%nat *
      determinant k (fun r c => M (past (Nat.max i j) (past (Nat.min i j) r)) (S (S c)))).
    rewrite <- (terms_cancel (S k) g).
    - cbn [determinant]. apply total_same. intros i Li.
      transitivity (sign i * M i 0%nat * total (S k) (fun l => sign l * (M (past i l) 1%nat
        * determinant k (fun r c => M (past i (past l r)) (S (S c)))))); [ring|].
      rewrite <- total_scaled. apply total_same. intros l Ll. unfold g.
      rewrite (determinant_same k _ (fun r c =>
        M (past (Nat.max i (past i l)) (past (Nat.min i (past i l)) r)) (S (S c)))) by
        (intros r c _ _; rewrite past_past; reflexivity).
      rewrite <- E by (apply past_below; assumption). ring.
    - intros i j. unfold g. rewrite (Nat.max_comm i j), (Nat.min_comm i j). ring.
  Qed.

  Lemma ordered_columns_equal : forall k M i j, (i < j)%nat -> (j < k)%nat ->
    (forall r, (r < k)%nat -> M r i == M r j) -> determinant k M == zero.
  Proof.
    induction k as [|k IH]; intros M i j Lij Ljk E; [lia|].
    assert (later : forall N i j, (i < j)%nat -> (j < k)%nat ->
      (forall r, (r < S k)%nat -> N r (S i) == N r (S j)) -> determinant (S k) N == zero).
    { intros N a b Lab Lbk F. cbn [determinant]. apply total_zero. intros l Ll.
      rewrite (IH _ a b) by (try assumption; intros; apply F, past_below; assumption). ring. }
    destruct i as [|i]; [|destruct j as [|j]; [lia|apply (later M i j); try assumption; lia]].
    destruct k as [|k]; [lia|].
    destruct j as [|[|j]]; [lia|apply first_columns_equal; exact E|].
    (* 0 = det(w, u + w, .., u + w) = det(w, u, .., w) for the columns 0, 1 and j + 2. *)
    set (u := fun r => M r 1%nat). set (w := fun r => M r 0%nat).
    set (B := fun x y => determinant (S (S k)) (with_column (with_column M 1 x) (S (S j)) y)).
    set (v := fun r => one * u r + one * w r).
    assert (equal : forall x, B x x == zero).
    { intro x. apply (later _ 0 (S j)); try lia. intros r _. unfold with_column. simpl.
      rewrite Nat.eqb_refl. reflexivity. }
    assert (first : forall y, B w y == zero).
    { intro y. apply first_columns_equal. intros r _. reflexivity. }
    assert (right_side : forall x, B x v == one * B x u + one * B x w).
    { intro x. apply determinant_linear. exact Ljk. }
    assert (left_side : forall y, B v y == one * B u y + one * B w y).
    { intro y. assert (order : forall x, B x y == determinant (S (S k))
        (with_column (with_column M (S (S j)) y) 1 x)).
      { intro x. apply determinant_same. intros r c _ _. unfold with_column.
        destruct (Nat.eqb_spec c (S (S j))), (Nat.eqb_spec c 1); try reflexivity; lia. }
      rewrite !order. apply determinant_linear. lia. }
    transitivity (B u w).
    - apply determinant_same. intros r c Lr _. unfold with_column, u, w.
      destruct (Nat.eqb_spec c (S (S j))) as [->|_]; [symmetry; apply E, Lr|].
      destruct (Nat.eqb_spec c 1) as [->|_]; reflexivity.
    - transitivity (B v v); [|apply equal].
      rewrite left_side, !right_side, !first, equal. ring.
  Qed.

  (** Where two columns are equal it is zero. *)
  Theorem two_columns_equal : forall k M i j, (i < k)%nat -> (j < k)%nat -> i <> j ->
    (forall r, (r < k)%nat -> M r i == M r j) -> determinant k M == zero.
  Proof.
    intros k M i j Li Lj N E. destruct (Nat.lt_ge_cases i j) as [L|L].
    - apply (ordered_columns_equal k M i j); assumption.
    - apply (ordered_columns_equal k M j i); [lia|assumption|].
      intros r Lr. symmetry. apply E, Lr.
  Qed.

  (** Of a combination of all columns, put for the column j, only that column's own share counts. *)
  Theorem determinant_of_columns : forall k M j x, (j < k)%nat ->
    determinant k (with_column M j (fun r => total k (fun b => x b * M r b)))
    == x j * determinant k M.
  Proof.
    intros k M j x L. rewrite (determinant_of_combination k M j k x (fun b r => M r b)) by exact L.
    rewrite (total_one K k j) by (try exact L; intros b Lb N;
      rewrite (two_columns_equal k _ b j) by (try assumption; intros r _; unfold with_column;
        rewrite Nat.eqb_refl, (proj2 (Nat.eqb_neq b j)) by exact N; reflexivity); ring).
    apply mul_extends; [reflexivity|]. apply determinant_same. intros r c _ _. unfold with_column.
    destruct (Nat.eqb_spec c j) as [->|_]; reflexivity.
  Qed.

  (** The identity with a column replaced. *)
  Lemma determinant_of_one_column : forall k M j v, (j < k)%nat ->
    (forall r c, (r < k)%nat -> (c < k)%nat -> M r c == identity r c) ->
    determinant k (with_column M j v) == v j.
  Proof.
    intros k M j v L E. transitivity (v j * determinant k M);
      [|rewrite (determinant_of_identity k M E); ring].
    rewrite <- determinant_of_columns by exact L.
    apply determinant_same. intros r c Lr Lc. unfold with_column.
    destruct (c =? j); [|reflexivity]. rewrite (total_one K k r) by
      (try exact Lr; intros b Lb N; rewrite E by assumption; unfold identity;
       rewrite (proj2 (Nat.eqb_neq r b)) by lia; ring).
    rewrite E by assumption. unfold identity. rewrite Nat.eqb_refl. ring.
  Qed.

  Lemma derivation_of_total : forall delta, derivation K delta ->
    forall m f, delta (total m f) == total m (fun k => delta (f k)).
  Proof.
    intros delta [extends adds multiplies] m f. induction m as [|m IH]; simpl.
    - apply (cancel K _ _ (delta zero)). rewrite <- adds.
      transitivity (delta zero); [apply extends|]; ring.
    - rewrite adds, IH. reflexivity.
  Qed.

  Lemma derivation_of_one : forall delta, derivation K delta -> delta one == zero.
  Proof.
    intros delta [extends adds multiplies]. apply (cancel K _ _ (delta one)).
    transitivity (delta one * one + one * delta one); [ring|].
    rewrite <- multiplies. transitivity (delta one); [apply extends|]; ring.
  Qed.

  Lemma derivation_of_sign : forall delta, derivation K delta ->
    forall i x, delta (sign i * x) == sign i * delta x.
  Proof.
    intros delta is_one.
    assert (minus : delta (- one) == zero).
    { apply (cancel K _ _ (delta one)). rewrite <- (it_adds K delta is_one).
      transitivity (delta zero); [apply (it_extends K delta is_one); ring|].
      rewrite (derivation_of_total delta is_one 0 (fun _ => zero)), derivation_of_one by
        exact is_one. simpl. ring. }
    intros i x. rewrite (it_multiplies K delta is_one).
    assert (still : delta (sign i) == zero).
    { induction i as [|i IH]; [apply derivation_of_one, is_one|]. simpl.
      rewrite (it_multiplies K delta is_one), minus, IH. ring. }
    rewrite still. ring.
  Qed.

  (** A derivation acts on one column after the other. *)
  Theorem derivation_of_determinant : forall delta, derivation K delta -> forall k M,
    delta (determinant k M)
    == total k (fun j => determinant k (with_column M j (fun r => delta (M r j)))).
  Proof.
    intros delta is_one. induction k as [|k IH]; intro M.
    - apply derivation_of_one, is_one.
    - rewrite total_first. cbn [determinant]. rewrite total_swap, <- total_add.
      rewrite derivation_of_total by exact is_one. apply total_same. intros i _.
      rewrite derivation_of_sign by exact is_one.
      rewrite (it_multiplies K delta is_one), IH.
      transitivity (sign i * (delta (M i 0%nat)
        * determinant k (fun r c => M (past i r) (S c)))
        + sign i * M i 0%nat * total k (fun j => determinant k
          (with_column (fun r c => M (past i r) (S c)) j (fun r => delta (M (past i r) (S j))))));
        [ring|].
      apply add_extends; [reflexivity|].
      rewrite <- total_scaled. apply total_same. intros j _. unfold with_column. simpl. ring.
  Qed.
End Determinants.
