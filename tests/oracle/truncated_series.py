"""Power series that are cut off, in numbers of 100 digits, with their derivatives by p, q and t.

The arithmetic of `tests.oracle.printed_certificates`; nothing here comes from `verify`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from mpmath.ctx_mp import MPContext

MP = MPContext()
DIGITS = 100
MP.dps = DIGITS


class Series:
    """A power series in one variable, cut off: Σ c_n xⁿ."""

    def __init__(self, coefficients: Sequence[Any]) -> None:
        self.c = list(coefficients)

    def like(self, x: Any) -> "Series":
        return x if isinstance(x, Series) else Series([MP.mpf(x), *[MP.mpf(0)] * (len(self.c) - 1)])

    def __add__(self, other: Any) -> "Series":
        return Series([a + b for a, b in zip(self.c, self.like(other).c, strict=True)])

    def __neg__(self) -> "Series":
        return Series([-a for a in self.c])

    def __mul__(self, other: Any) -> "Series":
        # Constants are series of zeros but for one number: what is 0 is left out.
        own = [(k, x) for k, x in enumerate(self.c) if x]
        found = [MP.mpf(0)] * len(self.c)
        for m, y in enumerate(self.like(other).c):
            if y:
                for k, x in own:
                    if k + m < len(found):
                        found[k + m] += x * y
        return Series(found)

    def inverse(self) -> "Series":
        found: list[Any] = []
        for n in range(len(self.c)):
            known = sum((self.c[k] * found[n - k] for k in range(1, n + 1)), MP.mpf(0))
            found.append(((1 if n == 0 else 0) - known) / self.c[0])
        return Series(found)

    def of(self, kind: str) -> "Series":
        """exp, sin or cos, by f' = g u' with g the derivative of the function."""
        u = self.c
        other, sign = {"exp": ("exp", 1), "sin": ("cos", 1), "cos": ("sin", -1)}[kind]
        own, side = [getattr(MP, kind)(u[0])], [getattr(MP, other)(u[0])]
        for n in range(1, len(u)):
            slope = sum((k * u[k] * side[n - k] for k in range(1, n + 1)), MP.mpf(0)) / n
            back = sum((k * u[k] * own[n - k] for k in range(1, n + 1)), MP.mpf(0)) / n
            own.append(sign * slope)
            side.append(own[-1] if kind == "exp" else -sign * back)
        return Series(own)


@dataclass
class Dual:
    """A series with its derivatives by p, q and t."""

    v: Series
    p: Series
    q: Series
    t: Series

    @property
    def slopes(self) -> tuple[Series, Series, Series]:
        return self.p, self.q, self.t

    def like(self, x: Any) -> "Dual":
        return x if isinstance(x, Dual) else Dual(self.v.like(x), *[self.v.like(0)] * 3)

    def __add__(self, other: Any) -> "Dual":
        o = self.like(other)
        slopes = (a + b for a, b in zip(self.slopes, o.slopes, strict=True))
        return Dual(self.v + o.v, *slopes)

    def __neg__(self) -> "Dual":
        return Dual(-self.v, *(-a for a in self.slopes))

    def __mul__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):  # a constant
            return Dual(self.v * other, *(a * other for a in self.slopes))
        slopes = (a * other.v + self.v * b for a, b in zip(self.slopes, other.slopes, strict=True))
        return Dual(self.v * other.v, *slopes)

    def chained(self, value: Series, slope: Series) -> "Dual":
        return Dual(value, *(slope * a for a in self.slopes))

    def inverse(self) -> "Dual":
        one = self.v.inverse()
        return self.chained(one, -(one * one))

    def of(self, kind: str) -> "Dual":
        slope = {"exp": "exp", "sin": "cos", "cos": "sin"}[kind]
        by = self.v.of(slope)
        return self.chained(self.v.of(kind), -by if kind == "cos" else by)

    def power(self, n: int) -> "Dual":
        found, base = self.like(1), self
        while n:
            found, base, n = (found * base if n % 2 else found), base * base, n // 2
        return found
