"""A printed table of kicks and drifts, or of a composition, and its order.

The table may have clocks: the times, in parts of h, at which its parts read H(p, q, t). The right
time of a part is the sum of the parts of the other kind before it. If all times are right, the
conditions without time suffice, except for a quadratic T that depends on time
(`verify.schemes.conditions.splitting_conditions`). Otherwise the conditions on words with time
decide (`verify.schemes.conditions.words.equations`).
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

_MOST_ORDER_OF_WORDS = 6  # limit with clocks that are not right: beyond, there are too many words


@dataclass(frozen=True)
class PrintedTable:
    """A printed splitting.

    `kind`: see `verify.schemes.conditions.words.equations`. `parts`: ("kick" or "drift", size) in
    the order in which they are applied, or ("step", size) in a composition; sizes are formulas in
    the numbers of `printed`. `times`: a text for each part, None if it reads no time; empty without
    time. `kinetic_in_time`: True if T depends on time, so that the times of drifts count. Raises
    InputError for an unknown kind or part, and for no parts.
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
        """The sizes of the parts as expressions in the rounded numbers."""
        return tuple(self.printed.entry(size) for _, size in self.parts)

    @property
    def kinetic(self) -> Kinetic:
        """The class of T that the order is judged for."""
        if self.kind == "nystrom":
            return Kinetic.MASS if self.kinetic_in_time else Kinetic.QUADRATIC
        return Kinetic.GENERAL if self.kinetic_in_time else Kinetic.AUTONOMOUS

    @cached_property
    def judged_parts(self) -> tuple[int, ...]:
        """The indices of the parts whose times count."""
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
        """True if the parts are the same read backwards, for any values of the numbers."""
        names = [name for name, _ in self.parts]
        return names == names[::-1] and self.sizes == self.sizes[::-1]

    @property
    def most_order(self) -> int:
        """The highest order that is tested."""
        return MOST_ORDER_BY_KIND[self.kind]

    def with_entry(self, name: str, text: str) -> "PrintedTable":
        """Return the table with another text for a number, or else for a part, of that name.

        If there is none, the table is the same.
        """
        if name in self.printed.numbers:
            return self.read(self.printed.with_number(name, text))
        parts = ((kind, text if name == f"{kind} {k + 1}" else size) for k, (kind, size) in
                 enumerate(self.parts))  # fmt: skip
        return replace(self, parts=tuple(parts), printed=replace(self.printed, tentative=True))

    def read(self, numbers: PrintedNumbers) -> "PrintedTable":
        """Return the table with another reading of its numbers."""
        return replace(self, printed=numbers)

    def residuals(
        self,
        equations: Sequence[WordEquation],
        sizes: Sequence[E],
        one: E,
        bound: bool,
        times: Sequence[E] | None = None,
    ) -> list[E]:
        """Return the residuals of conditions on words, at these sizes and times."""
        kinds = (LETTERS.get(kind, STEPS) for kind, _ in self.parts)
        # A composition has its sizes in place of times (see `step_words`); words without time do
        # not read them.
        parts = zip(kinds, sizes, times or sizes, strict=True)
        return residuals_of(equations, StepWords(PlainNumbers(one), list(parts), bound))

    def sums_to_one(self, name: str) -> bool:
        """Return True if the sizes of all `name` parts add up to 1, whatever the numbers are."""
        sizes = (x for (kind, _), x in zip(self.parts, self.sizes, strict=True) if kind == name)
        return bool(sympy.expand(sum(sizes, sympy.S.Zero) - 1) == 0)

    def conditions(self, order: int) -> tuple[WordEquation, ...]:
        """Return the conditions of orders 1 … `order` that do not hold by the table's form."""
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
        """Return the conditions without time up to that order, and some beyond.

        Those beyond tell where the order ends.
        """
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


# -- order and clocks ------------------------------------------------------------------------------


def judge_clocks(table: PrintedTable) -> Judgement:
    """Judge whether every time is the right one."""
    return judge(table.printed, _clock_conditions(table), 1)


def judge_order(table: PrintedTable, order: int) -> Judgement:
    """Judge whether exact numbers near the printed ones have the order.

    If the table has times, the order is for the class of T and for these times. Raises InputError
    for an order that is out of range.
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
    for n in range(1, most + 1):  # with a wrong clock mostly a low order fails already
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
