"""Tables of fractions, looked up lane by lane."""

from collections.abc import Sequence

from llvmlite import ir

from verify.arithmetic.lanes.vectors import DIGIT, LANES, WORDS
from verify.arithmetic.wide.limbs import I64, Value


class Table:
    """Fractions of `count` limbs, one after the other; 1 is the fraction next to it."""

    def __init__(self, module: ir.Module, name: str, values: Sequence[int], count: int) -> None:
        self.count, largest = count, 2 ** (DIGIT * count) - 1
        rows = [
            (min(value, largest) >> DIGIT * i) % (1 << DIGIT)
            for value in values
            for i in range(count)
        ]
        kind = ir.ArrayType(I64, len(rows))
        self.rows = ir.GlobalVariable(module, kind, name)
        self.rows.linkage, self.rows.global_constant = "internal", True
        self.rows.initializer = ir.Constant(kind, rows)

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
