(** The leading part of a defect as a derivative along the flow: in the plane that of a function G,
    and in general that of a 2-form. *)

From Coq Require Import Reals QArith List Lia.
From AreaPreservation Require Import Differential Rings Flow Formulas Smooth Identities Certified RealFormulas OneHamiltonian RealDefect RealClaims.
Import ListNotations.
Local Open Scope R_scope.

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

  (** In any number of degrees of freedom: L_D w is the leading form. *)
  Theorem leading_is_lie_derivative : forall w, primitive x = Some w ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    @same K (lie_derivative K sys (fun a b => @value_of K names (turned w a b)) a b)
            (@value_of K names (leading_entry x a b)).
  Proof.
    intros w W a b L Lb.
    apply (primitive_is K sys x names its_meaning (all_sloped v energy x factors checked) w W);
      try assumption.
    intros f F z I. rewrite value_of_element.
    apply (gaps_vanish v energy x factors checked given enough z I).
    apply in_app_iff. right. apply in_app_iff. right. exact F.
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

  (** In the plane: G_t + H_p G_q - H_q G_p is the leading entry. *)
  Theorem leading_is_derivative_of_potential : n = 1%nat -> forall w, primitive x = Some w ->
    forall z, U z -> exists Gp Gq Gt,
    derivable_pt_lim (fun s => value_at (moved z 0 s) (w 0%nat 1%nat)) (z 0%nat) Gp /\
    derivable_pt_lim (fun s => value_at (moved z 1 s) (w 0%nat 1%nat)) (z 1%nat) Gq /\
    derivable_pt_lim (fun s => value_at (moved z 2 s) (w 0%nat 1%nat)) (z 2%nat) Gt /\
    Gt + value_at z (slope_of_energy x 0) * Gq - value_at z (slope_of_energy x 1) * Gp
    = value_at z (leading_entry x 0 1).
  Proof.
    intros N w W z I. set (G := w 0%nat 1%nat).
    assert (D := fun a => value_of_slope_is v names_ok given enough x size slopes_ok z I G a).
    rewrite N in D. exists (value_at z (slope x 0 G)), (value_at z (slope x 1 G)),
      (value_at z (slope x 2 G)).
    split; [apply D; lia|split; [apply D; lia|split; [apply D; lia|]]].
    rewrite <- (gap_is_closed v given z (lie_formula x w 0 1) (leading_entry x 0 1)).
    - assert (M := mixed_slopes_equal z 0 1 I ltac:(lia) ltac:(lia)).
      unfold lie_formula, flow_formula. rewrite N.
      cbn [sum_up_to sum_of seq map fold_right Nat.mul Nat.add].
      change (turned w 1 1) with (Number 0). change (turned w 0 0) with (Number 0).
      change (turned w 0 1) with G. cbn [value_of].
      change (@add real_numbers) with Rplus. change (@mul real_numbers) with Rmult.
      change (@sub real_numbers) with Rminus. rewrite M.
      change (@rational real_numbers 0) with 0. ring.
    - apply (gaps_vanish v energy x factors checked given enough z I).
      apply in_app_iff. right. apply in_app_iff. right. unfold primitive_gaps. rewrite W.
      apply in_map_iff. exists (0%nat, 1%nat). split; [reflexivity|]. apply pair_listed; lia.
  Qed.
End RealPotential.
