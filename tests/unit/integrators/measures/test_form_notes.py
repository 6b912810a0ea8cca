"""A wrong sign, velocities and slopes in place of momenta are named; and nothing where none is."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import verify
from verify.integrators.measures.form_notes import note_constants
from verify.integrators.measures.reading import Component, DefectReading
from verify.integrators.places.trial_places import TrialPlace

PENDULUM = "p**2/2 - cos(q)"
MASSES = np.array([1.0, 3.0])
Map = Callable[..., Any]


def verlet(p, q, h):
    p = p - h / 2 * math.sin(q)
    q = q + h * p
    return p - h / 2 * math.sin(q), q


def slopes(z):
    """x', δ, x, τ: x' = p/(1 + δ), and δ is kept."""
    a, d, x, tau = z
    a = a - 0.4 * x**2 / (1 + d)
    return [a, d, x + 0.7 * a, tau - 0.35 * a * a]


def slopes_wrong(z):
    a, d, x, tau = slopes(z)
    return [a, d, x, tau + 0.01 * a]


def two_velocities(p, q):
    p = p - 0.1 * np.sin(q)
    return p / MASSES, q + 0.1 * p / MASSES


MAPS: list[tuple[Map, int, str]] = [
    (lambda p, q: (-verlet(p, q, 0.3)[0], verlet(p, q, 0.3)[1]), 1, "S = −2Ω: p is turned at"),
    (lambda p, q: (verlet(p, q, 0.3)[0], -verlet(p, q, 0.3)[1]), 1, "S = −2Ω: q is turned at"),
    (lambda p, q: (q, p), 1, "S = −2Ω: p or q is turned, or they are exchanged"),
    (lambda p, q: (0.9 * verlet(p, q, 0.3)[0], verlet(p, q, 0.3)[1]), 1, "with c = 0.9 at every"),
    (two_velocities, 2, "with c = (1, 0.333333) at every place"),
    (slopes, 2, "it keeps the form of momenta (1 + p2) p: slopes x' are taken"),
]


@pytest.mark.parametrize(("function", "degrees", "note"), MAPS)
def test_a_mistake_of_a_map_is_named(function: Map, degrees: int, note: str) -> None:
    found = verify.check_map(function, degrees)
    assert found.verdict == "REFUTED"
    assert [x for x in found.notes if note in x]


@pytest.mark.parametrize(
    ("function", "degrees"),
    [(lambda p, q: (p + 0.1 * q * p, q), 1), (slopes_wrong, 2)],
)
def test_another_mistake_is_not_called_one_of_these(function: Map, degrees: int) -> None:
    found = verify.check_map(function, degrees)
    assert found.verdict == "REFUTED"
    assert not [x for x in found.notes if "momenta" in x or "Ω" in x or "every place" in x]


def test_a_step_that_turns_p_or_returns_velocities_is_named() -> None:
    turned = verify.check(PENDULUM, lambda p, q, h: (-verlet(p, q, h)[0], verlet(p, q, h)[1]))
    assert "S = −2Ω: p is turned at the end" in turned.notes
    slow = verify.check(PENDULUM, lambda p, q, h: (verlet(p, q, h)[0] / 3, verlet(p, q, h)[1]))
    assert [x for x in slow.notes if "velocities p/m are returned" in x and "m = (3)" in x]
    damped = verify.check(
        PENDULUM, lambda p, q, h: (verlet(p, q, h)[0] * math.exp(-h), verlet(p, q, h)[1])
    )
    assert not [x for x in damped.notes if "velocities" in x]


def test_a_form_that_is_kept_within_its_noise_shows_no_mistake() -> None:
    """As where a proof alone tells that an iteration of many turns ends early."""
    one = Fraction(1)
    place = TrialPlace((one, one), Fraction(0), (one, one), (one, one))
    for value, expected in ((1e-30, 0), (0.5, 1)):
        readings = [
            DefectReading(place, h, {(0, 1): Component(value, 1e-16, 1.0)}, 0.0, 1e-16, ())
            for h in (one, one / 2)
        ]
        assert len(note_constants(readings, ("p", "q"))) == expected
