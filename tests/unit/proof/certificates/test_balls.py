"""Enclosures of functions contain the value."""

from fractions import Fraction

import pytest
from mpmath.ctx_mp import MPContext

from verify.proof.certificates import balls


@pytest.mark.parametrize(("kind", "x"), [("sin", 3), ("cos", -3), ("exp", 2), ("inverse", 7)])
def test_enclosures_contain_the_value(kind: str, x: int) -> None:
    context = MPContext()
    context.dps = 60
    exact = (lambda y: 1 / y) if kind == "inverse" else getattr(context, kind)
    for radius in (Fraction(0), Fraction(1, 1000)):
        middle, bound = balls.function(kind, (Fraction(x), radius))
        for end in (x - radius, x + radius):
            value = exact(context.mpf(end.numerator) / end.denominator)
            assert abs(context.mpf(middle.numerator) / middle.denominator - value) <= (
                context.mpf(bound.numerator) / bound.denominator + context.mpf(10) ** -50
            )
        assert bound < Fraction(1, 10**9) + 1000 * radius
