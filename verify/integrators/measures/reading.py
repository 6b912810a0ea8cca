"""S = JᵀΩJ − Ω and det J − 1 of a Jacobian that was measured, each with the noise that it may have.

The noise of an entry follows from that of J's entries, one by one, so that no unit enters: what is
said of S is the same in kilometres and in metres.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import prod
from typing import TYPE_CHECKING, TypeAlias

import gmpy2

from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.tracing.replacements import eliminate

if TYPE_CHECKING:
    Real: TypeAlias = gmpy2.mpfr
Indices = tuple[int, int]  # of an entry of S, a < b
Matrix: TypeAlias = "Sequence[Sequence[Real]]"  # rows
READING_BITS = 250
_ROUNDINGS = 32  # of an entry of Ω: what tens of operations in its numbers leave


@dataclass(frozen=True)
class DefectReading:
    """The entries a < b of S, and det J − 1, at a place with step size h (0 of a map that has
    none).

    `defect` and `noise` are of entries in the units of the place, where those of Ω are about 1;
    `entries` are as they stand. `jacobian`: J by rows, as floats.
    """

    place: TrialPlace
    h: Fraction
    entries: dict[Indices, float]
    noise: dict[Indices, float]
    scales: dict[Indices, float]
    volume: float
    volume_noise: float
    jacobian: tuple[tuple[float, ...], ...]

    @property
    def worst(self) -> Indices:
        """The entry that is farthest beyond its noise."""
        return max(self.entries, key=lambda at: abs(self.entries[at]) / self.noise[at])

    @property
    def largest_entry(self) -> Indices:
        """The largest entry in units of the place, of those beyond their noise where there are."""
        clear = [at for at, x in self.entries.items() if abs(x) > 4 * self.noise[at]]
        return max(clear or self.entries, key=lambda at: abs(self.entries[at]) * self.scales[at])

    @property
    def beyond(self) -> float:
        """The ratio of the worst entry to its noise."""
        return abs(self.entries[self.worst]) / self.noise[self.worst]

    @property
    def defect(self) -> float:
        """The largest entry in units of the place, of those beyond their noise where there are."""
        return abs(self.entries[self.largest_entry]) * self.scales[self.largest_entry]

    @property
    def blur(self) -> float:
        """The largest noise of an entry, in units of the place."""
        return max(x * self.scales[at] for at, x in self.noise.items())


def reading_of(
    place: TrialPlace, h: Fraction, jacobian: Matrix, errors: list[list[float]], epsilon: float
) -> DefectReading:
    """Compute the reading from J and the errors of its entries, both by rows; `epsilon`: of the
    numbers that the code computes in. Some dozens of roundings are allowed in each entry of Ω."""
    size, half = len(jacobian), len(jacobian) // 2
    units = [float(x) for x in place.units]
    with gmpy2.context(precision=READING_BITS):
        columns = list(zip(*jacobian, strict=True))
        blurs = list(zip(*errors, strict=True))
        sizes = [[abs(float(x)) for x in column] for column in columns]
        entries, noise, scales = {}, {}, {}
        # Pairs may have different units of action: Ω's entries are then held against their mean.
        action = [units[i] * units[half + i] for i in range(half)]
        mean = sum(action) / half
        for a, b in combinations(range(size), 2):
            u, v, e, f, x, y = columns[a], columns[b], blurs[a], blurs[b], sizes[a], sizes[b]
            # S_ab = Σ_i (u_i v_(n+i) − u_(n+i) v_i) − Ω_ab, with u and v the columns a and b of J;
            # the errors e and f of the columns enter to first order.
            total = gmpy2.mpfr(-1 if b == a + half else 0)
            blur = 0.0
            for i in range(half):
                j = half + i
                total += u[i] * v[j] - u[j] * v[i]
                blur += e[i] * y[j] + e[j] * y[i] + f[j] * x[i] + f[i] * x[j]
            entries[a, b] = float(total)
            scales[a, b] = units[a] * units[b] / (action[a % half] if b == a + half else mean)
            noise[a, b] = blur + _ROUNDINGS * epsilon / scales[a, b]
        volume, blur = _volume(jacobian, errors, place.units)
        blur += _ROUNDINGS * epsilon
    rows = tuple(tuple(map(float, row)) for row in jacobian)
    return DefectReading(place, h, entries, noise, scales, volume, blur, rows)


def _volume(
    jacobian: Matrix, errors: list[list[float]], units: Sequence[Fraction]
) -> tuple[float, float]:
    """Return det J − 1, and its noise by the entries of the inverse (Jacobi's formula)."""
    scale = [gmpy2.mpfr(float(x)) for x in units]
    rows = [[x * scale[j] / scale[i] for j, x in enumerate(row)] for i, row in enumerate(jacobian)]
    size, one = len(rows), gmpy2.mpfr(1)
    wide = [[*row, *(one * (i == k) for i in range(size))] for k, row in enumerate(rows)]
    # The identity is carried along: one elimination leaves the determinant as the product of the
    # pivots, and the inverse beside them.
    determinant = eliminate(wide, abs) * prod((row[k] for k, row in enumerate(wide)), start=one)
    if not determinant or not gmpy2.is_finite(determinant):  # a pivot is 0
        return -1.0, max(map(max, errors), default=0.0)
    # ∂ det J/∂J_ij = det J (J⁻¹)_ji, in units of the place.
    blur = sum(
        abs(float(row[size + i] / row[j])) * errors[i][j] * float(scale[j] / scale[i])
        for i in range(size)
        for j, row in enumerate(wide)
    )
    return float(determinant - 1), abs(float(determinant)) * blur
