"""What results say is marked: no formula and no number is left in a text for a page to find."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.parts_of_prose import UNMARKED, proses, unmarked
from verify.claims.theorems import check_theorem
from verify.claims.theorems import names as theorems
from verify.execution.keeping import NOTHING
from verify.proof.every import prove_every
from verify.proof.symmetry import prove_symmetry
from verify.prose import Formula, Prose, prose
from verify.schemes import get
from verify.schemes import names as schemes
from verify.studies.criteria import judge
from verify.studies.proofs.one import ProofTask

OWN = "p_next = p - h*q**2; q_next = q + h*p"
HAMILTONIANS = {"duffing": "p**2/2 + q**2/2 + q**4/4", "pendulum": "p**2/2 - cos(q)"}


@pytest.mark.parametrize("name", theorems())
def test_theorems_are_marked(name: str) -> None:
    found = check_theorem(name)
    assert unmarked(found) == []
    assert {found.statement, found.evidence, found.proof} <= set(proses(found))


@pytest.mark.parametrize("separable", [False, True])
@pytest.mark.parametrize("name", [n for n in schemes() if get(n).every_h and get(n).order <= 6])
def test_proofs_for_every_h_are_marked(name: str, separable: bool) -> None:
    proof = prove_every(name, separable=separable)
    assert unmarked([proof, proof.argument]) == []
    assert proof.reason in list(proses(proof))


@pytest.mark.parametrize("name", ["lie2", "stormer-verlet", "yoshida4", "rk4", "implicit-midpoint"])
def test_symmetry_is_marked(name: str) -> None:
    assert unmarked(prove_symmetry(get(name))) == []


@pytest.mark.parametrize("hamiltonian", HAMILTONIANS.values(), ids=HAMILTONIANS)
@pytest.mark.parametrize("scheme", ["lie1", "lie2", "lie3", "symplectic-euler", "rk4", OWN])
def test_proofs_and_criteria_are_marked(hamiltonian: str, scheme: str) -> None:
    task = ProofTask(hamiltonian=hamiltonian, parameters={}, scheme=scheme, formulas=False)
    proof = task.compute(NOTHING)
    found = [proof, *(judge(number, proof, []) for number in (1, 2, 3, 4))]
    assert len(list(proses(found))) == 5
    assert unmarked(found) == []
    data = [each.model_dump(mode="json") for each in found]
    assert all({"reason_parts", "evidence_parts"} & set(each) for each in data)


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
