"""The growth of the tangent map: of areas by its minors, in chaos, by the scheme, on a torus."""

from fractions import Fraction

import pytest

from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.separation_parts import TangentGrowth
from verify.studies.separation.matrix_products import compute_size, entries_of_defect
from verify.studies.separation.truncation_and_rounding import separate

HENON = systems.get("henon-heiles").hamiltonian({})
LINEAR = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + 2*q2**2)/2 + q1*q2/2", {})


def test_areas_grow_by_the_minors() -> None:
    m = [[1, 2, 0, 3], [0, 1, 5, 0], [2, 0, 1, 1], [0, 7, 0, 1]]
    pairs = [(a, b) for a in range(4) for b in range(a + 1, 4)]
    minors = [m[i][a] * m[k][b] - m[i][b] * m[k][a] for i, k in pairs for a, b in pairs]
    sizes = compute_size([[8 * x for x in row] for row in m], 8)
    assert sizes == (sum(x * x for row in m for x in row), sum(x * x for x in minors))
    identity = entries_of_defect(lambda a, b: Fraction(int(a == b)), 4)
    assert identity == (0,) * 6


def tangent(
    exact: Hamiltonian, scheme: str, h: str, steps: int, **start: list[str]
) -> TangentGrowth:
    result = separate(exact, scheme, step_size=h, steps=steps, digits=5, **start)
    assert result.tangent is not None
    return result.tangent


@pytest.mark.left_to_ci
def test_in_chaos_the_growth_is_the_motion_s() -> None:
    chaos = tangent(HENON, "rk4", "0.2", 600, q=["0", "-0.15"], p=["0.5277", "0"])
    assert (chaos.motion, chaos.cause) == ("exponential", "motion")
    assert chaos.law.name == "exponential"
    assert 0.08 < float(chaos.finite_time_lyapunov) < 0.12
    assert float(chaos.per_area) < 1e-3, "W grew as areas did, and S of a step is small"
    assert "not the scheme's" in chaos.meaning


def test_a_scheme_that_amplifies_is_told_from_it() -> None:
    growth = tangent(LINEAR, "lie2", "0.6", 300, q=["0.3", "-0.1"], p=["0.1", "0.2"])
    assert (growth.motion, growth.cause) == ("exponential", "scheme")
    assert "the scheme's at this step size" in growth.meaning


@pytest.mark.left_to_ci
def test_on_a_quasi_periodic_orbit_a_power_is_measured_and_said_to_be() -> None:
    growth = tangent(HENON, "lie2", "0.05", 2000, q=["0.3", "-0.1"], p=["0.1", "0.2"])
    assert (growth.motion, growth.cause) == ("polynomial", None)
    assert "measured, not proved" in growth.meaning
    assert "the motion's" not in growth.meaning
