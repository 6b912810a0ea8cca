(** A formula whose function is not 0 everywhere, as it or one of its derivatives is not 0 at a point
    where all names stand for rational numbers. *)

From Coq Require Import Reals Qreals List Lra.
From AreaPreservation Require Import Differential Slopes Rings Formulas RealFormulas RealNames OneHamiltonian RationalValues.
Import ListNotations.
Local Open Scope nat_scope.

(** Whether a function has this value by what is known of it: sin 0 = 0, cos 0 = 1, exp 0 = 1. *)
Definition has_known_value (k : kind) (argument u : Q) : bool :=
  match k with
  | Sine _ => Qeq_bool argument 0 && Qeq_bool u 0
  | Cosine _ | Exponential => Qeq_bool argument 0 && Qeq_bool u 1
  | Inverse => Qeq_bool (u * argument) 1
  end.

(** Whether each function has the next of the values, by those before it. *)
Fixpoint functions_have_values (l : list (kind * formula)) (known next : list Q) : bool :=
  match l, next with
  | [], [] => true
  | m :: others, u :: r =>
      has_known_value (fst m) (@value_of rational_numbers known (snd m)) u
      && functions_have_values others (known ++ [u]) r
  | _, _ => false
  end.

(** Whether the names stand for these values at the point, and no denominator is 0 there. *)
Definition values_check (v : vocabulary) (point params vals : list Q) : bool :=
  let base := dimension v + parameters v in
  (length point =? dimension v) && (length params =? parameters v)
  && same_numbers (firstn base vals) (point ++ params)
  && functions_have_values (made v) (firstn base vals) (skipn base vals)
  && forallb (fun m => match fst m with
                       | Inverse => negb (Qeq_bool (@value_of rational_numbers vals (snd m)) 0)
                       | _ => true
                       end) (made v).

(** The derivative along a list of coordinates, for calculation: each table of slopes is made once. *)
Definition derived_by_tables (v : vocabulary) (l : list nat) (f : formula) : formula :=
  fold_left (fun g a => derivative (looked_up (slope_table v a)) g) l f.

Definition nonzero_check (v : vocabulary) (point params vals : list Q) (l : list nat) (f : formula) :=
  well_made v && values_check v point params vals && forallb (fun a => a <? dimension v) l
  && negb (Qeq_bool (@value_of rational_numbers vals (derived_by_tables v l f)) 0).

Lemma known_value_is : forall k argument u, has_known_value k argument u = true ->
  applied k (real_of argument) = real_of u.
Proof.
  intros k a u E. destruct k; simpl in E |- *;
    try (apply andb_prop in E; destruct E as [A B]; apply Qeq_bool_eq, real_of_same in A;
         apply Qeq_bool_eq, real_of_same in B; rewrite A, B).
  - apply sin_0.
  - apply cos_0.
  - apply exp_0.
  - apply Qeq_bool_eq, real_of_same in E.
    assert (P : (real_of u * real_of a)%R = 1%R).
    { transitivity (real_of (u * a)); [symmetry; apply (rational_mul real_numbers)|exact E]. }
    assert (N : real_of a <> 0%R) by (intro Z; rewrite Z in P; lra).
    rewrite <- (Rmult_1_l (/ real_of a)), <- P. field. exact N.
Qed.

Lemma functions_are : forall l known next, functions_have_values l known next = true ->
  fold_left extended l (map real_of known) = map real_of (known ++ next).
Proof.
  induction l as [|m l IH]; intros known [|u next] E; try discriminate.
  - rewrite app_nil_r. reflexivity.
  - simpl in E. apply andb_prop in E. destruct E as [A E]. simpl.
    replace (known ++ u :: next) with ((known ++ [u]) ++ next) by (rewrite <- app_assoc; reflexivity).
    rewrite <- (IH _ _ E). f_equal. unfold extended.
    rewrite value_is_rational, (known_value_is _ _ _ A), map_app. reflexivity.
Qed.

Lemma parameters_enough : forall v point params vals, values_check v point params vals = true ->
  length (map real_of params) = parameters v.
Proof.
  intros v p params vals E. unfold values_check in E. rewrite !andb_true_iff in E.
  rewrite map_length. apply Nat.eqb_eq, E.
Qed.

(** The names stand for the values. *)
Theorem names_at_rational_point : forall v point params vals, values_check v point params vals = true ->
  names_at v (map real_of params) (rational_point point) = map real_of vals.
Proof.
  intros v p params vals E. unfold values_check in E. rewrite !andb_true_iff in E.
  destruct E as [[[[Lp Ln] S] F] _]. apply Nat.eqb_eq in Lp. unfold names_at.
  rewrite <- Lp, coordinates_of_point, <- map_app, <- (same_numbers_same _ _ S), (functions_are _ _ _ F).
  f_equal. apply firstn_skipn.
Qed.

Theorem value_at_rational_point : forall v point params vals f, values_check v point params vals = true ->
  @value_of real_numbers (names_at v (map real_of params) (rational_point point)) f
  = real_of (@value_of rational_numbers vals f).
Proof.
  intros v p params vals f E. rewrite (names_at_rational_point v p params vals E).
  apply value_is_rational.
Qed.

Theorem rational_point_inside : forall v point params vals, values_check v point params vals = true ->
  inside v (map real_of params) (rational_point point).
Proof.
  intros v p params vals E m I M. rewrite (value_at_rational_point v p params vals _ E).
  unfold values_check in E. apply andb_prop in E. destruct E as [_ D].
  rewrite forallb_forall in D. specialize (D m I). rewrite M in D. apply negb_true_iff in D.
  intro Z. apply (same_real_of _ 0), Qeq_bool_iff in Z. congruence.
Qed.

(** Of a formula that is 0 all over, so are the derivatives. *)
Lemma derivatives_of_zero : forall v given, well_made v = true -> length given = parameters v ->
  forall l f, (forall a, In a l -> a < dimension v) ->
  (forall y, inside v given y -> @value_of real_numbers (names_at v given y) f = 0%R) ->
  forall y, inside v given y -> @value_of real_numbers (names_at v given y) (derived_formula v l f) = 0%R.
Proof.
  intros v given W enough. induction l as [|a l IH]; intros f L Z; [exact Z|].
  apply (IH (derivative (slope_of_real v a) f)); [intros b B; apply L; right; exact B|].
  intros y I. set (N := dimension v).
  apply (slopes_unique N (fun z => @value_of real_numbers (names_at v given z) f) y
    (fun a => @value_of real_numbers (names_at v given y) (derivative (slope_of_real v a) f)) (fun _ => 0%R)).
  - apply formulas_have_slopes; assumption.
  - apply (slopes_of_equal_on_open N (inside v given) (fun _ => 0%R)).
    + apply defined_is_open; assumption.
    + exact I.
    + exact Z.
    + apply slopes_of_constant.
  - apply L. left. reflexivity.
Qed.

(** What the check says of the point itself. *)
Theorem not_zero_at_point : forall v point params vals l f,
  nonzero_check v point params vals l f = true ->
  @value_of real_numbers (names_at v (map real_of params) (rational_point point)) (derived_formula v l f)
  <> 0%R.
Proof.
  intros v p params vals l f E. unfold nonzero_check in E. rewrite !andb_true_iff in E.
  destruct E as [[[W E] L] N]. apply negb_true_iff in N. intro Z.
  rewrite (value_at_rational_point v p params vals _ E) in Z.
  apply (same_real_of _ 0), Qeq_bool_iff in Z.
  change (derived_formula v l f) with (derived_by_tables v l f) in Z. congruence.
Qed.

(** The function is not 0 on the whole set where it is defined, for these values of parameters. *)
Theorem not_zero_function : forall v point params vals l f,
  nonzero_check v point params vals l f = true ->
  ~ (forall y, inside v (map real_of params) y ->
       @value_of real_numbers (names_at v (map real_of params) y) f = 0%R).
Proof.
  intros v p params vals l f E Z. apply (not_zero_at_point v p params vals l f E).
  unfold nonzero_check in E. rewrite !andb_true_iff in E. destruct E as [[[W E] L] _].
  apply derivatives_of_zero; try assumption.
  - apply (parameters_enough v p params vals E).
  - intros a A. rewrite forallb_forall in L. apply Nat.ltb_lt, L, A.
  - apply (rational_point_inside v p params vals E).
Qed.
