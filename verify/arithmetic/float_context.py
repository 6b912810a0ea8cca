"""Arrays of floats with the interface of mpmath's context, so that one formula serves both.

numpy is imported when a number or a function is first used.
"""

from fractions import Fraction
from functools import cached_property
from typing import Any

Context = Any  # mpmath's MPContext, which has no type stubs, or a FloatContext
Number = Any  # a real number of that context: mpmath's, a float, or an array of floats
_PI = "3.14159265358979323846264338327950288419716939937510582"


class FloatContext:
    """The part of mpmath's context that formulas use, elementwise in float64 or in long double.

    `wide`: in the C compiler's long double, which has 64 bits or more on most machines, and 53 on
    others.
    """

    def __init__(self, wide: bool = False) -> None:
        self.wide = wide

    @cached_property
    def _np(self) -> Any:
        import numpy

        return numpy

    @cached_property
    def type(self) -> Any:
        """The numpy type of its numbers."""
        return self._np.longdouble if self.wide else self._np.float64

    @cached_property
    def prec(self) -> int:
        return int(self._np.finfo(self.type).nmant) + 1

    @cached_property
    def eps(self) -> Number:
        return self._np.finfo(self.type).eps

    @cached_property
    def pi(self) -> Number:
        return self.type(_PI)

    def mpf(self, x: Any) -> Number:
        return self._np.asarray(x, dtype=self.type)[()]

    def rational(self, x: Fraction) -> Number:
        """Return an exact rational, rounded to the nearest number; long doubles, in rare cases, to
        the second nearest."""
        # The float64 nearest to x, plus the remainder in float64, added in long double: only if the
        # rounded remainder lies across a tie is the sum not the nearest number.
        high = float(x)
        return self.type(high) + (float(x - Fraction(high)) if self.wide else 0)

    def exp(self, x: Number) -> Number:
        return self._np.exp(x)

    def sin(self, x: Number) -> Number:
        return self._np.sin(x)

    def cos(self, x: Number) -> Number:
        return self._np.cos(x)


def number(mp: Context, x: Fraction) -> Number:
    """Return an exact rational as a number of the context."""
    if isinstance(mp, FloatContext):
        return mp.rational(x)
    return mp.mpf(x.numerator) / x.denominator


FLOAT = FloatContext()
WIDE = FloatContext(wide=True)
