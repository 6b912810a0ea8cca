"""Numbers of all lanes in memory, as LLVM IR: 64-bit words from the lowest, each once a lane."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.carries import Number
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.vectors import DOUBLES, WORDS
from verify.arithmetic.processor import LANES
from verify.arithmetic.wide.limbs import Value, constant
from verify.arithmetic.wide.size import words_of

_ALIGNED = 8  # bytes; numbers come from Python's memory


@dataclass(frozen=True)
class Memory:
    """`widths`: the bits of a number, by the kinds of wide numbers."""

    numbers: Numbers
    widths: Mapping[str, int]

    def size(self, kind: str) -> int:
        """Return the number of words of a number of that kind."""
        return words_of(self.widths[kind]) if kind in self.widths else 1

    def read(self, b: ir.IRBuilder, memory: Value, offset: int, kind: str) -> Any:
        """Return the number of that kind at a word offset."""
        places = (self._place(b, memory, offset + i) for i in range(self.size(kind)))
        words = [b.load(place, align=_ALIGNED) for place in places]
        if kind in self.widths:
            return self.numbers.from_words(b, words, self.widths[kind])
        return b.bitcast(words[0], DOUBLES) if kind == "float" else words[0]

    def write(self, b: ir.IRBuilder, memory: Value, words: Sequence[Value]) -> None:
        for index, word in enumerate(words):
            b.store(word, self._place(b, memory, index), align=_ALIGNED)

    def words(self, b: ir.IRBuilder, value: Any) -> list[Value]:
        """Return the words of a number; of one for all lanes, the same in each."""
        if isinstance(value, Number):
            return self.numbers.words(b, value)
        if value.type == DOUBLES:
            return [b.bitcast(value, WORDS)]
        return [value if value.type == WORDS else vectors.same(b, value, WORDS)]

    def _place(self, b: ir.IRBuilder, memory: Value, index: int) -> Value:
        """Return the address of a word."""
        place = b.gep(memory, [constant(index * LANES, 64)])
        return b.bitcast(place, WORDS.as_pointer())
