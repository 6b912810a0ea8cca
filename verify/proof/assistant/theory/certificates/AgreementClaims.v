(** A certificate for one H: the coefficients of its map are those of the flow's Taylor series. In
    the words of its file: c_0 is the coordinate, and (k + 1) c_(k+1) the derivative of c_k along
    the flow, so that c_k = X^k z / k!. *)

From Coq Require Import Reals QArith Qreals List Lra Lia.
From AreaPreservation Require Import Sums Differential Rings Formulas Identities RealFormulas RealNames OneHamiltonian RealDefect RealClaims MapClaims.
Import ListNotations.
Local Open Scope R_scope.

(** The function f has at z the derivative g along the flow, f_t + sum H_(p_i) f_(q_i) - H_(q_i)
    f_(p_i); [H1] holds the slopes of H by the 2n coordinates, and the time is the next one. *)
Definition derivative_along_flow (n : nat) (H1 : point -> list R) (f : point -> R) (z : point)
    (g : R) : Prop :=
  exists slope : nat -> R,
    (forall a, (a < 2 * n + 1)%nat ->
      derivable_pt_lim (fun s => f (moved z a s)) (z a) (slope a)) /\
    slope (2 * n)%nat + sum n (fun i => nth i (H1 z) 0 * slope (n + i)%nat
                                      - nth (n + i) (H1 z) 0 * slope i) = g.

Section AgreementClaims.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).
  Notation coefficients := (coefficients_at v x given).

  Lemma coefficient_is : forall z k c, nth k (coefficients z c) 0 = value_at z (term x k c).
  Proof.
    intros z k c. unfold coefficients_at, term.
    transitivity (nth k (map (fun f => value_at z f) (nth c (series x) [])) 0).
    - apply (f_equal (fun l => nth k l 0)).
      exact (map_nth (map (fun f => value_at z f)) (series x) [] c).
    - exact (map_nth (fun f => value_at z f) (nth c (series x) []) (Number 0) k).
  Qed.

  Theorem coefficients_start : forall z c, inside v given z -> (c < 2 * n)%nat ->
    nth 0 (coefficients z c) 0 = z c.
  Proof.
    intros z c I L. rewrite coefficient_is.
    exact (starts_at_identity v energy x factors checked given enough z c I L).
  Qed.

  (** The derivative of what a formula stands for. *)
  Lemma formula_along_flow : forall H1,
    (forall y a, (a < 2 * n)%nat -> nth a (H1 y) 0 = value_at y (slope_of_energy x a)) ->
    forall z, inside v given z -> forall f F, (forall y, F y = value_at y f) ->
    derivative_along_flow n H1 F z (value_at z (flow_formula x f)).
  Proof.
    intros H1 H1_is z I f F F_is. exists (fun a => value_at z (slope x a f)). split.
    - intros a La. apply (derivable_pt_lim_ext (fun s => value_at (moved z a s) f)).
      + intro s. symmetry. apply F_is.
      + exact (value_of_slope_is v (sound_names _ _ _ _ checked) given enough x
          (sound_size _ _ _ _ checked) (sound_slopes _ _ _ _ checked) z I f a La).
    - unfold flow_formula. cbn [value_of]. rewrite (value_of_sum_up_to real_numbers), total_is_sum.
      apply (f_equal (Rplus _)), sum_of_equals. intros i L. rewrite !H1_is by lia. reflexivity.
  Qed.

  Theorem coefficients_along_flow : forall H1,
    (forall y a, (a < 2 * n)%nat -> nth a (H1 y) 0 = value_at y (slope_of_energy x a)) ->
    forall z, inside v given z -> forall k c, (k < agreement x)%nat -> (c < 2 * n)%nat ->
    derivative_along_flow n H1 (fun y => nth k (coefficients y c) 0) z
      (INR (k + 1) * nth (k + 1) (coefficients z c) 0).
  Proof.
    intros H1 H1_is z I k c Lk Lc. rewrite coefficient_is, Nat.add_1_r.
    replace (INR (S k) * value_at z (term x (S k) c))
      with (value_at z (flow_formula x (term x k c))).
    - apply formula_along_flow; [exact H1_is|exact I|]. intro y. apply coefficient_is.
    - symmetry. rewrite <- (gap_is_closed v given z
        (Times (Number (Z.of_nat (S k) # 1)) (term x (S k) c)) (flow_formula x (term x k c))).
      + cbn [value_of]. change (@mul real_numbers) with Rmult. f_equal.
        rewrite INR_IZR_INZ. reflexivity.
      + apply (gaps_vanish v energy x factors checked given enough z I).
        apply in_app_iff. left. unfold flow_gaps. apply in_flat_map. exists c. rewrite in_seq.
        split; [lia|right]. apply in_map_iff. exists k. rewrite in_seq. split; [reflexivity|lia].
  Qed.

  (** In the plane. *)
  Theorem coefficients_along_plane_flow : n = 1%nat -> forall z, inside v given z ->
    forall k c, (k < agreement x)%nat -> (c < 2)%nat -> exists c_p c_q c_t,
    derivable_pt_lim (fun s => nth k (coefficients (moved z 0 s) c) 0) (z 0%nat) c_p /\
    derivable_pt_lim (fun s => nth k (coefficients (moved z 1 s) c) 0) (z 1%nat) c_q /\
    derivable_pt_lim (fun s => nth k (coefficients (moved z 2 s) c) 0) (z 2%nat) c_t /\
    c_t + (value_at z (slope_of_energy x 0) * c_q - value_at z (slope_of_energy x 1) * c_p)
    = INR (k + 1) * nth (k + 1) (coefficients z c) 0.
  Proof.
    intros N z I k c Lk Lc.
    destruct (coefficients_along_flow (fun y => map (fun a => value_at y (slope_of_energy x a)) [0; 1]%nat))
      with (z := z) (k := k) (c := c) as [g [D E]]; try assumption; try lia.
    { rewrite N. intros y [|[|a]] La; reflexivity || lia. }
    rewrite N in D, E.
    exists (g 0%nat), (g 1%nat), (g 2%nat).
    split; [apply D; lia|split; [apply D; lia|split; [apply D; lia|]]].
    rewrite <- E. simpl. ring.
  Qed.
End AgreementClaims.

(** Of what does not depend on time, the slope by it is 0. *)
Lemma without_time : forall f t slope rest whole,
  derivable_pt_lim (fun _ => f) t slope -> slope + rest = whole -> rest = whole.
Proof.
  intros f t slope rest whole D E.
  rewrite <- E, (uniqueness_limite _ _ _ _ D (derivable_pt_lim_const f t)). ring.
Qed.

(** Where names are defined depends on the coordinates alone; two points whose coordinates are the
    same need not be told to be so by writing out all functions. *)
Lemma inside_at_same : forall v given y z, (forall c, (c < dimension v)%nat -> y c = z c) ->
  inside v given z -> inside v given y.
Proof.
  intros v given y z E I m M K.
  replace (names_at v given y) with (names_at v given z); [exact (I m M K)|].
  unfold names_at. f_equal. f_equal. apply map_ext_in. intros c C. apply in_seq in C.
  symmetry. apply E. lia.
Qed.

(** What is divided by. *)
Definition denominators (l : list (kind * formula)) : list formula :=
  flat_map (fun m => match fst m with Inverse => [snd m] | _ => [] end) l.

(** None of these is 0, as one writes that. *)
Fixpoint none_is_zero (names : list R) (l : list formula) : Prop :=
  match l with
  | [] => True
  | [f] => @value_of real_numbers names f <> 0
  | f :: others => @value_of real_numbers names f <> 0 /\ none_is_zero names others
  end.

Lemma inside_where_none_is_zero : forall v given z,
  none_is_zero (names_at v given z) (denominators (made v)) -> inside v given z.
Proof.
  intros v given z D m M K.
  assert (I : In (snd m) (denominators (made v))).
  { apply in_flat_map. exists m. rewrite K. split; [exact M|left; reflexivity]. }
  revert D I. generalize (denominators (made v)) as l. induction l as [|f l IH]; [intros _ []|].
  intros D [E|I].
  - rewrite <- E. destruct l; [exact D|exact (proj1 D)].
  - destruct l; [destruct I|exact (IH (proj2 D) I)].
Qed.

Lemma none_is_zero_inside : forall v given z, inside v given z ->
  none_is_zero (names_at v given z) (denominators (made v)).
Proof.
  intros v given z I.
  assert (D : forall f, In f (denominators (made v)) ->
    @value_of real_numbers (names_at v given z) f <> 0).
  { intros f F. apply in_flat_map in F. destruct F as [[k g] [M F]].
    destruct k; simpl in F; try contradiction. destruct F as [<-|[]]. exact (I _ M eq_refl). }
  revert D. generalize (denominators (made v)) as l.
  induction l as [|f l IH]; intro D; [exact Logic.I|].
  destruct l as [|g l]; [apply D; left; reflexivity|].
  split; [apply D; left; reflexivity|apply IH; intros h F; apply D; right; exact F].
Qed.
