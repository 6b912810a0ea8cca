"""That a step is not undone by that of −h, by its series for one H; that proves no more."""

import pytest

from tests.helpers.symmetry import WITNESS
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.map_symmetry import judge_symmetry
from verify.schemes import get
from verify.verdict import Verdict

IN_TIME = "p**2/2 + q**4/7 + p**3/3 + q*t + q**2*t**2"


@pytest.mark.parametrize("formula", [WITNESS, IN_TIME])
@pytest.mark.parametrize(
    ("scheme", "power"),
    [("implicit-symplectic-euler", 2), ("symplectic-euler", 2), ("lie1", 2), ("lie2", 4),
     ("rk4", 6), ("ruth3", 4)],
)  # fmt: skip
def test_a_step_that_is_not_symmetric_is_refuted_at_the_power_where_it_differs(
    scheme: str, power: int, formula: str
) -> None:
    """Steps of ±h that are off by d h^(r + 1) and d (−h)^(r + 1) leave 2 d h^(r + 1) for odd r,
    and for even r nothing but the next power."""
    found = judge_symmetry(get(scheme).step_map(Hamiltonian.parse(formula)), 6)
    assert (found.verdict, found.power) == (Verdict.REFUTED, power)
    assert f"O(h^{power})" in str(found.reason)


@pytest.mark.parametrize("formula", [WITNESS, IN_TIME])
@pytest.mark.parametrize("scheme", ["stormer-verlet", "implicit-midpoint"])
def test_of_a_symmetric_step_nothing_is_refuted_nor_proved(scheme: str, formula: str) -> None:
    found = judge_symmetry(get(scheme).step_map(Hamiltonian.parse(formula)), 5)
    assert (found.verdict, found.power) == (Verdict.UNDECIDED, None)
