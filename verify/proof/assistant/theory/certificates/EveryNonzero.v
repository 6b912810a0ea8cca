(** A formula in the derivatives of H that is not 0 for every H of a family: an H that is a
    polynomial shows it, at a point with rational coordinates. *)

From Coq Require Import Reals Qreals List Lia.
From AreaPreservation Require Import Differential Rings Flow Formulas Simplified Smooth Systems RealFormulas RealNames EveryHamiltonian RationalValues.
Import ListNotations.
Local Open Scope nat_scope.

(** The names 1 .. 2n+1 are the coordinates, and there are no others. *)
Definition coordinates_alone (n : nat) : vocabulary :=
  {| dimension := 2 * n + 1; parameters := 0; made := [] |}.

Definition polynomial_slope_of (n a : nat) (f : formula) : formula :=
  simplified (derivative (looked_up (slope_table (coordinates_alone n) a)) f).

(** The derivative along a list of coordinates, the last being taken first as [derived] does. *)
Definition derived_polynomial (n : nat) (l : list nat) (f : formula) : formula :=
  fold_right (polynomial_slope_of n) f l.

(** What the names of the family stand for at a point, if H is the polynomial E. *)
Definition values_of_names (e : family_of_energies) (E : formula) (point : list Q) : list Q :=
  point ++ map (fun l => @value_of rational_numbers point (derived_polynomial (energy_degrees e) l E))
             (named_derivatives e).

(** Whether E belongs to the family. *)
Definition polynomial_belongs (e : family_of_energies) (E : formula) : bool :=
  let n := energy_degrees e in
  (timed e || vanishes (derived_polynomial n [2 * n] E))
  && (negb (separable e)
      || forallb (fun ij => vanishes (derived_polynomial n [fst ij; n + snd ij] E))
           (list_prod (seq 0 n) (seq 0 n))).

(** Whether the formula L is not 0 at the point, if H is E. *)
Definition shown_by_energy (e : family_of_energies) (E : formula) (point : list Q) (L : formula) : bool :=
  let n := energy_degrees e in
  (length point =? 2 * n + 1)
  && forallb (forallb (fun a => a <? 2 * n + 1)) (named_derivatives e) && polynomial_belongs e E
  && negb (Qeq_bool (@value_of rational_numbers (values_of_names e E point) L) 0).

(** The value at a point of a formula in functions is that formula in their values. *)
Lemma value_at_point : forall N U (HU : is_open N U) (names : list (smooth_ring N U HU)) f x,
  value (@value_of (smooth_ring N U HU) names f) x
  = @value_of real_numbers (map (fun g => value g x) names) f.
Proof.
  intros N U HU names f x.
  induction f as [a|k|f1 E1 f2 E2|f1 E1 f2 E2|f1 E1 f2 E2|f E|f E k]; cbn [value_of].
  - symmetry. apply real_of_is.
  - rewrite (positive_is k), named_is_nth, (nth_at_position (smooth_ring N U HU)).
    symmetry. apply (map_nth (fun g : smooth N U => value g x) names (@zero (smooth_ring N U HU))).
  - rewrite <- E1, <- E2. reflexivity.
  - rewrite <- E1, <- E2. reflexivity.
  - rewrite <- E1, <- E2. reflexivity.
  - rewrite <- E. reflexivity.
  - rewrite <- E. induction k as [|k IH]; [reflexivity|]. cbn [power]. rewrite <- IH. reflexivity.
Qed.

Section PolynomialEnergy.
  Context (n : nat) (E : formula).
  Notation N := (2 * n + 1).
  Notation alone := (coordinates_alone n).
  Notation K := (smooth_ring N everywhere (everywhere_is_open N)).
  Notation value_at x f := (@value_of real_numbers (map x (seq 0 N)) f).

  Lemma names_are_coordinates : forall x, names_at alone [] x = map x (seq 0 N).
  Proof. intro x. unfold names_at. cbn [made coordinates_alone fold_left]. apply app_nil_r. Qed.

  Lemma polynomial_is_family :
    is_family N everywhere (fun l x => value_at x (derived_polynomial n (rev l) E)).
  Proof.
    intros l x _. cbv beta. rewrite <- names_are_coordinates.
    apply (slopes_of_equal N (fun y => @value_of real_numbers (names_at alone [] y)
      (derived_polynomial n (rev l) E))); [intro y; rewrite names_are_coordinates; reflexivity|].
    apply (slopes_of_equal_slopes N _ _ _ _ (formulas_have_slopes alone eq_refl [] eq_refl x
      (fun m I _ => match I with end) (derived_polynomial n (rev l) E))).
    intros i _. rewrite rev_unit. symmetry. apply (simplified_same real_numbers).
  Qed.

  (** The polynomial as a function with all its derivatives. *)
  Definition polynomial_energy : smooth N everywhere :=
    {| family := fun l x => value_at x (derived_polynomial n (rev l) E);
       family_slopes := polynomial_is_family |}.

  Lemma family_of_derived : forall l r x, (forall a, In a l -> a < N) ->
    family (@derived K l polynomial_energy) r x = value_at x (derived_polynomial n (rev r ++ l) E).
  Proof.
    induction l as [|a l IH]; intros r x L; [simpl; rewrite app_nil_r; reflexivity|].
    change (family (@derived K (a :: l) polynomial_energy) r x) with
      (derivative_family N a (family (@derived K l polynomial_energy)) r x).
    unfold derivative_family. rewrite (proj2 (Nat.ltb_lt a N)) by (apply L; left; reflexivity).
    rewrite IH by (intros b B; apply L; right; exact B).
    simpl. rewrite <- app_assoc. reflexivity.
  Qed.

  Lemma value_of_derived : forall l x, (forall a, In a l -> a < N) ->
    value (@derived K l polynomial_energy) x = value_at x (derived_polynomial n l E).
  Proof. intros l x L. exact (family_of_derived l [] x L). Qed.

  Lemma derived_vanishes : forall l, (forall a, In a l -> a < N) ->
    vanishes (derived_polynomial n l E) = true ->
    @same K (@derived K l polynomial_energy) (@zero K).
  Proof.
    intros l L V x _. rewrite (value_of_derived l x L).
    exact (vanishes_everywhere real_numbers (map x (seq 0 N)) _ V).
  Qed.
End PolynomialEnergy.

Section Shown.
  Context (e : family_of_energies) (E : formula).
  Notation n := (energy_degrees e).
  Notation K := (smooth_ring (2 * n + 1) everywhere (everywhere_is_open (2 * n + 1))).
  Notation sys := (smooth_system n everywhere (everywhere_is_open (2 * n + 1)) (polynomial_energy n E)).

  Lemma polynomial_is_member : polynomial_belongs e E = true -> @belongs K sys e.
  Proof.
    intro B. unfold polynomial_belongs in B. apply andb_prop in B. destruct B as [T S]. constructor.
    - reflexivity.
    - intro F. rewrite F in T. apply (derived_vanishes n E [2 * n]); [|exact T].
      intros a [<-|[]]. lia.
    - intros F i j Li Lj. rewrite F in S. cbn [negb orb] in S. rewrite forallb_forall in S.
      change (degrees sys) with n in *. apply (derived_vanishes n E [i; n + j]).
      + intros a [<-|[<-|[]]]; lia.
      + apply (S (i, j)). apply in_prod; apply in_seq; lia.
  Qed.

  Lemma values_of_names_are : forall point, length point = 2 * n + 1 ->
    (forall l, In l (named_derivatives e) -> forall a, In a l -> a < 2 * n + 1) ->
    map (fun g => value g (rational_point point)) (names_for_every K sys e)
    = map real_of (values_of_names e E point).
  Proof.
    intros p Lp D. unfold names_for_every, values_of_names. rewrite !map_app, !map_map. f_equal.
    - rewrite <- coordinates_of_point, Lp. apply map_ext_in. intros c C. apply in_seq in C.
      apply value_coordinate. lia.
    - apply map_ext_in. intros l I. rewrite (value_of_derived n E l) by exact (D l I).
      rewrite <- Lp, coordinates_of_point. apply value_is_rational.
  Qed.

  (** Some H of the family, and a point, where L is not 0. *)
  Theorem some_energy_shows_it : forall point L, shown_by_energy e E point L = true ->
    exists H : smooth (2 * n + 1) everywhere,
      let s := smooth_system n everywhere (everywhere_is_open (2 * n + 1)) H in
      @belongs K s e /\ exists x, everywhere x /\ value (@value_of K (names_for_every K s e) L) x <> 0%R.
  Proof.
    intros p L S. unfold shown_by_energy in S. rewrite !andb_true_iff in S.
    destruct S as [[[Lp D] B] Z]. apply Nat.eqb_eq in Lp. apply negb_true_iff in Z.
    exists (polynomial_energy n E). split; [apply polynomial_is_member, B|].
    exists (rational_point p). split; [exact I|].
    rewrite value_at_point, values_of_names_are, value_is_rational; [|exact Lp|].
    - intro Y. apply (same_real_of _ 0), Qeq_bool_iff in Y. congruence.
    - intros l M a A. rewrite forallb_forall in D. specialize (D l M).
      rewrite forallb_forall in D. apply Nat.ltb_lt, D, A.
  Qed.
End Shown.
