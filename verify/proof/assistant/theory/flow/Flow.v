(** The flow of a Hamiltonian, and the canonical form that it keeps.

    Coordinates 0 .. n-1 are p, n .. 2n-1 are q, and 2n is the time t. D = d/dt + X is the derivation
    along the flow. A 2-form is its entries by two of the first 2n coordinates, at one t. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals.
Local Open Scope nat_scope.

(** n degrees of freedom, coordinates and a Hamiltonian. *)
Record system (K : differential_ring) := {
  degrees : nat;
  coordinate : nat -> K;
  hamiltonian : K;
  own_slope : forall i, i <= 2 * degrees -> same (by_coordinate i (coordinate i)) one;
  other_slope : forall i j, i <= 2 * degrees -> j <= 2 * degrees -> i <> j ->
    same (by_coordinate i (coordinate j)) zero;
}.

Arguments degrees {_}.
Arguments coordinate {_}.
Arguments hamiltonian {_}.

Section Flow.
  Context (K : differential_ring) (s : system K).
  Add Ring flow : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (degrees s).
  Notation H := (hamiltonian s).
  Notation d := by_coordinate.
  Notation z := (coordinate s).

  (** X f = sum_i H_(p_i) f_(q_i) - H_(q_i) f_(p_i). *)
  Definition along_field (f : K) : K :=
    total n (fun i => d i H * d (n + i)%nat f - d (n + i)%nat H * d i f).

  (** D f = f_t + X f. *)
  Definition along_flow (f : K) : K := d (2 * n)%nat f + along_field f.

  Definition form := nat -> nat -> K.

  (** dA /\ dB. *)
  Definition wedge (A B : K) : form := fun a b => d a A * d b B - d b A * d a B.

  (** The Lie derivative along the flow, whose components are q_i' = H_(p_i), p_i' = - H_(q_i). *)
  Definition lie_derivative (w : form) : form := fun a b =>
    along_flow (w a b)
    + total n (fun i => (d a (d i H) * w (n + i)%nat b - d a (d (n + i)%nat H) * w i b)
                      + (d b (d i H) * w a (n + i)%nat - d b (d (n + i)%nat H) * w a i)).

  (** sum_i dA_i /\ dB_(n+i): of the coordinates it is the canonical form. *)
  Definition pairs (A B : nat -> K) : form := fun a b =>
    total n (fun i => wedge (A i) (B (n + i)%nat) a b).

  #[export] Instance along_field_proper : Proper (same ==> same) along_field.
  Proof. intros x y E. apply total_same. intros i _. rewrite E. reflexivity. Qed.

  #[export] Instance along_flow_proper : Proper (same ==> same) along_flow.
  Proof. intros x y E. unfold along_flow. rewrite E. reflexivity. Qed.

  #[export] Instance wedge_proper : Proper (same ==> same ==> eq ==> eq ==> same) wedge.
  Proof. intros x x' E y y' F a a' <- b b' <-. unfold wedge. rewrite E, F. reflexivity. Qed.

  Lemma along_flow_add : forall f g, along_flow (f + g) == along_flow f + along_flow g.
  Proof.
    intros f g. unfold along_flow, along_field. rewrite derivation_add.
    rewrite (total_same K n _ (fun i => (d i H * d (n + i)%nat f - d (n + i)%nat H * d i f)
      + (d i H * d (n + i)%nat g - d (n + i)%nat H * d i g))).
    - rewrite total_add. ring.
    - intros i _. rewrite !derivation_add. ring.
  Qed.

  Lemma along_flow_mul : forall f g, along_flow (f * g) == along_flow f * g + f * along_flow g.
  Proof.
    intros f g. unfold along_flow, along_field. rewrite derivation_mul.
    rewrite (total_same K n _ (fun i => g * (d i H * d (n + i)%nat f - d (n + i)%nat H * d i f)
      + f * (d i H * d (n + i)%nat g - d (n + i)%nat H * d i g))).
    - rewrite total_add, !total_scaled. ring.
    - intros i _. rewrite !derivation_mul. ring.
  Qed.

  Lemma along_flow_constant : forall c, is_constant K c -> along_flow c == zero.
  Proof.
    intros c C. unfold along_flow, along_field. rewrite (C _).
    rewrite total_zero; [ring|]. intros i _. rewrite !(C _). ring.
  Qed.

  Lemma along_flow_rational : forall a, along_flow (rational a) == zero.
  Proof. intro a. apply along_flow_constant. intro i. apply derivation_rational. Qed.

  Lemma along_flow_zero : along_flow zero == zero.
  Proof.
    transitivity (along_flow (rational 0)); [|apply along_flow_rational].
    apply along_flow_proper. symmetry. apply rational_zero.
  Qed.

  Lemma along_flow_scaled : forall c f, is_constant K c -> along_flow (c * f) == c * along_flow f.
  Proof. intros c f C. rewrite along_flow_mul, along_flow_constant by exact C. ring. Qed.

  Lemma along_flow_total : forall m f,
    along_flow (total m f) == total m (fun k => along_flow (f k)).
  Proof.
    intros m f. induction m as [|m IH]; simpl; [apply along_flow_zero|].
    rewrite along_flow_add, IH. reflexivity.
  Qed.

  (** A slope and the flow, exchanged. *)
  Lemma slope_along_flow : forall a f, d a (along_flow f) == along_flow (d a f)
    + total n (fun i => d a (d i H) * d (n + i)%nat f - d a (d (n + i)%nat H) * d i f).
  Proof.
    intros a f. unfold along_flow, along_field.
    rewrite derivation_add, derivation_total, (derivations_commute K a).
    rewrite (total_same K n (fun k => d a (d k H * d (n + k)%nat f - d (n + k)%nat H * d k f))
      (fun i => (d i H * d (n + i)%nat (d a f) - d (n + i)%nat H * d i (d a f))
        + (d a (d i H) * d (n + i)%nat f - d a (d (n + i)%nat H) * d i f))).
    - rewrite total_add. ring.
    - intros i _. rewrite derivation_sub, !derivation_mul.
      rewrite (derivations_commute K a (n + i)%nat f), (derivations_commute K a i f). ring.
  Qed.

  (** The Lie derivative of dA /\ dB is d(DA) /\ dB + dA /\ d(DB). *)
  Theorem lie_derivative_of_wedge : forall A B a b,
    lie_derivative (wedge A B) a b == wedge (along_flow A) B a b + wedge A (along_flow B) a b.
  Proof.
    intros A B a b. unfold lie_derivative.
    unfold wedge at 1. unfold Rings.sub at 1.
    assert (difference : forall x y, along_flow (x - y) == along_flow x - along_flow y).
    { intros x y. apply (cancel K _ _ (along_flow y)). rewrite <- along_flow_add.
      transitivity (along_flow x); [apply along_flow_proper; ring|ring]. }
    rewrite difference, !along_flow_mul. unfold wedge.
    rewrite !slope_along_flow.
    rewrite (total_same K n _ (fun i =>
      (d b B * (d a (d i H) * d (n + i)%nat A - d a (d (n + i)%nat H) * d i A)
       - d a B * (d b (d i H) * d (n + i)%nat A - d b (d (n + i)%nat H) * d i A))
      + (d a A * (d b (d i H) * d (n + i)%nat B - d b (d (n + i)%nat H) * d i B)
         - d b A * (d a (d i H) * d (n + i)%nat B - d a (d (n + i)%nat H) * d i B)))).
    - rewrite total_of_four. ring.
    - intros i _. ring.
  Qed.

  Lemma lie_derivative_same : forall v w a b, (a < 2 * n)%nat -> (b < 2 * n)%nat ->
    (forall a b, (a < 2 * n)%nat -> (b < 2 * n)%nat -> v a b == w a b) ->
    lie_derivative v a b == lie_derivative w a b.
  Proof.
    intros v w a b La Lb E. unfold lie_derivative. rewrite (E a b La Lb).
    rewrite (total_same K n _ (fun i =>
      (d a (d i H) * w (n + i)%nat b - d a (d (n + i)%nat H) * w i b)
      + (d b (d i H) * w a (n + i)%nat - d b (d (n + i)%nat H) * w a i))); [reflexivity|].
    intros i L. rewrite (E (n + i)%nat b), (E i b), (E a (n + i)%nat), (E a i) by lia. reflexivity.
  Qed.

  Lemma lie_derivative_total : forall m (w : nat -> form) a b,
    lie_derivative (fun a b => total m (fun k => w k a b)) a b
    == total m (fun k => lie_derivative (w k) a b).
  Proof.
    intros m w a b. unfold lie_derivative.
    rewrite along_flow_total, (total_add K m (fun k => along_flow (w k a b))).
    apply add_extends; [reflexivity|].
    rewrite (total_swap K m). apply total_same. intros i _.
    rewrite !total_add, !total_sub, !total_scaled. reflexivity.
  Qed.

  Lemma lie_derivative_zero : forall a b, lie_derivative (fun _ _ => zero) a b == zero.
  Proof.
    intros a b. unfold lie_derivative. rewrite along_flow_zero, total_zero; [ring|].
    intros i _. ring.
  Qed.

  Lemma lie_derivative_scaled : forall c w a b, is_constant K c ->
    lie_derivative (fun a b => c * w a b) a b == c * lie_derivative w a b.
  Proof.
    intros c w a b C. unfold lie_derivative. rewrite along_flow_scaled by exact C.
    rewrite (total_same K n _ (fun i => c *
      ((d a (d i H) * w (n + i)%nat b - d a (d (n + i)%nat H) * w i b)
      + (d b (d i H) * w a (n + i)%nat - d b (d (n + i)%nat H) * w a i)))).
    - rewrite total_scaled. ring.
    - intros i _. ring.
  Qed.

  Lemma lie_derivative_of_pairs : forall A B a b,
    lie_derivative (pairs A B) a b
    == pairs (fun i => along_flow (A i)) B a b + pairs A (fun i => along_flow (B i)) a b.
  Proof.
    intros A B a b. unfold pairs. rewrite lie_derivative_total, <- total_add.
    apply total_same. intros i _. apply lie_derivative_of_wedge.
  Qed.
End Flow.
