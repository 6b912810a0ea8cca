"""Readings of a defect at a place: its components, each with its noise and natural scale.

Those of S = JᵀΩJ − Ω, with det J − 1, are computed from a measured Jacobian J. The noise of an
entry of S is computed from that of each entry of J, so that the result does not depend on the units
of the coordinates: it is the same in kilometres and in metres.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import prod
from typing import TYPE_CHECKING, ClassVar, Generic, TypeAlias, TypeVar

import gmpy2

from verify.integrators.measures.error_powers import Row
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.tracing.replacements import eliminate

if TYPE_CHECKING:
    Real: TypeAlias = gmpy2.mpfr
Indices = tuple[int, int]  # a < b, the row and the column of an entry of S
Matrix: TypeAlias = "Sequence[Sequence[Real]]"  # by rows
READING_BITS = 250
# The roundings, in the numbers of the code, that are allowed in each entry of JᵀΩJ.
_ROUNDINGS_OF_ENTRY = 32
Key = TypeVar("Key")  # of a component


@dataclass(frozen=True)
class Component:
    """A component of a defect: its value, its noise, and its natural scale at the place."""

    value: float
    noise: float
    scale: float

    @property
    def ratio(self) -> float:
        """The ratio of the value to its noise."""
        return abs(self.value) / self.noise if self.noise else math.inf if self.value else 0.0

    @property
    def defect(self) -> float:
        """The absolute value in units of the scale."""
        return abs(self.value) / self.scale if self.scale else abs(self.value)

    @property
    def blur(self) -> float:
        """The noise in units of the scale."""
        return self.noise / self.scale if self.scale else self.noise

    def __str__(self) -> str:
        return f"{self.value:.6e} ± {self.noise:.1e}"


@dataclass(frozen=True)
class Reading(Generic[Key]):
    """The components of a defect at a place, with the step size h (0 for a map)."""

    clear_ratio: ClassVar[float] = (
        32.0  # a component is clear of its noise if it is larger so often
    )

    place: TrialPlace
    h: Fraction
    components: dict[Key, Component]

    @property
    def ratio(self) -> float:
        """The largest ratio of a component to its noise."""
        return max(x.ratio for x in self.components.values())

    @property
    def largest(self) -> tuple[Key, Component]:
        """The name of the largest component, among those clear of their noise if any are, and the
        component."""
        clear = [x for x in self.components.items() if x[1].ratio > self.clear_ratio]
        return max(clear or self.components.items(), key=lambda x: x[1].defect)

    @property
    def defect(self) -> float:
        """The largest component in units of its scale."""
        return max(x.defect for x in self.components.values())

    @property
    def blur(self) -> float:
        """The largest noise, in units of the scales."""
        return max(x.blur for x in self.components.values())

    @property
    def row(self) -> Row:
        """h, the defect and the blur."""
        return float(self.h), self.defect, self.blur


KeptReading = Reading[str]


@dataclass(frozen=True)
class DefectReading(Reading[Indices]):
    """The entries a < b of S; with det J − 1, `volume`, and its noise. `jacobian`: J by rows."""

    clear_ratio: ClassVar[float] = 4.0

    volume: float
    volume_noise: float
    jacobian: tuple[tuple[float, ...], ...]

    @property
    def defect(self) -> float:
        """The largest entry in units of its scale, among those clear of their noise if any are."""
        return self.largest[1].defect


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
        components = dict[Indices, Component]()
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
            scale = (action[a % half] if b == a + half else mean) / (units[a] * units[b])
            noise = blur + _ROUNDINGS_OF_ENTRY * epsilon * scale
            components[a, b] = Component(float(total), noise, scale)
        volume, blur = volume_change(jacobian, errors, place.units)
        blur += _ROUNDINGS_OF_ENTRY * epsilon
    rows = tuple(tuple(map(float, row)) for row in jacobian)
    return DefectReading(place, h, components, float(volume), blur, rows)


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
