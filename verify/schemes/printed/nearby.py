"""The residues of a printed table near its numbers, and whether none there can be 0.

Coefficients that stand for algebraic numbers are printed as decimals: taken exactly they satisfy no
condition at all. What can be asked is whether numbers near the printed ones do.

With F the residues, J their derivative at the printed numbers x₀, and B a bound of the second
derivatives (Cauchy's, by a majorant that has all signs plus), F(x) is F(x₀) + J (x − x₀) up to
B |x − x₀|²/2, the norm being the sum. Where some combination of residues is enclosed away from 0
over the whole box, no numbers in it satisfy them. That some do is shown in
`verify.schemes.printed.nearest`.

J is a difference quotient with a step of 2⁻¹⁶⁰, whose error B bounds too. All is done in balls.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

import flint

from verify.arithmetic.arb import Ball, middle_and_radius, rational_ball
from verify.arithmetic.flint_precision import length_of_series
from verify.schemes.printed.asked import Asked, ball_of, size_of
from verify.schemes.printed.printed_numbers import entries_at

_STEP = 160  # the difference quotient's, as a power of 1/2
RADIUS = Fraction(1, 8)  # of the polydisc of Cauchy's bound
# Of a condition's derivative, what is left beside the others', where it is taken to depend on them.
_DEPENDENT = 1e-10, 1e-5
Slopes = Mapping[int, Sequence[Ball]]  # of a condition's residue, by the numbers' places


class Rounded(Protocol):
    """Numbers by name: what is printed, its exact value, and one unit of its last digit."""

    @property
    def numbers(self) -> Mapping[str, str]: ...

    @property
    def values(self) -> Mapping[str, Fraction]: ...

    @property
    def units(self) -> Mapping[str, Fraction]: ...


@dataclass(frozen=True)
class AnyNumbers:
    """Those that no table has printed so: moved ones, or exact ones of which any may be wrong."""

    numbers: Mapping[str, str]
    values: Mapping[str, Fraction]
    units: Mapping[str, Fraction]


class Nearby:
    """The residues near the printed numbers: values, derivatives, a bound of the second ones."""

    def __init__(self, numbers: Rounded, asked: Asked) -> None:
        self.numbers, self.asked = numbers, asked
        self.names = tuple(numbers.units)
        self.start = [rational_ball(numbers.values[n]) for n in self.names]
        self.unit = [rational_ball(numbers.units[n]) for n in self.names]
        self.second = self._second()
        self.value = self.residues(self.start, range(len(asked.equations)))
        self.at_print = [middle_and_radius(x)[0] for x in self.value.values()]
        self.slope: Slopes = self.slopes(self.start, self.value)

    def residues(self, at: Sequence[Ball], rows: Sequence[int]) -> dict[int, Ball]:
        """Of these conditions, at those numbers."""
        point = dict(zip(self.names, at, strict=True))
        entries = entries_at(self.asked.entries, point, ball_of)
        return self.asked.residues_of(rows, entries, flint.arb(1))

    def moved(self, at: Sequence[Ball], k: int, rows: Sequence[int]) -> dict[int, Ball]:
        """The residues where number k is larger by the difference quotient's step."""
        return self.residues([x + small() if i == k else x for i, x in enumerate(at)], rows)

    def slopes(self, at: Sequence[Ball], value: Mapping[int, Ball]) -> dict[int, list[Ball]]:
        """The derivatives of the conditions whose values are given, by number."""
        found: dict[int, list[Ball]] = {i: [] for i in value}
        for k in range(len(at)):
            for i, y in self.moved(at, k, list(value)).items():
                slope = (y - value[i]) / small() + around(small() * self.second[i])
                found[i].append(slope)
        return found

    def _second(self) -> list[Ball]:
        """Bounds of each residue's second derivatives within half the polydisc's radius."""
        radius = rational_ball(RADIUS)
        reach = {n: abs(x) + radius for n, x in zip(self.names, self.start, strict=True)}
        entries = entries_at(self.asked.entries, reach, size_of)
        bounds = self.asked.residues(entries, flint.arb(1), bound=True)
        return [((x + 1) * 8 / radius**2).abs_upper() for x in bounds]

    # -- none exist -------------------------------------------------------------------------------

    def _excludes(
        self, weights: Mapping[int, Ball], units: Fraction | int, slopes: Slopes | None = None
    ) -> bool:
        """Whether Σ weight · residue is not 0 at any numbers within so many units.

        With the derivatives over the whole box, `slopes`, by the mean value theorem; without, with
        those at the printed numbers and the bound of the second ones.
        """
        radius, zero = [u * rational_ball(Fraction(units)) for u in self.unit], flint.arb(0)
        spread = zero
        if slopes is None:
            slopes, reach = self.slope, sum(radius, zero) * sum(radius, zero) / 2
            spread = sum((abs(w) * self.second[k] * reach for k, w in weights.items()), zero)
        for i, r in enumerate(radius):
            spread += abs(sum((w * slopes[k][i] for k, w in weights.items()), zero)) * r
        return bool(abs(sum((w * self.value[k] for k, w in weights.items()), zero)) > spread)

    def excluded(self, rows: Sequence[int], units: Fraction | int) -> list[int]:
        """The conditions that hold for no numbers within so many units."""
        one = flint.arb(1)
        found = [k for k in rows if self._excludes({k: one}, units)]
        left = [k for k in rows if k not in found and self._rough(k, units)]
        if left:
            slopes = self._over_box(units)
            found += [k for k in left if self._excludes({k: one}, units, slopes)]
        return sorted(found)

    def _rough(self, k: int, units: Fraction | int) -> bool:
        """Whether it is the bound of the second derivatives alone that keeps it from exclusion."""
        radius = [u * rational_ball(Fraction(units)) for u in self.unit]
        first = sum((abs(s) * r for s, r in zip(self.slope[k], radius, strict=True)), flint.arb(0))
        return bool(abs(self.value[k]) > first)

    def apart(self, rows: Sequence[int], units: Fraction | int) -> bool:
        """Whether no numbers within so many units satisfy all of these conditions."""
        return any(self._apart(chosen, units) for chosen in self.choices(rows))

    def _apart(self, rows: Sequence[int], units: Fraction | int) -> bool:
        inverse = self.inverse(rows, self.slope)
        if inverse is None:
            return False
        count = len(rows)
        combined = [
            dict(zip(rows, (inverse[i, j] for j in range(count)), strict=True))
            for i in range(len(self.names))
        ]
        if any(self._excludes(weights, units) for weights in combined):
            return True
        slopes = self._over_box(units)
        return any(self._excludes(weights, units, slopes) for weights in combined)

    def _over_box(self, units: Fraction | int) -> Slopes:
        """The derivatives over the box: slower than `slopes`, and sharper than their bound."""
        wide = rational_ball(Fraction(units))
        box = [x + around(u * wide) for x, u in zip(self.start, self.unit, strict=True)]
        columns = []
        with length_of_series(2):
            for k in range(len(box)):
                point = {
                    n: flint.arb_series([x, int(i == k)], prec=2)
                    for i, (n, x) in enumerate(zip(self.names, box, strict=True))
                }
                entries = entries_at(self.asked.entries, point, _constant)
                residues = self.asked.residues(entries, flint.arb_series([1], prec=2))
                columns.append([x[1] for x in residues])
        return dict(enumerate(zip(*columns, strict=True)))

    # -- conditions that are independent ----------------------------------------------------------

    def choices(self, rows: Sequence[int]) -> list[list[int]]:
        """All of them, where they can be independent; and those that seem to be."""
        all_of_them = [list(rows)] if len(rows) <= len(self.names) else []
        seeming = (self._independent(rows, least) for least in _DEPENDENT)
        found = {tuple(each): each for each in (*all_of_them, *seeming)}
        return list(found.values())

    def _independent(self, rows: Sequence[int], least: float) -> list[int]:
        """As many of the conditions as do not depend on one another at the printed numbers."""
        import numpy as np

        largest = max((u for u in self.numbers.units.values()), default=Fraction(1))
        scale = [float(u / largest) for u in self.numbers.units.values()]
        left = np.array([[float(x.mid()) for x in self.slope[k]] for k in rows]) * scale
        left = left.reshape(len(rows), len(self.names))
        size = np.linalg.norm(left, axis=1)
        left = left / np.where(size > 0, size, 1)[:, None]
        found: list[int] = []
        while len(found) < min(len(rows), len(self.names)):
            norms = np.linalg.norm(left, axis=1)
            # Of those that are far enough from the ones chosen, the first: lower orders are so.
            far = np.flatnonzero(norms > max(least, 0.1 * norms.max()))
            if not len(far):
                break
            k = int(far[0])
            direction = left[k] / norms[k]
            left = left - np.outer(left @ direction, direction)
            left[k] = 0
            found.append(k)
        return sorted(rows[k] for k in found)

    def inverse(self, rows: Sequence[int], slope: Slopes) -> flint.arb_mat | None:
        """U Jᵀ(J U Jᵀ)⁻¹, nearly."""
        if not rows or len(rows) > len(self.names):
            return None
        jacobian = flint.arb_mat([[x.mid() for x in slope[k]] for k in rows])
        count = len(self.unit)
        squares = [[self.unit[i] ** 2 if i == j else 0 for j in range(count)] for i in range(count)]
        scaled = flint.arb_mat(squares) * jacobian.transpose()
        try:
            found = scaled * (jacobian * scaled).inv()
        except ZeroDivisionError:
            return None
        middles = [[found[i, j].mid() for j in range(len(rows))] for i in range(count)]
        return flint.arb_mat(middles)


def small() -> Ball:
    """The difference quotient's step."""
    return flint.arb(2) ** -_STEP


def around(radius: Ball) -> Ball:
    """[−radius, radius]."""
    return radius.abs_upper() * flint.arb(0, 1)  # a tiny radius given as such may become infinite


def _constant(x: "flint.arb") -> flint.arb_series:
    return flint.arb_series([ball_of(x)], prec=2)
