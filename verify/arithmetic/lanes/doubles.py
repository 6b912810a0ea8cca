"""float64 kernels of many points in lockstep as LLVM IR: several vectors for each of its numbers.

Only the loop branches, and no point ends it before the others. Under an `if` a variable keeps its
value in the lanes where the condition is false.

A set is one vector of points. The operations on one set stand together, up to the next call for
all sets: so they have the registers for themselves, and the processor looks ahead to the next set
while it waits.
"""

import ast
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, NoReturn

from llvmlite import ir

from verify.arithmetic.lanes import libm_circle, vectors
from verify.arithmetic.lanes.functions import apply_to_doubles
from verify.arithmetic.lanes.libm_circle import LibmCircle
from verify.arithmetic.lanes.schedule import reorder
from verify.arithmetic.lanes.vectors import DOUBLES, LANES, WORDS
from verify.arithmetic.wide.limbs import I64, Value, constant
from verify.arithmetic.wide.one_orbit import BOOL

_B = ir.IRBuilder
_ALIGNMENT = 8  # bytes; memory from Python is aligned to no more


class DoublesInLanes:
    """A target (see `verify.arithmetic.wide.translator.Target`) for many points in float64.

    A number is a tuple of vectors, one for each of the `sets`; or one vector, if it is the same
    for all sets. The number of steps and its counter are scalar words. The last `carried`
    arguments differ from point to point. `function_names`: the functions that the source calls.
    """

    def __init__(self, sets: int, carried: int, function_names: Sequence[str]) -> None:
        self.module, self.sets, self.carried = ir.Module(), sets, carried
        circle_functions = [name for name in libm_circle.NAMES if name in function_names]
        self.circle = LibmCircle(self.module, sets, circle_functions)
        self._variables: dict[str, Any] = {"valid": ir.Constant(BOOL, 1)}
        self._loop_locals: set[str] = set()  # variables of loops that have ended
        self._where: Any = None  # the lanes for which an `if` holds

    # -- the function -------------------------------------------------------------------------

    def begin(self, arguments: Sequence[tuple[str, str]], products: int) -> None:
        pointer = I64.as_pointer()
        main = ir.Function(self.module, ir.FunctionType(ir.VoidType(), [pointer, pointer]), "main")
        self.allocations = ir.IRBuilder(main.append_basic_block("entry"))
        self._open(ir.IRBuilder(main.append_basic_block("body")))
        first_carried = len(arguments) - self.carried
        for index, (name, kind) in enumerate(arguments):
            sets = range(self.sets if index >= first_carried else 1)
            parts = [self._read(main.args[0], index, lane_set, kind) for lane_set in sets]
            self._variables[name] = tuple(parts) if index >= first_carried else parts[0]

    def _read(self, memory: Value, index: int, lane_set: int, kind: str) -> Value:
        address = self._address(self.b, memory, index, lane_set)
        if kind == "int":
            address = self.b.bitcast(address, I64.as_pointer())
        return self.b.load(address, align=_ALIGNMENT)

    def _address(self, b: ir.IRBuilder, memory: Value, index: int, lane_set: int) -> Value:
        """Return the address of a number's row for one set of lanes."""
        address = b.gep(memory, [constant((index * self.sets + lane_set) * LANES, 64)])
        return b.bitcast(address, DOUBLES.as_pointer())

    def end(self) -> None:
        self.allocations.branch(self.allocations.block.parent.blocks[1])

    def give(self, values: Callable[[], Sequence[Any]]) -> None:
        if self._where is not None:
            _refuse("points that end apart")
        results, b = [*values(), constant(1, 64)], self._close()
        for index, value in enumerate(results):
            for lane_set, x in enumerate(self._in_sets(value)):
                word = b.bitcast(vectors.same(b, x, WORDS), DOUBLES) if x.type == I64 else x
                b.store(
                    word, self._address(b, b.function.args[1], index, lane_set), align=_ALIGNMENT
                )
        b.ret_void()

    def when(self, condition: Any, body: Callable[[], None]) -> None:
        assert self._where is None  # noqa: S101 - the language nests no `if`
        self._where = condition
        body()
        self._where = None

    def loop(self, name: str, limit: Value, body: Callable[[], None], assigned: set[str]) -> None:
        outer_variables = dict(self._variables)
        loop_variables = [variable for variable in outer_variables if variable in assigned]
        if any(self.kind(outer_variables[variable]) == "int" for variable in loop_variables):
            _refuse("integers that a loop changes")
        places = {variable: self._room() for variable in loop_variables}
        self._keep(places)
        b, counter = self._close(), self.allocations.alloca(I64)
        b.store(constant(0, 64), counter)
        head, inside, done = (b.append_basic_block(n) for n in ("head", "loop", "done"))
        b.branch(head)
        b.position_at_end(head)
        index = b.load(counter)
        b.cbranch(b.icmp_signed("<", index, limit), inside, done)
        self._open(ir.IRBuilder(inside))
        self._variables = outer_variables | {name: index} | self._fetch(places)
        body()
        self._keep(places)
        b = self._close()
        b.store(b.add(index, constant(1, 64)), counter)
        b.branch(head)
        self._open(ir.IRBuilder(done))
        self._variables = outer_variables | self._fetch(places)
        # A variable that is first set in the loop has no value if the loop makes no pass; reading
        # it afterwards is refused.
        self._loop_locals |= {name, *assigned} - outer_variables.keys()
        self.circle.forget()

    def leave(self) -> None:
        _refuse("a loop that some points leave before others")

    def order(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        return reorder(statements)

    # -- sets of lanes ------------------------------------------------------------------------

    def _open(self, b: ir.IRBuilder) -> None:
        """Begin new blocks: `b` for operations that all sets share, and behind it one per set."""
        self.b = b
        self._of_sets = [ir.IRBuilder(b.append_basic_block("set")) for _ in range(self.sets)]

    def _close(self) -> ir.IRBuilder:
        """Chain the blocks of the sets; return the builder for the code behind them."""
        chain = [self.b, *self._of_sets]
        for builder, following in pairwise(chain):
            builder.branch(following.block)
        return chain[-1]

    def _each(self, operation: Callable[..., Value], *values: Any) -> Any:
        """Apply an operation, whose first argument is a builder, to each of the sets; once, if all
        values are the same for all sets."""
        if not any(isinstance(x, tuple) for x in values):
            return operation(self.b, *values)
        return tuple(map(operation, self._of_sets, *map(self._in_sets, values)))

    def _for_all(self, operation: Callable[[ir.IRBuilder], Any]) -> None:
        """Apply an operation of a builder once for all sets."""
        b = self._close()
        operation(b)
        self._open(b)

    def _in_sets(self, value: Any) -> Sequence[Value]:
        return value if isinstance(value, tuple) else (value,) * self.sets

    def _room(self) -> tuple[Value, ...]:
        """Allocate memory for a number: one address per set."""
        return tuple(self.allocations.alloca(DOUBLES) for _ in range(self.sets))

    def _keep(self, places: Mapping[str, tuple[Value, ...]]) -> None:
        for name, addresses in places.items():
            self._each(_B.store, self._variables[name], addresses)

    def _fetch(self, places: Mapping[str, tuple[Value, ...]]) -> dict[str, Any]:
        return {name: self._each(_B.load, addresses) for name, addresses in places.items()}

    # -- variables and numbers ----------------------------------------------------------------

    def has(self, name: str) -> bool:
        if name in self._loop_locals:
            _refuse("a variable of a loop after it")
        return name in self._variables

    def load(self, name: str) -> Any:
        return self._variables[name]

    def assign(self, name: str, value: Any) -> None:
        previous = self._variables.get(name)
        if previous is not None and self.kind(previous) == "float":
            value = self.convert(value, "float")
        if self._where is not None:
            if previous is None or self.kind(previous) == "int":
                _refuse("a variable that is set for some points, and was no number before")
            value = self._each(_B.select, self._where, value, previous)
        self._variables[name] = value
        self._loop_locals.discard(name)

    def integer(self, value: int) -> Value:
        return constant(value, 64)

    def constant(self, value: Any) -> Value:
        return vectors.splat_double(value)

    def kind(self, value: Any) -> str:
        return "int" if not isinstance(value, tuple) and value.type == I64 else "float"

    def convert(self, value: Any, kind: str) -> Any:
        if self.kind(value) == kind:
            return value
        return vectors.same(self.b, self.b.sitofp(value, ir.DoubleType()), DOUBLES)

    # -- operations ---------------------------------------------------------------------------

    def negative(self, x: Any) -> Any:
        return self._each(_B.neg if self.kind(x) == "int" else _B.fneg, x)

    def sum(self, sign: str, x: Any, y: Any) -> Any:
        integers = self.kind(x) == "int"
        if sign == "+":
            return self._each(_B.add if integers else _B.fadd, x, y)
        return self._each(_B.sub if integers else _B.fsub, x, y)

    def product(self, x: Any, y: Any) -> Any:
        if self.kind(x) == "int":
            _refuse("a product of integers")
        return self._each(_B.fmul, x, y)

    def quotient(self, x: Any, y: Any) -> Any:
        return self._each(_B.fdiv, x, y)

    def compare(self, order: str, x: Any, y: Any) -> Any:
        compare = _B.icmp_signed if self.kind(x) == "int" else _B.fcmp_ordered
        return self._each(lambda b, *vectors_: compare(b, order, *vectors_), x, y)

    def inside(self, x: Any, limit: Any) -> Any:
        _refuse("limits of a number format")

    def negation(self, condition: Any) -> Any:
        return self._each(_B.not_, condition)

    def conjunction(self, x: Any, y: Any) -> Any:
        return self._each(lambda b, *terms: b.and_(*(vectors.in_lanes(b, c) for c in terms)), x, y)

    def disjunction(self, x: Any, y: Any) -> Any:
        return self._each(lambda b, *terms: b.or_(*(vectors.in_lanes(b, c) for c in terms)), x, y)

    # -- functions ----------------------------------------------------------------------------

    def function(self, name: str, values: Sequence[Any]) -> list[Any]:
        x = values[0]
        if self.kind(x) == "int":
            _refuse("a function of an integer")
        if name == "abs":
            return [self._each(vectors.absolute, x)]
        if name in libm_circle.NAMES and libm_circle.is_available():
            return [self.circle.apply(name, x, self.allocations, self._each, self._for_all)]
        return [self._each(lambda b, vector: apply_to_doubles(b, name, vector), x)]


def _refuse(reason: str) -> NoReturn:
    raise NotImplementedError(reason)
