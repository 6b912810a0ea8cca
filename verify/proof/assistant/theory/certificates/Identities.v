(** What a certificate says of a map, as formulas that have to be 0.

    The names 1 .. 2n+1 are the coordinates p, q and t; those beyond stand for derivatives of H, or
    for parameters and functions. A series holds, for each of the 2n coordinates, the coefficients of
    h^0, h^1, ... of its new value. *)

From Coq Require Import QArith List Bool.
From AreaPreservation Require Import Formulas Calculation.
Import ListNotations.
Local Open Scope nat_scope.

Record certificate := {
  of_degrees : nat;
  slope_of_name : nat -> positive -> formula;
  has_slope : positive -> bool;
  slope_of_energy : nat -> formula;
  series : list (list formula);
  agreement : nat;
  known : nat;
  order : option nat;
  leading_entry : nat -> nat -> formula;
  primitive : option (nat -> nat -> formula);
}.

(** The coefficient of h^k in the new value of the coordinate c. *)
Definition term (x : certificate) (k c : nat) : formula := nth k (nth c (series x) []) (Number 0).

(** Whether no coordinate has more coefficients than m. *)
Definition of_length (x : certificate) (m : nat) : bool :=
  forallb (fun row => length row <=? m) (series x).

Definition coordinate_name (c : nat) : formula := Name (Pos.of_succ_nat c).

Definition slope (x : certificate) (a : nat) : formula -> formula := derivative (slope_of_name x a).

Definition flow_formula (x : certificate) (f : formula) : formula :=
  let n := of_degrees x in
  Plus (slope x (2 * n) f) (sum_up_to n (fun i =>
    Minus (Times (slope_of_energy x i) (slope x (n + i) f))
          (Times (slope_of_energy x (n + i)) (slope x i f)))).

Definition wedge_formula (x : certificate) (f g : formula) (a b : nat) : formula :=
  Minus (Times (slope x a f) (slope x b g)) (Times (slope x b f) (slope x a g)).

Definition defect_formula (x : certificate) (m a b : nat) : formula :=
  sum_up_to (S m) (fun k => sum_up_to (of_degrees x) (fun i =>
    wedge_formula x (term x k i) (term x (m - k) (of_degrees x + i)) a b)).

(** The 2-form whose entries above the diagonal are these. *)
Definition two_form {A : Type} (none : A) (negative : A -> A) (w : nat -> nat -> A) (a b : nat) : A :=
  if a <? b then w a b else if b <? a then negative (w b a) else none.

Notation form_formula := (two_form (Number 0) Negative).

Definition lie_formula (x : certificate) (w : nat -> nat -> formula) (a b : nat) : formula :=
  let n := of_degrees x in
  let h := slope_of_energy x in
  Plus (flow_formula x (form_formula w a b)) (sum_up_to n (fun i =>
    Plus (Minus (Times (slope x a (h i)) (form_formula w (n + i) b))
                (Times (slope x a (h (n + i))) (form_formula w i b)))
         (Minus (Times (slope x b (h i)) (form_formula w a (n + i)))
                (Times (slope x b (h (n + i))) (form_formula w a i))))).

(** One gap for each coefficient of each coordinate that agrees with the flow: (k + 1) z_(k+1) =
    D z_k, and z_0 = z. *)
Definition flow_gaps (x : certificate) : list formula :=
  flat_map (fun c => Minus (term x 0 c) (coordinate_name c)
    :: map (fun k => Minus (Times (Number (Z.of_nat (S k) # 1)) (term x (S k) c))
                           (flow_formula x (term x k c))) (seq 0 (agreement x)))
    (seq 0 (2 * of_degrees x)).

(** What the coefficient of h^m in the defect has to be: the leading one, or 0. *)
Definition expected (x : certificate) (m a b : nat) : formula :=
  match order x with
  | Some r => if m =? r then leading_entry x a b else Number 0
  | None => Number 0
  end.

Definition pairs_of_coordinates (n : nat) : list (nat * nat) :=
  filter (fun ab => fst ab <? snd ab) (list_prod (seq 0 (2 * n)) (seq 0 (2 * n))).

(** One for each coefficient of the defect and each pair of coordinates. *)
Definition defect_gaps (x : certificate) : list formula :=
  flat_map (fun m => map (fun ab =>
      Minus (defect_formula x m (fst ab) (snd ab)) (expected x m (fst ab) (snd ab)))
    (pairs_of_coordinates (of_degrees x))) (seq 1 (known x)).

Definition primitive_gaps (x : certificate) : list formula :=
  match primitive x with
  | None => []
  | Some w => map (fun ab => Minus (lie_formula x w (fst ab) (snd ab))
                                   (leading_entry x (fst ab) (snd ab)))
      (pairs_of_coordinates (of_degrees x))
  end.

(** A 2-form by its entries that are not 0. *)
Definition entry {A : Type} (default : A) (entries : list (nat * nat * A)) (a b : nat) : A :=
  match find (fun e => (fst (fst e) =? a) && (snd (fst e) =? b)) entries with
  | Some e => snd e
  | None => default
  end.

Lemma entry_of_map : forall (A B : Type) (f : A -> B) default entries a b,
  f (entry default entries a b) = entry (f default) (map (fun e => (fst e, f (snd e))) entries) a b.
Proof.
  intros A B f default entries a b. unfold entry. induction entries as [|e entries IH]; [reflexivity|].
  simpl. destruct ((fst (fst e) =? a) && (snd (fst e) =? b)); [reflexivity|exact IH].
Qed.

(** Whether all that is derived here has slopes. *)
Definition all_have_slopes (x : certificate) : bool :=
  let ok := uses (has_slope x) in
  let coordinates := seq 0 (2 * of_degrees x) in
  forallb (forallb ok) (series x) && forallb (fun a => ok (slope_of_energy x a)) coordinates
  && match primitive x with
     | None => true
     | Some w => forallb (fun ab => ok (w (fst ab) (snd ab))) (pairs_of_coordinates (of_degrees x))
     end.

Definition accepted (x : certificate) (relations : list formula)
    (factors : list (list (nat * formula))) : bool :=
  all_have_slopes x && all_vanish relations (flow_gaps x ++ defect_gaps x ++ primitive_gaps x) factors.
