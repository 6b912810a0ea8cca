"""The outer solar system: its numbers, its equation, and what a run of it keeps."""

import math
from fractions import Fraction
from typing import Any

import mpmath
import pytest

import verify
from tests.helpers.textbook_hamiltonians import example, gradients_apart

SUN = example("outer-solar-system", "september-1994")
MASSES = [SUN.values[f"m{k}"] for k in range(6)]
PLANETS = {1: 5.20, 2: 9.55, 3: 19.2, 4: 30.1, 5: 39.5}  # semi-major axes in AU, of any almanac


def textbook(q: Any, p: Any, _: Any, G: Any, **masses: Any) -> Any:
    m = [masses[f"m{k}"] for k in range(6)]
    total = sum(p[3 * k + i] ** 2 / m[k] for k in range(6) for i in range(3)) / 2
    for k in range(1, 6):
        for j in range(k):
            apart = mpmath.norm([q[3 * k + i] - q[3 * j + i] for i in range(3)])
            total -= G * m[j] * m[k] / apart
    return total


def test_it_is_newtons_attraction_of_six_bodies() -> None:
    assert SUN.hamiltonian.degrees == 18
    assert gradients_apart(SUN, textbook) < 1e-30


def test_a_mass_that_is_wrong_in_its_last_digit_is_seen() -> None:
    def wrong(q: Any, p: Any, t: Any, **values: Any) -> Any:
        values["m1"] += mpmath.mpf(10) ** -15
        return textbook(q, p, t, **values)

    assert gradients_apart(SUN, wrong) > 1e-30


def test_momenta_are_masses_times_the_printed_velocities() -> None:
    velocities = [p / MASSES[k // 3] for k, p in enumerate(SUN.p)]
    assert all((v * 10**8).denominator == 1 for v in velocities), "they have eight decimals"
    assert all((x * 10**7).denominator == 1 for x in SUN.q), "and positions seven"
    assert velocities[3:6] == [Fraction(x, 10**8) for x in (565429, -412490, -190589)]
    assert velocities[15:] == [Fraction(x, 10**8) for x in (276725, -170702, -136504)]
    assert not any((*SUN.q[:3], *SUN.p[:3])), "the Sun rests at the origin"


@pytest.mark.parametrize("planet", PLANETS)
def test_each_planet_has_its_semi_major_axis(planet: int) -> None:
    """By the equation of the living force: a digit that is wrong among the first ones is seen."""
    here = slice(3 * planet, 3 * planet + 3)
    distance = math.hypot(*SUN.q[here])
    speed = math.hypot(*(p / MASSES[planet] for p in SUN.p[here]))
    pull = float(SUN.values["G"] * (MASSES[0] + MASSES[planet]))
    assert 1 / (2 / distance - speed**2 / pull) == pytest.approx(PLANETS[planet], rel=0.02)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("scheme", ["stormer-verlet", "lie2"])
def test_a_run_keeps_momentum_and_nearly_the_energy(scheme: str) -> None:
    found = verify.run(SUN.hamiltonian, scheme, q=list(SUN.q), p=list(SUN.p), step_size=10,
                       steps=100)  # fmt: skip
    p, q = ([float(found.values[f"{x}{k}"]) for k in range(1, 19)] for x in "pq")
    for axis in range(3):
        assert sum(p[axis::3]) == pytest.approx(float(sum(SUN.p[axis::3])), rel=1e-12, abs=0)
    values = {name: float(x) for name, x in SUN.values.items()}
    first, last = (float(textbook([*map(float, a)], [*map(float, b)], 0, **values))
                   for a, b in ((SUN.q, SUN.p), (q, p)))  # fmt: skip
    assert first != last
    assert last == pytest.approx(first, rel=1e-4, abs=0)
    assert math.dist(q[3:6], [*map(float, SUN.q[3:6])]) > 5, "Jupiter goes a quarter of its way"
