"""Tables of fractions, looked up lane by lane."""

from collections.abc import Sequence

from llvmlite import ir

from verify.arithmetic.lanes.vectors import DIGIT, WORDS
from verify.arithmetic.processor import LANES
from verify.arithmetic.wide.limbs import I64, Value, words


def rows_of(values: Sequence[int], count: int) -> ir.Constant:
    """Fractions of `count` limbs, one after the other; 1 is the fraction next to it."""
    largest = 2 ** (DIGIT * count) - 1
    return words(
        [(min(v, largest) >> DIGIT * i) % (1 << DIGIT) for v in values for i in range(count)]
    )


class Table:
    """Fractions of `count` limbs, one after the other, as `rows_of` writes them."""

    def __init__(self, module: ir.Module, name: str, rows: ir.Constant, count: int) -> None:
        self.count = count
        self.rows = ir.GlobalVariable(module, rows.type, name)
        self.rows.linkage, self.rows.global_constant = "internal", True
        self.rows.initializer = rows

    def entries(self, b: ir.IRBuilder, index: Value) -> list[Value]:
        """Those of the lanes' indices."""
        first = b.mul(index, ir.Constant(WORDS, [self.count] * LANES))
        found = [ir.Constant(WORDS, ir.Undefined)] * self.count
        for lane in range(LANES):
            at = b.extract_element(first, ir.Constant(I64, lane))
            for i in range(self.count):
                path = [ir.Constant(I64, 0), b.add(at, ir.Constant(I64, i))]
                limb = b.load(b.gep(self.rows, path, inbounds=True), typ=I64)
                found[i] = b.insert_element(found[i], limb, ir.Constant(I64, lane))
        return found
