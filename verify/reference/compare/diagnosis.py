"""Which mistakes fit a run of theirs that rounding does not explain.

One is named where it fits and the right setting is off by many times more; where several fit,
nothing tells them apart. A mistake of the state is looked for in its columns, where they are given;
then what is wrong with the others, such as Λ, in the one setting that the state has.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

from verify.reference.compare.agreement import chance_of_single, is_single
from verify.reference.compare.column_meanings import readings
from verify.reference.compare.findings import DOUBLE, SINGLE, Fit, Named, RunFindings, Verdict
from verify.reference.compare.judge import Judge
from verify.reference.compare.mistakes import Mistake, of_inputs, of_states, without_synonyms
from verify.reference.compare.setting import Setting

_FARTHER = 30  # times: the right setting is off by so much more than a mistake that fits
_BY_CHANCE = 1e-3  # that all numbers are of single precision


class Diagnosis:
    """Of one run, as it was `judged`; `only`: names of the mistakes that are tried, if not all."""

    def __init__(
        self, judge: Judge, judged: RunFindings, only: frozenset[str] | None = None
    ) -> None:
        self.judge, self.judged, self.only = judge, judged, only

    def mistakes(self) -> list[list[Named]]:
        """Those that fit: of the state, then of each other column."""
        names, right = self.judge.names, self.judge.right
        states = self.judge.state or names
        found, settings = [], [right]
        if self._off(states) or self._finer_than_doubles():
            fitting = without_synonyms(list(self._fitting(states)))
            if not fitting and self._off(states) and self._is_single(states):
                fitting = [Mistake("single", "you work with single precision", right)]
                self.judged.unit = SINGLE
            found.append([(x.name, x.says) for x in fitting])
            settings = [x.setting for x in fitting]
        if len(settings) == 1:
            found += [self._of_column(settings[0], n) for n in names if n not in states]
        return [group for group in found if group]

    def _off(self, names: Sequence[str]) -> bool:
        return any(self.judged.columns[n].verdict >= Verdict.PERHAPS for n in names)

    def _finer_than_doubles(self) -> bool:
        """Whether doubles explain what is printed as if it were of a finer precision."""
        units = self.judge.units()
        return len(units) > 1 and self.judged.unit == units[-1]

    def _is_single(self, names: Sequence[str]) -> bool:
        """Whether they worked with single precision."""
        judge = self.judge
        cells = [cell for (_, n), cell in judge.cells.items() if n in judge.state and cell.differs]
        known = [(x.theirs, x.unit) for x in cells if x.theirs is not None]
        single = all(is_single(*x) for x in known)
        by_chance = math.prod(chance_of_single(*x) for x in known)
        return (
            single
            and by_chance <= _BY_CHANCE
            and judge.fit(judge.right, names, SINGLE, wholly=False).fits
        )

    # -- of the state -------------------------------------------------------------------------

    def _fitting(self, names: Sequence[str]) -> Iterator[Mistake]:
        """In the finest unit roundoff in which one fits, unless the right setting does."""
        judge = self.judge
        for unit in judge.units():
            right = judge.fit(judge.right, names, unit)
            if right.fits:
                return
            inputs = of_inputs(judge.right) if unit < DOUBLE else ()
            tried = [x for x in (*inputs, *of_states(judge.right)) if self._asked(x.name)]
            fitting = [x for x in tried if self._fits(x.setting, right, names, unit)]
            yield from fitting
            if fitting:
                return

    def _asked(self, name: str) -> bool:
        return self.only is None or name in self.only

    def _fits(self, setting: Setting, right: Fit, names: Sequence[str], unit: Fraction) -> bool:
        if not self._nearer_by_itself(setting, right, unit):
            return False
        fit = self.judge.fit(setting, names, unit, wholly=False)
        return fit.fits and self._tells(fit) and self._nearer(fit, right, unit)

    def _tells(self, fit: Fit) -> bool:
        """Whether there is more than one step to go by, where the setting's run is lost so early
        that it says nothing of the others: many a mistake has one point of another's orbit."""
        if fit.lost_from is None:
            return True
        return len({step for step, _ in self.judge.cells if 0 < step < fit.lost_from}) > 1

    def _nearer_by_itself(self, setting: Setting, right: Fit, unit: Fraction) -> bool:
        """What `_nearer` asks for, before anything is scattered, which takes long."""
        place = right.place
        if place is None or place not in right.apart:
            return True
        step, name = place
        known = self.judge.known(setting, step, unit)
        if name not in known:
            return True
        value, radius = known[name]
        apart = replace(self.judge.cells[place], ours=value, radius=radius).apart
        return right.apart[place] >= _FARTHER * apart

    def _nearer(self, fit: Fit, right: Fit, unit: Fraction) -> bool:
        """Whether the right setting is off by many times more, where it is off first."""
        place = right.place
        if place is None or (fit.lost_from is not None and fit.lost_from <= place[0]):
            return False
        if place not in right.apart:  # nothing is known there of the right one
            return True
        least = unit * abs(self.judge.cells[place].theirs or Fraction(0))
        own = max(fit.apart.get(place, Fraction(0)), least)
        return right.apart[place] >= _FARTHER * own

    # -- of the other columns -----------------------------------------------------------------

    def _of_column(self, setting: Setting, name: str) -> list[Named]:
        """Other readings of a column that fit, in a setting that does not foretell it."""
        judge, unit = self.judge, self.judged.unit
        if not self._off([name]):
            return []
        own = judge.fit(setting, [name], unit)
        if own.fits:
            return []
        digits, found = judge.digits(unit), []
        for other, says, read in readings(name):
            if self._asked(other):
                fit = judge.fit(setting, [name], unit, partial(read, setting, digits), wholly=False)
                if fit.fits and self._nearer(fit, own, unit):
                    found.append((other, says))
        return found
