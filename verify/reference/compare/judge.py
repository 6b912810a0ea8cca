"""A submitted run compared with the published one: differences that rounding explains, and others.

A setting fits if all numbers of the run are within what rounding may do of those that it
foretells. The right one is tried in the precision that their numbers are printed with, and in
doubles. `verify.reference.compare.diagnosis` tries others if it does not fit.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from verify.reference.compare.allowance import Allowance, may_overflow
from verify.reference.compare.published_data import PublishedRun
from verify.reference.compare.scatter import Scatters
from verify.reference.compare.setting import OrbitPoints, Prediction, Setting
from verify.reference.compare.submitted_table import SubmittedRow
from verify.reference.compare.table_agreement import (
    DOUBLE,
    ColumnFindings,
    ColumnVerdict,
    ComparedCell,
    Fit,
    Printing,
    RunFindings,
    cell_of,
)
from verify.reference.make.orbit_computation import Bounded

_DOUBLE_DIGITS = 17  # more than these may be of a more precise number
_MORE_DIGITS, _LEAST_DIGITS = 8, 25


class Judge:
    """The judge of one run; see the module's text."""

    def __init__(
        self,
        published_run: PublishedRun,
        rows: Mapping[int, SubmittedRow],
        printings: Mapping[str, Printing],
        scatters: Scatters,
        points: OrbitPoints,
    ) -> None:
        self.published_run, self.printings, self._scatters = published_run, printings, scatters
        self.cells = {
            (step, name): cell
            for step in sorted(rows)
            for name, cell in self._cells(step, rows[step])
        }
        names = {name for _, name in self.cells}
        self.names = tuple(n for n in published_run.columns if n in names)
        self.state = tuple(n for n in self.names if n in published_run.hamiltonian.coordinates)
        self.right_setting = Setting(published_run.orbit, points)

    def _cells(self, step: int, row: SubmittedRow) -> Iterator[tuple[str, ComparedCell]]:
        bounded = self.published_run.numbers(step)
        for name, text in row.cells.items():
            if name in bounded and text.strip():
                where = f"line {row.line}, {name}"
                yield name, cell_of(text, bounded[name], self.printings[name], where)

    # -- the right setting --------------------------------------------------------------------

    def judge(self) -> RunFindings:
        """Judge the run in the unit roundoff that explains most; mistakes are not tried."""
        fits = [(unit, self.fit(self.right_setting, self.names, unit)) for unit in self.units()]
        # Units are tried from the finest: who fits in high precision did not work with doubles.
        unit, best = next(((u, f) for u, f in fits if f.fits), fits[-1])
        columns = {name: self._describe_column(name, best) for name in self.names}
        return RunFindings(
            self.published_run.label, columns, [], unit, best.lost_from, best.overflow_from
        )

    def _describe_column(self, name: str, fit: Fit) -> ColumnFindings:
        """Describe one column; if the run is lost, its digits say nothing and are not
        compared."""
        column = {step: cell for (step, n), cell in self.cells.items() if n == name}
        cells = {n: x for n, x in column.items() if fit.lost_from is None or n < fit.lost_from}
        verdict = fit.verdicts[name] if cells else ColumnVerdict.LOST
        if not any(cell.differs for cell in column.values()):
            verdict, cells = ColumnVerdict.AGREES, column
        if not cells:
            return ColumnFindings(verdict, 0, math.inf, min(column), None)
        # The place of the fewest digits that agree is the one that a report shows.
        step = min(cells, key=lambda n: cells[n].digits)
        parts_at = fit.parts.get(name) if verdict is ColumnVerdict.MORE else None
        return ColumnFindings(verdict, len(cells), cells[step].digits, step, parts_at)

    def units(self) -> list[Fraction]:
        """Return the unit roundoffs that they may have worked with, the finest first."""
        digits = max((self.printings[n].digits or 0 for n in self.names), default=0)
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
        """Judge how well a setting foretells the columns; unless `wholly`, stop if it fails.

        `predict` returns what a column is foretold to hold, if that is not the setting's number.
        """
        allowance = Allowance(setting.orbit, unit, self._scatters)
        names = tuple(names)
        result = Fit(dict.fromkeys(names, ColumnVerdict.AGREES))
        for (step, name), cell in self.cells.items():
            if name not in names or result.verdicts[name] is ColumnVerdict.MORE:
                continue
            bounded = self.numbers(setting, step, unit)
            inner_values = {setting.inner(n): x for n, x in bounded.items()}
            inner, after = setting.inner(name), step + setting.delay
            if cell.submitted is None and may_overflow(setting.orbit, after, inner_values):
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
                if cell.submitted is None:
                    verdict = (
                        verdict
                        if allowance.accumulated_rounding(inner, after, inner_values)
                        else None
                    )
                else:
                    distance = replace(
                        cell, published=foretold.value, radius=foretold.radius
                    ).distance
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
        if setting == self.right_setting:
            return self.published_run.numbers(step)
        bounded = setting.numbers(step, self.digits(unit))
        columns = {*self.published_run.hamiltonian.coordinates, *self.names}
        return {n: x for n, x in bounded.items() if n in columns}

    def digits(self, unit: Fraction) -> int:
        """Return the digits that numbers need in order to be judged with this unit roundoff."""
        return max(_LEAST_DIGITS, len(str(unit.denominator)) + _MORE_DIGITS)


def _decide(
    allowance: Allowance, name: str, step: int, bounded: dict[str, Bounded], distance: Fraction
) -> ColumnVerdict | None:
    """Return the verdict on one number; None if rounding may have taken every digit."""
    if distance == 0:
        return ColumnVerdict.AGREES
    # The cheap bound is tried first: following the earlier roundings takes a scatter of many runs.
    if distance <= allowance.unavoidable_rounding(name, step, bounded):
        return ColumnVerdict.ROUNDING
    spread = allowance.accumulated_rounding(name, step, bounded)
    if spread is None:
        return None
    if distance <= spread.usual:
        return ColumnVerdict.ROUNDING
    return ColumnVerdict.PERHAPS if distance <= spread.worst else ColumnVerdict.MORE
