"""A diagnosis: which mistakes fit a submitted run that rounding does not explain.

A mistake is named if it fits and the right setting's numbers differ by many times more. If several
fit, all are named. Mistakes of the state are looked for in the state's columns, if the table has
them; then mistakes of the other columns, such as Λ, in the one setting that fits the state.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

from verify.reference.compare.judge import Judge
from verify.reference.compare.run_mistakes import (
    Mistake,
    input_mistakes,
    state_mistakes,
    without_synonyms,
)
from verify.reference.compare.setting import Setting, readings
from verify.reference.compare.table_agreement import (
    DOUBLE,
    SINGLE,
    ColumnVerdict,
    Fit,
    NamedMistake,
    RunFindings,
    chance_of_single,
    is_single,
)

_DISTANCE_RATIO = 30  # the right setting differs at least this many times more than a mistake's
_LARGEST_CHANCE = 1e-3  # the probability that all numbers are of single precision by chance


class Diagnosis:
    """The diagnosis of one run with these `findings`.

    `tried`: names of the mistakes that are tried, None for all.
    """

    def __init__(
        self, judge: Judge, findings: RunFindings, tried: frozenset[str] | None = None
    ) -> None:
        self.judge, self.findings, self.tried = judge, findings, tried

    def mistakes(self) -> list[list[NamedMistake]]:
        """Return the mistakes that fit: of the state, then of each other column."""
        names, right_setting = self.judge.names, self.judge.right_setting
        states = self.judge.state or names
        groups, settings = [], [right_setting]
        if self._are_off(states) or self._is_finer_than_doubles():
            fitting = without_synonyms(list(self._fitting_mistakes(states)))
            if not fitting and self._are_off(states) and self._is_single(states):
                fitting = [Mistake("single", "you work with single precision", right_setting)]
                self.findings.unit = SINGLE
            groups.append([(x.name, x.says) for x in fitting])
            settings = [x.setting for x in fitting]
        if len(settings) == 1:
            groups += [self._explain_column(settings[0], n) for n in names if n not in states]
        return [group for group in groups if group]

    def _are_off(self, names: Sequence[str]) -> bool:
        return any(self.findings.columns[n].verdict >= ColumnVerdict.PERHAPS for n in names)

    def _is_finer_than_doubles(self) -> bool:
        """Return True if numbers are printed in a finer precision that does not explain them.

        The findings' unit roundoff is then that of doubles.
        """
        units = self.judge.units()
        return len(units) > 1 and self.findings.unit == units[-1]

    def _is_single(self, names: Sequence[str]) -> bool:
        """Return True if the numbers show that the program worked in single precision."""
        judge = self.judge
        cells = [cell for (_, n), cell in judge.cells.items() if n in judge.state and cell.differs]
        printed = [(x.submitted, x.unit) for x in cells if x.submitted is not None]
        single = all(is_single(*x) for x in printed)
        # A few short decimals are single-precision numbers by accident: the product is the
        # probability that all of them are.
        by_chance = math.prod(chance_of_single(*x) for x in printed)
        return (
            single
            and by_chance <= _LARGEST_CHANCE
            and judge.fit(judge.right_setting, names, SINGLE, wholly=False).fits
        )

    # -- of the state -------------------------------------------------------------------------

    def _fitting_mistakes(self, names: Sequence[str]) -> Iterator[Mistake]:
        """Yield the mistakes that fit in the finest unit roundoff in which one does.

        None is yielded if the right setting fits in that or a finer one.
        """
        judge = self.judge
        for unit in judge.units():
            right_fit = judge.fit(judge.right_setting, names, unit)
            if right_fit.fits:
                return
            inputs = input_mistakes(judge.right_setting) if unit < DOUBLE else ()
            mistakes = [
                x for x in (*inputs, *state_mistakes(judge.right_setting)) if self._is_tried(x.name)
            ]
            fitting = [x for x in mistakes if self._fits_alone(x.setting, right_fit, names, unit)]
            yield from fitting
            if fitting:
                return

    def _is_tried(self, name: str) -> bool:
        return self.tried is None or name in self.tried

    def _fits_alone(
        self, setting: Setting, right_fit: Fit, names: Sequence[str], unit: Fraction
    ) -> bool:
        # The cheap test first: most mistakes are excluded by one number.
        if not self._may_be_nearer(setting, right_fit, unit):
            return False
        fit = self.judge.fit(setting, names, unit, wholly=False)
        return fit.fits and self._is_conclusive(fit) and self._is_nearer(fit, right_fit, unit)

    def _is_conclusive(self, fit: Fit) -> bool:
        """Return True if the setting's run is never lost, or two steps are compared before that.

        One step says nothing: the orbits of many mistakes have one point in common.
        """
        if fit.lost_from is None:
            return True
        return len({step for step, _ in self.judge.cells if 0 < step < fit.lost_from}) > 1

    def _may_be_nearer(self, setting: Setting, right_fit: Fit, unit: Fraction) -> bool:
        """Return False if `_is_nearer` must fail; this needs no scatter, which takes long."""
        place = right_fit.place
        if place is None or place not in right_fit.distances:
            return True
        step, name = place
        bounded = self.judge.numbers(setting, step, unit)
        if name not in bounded:
            return True
        value, radius = bounded[name]
        distance = replace(self.judge.cells[place], published=value, radius=radius).distance
        return right_fit.distances[place] >= _DISTANCE_RATIO * distance

    def _is_nearer(self, fit: Fit, right_fit: Fit, unit: Fraction) -> bool:
        """Return True if the right setting differs many times more in its first wrong cell.

        `place` is the step and the column of that cell.
        """
        place = right_fit.place
        if place is None or (fit.lost_from is not None and fit.lost_from <= place[0]):
            return False
        if place not in right_fit.distances:  # the right setting has no number there
            return True
        least = unit * abs(self.judge.cells[place].submitted or Fraction(0))
        distance = max(fit.distances.get(place, Fraction(0)), least)
        return right_fit.distances[place] >= _DISTANCE_RATIO * distance

    # -- of the other columns -----------------------------------------------------------------

    def _explain_column(self, setting: Setting, name: str) -> list[NamedMistake]:
        """Return the other readings of a column that fit, if the setting's own number does not."""
        judge, unit = self.judge, self.findings.unit
        if not self._are_off([name]):
            return []
        fit_of_column = judge.fit(setting, [name], unit)
        if fit_of_column.fits:
            return []
        digits, matches = judge.digits(unit), []
        for meaning in readings(name):
            if self._is_tried(meaning.name):
                predict = partial(meaning.read, setting, digits)
                fit = judge.fit(setting, [name], unit, predict, wholly=False)
                if fit.fits and self._is_nearer(fit, fit_of_column, unit):
                    matches.append((meaning.name, meaning.says))
        return matches
