"""Runge–Kutta tables as they are printed: one tableau, one for each part, or one of Nyström's kind.

Parts are those of a sum of vector fields, or p' and q' of a partitioned method.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy

from verify.arithmetic.number import E
from verify.errors import InputError
from verify.schemes.conditions.coloured_trees import Grammar
from verify.schemes.conditions.tree_weights import Block, Tableau, TreeWeights
from verify.schemes.printed.asked import Asked, of_pairs
from verify.schemes.printed.printed_numbers import PrintedNumbers

MOST_STAGES = 40
Texts = tuple[str, ...]
Entries = tuple[sympy.Expr, ...]
# Of blocks and the ring's one: the conditions' names, each with its left side and its right side.
Conditions = Callable[[Sequence[Block[Any]], Any], Iterator[tuple[str, Any, Any]]]


@dataclass(frozen=True)
class TableauTable:
    """`blocks`: one for each colour of the grammar. `names`: what stands after A, b and c of each.
    `nystrom`: the second block is of q' = p: see `verify.schemes.conditions.tree_weights`.
    `weighing`: what the weights are called.

    InputError where the blocks do not fit together.
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
        _ = self.entries

    @property
    def stages(self) -> int:
        """How many stages there are."""
        return len(self.blocks[0].weights)

    @property
    def timed(self) -> bool:
        """Whether every part has its stages' times."""
        return all(block.times is not None for block in self.blocks)

    @cached_property
    def exprs(self) -> tuple[Block[sympy.Expr], ...]:
        """The entries in the symbols of the rounded numbers; None where one is 0 by its form."""
        return tuple(block.mapped(self._expression) for block in self.blocks)

    def _expression(self, text: str, what: str) -> sympy.Expr | None:
        made = self.printed.entry(text, what)
        return None if made == 0 else made

    @cached_property
    def entries(self) -> Entries:
        """Those that are not 0, one after the other."""
        return tuple(x for block in self.exprs for x in block.entries if x is not None)

    @cached_property
    def labels(self) -> Texts:
        """What the entries are called."""
        pairs = zip(self._every_label(), self.exprs, strict=True)
        named = ((a, x) for told, own in pairs for a, x in zip(told, own.entries, strict=False))
        return tuple(label for label, x in named if x is not None)

    def _every_label(self) -> Iterator[list[str]]:
        """Those of each block, of entries that are 0, too, and of times that may not be there."""
        bars, stages = (
            ("", "_bar") if self.nystrom else ("",) * len(self.blocks),
            range(self.stages),
        )
        for name, bar in zip(self.names, bars, strict=True):
            told = [f"a{name}{_place(i)}{_place(j)}" for i in stages for j in stages]
            told += [f"{self.weighing}{bar}{name}{_place(i)}" for i in stages]
            yield [*told, *(f"c{name}{_place(i)}" for i in stages)]

    def mended(self, name: str, text: str) -> "TableauTable":
        """The same with this number, or else entry, written so; as it is where it has none."""
        if name in self.printed.numbers:
            return replace(self, printed=self.printed.with_number(name, text))
        pairs = zip(self._every_label(), self.blocks, strict=True)
        blocks = tuple(_put(x, told, name, text) for told, x in pairs)
        return replace(self, blocks=blocks, printed=replace(self.printed, tentative=True))

    def filled(self, entries: Sequence[E]) -> list[Block[E]]:
        """The blocks with these numbers for the entries."""
        numbers = iter(entries)
        return [x.mapped(lambda y, _: None if y is None else next(numbers)) for x in self.exprs]

    def weights(self, entries: Sequence[E], one: E) -> TreeWeights[E]:
        """What these entries put into trees."""
        return TreeWeights(self.filled(entries), one, self.nystrom)

    def asked(self, conditions: Conditions) -> Asked:
        """That the sides of each are equal."""

        def pairs(entries: Sequence[E], one: E, minus: int) -> Iterator[tuple[E, E]]:
            return ((x, y) for _, x, y in conditions(self.filled(entries), one))

        names = (name for name, *_ in conditions(self.exprs, sympy.S.One))
        return of_pairs(self.entries, names, pairs, self.labels)

    def read(self, numbers: PrintedNumbers) -> "TableauTable":
        """The same with its numbers read so."""
        return replace(self, printed=numbers)

    def with_weights(self, weights: Sequence[Texts]) -> "TableauTable":
        """The same with other weights in each block, as embedded ones."""
        pairs = zip(self.blocks, weights, strict=True)
        blocks = tuple(replace(block, weights=own) for block, own in pairs)
        return replace(self, blocks=blocks, weighing="embedded")


def _place(i: int) -> str:
    return str(i + 1) if i < 9 else f"_{i + 1}"


def _put(block: Tableau[str], labels: Sequence[str], name: str, text: str) -> Tableau[str]:
    """The block with that text for the entry of that name."""
    each = iter(labels)
    return block.mapped(lambda x, _: text if next(each) == name else x)


def _check(block: Tableau[str], count: int, name: str) -> None:
    what = f"b{name}"
    if not 1 <= len(block.weights) <= MOST_STAGES:
        raise InputError(what, len(block.weights), f"has 1 to {MOST_STAGES} weights")
    if len(block.weights) != count:
        raise InputError(
            what, len(block.weights), f"has other weights than the first part's {count}"
        )
    if len(block.matrix) != count or any(len(row) != count for row in block.matrix):
        raise InputError(f"a{name}", len(block.matrix), f"has {count} rows, as many as weights")
    if block.times is not None and len(block.times) != count:
        raise InputError(f"c{name}", len(block.times), f"has {count} times, as many as weights")


def square(rows: Sequence[Sequence[str]], stages: int, name: str = "a") -> tuple[Texts, ...]:
    """Rows of a full matrix, from full rows or from those of an explicit one, whose rows end before
    or at the diagonal. InputError where they are neither."""
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
