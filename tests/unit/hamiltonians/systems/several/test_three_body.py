"""Three bodies of equal masses: their equation, what is kept, and two orbits that are known."""

import math
from fractions import Fraction
from typing import Any

import mpmath
import pytest

import verify
from tests.helpers.textbook_hamiltonians import Example, example, gradients_apart
from verify.flows.solution import solution_from
from verify.hamiltonians.run_domain import point_of

EIGHT = example("three-body", "figure-eight")
PERIOD = Fraction("6.32591398")  # as it is published, with the initial values
PUBLISHED = 1e-7  # what eight decimals leave open after one period


def textbook(q: Any, p: Any, _: Any) -> Any:
    bodies = [mpmath.mpc(q[2 * k], q[2 * k + 1]) for k in range(3)]
    pairs = [(0, 1), (0, 2), (1, 2)]
    return sum(x**2 for x in p) / 2 - sum(1 / abs(bodies[j] - bodies[k]) for j, k in pairs)


def after(at: Example, time: Fraction) -> list[float]:
    """q, then p."""
    found = solution_from(at.hamiltonian, point_of(at.hamiltonian, at.q, at.p), time, 12)
    return [float(found.point[f"{letter}{k}"]) for letter in "qp" for k in range(1, 7)]


@pytest.mark.parametrize("regime", ["figure-eight", "collinear"])
def test_it_is_newtons_attraction(regime: str) -> None:
    assert gradients_apart(example("three-body", regime), textbook) < 1e-30


def test_the_figure_eight_starts_as_it_is_published() -> None:
    assert EIGHT.q[:2] == [-x for x in EIGHT.q[2:4]]
    assert EIGHT.q == [*map(Fraction, ("0.97000436", "-0.24308753")), *EIGHT.q[2:4], 0, 0]
    assert EIGHT.p[4:] == [Fraction("-0.93240737"), Fraction("-0.86473146")]
    assert EIGHT.p[:2] == EIGHT.p[2:4] == [-x / 2 for x in EIGHT.p[4:]]


@pytest.mark.left_to_ci
def test_after_a_period_the_figure_eight_is_where_it_began() -> None:
    start = [float(x) for x in (*EIGHT.q, *EIGHT.p)]
    end = after(EIGHT, PERIOD)
    assert max(abs(a - b) for a, b in zip(start, end, strict=True)) < PUBLISHED
    late = after(EIGHT, PERIOD + Fraction(1, 10**6))
    assert max(abs(a - b) for a, b in zip(start, late, strict=True)) > 5 * PUBLISHED


def test_after_a_third_of_it_each_body_is_where_another_was() -> None:
    x, y = (float(v) for v in EIGHT.q[:2])
    places = {(x, y), (-x, -y), (0.0, 0.0)}
    found = after(EIGHT, PERIOD / 3)
    for k in range(3):
        here = found[2 * k], found[2 * k + 1]
        nearest = min(places, key=lambda place: math.dist(place, here))
        assert math.dist(nearest, here) < PUBLISHED
        assert nearest != tuple(map(float, EIGHT.q[2 * k : 2 * k + 2]))
        places.remove(nearest)


def test_eulers_collinear_orbit_is_a_circle() -> None:
    """Of the radius 5 and the angular velocity 1/10."""
    x, y, *others = after(example("three-body", "collinear"), Fraction(7))
    assert abs(x - 5 * math.cos(0.7)) + abs(y - 5 * math.sin(0.7)) < 1e-11
    assert max(abs(a - b) for a, b in zip(others[:4], (-x, -y, 0, 0), strict=True)) < 1e-11


@pytest.mark.parametrize("scheme", ["stormer-verlet", "lie2"])
def test_a_run_keeps_momentum_and_verlet_angular_momentum(scheme: str) -> None:
    at = example("three-body", "figure-eight")
    p = [x + Fraction(k, 50) for k, x in enumerate(at.p)]  # with both, unlike the figure-eight
    found = verify.run("three-body", scheme, q=list(at.q), p=p, step_size="0.02", steps=40,
                       digits=25)  # fmt: skip
    end = {name: found.values[name].exact for name in at.hamiltonian.coordinates}
    for axis in (1, 2):
        total = sum(end[f"p{axis + 2 * k}"] for k in range(3))
        assert float(abs(total - sum(p[axis - 1 :: 2]))) < 1e-22
    spin = sum(end[f"q{k}"] * end[f"p{k + 1}"] - end[f"q{k + 1}"] * end[f"p{k}"] for k in (1, 3, 5))
    first = sum(at.q[k] * p[k + 1] - at.q[k + 1] * p[k] for k in (0, 2, 4))
    assert first != 0
    drift = float(abs(spin - first))
    assert drift < 1e-22 if scheme == "stormer-verlet" else 1e-12 < drift < 1e-3
