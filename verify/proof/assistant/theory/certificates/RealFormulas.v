(** Formulas over the real numbers: in coordinates, parameters, and sin, cos, exp and inverses of
    formulas. Their derivatives are those of the standard library's functions. *)

From Coq Require Import Reals Rtrigo_reg QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Rings Formulas.
Import ListNotations.
Local Open Scope nat_scope.

(** A rational number as a real one, written without a denominator 1. *)
Definition real_of (a : Q) : R :=
  match Qden a with
  | xH => IZR (Qnum a)
  | d => (IZR (Qnum a) / IZR (Zpos d))%R
  end.

Lemma real_of_is : forall a, real_of a = Q2R a.
Proof. intros [p [d|d|]]; unfold real_of, Q2R; simpl; [reflexivity|reflexivity|lra]. Qed.

(** The real numbers as a ring that holds the rational ones. *)
Definition real_numbers : rational_ring.
Proof.
  refine {| carrier := R; same := eq; zero := 0%R; one := 1%R; add := Rplus; mul := Rmult;
    sub := Rminus; opp := Ropp; rational := real_of |}.
  - constructor; congruence.
  - exact RTheory.
  - intros a b E. rewrite !real_of_is. exact (Qeq_eqR a b E).
  - reflexivity.
  - intros a b. rewrite !real_of_is. apply Q2R_plus.
  - intros a b. rewrite !real_of_is. apply Q2R_mult.
Defined.

(** Functions that a name may stand for; sin names the cos of the same argument, and cos the sin. *)
Inductive kind := Sine (cosine : positive) | Cosine (sine : positive) | Exponential | Inverse.

Definition applied (k : kind) : R -> R :=
  match k with
  | Sine _ => sin
  | Cosine _ => cos
  | Exponential => exp
  | Inverse => Rinv
  end.

(** After the 2n+1 coordinates and the parameters come functions of what stands before them. *)
Record vocabulary := {
  dimension : nat;
  parameters : nat;
  made : list (kind * formula);
}.

Section Vocabulary.
  Context (v : vocabulary).
  Notation base := (dimension v + parameters v).

  Definition extended (known : list R) (m : kind * formula) : list R :=
    known ++ [applied (fst m) (@value_of real_numbers known (snd m))].

  (** What the names stand for at a point, for values of the parameters. *)
  Definition names_at (given : list R) (x : point) : list R :=
    fold_left extended (made v) (map x (seq 0 (dimension v)) ++ given).

  (** The slope of a function, which is the name of number i, by what its argument's slope is. *)
  Definition outer_slope (i : nat) (k : kind) (inner : formula) : formula :=
    match k with
    | Sine c => Times (Name c) inner
    | Cosine s => Negative (Times (Name s) inner)
    | Exponential => Times (Name (Pos.of_succ_nat i)) inner
    | Inverse => Negative (Times (Power (Name (Pos.of_succ_nat i)) 2) inner)
    end.

  Definition looked_up (table : list formula) (k : positive) : formula :=
    nth (pred (Pos.to_nat k)) table (Number 0).

  Definition with_slope (table : list formula) (m : kind * formula) : list formula :=
    table ++ [outer_slope (length table) (fst m) (derivative (looked_up table) (snd m))].

  (** The slopes of all names by the coordinate a. *)
  Definition slope_table (a : nat) : list formula :=
    fold_left with_slope (made v)
      (map (fun c => Number (if c =? a then 1 else 0)) (seq 0 (dimension v))
       ++ map (fun _ => Number 0) (seq 0 (parameters v))).

  Fixpoint equal_formulas (f g : formula) : bool :=
    match f, g with
    | Number a, Number b => (Z.eqb (Qnum a) (Qnum b) && Pos.eqb (Qden a) (Qden b))%bool
    | Name i, Name j => Pos.eqb i j
    | Plus x y, Plus z w | Minus x y, Minus z w | Times x y, Times z w =>
        equal_formulas x z && equal_formulas y w
    | Negative x, Negative y => equal_formulas x y
    | Power x k, Power y l => equal_formulas x y && (k =? l)
    | _, _ => false
    end.

  Definition is_at (k : positive) (right : kind -> bool) (argument : formula) : bool :=
    let j := pred (Pos.to_nat k) in
    (base <=? j) && match nth_error (made v) (j - base) with
                    | Some m => right (fst m) && equal_formulas (snd m) argument
                    | None => false
                    end.

  (** The functions stand in order, and sin and cos of the same argument name each other. *)
  Definition well_made : bool :=
    forallb (fun jm => let m := snd jm in
      uses (fun k => pred (Pos.to_nat k) <? base + fst jm) (snd m)
      && match fst m with
         | Sine c => is_at c (fun k => match k with Cosine _ => true | _ => false end) (snd m)
         | Cosine s => is_at s (fun k => match k with Sine _ => true | _ => false end) (snd m)
         | _ => true
         end) (combine (seq 0 (length (made v))) (made v)).

  (** Where no denominator is 0. *)
  Definition defined_at (given : list R) (x : point) : Prop :=
    forall m, In m (made v) -> fst m = Inverse ->
      @value_of real_numbers (names_at given x) (snd m) <> 0%R.

  (** What holds of every such list of names: sin^2 + cos^2 = 1, u * (1/u) = 1. *)
  Definition relation_of (i : nat) (m : kind * formula) : formula :=
    let own := Name (Pos.of_succ_nat i) in
    match fst m with
    | Sine c => Minus (Plus (Times own own) (Times (Name c) (Name c))) (Number 1)
    | Cosine s => Minus (Plus (Times own own) (Times (Name s) (Name s))) (Number 1)
    | Exponential => Number 0
    | Inverse => Minus (Times own (snd m)) (Number 1)
    end.

  Definition relations_of : list formula :=
    map (fun jm => relation_of (base + fst jm) (snd jm)) (combine (seq 0 (length (made v))) (made v)).
End Vocabulary.

Lemma named_is_nth : forall (l : list R) j,
  @named real_numbers l (Pos.of_succ_nat j) = nth j l 0%R.
Proof. exact (nth_at_position real_numbers). Qed.

Lemma positive_is : forall k, k = Pos.of_succ_nat (pred (Pos.to_nat k)).
Proof.
  intro k. apply Pos2Nat.inj. rewrite SuccNat2Pos.id_succ.
  assert (0 < Pos.to_nat k)%nat by apply Pos2Nat.is_pos. lia.
Qed.

Lemma named_is : forall (l : list R) k,
  @named real_numbers l k = nth (pred (Pos.to_nat k)) l 0%R.
Proof. intros l k. rewrite (positive_is k) at 1. apply named_is_nth. Qed.

Lemma equal_formulas_equal : forall f g, equal_formulas f g = true -> f = g.
Proof.
  induction f; intros [] E; try discriminate; simpl in E;
    try (apply andb_prop in E; destruct E as [E1 E2]).
  - destruct a as [p q], a0 as [r t]. simpl in *. apply Z.eqb_eq in E1. apply Pos.eqb_eq in E2.
    congruence.
  - apply Pos.eqb_eq in E. congruence.
  - rewrite (IHf1 _ E1), (IHf2 _ E2). reflexivity.
  - rewrite (IHf1 _ E1), (IHf2 _ E2). reflexivity.
  - rewrite (IHf1 _ E1), (IHf2 _ E2). reflexivity.
  - rewrite (IHf _ E). reflexivity.
  - rewrite (IHf _ E1). apply Nat.eqb_eq in E2. congruence.
Qed.

(** The value depends on the names that are used alone. *)
Lemma value_of_same_names : forall names others known f, uses known f = true ->
  (forall k, known k = true -> @named real_numbers names k = named others k) ->
  @value_of real_numbers names f = value_of others f.
Proof.
  intros names others known f. induction f; simpl; intros U E;
    try (apply andb_prop in U; destruct U as [U1 U2]); try reflexivity.
  - apply E, U.
  - rewrite (IHf1 U1 E), (IHf2 U2 E). reflexivity.
  - rewrite (IHf1 U1 E), (IHf2 U2 E). reflexivity.
  - rewrite (IHf1 U1 E), (IHf2 U2 E). reflexivity.
  - rewrite (IHf U E). reflexivity.
  - rewrite (IHf U E). reflexivity.
Qed.

Lemma power_is_pow : forall (r : R) k, power real_numbers r k = (r ^ k)%R.
Proof. intros r k. induction k as [|k IH]; simpl; [reflexivity|]. rewrite IH. reflexivity. Qed.

(** [derivative] holds the slopes of a formula, where the names have the slopes that are told. *)
Theorem slopes_of_formula : forall N names slope known x,
  (forall k, known k = true -> has_slopes N (fun y => @named real_numbers (names y) k) x
    (fun a => @value_of real_numbers (names x) (slope a k))) ->
  forall f, uses known f = true -> has_slopes N (fun y => @value_of real_numbers (names y) f) x
    (fun a => @value_of real_numbers (names x) (derivative (slope a) f)).
Proof.
  intros N names slope known x E f.
  induction f as [c|k|f1 E1 f2 E2|f1 E1 f2 E2|f1 E1 f2 E2|f IH|f IH k]; simpl; intro U;
    try (apply andb_prop in U; destruct U as [U1 U2]; specialize (E1 U1); specialize (E2 U2)).
  - apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_constant N (real_of c) x)).
    intros i _. reflexivity.
  - apply E, U.
  - exact (slopes_of_sum N _ _ x _ _ E1 E2).
  - exact (slopes_of_difference N _ _ x _ _ E1 E2).
  - exact (slopes_of_product N _ _ x _ _ E1 E2).
  - exact (slopes_of_opposite N _ x _ (IH U)).
  - apply (slopes_of_equal N (fun y => (@value_of real_numbers (names y) f) ^ k)%R).
    + intro y. apply power_is_pow.
    + apply (slopes_of_equal_slopes N _ _ _ _ (slopes_of_power N _ x _ k (IH U))).
      intros i _. destruct k as [|k]; simpl.
      * change (real_of 0) with 0%R. lra.
      * rewrite power_is_pow. f_equal. f_equal. rewrite real_of_is. unfold Q2R. cbn [Qnum Qden].
        rewrite Zpos_P_of_succ_nat, <- Nat2Z.inj_succ, <- INR_IZR_INZ.
        change (match k with O => 1%R | S _ => (INR k + 1)%R end) with (INR (S k)). lra.
Qed.
