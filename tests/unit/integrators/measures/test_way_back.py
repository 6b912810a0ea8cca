"""The way back is made in the numbers of the code, and what is lost counted in their last place."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from verify.algebra.formula import symbol
from verify.integrators.measures.way_back import WayBack, go_back
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.user_code.loading import callee_from
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

SYMMETRIC = Symmetric("symmetric", "symmetric")
TURNED = Reversible("reversible", "reversible", (-symbol("p"), symbol("q")))
ONE = Fraction(1)
PLACES = [
    TrialPlace((Fraction(a, 7), Fraction(b, 9)), Fraction(0), (ONE, ONE), (ONE, ONE), ONE)
    for a, b in ((3, 5), (-4, 7), (10, -2))
]


def back(step: Callable[..., Any], structure: Any) -> WayBack | None:
    return go_back(callee_from(step, ("p", "q")).step, structure, PLACES)


def verlet(p: float, q: float, h: float) -> Any:
    p = p - h / 2 * math.sin(q)
    q = q + h * p
    return p - h / 2 * math.sin(q), q


def shear(p: float, q: float, h: float) -> Any:
    return p, q + h


def test_powers_of_two_lead_back_bit_for_bit() -> None:
    found = back(shear, SYMMETRIC)
    assert found is not None
    assert found.count == 3
    assert found.units <= 1
    exact = back(lambda p, q, h: (-p, -q), SYMMETRIC)
    assert exact == WayBack(0.0, 3, ignores_sign=True)
    assert exact.text == "in its own numbers it leads back bit for bit, at 3 places"


@pytest.mark.parametrize("structure", [SYMMETRIC, TURNED])
def test_a_scheme_that_leads_back_loses_a_few_units_at_most(structure: Any) -> None:
    kept = back(verlet, structure)
    lost = back(lambda p, q, h: (p - h * math.sin(q), q + h * p), structure)
    assert kept is not None
    assert lost is not None
    assert kept.units < 16
    assert lost.units > 1e12
    assert not kept.ignores_sign
    assert "loses up to" in lost.text


def test_a_unit_is_one_of_the_last_place_of_the_state() -> None:
    def nudged(p: float, q: float, h: float) -> Any:
        return (p, math.nextafter(q + h, math.inf)) if h > 0 else (p, q + h)

    def shifted(p: float, q: float, h: float) -> Any:
        return p, q + h + 3 * 2.0**-52 if h > 0 else q + h

    assert back(nudged, SYMMETRIC).units <= 2  # type: ignore[union-attr]
    assert back(shifted, SYMMETRIC).units >= 3  # type: ignore[union-attr]


def test_a_sign_that_is_ignored_is_seen() -> None:
    assert back(lambda p, q, h: verlet(p, q, abs(h)), SYMMETRIC).ignores_sign  # type: ignore[union-attr]
    assert not back(lambda p, q, h: verlet(p, q, abs(h)), TURNED).ignores_sign  # type: ignore[union-attr]


def test_a_step_that_fails_for_negative_h_has_no_way_back() -> None:
    def forward(p: float, q: float, h: float) -> Any:
        if h < 0:
            raise ValueError
        return verlet(p, q, h)

    assert back(forward, SYMMETRIC) is None
    assert back(forward, TURNED) is not None
