"""Laws of W and of the tangent map, on made values and on orbits whose motion is known."""

import math
from fractions import Fraction

import pytest

from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.tangent_growth import finite_time_lyapunov
from verify.scenes.results.separation_parts import TangentGrowth
from verify.studies.separation.growth_fits import classify_motion, fit_power_law
from verify.studies.separation.matrix_products import compute_size, entries_of_defect
from verify.studies.separation.truncation_and_rounding import separate

MARKS = tuple(range(4, 2049, 4))
HENON = systems.get("henon-heiles").hamiltonian({})
LINEAR = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + 2*q2**2)/2 + q1*q2/2", {})


@pytest.mark.parametrize(("power", "name"), [(0, "bounded"), (1, "N"), (2, "N²")])
def test_a_power_is_found_under_an_oscillation(power: int, name: str) -> None:
    sizes = [Fraction(n**power * (2 + math.sin(n))) for n in MARKS]
    found = fit_power_law(MARKS, sizes, Fraction(0), "polynomial")
    assert found.name == name
    assert found.exponent == pytest.approx(power, abs=0.2)


@pytest.mark.parametrize("power", [0.5, 1.5, 3])
def test_what_is_near_no_whole_power_is_undecided(power: float) -> None:
    sizes = [Fraction(n**power) for n in MARKS]
    assert fit_power_law(MARKS, sizes, Fraction(0), "polynomial").name == "undecided"


def test_nothing_is_fitted_to_noise_to_little_or_to_what_grows_exponentially() -> None:
    sizes = [Fraction(n) for n in MARKS]
    assert fit_power_law(MARKS, sizes, Fraction(10**6), "polynomial").exponent is None
    assert fit_power_law(MARKS[:20], sizes[:20], Fraction(0), "polynomial").exponent is None
    assert fit_power_law(MARKS, sizes, Fraction(0), "exponential").name == "exponential"
    assert fit_power_law(MARKS, [Fraction(0)] * 512, Fraction(0), "exponential").name == "bounded"


def test_a_power_of_the_tangent_map_is_not_taken_for_an_exponential() -> None:
    linear = [Fraction(4 + n * n) for n in MARKS]
    assert classify_motion(MARKS, linear) == "polynomial"
    assert classify_motion(MARKS, [Fraction(4)] * len(MARKS)) == "undecided", "it has not grown"
    squares = [Fraction(math.exp(n / 100)) for n in MARKS]
    assert classify_motion(MARKS, squares) == "exponential"


def test_areas_grow_by_the_minors() -> None:
    m = [[1, 2, 0, 3], [0, 1, 5, 0], [2, 0, 1, 1], [0, 7, 0, 1]]
    pairs = [(a, b) for a in range(4) for b in range(a + 1, 4)]
    minors = [m[i][a] * m[k][b] - m[i][b] * m[k][a] for i, k in pairs for a, b in pairs]
    found = compute_size([[8 * x for x in row] for row in m], 8)
    assert found == (sum(x * x for row in m for x in row), sum(x * x for x in minors))
    identity = entries_of_defect(lambda a, b: Fraction(int(a == b)), 4)
    assert identity == (0,) * 6


def test_the_exponent_is_that_of_the_identity_s_growth() -> None:
    assert finite_time_lyapunov(math.log(2), 4, 3) == 0
    assert finite_time_lyapunov(math.log(2) + 1, 4, 2) == pytest.approx(0.5)


def tangent(
    exact: Hamiltonian, scheme: str, h: str, steps: int, **start: list[str]
) -> TangentGrowth:
    found = separate(exact, scheme, step_size=h, steps=steps, digits=5, **start)
    assert found.tangent is not None
    return found.tangent


@pytest.mark.left_to_ci
def test_in_chaos_the_growth_is_the_motion_s() -> None:
    found = tangent(HENON, "rk4", "0.2", 600, q=["0", "-0.15"], p=["0.5277", "0"])
    assert (found.motion, found.cause, found.law.name) == ("exponential", "motion", "exponential")
    assert 0.08 < float(found.finite_time_lyapunov) < 0.12
    assert float(found.per_area) < 1e-3, "W grew as areas did, and S of a step is small"
    assert "not the scheme's" in found.meaning


def test_a_scheme_that_amplifies_is_told_from_it() -> None:
    found = tangent(LINEAR, "lie2", "0.6", 300, q=["0.3", "-0.1"], p=["0.1", "0.2"])
    assert (found.motion, found.cause) == ("exponential", "scheme")
    assert "the scheme's at this step size" in found.meaning


@pytest.mark.left_to_ci
def test_on_a_quasi_periodic_orbit_a_power_is_measured_and_said_to_be() -> None:
    found = tangent(HENON, "lie2", "0.05", 2000, q=["0.3", "-0.1"], p=["0.1", "0.2"])
    assert (found.motion, found.cause) == ("polynomial", None)
    assert "measured, not proved" in found.meaning
    assert "the motion's" not in found.meaning
