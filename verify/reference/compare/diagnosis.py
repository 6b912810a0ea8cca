"""A diagnosis: which mistakes fit a run of theirs that rounding does not explain.

One is named where it fits and the right setting is off by many times more; where several fit,
nothing tells them apart. A mistake of the state is looked for in its columns, where the table has
them; then what is wrong with the others, such as Λ, in the one setting that fits the state.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

from verify.reference.compare.agreement import chance_of_single, is_single
from verify.reference.compare.column_meanings import readings
from verify.reference.compare.findings import (
    DOUBLE,
    SINGLE,
    ColumnVerdict,
    Fit,
    NamedMistake,
    RunFindings,
)
from verify.reference.compare.judge import Judge
from verify.reference.compare.mistakes import (
    Mistake,
    input_mistakes,
    state_mistakes,
    without_synonyms,
)
from verify.reference.compare.setting import Setting

_FARTHER = 30  # times: the right setting is off by so much more than a mistake that fits
_BY_CHANCE = 1e-3  # that all numbers are of single precision


class Diagnosis:
    """The diagnosis of one run with these `findings`.

    `only`: names of the mistakes that are tried, None for all.
    """

    def __init__(
        self, judge: Judge, findings: RunFindings, only: frozenset[str] | None = None
    ) -> None:
        self.judge, self.findings, self.only = judge, findings, only

    def mistakes(self) -> list[list[NamedMistake]]:
        """Return the mistakes that fit: of the state, then of each other column."""
        names, right = self.judge.names, self.judge.right
        states = self.judge.state or names
        groups, settings = [], [right]
        if self._are_off(states) or self._is_finer_than_doubles():
            fitting = without_synonyms(list(self._fitting_mistakes(states)))
            if not fitting and self._are_off(states) and self._is_single(states):
                fitting = [Mistake("single", "you work with single precision", right)]
                self.findings.unit = SINGLE
            groups.append([(x.name, x.says) for x in fitting])
            settings = [x.setting for x in fitting]
        if len(settings) == 1:
            groups += [self._explain_column(settings[0], n) for n in names if n not in states]
        return [group for group in groups if group]

    def _are_off(self, names: Sequence[str]) -> bool:
        return any(self.findings.columns[n].verdict >= ColumnVerdict.PERHAPS for n in names)

    def _is_finer_than_doubles(self) -> bool:
        """Return True if doubles explain numbers that are printed in a finer precision."""
        units = self.judge.units()
        return len(units) > 1 and self.findings.unit == units[-1]

    def _is_single(self, names: Sequence[str]) -> bool:
        """Return True if they worked with single precision."""
        judge = self.judge
        cells = [cell for (_, n), cell in judge.cells.items() if n in judge.state and cell.differs]
        printed = [(x.theirs, x.unit) for x in cells if x.theirs is not None]
        single = all(is_single(*x) for x in printed)
        # A few short decimals are single-precision numbers by accident: the product is the
        # probability that all of them are.
        by_chance = math.prod(chance_of_single(*x) for x in printed)
        return (
            single
            and by_chance <= _BY_CHANCE
            and judge.fit(judge.right, names, SINGLE, wholly=False).fits
        )

    # -- of the state -------------------------------------------------------------------------

    def _fitting_mistakes(self, names: Sequence[str]) -> Iterator[Mistake]:
        """Yield the mistakes in the finest unit roundoff in which one fits, unless the right
        setting does."""
        judge = self.judge
        for unit in judge.units():
            right = judge.fit(judge.right, names, unit)
            if right.fits:
                return
            inputs = input_mistakes(judge.right) if unit < DOUBLE else ()
            tried = [x for x in (*inputs, *state_mistakes(judge.right)) if self._is_tried(x.name)]
            fitting = [x for x in tried if self._fits_alone(x.setting, right, names, unit)]
            yield from fitting
            if fitting:
                return

    def _is_tried(self, name: str) -> bool:
        return self.only is None or name in self.only

    def _fits_alone(
        self, setting: Setting, right: Fit, names: Sequence[str], unit: Fraction
    ) -> bool:
        # The cheap test first: most mistakes are excluded by one number.
        if not self._may_be_nearer(setting, right, unit):
            return False
        fit = self.judge.fit(setting, names, unit, wholly=False)
        return fit.fits and self._is_conclusive(fit) and self._is_nearer(fit, right, unit)

    def _is_conclusive(self, fit: Fit) -> bool:
        """Return True if the setting's run is never lost, or more than one step can be compared
        before that.

        One step says nothing: many a mistake has one point of another's orbit.
        """
        if fit.lost_from is None:
            return True
        return len({step for step, _ in self.judge.cells if 0 < step < fit.lost_from}) > 1

    def _may_be_nearer(self, setting: Setting, right: Fit, unit: Fraction) -> bool:
        """Return False where `_is_nearer` must fail, which is seen without the scatter that
        takes long."""
        place = right.place
        if place is None or place not in right.distances:
            return True
        step, name = place
        bounded = self.judge.numbers(setting, step, unit)
        if name not in bounded:
            return True
        value, radius = bounded[name]
        distance = replace(self.judge.cells[place], ours=value, radius=radius).distance
        return right.distances[place] >= _FARTHER * distance

    def _is_nearer(self, fit: Fit, right: Fit, unit: Fraction) -> bool:
        """Return True if the right setting is off by many times more at the place where it is
        off first."""
        place = right.place
        if place is None or (fit.lost_from is not None and fit.lost_from <= place[0]):
            return False
        if place not in right.distances:  # nothing is known there of the right one
            return True
        least = unit * abs(self.judge.cells[place].theirs or Fraction(0))
        distance = max(fit.distances.get(place, Fraction(0)), least)
        return right.distances[place] >= _FARTHER * distance

    # -- of the other columns -----------------------------------------------------------------

    def _explain_column(self, setting: Setting, name: str) -> list[NamedMistake]:
        """Return other readings of a column that fit, in a setting that does not foretell it."""
        judge, unit = self.judge, self.findings.unit
        if not self._are_off([name]):
            return []
        fit_of_column = judge.fit(setting, [name], unit)
        if fit_of_column.fits:
            return []
        digits, matches = judge.digits(unit), []
        for other, says, read in readings(name):
            if self._is_tried(other):
                fit = judge.fit(setting, [name], unit, partial(read, setting, digits), wholly=False)
                if fit.fits and self._is_nearer(fit, fit_of_column, unit):
                    matches.append((other, says))
        return matches
