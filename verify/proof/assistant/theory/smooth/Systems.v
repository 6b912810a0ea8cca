(** Systems of analysis: any smooth Hamiltonian on an open set is one of Flow.v's.

    Coordinates 0 .. n-1 are p, n .. 2n-1 are q, and 2n is the time, as in Flow.v. *)

From Coq Require Import Reals Lra Lia PeanoNat.
From AreaPreservation Require Import Sums Differential Rings Totals Flow Smooth.
Local Open Scope R_scope.

Lemma smooth_own_slope : forall n U (HU : is_open (2 * n + 1) U) i, (i <= 2 * n)%nat ->
  @same (smooth_ring _ U HU) (@by_coordinate (smooth_ring _ U HU) i (smooth_coordinate i))
    (@one (smooth_ring _ U HU)).
Proof.
  intros n U HU i Hi. pose proof (derivation_coordinate _ U HU i i) as D.
  rewrite Nat.eqb_refl in D. apply D; lia.
Qed.

Lemma smooth_other_slope : forall n U (HU : is_open (2 * n + 1) U) i j,
  (i <= 2 * n)%nat -> (j <= 2 * n)%nat -> i <> j ->
  @same (smooth_ring _ U HU) (@by_coordinate (smooth_ring _ U HU) i (smooth_coordinate j))
    (@zero (smooth_ring _ U HU)).
Proof.
  intros n U HU i j Hi Hj Ne. pose proof (derivation_coordinate _ U HU i j) as D.
  rewrite (proj2 (Nat.eqb_neq i j) Ne) in D. apply D; lia.
Qed.

(** Any smooth function of p, q and t is a Hamiltonian. *)
Definition smooth_system (n : nat) (U : point -> Prop) (HU : is_open (2 * n + 1) U)
    (H : smooth (2 * n + 1) U) : system (smooth_ring (2 * n + 1) U HU) :=
  Build_system (smooth_ring (2 * n + 1) U HU) n smooth_coordinate H
    (smooth_own_slope n U HU) (smooth_other_slope n U HU).

Lemma value_total : forall N U (HU : is_open N U) m (f : nat -> smooth N U) x,
  value (@total (smooth_ring N U HU) m f) x = sum m (fun i => value (f i) x).
Proof.
  intros N U HU m f x. induction m as [|m IH]; [reflexivity|].
  exact (f_equal (fun t => t + value (f m) x) IH).
Qed.

(** The rate at which a function changes along the flow is the one of analysis. *)
Theorem value_along_flow : forall n U (HU : is_open (2 * n + 1) U) H (f : smooth (2 * n + 1) U) x,
  value (along_flow _ (smooth_system n U HU H) f) x
  = value (smooth_derivative (2 * n) f) x
    + sum n (fun i =>
        value (smooth_derivative i H) x * value (smooth_derivative (n + i) f) x
        - value (smooth_derivative (n + i) H) x * value (smooth_derivative i f) x).
Proof.
  intros n U HU H f x. exact (f_equal (Rplus _) (value_total _ U HU n _ x)).
Qed.

Definition everywhere (x : point) : Prop := True.

Lemma everywhere_is_open : forall N, is_open N everywhere.
Proof. intros N x _. exists 1. split; [lra|]. intros y _. exact I. Qed.

(** Control: the ring is not trivial where the set has a point, so its laws say something. *)
Lemma smooth_ring_not_trivial : forall N U (HU : is_open N U) x, U x ->
  ~ @same (smooth_ring N U HU) (@zero (smooth_ring N U HU)) (@one (smooth_ring N U HU)).
Proof. intros N U HU x Hx E. specialize (E x Hx). unfold value in E. simpl in E. lra. Qed.
