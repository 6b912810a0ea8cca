(** n degrees of freedom: the determinant of the Jacobian of a step of lie_eta, for every H and
    every eta. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow LieScheme Step Determinants Values Volume.
Local Open Scope nat_scope.

Section Determinant.
  Context (K : differential_ring) (s : system K) (eta : nat).
  Add Ring determinant : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (degrees s).
  Notation d := by_coordinate.
  Notation power := (power K).
  Notation volume := (volume K s eta).
  Notation first_coefficient := (first_coefficient K s eta).

  (** The Jacobian of a step: row c, column a holds the slope of z_c' along z_a. *)
  Definition jacobian (h : K) (c a : nat) : K := d a (new_value K s eta h c).

  (** det J is the value at h of the series of its coefficients. *)
  Lemma determinant_has_value : forall h, is_constant K h ->
    has_value K h volume (determinant (2 * n) (jacobian h)).
  Proof.
    intros h C. apply value_of_determinant. intros c a _ _. exists (S eta). split.
    - intros k L. unfold jacobian_series, scheme_series.
      rewrite (proj2 (Nat.leb_gt _ _)) by lia. apply derivation_zero.
    - unfold jacobian, new_value, partial_sum. rewrite derivation_total.
      apply total_same. intros k L.
      unfold jacobian_series, scheme_series. rewrite (proj2 (Nat.leb_le _ _)) by lia.
      rewrite derivation_mul, (power_constant K h k C). ring.
  Qed.

  (** In n degrees of freedom, a step of lie_eta: the coefficients of the rest do not depend on h
      and end. *)
  Theorem determinant_of_jacobian : exists m, ends K volume m /\
    forall h, is_constant K h -> determinant (2 * n) (jacobian h)
      == one + power h (S eta) * first_coefficient
         + power h (S (S eta)) * partial_sum K h (fun k => volume (S (S eta) + k)%nat) m.
  Proof.
    destruct (determinant_has_value zero) as [m [E _]]; [exact (derivation_zero K)|].
    exists m. split; [exact E|]. intros h C.
    rewrite (value_unique K h volume _ m (determinant_has_value h C) E).
    rewrite <- (partial_sum_ends K h volume m (S (S eta) + m)) by (try exact E; lia).
    rewrite partial_sum_first by (first [lia | intros [|k] Lk; [lia|apply volume_below; lia]]).
    rewrite volume_at_0, volume_first. reflexivity.
  Qed.
End Determinant.
