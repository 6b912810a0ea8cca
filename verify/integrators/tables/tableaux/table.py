"""Runge–Kutta tables as they are printed: one tableau, one for each part, or one of Nyström's kind.

Parts are those of a sum of vector fields, or p' and q' of a partitioned method.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import sympy

from verify.arithmetic.number import E
from verify.errors import InputError
from verify.schemes.coloured_trees import Grammar
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.schemes.tree_weights import Block, TreeWeights

MOST_STAGES = 40
Texts = tuple[str, ...]
Entries = tuple[sympy.Expr, ...]


@dataclass(frozen=True)
class PrintedBlock:
    """Of one part: rows of a_ij, weights b_i and, where they are printed, times c_i, as texts."""

    rows: tuple[Texts, ...]
    weights: Texts
    times: Texts | None = None


@dataclass(frozen=True)
class TableauTable:
    """`blocks`: one for each colour of the grammar. `names`: what stands after A, b and c of each.
    `nystrom`: the second block is of q' = p: see `verify.schemes.tree_weights`.
    `weighing`: what the weights are called.

    InputError where the blocks do not fit together.
    """

    blocks: tuple[PrintedBlock, ...]
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
        return tuple(self._block(block) for block in self.blocks)

    def _block(self, block: PrintedBlock) -> Block[sympy.Expr]:
        def made(texts: Sequence[str], what: str) -> tuple[sympy.Expr | None, ...]:
            found = (self.printed.entry(text, what) for text in texts)
            return tuple(None if x == 0 else x for x in found)

        times = None if block.times is None else made(block.times, "c")
        rows = tuple(made(row, "a") for row in block.rows)
        return Block(rows, made(block.weights, "b"), times)

    @cached_property
    def entries(self) -> Entries:
        """Those that are not 0, one after the other."""
        return tuple(x for block in self.exprs for x in _flat(block) if x is not None)

    @cached_property
    def labels(self) -> Texts:
        """What the entries are called."""
        pairs = zip(self._every_label(), self.exprs, strict=True)
        found: list[str] = []
        for told, block in pairs:
            own = zip(told, _flat(block), strict=False)
            found += [label for label, x in own if x is not None]
        return tuple(found)

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
        blocks = []
        for told, block in zip(self._every_label(), self.blocks, strict=True):
            flat = [*(x for row in block.rows for x in row), *block.weights, *(block.times or ())]
            made = [text if label == name else x for label, x in zip(told, flat, strict=False)]
            n = self.stages
            rows = tuple(tuple(made[n * i : n * i + n]) for i in range(n))
            times = None if block.times is None else tuple(made[n * n + n :])
            blocks.append(PrintedBlock(rows, tuple(made[n * n : n * n + n]), times))
        return replace(self, blocks=tuple(blocks))

    def filled(self, entries: Sequence[E]) -> list[Block[E]]:
        """The blocks with these numbers for the entries."""
        numbers = iter(entries)

        def filled(own: Sequence[sympy.Expr | None]) -> tuple[E | None, ...]:
            return tuple(None if x is None else next(numbers) for x in own)

        made = []
        for block in self.exprs:
            rows = tuple(map(filled, block.matrix))
            weights = filled(block.weights)
            made.append(Block(rows, weights, None if block.times is None else filled(block.times)))
        return made

    def weights(self, entries: Sequence[E], one: E) -> TreeWeights[E]:
        """What these entries put into trees."""
        return TreeWeights(self.filled(entries), one, self.nystrom)

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


def _flat(block: Block[sympy.Expr]) -> list[sympy.Expr | None]:
    rows = [x for row in block.matrix for x in row]
    return [*rows, *block.weights, *(block.times or ())]


def _check(block: PrintedBlock, count: int, name: str) -> None:
    what = f"b{name}"
    if not 1 <= len(block.weights) <= MOST_STAGES:
        raise InputError(what, len(block.weights), f"has 1 to {MOST_STAGES} weights")
    if len(block.weights) != count:
        raise InputError(
            what, len(block.weights), f"has other weights than the first part's {count}"
        )
    if len(block.rows) != count or any(len(row) != count for row in block.rows):
        raise InputError(f"a{name}", len(block.rows), f"has {count} rows, as many as weights")
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
