(** A certificate for every H: its names are the coordinates and derivatives of H. *)

From Coq Require Import Setoid Morphisms Ring Ring_theory QArith List Permutation Bool Lia.
From AreaPreservation Require Import Rings Totals Flow Taylor Formulas Identities Certified.
Import ListNotations.
Local Open Scope nat_scope.

(** The derivative of f by all coordinates of a list. *)
Definition derived {K : differential_ring} (l : list nat) (f : K) : K :=
  fold_right by_coordinate f l.

Fixpoint inserted (a : nat) (l : list nat) : list nat :=
  match l with
  | [] => [a]
  | b :: r => if a <=? b then a :: l else b :: inserted a r
  end.

Fixpoint equal_lists (l m : list nat) : bool :=
  match l, m with
  | [], [] => true
  | a :: l', b :: m' => (a =? b) && equal_lists l' m'
  | _, _ => false
  end.

Fixpoint position (l : list nat) (known : list (list nat)) : option nat :=
  match known with
  | [] => None
  | m :: r => if equal_lists l m then Some O else option_map S (position l r)
  end.

(** Which H: with time or not, T(p) + V(q) or any; and the derivatives that have names. *)
Record family_of_energies := {
  energy_degrees : nat;
  timed : bool;
  separable : bool;
  named_derivatives : list (list nat);
}.

Section Naming.
  Context (e : family_of_energies).
  Notation n := (energy_degrees e).

  (** Whether the derivative is 0 for each such H. *)
  Definition is_zero (l : list nat) : bool :=
    (negb (timed e) && existsb (Nat.eqb (2 * n)) l)
    || (separable e && existsb (fun a => a <? n) l
        && existsb (fun a => (n <=? a) && (a <? 2 * n)) l).

  Definition name_of (l : list nat) : option formula :=
    if is_zero l then Some (Number 0)
    else option_map (fun j => Name (Pos.of_succ_nat (2 * n + 1 + j)))
           (position l (named_derivatives e)).

  Definition slope_by_name (a : nat) (k : positive) : formula :=
    let j := pred (Pos.to_nat k) in
    if j <=? 2 * n then Number (if j =? a then 1 else 0)
    else match nth_error (named_derivatives e) (j - (2 * n + 1)) with
         | None => Number 0
         | Some l => match name_of (inserted a l) with Some f => f | None => Number 0 end
         end.

  Definition known_slope (k : positive) : bool :=
    let j := pred (Pos.to_nat k) in
    (j <=? 2 * n)
    || match nth_error (named_derivatives e) (j - (2 * n + 1)) with
       | None => true
       | Some l => forallb (fun a => match name_of (inserted a l) with
                                     | Some _ => true | None => false end) (seq 0 (2 * n + 1))
       end.

  Definition slope_of_every (a : nat) : formula :=
    match name_of [a] with Some f => f | None => Number 0 end.

  Definition slopes_named : bool :=
    forallb (fun a => match name_of [a] with Some _ => true | None => false end) (seq 0 (2 * n)).
End Naming.

(** Which H the family has. *)
Record belongs {K : differential_ring} (s : system K) (e : family_of_energies) : Prop := {
  belongs_degrees : degrees s = energy_degrees e;
  belongs_still : timed e = false ->
    same (by_coordinate (2 * degrees s) (hamiltonian s)) zero;
  belongs_parts : separable e = true -> forall i j, i < degrees s -> j < degrees s ->
    same (by_coordinate i (by_coordinate (degrees s + j) (hamiltonian s))) zero;
}.

Section EveryHamiltonian.
  Context (K : differential_ring) (s : system K) (e : family_of_energies) (member : belongs s e).
  Add Ring every_hamiltonian : (ring_laws K) (setoid (same_equivalence K) (operations_extend K)).
  Local Open Scope ring_of_functions.

  Notation n := (energy_degrees e).
  Notation H := (hamiltonian s).

  Definition names_for_every : list K :=
    map (coordinate s) (seq 0 (2 * n + 1)) ++ map (fun l => derived l H) (named_derivatives e).

  Lemma derived_same : forall l (f g : K), f == g -> derived l f == derived l g.
  Proof. induction l as [|a l IH]; intros f g E; simpl; [exact E|]. rewrite (IH f g E). reflexivity. Qed.

  Lemma derived_zero : forall l, derived l (@zero K) == zero.
  Proof. induction l as [|a l IH]; simpl; [reflexivity|]. rewrite IH. apply derivation_zero. Qed.

  Lemma derived_permuted : forall l m (f : K), Permutation l m -> derived l f == derived m f.
  Proof.
    intros l m f P. induction P; simpl.
    - reflexivity.
    - rewrite IHP. reflexivity.
    - apply derivations_commute.
    - rewrite IHP1. exact IHP2.
  Qed.

  Lemma inserted_permutes : forall a l, Permutation (inserted a l) (a :: l).
  Proof.
    intros a l. induction l as [|b l IH]; simpl; [reflexivity|].
    destruct (a <=? b); [reflexivity|]. rewrite IH. apply perm_swap.
  Qed.

  Lemma derived_inserted : forall a l (f : K), derived (inserted a l) f == by_coordinate a (derived l f).
  Proof. intros a l f. apply (derived_permuted _ (a :: l)), inserted_permutes. Qed.

  Lemma derived_last : forall l a (f : K), In a l -> exists r,
    derived l f == derived r (by_coordinate a f) /\ (forall b, In b l -> b <> a -> In b r).
  Proof.
    intros l a f I. apply in_split in I. destruct I as [u [v ->]]. exists (u ++ v). split.
    - rewrite (derived_permuted _ ((u ++ v) ++ [a])).
      + unfold derived. rewrite fold_right_app. reflexivity.
      + rewrite <- app_assoc. apply Permutation_app_head, Permutation_cons_append.
    - intros b Ib N. apply in_app_iff in Ib. apply in_app_iff.
      destruct Ib as [Ib|[E|Ib]]; [left; exact Ib|congruence|right; exact Ib].
  Qed.

  Lemma zero_derivatives : forall l, is_zero e l = true -> derived l H == zero.
  Proof.
    intros l E. unfold is_zero in E. apply orb_prop in E. destruct E as [E|E].
    - apply andb_prop in E. destruct E as [T E]. apply existsb_exists in E.
      destruct E as [a [I A]]. apply Nat.eqb_eq in A. subst a.
      destruct (derived_last l _ H I) as [r [-> _]].
      rewrite (derived_same r _ zero); [apply derived_zero|].
      rewrite <- (belongs_degrees _ _ member). apply (belongs_still _ _ member).
      destruct (timed e); [discriminate|reflexivity].
    - rewrite !andb_true_iff in E. destruct E as [[Sep P] Q].
      apply existsb_exists in P. destruct P as [i [Ii Li]]. apply Nat.ltb_lt in Li.
      apply existsb_exists in Q. destruct Q as [j [Ij Lj]].
      apply andb_prop in Lj. destruct Lj as [Lj Mj].
      apply Nat.leb_le in Lj. apply Nat.ltb_lt in Mj.
      destruct (derived_last l j H Ij) as [r [-> R]].
      destruct (derived_last r i (by_coordinate j H) (R i Ii ltac:(lia))) as [r' [-> _]].
      rewrite (derived_same r' _ zero); [apply derived_zero|].
      replace j with (n + (j - n))%nat by lia. rewrite <- (belongs_degrees _ _ member).
      apply (belongs_parts _ _ member Sep); rewrite (belongs_degrees _ _ member); lia.
  Qed.

  Lemma equal_lists_equal : forall l m, equal_lists l m = true -> l = m.
  Proof.
    induction l as [|a l IH]; intros [|b m] E; try discriminate; [reflexivity|].
    simpl in E. apply andb_prop in E. destruct E as [A E]. apply Nat.eqb_eq in A.
    rewrite A, (IH m E). reflexivity.
  Qed.

  Lemma position_found : forall l known j, position l known = Some j -> nth_error known j = Some l.
  Proof.
    intros l known. induction known as [|m known IH]; intros j E; [discriminate|]. simpl in E.
    destruct (equal_lists l m) eqn:A.
    - injection E as <-. simpl. rewrite (equal_lists_equal _ _ A). reflexivity.
    - destruct (position l known) as [k|]; [|discriminate]. injection E as <-. apply IH. reflexivity.
  Qed.

  Lemma named_derivative : forall j l, nth_error (named_derivatives e) j = Some l ->
    named names_for_every (Pos.of_succ_nat (2 * n + 1 + j)) == derived l H.
  Proof.
    intros j l E. rewrite nth_at_position. unfold names_for_every.
    rewrite app_nth2; rewrite map_length, seq_length; [|lia].
    replace (2 * n + 1 + j - (2 * n + 1))%nat with j by lia.
    rewrite (nth_indep _ zero (derived [] H)).
    - rewrite map_nth with (f := fun l => derived l H) (d := []).
      rewrite (nth_error_nth _ _ _ E). reflexivity.
    - rewrite map_length. apply nth_error_Some. rewrite E. discriminate.
  Qed.

  Lemma name_found : forall l f, name_of e l = Some f -> value_of names_for_every f == derived l H.
  Proof.
    intros l f E. unfold name_of in E. destruct (is_zero e l) eqn:Z.
    - injection E as <-. simpl. rewrite (zero_derivatives l Z). apply rational_zero.
    - destruct (position l (named_derivatives e)) as [j|] eqn:P; [|discriminate].
      injection E as <-. apply named_derivative, position_found, P.
  Qed.

  Lemma named_coordinate : forall c, (c <= 2 * n)%nat ->
    named names_for_every (Pos.of_succ_nat c) == coordinate s c.
  Proof.
    intros c L. rewrite nth_at_position. unfold names_for_every.
    rewrite app_nth1 by (rewrite map_length, seq_length; lia).
    rewrite (nth_indep _ zero (coordinate s 0)) by (rewrite map_length, seq_length; lia).
    rewrite map_nth, seq_nth by lia. reflexivity.
  Qed.

  Lemma named_slope : forall a k, (a <= 2 * n)%nat -> known_slope e k = true ->
    by_coordinate a (named names_for_every k) == value_of names_for_every (slope_by_name e a k).
  Proof.
    intros a k L E. unfold known_slope in E. unfold slope_by_name.
    set (j := pred (Pos.to_nat k)) in *.
    assert (k_is : k = Pos.of_succ_nat j).
    { apply Pos2Nat.inj. rewrite SuccNat2Pos.id_succ. unfold j.
      assert (0 < Pos.to_nat k)%nat by apply Pos2Nat.is_pos. lia. }
    rewrite k_is. destruct (Nat.leb_spec j (2 * n)) as [J|J].
    - rewrite named_coordinate by exact J. simpl.
      destruct (Nat.eqb_spec j a) as [->|N].
      + rewrite own_slope by (rewrite (belongs_degrees _ _ member); exact L).
        symmetry. apply rational_one.
      + rewrite other_slope by (rewrite ?(belongs_degrees _ _ member); auto).
        symmetry. apply rational_zero.
    - cbv beta iota delta [orb] in E. set (i := (j - (2 * n + 1))%nat) in *.
      replace j with (2 * n + 1 + i)%nat by (unfold i; lia).
      destruct (nth_error (named_derivatives e) i) as [l|] eqn:P.
      + rewrite (named_derivative i l P), <- derived_inserted.
        rewrite forallb_forall in E. specialize (E a).
        destruct (name_of e (inserted a l)) as [f|] eqn:F.
        * symmetry. apply name_found, F.
        * discriminate E. apply in_seq. lia.
      + assert (Z : named names_for_every (Pos.of_succ_nat (2 * n + 1 + i)) == zero).
        { rewrite nth_at_position, nth_overflow; [reflexivity|].
          unfold names_for_every. rewrite app_length, !map_length, seq_length.
          apply nth_error_None in P. lia. }
        rewrite Z, derivation_zero. symmetry. apply rational_zero.
  Qed.

  (** The names stand for what they say, for each H of the family. *)
  Theorem every_interprets : forall x,
    of_degrees x = n -> slope_of_name x = slope_by_name e -> has_slope x = known_slope e ->
    slope_of_energy x = slope_of_every e -> slopes_named e = true ->
    interprets K s x names_for_every.
  Proof.
    intros x En Es Ek Eh N. constructor; rewrite ?En, ?Es, ?Ek, ?Eh.
    - apply (belongs_degrees _ _ member).
    - exact named_coordinate.
    - exact named_slope.
    - intros a L. unfold slope_of_every. unfold slopes_named in N. rewrite forallb_forall in N.
      specialize (N a). destruct (name_of e [a]) as [f|] eqn:F.
      + apply (name_found [a] f F).
      + discriminate N. apply in_seq. lia.
  Qed.
End EveryHamiltonian.
