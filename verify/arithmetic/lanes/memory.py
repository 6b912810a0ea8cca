"""A kernel's numbers in memory, as LLVM IR: arguments, results, and the variables of a loop.

Arguments and results are 64-bit words, the lowest first; each word is a vector, one value per lane.
A loop keeps the variables that it changes in memory, and records which lanes go on. Lanes that
return within the loop retire: their later values are ignored, and the loop ends when all lanes have
retired. Of a retired lane's results only the first, the number of steps done, is valid.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.products import LaneNumber
from verify.arithmetic.lanes.vectors import CONDITIONS, DOUBLES, LANES, WORDS
from verify.arithmetic.wide.limbs import Value, constant
from verify.arithmetic.wide.size import words_of

_ALIGNMENT = 8  # bytes; memory from Python is aligned to no more


@dataclass(frozen=True)
class Memory:
    """A reader and writer of arguments and results.

    `widths`: the bits of a number by its kind, `wide` or `sum`; other kinds take one word.
    """

    numbers: Numbers
    widths: Mapping[str, int]

    def size(self, kind: str) -> int:
        """Return the number of words of a number of that kind."""
        return words_of(self.widths[kind]) if kind in self.widths else 1

    def read(self, b: ir.IRBuilder, memory: Value, offset: int, kind: str) -> Any:
        """Return the number of that kind at a word offset."""
        places = (self._address(b, memory, offset + i) for i in range(self.size(kind)))
        words = [b.load(address, align=_ALIGNMENT) for address in places]
        if kind in self.widths:
            return self.numbers.from_words(b, words, self.widths[kind])
        return b.bitcast(words[0], DOUBLES) if kind == "float" else words[0]

    def write(self, b: ir.IRBuilder, memory: Value, words: Sequence[Value]) -> None:
        for index, word in enumerate(words):
            b.store(word, self._address(b, memory, index), align=_ALIGNMENT)

    def words(self, b: ir.IRBuilder, value: Any) -> list[Value]:
        """Return the words of a number; a scalar is repeated in each lane."""
        if isinstance(value, LaneNumber):
            return self.numbers.words(b, value)
        if value.type == DOUBLES:
            return [b.bitcast(value, WORDS)]
        return [value if value.type == WORDS else vectors.same(b, value, WORDS)]

    def _address(self, b: ir.IRBuilder, memory: Value, index: int) -> Value:
        """Return the address of a word."""
        address = b.gep(memory, [constant(index * LANES, 64)])
        return b.bitcast(address, WORDS.as_pointer())


class Variables:
    """The variables that a loop changes."""

    def __init__(self, numbers: Numbers) -> None:
        self.numbers = numbers
        self.places: dict[str, list[Value]] = {}

    def add(self, b: ir.IRBuilder, allocations: ir.IRBuilder, name: str, value: Any) -> None:
        """Allocate memory for a variable, which has this value before the loop."""
        parts = self._parts(b, value)
        self.places[name] = [allocations.alloca(part.type) for part in parts]

    def keep(self, b: ir.IRBuilder, values: Mapping[str, Any]) -> None:
        """Write the values at the end of a pass."""
        for name, places in self.places.items():
            for part, address in zip(self._parts(b, values[name]), places, strict=True):
                b.store(part, address)

    def fetch(self, b: ir.IRBuilder, before: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values at the beginning of a pass; `before`: those before the loop."""
        values = {}
        for name, places in self.places.items():
            parts, value = [b.load(address) for address in places], before[name]
            number = isinstance(value, LaneNumber)
            values[name] = self.numbers.from_settled(parts, value.width) if number else parts[0]
        return values

    def _parts(self, b: ir.IRBuilder, value: Any) -> list[Value]:
        return self.numbers.settle(b, value) if isinstance(value, LaneNumber) else [value]


class Retirement:
    """The lanes that go on, and the steps done by those that have retired."""

    def __init__(self, b: ir.IRBuilder, allocations: ir.IRBuilder, limit: Value) -> None:
        self.done, self.going = allocations.alloca(WORDS), allocations.alloca(CONDITIONS)
        b.store(vectors.same(b, limit, WORDS), self.done)
        b.store(ir.Constant(CONDITIONS, [1] * LANES), self.going)

    def retire(self, b: ir.IRBuilder, condition: Value, step: Value, finish: ir.Block) -> None:
        """Retire the lanes where the condition holds, which have done `step` steps; jump to
        `finish` when no lane is left."""
        leaving = b.and_(condition, b.load(self.going))
        exit_block = b.append_basic_block("leaving")
        after = b.append_basic_block("after")
        b.cbranch(vectors.any_of(b, leaving), exit_block, after)
        b.position_at_end(exit_block)
        # Only the lanes that leave in this pass record their step; those that left before keep
        # theirs.
        done = b.select(leaving, vectors.same(b, step, WORDS), b.load(self.done))
        b.store(done, self.done)
        going = b.and_(b.load(self.going), b.not_(leaving))
        b.store(going, self.going)
        b.cbranch(vectors.any_of(b, going), after, finish)
        b.position_at_end(after)
