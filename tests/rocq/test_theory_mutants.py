"""A statement of the theory, or a check that it trusts, with one thing changed has no proof.

A file is read by itself, with what it stands on taken from the compiled theory.
"""

import re

import pytest

from tests.helpers.rocq.coqc import changed, in_module
from tests.helpers.rocq.session import Session
from verify.proof.assistant.shipped_theory import text_of

pytestmark = pytest.mark.left_to_ci

# Of a file: what is there, what is put in its place, and the proof that then fails.
MUTANTS = [
    ("LieScheme", "- (inverse_factorial (S eta) * total", "- (inverse_factorial eta * total",
     "even_telescopes"),
    ("LieScheme", "form K := fun a b => - (pairs (flow_series (S eta)) z a b + pairs",
     "form K := fun a b => (pairs (flow_series (S eta)) z a b + pairs", "first_defect"),
    ("LieScheme", "even_telescopes : Nat.Even eta ->", "even_telescopes : True ->",
     "even_telescopes"),
    ("LieScheme", "if (k <=? eta)%nat then", "if (k <? eta)%nat then", "defect_at_0"),
    ("Step", "== power h (S eta) * leading K s eta a b +", "== power h eta * leading K s eta a b +",
     "defect_of_step"),
    ("Plane", "Definition G : K := - (", "Definition G : K := (", "telescopes_for_even"),
    ("Bracket", ":= d 0%nat a * d 1%nat b -", ":= d 0%nat a * d 1%nat b +", "pairs_in_plane"),
    ("RungeKutta", "b i * A i j + b j * A j i - b i * b j = 0.",
     "b i * A i j - b j * A j i - b i * b j = 0.", "weights_cancel"),
    ("StageSchemes", "(1 - share_p s - share_q s) = 0", "(1 - share_p s + share_q s) = 0",
     "scheme_symplectic"),
    ("SymplecticMethods", "| Kick _ V V1 => only_positions n V /\\",
     "| Kick _ V V1 => only_momenta n V /\\", "shear_symplectic"),
    ("Product", "Theorem product_near_one : forall N d eps, 0 <= eps -> (forall k, (k < N)%nat -> "
     "Rabs (d k - 1) <= eps) -> Rabs (product N d - 1) <= (1 + eps) ^ N - 1.",
     "Theorem product_near_one : forall N d eps, 0 <= eps -> (forall k, (k < N)%nat -> "
     "Rabs (d k - 1) <= eps) -> Rabs (product N d - 1) <= (1 + eps / 2) ^ N - 1.",
     "product_near_one"),
    ("Product", "exp (sum N (fun k => Rabs (d k - 1))) - 1. Proof.",
     "exp (sum N (fun k => Rabs (d k - 1)) / 2) - 1. Proof.", "product_near_one_by_sum"),
    ("Product", "1 + sum N x <= product N (fun k => 1 + x k).",
     "2 + sum N x <= product N (fun k => 1 + x k).", "product_above_sum"),
    ("Product", "e N <= c * (((1 + x) ^ N - 1) / x). Proof.",
     "e N <= c * ((1 + x) ^ N - 1). Proof.", "errors_add_up"),
    ("Product", "e N <= a ^ N * e O + sum N (fun k => a ^ (N - 1 - k) * c k). Proof.",
     "e N <= a ^ N * e O + sum N (fun k => a ^ (N - k) * c k). Proof.", "errors_sum_up"),
    ("Sums", "sum n f ^ 2 <= INR n * sum n (fun i => f i ^ 2).",
     "sum n f ^ 2 <= sum n (fun i => f i ^ 2).", "square_of_sum"),
    ("Oscillator", "Theorem odd_does_not_telescope : forall eta, Nat.Odd eta ->",
     "Theorem odd_does_not_telescope : forall eta, Nat.Even eta ->", "odd_does_not_telescope"),
    ("Taylor", "(fun j => defect_coefficient A j a b) (m + m).",
     "(fun j => defect_coefficient A j a b) m.", "pairs_at_number"),
    ("EveryNumbers", "(m + m <= S (S (known x)))%nat -> forall j a b,",
     "(m + m <= S (S (S (known x))))%nat -> forall j a b,", "coefficients_vanish"),
    ("EveryNumbers", "(m + m <= S (S r + l))%nat -> forall h u, is_constant K h ->",
     "(m + m <= S (S r + l))%nat -> forall h u, True ->", "form_at_number"),
    ("EverySmooth", "<= C * Rabs h ^ S r. Proof. intros l m r z",
     "<= C * Rabs h ^ S (S r). Proof. intros l m r z", "smooth_map_has_order"),
    ("RealPotential", "(H2 i a * antisymmetric (w z) (n + i) b - H2",
     "(H2 i a * antisymmetric (w z) (n + i) b + H2", "leading_is_lie_derivative"),
    ("RealPotential", "(H2 i b * antisymmetric (w z) a (n + i) - H2",
     "(H2 i a * antisymmetric (w z) b (n + i) - H2", "leading_is_lie_derivative"),
    ("AgreementClaims", "- nth (n + i) (H1 z) 0 * slope i) = g.",
     "+ nth (n + i) (H1 z) 0 * slope i) = g.", "formula_along_flow"),
    ("AgreementClaims", "(INR (k + 1) * nth (k + 1) (coefficients z c) 0). Proof. intros H1 H1_is",
     "(INR k * nth (k + 1) (coefficients z c) 0). Proof. intros H1 H1_is",
     "coefficients_along_flow"),
    ("Orders", "forall r a C, a <> 0 -> exists h0 c,", "forall r a C, True -> exists h0 c,",
     "order_is_exact"),
    ("ImplicitSolutions", "| O, _ => 1 / 4 - w / 6", "| O, _ => 1 / 4 + w / 6",
     "gauss_is_symplectic"),
    ("ImplicitSolutions", "(root : w * w = 3).", "(root : w * w = 2).", "gauss_solves"),
    ("SymplecticMethods", "| nil => True | s :: rest => shear_of_hamiltonian n s x /\\",
     "| nil => True | s :: rest => True /\\", "shears_symplectic"),
    ("MapClaims", "* h ^ r) <= C * Rabs h ^ S r. Proof. intros r Er Lr short z",
     "* h ^ r) <= C * Rabs h ^ S (S r). Proof. intros r Er Lr short z", "order_of_defect"),
]  # fmt: skip
# What a certificate is checked with: to ask less of it is to prove nothing by it.
CHECKS = [
    ("Calculation", "vanishes (reduced relations gap (hd [] factors)) && all_vanish",
     "all_vanish", "calculated"),
    ("AlgebraicNumbers", "Qle_bool (rational_value l low * rational_value l high) 0",
     "Qle_bool (rational_value l low * rational_value l high) 1", "root_between"),
    ("Coefficients", "Plus (Times (b_ i) (a_ i j)) (Times (b_ j) (a_ j i))",
     "Plus (Times (b_ i) (a_ i j)) (Times (b_ j) (a_ i j))", "weights_are_symplectic"),
    ("Coefficients", "then Number 0 else Minus (at_ 0) (at_ 1)]", "then Number 0 else Number 0]",
     "stages_hold"),
    ("Nonzero", "| Cosine _ | Exponential => Qeq_bool argument 0 && Qeq_bool u 1",
     "| Cosine _ | Exponential => Qeq_bool argument 0 && Qeq_bool u 0", "known_value_is"),
]  # fmt: skip
# The identities of a certificate, which the file Certified trusts.
IDENTITIES = [
    ("Times (Number (Z.of_nat (S k) # 1)) (term x (S k) c)",
     "Times (Number (Z.of_nat k # 1)) (term x (S k) c)", "agrees_with_flow"),
    ("(pairs_of_coordinates (of_degrees x))) (seq 1 (known x)).",
     "(pairs_of_coordinates (of_degrees x))) (seq 2 (known x)).", "defect_is_known"),
    ("filter (fun ab => fst ab <? snd ab)", "filter (fun ab => S (fst ab) <? snd ab)",
     "pair_listed"),
    ("Plus (flow_formula x (form_formula w a b))", "Minus (flow_formula x (form_formula w a b))",
     "value_of_lie"),
]  # fmt: skip


@pytest.mark.sample(8)
@pytest.mark.parametrize(
    ("name", "old", "new", "place"),
    [pytest.param(*each, id=f"{each[0]}: {each[-1]}") for each in [*MUTANTS, *CHECKS]],
)
def test_a_changed_statement_has_no_proof(
    rocq: Session, name: str, old: str, new: str, place: str
) -> None:
    assert rocq.stops_at(changed(text_of(name), old, new)) == place


def certified(identities: str) -> str:
    """The file Certified with these identities before it, in one."""
    loaded = re.findall(r"^From .*\n", identities, re.MULTILINE)
    inside = identities.replace("".join(loaded), "")
    module = f"{in_module('Identities', inside)}Import Identities.\n"
    rest = changed(text_of("Certified"), "Taylor Formulas Identities.", "Taylor Formulas.")
    return f"{''.join(loaded)}{module}{rest}"


@pytest.mark.sample(2)
@pytest.mark.parametrize(("old", "new", "place"), IDENTITIES, ids=lambda x: x.split()[0])
def test_what_follows_from_identities_has_no_proof_from_others(
    rocq: Session, old: str, new: str, place: str
) -> None:
    assert rocq.stops_at(certified(changed(text_of("Identities"), old, new))) == place


def test_the_files_are_taken_as_they_are(rocq: Session) -> None:
    rocq.accepted(text_of("Product"))
    rocq.accepted(certified(text_of("Identities")))
