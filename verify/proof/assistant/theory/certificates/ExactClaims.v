(** A certificate for one H and a map that is a polynomial in h, symplectic as it stands, in the
    words of its file. *)

From Coq Require Import Reals QArith Qreals List Bool Lra Lia.
From AreaPreservation Require Import Sums Differential Rings Formulas Symplectic Identities RealFormulas RealNames OneHamiltonian RealMaps RealDefect RealClaims RealExact MapClaims.
Import ListNotations.
Local Open Scope R_scope.

Section ExactClaims.
  Context (v : vocabulary) (energy : formula) (x : certificate).
  Context (factors : list (list (nat * formula))) (checked : sound v energy x factors).
  Context (given : list R) (enough : length given = parameters v).
  Notation n := (of_degrees x).

  Theorem form_is_kept_exactly : forall d, short_series x d = true -> of_length x (S (known x)) = true ->
    forall z, inside v given z -> forall h, exists J,
      has_jacobian n (fun c y => in_powers h (coefficients_at v x given y c)) z J /\
      forall a b, (a < b)%nat -> (b < 2 * n)%nat -> defect_entry n J a b = 0.
  Proof.
    intros d short S z I h. exists (fun c a => polynomial_slope v given x z c a h). split.
    - intros c a Lc La. cbv beta.
      apply (derivable_pt_lim_ext (fun s => polynomial_map v given x c h (moved z a s))).
      + intro s. rewrite (series_is v x given enough S). reflexivity.
      + apply (polynomial_map_derivable v (sound_names _ _ _ _ checked) given enough x
          (sound_size _ _ _ _ checked) (sound_slopes _ _ _ _ checked) z I c a h La).
    - intros a b L Lb.
      exact (exactly_symplectic v energy x factors checked given enough d short z I h a b L Lb).
  Qed.

  (** In the plane: det J = 1. *)
  Theorem area_is_kept_exactly : forall d, short_series x d = true -> of_length x (S (known x)) = true ->
    n = 1%nat -> forall (P Q : R -> R -> R -> R) p q t,
    (forall h y, y 2%nat = t -> P h (y 0%nat) (y 1%nat) = in_powers h (coefficients_at v x given y 0)) ->
    (forall h y, y 2%nat = t -> Q h (y 0%nat) (y 1%nat) = in_powers h (coefficients_at v x given y 1)) ->
    inside v given (at_point [p; q; t]) -> forall h, has_determinant (P h) (Q h) p q 1.
  Proof.
    intros d short S N P Q p q t P_is Q_is I h. set (z := at_point [p; q; t]).
    destruct (form_is_kept_exactly d short S z I h) as [J [D E]].
    specialize (E 0%nat 1%nat ltac:(lia) ltac:(lia)). rewrite N in D, E.
    replace 1 with (defect_entry 1 J 0 1 + 1) by (rewrite E; ring).
    refine (plane_determinant _ _ _ z J _ _ D); intros y Y; [apply P_is|apply Q_is]; exact Y.
  Qed.
End ExactClaims.
