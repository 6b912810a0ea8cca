"""Runge–Kutta tables as they are printed: one tableau, one for each part, or one of Nyström's kind.

Parts are those of a sum of vector fields, or p' and q' of a partitioned method.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy

from verify.arithmetic.number_system import E
from verify.errors import InputError
from verify.schemes.conditions.coloured_trees import Grammar
from verify.schemes.conditions.tree_weights import Block, Tableau, TreeWeights
from verify.schemes.printed.condition_set import ConditionSet, conditions_of_pairs
from verify.schemes.printed.printed_numbers import PrintedNumbers

MOST_STAGES = 40
Texts = tuple[str, ...]
Entries = tuple[sympy.Expr, ...]
# A function of the blocks and the ring's one that yields conditions: the name, the left side and
# the right side of each.
Conditions = Callable[[Sequence[Block[Any]], Any], Iterator[tuple[str, Any, Any]]]


@dataclass(frozen=True)
class TableauTable:
    """A Runge–Kutta table of one or several tableaux.

    `blocks`: a tableau for each colour of the grammar. `names`: the ends of the names A, b and c of
    each. `nystrom`: True if the second block is that of q' = p, see
    `verify.schemes.conditions.tree_weights`. `weighing`: the letter of the weights. Raises
    InputError if the blocks do not fit together.
    """

    blocks: tuple[Tableau[str], ...]
    grammar: Grammar
    printed: PrintedNumbers
    names: tuple[str, ...] = ("",)
    nystrom: bool = False
    weighing: str = "b"

    def __post_init__(self) -> None:
        count = self.stages
        for block, name in zip(self.blocks, self.names, strict=True):
            _check(block, count, name)
        # The entries are parsed at once, so that one that cannot be read is an error of the table
        # and not of a later judgement.
        _ = self.entries

    @property
    def stages(self) -> int:
        """The number of stages."""
        return len(self.blocks[0].weights)

    @property
    def has_times(self) -> bool:
        """True if every part has its stages' times."""
        return all(block.times is not None for block in self.blocks)

    @cached_property
    def exprs(self) -> tuple[Block[sympy.Expr], ...]:
        """The entries in the symbols of the rounded numbers; None for one that is 0 by its form."""
        return tuple(block.map_entries(self._expression) for block in self.blocks)

    def _expression(self, text: str, label: str) -> sympy.Expr | None:
        expression = self.printed.entry(text, label)
        return None if expression == 0 else expression

    @cached_property
    def entries(self) -> Entries:
        """The entries that are not 0, one after the other."""
        return tuple(x for block in self.exprs for x in block.entries if x is not None)

    @cached_property
    def labels(self) -> Texts:
        """The names of the entries."""
        pairs = zip(self._every_label(), self.exprs, strict=True)
        named = (
            (a, x)
            for labels_of_block, block in pairs
            for a, x in zip(labels_of_block, block.entries, strict=False)
        )
        return tuple(label for label, x in named if x is not None)

    def _every_label(self) -> Iterator[list[str]]:
        """Yield the labels of each block, also of entries that are 0, and of times that may be
        missing."""
        bars, stages = (
            ("", "_bar") if self.nystrom else ("",) * len(self.blocks),
            range(self.stages),
        )
        for name, bar in zip(self.names, bars, strict=True):
            labels = [f"a{name}{_place(i)}{_place(j)}" for i in stages for j in stages]
            labels += [f"{self.weighing}{bar}{name}{_place(i)}" for i in stages]
            yield [*labels, *(f"c{name}{_place(i)}" for i in stages)]

    def with_text(self, name: str, text: str) -> "TableauTable":
        """Return the table with this number, or else entry, written so; unchanged where it has none
        of that name."""
        if name in self.printed.numbers:
            return replace(self, printed=self.printed.with_number(name, text))
        pairs = zip(self._every_label(), self.blocks, strict=True)
        blocks = tuple(_put_text(x, labels, name, text) for labels, x in pairs)
        return replace(self, blocks=blocks, printed=replace(self.printed, tentative=True))

    def fill_blocks(self, entries: Sequence[E]) -> list[Block[E]]:
        """Return the blocks with these numbers for the entries."""
        numbers = iter(entries)
        return [
            x.map_entries(lambda y, _: None if y is None else next(numbers)) for x in self.exprs
        ]

    def weights(self, entries: Sequence[E], one: E) -> TreeWeights[E]:
        """Return the weights of trees with these entries."""
        return TreeWeights(self.fill_blocks(entries), one, self.nystrom)

    def build_conditions(self, conditions: Conditions) -> ConditionSet:
        """Build the conditions that the two sides of each are equal."""

        def pairs(entries: Sequence[E], one: E, minus: int) -> Iterator[tuple[E, E]]:
            return ((x, y) for _, x, y in conditions(self.fill_blocks(entries), one))

        names = (name for name, *_ in conditions(self.exprs, sympy.S.One))
        return conditions_of_pairs(self.entries, names, pairs, self.labels)

    def read(self, numbers: PrintedNumbers) -> "TableauTable":
        """Return the table with its numbers read so."""
        return replace(self, printed=numbers)

    def with_weights(self, weights: Sequence[Texts]) -> "TableauTable":
        """Return the table with other weights in each block, as embedded ones."""
        pairs = zip(self.blocks, weights, strict=True)
        blocks = tuple(replace(block, weights=texts) for block, texts in pairs)
        return replace(self, blocks=blocks, weighing="embedded")


def _place(i: int) -> str:
    return str(i + 1) if i < 9 else f"_{i + 1}"


def _put_text(block: Tableau[str], labels: Sequence[str], name: str, text: str) -> Tableau[str]:
    """Return the block with that text for the entry of that name."""
    remaining_labels = iter(labels)
    return block.map_entries(lambda x, _: text if next(remaining_labels) == name else x)


def _check(block: Tableau[str], count: int, name: str) -> None:
    key = f"b{name}"
    if not 1 <= len(block.weights) <= MOST_STAGES:
        raise InputError(key, len(block.weights), f"has 1 to {MOST_STAGES} weights")
    if len(block.weights) != count:
        raise InputError(
            key, len(block.weights), f"has other weights than the first part's {count}"
        )
    if len(block.matrix) != count or any(len(row) != count for row in block.matrix):
        raise InputError(f"a{name}", len(block.matrix), f"has {count} rows, as many as weights")
    if block.times is not None and len(block.times) != count:
        raise InputError(f"c{name}", len(block.times), f"has {count} times, as many as weights")


def square(rows: Sequence[Sequence[str]], stages: int, name: str = "a") -> tuple[Texts, ...]:
    """Return the rows of a full matrix, from full rows or from those of an explicit one, whose rows
    end before or at the diagonal. Raises InputError where they are neither."""
    if len(rows) == stages - 1 and all(len(row) == k + 1 for k, row in enumerate(rows)):
        rows = [[], *rows]  # the first stage's row, which is empty, is not printed
    if len(rows) != stages:
        raise InputError(name, len(rows), f"has {stages} rows, as many as weights")
    lengths = [len(row) for row in rows]
    full = all(n == stages for n in lengths)
    short = all(n in (k, k + 1) for k, n in enumerate(lengths))
    if not full and not short:
        k = next(k for k, n in enumerate(lengths) if n not in (k, k + 1))
        problem = f"row {k + 1} has {lengths[k]} entries; allowed: {k}, {k + 1} or {stages} in each"
        raise InputError(name, " ".join(rows[k]) or "no entry", problem)
    return tuple((*row, *["0"] * (stages - len(row))) for row in rows)
