(** Schemes of several stages, each of them one of Stages.v, for every Hamiltonian. *)

From Coq Require Import Reals Lra Lia List.
From AreaPreservation Require Import Differential Symplectic Stages Hamiltonians SymplecticMethods.
Import ListNotations.
Local Open Scope R_scope.

(** p' = p - h kick H_q, q' = q + h drift H_p, at p + share_p (p' - p), q + share_q (q' - q) and the
    time t + moment h. *)
Record stage := { kick_by : R; drift_by : R; share_p : R; share_q : R; moment : R }.

Definition stage_holds (separable : bool) (s : stage) : Prop :=
  kick_by s * drift_by s * (1 - share_p s - share_q s) = 0 /\
  (separable = false -> kick_by s = drift_by s).

(** The maps solve the stages one after the other from the point x on, smoothly, and H is twice
    differentiable where its slopes are taken. *)
Fixpoint solves_scheme (n : nat) (h t : R) (H : R -> point -> R) (H1 : R -> nat -> point -> R)
    (stages : list stage) (maps : list (nat -> point -> R)) (x : point) : Prop :=
  match stages, maps with
  | [], [] => True
  | s :: stages', F :: maps' =>
      near (2 * n) x (solves_stage n h (kick_by s) (drift_by s) (share_p s) (share_q s)
        (H1 (t + moment s * h)) F) /\
      (forall i, (i < 2 * n)%nat -> exists g, has_slopes (2 * n) (F i) x g) /\
      twice_differentiable (2 * n) (H (t + moment s * h)) (H1 (t + moment s * h))
        (stage_point n (share_p s) (share_q s) F x) /\
      solves_scheme n h t H H1 stages' maps' (fun j => F j x)
  | _, _ => False
  end.

Theorem scheme_symplectic : forall n separable stages, Forall (stage_holds separable) stages ->
  forall H H1, (separable = true -> forall t, sum_of_parts n (H t)) ->
  forall h t maps x, solves_scheme n h t H H1 stages maps x -> symplectic_at n (steps_of maps) x.
Proof.
  intros n separable stages Hold H H1 Parts h t. induction Hold as [|s stages [C KD] Hold IH];
    intros [|F maps] x S; try contradiction.
  - apply (identity_symplectic n).
  - destruct S as [Eq [Some [Twice Rest]]].
    apply (composition_symplectic n F (steps_of maps)); [|apply IH, Rest].
    apply (stage_of_hamiltonian n h (kick_by s) (drift_by s) (share_p s) (share_q s)
      (H (t + moment s * h)) (H1 (t + moment s * h)) F x);
      try assumption.
    destruct separable; [right; apply Parts; reflexivity|left; apply KD; reflexivity].
Qed.
