"""Numbers of a result, and antisymmetric matrices of such, as exact decimal strings with bounds.

They are unchanged by a JSON round trip.
"""

from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from itertools import combinations
from math import isqrt
from numbers import Real
from typing import Annotated, Any

from pydantic import Field

from verify.arithmetic.exact import known_digits, of_mpf, rational
from verify.errors import InputError
from verify.scenes.frozen import Frozen

_DECIMAL = r"^-?\d+(\.\d+)?(e[+-]\d+)?$"


class Value(Frozen):
    """A decimal whose printed digits are known, with the bound of its error.

    It can be used as a number: `float(x)`, `mpmath.mpf(x)` and `f"{x:.3e}"` convert `value`,
    `x.exact` is the rational number `value`, and `abs(x)` and `-x` are a Value.

    Comparisons are between all numbers within the bounds: x < y is True if it holds for each of
    them, so that `assert abs(x) < 1e-6` means what it says. Where the bounds overlap, none of
    x < y, x > y, x <= y and x >= y is True: `not x < y` does not imply x ≥ y, and Values cannot be
    sorted by them (sort by `key=float`). x == 0 is True for an exact 0 alone; two Values are equal
    where value and bound are.

    >>> x = Value(value="1.50e-03", bound="2.00e-05")
    >>> float(x), x < 0.0016, x < 0.00151, x >= 0.00151
    (0.0015, True, False, False)
    """

    value: Annotated[str, Field(pattern=_DECIMAL)]
    bound: Annotated[str, Field(pattern=_DECIMAL)]

    @classmethod
    def from_bound(cls, value: Fraction, bound: Fraction, digits: int) -> "Value":
        """Return the value rounded to the digits that its bound permits, `digits` at most."""
        digits_text, own_bound = known_digits(value, bound, digits)
        return cls(value=digits_text, bound=own_bound)

    @property
    def exact(self) -> Fraction:
        """`value` as a rational."""
        return Fraction(self.value)

    @property
    def ends(self) -> tuple[Fraction, Fraction]:
        """value − bound and value + bound, between which the true value lies."""
        middle, radius = Fraction(self.value), Fraction(self.bound)
        return middle - radius, middle + radius

    def __float__(self) -> float:
        return float(self.value)

    def __abs__(self) -> "Value":
        return Value(value=self.value.removeprefix("-"), bound=self.bound)

    def __neg__(self) -> "Value":
        negative = self.value.startswith("-") or self.value == "0"
        return Value(
            value=self.value.lstrip("-") if negative else f"-{self.value}", bound=self.bound
        )

    def _mpmath_(self, precision: int, rounding: str) -> Any:
        """Convert `value` for mpmath, rounded to its current precision."""
        import mpmath

        exact = self.exact
        parts = exact.numerator, exact.denominator, precision, rounding
        return mpmath.mp.make_mpf(mpmath.libmp.from_rational(*parts))

    @property
    def unknown(self) -> bool:
        """True if no digit is known, but only that |x| is within the bound."""
        return self.bound != "0" and self.exact == 0

    def __str__(self) -> str:
        if self.unknown:
            return f"|·| ≤ {self.bound}"
        return self.value if self.bound == "0" else f"{self.value} ± {self.bound}"

    def __repr__(self) -> str:
        return f"Value({self})"

    def __format__(self, spec: str) -> str:
        return format(float(self), spec) if spec else str(self)

    # -- comparisons ------------------------------------------------------------------------------

    def __lt__(self, other: object) -> bool:
        return self._certain(other, lambda a, b: a[1] < b[0])

    def __le__(self, other: object) -> bool:
        return self._certain(other, lambda a, b: a[1] <= b[0])

    def __gt__(self, other: object) -> bool:
        return self._certain(other, lambda a, b: a[0] > b[1])

    def __ge__(self, other: object) -> bool:
        return self._certain(other, lambda a, b: a[0] >= b[1])

    def __eq__(self, other: object) -> bool:
        ends = _ends(other)
        if ends is None:
            return NotImplemented
        if isinstance(other, Value) and (self.value, self.bound) == (other.value, other.bound):
            return True
        # Numbers are equal for certain only where both are exact.
        return self.ends[0] == self.ends[1] == ends[0] == ends[1]

    def __hash__(self) -> int:
        return hash(self.exact if Fraction(self.bound) == 0 else (self.value, self.bound))

    def _certain(self, other: object, holds: Callable[[Any, Any], bool]) -> bool:
        ends = _ends(other)
        return NotImplemented if ends is None else holds(self.ends, ends)


def _ends(x: object) -> tuple[Fraction, Fraction] | None:
    """Return the least and the greatest number that x may be; None if it is no number."""
    if isinstance(x, Value):
        return x.ends
    try:
        if hasattr(x, "_mpf_"):  # mpmath's numbers, which are exact in binary
            exact = of_mpf(x)
        elif isinstance(x, Real | Decimal):
            exact = rational(x)  # type: ignore[arg-type]
        else:
            return None
    except InputError:  # nan, an infinity
        return None
    return exact, exact


Rows = tuple[tuple[str, ...], ...]


class FormValue(Frozen):
    """An antisymmetric 2n × 2n matrix of decimal strings, rows and columns p1 … pn, q1 … qn, with
    the bound of each entry's error."""

    value: Rows
    bound: Rows

    @classmethod
    def from_entries(cls, entries: tuple[Value, ...]) -> "FormValue":
        """Return the matrix with these entries above the diagonal, row by row."""
        size = (1 + isqrt(1 + 8 * len(entries))) // 2  # of rows: size (size − 1)/2 entries
        zero = Value(value="0", bound="0")
        full = [[zero] * size for _ in range(size)]
        for (a, b), entry in zip(combinations(range(size), 2), entries, strict=True):
            # The lower triangle follows from antisymmetry; the diagonal is 0.
            full[a][b], full[b][a] = entry, -entry
        return cls(
            value=tuple(tuple(x.value for x in row) for row in full),
            bound=tuple(tuple(x.bound for x in row) for row in full),
        )

    @property
    def exact(self) -> tuple[tuple[Fraction, ...], ...]:
        """The matrix `value` as rationals."""
        return tuple(tuple(map(Fraction, row)) for row in self.value)

    def entry(self, a: int, b: int) -> Value:
        """Return one entry, with row and column counted from 0."""
        return Value(value=self.value[a][b], bound=self.bound[a][b])

    @property
    def place(self) -> tuple[int, int]:
        """Row and column of the greatest |entry|, above the diagonal."""
        places = combinations(range(len(self.value)), 2)
        return max(places, key=lambda indices: abs(Fraction(self.value[indices[0]][indices[1]])))

    @property
    def largest(self) -> Value:
        """The entry of the greatest size, with its sign."""
        return self.entry(*self.place)

    def __str__(self) -> str:
        return f"{self.largest} at the greatest entry"


def largest(x: Value | FormValue) -> Value:
    """Return the number itself; for a matrix, the entry of the greatest size."""
    return x if isinstance(x, Value) else x.largest
