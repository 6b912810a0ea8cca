"""Peers beside the exact solution: where they end, in the plane, in time, in degrees of freedom."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.constructed.work import reference_problem
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.systems import get
from verify.studies.work_precision import peers
from verify.studies.work_precision.problem import reference

DRIVEN = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4 - q*cos(7*t/5)/2")
HENON, KEPLER = get("henon-heiles").hamiltonian(), get("kepler").hamiltonian({"mu": 1})
REST: dict[str, Any] = {"p": 0, "q": 1}
ORBIT: dict[str, Any] = {"q": [0, "0.1"], "p": ["0.4", 0]}
ELLIPSE: dict[str, Any] = {"q": ["2/5", 0], "p": [0, 2]}
CASES: dict[str, tuple[Hamiltonian, dict[str, Any], int, Fraction, int]] = {
    "driven from 1/3": (DRIVEN, REST, 10, Fraction(1, 3), 10),
    "driven from 1000": (DRIVEN, REST, 10, Fraction(1000), 10),
    "henon-heiles": (HENON, ORBIT, 3, Fraction(0), 9),
    "kepler": (KEPLER, ELLIPSE, 3, Fraction(0), 9),
}


@pytest.mark.parametrize("name", peers.libraries())
@pytest.mark.parametrize(
    ("hamiltonian", "start", "time", "t0", "digits"), CASES.values(), ids=CASES
)
def test_a_peer_ends_where_the_exact_solution_does(
    name: str, hamiltonian: Hamiltonian, start: dict[str, Any], time: int, t0: Fraction, digits: int
) -> None:
    pytest.importorskip(peers.libraries()[name])
    problem = reference_problem(hamiltonian, Fraction(time), t0, **start)
    solver = peers.get(name).make(problem, Fraction(1, 10**12))
    state = solver.solve().state
    assert solver.solve().state == state, "it may be timed again and again"
    exact = tuple(map(Fraction, state))
    assert problem.error(exact)[0] < Fraction(1, 10**digits)
    assert problem.error(exact[::-1])[0] > Fraction(1, 10), "with another order of coordinates"
    if hamiltonian.time_dependent:
        later = reference(hamiltonian, problem.point, problem.time, t0 + 1)
        for coordinate, wrong in zip(exact, later.point.values(), strict=True):
            assert abs(coordinate - wrong) > Fraction(1, 10), "with another start of the clock"
