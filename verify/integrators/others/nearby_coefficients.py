"""The residues of a printed table near its numbers; the module `printed_table` has the argument."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.arithmetic.arb import Ball, middle_and_radius, rational_ball
from verify.integrators.others.printed_table import PrintedTable, evaluated
from verify.schemes.free_lie_words import LogCondition, of_logarithm, residue, step

_STEP = 160  # the difference quotient's, as a power of 1/2
_RADIUS = Fraction(1, 8)  # of the polydisc of Cauchy's bound
_TURNS = 12


@dataclass(frozen=True)
class Misprint:
    """One number alone that, were it `value`, would make the conditions hold to the digits."""

    name: str
    printed: str
    value: Fraction


class NearbyCoefficients:
    """The residues near the printed numbers: values, derivatives, a bound of the second ones."""

    def __init__(self, table: PrintedTable, asked: Sequence[LogCondition]) -> None:
        self.table, self.asked = table, tuple(asked)
        self.most = max((c.order for c in asked), default=1)
        self.names = tuple(table.units)
        self.start = [rational_ball(table.values[n]) for n in self.names]
        self.unit = [rational_ball(table.units[n]) for n in self.names]
        self.second = self._second()
        self.value = self._residues(self.start)
        self.at_print = [middle_and_radius(x)[0] for x in self.value]
        self.slope = self._slopes(self.start, self.value)  # [condition][number]

    def _residues(self, at: Sequence[Ball]) -> list[Ball]:
        point = dict(zip(self.names, at, strict=True))
        sizes = [evaluated(size, point, rational_ball) for size in self.table.sizes]
        series = step(self.table.kind, self.table.letters(sizes), self.most, flint.arb(1))
        return [residue(series, c) for c in self.asked]

    def _slopes(self, at: Sequence[Ball], value: Sequence[Ball]) -> list[list[Ball]]:
        small = flint.arb(2) ** -_STEP
        columns = []
        for k in range(len(at)):
            moved = [x + small if i == k else x for i, x in enumerate(at)]
            there = self._residues(moved)
            columns.append(
                [
                    (y - x) / small + _around(small * b)
                    for x, y, b in zip(value, there, self.second, strict=True)
                ]
            )
        return [list(row) for row in zip(*columns, strict=True)]

    def _second(self) -> list[Ball]:
        """Bounds of each residue's second derivatives within half the polydisc's radius."""
        radius = rational_ball(_RADIUS)
        reach = {n: abs(x) + radius for n, x in zip(self.names, self.start, strict=True)}
        sizes = [evaluated(size, reach, _size) for size in self.table.sizes]
        series = step(self.table.kind, self.table.letters(sizes), self.most, flint.arb(1))
        bounds = []
        for c in self.asked:
            terms = (of_logarithm(series, word, 1) * abs(n) for n, word in c.terms)
            bounds.append((sum(terms, flint.arb(1)) * 8 / radius**2).abs_upper())
        return bounds

    def _excludes(
        self,
        weights: Mapping[int, Ball],
        units: int,
        slopes: Sequence[Sequence[Ball]] | None = None,
    ) -> bool:
        """Whether Σ weight · residue is not 0 at any numbers within so many units.

        With the derivatives over the whole box, `slopes`, by the mean value theorem; without, with
        those at the printed numbers and the bound of the second ones.
        """
        radius, spread, zero = [u * units for u in self.unit], flint.arb(0), flint.arb(0)
        if slopes is None:
            slopes, reach = self.slope, sum(radius, zero) * sum(radius, zero) / 2
            spread = sum((abs(w) * self.second[k] * reach for k, w in weights.items()), zero)
        for i, r in enumerate(radius):
            spread += abs(sum((w * slopes[k][i] for k, w in weights.items()), zero)) * r
        return bool(abs(sum((w * self.value[k] for k, w in weights.items()), zero)) > spread)

    def excluded(self, rows: Sequence[int], units: int) -> list[int]:
        """The conditions that hold for no numbers within so many units."""
        return [k for k in rows if self._excludes({k: flint.arb(1)}, units)]

    def apart(self, rows: Sequence[int], units: int) -> bool:
        """Whether no numbers within so many units satisfy all of these conditions."""
        inverse = self._inverse(rows, self.slope)
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

    def _over_box(self, units: int) -> list[list[Ball]]:
        """The derivatives over the box: slower than `_slopes`, and sharper than their bound."""
        box = [x + _around(u * units) for x, u in zip(self.start, self.unit, strict=True)]
        columns = []
        with series_of_two_terms():
            for k in range(len(box)):
                point = {
                    n: flint.arb_series([x, int(i == k)], prec=2)
                    for i, (n, x) in enumerate(zip(self.names, box, strict=True))
                }
                one = flint.arb_series([1], prec=2)
                sizes = [evaluated(size, point, _constant) for size in self.table.sizes]
                series = step(self.table.kind, self.table.letters(sizes), self.most, one)
                columns.append([residue(series, c)[1] for c in self.asked])
        return [list(row) for row in zip(*columns, strict=True)]

    def _inverse(
        self, rows: Sequence[int], slope: Sequence[Sequence[Ball]]
    ) -> flint.arb_mat | None:
        """U Jᵀ(J U Jᵀ)⁻¹, nearly."""
        if len(rows) > len(self.names):
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

    def nearest(self, rows: Sequence[int]) -> tuple[Fraction, dict[str, Fraction]] | None:
        """How far a solution of these conditions is, in units of the last digit, and its numbers;
        None where none is shown to exist."""
        if not rows:
            return Fraction(0), dict(self.table.values)
        inverse = self._inverse(rows, self.slope)
        if inverse is None:
            return None
        at = list(self.start)
        for _ in range(_TURNS):  # chords: far faster than they are needed
            value = self._residues(at)
            change = (inverse * flint.arb_mat([[value[k].mid()] for k in rows])).tolist()
            at = [(x - d).mid() for x, (d,) in zip(at, change, strict=True)]
        if not all(
            abs(x - y) < rational_ball(_RADIUS / 4) for x, y in zip(at, self.start, strict=True)
        ):
            return None
        around = self._solution(rows, at)
        if around is None:
            return None
        triples = list(zip(self.names, self.start, around, strict=True))
        off = max(_upper(y - x) / self.table.units[n] for n, x, y in triples)
        return off, {n: middle_and_radius(y)[0] for n, _, y in triples}

    def _solution(self, rows: Sequence[int], at: Sequence[Ball]) -> list[Ball] | None:
        """Balls around `at` in which a solution lies; None where that is not shown."""
        value = self._residues(at)
        slope = self._slopes(at, value)
        inverse = self._inverse(rows, slope)
        if inverse is None:
            return None
        target = [-value[k] for k in rows]
        slack = 2 * max((x.abs_upper() for x in target), key=float) + flint.arb(2) ** -240
        ball = flint.arb_mat([[x + _around(slack)] for x in target])
        moved = [x for (x,) in (inverse * ball).tolist()]
        far = sum((abs(x) for x in moved), flint.arb(0))
        if not far < rational_ball(_RADIUS / 4):
            return None
        size = len(rows)
        identity = flint.arb_mat([[int(i == j) for j in range(size)] for i in range(size)])
        rest = identity - flint.arb_mat([slope[k] for k in rows]) * inverse
        image = (rest * ball).tolist()
        for i, k in enumerate(rows):
            curved = _around(self.second[k] * far * far / 2)
            if not ball[i, 0].contains_interior(target[i] + image[i][0] + curved):
                return None
        return [x + d for x, d in zip(at, moved, strict=True)]

    # -- misprints --------------------------------------------------------------------------------

    def misprint(self, rows: Sequence[int]) -> Misprint | None:
        """The one number whose change alone would do; None where none or several would."""
        found = [m for k in range(len(self.names)) if (m := self._single(k, rows)) is not None]
        return found[0] if len(found) == 1 else None

    def _single(self, k: int, rows: Sequence[int]) -> Misprint | None:
        """By Newton's method for one unknown, in the sense of least squares."""
        at, value = list(self.start), self.value
        largest = max(abs(value[i]) for i in rows)
        small = flint.arb(2) ** -_STEP
        for turn in range(7):
            there = self._residues([x + small if i == k else x for i, x in enumerate(at)])
            slope = [(there[i] - value[i]).mid() / small for i in rows]
            square = sum((d * d for d in slope), flint.arb(0))
            if square == 0:
                return None
            change = sum((d * value[i] for d, i in zip(slope, rows, strict=True)), flint.arb(0))
            at[k] = (at[k] - change / square).mid()
            value = self._residues(at)
            if turn == 0 and not all(abs(value[i]) < largest / 2 for i in rows):
                return None  # no change of this number alone brings them down
        for i in rows:
            allowed = sum((abs(d) * u for d, u in zip(self.slope[i], self.unit, strict=True)), 0)
            if not abs(value[i]) < allowed:
                return None
        name = self.names[k]
        return Misprint(name, self.table.numbers[name], middle_and_radius(at[k])[0])


def _around(radius: Ball) -> Ball:
    """[−radius, radius]."""
    return radius.abs_upper() * flint.arb(0, 1)  # a tiny radius given as such may become infinite


def _upper(x: Ball) -> Fraction:
    middle, radius = middle_and_radius(x)
    return abs(middle) + radius


def _constant(x: Fraction) -> flint.arb_series:
    return flint.arb_series([rational_ball(x)], prec=2)


@contextmanager
def series_of_two_terms() -> Iterator[None]:
    """A value and its derivative; leaves flint's length of series as it was."""
    before, flint.ctx.cap = flint.ctx.cap, 2
    try:
        yield
    finally:
        flint.ctx.cap = before


def _size(x: Fraction) -> Ball:
    return rational_ball(abs(x))
