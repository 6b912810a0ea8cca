"""A printed table of splitting coefficients: of kicks and drifts, or of a composition.

It may have clocks: the times, in parts of h, at which its parts read H(p, q, t).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import sympy

from verify.arithmetic.number import E
from verify.errors import InputError
from verify.schemes.conditions.free_lie_words import KINDS, MOST_ORDER, conditions
from verify.schemes.conditions.splitting_conditions import LETTERS
from verify.schemes.conditions.words.equations import WordEquation, residues_of
from verify.schemes.conditions.words.kinetic import Kinetic
from verify.schemes.conditions.words.step_words import PlainNumbers, StepWords
from verify.schemes.conditions.words.words import STEPS
from verify.schemes.printed.condition_set import ConditionSet, Residues
from verify.schemes.printed.printed_numbers import PrintedNumbers


@dataclass(frozen=True)
class PrintedTable:
    """A printed splitting. `kind`: see `verify.schemes.conditions.free_lie_words`. `parts`: ("kick"
    or "drift", size) in the order in which they are made, or ("step", size) of a composition; sizes
    are formulas in `numbers`, which are decimals as printed, or exact formulas of numbers. `times`:
    a text for each part, None where it reads no time; none without time. `both`: whether T depends
    on time, too, so that drifts are judged. InputError for a table that is none."""

    kind: str
    parts: tuple[tuple[str, str], ...]
    printed: PrintedNumbers
    times: tuple[str | None, ...] = ()
    both: bool = False

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise InputError("kind", self.kind, f"allowed: {', '.join(KINDS)}")
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
            return Kinetic.MASS if self.both else Kinetic.QUADRATIC
        return Kinetic.GENERAL if self.both else Kinetic.AUTONOMOUS

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
    def labels(self) -> tuple[str, ...]:
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
        return MOST_ORDER[self.kind]

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

    def residues(
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
        return residues_of(equations, StepWords(PlainNumbers(one), list(parts), bound))

    def sums_to_one(self, name: str) -> bool:
        """Return True if the sizes of these parts have the sum 1, whatever the numbers are."""
        sizes = (x for (kind, _), x in zip(self.parts, self.sizes, strict=True) if kind == name)
        return bool(sympy.expand(sum(sizes, sympy.S.Zero) - 1) == 0)

    def conditions(self, order: int) -> tuple[WordEquation, ...]:
        """Return the conditions of orders 1 … `order` that do not hold by the form of the table
        alone."""
        by_form = {"Σ kicks = 1": "kick", "Σ drifts = 1": "drift", "Σ w = 1": "step"}
        rational = all(size.is_Rational for size in self.sizes)
        return tuple(
            c
            for c in conditions(self.kind, order)
            if rational
            or not (
                (self.palindromic and c.order % 2 == 0)
                or (c.name in by_form and self.sums_to_one(by_form[c.name]))
            )
        )

    def condition_set(self, order: int) -> ConditionSet:
        """Return the conditions of that order without time, and some beyond, which tell where it
        ends."""
        highest = min(order + (1 if self.printed.units else 2), self.most_order)
        equations = self.conditions(highest)

        def some(rows: Sequence[int]) -> Residues:
            chosen = [equations[k] for k in rows]

            def residues(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
                return self.residues(chosen, entries, one, bound)

            return residues

        up_to_order = [c for c in equations if c.order <= order]
        by_form = len(conditions(self.kind, order)) - len(up_to_order)
        labels, every = self.labels[: len(self.sizes)], some(range(len(equations)))
        return ConditionSet(self.sizes, equations, every, by_form, labels=labels, some=some)
