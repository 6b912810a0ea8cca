(** The coefficients of det J of lie_eta, for every H in n degrees of freedom: as the flow keeps the
    volume, those of h^1 .. h^eta vanish, and the next is - div(D^eta f) / (eta+1)!. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor LieScheme Step Determinants Series.
Local Open Scope nat_scope.

Section Volume.
  Context (K : differential_ring) (s : system K) (eta : nat).
  Add Ring volume : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Add Ring volume_series : (ring_laws (series K))
    (setoid (same_equivalence (series K)) (operations_extend (series K))).
  Local Open Scope ring_of_functions.

  Notation n := (degrees s).
  Notation d := by_coordinate.
  Notation z := (coordinate s).
  Notation D := (along_flow K s).
  Notation coefficient := (coefficient K s).

  (** The field f, z' = f. *)
  Definition field (c : nat) : K := D (z c).

  Lemma field_is : forall i, (i < n)%nat ->
    field i == - d (n + i)%nat (hamiltonian s) /\ field (n + i) == d i (hamiltonian s).
  Proof. exact (along_flow_coordinate K s). Qed.

  (** div(D^eta f), of D^eta of each component. *)
  Definition divergence : K := total (2 * n) (fun c => d c (iterated K s eta (field c))).

  Definition first_coefficient : K := - (inverse_factorial K (S eta) * divergence).

  (** The Jacobian of a step by powers of h: row c, column a holds the slope of z_c' along z_a. *)
  Definition jacobian_series (c a : nat) : series K := fun k => d a (scheme_series K s eta k c).

  (** The coefficients of det J. *)
  Definition volume : series K := determinant (2 * n) jacobian_series.

  Lemma total_pairs : forall f : nat -> K,
    total (2 * n) f == total n (fun i => f i + f (n + i)%nat).
  Proof.
    intro f. replace (2 * n)%nat with (n + n)%nat by lia. rewrite total_split, total_add.
    reflexivity.
  Qed.

  (** A slope and the flow, exchanged, with the slopes of the field. *)
  Lemma slope_and_field : forall a f,
    d a (D f) == D (d a f) + total (2 * n) (fun b => d a (field b) * d b f).
  Proof.
    intros a f. rewrite slope_along_flow, total_pairs. apply add_extends; [reflexivity|].
    apply total_same. intros i L. destruct (field_is i L) as [-> ->]. rewrite derivation_opp. ring.
  Qed.

  (** The field of a Hamiltonian has no divergence. *)
  Lemma field_without_divergence : total (2 * n) (fun a => d a (field a)) == zero.
  Proof.
    rewrite total_pairs. apply total_zero. intros i L. destruct (field_is i L) as [-> ->].
    rewrite derivation_opp, (derivations_commute K i). ring.
  Qed.

  Lemma jacobian_series_at_0 : forall c a, (c < 2 * n)%nat -> (a < 2 * n)%nat ->
    jacobian_series c a O == identity c a.
  Proof.
    intros c a Lc La. unfold jacobian_series, scheme_series, flow_series, identity. simpl.
    destruct (Nat.eqb_spec c a) as [->|N]; [apply own_slope|apply other_slope]; lia.
  Qed.

  (** d/dh - D, which is 0 on the flow itself. *)
  Definition off_flow (f : series K) : series K := fun k => slope_in_h K f k - D (f k).

  Lemma off_flow_is_derivation : derivation (series K) off_flow.
  Proof.
    assert (D_is : derivation K D).
    { split; [apply along_flow_proper|apply along_flow_add|apply along_flow_mul]. }
    split; intros f g.
    - intros E k. unfold off_flow, slope_in_h. rewrite (E (S k)), (E k). reflexivity.
    - intro k. unfold off_flow, slope_in_h. simpl. rewrite along_flow_add. ring.
    - intro k. unfold off_flow. simpl.
      rewrite product_slope_in_h, (product_derived K D D_is).
      transitivity (convolution (fun l => slope_in_h K f l + - one * D (f l)) g k
        + convolution (fun l => slope_in_h K g l + - one * D (g l)) f k).
      + rewrite !product_add_left, !product_scaled.
        rewrite !(product_commutes K k f). ring.
      + rewrite (product_commutes K k f).
        apply add_extends; apply product_same; intro l; try reflexivity; ring.
  Qed.

  (** h^eta, and what the scheme lacks of the flow from there on. *)
  Definition last_power : series K := fun k => if (k =? eta)%nat then one else zero.

  Definition lacking (c a : nat) : series K := number (d a (D (coefficient eta (z c)))).

  (** Off the flow a column is a combination of the columns, but for what is lacking. *)
  Lemma jacobian_off_flow : forall c a, off_flow (jacobian_series c a)
    == one * total (2 * n) (fun b => (number (d a (field b)) : series K) * jacobian_series c b)
       + - last_power * lacking c a.
  Proof.
    intros c a. transitivity (total (2 * n) (fun b => (number (d a (field b)) : series K)
      * jacobian_series c b) - lacking c a * last_power); [|ring].
    intro k. change (slope_in_h K (jacobian_series c a) k - D (jacobian_series c a k)
      == total (2 * n) (fun b => (number (d a (field b)) : series K) * jacobian_series c b) k
        - convolution (lacking c a) last_power k).
    rewrite coefficient_of_total. unfold slope_in_h, lacking. rewrite product_of_number.
    unfold last_power, jacobian_series.
    rewrite (total_same K (2 * n) _ (fun b => d a (field b) * d b (scheme_series K s eta k c))) by
      (intros b _; simpl; apply product_of_number).
    apply (cancel K _ _ (D (d a (scheme_series K s eta k c)))).
    transitivity (whole (S k) * d a (scheme_series K s eta (S k) c)); [ring|].
    transitivity (d a (D (scheme_series K s eta k c))
      - d a (D (coefficient eta (z c))) * (if (k =? eta)%nat then one else zero));
      [|rewrite slope_and_field; ring].
    assert (none : d a (D zero) == zero).
    { rewrite (along_flow_zero K s). apply derivation_zero. }
    unfold scheme_series, flow_series.
    destruct (Nat.eqb_spec k eta) as [->|N].
    - rewrite (proj2 (Nat.leb_gt _ _)), (proj2 (Nat.leb_le _ _)), derivation_zero by lia. ring.
    - destruct (Nat.leb_spec k eta) as [L|L].
      + rewrite (proj2 (Nat.leb_le _ _)) by lia. rewrite along_flow_coefficient.
        unfold whole. rewrite derivation_mul, derivation_rational. ring.
      + rewrite (proj2 (Nat.leb_gt _ _)), derivation_zero, none by lia. ring.
  Qed.

  (** det J with what is lacking put for a column, one after the other. *)
  Definition volume_lacking : series K := total (2 * n) (fun a =>
    determinant (2 * n) (with_column jacobian_series a (fun c => lacking c a))).

  (** Liouville: off the flow det J changes by the divergence of the field, which is 0, but for
      what is lacking. *)
  Lemma volume_off_flow : off_flow volume == - (last_power * volume_lacking).
  Proof.
    unfold volume. rewrite (derivation_of_determinant (series K) off_flow) by
      exact off_flow_is_derivation.
    rewrite (total_same (series K) (2 * n) _ (fun a =>
      volume * (number (d a (field a)) : series K) - last_power * determinant (2 * n)
        (with_column jacobian_series a (fun c => lacking c a)))).
    - rewrite total_sub, !total_scaled.
      assert (none : total (2 * n) (fun a => number (d a (field a)) : series K) == zero).
      { intro k. rewrite coefficient_of_total. destruct k as [|k].
        - exact field_without_divergence.
        - apply total_zero. reflexivity. }
      rewrite none. unfold volume_lacking. ring.
    - intros a L.
      rewrite (determinant_same (series K) (2 * n) _ (with_column jacobian_series a (fun c =>
        one * total (2 * n) (fun b => (number (d a (field b)) : series K) * jacobian_series c b)
        + - last_power * lacking c a))).
      + rewrite determinant_linear, determinant_of_columns by exact L. unfold volume. ring.
      + intros r c _ _. unfold with_column. destruct (c =? a)%nat; [|reflexivity].
        apply jacobian_off_flow.
  Qed.

  (** D v_m = (m + 1) v_(m+1) for the coefficients v_m of det J, before the last power. *)
  Lemma next_coefficient : forall m, (m <= eta)%nat -> D (volume m) == zero ->
    whole (S m) * volume (S m) == if (m =? eta)%nat then - volume_lacking O else zero.
  Proof.
    intros m L E. assert (F := volume_off_flow m). unfold off_flow in F at 1. simpl in F.
    rewrite (product_below K eta m) in F by (try exact L; intros k Lk; unfold last_power;
      rewrite (proj2 (Nat.eqb_neq _ _)) by lia; reflexivity).
    apply (cancel K _ _ (- D (volume m))). transitivity (slope_in_h K volume m - D (volume m));
      [unfold slope_in_h; ring|].
    rewrite F, E. destruct (m =? eta)%nat; [|ring].
    unfold last_power. rewrite Nat.eqb_refl. ring.
  Qed.

  Theorem volume_at_0 : volume O == one.
  Proof.
    unfold volume. rewrite determinant_at_0. apply determinant_of_identity.
    intros c a Lc La. apply jacobian_series_at_0; assumption.
  Qed.

  Lemma along_flow_one : D one == zero.
  Proof. rewrite <- rational_one. apply along_flow_rational. Qed.

  (** The coefficients of h^1 .. h^eta in det J vanish. *)
  Theorem volume_below : forall m, (S m <= eta)%nat -> volume (S m) == zero.
  Proof.
    induction m as [|m IH]; intro L; eapply no_torsion; rewrite next_coefficient by
      (first [lia | rewrite volume_at_0; apply along_flow_one
             | rewrite IH by lia; apply along_flow_zero]);
      rewrite (proj2 (Nat.eqb_neq _ _)) by lia; reflexivity.
  Qed.

  Lemma iterated_flow : forall k f, iterated K s (S k) f == iterated K s k (D f).
  Proof. induction k as [|k IH]; intro f; [reflexivity|]. simpl. rewrite <- IH. reflexivity. Qed.

  Lemma volume_lacking_at_0 : volume_lacking O
    == whole (S eta) * (inverse_factorial K (S eta) * divergence).
  Proof.
    unfold volume_lacking, divergence. rewrite coefficient_of_total, <- !total_scaled.
    apply total_same. intros a L. rewrite determinant_at_0.
    rewrite (determinant_same K (2 * n) _ (with_column (fun c b => jacobian_series c b O) a
      (fun c => d a (D (coefficient eta (z c)))))) by
      (intros r c _ _; unfold with_column; destruct (c =? a)%nat; reflexivity).
    rewrite determinant_of_one_column by (try exact L; exact jacobian_series_at_0).
    rewrite along_flow_coefficient, coefficient_is, iterated_flow. unfold field.
    unfold whole, inverse_factorial. rewrite !derivation_mul, !derivation_rational. ring.
  Qed.

  (** The coefficient of h^(eta+1). *)
  Theorem volume_first : volume (S eta) == first_coefficient.
  Proof.
    assert (still : forall m, (m <= eta)%nat -> D (volume m) == zero).
    { intros [|m] L; [rewrite volume_at_0; apply along_flow_one|].
      rewrite volume_below by exact L. apply along_flow_zero. }
    assert (F := next_coefficient eta (le_n eta) (still eta (le_n eta))).
    rewrite Nat.eqb_refl, volume_lacking_at_0 in F.
    transitivity (whole (S eta) * fraction (S eta) * volume (S eta));
      [rewrite whole_fraction; ring|].
    transitivity (fraction (S eta) * (whole (S eta) * volume (S eta))); [ring|]. rewrite F.
    transitivity (- (whole (S eta) * fraction (S eta)
      * (inverse_factorial K (S eta) * divergence))); [ring|].
    rewrite whole_fraction. unfold first_coefficient. ring.
  Qed.
End Volume.
