"""gmpy2's rationals in the place of Fractions: the same numbers, order, differences and floats."""

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.arithmetic.exact import fraction, quotient
from verify.arithmetic.systems import mpfr

SCALED = st.builds(
    lambda x, e: x * Fraction(10) ** e, st.fractions(max_denominator=10**9), st.integers(-300, 290)
)


@drawn(150)
@given(x=st.floats(allow_nan=False, allow_infinity=False), y=SCALED)
def test_a_quotient_is_the_number_and_does_as_fractions_do(x: float, y: Fraction) -> None:
    one, other = quotient(x), quotient(y)
    assert (fraction(one), fraction(other)) == (Fraction(x), y)
    assert type(fraction(other).numerator) is type(fraction(other).denominator) is int
    assert fraction(one - other) == Fraction(x) - y
    assert (one < other, x < other, one < y) == (Fraction(x) < y,) * 3
    assert float(other) == float(y)
    assert quotient(one) == one


@drawn(100)
@given(x=st.floats(allow_nan=False, allow_infinity=False), y=SCALED)
def test_a_number_of_mpfr_is_compared_exactly_with_any_of_them(x: float, y: Fraction) -> None:
    wide = mpfr.at_bits(200).number(y)
    exact = fraction(quotient(wide))
    assert exact == mpfr.at_bits(200).exact(wide)
    assert (wide < x, x < wide) == (exact < Fraction(x), Fraction(x) < exact)
    near = quotient(y)
    assert (wide < near, near < wide) == (exact < y, y < exact)
