(** Functions of a smooth function: exponential, sine, cosine, inverse and power are smooth. *)

From Coq Require Import Reals Lra Lia PeanoNat List.
From AreaPreservation Require Import Differential Slopes Rings Smooth.
Import ListNotations.
Local Open Scope R_scope.

(** The derivatives of phi_k(F) G: its slope is phi_(k+1)(F) F' G + phi_k(F) G'. *)
Fixpoint composite_family (phi : nat -> R -> R) (F : list nat -> point -> R)
    (k : nat) (G : list nat -> point -> R) (l : list nat) : point -> R :=
  match l with
  | [] => fun x => phi k (F [] x) * G [] x
  | i :: r => fun x =>
      composite_family phi F (S k) (product_family (fun m => F (i :: m)) G) r x
      + composite_family phi F k (fun m => G (i :: m)) r x
  end.

(** Every member of [phi] is the derivative of the one before, at all values of [f]. *)
Definition derivatives_at_values {N U} (phi : nat -> R -> R) (f : smooth N U) : Prop :=
  forall k x, U x -> derivable_pt_lim (phi k) (value f x) (phi (S k) (value f x)).

Lemma composite_is_family : forall N U phi (f : smooth N U) k G,
  derivatives_at_values phi f -> is_family N U G ->
  is_family N U (composite_family phi (family f) k G).
Proof.
  intros N U phi f k G D HG l. revert k G HG. induction l as [|i l IH]; intros k G HG x Hx.
  - refine (slopes_of_equal_slopes N _ x _ _ (slopes_of_product N _ _ x _ _
      (slopes_of_real_function N (phi k) _ _ x _ (family_slopes f [] x Hx) (D k x Hx))
      (HG [] x Hx)) _).
    intros i _. simpl. unfold value. ring.
  - apply slopes_of_sum; apply IH;
      auto using derivative_is_family, product_is_family, family_slopes.
Qed.

Definition smooth_compose {N U} (phi : nat -> R -> R) (f : smooth N U)
    (D : derivatives_at_values phi f) : smooth N U := {|
  family := composite_family phi (family f) 0 (constant_family 1);
  family_slopes := composite_is_family N U phi f 0 _ D (constant_is_family N U 1) |}.

Lemma value_compose : forall N U phi (f : smooth N U) D x,
  value (smooth_compose phi f D) x = phi O (value f x).
Proof. intros. apply Rmult_1_r. Qed.

(** The chain rule. *)
Lemma derivation_compose : forall N U phi (f : smooth N U) D i x,
  value (smooth_derivative i (smooth_compose phi f D)) x
  = phi 1%nat (value f x) * value (smooth_derivative i f) x.
Proof.
  intros N U phi f D i x. unfold value; simpl; unfold derivative_family.
  destruct (Nat.ltb i N); simpl; ring.
Qed.

(** The exponential. *)
Lemma exp_derivatives : forall N U (f : smooth N U), derivatives_at_values (fun _ => exp) f.
Proof. intros N U f k x _. apply derivable_pt_lim_exp. Qed.

Definition smooth_exp {N U} (f : smooth N U) : smooth N U :=
  smooth_compose _ f (exp_derivatives N U f).

Lemma value_exp : forall N U (f : smooth N U) x, value (smooth_exp f) x = exp (value f x).
Proof. intros. apply (value_compose N U (fun _ => exp)). Qed.

Lemma derivation_exp : forall N U (f : smooth N U) i,
  smooth_same (smooth_derivative i (smooth_exp f))
    (smooth_mul (smooth_exp f) (smooth_derivative i f)).
Proof.
  intros N U f i x _. etransitivity; [apply derivation_compose|].
  symmetry. exact (f_equal (fun t => t * _) (value_exp N U f x)).
Qed.

(** Sine and cosine: the derivatives of the sine repeat after two, with the sign turned. *)
Fixpoint sine_derivative (k : nat) : R -> R :=
  match k with
  | O => sin
  | S O => cos
  | S (S m) => fun y => - sine_derivative m y
  end.

Lemma sine_derivative_step : forall k y,
  derivable_pt_lim (sine_derivative k) y (sine_derivative (S k) y) /\
  derivable_pt_lim (sine_derivative (S k)) y (sine_derivative (S (S k)) y).
Proof.
  intros k y. induction k as [|k [IH IH']].
  - split; [apply derivable_pt_lim_sin|apply derivable_pt_lim_cos].
  - split; [assumption|]. exact (derivable_pt_lim_opp (sine_derivative k) y _ IH).
Qed.

Lemma sine_derivatives : forall N U (f : smooth N U), derivatives_at_values sine_derivative f.
Proof. intros N U f k x _. apply sine_derivative_step. Qed.

Lemma cosine_derivatives : forall N U (f : smooth N U),
  derivatives_at_values (fun k => sine_derivative (S k)) f.
Proof. intros N U f k x _. apply (sine_derivative_step k). Qed.

Definition smooth_sin {N U} (f : smooth N U) : smooth N U :=
  smooth_compose _ f (sine_derivatives N U f).
Definition smooth_cos {N U} (f : smooth N U) : smooth N U :=
  smooth_compose _ f (cosine_derivatives N U f).

Lemma value_sin : forall N U (f : smooth N U) x, value (smooth_sin f) x = sin (value f x).
Proof. intros. apply (value_compose N U sine_derivative). Qed.

Lemma value_cos : forall N U (f : smooth N U) x, value (smooth_cos f) x = cos (value f x).
Proof. intros. apply (value_compose N U (fun k => sine_derivative (S k))). Qed.

Lemma derivation_sin : forall N U (f : smooth N U) i,
  smooth_same (smooth_derivative i (smooth_sin f))
    (smooth_mul (smooth_cos f) (smooth_derivative i f)).
Proof.
  intros N U f i x _. etransitivity; [apply derivation_compose|].
  symmetry. exact (f_equal (fun t => t * _) (value_cos N U f x)).
Qed.

Lemma derivation_cos : forall N U (f : smooth N U) i,
  smooth_same (smooth_derivative i (smooth_cos f))
    (smooth_mul (smooth_opp (smooth_sin f)) (smooth_derivative i f)).
Proof.
  intros N U f i x _. etransitivity; [apply derivation_compose|].
  symmetry. exact (f_equal (fun t => - t * _) (value_sin N U f x)).
Qed.

(** The inverse of a function without zeros. *)
Fixpoint inverse_coefficient (k : nat) : R :=
  match k with
  | O => 1
  | S m => - INR (S m) * inverse_coefficient m
  end.

Definition inverse_derivative (k : nat) (y : R) : R := inverse_coefficient k * (/ y) ^ S k.

Lemma inverse_derivative_step : forall k y, y <> 0 ->
  derivable_pt_lim (inverse_derivative k) y (inverse_derivative (S k) y).
Proof.
  intros k y Hy. unfold inverse_derivative.
  replace (inverse_coefficient (S k) * (/ y) ^ S (S k))
    with (inverse_coefficient k * (INR (S k) * (/ y) ^ pred (S k) * - (/ y * / y))).
  2: { cbn [inverse_coefficient pred pow]. ring. }
  apply (derivable_pt_lim_scal (fun y => (/ y) ^ S k)).
  apply (derivable_pt_lim_comp Rinv (fun z => z ^ S k)); [|apply derivable_pt_lim_pow].
  intros eps He.
  destruct (derivable_pt_lim_div (fun _ => 1) id y 0 1
    (derivable_pt_lim_const 1 y) (derivable_pt_lim_id y) Hy eps He) as (d & B).
  exists d. intros h H0 Hh. specialize (B h H0 Hh). unfold div_fct, id, Rsqr, Rdiv in B.
  rewrite !Rmult_1_l in B.
  replace (- (/ y * / y)) with ((0 * y - 1) * / (y * y)) by (field; assumption). exact B.
Qed.

Lemma inverse_derivatives : forall N U (f : smooth N U), (forall x, U x -> value f x <> 0) ->
  derivatives_at_values inverse_derivative f.
Proof. intros N U f H k x Hx. apply inverse_derivative_step. auto. Qed.

Definition smooth_inverse {N U} (f : smooth N U) (H : forall x, U x -> value f x <> 0) :
  smooth N U := smooth_compose _ f (inverse_derivatives N U f H).

Lemma value_inverse : forall N U (f : smooth N U) H x, value (smooth_inverse f H) x = / value f x.
Proof.
  intros. etransitivity; [apply (value_compose N U inverse_derivative)|].
  unfold inverse_derivative. simpl. ring.
Qed.

Lemma mul_inverse : forall N U (f : smooth N U) H,
  smooth_same (smooth_mul f (smooth_inverse f H)) (smooth_constant 1).
Proof.
  intros N U f H x Hx. etransitivity; [exact (f_equal (Rmult _) (value_inverse N U f H x))|].
  exact (Rinv_r _ (H x Hx)).
Qed.

Lemma derivation_inverse : forall N U (f : smooth N U) H i,
  smooth_same (smooth_derivative i (smooth_inverse f H))
    (smooth_mul (smooth_opp (smooth_mul (smooth_inverse f H) (smooth_inverse f H)))
      (smooth_derivative i f)).
Proof.
  intros N U f H i x _. etransitivity; [apply derivation_compose|].
  etransitivity; [|symmetry; exact (f_equal (fun t => - (t * t) * _) (value_inverse N U f H x))].
  unfold inverse_derivative. simpl. ring.
Qed.

(** The power of a positive function, its exponent any number. *)
Fixpoint power_coefficient (a : R) (k : nat) : R :=
  match k with
  | O => 1
  | S m => power_coefficient a m * (a - INR m)
  end.

Definition power_derivative (a : R) (k : nat) (y : R) : R :=
  power_coefficient a k * Rpower y (a - INR k).

Lemma power_derivatives : forall N U (f : smooth N U) a, (forall x, U x -> 0 < value f x) ->
  derivatives_at_values (power_derivative a) f.
Proof.
  intros N U f a H k x Hx. unfold power_derivative.
  replace (power_coefficient a (S k) * Rpower (value f x) (a - INR (S k)))
    with (power_coefficient a k * ((a - INR k) * Rpower (value f x) (a - INR k - 1))).
  - apply (derivable_pt_lim_scal (fun y => Rpower y (a - INR k))).
    apply derivable_pt_lim_power. auto.
  - rewrite S_INR. replace (a - (INR k + 1)) with (a - INR k - 1) by ring. simpl. ring.
Qed.

Definition smooth_power {N U} (f : smooth N U) (a : R) (H : forall x, U x -> 0 < value f x) :
  smooth N U := smooth_compose _ f (power_derivatives N U f a H).

Lemma value_power : forall N U (f : smooth N U) a H x,
  value (smooth_power f a H) x = Rpower (value f x) a.
Proof.
  intros. etransitivity; [apply (value_compose N U (power_derivative a))|].
  unfold power_derivative. simpl. rewrite Rminus_0_r. ring.
Qed.

Lemma derivation_power : forall N U (f : smooth N U) a H i,
  smooth_same (smooth_derivative i (smooth_power f a H))
    (smooth_mul (smooth_mul (smooth_constant a) (smooth_power f (a - 1) H))
      (smooth_derivative i f)).
Proof.
  intros N U f a H i x _. etransitivity; [apply derivation_compose|].
  etransitivity; [|symmetry; exact (f_equal (fun t => a * t * _) (value_power N U f (a - 1) H x))].
  unfold power_derivative. simpl. rewrite Rminus_0_r. ring.
Qed.

(** Where a smooth function is positive is open. *)
Lemma positive_is_open : forall N U (f : smooth N U), is_open N U ->
  is_open N (fun x => U x /\ 0 < value f x).
Proof.
  intros N U f HU x [Hx P]. destruct (HU x Hx) as (r & Hr & B).
  destruct (continuous_where_slopes N _ x _ (family_slopes f [] x Hx) (value f x) P)
    as (d & Hd & C).
  exists (Rmin r d). split; [now apply Rmin_pos|]. intros y Hy.
  pose proof (Rmin_l r d). pose proof (Rmin_r r d). split; [apply B; lra|].
  specialize (C y ltac:(lra)). apply Rabs_def2 in C. unfold value in *. lra.
Qed.
