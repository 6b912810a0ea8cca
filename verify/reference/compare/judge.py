"""One run of theirs compared with ours: differences that rounding explains, and larger ones.

A setting fits where all numbers of the run are within what rounding may do of those that it
foretells. The right one is tried in the precision that their numbers are printed with, and in
doubles. `verify.reference.compare.diagnosis` tries others where it does not fit.

Also decided here: whether a program in doubles may overflow on a run where the reference data do
not.

It does where the toolkit's own step does in doubles; and another program may where a number of the
run, or a product of its determinants, is not far from the largest double.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.systems import float64
from verify.reference.compare.agreement import Cell, Printing, cell_of
from verify.reference.compare.allowance import Allowance, products
from verify.reference.compare.column_meanings import Prediction
from verify.reference.compare.findings import (
    DOUBLE,
    ColumnFindings,
    ColumnVerdict,
    Fit,
    RunFindings,
)
from verify.reference.compare.published import PublishedRun
from verify.reference.compare.rows import Row
from verify.reference.compare.scatter import Scatters, run_of
from verify.reference.compare.setting import Points, Setting
from verify.reference.make.orbit_points import Bounded
from verify.runs.start import Start

_LARGE = Fraction(10) ** 250  # what is summed up or multiplied on the way to it may be larger
_MOST_STEPS = 20_000  # stepped


def may_overflow(orbit: Start, step: int, bounded: dict[str, Bounded]) -> bool:
    """Return True if doubles may overflow within `step` steps or in the next one.

    `bounded`: the run's numbers then, the state among them unless it has left the range of the
    reference data, too.
    """
    # The reference data have no state there: whether doubles overflow is decided by a run of the
    # toolkit's own.
    if any(name not in bounded for name in orbit.hamiltonian.coordinates):
        return _overflows(orbit, step)
    if any(abs(value) > _LARGE for value, _ in bounded.values()):
        return True
    return products(orbit, step, bounded) > _LARGE or _overflows(orbit, step)


@lru_cache(maxsize=4096)
def _overflows(orbit: Start, step: int) -> bool:
    run = run_of(orbit, min(step, _MOST_STEPS) + 1)
    try:
        return not run.implicit and run.run(float64.make(_DOUBLE_DIGITS)).done < run.steps
    except OverflowError:  # what is given is no double
        return True


_DOUBLE_DIGITS = 17  # more than these may be of a more precise number
_MORE_DIGITS, _LEAST_DIGITS = 8, 25


class Judge:
    """The judge of one run; see the module's text."""

    def __init__(
        self,
        ours: PublishedRun,
        rows: Mapping[int, Row],
        how: Mapping[str, Printing],
        scatters: Scatters,
        points: Points,
    ) -> None:
        self.ours, self.how, self._scatters = ours, how, scatters
        self.cells = {
            (step, name): cell
            for step in sorted(rows)
            for name, cell in self._cells(step, rows[step])
        }
        names = {name for _, name in self.cells}
        self.names = tuple(n for n in ours.columns if n in names)
        self.state = tuple(n for n in self.names if n in ours.hamiltonian.coordinates)
        self.right = Setting(ours.orbit, points)

    def _cells(self, step: int, row: Row) -> Iterator[tuple[str, Cell]]:
        bounded = self.ours.numbers(step)
        for name, text in row.cells.items():
            if name in bounded and text.strip():
                yield name, cell_of(text, bounded[name], self.how[name], f"line {row.line}, {name}")

    # -- the right setting --------------------------------------------------------------------

    def judge(self) -> RunFindings:
        """Judge the run in the unit roundoff that explains most; mistakes are not tried."""
        fits = [(unit, self.fit(self.right, self.names, unit)) for unit in self.units()]
        # Units are tried from the finest: who fits in high precision did not work with doubles.
        unit, best = next(((u, f) for u, f in fits if f.fits), fits[-1])
        columns = {name: self._describe_column(name, best) for name in self.names}
        return RunFindings(self.ours.label, columns, [], unit, best.lost_from, best.overflow_from)

    def _describe_column(self, name: str, fit: Fit) -> ColumnFindings:
        """Describe one column; where the run is lost, its digits say nothing and are not
        compared."""
        every = {step: cell for (step, n), cell in self.cells.items() if n == name}
        cells = {n: x for n, x in every.items() if fit.lost_from is None or n < fit.lost_from}
        verdict = fit.verdicts[name] if cells else ColumnVerdict.LOST
        if not any(cell.differs for cell in every.values()):
            verdict, cells = ColumnVerdict.AGREES, every
        if not cells:
            return ColumnFindings(verdict, 0, math.inf, min(every), None)
        # The place of the fewest digits that agree is the one that a report shows.
        step = min(cells, key=lambda n: cells[n].digits)
        parts_at = fit.parts.get(name) if verdict is ColumnVerdict.MORE else None
        return ColumnFindings(verdict, len(cells), cells[step].digits, step, parts_at)

    def units(self) -> list[Fraction]:
        """Return the unit roundoffs that they may have worked with, the finest first."""
        digits = max((self.how[n].digits or 0 for n in self.names), default=0)
        fine = [Fraction(10) ** (1 - digits)] if digits > _DOUBLE_DIGITS else []
        return [*fine, DOUBLE]

    # -- any setting --------------------------------------------------------------------------

    def fit(
        self,
        setting: Setting,
        names: Iterable[str],
        unit: Fraction,
        predict: Callable[[int], Prediction | None] | None = None,
        *,
        wholly: bool = True,
    ) -> Fit:
        """Judge how well a setting foretells the columns; unless `wholly`, stop where it fails.

        `read` returns what a column is foretold to hold, where that is not the setting's number.
        """
        allowance = Allowance(setting.orbit, unit, self._scatters)
        names = tuple(names)
        result = Fit(dict.fromkeys(names, ColumnVerdict.AGREES))
        for (step, name), cell in self.cells.items():
            if name not in names or result.verdicts[name] is ColumnVerdict.MORE:
                continue
            bounded = self.numbers(setting, step, unit)
            inner_values = {setting.inner(n): x for n, x in bounded.items()}
            inner, after = setting.inner(name), step + setting.late
            if cell.theirs is None and may_overflow(setting.orbit, after, inner_values):
                result.overflow_from = (
                    step if result.overflow_from is None else result.overflow_from
                )
                result.verdicts[name] = max(result.verdicts[name], ColumnVerdict.ROUNDING)
                continue
            foretold = (
                predict(step)
                if predict
                else Prediction(*bounded[name])
                if name in bounded
                else None
            )
            verdict: ColumnVerdict | None = ColumnVerdict.MORE
            if foretold is not None and name in bounded:
                if cell.theirs is None:
                    verdict = verdict if allowance.after_steps(inner, after, inner_values) else None
                else:
                    distance = replace(cell, ours=foretold.value, radius=foretold.radius).distance
                    result.distances[step, name] = distance
                    verdict = _decide(
                        allowance, inner, after, inner_values, distance / foretold.factor
                    )
            # Rounding may have taken every digit: nothing can be said of this step or of later
            # ones.
            if verdict is None:
                result.lost_from = step
                return result
            result.take(step, name, verdict)
            if not wholly and not result.fits:
                return result
        return result

    def numbers(self, setting: Setting, step: int, unit: Fraction) -> dict[str, Bounded]:
        """Return the setting's numbers at a row's step, as far as they can be computed."""
        if setting == self.right:
            return self.ours.numbers(step)
        bounded = setting.numbers(step, self.digits(unit))
        columns = {*self.ours.hamiltonian.coordinates, *self.names}
        return {n: x for n, x in bounded.items() if n in columns}

    def digits(self, unit: Fraction) -> int:
        """Return the digits that numbers need in order to be judged with this unit roundoff."""
        return max(_LEAST_DIGITS, len(str(unit.denominator)) + _MORE_DIGITS)


def _decide(
    allowance: Allowance, name: str, step: int, bounded: dict[str, Bounded], distance: Fraction
) -> ColumnVerdict | None:
    """Return the verdict on one number; None where rounding may have taken every digit."""
    if distance == 0:
        return ColumnVerdict.AGREES
    # The cheap bound is tried first: following the earlier roundings takes a scatter of many runs.
    if distance <= allowance.at_once(name, step, bounded):
        return ColumnVerdict.ROUNDING
    spread = allowance.after_steps(name, step, bounded)
    if spread is None:
        return None
    if distance <= spread.usual:
        return ColumnVerdict.ROUNDING
    return ColumnVerdict.PERHAPS if distance <= spread.worst else ColumnVerdict.MORE
