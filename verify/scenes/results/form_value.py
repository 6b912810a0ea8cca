"""An antisymmetric matrix of a result: exact decimal strings, each entry with its bound."""

from fractions import Fraction
from itertools import combinations
from math import isqrt

from verify.scenes.frozen import Frozen
from verify.scenes.results.bounded_value import Value

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
