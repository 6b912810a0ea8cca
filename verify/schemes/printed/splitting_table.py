"""A printed table of splitting coefficients, and its order: of kicks and drifts, or a composition.

It may have clocks: the times, in parts of h, at which its parts read H(p, q, t). Where each time is
the right one, the sum of the other kind's parts before it, the conditions without time suffice,
except for a quadratic T that depends on time (`verify.schemes.conditions.splitting_conditions`). If
one is not, those of words with time decide (`verify.schemes.conditions.words.equations`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import sympy

from verify.arithmetic.number_system import E
from verify.errors import InputError
from verify.schemes.conditions.splitting_conditions import LETTERS, sums_before
from verify.schemes.conditions.words.equations import (
    LETTERS_BY_KIND,
    MOST_ORDER_BY_KIND,
    WordEquation,
    equations_of_weight,
    logarithm_equations,
    residuals_of,
)
from verify.schemes.conditions.words.step_words import PlainNumbers, StepWords
from verify.schemes.conditions.words.words import STEPS, Kinetic
from verify.schemes.printed.condition_set import (
    ConditionSet,
    NamedEquation,
    Residuals,
    prepend_conditions,
)
from verify.schemes.printed.judgement import Judgement, judge
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict

_MOST_ORDER_OF_WORDS = 6  # with clocks that are not right: of higher ones there are too many words


@dataclass(frozen=True)
class PrintedTable:
    """A printed splitting.

    `kind`: see `verify.schemes.conditions.words.equations`. `parts`: ("kick" or "drift", size) in
    the order in which they are made, or ("step", size) of a composition; sizes are formulas in the
    numbers of `printed`. `times`: a text for each part, None where it reads no time; none without
    time. `kinetic_in_time`: whether T depends on time, too, so that drifts are judged. InputError
    for a table that is none.
    """

    kind: str
    parts: tuple[tuple[str, str], ...]
    printed: PrintedNumbers
    times: tuple[str | None, ...] = ()
    kinetic_in_time: bool = False

    def __post_init__(self) -> None:
        if self.kind not in LETTERS_BY_KIND:
            raise InputError("kind", self.kind, f"allowed: {', '.join(LETTERS_BY_KIND)}")
        kinds = ("step",) if self.kind == "composition" else tuple(LETTERS)
        wrong = [name for name, _ in self.parts if name not in kinds]
        if wrong or not self.parts:
            raise InputError("parts", wrong, f"are {' or '.join(kinds)}, one at least")
        _ = self.sizes, self.printed.units

    @cached_property
    def sizes(self) -> tuple[sympy.Expr, ...]:
        """The sizes of the parts, in the symbols of the numbers that are rounded."""
        return tuple(self.printed.entry(size) for _, size in self.parts)

    @property
    def kinetic(self) -> Kinetic:
        """The class of T that is claimed."""
        if self.kind == "nystrom":
            return Kinetic.MASS if self.kinetic_in_time else Kinetic.QUADRATIC
        return Kinetic.GENERAL if self.kinetic_in_time else Kinetic.AUTONOMOUS

    @cached_property
    def judged_parts(self) -> tuple[int, ...]:
        """The parts whose times count."""
        return tuple(
            k
            for k, time in enumerate(self.times)
            if time is not None
            and LETTERS[self.parts[k][0]] in self.kinetic.timed_letters
            and self.sizes[k] != 0
        )

    @cached_property
    def entries(self) -> tuple[sympy.Expr, ...]:
        """The sizes, and the times of the judged parts."""
        clock_times = (self.printed.entry(self.times[k] or "0", "times") for k in self.judged_parts)
        return (*self.sizes, *clock_times)

    @property
    def entry_names(self) -> tuple[str, ...]:
        """The names of the entries."""
        names = [f"{kind} {k + 1}" for k, (kind, _) in enumerate(self.parts)]
        return (*names, *(f"time of {names[k]}" for k in self.judged_parts))

    @property
    def palindromic(self) -> bool:
        """True if it is the same read backwards, by its form."""
        names = [name for name, _ in self.parts]
        return names == names[::-1] and self.sizes == self.sizes[::-1]

    @property
    def most_order(self) -> int:
        """The highest order that is tested."""
        return MOST_ORDER_BY_KIND[self.kind]

    def with_entry(self, name: str, text: str) -> "PrintedTable":
        """Return the same with this number, or else part, written so; unchanged where it has
        none."""
        if name in self.printed.numbers:
            return self.read(self.printed.with_number(name, text))
        parts = ((kind, text if name == f"{kind} {k + 1}" else size) for k, (kind, size) in
                 enumerate(self.parts))  # fmt: skip
        return replace(self, parts=tuple(parts), printed=replace(self.printed, tentative=True))

    def read(self, numbers: PrintedNumbers) -> "PrintedTable":
        """Return the same with its numbers read so."""
        return replace(self, printed=numbers)

    def residuals(
        self,
        equations: Sequence[WordEquation],
        sizes: Sequence[E],
        one: E,
        bound: bool,
        times: Sequence[E] | None = None,
    ) -> list[E]:
        """Return the residuals of conditions on words, with these sizes; without `times` on words
        without time."""
        kinds = (LETTERS.get(kind, STEPS) for kind, _ in self.parts)
        # Of a composition the letters' second number is the size again: see `step_words`.
        parts = zip(kinds, sizes, times or sizes, strict=True)
        return residuals_of(equations, StepWords(PlainNumbers(one), list(parts), bound))

    def sums_to_one(self, name: str) -> bool:
        """Return True if the sizes of these parts have the sum 1, whatever the numbers are."""
        sizes = (x for (kind, _), x in zip(self.parts, self.sizes, strict=True) if kind == name)
        return bool(sympy.expand(sum(sizes, sympy.S.Zero) - 1) == 0)

    def conditions(self, order: int) -> tuple[WordEquation, ...]:
        """Return the conditions of orders 1 … `order` that do not hold by the form of the table
        alone."""
        sums = {"Σ kicks = 1": "kick", "Σ drifts = 1": "drift", "Σ w = 1": "step"}
        rational = all(size.is_Rational for size in self.sizes)
        return tuple(
            c
            for c in logarithm_equations(self.kind, order)
            if rational
            or not (
                (self.palindromic and c.order % 2 == 0)
                or (c.name in sums and self.sums_to_one(sums[c.name]))
            )
        )

    def condition_set(self, order: int) -> ConditionSet:
        """Return the conditions of that order without time, and some beyond, which tell where it
        ends."""
        highest = min(order + (1 if self.printed.units else 2), self.most_order)
        equations = self.conditions(highest)

        def select(indices: Sequence[int]) -> Residuals:
            selection = [equations[k] for k in indices]

            def residuals(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
                return self.residuals(selection, entries, one, bound)

            return residuals

        up_to_order = [c for c in equations if c.order <= order]
        return ConditionSet(
            self.sizes,
            equations,
            select(range(len(equations))),
            held_by_form=len(logarithm_equations(self.kind, order)) - len(up_to_order),
            entry_names=self.entry_names[: len(self.sizes)],
            select_residuals=select,
        )


# -- its order, and its clocks ---------------------------------------------------------------------


def judge_clocks(table: PrintedTable) -> Judgement:
    """Judge whether each time is the right one."""
    return judge(table.printed, _clock_conditions(table), 1)


def judge_order(table: PrintedTable, order: int) -> Judgement:
    """Judge whether it can have the order: with times, for the class of T, as they are printed.

    InputError where it cannot be looked at so far.
    """
    if not 1 <= order <= table.most_order:
        problem = f"of a {table.kind} is looked at up to {table.most_order}"
        raise InputError("order", order, problem)
    if not table.judged_parts and table.kinetic is not Kinetic.MASS:
        return judge(table.printed, table.condition_set(order), order)
    right = judge_clocks(table).verdict is not Verdict.REFUTED
    # With right clocks the conditions without time suffice: see `splitting_conditions`.
    if right and table.kinetic is not Kinetic.MASS:
        plain = table.condition_set(order)
        conditions_in_time = prepend_conditions(plain, _clock_conditions(table))
        judgement = judge(table.printed, conditions_in_time, order)
        if judgement.verdict is not Verdict.REFUTED:
            return judgement
    most = min(order, _MOST_ORDER_OF_WORDS)
    for n in range(1, most + 1):  # of a wrong clock it is mostly a low order that fails
        judgement = judge(table.printed, _word_conditions(table, n), n)
        if judgement.verdict is Verdict.REFUTED:
            return judgement
    return judgement if most == order else replace(judgement, verdict=Verdict.UNDECIDED)


def _clock_conditions(table: PrintedTable) -> ConditionSet:
    names = (
        f"time of {table.parts[k][0]} {k + 1} = {_right_time_text(table, k)}"
        for k in table.judged_parts
    )

    def residuals(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        count, sign = len(table.parts), 1 if bound else -1
        right, times = _right_times(table, entries[:count], one), entries[count:]
        return [time + right[k] * sign for k, time in zip(table.judged_parts, times, strict=True)]

    equations = tuple(NamedEquation(name, 1) for name in names)
    return ConditionSet(table.entries, equations, residuals, entry_names=table.entry_names)


def _right_time_text(table: PrintedTable, k: int) -> str:
    other = "drifts" if table.parts[k][0] == "kick" else "kicks"
    return f"sum of the {other} before it"


def _right_times(table: PrintedTable, sizes: Sequence[E], one: E) -> list[E]:
    kinds = (kind for kind, _ in table.parts)
    return sums_before(list(zip(kinds, sizes, strict=True)), one * 0)


def _word_conditions(table: PrintedTable, order: int) -> ConditionSet:
    equations = tuple(x for n in range(1, order + 1) for x in equations_of_weight(table.kinetic, n))

    def residuals(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        count = len(table.parts)
        sizes = entries[:count]
        printed = dict(zip(table.judged_parts, entries[count:], strict=True))
        times = [printed.get(k, x) for k, x in enumerate(_right_times(table, sizes, one))]
        return table.residuals(equations, sizes, one, bound, times)

    return ConditionSet(table.entries, equations, residuals, entry_names=table.entry_names)
