"""What is known of a coupling holds: where it is bounded, where it may be negative, its degrees."""

from itertools import product

import mpmath
import pytest
import sympy
from hypothesis import strategies as st

from tests.helpers.sampled.drawing import fuzzed
from verify.strategies.couplings import Coupling, couplings, number_variables
from verify.strategies.terms import KINDS, Drawer, FormulaLimits

NAMES = sympy.symbols("p q P Q")
SIZES = (0, 1, -3, 1000, -(10**4))
MOST = 3  # of what is bounded
EVERY = list(
    dict.fromkeys(x for kind in KINDS for x in couplings(kind, 6, separable=False, bounded=None))
)
every_coupling = pytest.mark.parametrize(
    "coupling", EVERY, ids=lambda x: f"{x.numerators[0]}, {x.denominator}"
)


def drawn(coupling: Coupling) -> list[tuple[str, str]]:
    return fuzzed(
        st.composite(lambda draw: coupling.draw_sides(Drawer(draw, FormulaLimits())))(), 6
    )


def values(sides: tuple[str, str], axes: bool) -> list[mpmath.mpf]:
    """With 1 for its coefficient; on the axes alone, or at points that lie all over."""
    text = f"({sides[0] or 1})/({sides[1] or 1})"
    own = dict(zip(("p", "q", "P", "Q"), NAMES, strict=True))
    at = sympy.lambdify(NAMES, sympy.sympify(text, locals=own), "mpmath")
    points = product(SIZES, repeat=4)
    return [at(*map(mpmath.mpf, z)) for z in points if not axes or sum(map(bool, z)) <= 1]


@every_coupling
def test_what_takes_a_positive_coefficient_is_nowhere_negative(coupling: Coupling) -> None:
    for sides in drawn(coupling):
        assert not coupling.positive or min(values(sides, axes=False)) >= 0, sides


@every_coupling
def test_what_keeps_an_h_confined_is_bounded_below_with_any_coefficient_that_it_takes(
    coupling: Coupling,
) -> None:
    for sides in drawn(coupling):
        found = values(sides, axes=False)
        bounded = max(map(abs, found)) <= MOST
        assert not coupling.confined or bounded or (coupling.positive and min(found) >= 0), sides


@every_coupling
def test_what_is_flat_is_bounded_on_every_axis(coupling: Coupling) -> None:
    for sides in drawn(coupling):
        bounded = max(map(abs, values(sides, axes=True))) <= MOST
        assert bounded or not coupling.flat, sides


def test_a_coupling_has_two_degrees_and_the_asked_properties() -> None:
    assert len(EVERY) == 15
    assert all(x.separable for x in couplings("rational", 6, separable=True, bounded=None))
    assert all(x.confined for x in couplings("exponential", 6, separable=False, bounded=True))
    assert not list(couplings("polynomial", 1, separable=True, bounded=None))


def test_degrees_are_numbered_in_names_alone() -> None:
    assert number_variables("exp(-p**2) + sin(2*q)*P", 3, 12) == "exp(-p3**2) + sin(2*q3)*p12"
