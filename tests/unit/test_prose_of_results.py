"""What results say is marked: no formula and no number is left in a text for a page to find."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.pages.parts_of_prose import UNMARKED, proses, unmarked
from tests.helpers.programs.judged import judged
from verify.execution.keeper import NOTHING
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import Claims
from verify.papers import check_theorem
from verify.papers import names as theorems
from verify.proof.map_symmetry import judge_symmetry
from verify.proof.order_for_every_h import prove_for_every_h
from verify.prose import Formula, Number, Prose, prose
from verify.scenes.frozen import PLAIN
from verify.schemes import get
from verify.schemes import names as schemes
from verify.studies.criteria_verdicts import judge
from verify.studies.kinds.proofs import ProofTask
from verify.studies.separation.growth_fits import fit_growth
from verify.studies.stability.trail import StabilityRun
from verify.studies.stability.verdict_results import run_result

OWN = "p_next = p - h*q**2; q_next = q + h*p"
HAMILTONIANS = {"duffing": "p**2/2 + q**2/2 + q**4/4", "pendulum": "p**2/2 - cos(q)"}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", theorems())
def test_theorems_are_marked(name: str) -> None:
    found = check_theorem(name)
    assert unmarked(found) == []
    assert {found.evidence, *(each.text for each in found.steps)} <= set(proses(found))


@pytest.mark.parametrize("separable", [False, True])
@pytest.mark.parametrize("name", [n for n in schemes() if get(n).every_h and get(n).order <= 6])
def test_proofs_for_every_h_are_marked(name: str, separable: bool) -> None:
    proof = prove_for_every_h(name, separable=separable)
    assert unmarked([proof, proof.argument]) == []
    assert proof.reason in list(proses(proof))


@pytest.mark.parametrize("name", ["lie2", "stormer-verlet", "yoshida4", "rk4", "implicit-midpoint"])
def test_symmetry_is_marked(name: str) -> None:
    step_map = get(name).step_map(Hamiltonian.parse("p**2/2 + q**3/3"))
    assert unmarked(judge_symmetry(step_map, 3)) == []


@pytest.mark.parametrize("hamiltonian", HAMILTONIANS.values(), ids=HAMILTONIANS)
@pytest.mark.parametrize("scheme", ["lie1", "lie2", "lie3", "symplectic-euler", "rk4", OWN])
def test_proofs_and_criteria_are_marked(hamiltonian: str, scheme: str) -> None:
    task = ProofTask(hamiltonian=hamiltonian, parameters={}, scheme=scheme, formulas=False)
    proof = task.compute(NOTHING)
    found = [proof, *(judge(number, proof, []) for number in (1, 2, 3, 4))]
    assert len([x for x in proses(found) if x]) == 5 + bool(proof.where)
    assert unmarked(found) == []
    said = [x for x in proses(found) if any(type(part) is not str for part in x.parts)]
    data = [each.model_dump(mode="json") for each in found]
    assert sum(len({"reason_parts", "evidence_parts"} & set(each)) for each in data) == len(said)


@pytest.mark.parametrize(
    "text",
    ["h**3*p", "of order h^3", "H_qq = 0", "z̄_(k+1)", "Σ_k", "[0.5 +/- 1e-9]", "up to 2e-16",
     "q = -0.5", "from (1, -3)", "1.5E+4 steps"],
)  # fmt: skip
def test_what_is_not_marked_is_seen(text: str) -> None:
    assert unmarked([{"a": (prose("as before, ", Formula("h^2"), " and ", text),)}])
    assert not unmarked(prose("as before, ", Formula(text)))


@pytest.mark.parametrize("text", ["h², 1/3 and 0.5", "well-known", "5-10", "a rerun, −3", "lie2"])
def test_plain_text_is_no_formula(text: str) -> None:
    assert not UNMARKED.search(text)


def test_what_is_no_prose_is_not_looked_at() -> None:
    found: Any = {"formula": "h**3", "n": Fraction(1, 3), "text": Prose("fine")}
    assert unmarked(found) == []
    assert list(proses(found)) == ["fine"]


# -- what was measured -----------------------------------------------------------------------------

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4")
STEPS = {
    "a power": lambda p, q, h: (p - h * (q + q**3), q + h * (p - h * (q + q**3))),
    "rounded": lambda p, q, h: (p - 0.3333333333333333 * h * q, q + h * p),
    "frozen": lambda p, q, _: (p, q),
    "of floats": lambda p, q, h: (float(p) - h * float(q + q**3), float(q) + h * float(p)),
}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("step", STEPS.values(), ids=STEPS)
@pytest.mark.parametrize("claims", [Claims(), Claims(order=2, area_order=3), Claims(2, 3, True)])
def test_what_is_found_of_a_step_is_marked(step: Any, claims: Claims) -> None:
    found = judged(step, claims, hamiltonian=DUFFING)
    said = [found.reason, *found.notes]
    assert unmarked(said) == []
    assert list(proses(said)) == said


@pytest.mark.parametrize("h", ["1/10", "1/2", "9/4"])
@pytest.mark.parametrize("q", ["1/2", "30"])
def test_stability_is_marked(h: str, q: str) -> None:
    run = StabilityRun(DUFFING, "symplectic-euler", Fraction(h), (Fraction(0), Fraction(q)), 200)
    found = run_result(run)
    assert unmarked(found) == []
    assert len(list(proses(found))) == 2
    assert not [name for name in found.model_dump(context=PLAIN) if name.endswith("_parts")]
    assert "detail_parts" in found.model_dump() or "exact_orbit_parts" in found.model_dump()


def test_a_growth_of_rounding_is_marked() -> None:
    marks = list(range(100, 100_001, 100))
    for power in (Fraction(0), Fraction(-1)):
        found = fit_growth(marks, [1 + power * Fraction(1, n) for n in marks], Fraction(1, 10**30))
        assert [type(part) for part in found.reason.parts].count(Number) == 2
        assert unmarked(found) == []
