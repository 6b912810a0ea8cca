"""What is known of a coupling holds: where it is bounded, and where it may be negative."""

from itertools import product

import mpmath
import pytest
import sympy
from hypothesis import strategies as st

from tests.helpers.sampled.drawing import fuzzed
from verify.strategies.formulas import KINDS
from verify.strategies.formulas_in_degrees import Coupling, Form, forms
from verify.strategies.terms import Drawer, Limits

NAMES = sympy.symbols("p q P Q")
SIZES = (0, 1, -3, 1000, -(10**4))
MOST = 3  # of what is bounded
EVERY = list(
    dict.fromkeys(form for kind in KINDS for form in forms(kind, 6, separable=False, bounded=None))
)
every_form = pytest.mark.parametrize("form", EVERY, ids=lambda form: form.draw.__name__)


def drawn(form: Form) -> list[Coupling]:
    return fuzzed(st.composite(lambda draw: form.draw(Drawer(draw, Limits())))(), 6)


def values(coupling: Coupling, axes: bool) -> list[mpmath.mpf]:
    """With 1 for its coefficient; on the axes alone, or at points that lie all over."""
    text = f"({coupling.numerator or 1})/({coupling.denominator or 1})"
    own = dict(zip(("p", "q", "P", "Q"), NAMES, strict=True))
    at = sympy.lambdify(NAMES, sympy.sympify(text, locals=own), "mpmath")
    points = product(SIZES, repeat=4)
    return [at(*map(mpmath.mpf, z)) for z in points if not axes or sum(map(bool, z)) <= 1]


@every_form
def test_what_takes_a_positive_coefficient_is_nowhere_negative(form: Form) -> None:
    for coupling in drawn(form):
        assert not coupling.positive or min(values(coupling, axes=False)) >= 0, coupling


@every_form
def test_what_keeps_an_h_confined_is_bounded_below_with_any_coefficient_that_it_takes(
    form: Form,
) -> None:
    for coupling in drawn(form):
        found = values(coupling, axes=False)
        bounded = max(map(abs, found)) <= MOST
        assert not form.confined or bounded or (coupling.positive and min(found) >= 0), coupling


@every_form
def test_what_is_flat_is_bounded_on_every_axis(form: Form) -> None:
    for coupling in drawn(form):
        bounded = max(map(abs, values(coupling, axes=True))) <= MOST
        assert bounded or not form.flat, coupling
