"""Dual numbers x + Σ a_k ε_k: a value and its derivatives along any number of directions.

They are compared by their values, so that they pass branches, and loops with a tolerance: a result
has the derivatives of the operations that were carried out. Each comparison is recorded with the
line of code that made it. `Duals.running` sets gmpy2's context.
"""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

import gmpy2

from verify.arithmetic.exact import fraction
from verify.functions import by_name
from verify.integrators.tracing.named_functions import OPERATORS
from verify.integrators.tracing.traced_number import Kind, TracedNumber, UntraceableError, constant

Number: TypeAlias = gmpy2.mpfr
DUAL_BITS = 200
_MAX_COMPARISONS = 4096  # recorded comparisons of one call


@dataclass(frozen=True)
class Comparison:
    """A comparison of two numbers.

    `line`: the file, the line of code and the instruction; `gap`: the first number minus the
    second; `limit`: the second number, if it is a constant.
    """

    line: tuple[str, int, int]
    gap: "DualNumber"
    limit: Number | None

    @property
    def sign(self) -> int:
        """The sign of the gap, which tells the side of the comparison."""
        return int(self.gap.value > 0) - int(self.gap.value < 0)


class Duals(Kind):
    """A factory of dual numbers with that number of bits, to be used inside `running`.

    `comparisons`: those of numbers that depend on the state; a probe begins a new list for each
    call.
    """

    def __init__(self, bits: int = DUAL_BITS) -> None:
        super().__init__()
        self.bits = bits
        self.comparisons: list[Comparison] = []
        self.compared = False  # True after a comparison: there may be branches, or a tolerance

    @contextmanager
    def running(self) -> Iterator[None]:
        with gmpy2.context(precision=self.bits, round=gmpy2.RoundToNearest):
            yield

    def rational(self, value: Fraction) -> "DualNumber":
        return DualNumber(self, gmpy2.mpfr(gmpy2.mpq(value.numerator, value.denominator)), ())

    def pi(self) -> "DualNumber":
        return DualNumber(self, gmpy2.const_pi(), ())

    def state(self, *z: Fraction) -> list["DualNumber"]:
        """Return z as dual numbers, whose derivatives are the unit vectors."""
        unit = [[gmpy2.mpfr(int(j == k)) for j in range(len(z))] for k in range(len(z))]
        pairs = zip(z, unit, strict=True)
        return [DualNumber(self, self.rational(x).value, tuple(row)) for x, row in pairs]


def slope_of(name: str, x: Number, y: Number) -> Number:
    """Return the derivative of y = f(x); that of √x at 0, which does not exist, is taken as 0."""
    if name == "sqrt" and not y:
        return gmpy2.mpfr(0)
    return by_name()[name].derivative(x, y, _apply)


def _apply(name: str, x: Number) -> Number:
    return 1 / x if name == "inverse" else getattr(gmpy2, name)(x)


def _line_of_user() -> tuple[str, int, int]:
    """Return the line that compares: that of the innermost frame outside this package and numpy."""
    frame = sys._getframe(2)
    while frame.f_back is not None:
        home = str(frame.f_globals.get("__name__", "")).partition(".")[0]
        if home not in ("verify", "numpy"):
            break
        frame = frame.f_back
    return Path(frame.f_code.co_filename).name, frame.f_lineno, frame.f_lasti


class DualNumber(TracedNumber):
    """A dual number: `value`, and `slopes`, its derivatives; () for a constant."""

    __slots__ = ("slopes", "value")
    kind: Duals

    def __init__(self, kind: Duals, value: Number, slopes: Sequence[Number]) -> None:
        super().__init__(kind)
        self.value, self.slopes = value, slopes

    def _chain(self, value: Number, slope: Number) -> "DualNumber":
        return DualNumber(self.kind, value, tuple([slope * a for a in self.slopes]))

    def exact_value(self) -> Fraction | None:
        """Return its value if it does not depend on the state and is a rational of few bits."""
        if any(self.slopes) or not gmpy2.is_finite(self.value):
            return None
        value = fraction(self.value)
        if value.numerator.bit_length() + value.denominator.bit_length() < self.kind.bits // 2:
            return value
        # 1/3 and its like, as exponents: rounded to the working precision, and read back.
        nearest = value.limit_denominator(10**4)
        return nearest if self.kind.rational(nearest).value == self.value else None

    def _order(self, other: object) -> int:
        lifted = constant(self.kind, other)
        if lifted is None:
            self.refuse("it compares a number with what is none")
        assert isinstance(lifted, DualNumber)  # noqa: S101 - of this kind
        return self.compare(lifted)

    def compare(self, other: "DualNumber") -> int:
        if self.slopes or other.slopes:
            self.kind.compared = True
            if len(self.kind.comparisons) < _MAX_COMPARISONS:
                limit = None if other.slopes else other.value
                gap = self.combine("subtract", other)
                self.kind.comparisons.append(Comparison(_line_of_user(), gap, limit))
        if gmpy2.is_nan(self.value) or gmpy2.is_nan(other.value):
            return 2 if gmpy2.is_nan(self.value) else -2
        return int(self.value > other.value) - int(self.value < other.value)

    def combine(self, name: str, other: "DualNumber") -> "DualNumber":
        x, y, a, b = self.value, other.value, self.slopes, other.slopes
        if name == "divide" and y == 0:
            raise ZeroDivisionError("division by zero")
        act = OPERATORS[name]
        z, is_sum = act(x, y), name in ("add", "subtract")
        if not b:  # a constant moves nothing
            return DualNumber(self.kind, z, a if is_sum else tuple([act(u, y) for u in a]))
        pairs = zip(a or (gmpy2.mpfr(0),) * len(b), b, strict=True)
        if is_sum:
            slopes = [act(u, v) for u, v in pairs]
        elif name == "multiply":
            slopes = [u * y + x * v for u, v in pairs]
        else:
            # (x/y)' = (x' − z y')/y with z = x/y.
            slopes = [(u - z * v) / y for u, v in pairs]
        return DualNumber(self.kind, z, tuple(slopes))

    def apply(self, name: str) -> "DualNumber":
        x = self.value
        domain = by_name()[name].domain
        if domain and domain.relation != "!=":
            interior = domain.inside(x)
            if interior < 0 or (interior == 0 and domain.relation == ">"):
                raise ValueError("math domain error")
        y = getattr(gmpy2, name)(x)
        return self._chain(y, slope_of(name, x, y))

    def raise_to(self, exponent: Fraction) -> "DualNumber":
        x = self.value
        if exponent.denominator == 1:
            n = int(exponent)
            if n == 0:
                return self.kind.rational(Fraction(1))
            if x == 0 and n < 0:
                raise ZeroDivisionError("0 cannot be raised to a negative power")
            return self._chain(x**n, n * x ** (n - 1))
        if x <= 0:
            raise UntraceableError("it takes the root of a number that is not positive")
        power = gmpy2.mpfr(gmpy2.mpq(exponent.numerator, exponent.denominator))
        y = x**power
        return self._chain(y, power * y / x)

    def isfinite(self) -> bool:
        return bool(gmpy2.is_finite(self.value))
