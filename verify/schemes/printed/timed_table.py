"""The printed clocks of a splitting: the times, in parts of h, at which its parts read H(p, q, t).

Where each is the right one, the sum of the other kind's parts before it, the conditions without
time are all that is asked, but of a quadratic T that depends on time
(`verify.schemes.conditions.splitting_conditions`).
Where one is not, those of words with time tell (`verify.schemes.conditions.words.equations`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import sympy

from verify.arithmetic.number import E
from verify.schemes.conditions.splitting_conditions import LETTERS, sums_before
from verify.schemes.conditions.words.equations import TimedEquation, equations_of
from verify.schemes.conditions.words.kinetic import Kinetic
from verify.schemes.conditions.words.step_words import StepWords
from verify.schemes.printed.asked import Asked, Named, both
from verify.schemes.printed.judged import Judged, judge
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.schemes.printed.splitting_table import PrintedTable, judge_order
from verify.verdict import Verdict

_MOST_ORDER = 6  # with clocks that are not right: of higher ones there are too many words


@dataclass(frozen=True)
class TimedTable:
    """`times`: a text for each part, None where it reads no time. `both`: whether T depends on
    time, too, so that drifts are judged."""

    table: PrintedTable
    times: tuple[str | None, ...]
    both: bool = False

    @property
    def printed(self) -> PrintedNumbers:
        """The numbers of sizes and times."""
        return self.table.printed

    def read(self, numbers: PrintedNumbers) -> "TimedTable":
        """The same with its numbers read so."""
        return replace(self, table=self.table.read(numbers))

    @property
    def kinetic(self) -> Kinetic:
        """The class of T that is claimed."""
        if self.table.kind == "nystrom":
            return Kinetic.MASS if self.both else Kinetic.QUADRATIC
        return Kinetic.GENERAL if self.both else Kinetic.AUTONOMOUS

    @property
    def kinds(self) -> tuple[str, ...]:
        """Of the parts."""
        return tuple(kind for kind, _ in self.table.parts)

    @property
    def judged(self) -> tuple[int, ...]:
        """The parts whose times count."""
        return tuple(
            k
            for k, kind in enumerate(self.kinds)
            if LETTERS[kind] in self.kinetic.timed
            and self.table.sizes[k] != 0
            and self.times[k] is not None
        )

    @property
    def entries(self) -> tuple[sympy.Expr, ...]:
        """The sizes, and the times of the judged parts."""
        told = (self.printed.entry(self.times[k] or "0", "times") for k in self.judged)
        return (*self.table.sizes, *told)

    @property
    def labels(self) -> tuple[str, ...]:
        """What they are called."""
        kinds = self.kinds
        sizes = (f"{kind} {k + 1}" for k, kind in enumerate(kinds))
        return (*sizes, *(f"time of {kinds[k]} {k + 1}" for k in self.judged))


def judge_clocks(timed: TimedTable) -> Judged:
    """Whether each time is the right one."""
    return judge(timed.printed, _right_asked(timed), 1)


def judge_in_time(timed: TimedTable, order: int) -> Judged:
    """Whether it can have the order for the class of T, with the times as they are printed.

    InputError where it cannot be looked at so far.
    """
    if not timed.judged and timed.kinetic is not Kinetic.MASS:
        return judge_order(timed.table, order)
    right = judge_clocks(timed).verdict is not Verdict.REFUTED
    if right and timed.kinetic is not Kinetic.MASS:
        plain = timed.table.asked(order)
        found = judge(timed.printed, both(plain, _right_asked(timed)), order)
        if found.verdict is not Verdict.REFUTED:
            return found
    most = min(order, _MOST_ORDER)
    for n in range(1, most + 1):  # of a wrong clock it is mostly a low order that fails
        found = judge(timed.printed, _words_asked(timed, n), n)
        if found.verdict is Verdict.REFUTED:
            return found
    return found if most == order else replace(found, verdict=Verdict.UNDECIDED)


def _right_asked(timed: TimedTable) -> Asked:
    names = (f"time of {timed.kinds[k]} {k + 1} = {_before(timed, k)}" for k in timed.judged)

    def residues(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        count, sign = len(timed.kinds), 1 if bound else -1
        right, times = _right(timed, entries[:count], one), entries[count:]
        return [time + right[k] * sign for k, time in zip(timed.judged, times, strict=True)]

    equations = tuple(Named(name, 1) for name in names)
    return Asked(timed.entries, equations, residues, labels=timed.labels)


def _before(timed: TimedTable, k: int) -> str:
    other = "drifts" if timed.kinds[k] == "kick" else "kicks"
    return f"sum of the {other} before it"


def _right(timed: TimedTable, sizes: Sequence[E], one: E) -> list[E]:
    return sums_before(list(zip(timed.kinds, sizes, strict=True)), one * 0)


# -- words with time ------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Plain:
    """Numbers that need no reduction, in a ring's place."""

    one: Any

    @property
    def zero(self) -> Any:
        return self.one * 0

    def reduce(self, x: Any) -> Any:
        return x

    def multiply(self, x: Any, y: Any) -> Any:
        return x * y


def _words_asked(timed: TimedTable, order: int) -> Asked:
    equations = tuple(x for n in range(1, order + 1) for x in equations_of(timed.kinetic, n))
    residues = partial(_of_words, timed, equations)
    return Asked(timed.entries, equations, residues, labels=timed.labels)


def _of_words(
    timed: TimedTable,
    equations: Sequence[TimedEquation],
    entries: Sequence[Any],
    one: Any,
    bound: bool = False,
) -> list[Any]:
    count = len(timed.kinds)
    sizes, told = entries[:count], dict(zip(timed.judged, entries[count:], strict=True))
    times = [told.get(k, right) for k, right in enumerate(_right(timed, sizes, one))]
    letters = (LETTERS[kind] for kind in timed.kinds)
    words = StepWords(_Plain(one), list(zip(letters, sizes, times, strict=True)), bound)
    words.prepare({word for each in equations for word in each.needed})
    return [each.residue(words) for each in equations]
