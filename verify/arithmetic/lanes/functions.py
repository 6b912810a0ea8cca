"""Functions of numbers in lanes, with the bits of those of one orbit.

A function that is written in lanes says in which lanes its last bit is unsure. There, and for
functions that are not written in lanes, the function of one orbit is called, lane by lane.

1/x and √x are iterated from a guess in float64 by sums and rounded products of numbers, step by
step as in `verify.arithmetic.wide.newton`. Each of these operations has the same bits in lanes as
for one orbit; therefore the results have, too.
"""

from collections.abc import Callable

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.numbers import FunctionValues, Numbers
from verify.arithmetic.lanes.products import LaneNumber
from verify.arithmetic.lanes.transcendentals import Circle, Exponential
from verify.arithmetic.lanes.vectors import (
    CONDITIONS,
    DOUBLES,
    LANES,
    LIMB_BITS,
    WORDS,
    splat,
    splat_double,
)
from verify.arithmetic.wide import limbs
from verify.arithmetic.wide.limbs import I64, Value, constant, resize
from verify.arithmetic.wide.newton import (
    LEAST_DIVISOR_PLACES,
    LEAST_ROOT_PLACES,
    MoreFunctions,
    iterations,
)
from verify.arithmetic.wide.one_orbit import float_function
from verify.arithmetic.wide.size import words_of


class Newton:
    """1/x and √x for numbers of one format."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers, self.fraction = module, numbers, numbers.fraction

    def inverse(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Iterate y ← y + y (1 − x y)."""
        numbers, one = self.numbers, splat_double(1.0)
        size = numbers.from_settled(numbers.settle(b, numbers.absolute(b, x)), numbers.size)
        valid = self._at_least(b, size, LEAST_DIVISOR_PLACES)
        guess = b.fdiv(one, b.select(valid, numbers.to_double(b, x), one))
        y = numbers.from_double(b, guess)
        unit = numbers.constant(1 << self.fraction, numbers.size)
        for _ in range(iterations(self.fraction, quadratic=True)):
            error = numbers.sub(b, unit, numbers.product(b, x, y))
            y = numbers.add(b, y, numbers.product(b, y, error))
        return FunctionValues([y], valid)

    def sqrt(self, b: ir.IRBuilder, x: LaneNumber) -> FunctionValues:
        """Iterate s ← s + (x − s²)/(2 s₀)."""
        numbers = self.numbers
        valid = self._at_least(b, x, LEAST_ROOT_PLACES)
        radicand = b.select(valid, numbers.to_double(b, x), splat_double(1.0))
        guess = b.call(vectors.intrinsic(self.module, "sqrt"), [radicand])
        s = numbers.from_double(b, guess)
        slope = numbers.from_double(b, b.fdiv(splat_double(0.5), guess))
        for _ in range(iterations(self.fraction, quadratic=False)):
            rest = numbers.sub(b, x, numbers.product(b, s, s))
            s = numbers.add(b, s, numbers.product(b, rest, slope))
        return FunctionValues([s], valid)

    def _at_least(self, b: ir.IRBuilder, x: LaneNumber, places: int) -> Value:
        """Return the condition x ≥ 2^−places."""
        least = self.numbers.constant(1 << self.fraction - places, self.numbers.size)
        return b.not_(self.numbers.less(b, x, least))


class LaneFunctions:
    """A writer of the functions of one format into a module; each is written when it is first
    used."""

    def __init__(self, module: ir.Module, numbers: Numbers) -> None:
        self.module, self.numbers, self._words = module, numbers, words_of(numbers.size)
        self.of_one_orbit = MoreFunctions(module, numbers.fraction)
        self._loops: dict[str, ir.Function] = {}
        newton, circle = Newton(module, numbers), Circle(module, numbers)
        exponential = Exponential(module, numbers)
        self._in_lanes: dict[str, Callable[[ir.IRBuilder, LaneNumber], FunctionValues]] = {
            "inverse": newton.inverse,
            "sqrt": newton.sqrt,
        }
        if circle.spare < LIMB_BITS:
            self._in_lanes |= {
                "cos_sin": circle.cos_sin,
                "cos": lambda b, x: _part(circle.cos_sin(b, x), 0),
                "sin": lambda b, x: _part(circle.cos_sin(b, x), 1),
                **{name: getattr(exponential, name) for name in ("exp", "sinh", "cosh")},
            }

    def call(
        self, b: ir.IRBuilder, name: str, x: LaneNumber, allocations: ir.IRBuilder
    ) -> FunctionValues:
        """Return the function's values, with no lane unsure; `allocations` allocates memory."""
        if name not in self._in_lanes:
            everywhere = ir.Constant(CONDITIONS, [1] * LANES)
            return self._one_by_one(b, name, x, everywhere, allocations)
        near = self._in_lanes[name](b, x)
        if near.unsure is None:  # it has the bits of one orbit in all lanes
            return near
        places = [[allocations.alloca(WORDS) for _ in value.limbs] for value in near.values]
        for value, addresses in zip(near.values, places, strict=True):
            for limb, address in zip(self.numbers.settle(b, value), addresses, strict=True):
                b.store(limb, address)
        # The results of all lanes are stored before the branch: the rare block overwrites only the
        # lanes in which rounding is in doubt.
        cold, after = b.append_basic_block("unsure"), b.append_basic_block("sure")
        entry, everywhere = b.block, ir.Constant(CONDITIONS, [1] * LANES)
        b.cbranch(vectors.any_of(b, near.unsure), cold, after)
        b.position_at_end(cold)
        precise = self._one_by_one(b, name, x, near.unsure, allocations)
        has_value, end = b.or_(precise.valid, b.not_(near.unsure)), b.block
        for value, addresses in zip(precise.values, places, strict=True):
            for limb, address in zip(self.numbers.settle(b, value), addresses, strict=True):
                b.store(b.select(near.unsure, limb, b.load(address)), address)
        b.branch(after)
        b.position_at_end(after)
        valid = b.phi(CONDITIONS)
        valid.add_incoming(everywhere, entry)
        valid.add_incoming(has_value, end)
        numbers = [
            self.numbers.from_settled([b.load(p) for p in addresses], self.numbers.size)
            for addresses in places
        ]
        return FunctionValues(numbers, valid)

    # -- lane by lane -------------------------------------------------------------------------

    def _one_by_one(
        self, b: ir.IRBuilder, name: str, x: LaneNumber, chosen: Value, allocations: ir.IRBuilder
    ) -> FunctionValues:
        """Apply the function of one orbit in the lanes where `chosen` holds."""
        count = self._words
        function, results = self._loop_of(name)
        room = allocations.alloca(WORDS, size=count)
        results_at = allocations.alloca(WORDS, size=results * count + 1)
        for i, word in enumerate(self.numbers.words(b, x)):
            b.store(word, b.gep(room, [constant(i, 64)]))
        pointer, lane_bits = I64.as_pointer(), b.bitcast(chosen, ir.IntType(LANES))
        b.call(function, [b.bitcast(room, pointer), b.bitcast(results_at, pointer), lane_bits])
        words = [b.load(b.gep(results_at, [constant(i, 64)])) for i in range(results * count + 1)]
        values = [
            self.numbers.from_words(b, words[i * count : (i + 1) * count], self.numbers.size)
            for i in range(results)
        ]
        return FunctionValues(values, b.icmp_unsigned("!=", words[-1], splat(0)))

    def _loop_of(self, name: str) -> tuple[ir.Function, int]:
        """Return the function that loops over the lanes in memory, and the number of its values."""
        function_of_one = self.of_one_orbit.get(name)
        results = len(function_of_one.function_type.return_type.elements) - 1
        if name in self._loops:
            return self._loops[name], results
        pointer, lane_bits = I64.as_pointer(), ir.IntType(LANES)
        kind = ir.FunctionType(ir.VoidType(), [pointer, pointer, lane_bits])
        function = self._loops[name] = ir.Function(self.module, kind, f"lanes_{name}")
        function.linkage = "internal"
        function.attributes.add("noinline")
        names = ("entry", "lane", "selected", "next", "done")
        entry, head, selected, following, done = map(function.append_basic_block, names)
        b = ir.IRBuilder(entry)
        b.branch(head)
        b.position_at_end(head)
        lane = b.phi(I64)
        lane.add_incoming(constant(0, 64), entry)
        bit = b.lshr(function.args[2], b.trunc(lane, lane_bits))
        b.cbranch(b.trunc(bit, ir.IntType(1)), selected, following)
        b.position_at_end(selected)
        packed = b.call(function_of_one, [self._gather(b, b.gep(function.args[0], [lane]))])
        target, index = b.gep(function.args[1], [lane]), 0
        for i in range(results):
            index = self._scatter(b, target, index, b.extract_value(packed, i))
        self._scatter(b, target, index, resize(b, b.extract_value(packed, results), 64))
        b.branch(following)
        b.position_at_end(following)
        after = b.add(lane, constant(1, 64))
        lane.add_incoming(after, following)
        b.cbranch(b.icmp_unsigned("<", after, constant(LANES, 64)), head, done)
        b.position_at_end(done)
        b.ret_void()
        return function, results

    def _gather(self, b: ir.IRBuilder, pointer: Value) -> Value:
        places = (b.gep(pointer, [constant(LANES * i, 64)]) for i in range(self._words))
        return limbs.join(b, [b.load(address) for address in places])

    def _scatter(self, b: ir.IRBuilder, pointer: Value, index: int, value: Value) -> int:
        count: int = value.type.width // 64
        for i in range(count):
            b.store(limbs.limb(b, value, i), b.gep(pointer, [constant(LANES * (index + i), 64)]))
        return index + count


def apply_to_doubles(b: ir.IRBuilder, name: str, x: Value) -> Value:
    """Apply a function of float64 with the bits that it has for one orbit: lane by lane, except the
    square root, which the processor rounds correctly."""
    if name.removeprefix("f_") == "sqrt":
        return b.call(vectors.intrinsic(b.module, "sqrt"), [x])
    function, total = float_function(b.module, name), ir.Constant(DOUBLES, ir.Undefined)
    for lane, word in enumerate(vectors.lanes_of(b, x)):
        total = b.insert_element(total, b.call(function, [word]), constant(lane, 64))
    return total


def _part(results: FunctionValues, index: int) -> FunctionValues:
    return results._replace(values=[results.values[index]])
