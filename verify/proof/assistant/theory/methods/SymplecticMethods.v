(** Stages, kicks, drifts and Runge-Kutta methods are symplectic for every Hamiltonian that is twice
    differentiable at the points where its slopes are taken. For one degree of freedom this is that
    they keep the area, by [area_preserved] and [determinant_one]. *)

From Coq Require Import Reals Lra Lia List.
From AreaPreservation Require Import Differential Symplectic Stages Shears RungeKutta Hamiltonians.
Local Open Scope R_scope.

Theorem stage_of_hamiltonian : forall n h k d s u (H : point -> R) (H1 F : nat -> point -> R) x,
  near (2 * n) x (solves_stage n h k d s u H1 F) ->
  (forall i, (i < 2 * n)%nat -> exists g, has_slopes (2 * n) (F i) x g) ->
  twice_differentiable (2 * n) H H1 (stage_point n s u F x) ->
  k * d * (1 - s - u) = 0 ->
  k = d \/ sum_of_parts n H ->
  symplectic_at n F x.
Proof.
  intros n h k d s u H H1 F x Eq Some Twice C KD.
  destruct (symmetric_second_slopes _ _ _ _ Twice) as (H2 & S2 & E).
  apply (stage_symplectic n h k d s u H1 F x H2); try assumption.
  destruct KD as [ | Parts ]; [ left; assumption | right ].
  apply (parts_separated n H H1 _ H2 Parts (proj1 Twice) S2 E).
Qed.

Theorem method_of_hamiltonian : forall n m h A b (H : nat -> point -> R)
    (H1 : nat -> nat -> point -> R) (Z : nat -> point -> point) (F : nat -> point -> R) (x : point),
  near (2 * n) x (solves_method n m h A b H1 Z F) ->
  (forall i c, (i < m)%nat -> (c < 2 * n)%nat ->
     exists g, has_slopes (2 * n) (fun y => Z i y c) x g) ->
  (forall i, (i < m)%nat -> twice_differentiable (2 * n) (H i) (H1 i) (Z i x)) ->
  symplectic_weights m A b ->
  symplectic_at n F x.
Proof.
  intros n m h A b H H1 Z F x Eq Some Twice M.
  assert (Second : exists H2 : nat -> nat -> nat -> R, forall i, (i < m)%nat ->
    (forall j, (j < 2 * n)%nat -> has_slopes (2 * n) (H1 i j) (Z i x) (H2 i j)) /\
    symmetric (2 * n) (H2 i)).
  { clear M Eq Some. induction m as [ | m IH ].
    - exists (fun _ _ _ => 0). intros. lia.
    - destruct IH as (H2 & S2); [ intros; apply Twice; lia | ].
      destruct (symmetric_second_slopes _ _ _ _ (Twice m ltac:(lia))) as (G & SG).
      exists (fun i => if Nat.eqb i m then G else H2 i). intros i I.
      destruct (Nat.eqb_spec i m) as [ -> | ]; [ exact SG | apply S2; lia ]. }
  destruct Second as (H2 & S2).
  apply (method_symplectic n m h A b H1 Z F x H2); try assumption.
  - intros i j I. apply (proj1 (S2 i I)).
  - intros i I. apply (proj2 (S2 i I)).
Qed.

Theorem midpoint_of_hamiltonian : forall n h (H : point -> R) (H1 F : nat -> point -> R) x,
  let middle := fun y c => (y c + F c y) / 2 in
  near (2 * n) x (fun y => forall c, (c < 2 * n)%nat ->
    F c y = y c + h * turned n (fun l => H1 l (middle y)) c) ->
  (forall c, (c < 2 * n)%nat -> exists g, has_slopes (2 * n) (F c) x g) ->
  twice_differentiable (2 * n) H H1 (middle x) ->
  symplectic_at n F x.
Proof.
  intros n h H H1 F x middle Eq Some Twice.
  destruct (symmetric_second_slopes _ _ _ _ Twice) as (H2 & S2 & E).
  apply (midpoint_symplectic n h H1 F x H2); assumption.
Qed.

(** * Lists of kicks and drifts *)

(** A kick with a function V of the positions, or a drift with a function T of the momenta, each
    with its slopes and a weight. *)
Inductive shear : Type :=
  | Kick : R -> (point -> R) -> (nat -> point -> R) -> shear
  | Drift : R -> (point -> R) -> (nat -> point -> R) -> shear.

Definition shear_map (n : nat) (h : R) (s : shear) : nat -> point -> R :=
  match s with
  | Kick k _ V1 => kick n h k V1
  | Drift d _ T1 => drift n h d T1
  end.

Definition shear_of_hamiltonian (n : nat) (s : shear) (x : point) : Prop :=
  match s with
  | Kick _ V V1 => only_positions n V /\ twice_differentiable (2 * n) V V1 x
  | Drift _ T T1 => only_momenta n T /\ twice_differentiable (2 * n) T T1 x
  end.

Theorem shear_symplectic : forall n h s x,
  shear_of_hamiltonian n s x -> symplectic_at n (shear_map n h s) x.
Proof.
  intros n h [ k V V1 | d T T1 ] x (Only & Twice); simpl;
    destruct (symmetric_second_slopes _ _ _ _ Twice) as (H2 & S2 & E).
  - apply positions_are_parts in Only.
    pose proof (parts_separated n V V1 x H2 Only (proj1 Twice) S2 E) as Sep.
    apply (kick_symplectic n h k V1 x H2).
    + intros i I. apply S2. lia.
    + intros i j I L. split; [ apply (Sep i j I L) | apply E; lia ].
  - apply momenta_are_parts in Only.
    pose proof (parts_separated n T T1 x H2 Only (proj1 Twice) S2 E) as Sep.
    apply (drift_symplectic n h d T1 x H2).
    + intros i I. apply S2. lia.
    + intros i j I L. split; [ apply (Sep i j I L) | apply E; lia ].
Qed.

(** Each shear is one at the point that those before it lead to. *)
Fixpoint shears_of_hamiltonian (n : nat) (h : R) (l : list shear) (x : point) : Prop :=
  match l with
  | nil => True
  | s :: rest => shear_of_hamiltonian n s x /\
                 shears_of_hamiltonian n h rest (fun j => shear_map n h s j x)
  end.

Theorem shears_symplectic : forall n h l x,
  shears_of_hamiltonian n h l x -> symplectic_at n (steps_of (map (shear_map n h) l)) x.
Proof.
  intros n h l x E. apply steps_symplectic. revert x E.
  induction l as [ | s rest IH ]; intros x E; simpl; [ exact I | ].
  destruct E as (Here & There). split; [ apply shear_symplectic, Here | apply IH, There ].
Qed.

(** Where V and T are so everywhere, it is enough to look at each shear by itself. *)
Lemma shears_of_hamiltonian_everywhere : forall n h l,
  List.Forall (fun s => forall x, shear_of_hamiltonian n s x) l ->
  forall x, shears_of_hamiltonian n h l x.
Proof.
  intros n h l E. induction E as [ | s rest Here _ IH ]; intro x; simpl;
    [ exact I | split; [ apply Here | apply IH ] ].
Qed.
