"""S = JᵀΩJ − Ω and det J − 1 of a measured Jacobian J, each with its noise.

The noise of an entry of S is computed from that of each entry of J, so that the result does not
depend on the units of the coordinates: it is the same in kilometres and in metres.
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
Indices = tuple[int, int]  # a < b, the row and the column of an entry of S
Matrix: TypeAlias = "Sequence[Sequence[Real]]"  # by rows
READING_BITS = 250
# The roundings, in the numbers of the code, that are allowed in each entry of JᵀΩJ.
_ROUNDINGS_OF_ENTRY = 32
_NOISE_FACTOR = 4  # an entry is clear of its noise if it exceeds it by this factor


@dataclass(frozen=True)
class DefectReading:
    """The entries a < b of S, and det J − 1, at a place with step size h (0 for a map without h).

    `entries` and `noise` are in the user's units. `scales` convert an entry to units of the place,
    in which the entries of Ω are about 1: `defect` and `blur` are in these. `volume`: det J − 1,
    with its noise. `jacobian`: J by rows, as floats.
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
        """The entry with the largest ratio to its noise."""
        return max(self.entries, key=lambda at: abs(self.entries[at]) / self.noise[at])

    @property
    def largest_entry(self) -> Indices:
        """The largest entry in units of the place, among those clear of their noise if any are."""
        clear = [at for at, x in self.entries.items() if abs(x) > _NOISE_FACTOR * self.noise[at]]
        return max(clear or self.entries, key=lambda at: abs(self.entries[at]) * self.scales[at])

    @property
    def beyond(self) -> float:
        """The ratio of the worst entry to its noise."""
        return abs(self.entries[self.worst]) / self.noise[self.worst]

    @property
    def defect(self) -> float:
        """The absolute value of `largest_entry`, in units of the place."""
        return abs(self.entries[self.largest_entry]) * self.scales[self.largest_entry]

    @property
    def blur(self) -> float:
        """The largest noise of an entry, in units of the place."""
        return max(x * self.scales[at] for at, x in self.noise.items())


def reading_of(
    place: TrialPlace, h: Fraction, jacobian: Matrix, errors: list[list[float]], epsilon: float
) -> DefectReading:
    """Compute the reading from J and the errors of its entries, both by rows.

    `epsilon`: that of the numbers in which the code computes.
    """
    size, half = len(jacobian), len(jacobian) // 2
    units = [float(x) for x in place.units]
    with gmpy2.context(precision=READING_BITS):
        columns = list(zip(*jacobian, strict=True))
        blurs = list(zip(*errors, strict=True))
        sizes = [[abs(float(x)) for x in column] for column in columns]
        entries, noise, scales = {}, {}, {}
        # Pairs (p_i, q_i) may have different units of action. An entry of S between two pairs,
        # where Ω is 0, is compared with the mean of these units.
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
            noise[a, b] = blur + _ROUNDINGS_OF_ENTRY * epsilon / scales[a, b]
        volume, blur = volume_change(jacobian, errors, place.units)
        blur += _ROUNDINGS_OF_ENTRY * epsilon
    rows = tuple(tuple(map(float, row)) for row in jacobian)
    return DefectReading(place, h, entries, noise, scales, float(volume), blur, rows)


def volume_change(
    jacobian: Matrix, errors: list[list[float]], units: Sequence[Fraction]
) -> "tuple[Real, float]":
    """Return det J − 1, and its noise to first order by Jacobi's formula, with the inverse of J."""
    scale = [gmpy2.mpfr(float(x)) for x in units]
    rows = [[x * scale[j] / scale[i] for j, x in enumerate(row)] for i, row in enumerate(jacobian)]
    size, one = len(rows), gmpy2.mpfr(1)
    wide = [[*row, *(one * (i == k) for i in range(size))] for k, row in enumerate(rows)]
    # One elimination of (J | identity) leaves the pivots, whose product is the determinant, and
    # beside them the inverse.
    determinant = eliminate(wide, abs) * prod((row[k] for k, row in enumerate(wide)), start=one)
    if not determinant or not gmpy2.is_finite(determinant):  # a pivot is 0
        return gmpy2.mpfr(-1), max(map(max, errors), default=0.0)
    # ∂ det J/∂J_ij = det J (J⁻¹)_ji, in units of the place.
    blur = sum(
        abs(float(row[size + i] / row[j])) * errors[i][j] * float(scale[j] / scale[i])
        for i in range(size)
        for j, row in enumerate(wide)
    )
    return determinant - 1, abs(float(determinant)) * blur
