"""The operations of a step, for any values: series in h, closed forms, a kernel's program.

A scheme's step is written once, in these few operations, and read with any of them.
"""

from collections import deque
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, Protocol, TypeAlias, TypeVar

from verify.algebra.power_series import Series, expand_at
from verify.algebra.ring import Poly
from verify.hamiltonians.canonical_field import VectorField

V = TypeVar("V")
Recent: TypeAlias = "deque[tuple[object, list[Series]]]"
_CACHED_SLOPES = 8  # the number of stages whose slopes are cached
Number = Fraction | Poly  # a scheme's coefficient; an irrational one is in the ring of H's field


class StepAlgebra(Protocol[V]):
    """Operations on changes of z. A value V is the O(h) change of one coordinate."""

    @property
    def nothing(self) -> V:
        """The change 0."""
        raise NotImplementedError

    @property
    def size(self) -> int:
        """The number of coordinates in z."""

    def along_flow(self, eta: int) -> list[V]:
        """Return Σ hⁿ/n! Xⁿz, n = 1 … η."""

    def slopes(self, changes: Sequence[V], clock: Number, places: Sequence[int]) -> list[V]:
        """Return the components `places` of f at z + changes, with a time in H at t + clock h."""

    def move(self, change: V, weights: Sequence[Number], slopes: Sequence[V]) -> V:
        """Return change + h Σ weights · slopes."""

    def shear(
        self, changes: Sequence[V], size: Number, clock: Number, places: Sequence[int]
    ) -> list[V]:
        """Return changes + h size f(z + changes) in the components `places`, and others as is."""
        result = list(changes)
        slopes = self.slopes(changes, clock, places)
        for place, slope in zip(places, slopes, strict=True):
            result[place] = self.move(result[place], [size], [slope])
        return result

    def add_share(self, x: V, y: V, share: Fraction) -> V:
        """Return x + share · y."""

    def solve(
        self, count: int, right: "Callable[[StepAlgebra[V], Sequence[V]], list[V]]"
    ) -> list[V]:
        """Return the solution Z of Z = right(Z), with `count` components; the right side is O(h).

        Z[k] is a change of the coordinate k modulo `size`.
        """


class SeriesAlgebra(StepAlgebra[Series]):
    """The step algebra of series up to h^most over the ring of a field."""

    def __init__(self, field: VectorField, most: int, recent: "Recent | None" = None) -> None:
        """`recent`: the cached slopes, which the iterations of `solve` share."""
        self.field, self.most = field, most
        self._recent: Recent = deque(maxlen=_CACHED_SLOPES) if recent is None else recent

    @property
    def nothing(self) -> Series:
        return Series.from_coefficients(self.field.ring, [], self.most)

    @property
    def size(self) -> int:
        return len(self.field.names)

    def along_flow(self, eta: int) -> list[Series]:
        field, ring = self.field, self.field.ring
        terms = [field.term(n) for n in range(1, min(eta, self.most) + 1)]
        rows = zip(*terms, strict=True) if terms else [()] * len(field.names)
        return [
            Series.from_coefficients(ring, [ring.zero, *coefficients], self.most)
            for coefficients in rows
        ]

    def slopes(
        self, changes: Sequence[Series], clock: Number, places: Sequence[int]
    ) -> list[Series]:
        # `move` multiplies slopes by h, so that one power less is enough.
        reach = max(self.most - 1, 0)
        key = reach, clock, places, [x.coefficients[: reach + 1] for x in changes]
        values = next((values for recent_key, values in self._recent if recent_key == key), None)
        if values is None:
            values = self._slopes(changes, clock, places, reach)
            self._recent.append((key, values))
        return values

    def _slopes(
        self, changes: Sequence[Series], clock: Number, places: Sequence[int], reach: int
    ) -> list[Series]:
        field, ring = self.field, self.field.ring
        named_changes = zip(field.names, changes, strict=True)
        moves = [(name, x) for name, x in named_changes if not x.vanishes]
        if field.timed and clock != 0:
            late = ring.constant(clock) if isinstance(clock, Fraction) else clock
            moves.append(("t", Series.from_coefficients(ring, [ring.zero, late], self.most)))
        return [expand_at(field.derivatives[k], moves, reach) for k in places]

    def move(self, change: Series, weights: Sequence[Number], slopes: Sequence[Series]) -> Series:
        total = self._cut(change)
        for w, slope in zip(weights, slopes, strict=True):
            total += self._cut(slope).times(w).shift(1)
        return total

    def add_share(self, x: Series, y: Series, share: Fraction) -> Series:
        return self._cut(x) + self._cut(y).times(share)

    def solve(
        self, count: int, right: Callable[[StepAlgebra[Series], Sequence[Series]], list[Series]]
    ) -> list[Series]:
        """Solve by iteration: each pass makes one more power of h right."""
        solution = [self.up_to(0).nothing] * count
        # The right side is O(h): if Z is right up to h^(k−1), right(Z) is right up to h^k.
        for longest in range(1, self.most + 1):
            shorter = self.up_to(longest)
            solution = right(shorter, list(map(shorter._cut, solution)))
        return solution

    def up_to(self, most: int) -> "SeriesAlgebra":
        """Return the algebra of shorter series, with the same cache."""
        return SeriesAlgebra(self.field, most, self._recent)

    def _cut(self, x: Series) -> Series:
        return Series.from_coefficients(self.field.ring, x.coefficients, self.most)


State = tuple[Series, ...]  # a series for each of p1 … pn, q1 … qn
# A step: it returns z' − z in the values of a step algebra.
Step = Callable[[StepAlgebra[Any]], list[Any]]


def series_of(field: VectorField, step: Step, most: int) -> State:
    """Return z' up to h^most."""
    changes = step(SeriesAlgebra(field, most))
    start = (Series.from_coefficients(field.ring, [x], most) for x in field.start)
    return tuple(x + y for x, y in zip(start, changes, strict=True))
