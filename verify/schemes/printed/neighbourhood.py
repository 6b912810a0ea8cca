"""The residuals of a printed table near its numbers, and a test that no solution lies there.

Coefficients that stand for algebraic numbers are printed as decimals: taken exactly they satisfy no
condition at all. The question is whether numbers near the printed ones do.

Let F be the residuals, J their derivative at the printed numbers x₀, and B a bound of the second
derivatives (by Cauchy's estimate, from a majorant with all signs plus). F(x) is F(x₀) + J (x − x₀)
up to B |x − x₀|²/2, in the norm of the sum. If some combination of residuals is enclosed away from
0 over a whole box, no numbers in it satisfy the conditions. `verify.schemes.printed.solutions`
shows that some numbers do.

J is a difference quotient with a step of 2⁻¹⁶⁰, whose error B bounds too. All numbers are balls.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

import flint

from verify.arithmetic.arb import Ball, midpoint_and_radius, rational_ball
from verify.arithmetic.flint_precision import length_of_series
from verify.schemes.printed.condition_set import ConditionSet, ball_of, size_of
from verify.schemes.printed.printed_numbers import entries_at

_STEP_EXPONENT = 160  # the step of difference quotients is 2^−160
RADIUS = Fraction(1, 8)  # the radius of the polydisc in Cauchy's estimate
# A condition counts as dependent on others if its normed derivative has a smaller part orthogonal
# to theirs.
_DEPENDENCE_THRESHOLDS = 1e-10, 1e-5
Slopes = Mapping[int, Sequence[Ball]]  # by condition, the derivatives of its residual by number


class RoundedNumbers(Protocol):
    """Numbers by name: the printed text, its exact value, and one unit of its last digit."""

    @property
    def numbers(self) -> Mapping[str, str]: ...

    @property
    def values(self) -> Mapping[str, Fraction]: ...

    @property
    def units(self) -> Mapping[str, Fraction]: ...


@dataclass(frozen=True)
class AnyNumbers:
    """Numbers that no table prints: changed ones, or exact ones that may be misprints."""

    numbers: Mapping[str, str]
    values: Mapping[str, Fraction]
    units: Mapping[str, Fraction]


class Neighbourhood:
    """The residuals near the printed numbers: values, derivatives, bounds of second derivatives."""

    def __init__(self, numbers: RoundedNumbers, conditions: ConditionSet) -> None:
        self.numbers, self.conditions = numbers, conditions
        self.names = tuple(numbers.units)
        self.start = [rational_ball(numbers.values[n]) for n in self.names]
        self.unit = [rational_ball(numbers.units[n]) for n in self.names]
        self.second = self._second()
        self.value = self.residuals(self.start, range(len(conditions.equations)))
        self.printed_residuals = [midpoint_and_radius(x)[0] for x in self.value.values()]
        self.slope: Slopes = self.slopes(self.start, self.value)

    def residuals(self, values: Sequence[Ball], rows: Sequence[int]) -> dict[int, Ball]:
        """Return the residuals of the conditions `rows` at the numbers `values`, by condition."""
        point = dict(zip(self.names, values, strict=True))
        entries = entries_at(self.conditions.entries, point, ball_of)
        return self.conditions.residuals_by_index(rows, entries, flint.arb(1))

    def shifted_residuals(
        self, values: Sequence[Ball], k: int, rows: Sequence[int]
    ) -> dict[int, Ball]:
        """Return the residuals with number k larger by the difference quotient's step."""
        return self.residuals(
            [x + difference_step() if i == k else x for i, x in enumerate(values)], rows
        )

    def slopes(self, values: Sequence[Ball], value: Mapping[int, Ball]) -> dict[int, list[Ball]]:
        """Return the derivatives by each number of the conditions in `value`."""
        derivatives: dict[int, list[Ball]] = {i: [] for i in value}
        for k in range(len(values)):
            for i, y in self.shifted_residuals(values, k, list(value)).items():
                # Taylor: the difference quotient is off by at most |second derivative| · step / 2.
                slope = (y - value[i]) / difference_step() + symmetric_ball(
                    difference_step() * self.second[i]
                )
                derivatives[i].append(slope)
        return derivatives

    def _second(self) -> list[Ball]:
        """Return bounds of each residual's second derivatives within half the polydisc's radius."""
        radius = rational_ball(RADIUS)
        reach = {n: abs(x) + radius for n, x in zip(self.names, self.start, strict=True)}
        entries = entries_at(self.conditions.entries, reach, size_of)
        bounds = self.conditions.residuals(entries, flint.arb(1), bound=True)
        # Cauchy's estimate: |F''| ≤ 2 max|F|/(r/2)² within half of the radius r; max|F| is at most
        # x + 1.
        return [((x + 1) * 8 / radius**2).abs_upper() for x in bounds]

    # -- no solutions -----------------------------------------------------------------------------

    def _excludes(
        self, weights: Mapping[int, Ball], units: Fraction | int, slopes: Slopes | None = None
    ) -> bool:
        """Return True if Σ weight · residual ≠ 0 is shown for all numbers within `units` units.

        `slopes`: the derivatives over the whole box, for the mean value theorem; if left out, those
        at the printed numbers and the bounds of second derivatives are used.
        """
        radius, zero = [u * rational_ball(Fraction(units)) for u in self.unit], flint.arb(0)
        spread = zero
        if slopes is None:
            slopes, reach = self.slope, sum(radius, zero) * sum(radius, zero) / 2
            spread = sum((abs(w) * self.second[k] * reach for k, w in weights.items()), zero)
        # The linear part is largest at a corner of the box, the quadratic one is bounded by B.
        for i, r in enumerate(radius):
            spread += abs(sum((w * slopes[k][i] for k, w in weights.items()), zero)) * r
        return bool(abs(sum((w * self.value[k] for k, w in weights.items()), zero)) > spread)

    def find_excluded(self, rows: Sequence[int], units: Fraction | int) -> list[int]:
        """Return the conditions that are shown to hold for no numbers within `units` units."""
        one = flint.arb(1)
        excluded_rows = [k for k in rows if self._excludes({k: one}, units)]
        undecided = [k for k in rows if k not in excluded_rows and self._rough(k, units)]
        if undecided:
            slopes = self._over_box(units)
            excluded_rows += [k for k in undecided if self._excludes({k: one}, units, slopes)]
        return sorted(excluded_rows)

    def _rough(self, k: int, units: Fraction | int) -> bool:
        """Return True if only the bound of second derivatives prevents an exclusion."""
        radius = [u * rational_ball(Fraction(units)) for u in self.unit]
        first = sum((abs(s) * r for s, r in zip(self.slope[k], radius, strict=True)), flint.arb(0))
        return bool(abs(self.value[k]) > first)

    def has_no_solution(self, rows: Sequence[int], units: Fraction | int) -> bool:
        """Return True if it is shown that no numbers within `units` units satisfy all `rows`."""
        return any(self._excludes_together(chosen, units) for chosen in self.choices(rows))

    def _excludes_together(self, rows: Sequence[int], units: Fraction | int) -> bool:
        inverse = self.inverse(rows, self.slope)
        if inverse is None:
            return False
        count = len(rows)
        combinations = [
            dict(zip(rows, (inverse[i, j] for j in range(count)), strict=True))
            for i in range(len(self.names))
        ]
        if any(self._excludes(weights, units) for weights in combinations):
            return True
        slopes = self._over_box(units)
        return any(self._excludes(weights, units, slopes) for weights in combinations)

    def _over_box(self, units: Fraction | int) -> Slopes:
        """Return the derivatives over the box; they are slower and sharper than the bounds."""
        wide = rational_ball(Fraction(units))
        box = [x + symmetric_ball(u * wide) for x, u in zip(self.start, self.unit, strict=True)]
        columns = []
        with length_of_series(2):
            for k in range(len(box)):
                point = {
                    n: flint.arb_series([x, int(i == k)], prec=2)
                    for i, (n, x) in enumerate(zip(self.names, box, strict=True))
                }
                entries = entries_at(self.conditions.entries, point, _constant)
                residuals = self.conditions.residuals(entries, flint.arb_series([1], prec=2))
                columns.append([x[1] for x in residuals])
        return dict(enumerate(zip(*columns, strict=True)))

    # -- independent conditions -------------------------------------------------------------------

    def choices(self, rows: Sequence[int]) -> list[list[int]]:
        """Return selections of `rows`: all unless too many, and those that seem independent."""
        whole_selection = [list(rows)] if len(rows) <= len(self.names) else []
        independent = (self._independent(rows, least) for least in _DEPENDENCE_THRESHOLDS)
        selections = {tuple(x): x for x in (*whole_selection, *independent)}
        return list(selections.values())

    def _independent(self, rows: Sequence[int], least: float) -> list[int]:
        """Return a maximal set of conditions that seem independent at the printed numbers."""
        import numpy as np

        largest = max((u for u in self.numbers.units.values()), default=Fraction(1))
        scale = [float(u / largest) for u in self.numbers.units.values()]
        remaining = np.array([[float(x.mid()) for x in self.slope[k]] for k in rows]) * scale
        remaining = remaining.reshape(len(rows), len(self.names))
        size = np.linalg.norm(remaining, axis=1)
        remaining = remaining / np.where(size > 0, size, 1)[:, None]
        selected: list[int] = []
        while len(selected) < min(len(rows), len(self.names)):
            norms = np.linalg.norm(remaining, axis=1)
            # The first that is far enough from the selected ones: low orders come first.
            far = np.flatnonzero(norms > max(least, 0.1 * norms.max()))
            if not len(far):
                break
            k = int(far[0])
            direction = remaining[k] / norms[k]
            remaining = remaining - np.outer(remaining @ direction, direction)
            remaining[k] = 0
            selected.append(k)
        return sorted(rows[k] for k in selected)

    def inverse(self, rows: Sequence[int], slope: Slopes) -> flint.arb_mat | None:
        """Return U Jᵀ(J U Jᵀ)⁻¹ approximately, U the squared units; None if it is singular."""
        if not rows or len(rows) > len(self.names):
            return None
        jacobian = flint.arb_mat([[x.mid() for x in slope[k]] for k in rows])
        count = len(self.unit)
        # The units weigh the numbers: the solution found is the nearest in units of last digits.
        squares = [[self.unit[i] ** 2 if i == j else 0 for j in range(count)] for i in range(count)]
        weighted = flint.arb_mat(squares) * jacobian.transpose()
        try:
            product = weighted * (jacobian * weighted).inv()
        except ZeroDivisionError:
            return None
        middles = [[product[i, j].mid() for j in range(len(rows))] for i in range(count)]
        return flint.arb_mat(middles)


def difference_step() -> Ball:
    """Return the difference quotient's step."""
    return flint.arb(2) ** -_STEP_EXPONENT


def symmetric_ball(radius: Ball) -> Ball:
    """Return [−radius, radius]."""
    return radius.abs_upper() * flint.arb(0, 1)  # arb(0, radius) may make a tiny radius infinite


def _constant(x: "flint.arb") -> flint.arb_series:
    return flint.arb_series([ball_of(x)], prec=2)
