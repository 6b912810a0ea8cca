"""Roots of numbers in the ring, however large or small the numbers are."""

from fractions import Fraction

import pytest
import sympy

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision


@pytest.mark.parametrize("number", ["2", "471", "123456789/1000", "3/10**20", "7*10**41/9"])
@pytest.mark.parametrize("degree", [2, 3, 5])
@pytest.mark.parametrize("power", [1, -1, 2])
def test_a_root_of_a_number_of_any_size_is_that_root(number: str, degree: int, power: int) -> None:
    """Large and small ones are scaled, so that no generator is out of fixed point's reach."""
    base = sympy.Rational(sympy.sympify(number))
    root = sympy.Pow(base, sympy.Rational(power, degree))
    ring, (x,) = embed([root], ("p",))
    found = enclose(ring, x, {}, 300)
    with working_precision(300):
        exact = rational_ball(Fraction(int(base.p), int(base.q)))
        true = exact.root(degree) ** power
        assert abs(found / true - 1) < 1e-80
        assert abs(found / true * 2 - 1) > 0.5
    (same,) = embed([root**degree - base**power], ("p",))[1]
    assert same == 0
    for g in ring.generators_in(x):
        with working_precision(300):
            value = enclose(ring, g.argument, {}, 300) if g.kind == "root" else 1
            assert value < 2 ** max(degree + 1, 13)
