"""What a proof says is 0 of a run is what is made of the defect, and not all that may be asked."""

from fractions import Fraction

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.runs import run as runs
from verify.scenes import observables
from verify.scenes.observables import OF_DEFECT, OF_FORM, SEVERAL

PLANE = Hamiltonian.parse("p**2/2 - cos(q)")
TWO_DEGREES = Hamiltonian.parse("(p1**2 + p2**2)/2 + q1**2*q2 + q1**2 + q2**2")
NOT_OF_THE_DEFECT = "energy_error_max"


def proved(hamiltonian: Hamiltonian, scheme: str) -> runs.Bounded:
    return runs.proved(step_map_of(hamiltonian, scheme), Fraction(1, 10), 10, 20)


@pytest.mark.parametrize("hamiltonian", [PLANE, TWO_DEGREES])
def test_what_may_be_asked_beside_the_defect_is_not_said_to_be_0(
    hamiltonian: Hamiltonian, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (observables, runs):
        monkeypatch.setattr(module, "SEVERAL", (*SEVERAL, NOT_OF_THE_DEFECT), raising=False)
    found = proved(hamiltonian, "stormer-verlet")
    assert NOT_OF_THE_DEFECT not in found
    assert {"lambda", "lambda_max", "mse", "delta_j_max"} <= found.keys()
    assert set(map(tuple, found.values())) == {(0, 0)}


def test_what_is_said_to_be_0_is_0_in_a_run_that_steps() -> None:
    """A run of a scheme whose defect is not 0 has none of them at 0, so that 0 says something."""
    names = [name for name in OF_DEFECT if name in SEVERAL]
    keys = {"q": [1, Fraction(1, 2)], "p": [0, 1], "steps": 5, "digits": 20, "t0": 0}
    asked = {**keys, "step_size": Fraction(1, 10), "observables": names}
    kept = runs.run(TWO_DEGREES, "stormer-verlet", **asked)
    lost = runs.run(TWO_DEGREES, "lie2", **asked)
    for name in names:
        assert Fraction(kept.values[name].value) == 0
        assert Fraction(lost.values[name].value) != 0
    assert set(OF_FORM) <= set(names)
    assert proved(TWO_DEGREES, "lie2") == {}
