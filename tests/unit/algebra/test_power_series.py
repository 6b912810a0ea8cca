"""Truncated power series in h, and functions at points given by them, against sympy's series."""

from fractions import Fraction

import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q, plain
from verify.algebra.embedding import embed
from verify.algebra.power_series import Derivatives, Series, expand_at
from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.steps.defect import DefectSeries

H = plain("h")
MOST = 4


def ring_with(text: str) -> tuple[Ring, Poly]:
    ring, (x,) = embed([plain(text)], ("p", "q", "h", "a"))
    return ring, x


def series(ring: Ring, *coefficients: str) -> Series:
    """Of polynomials in p, q and a."""
    names = {name: ring.variable(name) for name in ("p", "q", "a")}
    values = [ring.zero + eval(text, {}, names) for text in coefficients]  # noqa: S307 - own text
    return Series.from_coefficients(ring, values, MOST)


FUNCTIONS = [
    "p**3*q**2 + a*p*q",
    "sin(q) + p**2",
    "exp(a*p)*cos(q)",
    "sqrt(1 + p**2 + q**2)",
    "1/(1 + q**2)",
    "log(cosh(q)) + p",
]


@pytest.mark.sample(3)
@pytest.mark.parametrize("text", FUNCTIONS)
def test_a_function_at_a_point_is_its_taylor_series(text: str) -> None:
    ring, x = ring_with(text)
    u, v = series(ring, "0", "q", "a*p*q", "p"), series(ring, "0", "p", "-q**2")
    found = expand_at(Derivatives(ring, x), [("p", u), ("q", v)], MOST)
    moved = {P: P + H * Q + H**2 * plain("a*p*q") + H**3 * P, Q: Q + H * P - H**2 * Q**2}
    at = {P: sympy.Rational(3, 7), Q: sympy.Rational(5, 11), plain("a"): sympy.Rational(2, 3)}
    whole = plain(text).xreplace(moved)
    for n, coefficient in enumerate(found.coefficients):
        expected = whole.diff(H, n).subs(H, 0) / sympy.factorial(n) if n else plain(text)
        gap = (ring.expression(coefficient) - expected).subs(at)
        assert abs(gap.evalf(40, chop=False)) < sympy.Rational(1, 10**30), n


def test_a_point_that_is_elsewhere_at_h_0_is_refused() -> None:
    ring, x = ring_with("p*q")
    elsewhere, here = series(ring, "p"), series(ring, "0", "q")
    for u, v in ((elsewhere, here), (here, elsewhere)):
        with pytest.raises(ValueError, match="at h = 0"):
            expand_at(Derivatives(ring, x), [("p", u), ("q", v)], MOST)


def test_series_are_multiplied_and_cut_off() -> None:
    ring, _ = ring_with("p")
    x, y = series(ring, "p", "q", "0", "0", "1"), series(ring, "q", "-p", "0", "0", "p")
    expected = series(ring, "p*q", "q**2 - p**2", "-p*q", "0", "p**2 + q")
    assert (x * y).coefficients == expected.coefficients
    assert (x - x).coefficients == series(ring).coefficients
    assert (x.times(Fraction(1, 2)) + x.times(Fraction(1, 2))).coefficients == x.coefficients
    assert x.shift(1).coefficients == series(ring, "0", "p", "q").coefficients


@pytest.mark.parametrize("name", ["lie2", "symplectic-euler", "explicit-midpoint"])
def test_delta_j_of_a_series_is_that_of_the_closed_form(name: str) -> None:
    step_map = get(name).step_map(Hamiltonian.parse("p**2/2 + q**2/2 + a*q**4/4"))
    expanded = step_map.series(MOST)
    assert expanded is not None
    field, state = expanded
    closed = sympy.Poly(step_map.delta_j, H)
    made = DefectSeries(lambda _: (field, state), MOST)
    for n in range(MOST + 1):
        coefficient = made.form(n).divergence
        assert sympy.expand(field.ring.expression(coefficient) - closed.coeff_monomial(H**n)) == 0
