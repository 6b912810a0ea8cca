"""The page says of the leading coefficient what `prove` says of it: that it telescopes, or not."""

import pytest

from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import proof, report, scene
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.pages.page import render
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import potential_of
from verify.scenes.results.growth import GrowthLawResult
from verify.schemes import get
from verify.studies.growth_prediction import compute_average

PENDULUM = "p**2/2 - cos(q)"
MIDPOINT = "p_next = p - h*sin(q + h*p/2); q_next = q + h*(p - h*sin(q)/2)"
SAYS = {
    True: "telescopes: it is X·G with G =",
    False: "does not telescope",
    None: "whether it telescopes is not decided",
}
CASES = [
    (PENDULUM, "lie1", False),
    (PENDULUM, "lie2", True),
    (PENDULUM, "lie3", False),
    (PENDULUM, "explicit-midpoint", True),
    (PENDULUM, MIDPOINT, True),
    (PENDULUM, "rk4", False),
    (PENDULUM, "p_next = p - h*sin(q); q_next = q + h*p", False),
    ("p**2/2 + q**4/4", "p_next = p - h*q**3; q_next = q + h*p", None),
    ("p**2/2 + q**4/4", "p_next = p - h*q**3; q_next = q + h*p - h**2*q**3/2", None),
    ("p**2/2 + q**2/2", "explicit-midpoint", False),
]


def page_of(hamiltonian: Hamiltonian, scheme: str) -> str:
    law = compute_average(hamiltonian, scheme, q="0.7", p="0.1", digits=8)
    laws = (GrowthLawResult(law=law, predictions=()),)
    return text_of(render(report((scene(growth_laws=laws, proofs=(proof(scheme=scheme),)),))))


@pytest.mark.parametrize(("formula", "scheme", "expected"), CASES)
def test_the_page_says_of_the_leading_coefficient_what_prove_says(
    formula: str, scheme: str, expected: bool | None
) -> None:
    hamiltonian, chosen = Hamiltonian.parse(formula), get(scheme)
    assert potential_of(prove(chosen.step_map(hamiltonian), chosen), chosen).holds is expected
    text = page_of(hamiltonian, scheme)
    said = {known for known, words in SAYS.items() if words in text}
    by_potential = "whose derivative along the flow is the leading coefficient of ΔJ" in text
    assert (said or {True}) == {expected}
    assert by_potential == (not said)
