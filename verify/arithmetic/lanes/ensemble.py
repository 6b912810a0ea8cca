"""Orbits in lockstep as LLVM IR: a kernel's number has one value in each lane.

Only the loop branches. Under an `if` a variable keeps its value in the lanes where the condition is
false. A lane that returns within the loop retires (`verify.arithmetic.lanes.memory`): a lane that
fails does no harm to others.
"""

import ast
from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir

from verify.arithmetic.lanes import libm_circle, vectors
from verify.arithmetic.lanes.functions import LaneFunctions, apply_to_doubles
from verify.arithmetic.lanes.libm_circle import LibmCircle
from verify.arithmetic.lanes.memory import Memory, Retirement, Variables
from verify.arithmetic.lanes.multiply_add import MultiplyAdd
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.products import LaneNumber
from verify.arithmetic.lanes.schedule import reorder
from verify.arithmetic.lanes.vectors import CONDITIONS, DOUBLES, LANES, WORDS
from verify.arithmetic.wide.limbs import I64, Value, constant
from verify.arithmetic.wide.size import INTEGER_BITS, sizes_of


class Ensemble:
    """A target (see `verify.arithmetic.wide.translator.Target`) for one orbit in each lane.

    A wide number is a `LaneNumber`; a double or an integer is a vector, except the number of steps
    and its counter, which are scalars. A condition is a vector, or one bit for all lanes.
    """

    def __init__(self, fraction: int, multiply_add: type[MultiplyAdd]) -> None:
        self.module = ir.Module()
        self.widths = sizes_of(fraction)
        self.numbers = Numbers(fraction, multiply_add())
        self.functions = LaneFunctions(self.module, self.numbers)
        self.memory = Memory(self.numbers, self.widths)
        self.circle = LibmCircle(self.module, 1, libm_circle.NAMES)
        self._variables: dict[str, Any] = {}
        self._retirement: Retirement | None = None  # that of the lanes in the loop
        self._where: Value | None = None  # the lanes for which an `if` holds

    # -- the function -------------------------------------------------------------------------

    def begin(self, arguments: Sequence[tuple[str, str]], products: int) -> None:
        pointer = I64.as_pointer()
        main = ir.Function(self.module, ir.FunctionType(ir.VoidType(), [pointer, pointer]), "main")
        self.allocations = ir.IRBuilder(main.append_basic_block("entry"))
        self.b = ir.IRBuilder(main.append_basic_block("body"))
        self._variables["valid"] = ir.Constant(CONDITIONS, [1] * LANES)
        offset = 0
        for name, kind in arguments:
            self._variables[name] = self.memory.read(self.b, main.args[0], offset, kind)
            offset += self.memory.size(kind)
        steps = arguments[0][0] if arguments and arguments[0][1] == "int" else None
        if steps:  # the number of steps is the same in all lanes
            self._variables[steps] = self.b.extract_element(self._variables[steps], constant(0, 64))

    def end(self) -> None:
        self.allocations.branch(self.allocations.block.parent.blocks[1])
        if not self.b.block.is_terminated:
            self.b.ret_void()

    def give(self, values: Callable[[], Sequence[Any]]) -> None:
        if self._where is not None:
            assert self._retirement is not None  # noqa: S101 - an `if` returns in the loop alone
            self._retirement.retire(self.b, self._where, values()[0], self._finish)
            return
        b, results = self.b, values()
        if self._retirement:
            results = [b.load(self._retirement.done), *results[1:]]
        words = [word for value in results for word in self.memory.words(b, value)]
        words.append(b.zext(vectors.in_lanes(b, self.load("valid")), WORDS))
        self.memory.write(b, b.function.args[1], words)
        b.ret_void()

    def when(self, condition: Value, body: Callable[[], None]) -> None:
        assert self._where is None  # noqa: S101 - the language nests no `if`
        # Lanes cannot branch apart: the body is executed for all, and `assign` selects the new
        # value only where the condition holds.
        self._where = vectors.in_lanes(self.b, condition)
        body()
        self._where = None

    def loop(self, name: str, limit: Value, body: Callable[[], None], assigned: set[str]) -> None:
        b, outer_variables = self.b, dict(self._variables)
        changed_here = [n for n in outer_variables if n in assigned or n == "valid"]
        variables = Variables(self.numbers)
        for variable in changed_here:
            variables.add(b, self.allocations, variable, outer_variables[variable])
        variables.keep(b, outer_variables)
        self._retirement = Retirement(b, self.allocations, limit)
        counter = self.allocations.alloca(I64)
        b.store(constant(0, 64), counter)
        for value in (value for n, value in outer_variables.items() if n not in changed_here):
            if isinstance(value, LaneNumber):  # constant in the loop: it is prepared once
                self.numbers.prepare(b, value)
        head, inside, self._finish = (b.append_basic_block(n) for n in ("head", "loop", "done"))
        b.branch(head)
        b.position_at_end(head)
        index = b.load(counter)
        b.cbranch(b.icmp_signed("<", index, limit), inside, self._finish)
        b.position_at_end(inside)
        self._variables = outer_variables | {name: index} | variables.fetch(b, outer_variables)
        body()
        variables.keep(b, self._variables)
        b.store(b.add(index, constant(1, 64)), counter)
        b.branch(head)
        b.position_at_end(self._finish)
        self._variables = outer_variables | variables.fetch(b, outer_variables)
        self.circle.forget()

    def leave(self) -> None:
        raise NotImplementedError("a loop that some lanes leave before others")

    def order(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        return reorder(statements)

    # -- variables and numbers ----------------------------------------------------------------

    def has(self, name: str) -> bool:
        return name in self._variables

    def load(self, name: str) -> Any:
        return self._variables[name]

    def assign(self, name: str, value: Any) -> None:
        previous = self._variables.get(name)
        if previous is not None and name != "valid" and self.kind(value) != self.kind(previous):
            value = self.convert(value, self.kind(previous))
        if self._where is not None:
            value = self._select(self._where, value, previous)
        self._variables[name] = value

    def _select(self, condition: Value, x: Any, y: Any) -> Any:
        if isinstance(x, LaneNumber):
            return self.numbers.choose(self.b, condition, x, y)
        if x.type == I64 or y.type == I64:
            x, y = (self.memory.words(self.b, v)[0] for v in (x, y))
        return self.b.select(condition, x, y)

    def integer(self, value: int) -> Value:
        return constant(value, 64)

    def constant(self, value: Any) -> Any:
        if isinstance(value, float):
            return vectors.splat_double(value)
        return self.numbers.constant(value.raw, self.widths["wide"])

    def kind(self, value: Any) -> str:
        if isinstance(value, LaneNumber):
            return "wide" if value.width == self.widths["wide"] else "sum"
        return "float" if value.type == DOUBLES else "int"

    def convert(self, value: Any, kind: str) -> Any:
        if isinstance(value, LaneNumber) and kind == "sum":
            return self.numbers.extend(self.b, value, self.widths["sum"])
        if isinstance(value, LaneNumber) or value.type == DOUBLES:
            raise TypeError(f"{self.kind(value)} is no {kind}; use wide(x) or approx(x)")
        if not isinstance(value, ir.Constant):
            raise TypeError(f"{value} is no {kind}")
        if kind == "float":
            return vectors.splat_double(float(value.constant))
        return self.numbers.constant(value.constant << self.numbers.fraction, self.widths[kind])

    # -- operations ---------------------------------------------------------------------------

    def negative(self, x: Any) -> Any:
        if isinstance(x, LaneNumber):
            return self.numbers.neg(self.b, x)
        return self.b.fneg(x) if x.type == DOUBLES else self.b.neg(x)

    def sum(self, sign: str, x: Any, y: Any) -> Any:
        b = self.b
        if isinstance(x, LaneNumber):
            operation = self.numbers.add if sign == "+" else self.numbers.sub
            return operation(b, x, y)
        floating = x.type == DOUBLES
        if sign == "+":
            return b.fadd(x, y) if floating else b.add(x, y)
        return b.fsub(x, y) if floating else b.sub(x, y)

    def product(self, x: Any, y: Any) -> Any:
        if isinstance(x, LaneNumber):
            return self.numbers.product(self.b, x, y)
        return self.b.fmul(x, y)

    def quotient(self, x: Value, y: Value) -> Value:
        return self.b.fdiv(x, y)

    def negation(self, condition: Value) -> Value:
        return self.b.not_(condition)

    def conjunction(self, x: Value, y: Value) -> Value:
        return self.b.and_(*(vectors.in_lanes(self.b, condition) for condition in (x, y)))

    def disjunction(self, x: Value, y: Value) -> Value:
        return self.b.or_(*(vectors.in_lanes(self.b, condition) for condition in (x, y)))

    def compare(self, order: str, x: Any, y: Any) -> Value:
        b = self.b
        if not isinstance(x, LaneNumber):
            compare = b.fcmp_ordered if x.type == DOUBLES else b.icmp_signed
            return compare(order, x, y)
        numbers = self.numbers
        match order:
            case "<":
                return numbers.less(b, x, y)
            case ">":
                return numbers.less(b, y, x)
            case ">=":
                return b.not_(numbers.less(b, x, y))
            case "<=":
                return b.not_(numbers.less(b, y, x))
            case "==":
                return numbers.equal(b, x, y)
        return b.not_(numbers.equal(b, x, y))

    def inside(self, x: LaneNumber, limit: LaneNumber) -> Value:
        return self.numbers.inside(self.b, x, limit)

    # -- functions ----------------------------------------------------------------------------

    def function(self, name: str, values: Sequence[Any]) -> list[Any]:
        b, x = self.b, values[0]
        if name == "abs":
            if isinstance(x, LaneNumber):
                return [self.numbers.absolute(b, x)]
            return [vectors.absolute(b, x)]
        if name == "approx":
            return [self.numbers.to_double(b, x)]
        if name == "shifted":
            shift = values[1]  # a literal is one word for all lanes
            shift = vectors.same(b, shift, WORDS) if shift.type == I64 else shift
            return [self.numbers.shift_down(b, x, shift)]
        if name == "wide":
            return [self._wide(x)]
        if not isinstance(x, LaneNumber):
            plain = name.removeprefix("f_")
            if plain in libm_circle.NAMES and libm_circle.is_available():
                return [self.circle.apply(plain, x, self.allocations, self._here, self._here)]
            return [apply_to_doubles(b, name, x)]
        results = self.functions.call(b, name, x, self.allocations)
        self._require(results.valid)
        return list(results.values)

    def _here(self, operation: Callable[..., Any], *values: Any) -> Any:
        """Apply an operation whose first argument is a builder."""
        return operation(self.b, *values)

    def _wide(self, x: Value) -> LaneNumber:
        limit = vectors.splat_double(2.0 ** (INTEGER_BITS - 1))
        size = vectors.absolute(self.b, x)
        fits = self.b.fcmp_ordered("<", size, limit)
        self._require(fits)
        # LLVM does not define the conversion of a number that does not fit: 0 takes its place.
        x = self.b.select(fits, x, vectors.splat_double(0.0))
        return self.numbers.from_double(self.b, x)

    def _require(self, condition: Value) -> None:
        """Make `valid` false unless the condition holds."""
        self._variables["valid"] = self.b.and_(self.load("valid"), condition)
