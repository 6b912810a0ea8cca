"""What goes from pass to pass of a loop, as LLVM IR: variables, and which lanes go on.

Both are in memory. Lanes that return within the loop retire: what they do further on is not looked
at, and the loop ends when all have; of what they give only the first value, the steps done, is
theirs.
"""

from collections.abc import Mapping
from typing import Any

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.carries import Number
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.vectors import CONDITIONS, WORDS
from verify.arithmetic.processor import LANES
from verify.arithmetic.wide.limbs import Value


class Variables:
    """The variables that a loop changes."""

    def __init__(self, numbers: Numbers) -> None:
        self.numbers = numbers
        self.places: dict[str, list[Value]] = {}

    def add(self, b: ir.IRBuilder, allocations: ir.IRBuilder, name: str, value: Any) -> None:
        """Allocate places for a variable, which has this value before the loop."""
        parts = self._parts(b, value)
        self.places[name] = [allocations.alloca(part.type) for part in parts]

    def keep(self, b: ir.IRBuilder, values: Mapping[str, Any]) -> None:
        """Write the values at the end of a pass."""
        for name, places in self.places.items():
            for part, place in zip(self._parts(b, values[name]), places, strict=True):
                b.store(part, place)

    def fetch(self, b: ir.IRBuilder, before: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values at the beginning of a pass; `before`: those before the loop."""
        values = {}
        for name, places in self.places.items():
            parts, value = [b.load(place) for place in places], before[name]
            number = isinstance(value, Number)
            values[name] = self.numbers.from_settled(parts, value.width) if number else parts[0]
        return values

    def _parts(self, b: ir.IRBuilder, value: Any) -> list[Value]:
        return self.numbers.settle(b, value) if isinstance(value, Number) else [value]


class Retirement:
    """The lanes that go on, and the steps done by those that have retired."""

    def __init__(self, b: ir.IRBuilder, allocations: ir.IRBuilder, limit: Value) -> None:
        self.done, self.going = allocations.alloca(WORDS), allocations.alloca(CONDITIONS)
        b.store(vectors.same(b, limit, WORDS), self.done)
        b.store(ir.Constant(CONDITIONS, [1] * LANES), self.going)

    def retire(self, b: ir.IRBuilder, where: Value, step: Value, finish: ir.Block) -> None:
        """Retire the lanes where the condition holds, which have done so many steps; go to
        `finish` when none is left."""
        leaving = b.and_(where, b.load(self.going))
        some = b.append_basic_block("leaving")
        after = b.append_basic_block("after")
        b.cbranch(vectors.any_of(b, leaving), some, after)
        b.position_at_end(some)
        # Only the lanes that leave in this pass record their step; those that left before keep
        # theirs.
        done = b.select(leaving, vectors.same(b, step, WORDS), b.load(self.done))
        b.store(done, self.done)
        rest = b.and_(b.load(self.going), b.not_(leaving))
        b.store(rest, self.going)
        b.cbranch(vectors.any_of(b, rest), after, finish)
        b.position_at_end(after)
