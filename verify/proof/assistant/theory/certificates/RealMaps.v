(** What is said of maps over the real numbers, in the words of an exported file: sums of powers of h,
    Jacobians, and what a map lacks to be symplectic. *)

From Coq Require Import Reals List Lra Lia.
From AreaPreservation Require Import Sums Differential Symplectic.
Import ListNotations.
Local Open Scope R_scope.

(** sum c_k h^k. *)
Fixpoint in_powers (h : R) (coefficients : list R) : R :=
  match coefficients with
  | [] => 0
  | c :: others => c + h * in_powers h others
  end.

(** The point with these coordinates. *)
Definition at_point (coordinates : list R) : point := fun j => nth j coordinates 0.

Definition has_jacobian (n : nat) (F : nat -> point -> R) (z : point) (J : nat -> nat -> R) : Prop :=
  forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat ->
    derivable_pt_lim (fun s => F c (moved z a s)) (z a) (J c a).

(** J^T Omega J - Omega, entry by entry. *)
Definition defect_entry (n : nat) (J : nat -> nat -> R) (a b : nat) : R :=
  sum n (fun i => J i a * J (n + i)%nat b - J i b * J (n + i)%nat a) - pairing n a b.

(** What is left out of a map has slopes that stay bounded for |h| <= 1. *)
Definition slopes_bounded (n : nat) (rest : nat -> R -> point -> R) (z : point) : Prop :=
  exists (J : nat -> nat -> R -> R) B, forall h, Rabs h <= 1 ->
    has_jacobian n (fun c => rest c h) z (fun c a => J c a h) /\
    forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat -> Rabs (J c a h) <= B.

(** In the plane: the determinant of the map (P, Q) at (p, q). *)
Definition has_determinant (P Q : R -> R -> R) (p q det : R) : Prop := exists P_p P_q Q_p Q_q,
  derivable_pt_lim (fun s => P s q) p P_p /\ derivable_pt_lim (fun s => P p s) q P_q /\
  derivable_pt_lim (fun s => Q s q) p Q_p /\ derivable_pt_lim (fun s => Q p s) q Q_q /\
  det = P_p * Q_q - P_q * Q_p.

Definition plane_slopes_bounded (u : R -> R -> R -> R) (p q : R) : Prop :=
  exists (u_p u_q : R -> R) B, forall h, Rabs h <= 1 ->
    derivable_pt_lim (fun s => u h s q) p (u_p h) /\ derivable_pt_lim (fun s => u h p s) q (u_q h) /\
    Rabs (u_p h) <= B /\ Rabs (u_q h) <= B.

Lemma in_powers_is : forall h l m, (length l <= m)%nat ->
  in_powers h l = sum m (fun k => nth k l 0 * h ^ k).
Proof.
  intros h l. induction l as [|c l IH]; intros m L; simpl in_powers.
  - symmetry. apply sum_of_zeros. intros k _. destruct k; simpl; ring.
  - destruct m as [|m]; [simpl in L; lia|]. rewrite (IH m) by (simpl in L; lia).
    assert (first : forall f, sum (S m) f = f O + sum m (fun k => f (S k))).
    { clear. induction m as [|m IH]; intro f; simpl; [ring|]. simpl in IH. rewrite IH. ring. }
    rewrite first. simpl nth. simpl pow. rewrite <- sum_of_multiple.
    replace (c * 1) with c by ring. f_equal. apply sum_of_equals. intros k _. ring.
Qed.

(** * The plane *)

(** There S has one entry, which is det J - 1. *)
Lemma entry_in_plane : forall n J, n = 1%nat -> defect_entry n J 0 1
  = J 0%nat 0%nat * J 1%nat 1%nat - J 0%nat 1%nat * J 1%nat 0%nat - 1.
Proof. intros n J ->. unfold defect_entry, pairing. simpl. ring. Qed.

(** Two functions of p and q as a map of points. *)
Definition plane_map (u w : R -> R -> R -> R) (c : nat) (h : R) (y : point) : R :=
  match c with O => u h (y 0%nat) (y 1%nat) | _ => w h (y 0%nat) (y 1%nat) end.

Lemma plane_map_bounded : forall u w z,
  plane_slopes_bounded u (z 0%nat) (z 1%nat) -> plane_slopes_bounded w (z 0%nat) (z 1%nat) ->
  slopes_bounded 1 (plane_map u w) z.
Proof.
  intros u w z [u_p [u_q [B1 U]]] [w_p [w_q [B2 W]]].
  exists (fun c a h => match c, a with O, O => u_p h | O, _ => u_q h | _, O => w_p h | _, _ => w_q h end),
    (Rmax B1 B2). intros h Lh. destruct (U h Lh) as [U1 [U2 [U3 U4]]].
  destruct (W h Lh) as [W1 [W2 [W3 W4]]].
  assert (M1 := Rmax_l B1 B2). assert (M2 := Rmax_r B1 B2). split.
  - intros [|[|c]] [|[|a]] Lc La; try lia; assumption.
  - intros [|[|c]] [|[|a]] Lc La; try lia; lra.
Qed.

(** A map of points that is written with functions of p and q where the time is that of z. *)
Lemma plane_determinant : forall (F : nat -> point -> R) (P Q : R -> R -> R) (z : point) J,
  (forall y, y 2%nat = z 2%nat -> P (y 0%nat) (y 1%nat) = F 0%nat y) ->
  (forall y, y 2%nat = z 2%nat -> Q (y 0%nat) (y 1%nat) = F 1%nat y) ->
  has_jacobian 1 F z J -> has_determinant P Q (z 0%nat) (z 1%nat) (defect_entry 1 J 0 1 + 1).
Proof.
  intros F P Q z J P_is Q_is D.
  exists (J 0%nat 0%nat), (J 0%nat 1%nat), (J 1%nat 0%nat), (J 1%nat 1%nat).
  split; [|split; [|split; [|split]]].
  - exact (derivable_pt_lim_ext _ _ _ _ (fun s => eq_sym (P_is (moved z 0 s) eq_refl))
      (D 0%nat 0%nat ltac:(lia) ltac:(lia))).
  - exact (derivable_pt_lim_ext _ _ _ _ (fun s => eq_sym (P_is (moved z 1 s) eq_refl))
      (D 0%nat 1%nat ltac:(lia) ltac:(lia))).
  - exact (derivable_pt_lim_ext _ _ _ _ (fun s => eq_sym (Q_is (moved z 0 s) eq_refl))
      (D 1%nat 0%nat ltac:(lia) ltac:(lia))).
  - exact (derivable_pt_lim_ext _ _ _ _ (fun s => eq_sym (Q_is (moved z 1 s) eq_refl))
      (D 1%nat 1%nat ltac:(lia) ltac:(lia))).
  - rewrite (entry_in_plane 1 J eq_refl). ring.
Qed.
