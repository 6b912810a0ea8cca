"""A submitted run compared with the published one: differences that rounding explains, and others.

A setting is a run's inputs and scheme with the reading of its columns, right or mistaken. It fits
if each number of the submitted run differs from the predicted one by no more than rounding
explains. The right setting is tried with the unit roundoff of the printed digits, if these are more
than a double's, and with that of doubles. If it does not fit, `verify.reference.compare.diagnosis`
tries others.
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

_DOUBLE_DIGITS = 17  # a number printed with more digits may come from a finer arithmetic
_EXTRA_DIGITS, _LEAST_DIGITS = 8, 25


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
        """Judge the run by the right setting, with the finest unit roundoff that fits, or doubles'.

        Mistakes are not tried.
        """
        fits = [(unit, self.fit(self.right_setting, self.names, unit)) for unit in self.units()]
        # Units are tried from the finest: a run that fits in high precision is none of doubles.
        unit, best = next(((u, f) for u, f in fits if f.fits), fits[-1])
        columns = {name: self._describe_column(name, best) for name in self.names}
        return RunFindings(
            self.published_run.label, columns, [], unit, best.lost_from, best.overflow_from
        )

    def _describe_column(self, name: str, fit: Fit) -> ColumnFindings:
        """Describe one column up to the step from which the run is lost.

        Later digits say nothing, and are not compared unless all of them agree.
        """
        column = {step: cell for (step, n), cell in self.cells.items() if n == name}
        cells = {n: x for n, x in column.items() if fit.lost_from is None or n < fit.lost_from}
        verdict = fit.verdicts[name] if cells else ColumnVerdict.LOST
        if not any(cell.differs for cell in column.values()):
            verdict, cells = ColumnVerdict.AGREES, column
        if not cells:
            return ColumnFindings(verdict, 0, math.inf, min(column), None)
        # A report shows the step at which the fewest digits agree.
        step = min(cells, key=lambda n: cells[n].digits)
        parts_at = fit.parts.get(name) if verdict is ColumnVerdict.MORE else None
        return ColumnFindings(verdict, len(cells), cells[step].digits, step, parts_at)

    def units(self) -> list[Fraction]:
        """Return the unit roundoffs that the program may have had, the finest first."""
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
        """Judge if a setting's numbers fit the columns; unless `wholly`, stop at the first misfit.

        `predict`: the number predicted at a step, if that is not the setting's own number.
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
            prediction = (
                predict(step)
                if predict
                else Prediction(*bounded[name])
                if name in bounded
                else None
            )
            verdict: ColumnVerdict | None = ColumnVerdict.MORE
            if prediction is not None and name in bounded:
                if cell.submitted is None:
                    verdict = (
                        verdict
                        if allowance.accumulated_rounding(inner, after, inner_values)
                        else None
                    )
                else:
                    distance = replace(
                        cell, published=prediction.value, radius=prediction.radius
                    ).distance
                    result.distances[step, name] = distance
                    verdict = _decide(
                        allowance, inner, after, inner_values, distance / prediction.factor
                    )
            # None: rounding may have taken every digit of this step and of later ones.
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
        return max(_LEAST_DIGITS, len(str(unit.denominator)) + _EXTRA_DIGITS)


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
