"""One run of theirs beside ours: what differs by rounding, and what by more.

A setting fits where all numbers of the run are within what rounding may do of those that it
foretells. The right one is tried in the precision that their numbers are printed with, and in
doubles. `verify.reference.compare.diagnosis` tries others where it does not fit.

Whether a program in doubles may leave their range on a run, where the reference data do not.

It does where the toolkit's own step does in doubles; and another program may where a number of the
run, or a product of its determinants, is not far from the largest double.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.systems import float64
from verify.reference.compare.agreement import Cell, Printing, beside
from verify.reference.compare.allowance import Allowance, products
from verify.reference.compare.column_meanings import Foretold
from verify.reference.compare.findings import DOUBLE, Fit, Of, RunFindings, Verdict
from verify.reference.compare.published import PublishedRun
from verify.reference.compare.rows import Row
from verify.reference.compare.scatter import Scatters, run_of
from verify.reference.compare.setting import Points, Setting
from verify.reference.make.orbit_points import Bounded
from verify.runs.start import Start

_LARGE = Fraction(10) ** 250  # what is summed up or multiplied on the way to it may be larger
_MOST_STEPS = 20_000  # stepped


def may_overflow(orbit: Start, step: int, known: dict[str, Bounded]) -> bool:
    """Within so many steps and the next; `known` are the run's numbers then, the state among them
    unless it has left the reference data's range, too."""
    if any(name not in known for name in orbit.hamiltonian.coordinates):
        return _overflows(orbit, step)
    if any(abs(value) > _LARGE for value, _ in known.values()):
        return True
    return products(orbit, step, known) > _LARGE or _overflows(orbit, step)


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
    """Judges one run; see the module's text."""

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
        known = self.ours.numbers(step)
        for name, text in row.cells.items():
            if name in known and text.strip():
                yield name, beside(text, known[name], self.how[name], f"line {row.line}, {name}")

    # -- the right setting --------------------------------------------------------------------

    def judged(self) -> RunFindings:
        """The run as it is, in the unit roundoff that explains most; mistakes are not tried."""
        fits = [(unit, self.fit(self.right, self.names, unit)) for unit in self.units()]
        unit, best = next(((u, f) for u, f in fits if f.fits), fits[-1])
        columns = {name: self._of(name, best) for name in self.names}
        return RunFindings(self.ours.label, columns, [], unit, best.lost_from, best.overflow_from)

    def _of(self, name: str, fit: Fit) -> Of:
        """Where the run is lost its digits say nothing, and they are not looked at."""
        every = {step: cell for (step, n), cell in self.cells.items() if n == name}
        cells = {n: x for n, x in every.items() if fit.lost_from is None or n < fit.lost_from}
        verdict = fit.verdicts[name] if cells else Verdict.LOST
        if not any(cell.differs for cell in every.values()):
            verdict, cells = Verdict.AGREES, every
        if not cells:
            return Of(verdict, 0, math.inf, min(every), None)
        step = min(cells, key=lambda n: cells[n].digits)
        parts_at = fit.parts.get(name) if verdict is Verdict.MORE else None
        return Of(verdict, len(cells), cells[step].digits, step, parts_at)

    def units(self) -> list[Fraction]:
        """The unit roundoffs that they may have worked with, the finest first."""
        digits = max((self.how[n].digits or 0 for n in self.names), default=0)
        fine = [Fraction(10) ** (1 - digits)] if digits > _DOUBLE_DIGITS else []
        return [*fine, DOUBLE]

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
        allowance = Allowance(setting.orbit, unit, self._scatters)
        names = tuple(names)
        found = Fit(dict.fromkeys(names, Verdict.AGREES))
        for (step, name), cell in self.cells.items():
            if name not in names or found.verdicts[name] is Verdict.MORE:
                continue
            known = self.known(setting, step, unit)
            there = {setting.inner(n): x for n, x in known.items()}
            inner, after = setting.inner(name), step + setting.late
            if cell.theirs is None and may_overflow(setting.orbit, after, there):
                found.overflow_from = step if found.overflow_from is None else found.overflow_from
                found.verdicts[name] = max(found.verdicts[name], Verdict.ROUNDING)
                continue
            own = read(step) if read else Foretold(*known[name]) if name in known else None
            verdict: Verdict | None = Verdict.MORE
            if own is not None and name in known:
                if cell.theirs is None:
                    verdict = verdict if allowance.of(inner, after, there) else None
                else:
                    apart = replace(cell, ours=own.value, radius=own.radius).apart
                    found.apart[step, name] = apart
                    verdict = _verdict(allowance, inner, after, there, apart / own.factor)
            if verdict is None:
                found.lost_from = step
                return found
            found.take(step, name, verdict)
            if not wholly and not found.fits:
                return found
        return found

    def known(self, setting: Setting, step: int, unit: Fraction) -> dict[str, Bounded]:
        """The setting's numbers at a row's step, as far as they can be had."""
        if setting == self.right:
            return self.ours.numbers(step)
        known = setting.numbers(step, self.digits(unit))
        wanted = {*self.ours.hamiltonian.coordinates, *self.names}
        return {n: x for n, x in known.items() if n in wanted}

    def digits(self, unit: Fraction) -> int:
        """Those to which numbers are to be known that are judged with this unit roundoff."""
        return max(_LEAST_DIGITS, len(str(unit.denominator)) + _MORE_DIGITS)


def _verdict(
    allowance: Allowance, name: str, step: int, known: dict[str, Bounded], apart: Fraction
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
