"""One run of theirs beside ours: what differs by rounding, what by more, and which mistake fits.

An explanation fits where all numbers of the run are within what rounding may do of those that it
foretells. The right one is tried first, in the precision that their numbers are printed with and in
doubles: where it fits, nothing is said of mistakes. A mistake is named where it fits and the right
setting is off by many times more; where several fit, nothing tells them apart.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import IntEnum
from fractions import Fraction
from functools import partial

from reference.agreement import Cell, Printing, beside, is_single
from reference.allowance import Allowance
from reference.mistakes import (
    Foretold,
    Mistake,
    of_inputs,
    of_states,
    readings,
    value_of,
    without_synonyms,
)
from reference.ours import OurRun
from reference.overflow import may_overflow
from reference.scatter import Scatters
from reference.setting import Known, Points, Setting
from reference.theirs import Row

DOUBLE, SINGLE = Fraction(1, 2**53), Fraction(1, 2**24)
STATE, AREA = ("p", "q"), ("delta_j", "mse", "lambda")
_DOUBLE_DIGITS = 17  # more than these may be of a more precise number
_FARTHER = 30  # times: the right setting is off by so much more than a mistake that fits
_SINGLES = 4  # numbers of single precision, so that it is not by chance
_MORE_DIGITS, _LEAST_DIGITS = 8, 25
Named = tuple[str, str]  # a mistake's name, and what it says


class Verdict(IntEnum):
    """Of a column, or of a run, from best to worst."""

    AGREES = 0  # in all digits that are printed
    ROUNDING = 1
    PERHAPS = 2  # more than rounding usually does, and less than it may do
    MORE = 3


@dataclass(frozen=True)
class Of:
    """What was found of a column of one run: `digits` agree at least, the least of them at `step`.

    `parts_at`: the first step at which it differs by more than rounding.
    """

    verdict: Verdict
    rows: int
    digits: float
    step: int
    parts_at: int | None


@dataclass
class Judged:
    """What was found of one run. `mistakes`: those that fit; one, or several which nothing tells
    apart. `unit`: the unit roundoff that explains it, or would. `lost_from`: the step from which
    rounding may have taken every digit, so that nothing can be said. `overflow_from`: the first
    step of which a number is not finite where doubles may overflow."""

    label: str
    columns: dict[str, Of] = field(default_factory=dict)
    mistakes: list[list[Named]] = field(default_factory=list)
    unit: Fraction = DOUBLE
    lost_from: int | None = None
    overflow_from: int | None = None

    @property
    def verdict(self) -> Verdict:
        return max((x.verdict for x in self.columns.values()), default=Verdict.AGREES)


@dataclass
class Fit:
    """How well a setting foretells some columns: a verdict of each, the first place of a column at
    which it does not, and how far off it is at each place, as far as was looked."""

    verdicts: dict[str, Verdict]
    parts: dict[str, int] = field(default_factory=dict)
    apart: dict[tuple[int, str], Fraction] = field(default_factory=dict)
    lost_from: int | None = None
    overflow_from: int | None = None

    @property
    def fits(self) -> bool:
        return max(self.verdicts.values(), default=Verdict.AGREES) <= Verdict.ROUNDING

    @property
    def place(self) -> tuple[int, str] | None:
        """The first place at which rounding does not usually explain it."""
        return min(((step, name) for name, step in self.parts.items()), default=None)


class Judge:
    """Judges one run; see the module's text."""

    def __init__(
        self,
        ours: OurRun,
        rows: Mapping[int, Row],
        how: Mapping[str, Printing],
        scatters: Scatters,
        points: Points,
    ) -> None:
        self.ours, self.how, self._scatters = ours, how, scatters
        self.cells: dict[tuple[int, str], Cell] = {}
        for step in sorted(rows):
            for name, cell in self._cells(step, rows[step]):
                self.cells[step, name] = cell
        names = {name for _, name in self.cells}
        self.names = tuple(n for n in (*STATE, *AREA) if n in names)
        self.right = Setting(ours.case, points)

    def _cells(self, step: int, row: Row) -> Iterator[tuple[str, Cell]]:
        point = self.ours.rows[step]
        for name, text in row.cells.items():
            known = getattr(point, "lam" if name == "lambda" else name)
            if known is not None and text.strip():
                yield name, beside(text, known, self.how[name], f"line {row.line}, {name}")

    # -- the right setting --------------------------------------------------------------------

    def judged(self) -> tuple[Judged, Fit]:
        """The run as it is, in the unit roundoff that explains most; mistakes are not tried."""
        fits = [(unit, self.fit(self.right, self.names, unit)) for unit in self.units()]
        unit, best = next(((u, f) for u, f in fits if f.fits), fits[-1])
        columns = {name: self._of(name, best) for name in self.names}
        return Judged(self.ours.label, columns, [], unit, best.lost_from, best.overflow_from), best

    def _of(self, name: str, fit: Fit) -> Of:
        cells = {step: cell for (step, n), cell in self.cells.items() if n == name}
        step = min(cells, key=lambda n: cells[n].digits)
        verdict = fit.verdicts[name]
        if all(cell.agrees for cell in cells.values()):
            verdict = Verdict.AGREES
        parts_at = fit.parts.get(name) if verdict is Verdict.MORE else None
        return Of(verdict, len(cells), cells[step].digits, step, parts_at)

    def units(self) -> list[Fraction]:
        """The unit roundoffs that they may have worked with, the finest first."""
        digits = max((self.how[n].digits or 0 for n in self.names), default=0)
        fine = [Fraction(10) ** (1 - digits)] if digits > _DOUBLE_DIGITS else []
        return [*fine, DOUBLE]

    def _is_single(self, names: list[str]) -> bool:
        """Whether they worked with single precision."""
        cells = [cell for (_, n), cell in self.cells.items() if n in STATE and cell.differs]
        known = [(x.theirs, x.unit) for x in cells if x.theirs is not None]
        single = len(known) >= _SINGLES and all(is_single(*x) for x in known)
        return single and self.fit(self.right, names, SINGLE, wholly=False).fits

    # -- any setting --------------------------------------------------------------------------

    def fit(
        self,
        setting: Setting,
        names: Iterable[str],
        unit: Fraction,
        read: Callable[[int], Foretold | None] | None = None,
        *,
        wholly: bool = True,
    ) -> Fit:
        """How well it foretells the columns; unless `wholly`, no farther than to where it fails.

        `read` gives what a column is foretold to hold, where that is not the setting's own.
        """
        allowance = Allowance(setting.case, unit, self._scatters)
        names = tuple(names)
        found = Fit(dict.fromkeys(names, Verdict.AGREES))
        for (step, name), cell in self.cells.items():
            if name not in names or found.verdicts[name] is Verdict.MORE:
                continue
            known = self._known(setting, step, unit)
            if cell.theirs is None and may_overflow(setting.case, step + setting.late, known):
                found.overflow_from = step if found.overflow_from is None else found.overflow_from
                found.verdicts[name] = max(found.verdicts[name], Verdict.ROUNDING)
                continue
            own = read(step) if read else Foretold(*known[name]) if name in known else None
            verdict = Verdict.MORE
            if own is not None and name in known and cell.theirs is not None:
                apart = replace(cell, ours=own.value, radius=own.radius).apart
                found.apart[step, name] = apart
                of_it = _verdict(allowance, name, step + setting.late, known, apart / own.factor)
                if of_it is None:
                    found.lost_from = step
                    return found
                verdict = of_it
            if verdict >= Verdict.PERHAPS:
                found.parts.setdefault(name, step)
            if verdict is Verdict.MORE:
                found.parts[name] = min(found.parts[name], step)
            found.verdicts[name] = max(found.verdicts[name], verdict)
            if not wholly and not found.fits:
                return found
        return found

    def _known(self, setting: Setting, step: int, unit: Fraction) -> dict[str, Known]:
        if setting == self.right:
            return self._printed(step)
        digits = self.digits(unit)
        found = dict(setting.state(step, digits) or {})
        for name in AREA:
            value = value_of(setting, name, step, digits) if name in self.names else None
            if value is not None:
                found[name] = value
        return found

    def _printed(self, step: int) -> dict[str, Known]:
        """What the reference data say."""
        point = self.ours.rows[step]
        found = {n: getattr(point, "lam" if n == "lambda" else n) for n in (*STATE, *AREA)}
        return {n: (Fraction(x.value), Fraction(x.radius)) for n, x in found.items() if x}

    def digits(self, unit: Fraction) -> int:
        return max(_LEAST_DIGITS, len(str(unit.denominator)) + _MORE_DIGITS)

    # -- mistakes -----------------------------------------------------------------------------

    def explained(self, judged: Judged, right: Fit, only: frozenset[str] | None = None) -> None:
        """Tries mistakes, or `only` those of these names, and puts those that fit in `judged`."""
        states = [n for n in STATE if n in self.names] or list(self.names)
        settings = [self.right]
        if any(judged.columns[n].verdict >= Verdict.PERHAPS for n in states) or self._fine(judged):
            fitting = without_synonyms(list(self._fitting(states, only)))
            if not fitting and self._is_single(states):
                fitting = [Mistake("single", "you work with single precision", self.right)]
                judged.unit = SINGLE
            if fitting:
                judged.mistakes.append([(x.name, x.says) for x in fitting])
            settings = [x.setting for x in fitting]
        if len(settings) != 1 or states == list(self.names):
            return
        for name in (n for n in AREA if n in self.names):
            if judged.columns[name].verdict < Verdict.PERHAPS:
                continue
            again = self.fit(settings[0], [name], judged.unit)
            if not again.fits:
                others = self._readings(settings[0], name, judged.unit, again, only)
                if others:
                    judged.mistakes.append(others)

    def _fine(self, judged: Judged) -> bool:
        """Whether doubles explain what was printed as if it were of a finer precision."""
        return len(self.units()) > 1 and judged.unit == self.units()[-1]

    def _fitting(self, names: list[str], only: frozenset[str] | None) -> Iterator[Mistake]:
        units = self.units()
        for unit in units:
            tried = [*of_states(self.right)]
            if unit < DOUBLE:
                tried = [*of_inputs(self.right), *tried]
            right = self.fit(self.right, names, unit)
            if right.fits:
                return
            found = [x for x in tried if only is None or x.name in only]
            fitting = [x for x in found if self._is(x.setting, right, names, unit)]
            if fitting:
                yield from fitting
                return

    def _is(self, setting: Setting, right: Fit, names: list[str], unit: Fraction) -> bool:
        if not self._near_there(setting, right, unit):
            return False
        fit = self.fit(setting, names, unit, wholly=False)
        return fit.fits and self._nearer(fit, right, unit)

    def _near_there(self, setting: Setting, right: Fit, unit: Fraction) -> bool:
        """What `_nearer` asks for, before anything is scattered, which takes long."""
        place = right.place
        if place is None or place not in right.apart:
            return True
        step, name = place
        known = self._known(setting, step, unit)
        if name not in known:
            return True
        value, radius = known[name]
        apart = replace(self.cells[place], ours=value, radius=radius).apart
        return right.apart[place] >= _FARTHER * apart

    def _nearer(self, fit: Fit, right: Fit, unit: Fraction) -> bool:
        """Whether the right setting is off by many times more, where it is off first."""
        place = right.place
        if place is None or (fit.lost_from is not None and fit.lost_from <= place[0]):
            return False
        if place not in right.apart:  # nothing is known there of the right one
            return True
        least = unit * abs(self.cells[place].theirs or Fraction(0))
        own = max(fit.apart.get(place, Fraction(0)), least)
        return right.apart[place] >= _FARTHER * own

    def _readings(
        self, setting: Setting, name: str, unit: Fraction, right: Fit, only: frozenset[str] | None
    ) -> list[Named]:
        digits = self.digits(unit)
        found = []
        for own, says, read in readings(name):
            if only is not None and own not in only:
                continue
            fit = self.fit(setting, [name], unit, partial(read, setting, digits), wholly=False)
            if fit.fits and self._nearer(fit, right, unit):
                found.append((own, says))
        return found


def _verdict(
    allowance: Allowance, name: str, step: int, known: dict[str, Known], apart: Fraction
) -> Verdict | None:
    """None where rounding may have taken every digit."""
    if apart == 0:
        return Verdict.AGREES
    if apart <= allowance.at_once(name, step, known):
        return Verdict.ROUNDING
    allowed = allowance.of(name, step, known)
    if allowed is None:
        return None
    if apart <= allowed.usual:
        return Verdict.ROUNDING
    return Verdict.PERHAPS if apart <= allowed.worst else Verdict.MORE
