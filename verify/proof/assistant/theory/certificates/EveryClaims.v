(** The theorems of a certificate for every H, in every ring of functions. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith List Bool Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor Bracket Formulas Calculation Identities Certified EveryHamiltonian.
Import ListNotations.
Local Open Scope nat_scope.

Notation form_of := (two_form (rational 0) opp).

(** The coefficient of h^m in the determinant of p' = sum P_k h^k, q' = sum Q_k h^k. *)
Definition determinant_coefficient {K : differential_ring} (P Q : nat -> K) (m : nat) : K :=
  total (S m) (fun k => bracket K (P k) (Q (m - k))).

(** The 2-form of elements that are the values of formulas. *)
Lemma value_of_form : forall (K : rational_ring) (names : list K) w (v : nat -> nat -> K),
  (forall i j, value_of names (w i j) = v i j) ->
  forall a b, value_of names (form_formula w a b) = form_of v a b.
Proof.
  intros K names w v E a b. unfold two_form. rewrite <- !E.
  destruct (a <? b); [reflexivity|]. destruct (b <? a); reflexivity.
Qed.

(** A certificate for the H of the family [e] that the check accepts. *)
Record sound_for_every (e : family_of_energies) (x : certificate) : Prop := {
  every_degrees : of_degrees x = energy_degrees e;
  every_slopes : slope_of_name x = slope_by_name e;
  every_known : has_slope x = known_slope e;
  every_energy : slope_of_energy x = slope_of_every e;
  every_named : slopes_named e = true;
  every_gaps : accepted x [] [] = true;
}.

Section EveryClaims.
  Context (e : family_of_energies) (x : certificate) (checked : sound_for_every e x).
  Context (K : differential_ring) (s : system K) (member : belongs s e).
  Add Ring every_claims : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.
  Notation n := (of_degrees x).
  Notation value f := (@value_of K (names_for_every K s e) f).

  Lemma every_meaning : interprets K s x (names_for_every K s e).
  Proof. destruct checked. apply every_interprets; assumption. Qed.

  Lemma every_sloped : all_have_slopes x = true.
  Proof. destruct checked as [_ _ _ _ _ A]. apply andb_prop in A. exact (proj1 A). Qed.

  Lemma every_gap : forall f, In f (flow_gaps x ++ defect_gaps x ++ primitive_gaps x) ->
    value f == zero.
  Proof.
    destruct checked as [_ _ _ _ _ A]. apply andb_prop in A.
    apply (calculated K _ [] _ []) with (2 := proj2 A). intros f [].
  Qed.

  (** The map agrees with the flow: its coefficients are D^k z / k!. *)
  Theorem every_agrees : forall k c, (k <= agreement x)%nat -> (c < 2 * n)%nat ->
    value (term x k c) == coefficient K s k (coordinate s c).
  Proof.
    apply (agrees_with_flow K s x _ every_meaning every_sloped).
    intros f F. apply every_gap, in_app_iff. left. exact F.
  Qed.

  Section OfMaps.
    (** Any map with these coefficients up to the last known one. *)
    Context (A : nat -> nat -> K).
    Context (is_so : forall k c, (k <= known x)%nat -> (c < 2 * n)%nat -> A k c == value (term x k c)).

    Lemma every_defect : forall m a b, (1 <= m <= known x)%nat -> (a < b)%nat -> (b < 2 * n)%nat ->
      defect_coefficient K s A m a b == value (expected x m a b).
    Proof.
      apply (defect_is_known K s x _ every_meaning every_sloped); [|exact is_so].
      intros f F. apply every_gap, in_app_iff. right. apply in_app_iff. left. exact F.
    Qed.

    Lemma every_defect_start : forall a b, defect_coefficient K s A 0 a b == canonical K s a b.
    Proof.
      intros a b. transitivity (pairs K s (A 0%nat) (A 0%nat) a b);
        [unfold defect_coefficient, paired; simpl; ring|].
      unfold canonical, pairs. rewrite (belongs_degrees _ _ member), <- (every_degrees e x checked).
      apply total_same. intros i Li.
      rewrite !is_so by lia. rewrite !every_agrees by lia. reflexivity.
    Qed.

    Theorem every_defect_before : forall r m a b, order x = Some r -> (1 <= m < r)%nat ->
      (r <= known x)%nat -> (a < b)%nat -> (b < 2 * n)%nat ->
      defect_coefficient K s A m a b == zero.
    Proof.
      intros r m a b E L M La Lb. rewrite every_defect by lia. unfold expected.
      rewrite E, (proj2 (Nat.eqb_neq m r)) by lia. apply rational_zero.
    Qed.

    Theorem every_defect_first : forall r a b, order x = Some r -> (1 <= r <= known x)%nat ->
      (a < b)%nat -> (b < 2 * n)%nat ->
      defect_coefficient K s A r a b == value (leading_entry x a b).
    Proof.
      intros r a b E L La Lb. rewrite every_defect by lia. unfold expected.
      rewrite E, Nat.eqb_refl. reflexivity.
    Qed.
  End OfMaps.

  (** The coefficients of h^0, h^1, ... in the new value of a coordinate, as elements. *)
  Definition elements_of (c : nat) : list K := nth c (map (map (fun f => value f)) (series x)) [].

  Lemma element_is : forall k c, value (term x k c) == nth k (elements_of c) zero.
  Proof.
    intros k c. unfold term, elements_of. change (@nil K) with (map (fun f => value f) []).
    rewrite (map_nth (map (fun f => value f))).
    destruct (Nat.lt_ge_cases k (length (nth c (series x) []))) as [L|L].
    - rewrite (nth_indep (map _ _) zero (value (Number 0))) by (rewrite map_length; exact L).
      rewrite (map_nth (fun f => value f)). reflexivity.
    - rewrite !nth_overflow by (rewrite ?map_length; exact L). apply rational_zero.
  Qed.

  Theorem elements_agree : forall k c, (k <= agreement x)%nat -> (c < 2 * n)%nat ->
    nth k (elements_of c) zero == coefficient K s k (coordinate s c).
  Proof. intros k c Lk Lc. rewrite <- element_is. apply every_agrees; assumption. Qed.

  (** In n degrees of freedom: of S = J^T Omega J - Omega, entry by entry. *)
  Theorem form_has_order : forall r, order x = Some r -> (1 <= r <= known x)%nat ->
    forall A : nat -> nat -> K, (forall k c, (k <= known x)%nat -> (c < 2 * n)%nat ->
      A k c == nth k (elements_of c) zero) ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    defect_coefficient K s A 0 a b == canonical K s a b /\
    (forall m, (1 <= m < r)%nat -> defect_coefficient K s A m a b == zero) /\
    defect_coefficient K s A r a b == value (leading_entry x a b).
  Proof.
    intros r E L A A_is a b La Lb.
    assert (is_so : forall k c, (k <= known x)%nat -> (c < 2 * n)%nat -> A k c == value (term x k c)).
    { intros k c Lk Lc. rewrite (A_is k c Lk Lc). symmetry. apply element_is. }
    split; [|split].
    - apply (every_defect_start A is_so).
    - intros m M. apply (every_defect_before A is_so r); assumption || lia.
    - apply (every_defect_first A is_so r); assumption.
  Qed.

  Lemma one_degree : degrees s = 1%nat -> n = 1%nat.
  Proof. intro P. rewrite (every_degrees e x checked), <- (belongs_degrees _ _ member). exact P. Qed.

  Lemma determinant_coefficient_is : degrees s = 1%nat -> forall (A : nat -> nat -> K) m,
    defect_coefficient K s A m 0 1
    == determinant_coefficient (fun k => A k 0%nat) (fun k => A k 1%nat) m.
  Proof. intros plane A m. apply total_same. intros k _. apply (pairs_in_plane K s plane). Qed.

  (** In the plane: of det J. *)
  Theorem determinant_has_order : degrees s = 1%nat ->
    forall r, order x = Some r -> (1 <= r <= known x)%nat ->
    forall P Q : nat -> K, (forall k, (k <= known x)%nat ->
      P k == nth k (elements_of 0) zero /\ Q k == nth k (elements_of 1) zero) ->
    determinant_coefficient P Q 0 == one /\
    (forall m, (1 <= m < r)%nat -> determinant_coefficient P Q m == zero) /\
    determinant_coefficient P Q r == value (leading_entry x 0 1).
  Proof.
    intros plane r E L P Q PQ. assert (N := one_degree plane).
    set (A := fun k c => match c with O => P k | _ => Q k end).
    assert (same_coefficient := determinant_coefficient_is plane A).
    change (fun k => A k 0%nat) with P in same_coefficient.
    change (fun k => A k 1%nat) with Q in same_coefficient.
    destruct (form_has_order r E L A) with (a := 0%nat) (b := 1%nat) as [start [before first]];
      [|lia|lia|].
    - intros k c Lk Lc. rewrite N in Lc. destruct c as [|[|c]]; [apply PQ, Lk|apply PQ, Lk|lia].
    - split; [|split].
      + rewrite <- same_coefficient, start. apply canonical_in_plane, plane.
      + intros m M. rewrite <- same_coefficient. apply before, M.
      + rewrite <- same_coefficient. exact first.
  Qed.

  (** L is the Lie derivative of G along the flow. *)
  Theorem every_primitive : forall w, primitive x = Some w ->
    forall a b, (a < b)%nat -> (b < 2 * n)%nat ->
    lie_derivative K s (fun a b => value (form_formula w a b)) a b == value (leading_entry x a b).
  Proof.
    intros w W. apply (primitive_is K s x _ every_meaning every_sloped w W).
    intros f F. apply every_gap, in_app_iff. right. apply in_app_iff. right. exact F.
  Qed.

  (** In the plane that is D G = L. *)
  Theorem every_potential : degrees s = 1%nat -> forall w, primitive x = Some w ->
    along_flow K s (value (w 0 1)%nat) == value (leading_entry x 0 1).
  Proof.
    intros P w W. assert (N := one_degree P).
    rewrite <- (every_primitive w W 0 1) by lia.
    unfold lie_derivative. rewrite P. simpl total. simpl Nat.add.
    change (value (form_formula w 0 1)) with (value (w 0 1)%nat).
    change (value (form_formula w 1 1)) with (@rational K 0).
    change (value (form_formula w 0 0)) with (@rational K 0).
    rewrite (rational_zero K), (derivations_commute K 0 1). ring.
  Qed.
End EveryClaims.
