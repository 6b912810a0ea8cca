(** Hamiltonians that are twice differentiable, and those that are a sum T(p) + V(q). *)

From Coq Require Import Reals Lra Lia.
From AreaPreservation Require Import Differential Slopes Schwarz Symplectic Stages.
Local Open Scope R_scope.

(** [H] has the slopes [H1] on a ball around [x], and these have slopes at [x]. *)
Definition twice_differentiable (N : nat) (H : point -> R) (H1 : nat -> point -> R) (x : point) :=
  near N x (fun y => has_slopes N H y (fun j => H1 j y)) /\
  forall j, (j < N)%nat -> exists g, has_slopes N (H1 j) x g.

Lemma symmetric_second_slopes : forall N H H1 x, twice_differentiable N H H1 x ->
  exists H2, (forall j, (j < N)%nat -> has_slopes N (H1 j) x (H2 j)) /\ symmetric N H2.
Proof.
  intros N H H1 x (S & Some). destruct (choice_of_slopes N N H1 x Some) as (H2 & S2).
  exists H2. split; [ exact S2 | ]. destruct S as (r & r_positive & S).
  exact (second_slopes_symmetric N H H1 H2 x r r_positive S S2).
Qed.

(** * Hamiltonians T(p) + V(q) *)

Definition only_momenta (n : nat) (T : point -> R) : Prop :=
  forall y y', (forall i, (i < n)%nat -> y i = y' i) -> T y = T y'.

Definition only_positions (n : nat) (V : point -> R) : Prop :=
  forall y y', (forall i, (i < n)%nat -> y (n + i)%nat = y' (n + i)%nat) -> V y = V y'.

Definition sum_of_parts (n : nat) (H : point -> R) : Prop :=
  exists T V, only_momenta n T /\ only_positions n V /\ forall y, H y = T y + V y.

Lemma positions_are_parts : forall n V, only_positions n V -> sum_of_parts n V.
Proof.
  intros n V P. exists (fun _ => 0), V. split; [ | split; [ exact P | intros; ring ] ].
  intros y y' _. reflexivity.
Qed.

Lemma momenta_are_parts : forall n T, only_momenta n T -> sum_of_parts n T.
Proof.
  intros n T P. exists T, (fun _ => 0). split; [ exact P | split; [ | intros; ring ] ].
  intros y y' _. reflexivity.
Qed.

Lemma distance_moved : forall N x i s, (i < N)%nat -> distance N x (moved x i s) = Rabs (s - x i).
Proof.
  intros N x i s L. unfold distance, moved.
  rewrite (sum_of_single N i); [ rewrite Nat.eqb_refl; reflexivity | exact L | ].
  intros j _ D. apply Nat.eqb_neq in D. rewrite D, Rminus_diag_eq, Rabs_R0; reflexivity.
Qed.

(** The slope along a momentum does not change when a position moves. *)
Lemma parts_slope_fixed : forall n H H1 x i j s, sum_of_parts n H -> (i < n)%nat -> (j < n)%nat ->
  has_slopes (2 * n) H x (fun l => H1 l x) ->
  has_slopes (2 * n) H (moved x (n + j) s) (fun l => H1 l (moved x (n + j) s)) ->
  H1 i (moved x (n + j) s) = H1 i x.
Proof.
  intros n H H1 x i j s (T & V & HT & HV & HTV) I L Sx Sy. set (y := moved x (n + j) s) in *.
  assert (same : y i = x i).
  { unfold y, moved. replace (Nat.eqb i (n + j)) with false; [ reflexivity | ].
    symmetry. apply Nat.eqb_neq. lia. }
  pose proof (derivative_along_coordinate (2 * n) H x _ i Sx ltac:(lia)) as Dx.
  pose proof (derivative_along_coordinate (2 * n) H y _ i Sy ltac:(lia)) as Dy.
  cbv beta in Dx, Dy. rewrite same in Dy.
  replace (H1 i x) with (H1 i x + 0) by ring.
  apply (uniqueness_limite (fun t => H (moved y i t)) (x i)); [ exact Dy | ].
  intros eps Eps.
  destruct (derivable_pt_lim_plus _ _ _ _ _ Dx (derivable_pt_lim_const (V y - V x) (x i)) eps Eps)
    as (d & D).
  exists d. intros t t_nonzero t_small. specialize (D t t_nonzero t_small).
  assert (E : forall r, H (moved y i r)
    = plus_fct (fun t => H (moved x i t)) (fct_cte (V y - V x)) r).
  { intros r. unfold plus_fct, fct_cte. rewrite !HTV.
    rewrite (HT (moved y i r) (moved x i r)).
    2: { intros l M. unfold y, moved. destruct (Nat.eqb l i); [ reflexivity | ].
         destruct (Nat.eqb_spec l (n + j)); [ lia | reflexivity ]. }
    rewrite (HV (moved y i r) y), (HV (moved x i r) x); [ ring | | ]; intros l M; unfold moved;
      (destruct (Nat.eqb_spec (n + l) i); [ lia | reflexivity ]). }
  rewrite !E. exact D.
Qed.

Lemma parts_separated : forall n H H1 x H2, sum_of_parts n H ->
  near (2 * n) x (fun y => has_slopes (2 * n) H y (fun j => H1 j y)) ->
  (forall j, (j < 2 * n)%nat -> has_slopes (2 * n) (H1 j) x (H2 j)) ->
  symmetric (2 * n) H2 -> separated n H2.
Proof.
  intros n H H1 x H2 Parts (r & r_positive & S) S2 E i j I L.
  assert (zero : forall i j, (i < n)%nat -> (j < n)%nat -> H2 i (n + j)%nat = 0).
  { clear i j I L. intros i j I L.
    pose proof (derivative_along_coordinate (2 * n) (H1 i) x _ (n + j) (S2 i ltac:(lia)) ltac:(lia))
      as D.
    apply (uniqueness_limite _ _ _ _ D). intros eps Eps. exists (mkposreal r r_positive). simpl.
    intros t t_nonzero t_small.
    assert (fixed : forall s, Rabs (s - x (n + j)%nat) < r ->
      H1 i (moved x (n + j) s) = H1 i x).
    { intros s Near. apply (parts_slope_fixed n H H1 x i j s Parts I L).
      - apply S. rewrite distance_to_itself. exact r_positive.
      - apply S. rewrite distance_moved by lia. exact Near. }
    rewrite !fixed.
    - replace ((H1 i x - H1 i x) / t - 0) with 0 by (field; exact t_nonzero).
      rewrite Rabs_R0. exact Eps.
    - rewrite Rminus_diag_eq, Rabs_R0; trivial.
    - replace (x (n + j)%nat + t - x (n + j)%nat) with t by ring. exact t_small. }
  split; [ apply zero; assumption | ]. rewrite (E (n + i)%nat j) by lia. apply zero; assumption.
Qed.
