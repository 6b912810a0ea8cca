(** Controls of the theorems about implicit methods: their equations can be solved, smoothly in where
    they start. Of the oscillator H = (p^2 + q^2)/2, in closed form and for every h, by stages
    (the implicit midpoint rule) and by a Runge-Kutta method of two stages (that of Gauss). *)

From Coq Require Import Reals Lra Lia List.
From AreaPreservation Require Import Sums Differential Slopes Symplectic Stages Hamiltonians RungeKutta SymplecticMethods StageSchemes.
Import ListNotations.
Local Open Scope R_scope.

Definition harmonic (y : point) : R := (y 0%nat ^ 2 + y 1%nat ^ 2) / 2.

(** Its slopes. *)
Definition harmonic_slopes (j : nat) (y : point) : R := y j.

Lemma harmonic_is_smooth : forall x, twice_differentiable 2 harmonic harmonic_slopes x.
Proof.
  intros x. split.
  - apply near_everywhere. intros y.
    apply (slopes_of_equal 2 (fun z => / 2 * (z 0%nat * z 0%nat + z 1%nat * z 1%nat)));
      [ intros; unfold harmonic; field | ].
    refine (slopes_of_equal_slopes 2 _ y _ _ (slopes_of_multiple 2 (/ 2) _ y _
      (slopes_of_sum 2 _ _ y _ _
        (slopes_of_product 2 _ _ y _ _ (slopes_of_coordinate 2 0 y ltac:(lia))
          (slopes_of_coordinate 2 0 y ltac:(lia)))
        (slopes_of_product 2 _ _ y _ _ (slopes_of_coordinate 2 1 y ltac:(lia))
          (slopes_of_coordinate 2 1 y ltac:(lia))))) _).
    intros [ | [ | i ] ] L; [ | | lia ]; unfold harmonic_slopes, pick; simpl; field.
  - intros j L. exists (pick j). apply slopes_of_coordinate, L.
Qed.

(** * Stages: the implicit midpoint rule *)

Definition midpoint : stage :=
  {| kick_by := 1; drift_by := 1; share_p := 1 / 2; share_q := 1 / 2; moment := 1 / 2 |}.

Definition midpoint_map (h : R) : nat -> point -> R :=
  linear (oscillator_stage h 1 1 (1 / 2) (1 / 2)).

Theorem midpoint_has_solutions : forall h t x,
  solves_scheme 1 h t (fun _ => harmonic) (fun _ => harmonic_slopes)
    [midpoint] [midpoint_map h] x.
Proof.
  intros h t x. split; [ | split; [ | split; [ apply harmonic_is_smooth | exact I ] ] ].
  - apply near_everywhere. intros y. apply oscillator_stage_solves. simpl.
    pose proof (Rle_0_sqr h) as P. unfold Rsqr in P. lra.
  - intros i _. eexists. apply slopes_of_linear_map.
Qed.

(** * A Runge-Kutta method: that of Gauss with two stages *)

(** w is the root of 3. *)
Definition gauss_entry (w : R) (i j : nat) : R :=
  match i, j with
  | O, O => 1 / 4
  | O, _ => 1 / 4 - w / 6
  | _, O => 1 / 4 + w / 6
  | _, _ => 1 / 4
  end.

Definition gauss_weight (i : nat) : R := 1 / 2.

Lemma gauss_is_symplectic : forall w, symplectic_weights 2 (gauss_entry w) gauss_weight.
Proof.
  intros w [ | [ | i ] ] [ | [ | j ] ] I J; try lia; unfold gauss_entry, gauss_weight; field.
Qed.

(** The matrix of a complex number u + i v on p + i q. *)
Definition complex (u v : R) (i a : nat) : R :=
  match i, a with
  | O, O => u
  | O, _ => - v
  | _, O => v
  | _, _ => u
  end.

(** With z = p + i q the equations are Z_i = z + i h sum_j a_ij Z_j, and 1 - i h/2 - h^2/12 is the
    determinant of that system: d - i e, of absolute value n squared. *)
Section Gauss.
  Context (w h : R) (root : w * w = 3).
  Let d := 1 - h * h / 12.
  Let e := h / 2.
  Let n := d * d + e * e.
  Let c := h * w / 6.

  Definition gauss_stage (i : nat) (y : point) : point := fun a =>
    match i with
    | O => linear (complex ((d + c * e) / n) ((e - c * d) / n)) a y
    | _ => linear (complex ((d - c * e) / n) ((e + c * d) / n)) a y
    end.

  Definition gauss_map : nat -> point -> R := linear (complex ((d * d - e * e) / n) (2 * d * e / n)).

  Lemma gauss_determinant_positive : 0 < n.
  Proof.
    unfold n, d, e. destruct (Req_dec h 0) as [ -> | N ]; [ lra | ].
    pose proof (Rsqr_pos_lt h N) as P. pose proof (Rle_0_sqr (1 - h * h / 12)) as Q.
    unfold Rsqr in *. lra.
  Qed.

  Theorem gauss_solves : forall y, solves_method 1 2 h (gauss_entry w) gauss_weight
    (fun _ => harmonic_slopes) gauss_stage gauss_map y.
  Proof.
    intros y. pose proof gauss_determinant_positive as P.
    assert (N : 144 * n <> 0) by lra. unfold n, d, e in N.
    split.
    - intros [ | [ | i ] ] [ | [ | a ] ] I A; try lia;
        unfold gauss_stage, gauss_entry, turned, harmonic_slopes, linear, complex; simpl;
        unfold c, n, d, e; field [ root ]; lra.
    - intros [ | [ | a ] ] A; try lia;
        unfold gauss_map, gauss_stage, gauss_weight, turned, harmonic_slopes, linear, complex; simpl;
        unfold c, n, d, e; field [ root ]; lra.
  Qed.

  (** All that the theorem about Runge-Kutta methods asks for. *)
  Theorem gauss_has_solutions : forall x,
    near 2 x (solves_method 1 2 h (gauss_entry w) gauss_weight
      (fun _ => harmonic_slopes) gauss_stage gauss_map) /\
    (forall i a, (i < 2)%nat -> (a < 2)%nat ->
      exists g, has_slopes 2 (fun y => gauss_stage i y a) x g) /\
    (forall i, (i < 2)%nat -> twice_differentiable 2 harmonic harmonic_slopes (gauss_stage i x)).
  Proof.
    intros x. split; [ | split ].
    - apply near_everywhere, gauss_solves.
    - intros [ | i ] a _ _; eexists; apply slopes_of_linear_map.
    - intros i _. apply harmonic_is_smooth.
  Qed.
End Gauss.
