"""Arrays of floats behind the names of mpmath's context, so that one formula serves both.

Plain arrays and numbers serve formulas without branches; a `Batch` those with branches as well.
numpy is imported when a function is first asked for.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import cached_property
from types import ModuleType
from typing import TYPE_CHECKING, Any

from verify.arithmetic.batch import Batch, choose, some

if TYPE_CHECKING:
    import numpy

Number = Any  # a float, an array of floats, or a Batch
_PI = "3.14159265358979323846264338327950288419716939937510582"


class FloatContext:
    """What formulas ask of `mp`, elementwise, in float64 or in the C compiler's long double.

    `wide`: long double, which has 64 bits or more on most machines, and 53 on the others.
    """

    def __init__(self, wide: bool = False) -> None:
        self.wide = wide

    @cached_property
    def _np(self) -> ModuleType:
        import numpy

        return numpy

    @cached_property
    def type(self) -> "type[numpy.floating]":
        """numpy's type of its numbers."""
        found: type[numpy.floating] = self._np.longdouble if self.wide else self._np.float64
        return found

    @cached_property
    def prec(self) -> int:
        return int(self._np.finfo(self.type).nmant) + 1

    @cached_property
    def eps(self) -> Number:
        return self._np.finfo(self.type).eps

    @cached_property
    def pi(self) -> Number:
        return self.type(_PI)

    @property
    def inf(self) -> Number:
        return self.type("inf")

    # -- numbers --------------------------------------------------------------------------------

    def mpf(self, x: Number) -> Number:
        """A number, a text or a batch in this precision."""
        if isinstance(x, Batch):
            return Batch(x.values.astype(self.type))
        return self._np.asarray(x, dtype=self.type)[()]

    def mpc(self, x: Number) -> Number:
        return self._each(lambda v: v + 0j, x)

    def rational(self, x: Number) -> Number:
        """An exact rational, or a batch of them, rounded once."""
        if isinstance(x, Batch):
            high, low = x.parts
            return Batch(high.astype(self.type) + low if self.wide else high)
        near = float(x)
        return self.type(near) + (float(x - Fraction(near)) if self.wide else 0)

    def ldexp(self, x: Number, n: int) -> Number:
        return self._each(lambda v: self._np.ldexp(self.type(v), n), x)

    def mag(self, x: Number) -> Number:
        """The exponent of the power of 2 above."""
        return self._each(lambda v: self._np.frexp(v)[1], x)

    def _each(self, function: Callable[..., Number], *xs: Number) -> Number:
        if not any(isinstance(x, Batch) for x in xs):
            return function(*xs)
        return Batch(function(*(x.values if isinstance(x, Batch) else x for x in xs)))

    # -- functions ------------------------------------------------------------------------------

    def re(self, x: Number) -> Number:
        return self._each(self._np.real, x)

    def nint(self, x: Number) -> Number:
        return self._each(self._np.rint, x)

    def floor(self, x: Number) -> Number:
        return self._each(self._np.floor, x)

    def sign(self, x: Number) -> Number:
        return self._each(self._np.sign, x)

    def sqrt(self, x: Number) -> Number:
        return self._each(self._np.sqrt, x)

    def cbrt(self, x: Number) -> Number:
        return self._each(self._np.cbrt, x)

    def exp(self, x: Number) -> Number:
        return self._each(self._np.exp, x)

    def log(self, x: Number) -> Number:
        return self._each(self._np.log, x)

    def sin(self, x: Number) -> Number:
        return self._each(self._np.sin, x)

    def cos(self, x: Number) -> Number:
        return self._each(self._np.cos, x)

    def cos_sin(self, x: Number) -> tuple[Number, Number]:
        return self.cos(x), self.sin(x)

    def asin(self, x: Number) -> Number:
        return self._each(self._np.arcsin, x)

    def atan2(self, y: Number, x: Number) -> Number:
        return self._each(self._np.arctan2, y, x)

    def sinh(self, x: Number) -> Number:
        return self._each(self._np.sinh, x)

    def cosh(self, x: Number) -> Number:
        return self._each(self._np.cosh, x)

    def tanh(self, x: Number) -> Number:
        return self._each(self._np.tanh, x)

    def sech(self, x: Number) -> Number:
        return 1 / self.cosh(x)

    def ellipk(self, m: Number) -> Number:
        """The complete elliptic integral K(m), 0 ≤ m < 1, by the arithmetic-geometric mean."""
        a, b = self.mpf(1), self.sqrt(1 - m)
        while some(abs(a - b) > self.eps * 2 * a):
            a, b = (a + b) / 2, self.sqrt(a * b)
        return self.pi / (a + b)

    def elliprf(self, x: Number, y: Number, z: Number) -> Number:
        """Carlson's R_F by duplication (B. C. Carlson, Numer. Algorithms 10, 1995, section 2)."""
        x, y, z = (self.mpc(v) for v in (x, y, z))
        mean = (x + y + z) / 3
        near = self.eps ** self.type("0.125")  # the series that ends has an error of order 8
        while some(_largest(abs(mean - x), abs(mean - y), abs(mean - z)) > near / 4 * abs(mean)):
            a, b, c = self.sqrt(x), self.sqrt(y), self.sqrt(z)
            more = a * b + b * c + c * a
            x, y, z, mean = (x + more) / 4, (y + more) / 4, (z + more) / 4, (mean + more) / 4
        u, v = 1 - x / mean, 1 - y / mean
        w = -u - v
        e2, e3 = u * v - w * w, u * v * w
        series = 1 - e2 / 10 + e3 / 14 + e2**2 / 24 - 3 * e2 * e3 / 44
        series = series - 5 * e2**3 / 208 + 3 * e3**2 / 104 + e2**2 * e3 / 16
        return series / self.sqrt(mean)


def _largest(a: Number, b: Number, c: Number) -> Number:
    a = choose(a > b, a, b)
    return choose(a > c, a, c)


FLOAT = FloatContext()
WIDE = FloatContext(wide=True)
