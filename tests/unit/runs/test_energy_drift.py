"""The drift of H and H̃ along a run: exact values, smaller with each term, and planted errors."""

import dataclasses
import math
from fractions import Fraction

import pytest
import sympy

import verify
from verify.errors import InputError
from verify.proof.plane.modified_for_one_h import modified_for_one_h
from verify.runs import run_errors
from verify.runs.run_errors import energy_drifts

START = {"q": 1.5, "p": 0, "steps": 60}


def run(step_size: str, scheme: str = "stormer-verlet", **more):
    return verify.run("pendulum", scheme, step_size=step_size, **START, **more)


def test_the_drift_is_that_of_the_formula_at_the_states() -> None:
    result = run("0.2", digits=25)
    drifts = energy_drifts(result, 4)
    assert [x.power for x in drifts] == [0, 2, 4]
    found = verify.modified_hamiltonian("stormer-verlet", "pendulum", 4)
    p, q, h = (sympy.Symbol(n, real=True) for n in "pqh")
    energy = sympy.lambdify((p, q, h), found.expression, "mpmath")
    orbit = result.orbit
    states = list(zip(orbit.p, orbit.q, strict=True))
    for k in (1, 30, 60):
        wanted = energy(*states[k], 0.2) - energy(*states[0], 0.2)
        assert drifts[-1].values[k] == pytest.approx(float(wanted), abs=1e-15)
    assert drifts[0].values[60] == pytest.approx(orbit.energy_error[60], rel=1e-12)
    assert (drifts[0].values[0], drifts[0].t[60]) == (0.0, Fraction(12))


@pytest.mark.parametrize("arithmetic", [{}, {"digits": 25}])
def test_each_term_makes_the_drift_smaller_by_its_order(arithmetic) -> None:
    coarse, fine = (energy_drifts(run(h, **arithmetic), 4) for h in ("0.1", "0.05"))
    for one, half in zip(coarse, fine, strict=True):
        gain = math.log2(one.largest / half.largest)
        assert gain == pytest.approx(one.power + 2, abs=0.5)
    assert coarse[0].largest > 100 * coarse[1].largest > 10_000 * coarse[2].largest


def test_a_wrong_term_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def planted(*given):
        found = modified_for_one_h(*given)
        term = found.terms[2]
        ring, x = term.energy
        wrong = dataclasses.replace(term, energy=(ring, x + ring.variable("q") ** 2 / 50))
        return dataclasses.replace(found, terms=(*found.terms[:2], wrong, *found.terms[3:]))

    right = energy_drifts(run("0.05"), 2)[1].largest
    monkeypatch.setattr(run_errors, "modified_for_one_h", planted)
    assert energy_drifts(run("0.05"), 2)[1].largest > 20 * right


def test_a_scheme_that_keeps_no_energy_is_refused() -> None:
    with pytest.raises(InputError, match=r"lie2: has no modified Hamiltonian but H"):
        energy_drifts(run("0.1", "lie2"))
    with pytest.raises(InputError, match="order=0"):
        energy_drifts(run("0.1"), 0)
