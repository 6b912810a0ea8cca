"""Dual numbers of many digits, x + a ε_p + b ε_q: a value and its derivatives by p and q.

They can be compared, by their values, so that branches and loops with a tolerance go through: what
comes out has the derivatives of the operations that were done. gmpy2's context is set by `running`.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import TypeAlias

import gmpy2

from verify.arithmetic.exact import fraction
from verify.integrators.tracing.number import OPERATORS, Kind, TracedNumber, UntraceableError

Number: TypeAlias = gmpy2.mpfr
BITS = 200
SLOPES: dict[str, Callable[[Number, Number], Number]] = {  # of each function y of x
    "sin": lambda x, _: gmpy2.cos(x),
    "cos": lambda x, _: -gmpy2.sin(x),
    "tan": lambda _, y: 1 + y * y,
    "tanh": lambda _, y: 1 - y * y,
    "exp": lambda _, y: y,
    "sinh": lambda x, _: gmpy2.cosh(x),
    "cosh": lambda x, _: gmpy2.sinh(x),
    "log": lambda x, _: 1 / x,
    "atan": lambda x, _: 1 / (1 + x * x),
    "sqrt": lambda _, y: 1 / (2 * y) if y else gmpy2.mpfr(0),
}


class Duals(Kind):
    """Makes dual numbers of `BITS` bits. Use it inside `running`."""

    def __init__(self) -> None:
        super().__init__()
        self.compared = False  # whether values were: there may be branches, or a tolerance

    @contextmanager
    def running(self) -> Iterator[None]:
        with gmpy2.context(precision=BITS, round=gmpy2.RoundToNearest):
            yield

    def rational(self, value: Fraction) -> "Dual":
        zero = gmpy2.mpfr(0)
        return Dual(self, gmpy2.mpfr(gmpy2.mpq(value.numerator, value.denominator)), zero, zero)

    def pi(self) -> "Dual":
        zero = gmpy2.mpfr(0)
        return Dual(self, gmpy2.const_pi(), zero, zero)

    def state(self, p: Fraction, q: Fraction) -> tuple["Dual", "Dual"]:
        """p and q, whose derivatives are the unit vectors."""
        x, y = self.rational(p), self.rational(q)
        one = gmpy2.mpfr(1)
        return Dual(self, x.value, one, x.by_q), Dual(self, y.value, y.by_p, one)


class Dual(TracedNumber):
    """`value`, and `by_p` and `by_q`, its partial derivatives."""

    __slots__ = ("by_p", "by_q", "value")
    kind: Duals

    def __init__(self, kind: Duals, value: Number, by_p: Number, by_q: Number) -> None:
        super().__init__(kind)
        self.value, self.by_p, self.by_q = value, by_p, by_q

    def _chained(self, value: Number, slope: Number) -> "Dual":
        return Dual(self.kind, value, slope * self.by_p, slope * self.by_q)

    def known(self) -> Fraction | None:
        """Its value where it does not move with p and q and is a rational of few bits."""
        if self.by_p or self.by_q or not gmpy2.is_finite(self.value):
            return None
        exact = fraction(self.value)
        if exact.numerator.bit_length() + exact.denominator.bit_length() < BITS // 2:
            return exact
        # 1/3 and its like, as exponents: rounded to the working precision, and read back.
        near = exact.limit_denominator(10**4)
        return near if self.kind.rational(near).value == self.value else None

    def compared(self, other: "Dual") -> int:
        self.kind.compared = True
        if gmpy2.is_nan(self.value) or gmpy2.is_nan(other.value):
            return 2 if gmpy2.is_nan(self.value) else -2
        return int(self.value > other.value) - int(self.value < other.value)

    def combined(self, name: str, other: "Dual") -> "Dual":
        x, y = self.value, other.value
        match name:
            case "add" | "subtract":
                parts = ((x, y), *self._slopes(other))
                return Dual(self.kind, *(OPERATORS[name](a, b) for a, b in parts))
            case "multiply":
                by_p, by_q = (a * y + x * b for a, b in self._slopes(other))
                return Dual(self.kind, x * y, by_p, by_q)
        if y == 0:
            raise ZeroDivisionError("division by zero")
        z = x / y
        by_p, by_q = ((a - z * b) / y for a, b in self._slopes(other))
        return Dual(self.kind, z, by_p, by_q)

    def _slopes(self, other: "Dual") -> tuple[tuple[Number, Number], tuple[Number, Number]]:
        return (self.by_p, other.by_p), (self.by_q, other.by_q)

    def applied(self, name: str) -> "Dual":
        x = self.value
        if (name == "sqrt" and x < 0) or (name == "log" and x <= 0):
            raise ValueError("math domain error")
        y = getattr(gmpy2, name)(x)
        return self._chained(y, SLOPES[name](x, y))

    def raised(self, exponent: Fraction) -> "Dual":
        x = self.value
        if exponent.denominator == 1:
            n = int(exponent)
            if n == 0:
                return self.kind.rational(Fraction(1))
            if x == 0 and n < 0:
                raise ZeroDivisionError("0 cannot be raised to a negative power")
            return self._chained(x**n, n * x ** (n - 1))
        if x <= 0:
            raise UntraceableError("it takes the root of a number that is not positive")
        power = gmpy2.mpfr(gmpy2.mpq(exponent.numerator, exponent.denominator))
        y = x**power
        return self._chained(y, power * y / x)

    def isfinite(self) -> bool:
        return bool(gmpy2.is_finite(self.value))
