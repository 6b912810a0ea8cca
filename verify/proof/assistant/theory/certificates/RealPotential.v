(** The leading part of a defect as a derivative along the flow, in slopes alone: in the plane that of
    a function G, and in general that of a 2-form. *)

From Coq Require Import Reals QArith List Lia.
From AreaPreservation Require Import Sums Differential Rings Flow Formulas Smooth Identities Certified RealFormulas OneHamiltonian RealDefect RealClaims AgreementClaims.
Import ListNotations.
Local Open Scope R_scope.

(** The 2-form with the entries w above the diagonal. *)
Notation antisymmetric := (two_form 0 Ropp).

(** The 2-form w has at z the Lie derivative L along the flow of H, whose slopes by the 2n
    coordinates [H1] holds: with f' for the derivative of f along the flow and f_a for that by the
    coordinate a, L_ab = w_ab' + sum over i of H_(p_i)a w_(q_i)b - H_(q_i)a w_(p_i)b
    + H_(p_i)b w_a(q_i) - H_(q_i)b w_a(p_i). *)
Definition lie_derivative_along_flow (n : nat) (H1 : point -> list R)
    (w : point -> nat -> nat -> R) (z : point) (L : nat -> nat -> R) : Prop :=
  exists H2 w' : nat -> nat -> R,
    (forall a c, (a < 2 * n)%nat -> (c < 2 * n)%nat ->
      derivable_pt_lim (fun s => nth a (H1 (moved z c s)) 0) (z c) (H2 a c)) /\
    (forall a b, derivative_along_flow n H1 (fun y => antisymmetric (w y) a b) z (w' a b)) /\
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
      w' a b + sum n (fun i =>
        (H2 i a * antisymmetric (w z) (n + i) b - H2 (n + i)%nat a * antisymmetric (w z) i b)
        + (H2 i b * antisymmetric (w z) a (n + i) - H2 (n + i)%nat b * antisymmetric (w z) a i)) = L a b.

Section RealPotential.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).
  Notation value_at z f := (@value_of real_numbers (names_at v given z) f).
  Notation size := (sound_size v energy x factors checked).
  Notation names_ok := (sound_names v energy x factors checked).
  Notation slopes_ok := (sound_slopes v energy x factors checked).
  Notation U := (inside v given).
  Notation U_open := (inside_is_open v names_ok given enough n size).
  Notation sys := (system_of_energy v names_ok given enough n size energy).
  Notation K := (smooth_ring (2 * n + 1) U U_open).
  Notation names := (elements v names_ok given enough n size).
  Notation its_meaning := (meaning v energy x factors checked given enough).

  Lemma leading_is : forall w, primitive x = Some w -> forall z a b, U z ->
    (a < b)%nat -> (b < 2 * n)%nat -> value_at z (lie_formula x w a b) = value_at z (leading_entry x a b).
  Proof.
    intros w W z a b I L Lb. apply gap_is_closed, (gaps_vanish v energy x factors checked given enough z I).
    apply in_app_iff. right. apply in_app_iff. right. unfold primitive_gaps. rewrite W.
    apply in_map_iff. exists (a, b). split; [reflexivity|]. apply pair_listed; assumption.
  Qed.

  (** In any number of degrees of freedom. *)
  Theorem leading_is_lie_derivative : forall w, primitive x = Some w ->
    forall (H1 : point -> list R) (G L : point -> nat -> nat -> R),
    (forall y a, (a < 2 * n)%nat -> nth a (H1 y) 0 = value_at y (slope_of_energy x a)) ->
    (forall y a b, value_at y (w a b) = G y a b) ->
    (forall y a b, value_at y (leading_entry x a b) = L y a b) ->
    forall z, U z -> lie_derivative_along_flow n H1 G z (L z).
  Proof.
    intros w W H1 G L H1_is G_is L_is z I.
    assert (form_is : forall y a b, antisymmetric (G y) a b = value_at y (form_formula w a b)).
    { intros y a b. unfold two_form. rewrite <- !G_is.
      destruct (a <? b)%nat; [reflexivity|]. destruct (b <? a)%nat; reflexivity. }
    exists (fun a c => value_at z (slope x c (slope_of_energy x a))),
      (fun a b => value_at z (flow_formula x (form_formula w a b))). split; [|split].
    - intros a c La Lc.
      apply (derivable_pt_lim_ext (fun s => value_at (moved z c s) (slope_of_energy x a))).
      + intro s. symmetry. apply H1_is, La.
      + apply (value_of_slope_is v names_ok given enough x size slopes_ok z I). lia.
    - intros a b. apply (formula_along_flow v energy x factors checked given enough H1 H1_is z I).
      intro y. apply form_is.
    - intros a b La Lb. rewrite <- L_is, <- (leading_is w W z a b I La Lb). unfold lie_formula.
      cbn [value_of]. rewrite (value_of_sum_up_to real_numbers), total_is_sum.
      apply (f_equal (Rplus _)), sum_of_equals. intros i _. rewrite !form_is. reflexivity.
  Qed.

  (** The mixed derivatives of H are equal, also as the certificate has them. *)
  Lemma mixed_slopes_equal : forall z a b, U z -> (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    value_at z (slope x a (slope_of_energy x b)) = value_at z (slope x b (slope_of_energy x a)).
  Proof.
    assert (E : forall z a b, U z -> (a < 2 * n)%nat -> (b < 2 * n)%nat ->
      value_at z (slope x a (slope_of_energy x b))
      = value (@by_coordinate K a (@by_coordinate K b (hamiltonian sys))) z).
    { intros z a b I La Lb. unfold slope. rewrite slopes_ok.
      rewrite <- (slope_of_element v names_ok given enough n size a (slope_of_energy x b)) by
        (lia || exact I).
      apply (derivation_extends K a); [|exact I].
      apply (names_energy K sys x names its_meaning). exact Lb. }
    intros z a b I La Lb. rewrite !E by assumption.
    exact (derivations_commute K a b (hamiltonian sys) z I).
  Qed.

  (** In the plane: G_t + (H_p G_q - H_q G_p) is the leading entry. *)
  Theorem leading_is_derivative_of_potential : n = 1%nat -> forall w, primitive x = Some w ->
    forall z, U z -> exists Gp Gq Gt,
    derivable_pt_lim (fun s => value_at (moved z 0 s) (w 0%nat 1%nat)) (z 0%nat) Gp /\
    derivable_pt_lim (fun s => value_at (moved z 1 s) (w 0%nat 1%nat)) (z 1%nat) Gq /\
    derivable_pt_lim (fun s => value_at (moved z 2 s) (w 0%nat 1%nat)) (z 2%nat) Gt /\
    Gt + (value_at z (slope_of_energy x 0) * Gq - value_at z (slope_of_energy x 1) * Gp)
    = value_at z (leading_entry x 0 1).
  Proof.
    intros N w W z I. set (G := w 0%nat 1%nat).
    assert (D := fun a => value_of_slope_is v names_ok given enough x size slopes_ok z I G a).
    rewrite N in D. exists (value_at z (slope x 0 G)), (value_at z (slope x 1 G)),
      (value_at z (slope x 2 G)).
    split; [apply D; lia|split; [apply D; lia|split; [apply D; lia|]]].
    rewrite <- (leading_is w W z 0 1 I ltac:(lia) ltac:(lia)).
    assert (M := mixed_slopes_equal z 0 1 I ltac:(lia) ltac:(lia)).
    unfold lie_formula, flow_formula. rewrite N.
    cbn [sum_up_to sum_of seq map fold_right Nat.mul Nat.add].
    change (form_formula w 1 1) with (Number 0). change (form_formula w 0 0) with (Number 0).
    change (form_formula w 0 1) with G. cbn [value_of].
    change (@add real_numbers) with Rplus. change (@mul real_numbers) with Rmult.
    change (@sub real_numbers) with Rminus. rewrite M.
    change (@rational real_numbers 0) with 0. ring.
  Qed.
End RealPotential.
