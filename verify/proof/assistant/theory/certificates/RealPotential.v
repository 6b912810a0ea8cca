(** The leading part of a defect as a derivative along the flow, in slopes alone: in the plane that of
    a function G, and in general that of a 2-form. *)

From Coq Require Import Reals QArith List Lia.
From AreaPreservation Require Import Sums Differential Rings Flow Formulas Smooth Identities Certified RealFormulas RealNames OneHamiltonian RealDefect RealClaims.
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

  Lemma primitive_closed : forall w, primitive x = Some w -> forall z a b, U z -> (a < b)%nat ->
    (b < 2 * n)%nat -> value_at z (lie_formula x w a b) = value_at z (leading_entry x a b).
  Proof.
    intros w W z a b I L Lb. apply gap_is_closed.
    apply (gaps_vanish v energy x factors checked given enough z I).
    apply in_app_iff. right. apply in_app_iff. right. unfold primitive_gaps. rewrite W.
    apply in_map_iff. exists (a, b). split; [reflexivity|]. apply pair_listed; assumption.
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
    rewrite <- (primitive_closed w W z 0 1 I) by lia.
    assert (M := mixed_slopes_equal z 0 1 I ltac:(lia) ltac:(lia)).
    unfold lie_formula, flow_formula. rewrite N.
    cbn [sum_up_to sum_of seq map fold_right Nat.mul Nat.add].
    change (form_formula w 1 1) with (Number 0). change (form_formula w 0 0) with (Number 0).
    change (form_formula w 0 1) with G. cbn [value_of].
    change (@add real_numbers) with Rplus. change (@mul real_numbers) with Rmult.
    change (@sub real_numbers) with Rminus. rewrite M.
    change (@rational real_numbers 0) with 0. ring.
  Qed.

  (** In any number of degrees of freedom it is the Lie derivative of a 2-form along the flow: of its
      entries G, their slopes G1 a b c by the coordinate c, the slopes of H and theirs, H2 i c. *)
  Theorem leading_is_lie_derivative : forall slopes form leading,
    slope_of_energy x = (fun a => nth a slopes (Number 0)) ->
    primitive x = Some (entry (Number 0) form) -> leading_entry x = entry (Number 0) leading ->
    let entries z l : nat -> nat -> R := entry 0 (map (fun e => (fst e, value_at z (snd e))) l) in
    let H1 z i : R := nth i (map (fun f => value_at z f) slopes) 0 in
    forall z, U z -> exists (G1 : nat -> nat -> nat -> R) (H2 : nat -> nat -> R),
    (forall a b c, (a < b)%nat -> (b < 2 * n)%nat -> (c <= 2 * n)%nat ->
      derivable_pt_lim (fun s => entries (moved z c s) form a b) (z c) (G1 a b c)) /\
    (forall i c, (i < 2 * n)%nat -> (c < 2 * n)%nat ->
      derivable_pt_lim (fun s => H1 (moved z c s) i) (z c) (H2 i c)) /\
    let w := two_form 0 Ropp (entries z form) in
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
      G1 a b (2 * n)%nat
      + sum n (fun i => H1 z i * G1 a b (n + i)%nat - H1 z (n + i)%nat * G1 a b i)
      + sum n (fun i => H2 i a * w (n + i)%nat b - H2 (n + i)%nat a * w i b
                      + (H2 i b * w a (n + i)%nat - H2 (n + i)%nat b * w a i))
      = entries z leading a b.
  Proof.
    intros slopes form leading Es Ew El entries H1 z I. set (G := entry (Number 0) form).
    assert (entry_is : forall y l a b, value_at y (entry (Number 0) l a b) = entries y l a b).
    { intros y l a b. apply (entry_of_map _ _ (fun f => value_at y f)). }
    assert (slope_is : forall y i, value_at y (slope_of_energy x i) = H1 y i).
    { intros y i. rewrite Es. unfold H1. change 0 with (value_at y (Number 0)).
      rewrite (map_nth (fun f => value_at y f)). reflexivity. }
    exists (fun a b c => value_at z (slope x c (G a b))),
      (fun i c => value_at z (slope x c (slope_of_energy x i))).
    assert (D := fun f c => value_of_slope_is v names_ok given enough x size slopes_ok z I f c).
    split; [|split].
    - intros a b c _ _ L. apply derivable_pt_lim_ext with (2 := D (G a b) c ltac:(lia)).
      intro s. apply entry_is.
    - intros i c _ L. apply derivable_pt_lim_ext with (2 := D (slope_of_energy x i) c ltac:(lia)).
      intro s. apply slope_is.
    - intros w a b L Lb.
      assert (form_is : forall i j, value_at z (form_formula G i j) = w i j).
      { intros i j. unfold w, two_form. rewrite <- !entry_is.
        destruct (i <? j)%nat; [reflexivity|]. destruct (j <? i)%nat; reflexivity. }
      rewrite <- entry_is, <- El, <- (primitive_closed G Ew z a b I L Lb).
      unfold lie_formula, flow_formula. cbn [value_of].
      rewrite !(value_of_sum_up_to real_numbers), !total_is_sum.
      replace (form_formula G a b) with (G a b) by
        (unfold two_form; rewrite (proj2 (Nat.ltb_lt a b) L); reflexivity).
      apply f_equal2; [apply f_equal|]; apply sum_of_equals; intros i Li; cbn [value_of];
        rewrite ?form_is, ?slope_is; reflexivity.
  Qed.
End RealPotential.
