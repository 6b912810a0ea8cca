"""A map's Jacobian at points: with dual numbers of 200 bits, or by central differences of floats.

With S = JᵀΩJ − Ω comes, for each entry, how far it may be off by the probe's own error.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

import gmpy2

from verify.arithmetic.exact import fraction
from verify.integrators.maps.user_map import CallableMap
from verify.integrators.number_type import DOUBLE
from verify.integrators.step import StepError, lifted, real
from verify.integrators.tracing.dual import BITS, Dual, Duals
from verify.integrators.tracing.functions import copied

Place = tuple[int, int]
Columns = list[list[float]]
Ends = tuple[list[Fraction], list[Fraction]]
_STENCIL = ((1, 45), (2, -9), (3, 1))  # of the sixth order, over 60
_EPSILON = 2.0**-52
_DUAL = 2.0 ** -(BITS - 30)
# Parts of an entry's terms: what a rounded coefficient, and the tolerance of a loop, may do to it.
_OF_COEFFICIENT, _OF_LOOP = 64 * _EPSILON, 1e-9


@dataclass(frozen=True)
class Reading:
    """At one point: the entries of S, a < b, det J − 1, and the errors that they may have."""

    point: tuple[Fraction, ...]
    entries: dict[Place, float]
    noise: dict[Place, float]
    volume: float
    volume_noise: float

    @property
    def worst(self) -> Place:
        """The entry that is most of all beyond its noise."""
        return max(self.entries, key=lambda at: abs(self.entries[at]) / self.noise[at])

    @property
    def beyond(self) -> float:
        """How many times its noise that entry is."""
        return abs(self.entries[self.worst]) / self.noise[self.worst]


class DualProbe:
    """The map at dual numbers, two columns of J at a time."""

    how = "duals"

    def __init__(self, own: CallableMap) -> None:
        self.map, self.kind = own, Duals()
        with self.kind.running():
            self.function = copied(own.function, self.kind)

    def at(self, point: Sequence[Fraction]) -> Reading:
        """S at the point. Raises StepError, and what the user's code raises."""
        size, rows = len(point), [list[gmpy2.mpfr]() for _ in point]
        with self.kind.running():
            for first in range(0, size, 2):
                for row, x in zip(rows, self._two(point, first), strict=True):
                    row += [x.by_p, x.by_q]
            columns = [[row[k] for row in rows] for k in range(size)]
            share = _DUAL + _OF_COEFFICIENT * len(self.kind.rounded)
            share += _OF_LOOP if self.kind.compared else 0.0
            return _reading(tuple(point), columns, None, share)

    def value(self, point: Sequence[Fraction]) -> list[float]:
        """z' at the point."""
        with self.kind.running():
            return [float(x.value) for x in self._two(point, 0)]

    def exact(self, point: Sequence[Fraction]) -> Ends:
        """Where it is called, and z' there, as the rationals that they are."""
        with self.kind.running():
            begun = [self.kind.rational(x).value for x in point]
            ended = [x.value for x in self._two(point, 0)]
        return list(map(fraction, begun)), list(map(fraction, ended))

    def _two(self, point: Sequence[Fraction], first: int) -> list[Dual]:
        """z' with its derivatives by two of the coordinates."""
        state = []
        for k, x in enumerate(map(self.kind.rational, point)):
            by = [gmpy2.mpfr(k == first + i) for i in (0, 1)]
            state.append(Dual(self.kind, x.value, *by))
        result = self.map.called(self.function, state, self.kind.rational)
        found: list[Dual] = lifted(state[0], result)
        if not all(gmpy2.is_finite(x.value) for x in found):
            raise StepError("it returns what is not finite")
        return found


class FloatProbe:
    """The map at floats, or at numbers of another type, columns of J by central differences of the
    increments; what is made of them is exact."""

    how = "floats"

    def __init__(self, own: CallableMap) -> None:
        self.map, self.numbers = own, own.numbers

    def value(self, point: Sequence[Fraction]) -> list[float]:
        """z' at the point."""
        return [float(x) for x in self._at([self.numbers.rounded(x) for x in point])]

    def exact(self, point: Sequence[Fraction]) -> Ends:
        """Where it is called, and z' there, as the rationals that they are."""
        begun = [self.numbers.rounded(x) for x in point]
        return begun, self._at(begun)

    def _at(self, z: Sequence[Fraction]) -> list[Fraction]:
        if self.numbers is not DOUBLE:
            return [Fraction(x) for x in self.map.called(self.map.function, z, _as_it_is)]
        given = [float(x) for x in z]
        found = [real(x) for x in self.map.called(self.map.function, given, float)]
        if not all(map(math.isfinite, found)):
            raise StepError("it returns what is not finite")
        return [Fraction(x) for x in found]

    def at(self, point: Sequence[Fraction]) -> Reading:
        """S at the point; its errors by a second width."""
        z, epsilon = [self.numbers.rounded(x) for x in point], self.numbers.epsilon
        reach = 1 + max(float(abs(x)) for x in (*z, *self._at(z)))
        width = Fraction(self.numbers.width * reach)
        one, two = (self._columns(z, w) for w in (width, width / 2))
        rounding = 8 * epsilon * reach / float(width)
        noise = [
            [float(abs(x - y)) + rounding for x, y in zip(*pair, strict=True)]
            for pair in zip(one, two, strict=True)
        ]
        return _reading(tuple(point), two, noise, 4 * epsilon)

    def _columns(self, z: Sequence[Fraction], width: Fraction) -> list[list[Fraction]]:
        columns, rounded = [], self.numbers.rounded
        for i in range(len(z)):
            total = [Fraction(60 * width * (k == i)) for k in range(len(z))]
            for k, weight in _STENCIL:
                ahead, behind = list(z), list(z)
                ahead[i], behind[i] = rounded(z[i] + k * width), rounded(z[i] - k * width)
                f, b = self._at(ahead), self._at(behind)
                for j in range(len(z)):
                    total[j] += weight * ((f[j] - ahead[j]) - (b[j] - behind[j]))
            columns.append([x / (60 * width) for x in total])
        return columns


def _as_it_is(x: Fraction) -> Fraction:
    return x


Probe = DualProbe | FloatProbe


def _reading(
    point: tuple[Fraction, ...],
    columns: Sequence[Sequence["gmpy2.mpfr | Fraction"]],
    errors: Columns | None,
    share: float,
) -> Reading:
    """S and det J − 1 of these columns, each with `share` of its terms and what `errors` make."""
    size = len(columns)
    half, entries, noise = size // 2, {}, {}
    for a, b in combinations(range(size), 2):
        u, v = columns[a], columns[b]
        pairs = [(i, half + i) for i in range(half)]
        terms = [u[i] * v[j] - u[j] * v[i] for i, j in pairs]
        entries[a, b] = float(sum(terms, type(u[0])(0)) - (b == a + half))
        large = sum(abs(float(u[i] * v[j])) + abs(float(u[j] * v[i])) for i, j in pairs)
        noise[a, b] = share * (1 + large)
        if errors is not None:
            e, f = errors[a], errors[b]
            noise[a, b] += sum(
                e[i] * abs(float(v[j])) + e[j] * abs(float(v[i]))
                + f[j] * abs(float(u[i])) + f[i] * abs(float(u[j]))
                for i, j in pairs
            )  # fmt: skip
    change, scale = _change_of_volume(columns)
    wrong = share * scale
    if errors is not None:
        largest = max(1.0, *(abs(float(x)) for column in columns for x in column))
        wrong += size * max(map(max, errors)) * largest ** (size - 1)
    return Reading(point, entries, noise, change, wrong)


def _change_of_volume(columns: Sequence[Sequence["gmpy2.mpfr | Fraction"]]) -> tuple[float, float]:
    """det J − 1 by elimination, the largest entries first, and how large the products in it are."""
    rows = [list(column) for column in columns]
    size, found, scale = len(rows), rows[0][0] * 0 + 1, 1.0
    for k in range(size):
        at = max(range(k, size), key=lambda i: abs(rows[i][k]))
        scale *= 1 + max(abs(float(x)) for x in rows[at])
        if rows[at][k] == 0:
            return -1.0, scale
        if at != k:
            rows[k], rows[at], found = rows[at], rows[k], -found
        found *= rows[k][k]
        for i in range(k + 1, size):
            share = rows[i][k] / rows[k][k]
            rows[i] = [x - share * y for x, y in zip(rows[i], rows[k], strict=True)]
    return float(found - 1), scale
