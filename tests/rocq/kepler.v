(** Kepler's problem on a line, H = p^2 / 2 - 1 / q, in the theorem of an exported file: V is singular
    at q = 0, and twice differentiable where q is not 0. *)

From Coq Require Import Reals Lra Lia.
From AreaPreservation Require Import Sums Differential Slopes Symplectic Shears Hamiltonians SymplecticMethods.
Require Import stormer_verlet.
Local Open Scope R_scope.

Definition V (y : point) : R := - / y 1%nat.
Definition V1 (j : nat) (y : point) : R := match j with 1%nat => / (y 1%nat * y 1%nat) | _ => 0 end.
Definition T (y : point) : R := / 2 * (y 0%nat * y 0%nat).
Definition T1 (j : nat) (y : point) : R := match j with O => y 0%nat | _ => 0 end.

Lemma V_off_0 : forall x, 0 < x 1%nat -> only_positions 1 V /\ twice_differentiable 2 V V1 x.
Proof.
  assert (coordinate := fun x => slopes_of_coordinate 2 1 x ltac:(lia)).
  intros x X. split; [intros y y' E; exact (f_equal (fun q => - / q) (E 0%nat ltac:(lia)))|split].
  - exists (x 1%nat). split; [exact X|]. intros y Y.
    assert (B := coordinate_below_distance 2 x y 1 ltac:(lia)).
    assert (P : 0 < y 1%nat) by (destruct (Rabs_def2 (y 1%nat - x 1%nat) (x 1%nat)); lra).
    refine (slopes_of_equal_slopes _ _ _ _ _ (slopes_of_opposite _ _ _ _
      (slopes_of_inverse _ _ _ _ (coordinate y) _)) _); [lra|].
    intros [|[|j]] L; [| |lia]; unfold V1, pick; simpl; ring.
  - intros [|[|j]] L; [| |lia]; eexists; [apply slopes_of_constant|].
    refine (slopes_of_inverse 2 (fun y => y 1%nat * y 1%nat) _ _
      (slopes_of_product _ _ _ _ _ _ (coordinate x) (coordinate x)) _).
    apply Rgt_not_eq, Rmult_lt_0_compat; exact X.
Qed.

Lemma T_anywhere : forall x, only_momenta 1 T /\ twice_differentiable 2 T T1 x.
Proof.
  assert (coordinate := fun x => slopes_of_coordinate 2 0 x ltac:(lia)).
  intros x. split; [intros y y' E; exact (f_equal (fun p => / 2 * (p * p)) (E 0%nat ltac:(lia)))|split].
  - apply near_everywhere. intros y.
    refine (slopes_of_equal_slopes _ _ _ _ _ (slopes_of_multiple _ (/ 2) _ _ _
      (slopes_of_product _ _ _ _ _ _ (coordinate y) (coordinate y))) _).
    intros [|[|j]] L; [| |lia]; unfold T1, pick; simpl; field.
  - intros [|[|j]] L; [| |lia]; eexists; [apply coordinate|apply slopes_of_constant].
Qed.

(** Where q is positive before and after the drift. *)
Theorem kepler : forall h x, 0 < x 1%nat ->
  0 < x 1%nat + h * (x 0%nat - h * / 2 * / (x 1%nat * x 1%nat)) ->
  symplectic_at 1 (step V T V1 T1 h) x.
Proof.
  intros h x X X'. apply step_is_symplectic. simpl.
  split; [apply V_off_0, X|split; [apply T_anywhere|split; [|exact I]]]. apply V_off_0.
  unfold drift, kick, V1, T1. simpl. replace (1 / 2) with (/ 2) by field. lra.
Qed.

(** The special case says nothing of it. *)
Theorem not_everywhere : ~ is_potential V V1.
Proof.
  intros P. destruct (P (fun _ => 0)) as [_ [[r [R S]] _]].
  destruct (continuous_where_slopes 2 V (fun _ => 0) _
    (S (fun _ => 0) ltac:(rewrite distance_to_itself; exact R)) 1 Rlt_0_1) as [d [D C]].
  set (v := V (fun _ => 0)) in *. assert (A := Rabs_pos v). assert (B := Rle_abs (- v)).
  rewrite Rabs_Ropp in B. set (e := Rmin (d / 2) (/ (Rabs v + 2))).
  assert (E : 0 < e) by (apply Rmin_pos; [lra|apply Rinv_0_lt_compat; lra]).
  assert (E1 := Rmin_l (d / 2) (/ (Rabs v + 2))). assert (E2 := Rmin_r (d / 2) (/ (Rabs v + 2))).
  fold e in E1, E2. assert (large : Rabs v + 2 <= / e).
  { rewrite <- (Rinv_inv (Rabs v + 2)). apply Rinv_le_contravar; assumption. }
  specialize (C (fun j => match j with 1%nat => e | _ => 0 end)). unfold distance, V in C. simpl in C.
  rewrite !Rminus_0_r, Rabs_R0, (Rabs_right e) in C by lra.
  destruct (Rabs_def2 _ _ (C ltac:(lra))) as [_ F]. lra.
Qed.
