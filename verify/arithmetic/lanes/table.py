"""Tables of fractions, of which each lane has a row."""

from collections.abc import Sequence

from llvmlite import ir

from verify.arithmetic.lanes.vectors import DIGIT, shuffle
from verify.arithmetic.processor import LANES
from verify.arithmetic.wide.limbs import I64, Value, constant, words

_GROUP = 4  # words that are read at once, and then turned to one vector each
_GROUPS = ir.VectorType(I64, _GROUP)


def rows_of(values: Sequence[int], count: int) -> ir.Constant:
    """Return fractions of `count` limbs, one after the other; 1 becomes the largest fraction
    below it."""
    largest = 2 ** (DIGIT * count) - 1
    limbs = [(min(v, largest) >> DIGIT * i) % (1 << DIGIT) for v in values for i in range(count)]
    return words([*limbs, *[0] * _GROUP])  # a group may reach beyond the last row


class Table:
    """Fractions of `count` limbs, one after the other, as `rows_of` writes them."""

    def __init__(self, module: ir.Module, name: str, rows: ir.Constant, count: int) -> None:
        self.count = count
        self.rows = ir.GlobalVariable(module, rows.type, name)
        self.rows.linkage, self.rows.global_constant = "internal", True
        self.rows.initializer = rows

    def entries(self, b: ir.IRBuilder, rows: Sequence[Value]) -> list[Value]:
        """Return the limbs of the lanes' rows."""
        first = [b.mul(row, constant(self.count, 64)) for row in rows]
        limbs: list[Value] = []
        for start in range(0, self.count, _GROUP):
            limbs += _transpose(b, [self._group(b, b.add(at, constant(start, 64))) for at in first])
        return limbs[: self.count]

    def _group(self, b: ir.IRBuilder, index: Value) -> Value:
        place = b.gep(self.rows, [constant(0, 64), index], inbounds=True)
        return b.load(b.bitcast(place, _GROUPS.as_pointer()), align=8)


def _transpose(b: ir.IRBuilder, groups: Sequence[Value]) -> list[Value]:
    """Return the first words of all lanes, then the second ones, and so on."""
    rows = groups
    if LANES > _GROUP:  # two groups side by side in each vector
        both = zip(groups[:_GROUP], groups[_GROUP:], strict=True)
        rows = [shuffle(b, x, y, range(LANES)) for x, y in both]
    halves = range(0, LANES, _GROUP)

    def pick(x: Value, y: Value, *places: int) -> Value:
        """Return from each half the words at those places, of the second vector where they are 4
        or more."""
        positions = [
            at + half + (LANES - _GROUP) * (at >= _GROUP) for half in halves for at in places
        ]
        return shuffle(b, x, y, positions)

    even, odd = (
        [pick(x, y, *places) for x, y in (rows[:2], rows[2:])]
        for places in ((0, 4, 2, 6), (1, 5, 3, 7))
    )
    low, high = (0, 1, 4, 5), (2, 3, 6, 7)
    return [pick(*pair, *places) for places in (low, high) for pair in (even, odd)]
