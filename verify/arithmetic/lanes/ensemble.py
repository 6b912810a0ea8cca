"""Orbits in lockstep as LLVM IR: each of a kernel's numbers is one in each lane.

Nothing branches but the loop. Under an `if` a variable keeps its value in the lanes where the
condition is false. Lanes that return within the loop retire: what they do further on is not looked
at, and the loop ends when all have; of what they give only the first value, the steps done, is
theirs. So a lane that fails hurts no other.
"""

import ast
from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir

from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.carries import Number
from verify.arithmetic.lanes.functions import LaneFunctions
from verify.arithmetic.lanes.multiply_add import MultiplyAdd
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.schedule import reordered
from verify.arithmetic.lanes.vectors import CONDITIONS, DOUBLES, WORDS
from verify.arithmetic.processor import LANES
from verify.arithmetic.wide.limbs import I64, Value, constant
from verify.arithmetic.wide.size import INTEGER_BITS, sizes_of, words_of

BOOL = ir.IntType(1)
_ALIGNED = 8  # bytes; numbers come from Python's memory


class Ensemble:
    """See `verify.arithmetic.wide.translate.Target`.

    A wide number is a `Number`; a double or an integer is a vector, but for the steps and their
    counter, which are one for all lanes; a condition is a vector too, or one for all.

    `sets`: so many sets of lanes take turns in each pass of the loop, so that what one waits for
    another has time for. What a loop does not change is then the same for all of them.
    """

    def __init__(self, fraction: int, multiply_add: type[MultiplyAdd], *, sets: int = 1) -> None:
        self.module, self.sets = ir.Module(), sets
        self.widths = sizes_of(fraction)
        self.numbers = Numbers(fraction, multiply_add())
        self.functions = LaneFunctions(self.module, self.numbers)
        self._known: dict[str, Any] = {}
        self._arguments: dict[str, tuple[int, int, str]] = {}  # where each lies, and its kind
        self._of_sets: list[dict[str, Any]] = []  # after the loop, the variables of each set
        self._kept: dict[str, list[Value]] = {}  # what goes from pass to pass, in memory
        self._where: Value | None = None  # the lanes for which an `if` holds

    # -- the function -------------------------------------------------------------------------

    def begin(self, arguments: Sequence[tuple[str, str]], products: int) -> None:
        pointer = I64.as_pointer()
        main = ir.Function(self.module, ir.FunctionType(ir.VoidType(), [pointer, pointer]), "main")
        self.allocations = ir.IRBuilder(main.append_basic_block("entry"))
        self.b = ir.IRBuilder(main.append_basic_block("body"))
        self._known["valid"] = ir.Constant(CONDITIONS, [1] * LANES)
        at = 0
        for name, kind in arguments:
            size = words_of(self.widths[kind]) if kind in self.widths else 1
            self._arguments[name] = at, size, kind
            self._known[name] = self._argument(name, 0)
            at += size
        first = arguments[0][0] if arguments and arguments[0][1] == "int" else None
        if first:  # the steps, one number for all
            self._known[first] = self.b.extract_element(self._known[first], constant(0, 64))

    def _argument(self, name: str, own: int) -> Any:
        """An argument of one set of lanes."""
        at, size, kind = self._arguments[name]
        given = self.b.function.args[0]
        words = [self.b.load(self._place(given, at + i, own), align=_ALIGNED) for i in range(size)]
        return self._of_words(words, kind)

    def _of_words(self, words: list[Value], kind: str) -> Any:
        if kind in self.widths:
            return self.numbers.from_words(self.b, words, self.widths[kind])
        return self.b.bitcast(words[0], DOUBLES) if kind == "float" else words[0]

    def _place(self, pointer: Value, at: int, own: int = 0) -> Value:
        """Where a word of one set of lanes lies."""
        place = self.b.gep(pointer, [constant((at * self.sets + own) * LANES, 64)])
        return self.b.bitcast(place, WORDS.as_pointer())

    def end(self) -> None:
        self.allocations.branch(self.allocations.block.parent.blocks[1])
        if not self.b.block.is_terminated:
            self.b.ret_void()

    def give(self, values: Callable[[], Sequence[Any]]) -> None:
        if self._where is not None:
            self._retire(values()[0])
            return
        for own, known in enumerate(self._of_sets or [self._known]):
            self._known = known
            self._write(values(), own)
        self.b.ret_void()

    def _write(self, values: Sequence[Any], own: int) -> None:
        """The results of one set of lanes."""
        if "done" in self._kept:
            values = [self.b.load(self._kept["done"][0]), *values[1:]]
        words = [word for value in values for word in self._words(value)]
        words.append(self.b.zext(self._lanes(self.load("valid")), WORDS))
        for at, word in enumerate(words):
            self.b.store(word, self._place(self.b.function.args[1], at, own), align=_ALIGNED)

    def _words(self, value: Any) -> list[Value]:
        if isinstance(value, Number):
            return self.numbers.words(self.b, value)
        if value.type == DOUBLES:
            return [self.b.bitcast(value, WORDS)]
        return [value if value.type == WORDS else vectors.same(self.b, value, WORDS)]

    def _retire(self, step: Value) -> None:
        """The lanes where an `if` holds have done so many steps, and do no more."""
        b = self.b
        going, done = self._kept["going"][0], self._kept["done"][0]
        leaving = b.and_(self._where, b.load(going))
        some = b.append_basic_block("leaving")
        after = b.append_basic_block("after")
        b.cbranch(vectors.any_of(b, leaving), some, after)
        b.position_at_end(some)
        b.store(b.select(leaving, vectors.same(b, step, WORDS), b.load(done)), done)
        rest = b.and_(b.load(going), b.not_(leaving))
        b.store(rest, going)
        b.cbranch(vectors.any_of(b, rest), after, self._finish)
        b.position_at_end(after)

    def when(self, condition: Value, body: Callable[[], None]) -> None:
        assert self._where is None  # noqa: S101 - the language nests no `if`
        self._where = self._lanes(condition)
        body()
        self._where = None

    def loop(self, name: str, limit: Value, body: Callable[[], None], changed: set[str]) -> None:
        b = self.b
        carried = [n for n in self._known if n in changed or n == "valid"]
        before = dict(self._known)
        for own in range(self.sets):
            for n in carried:
                first = own and n in self._arguments
                self._known[n] = self._argument(n, own) if first else before[n]
                parts = self._parts(self._known[n])
                self._kept[f"{n} {own}"] = [self.allocations.alloca(p.type) for p in parts]
            self._keep(carried, own)
        self._kept["done"] = [self.allocations.alloca(WORDS)]
        self._kept["going"] = [self.allocations.alloca(CONDITIONS)]
        b.store(vectors.same(b, limit, WORDS), self._kept["done"][0])
        b.store(ir.Constant(CONDITIONS, [1] * LANES), self._kept["going"][0])
        counter = self.allocations.alloca(I64)
        b.store(constant(0, 64), counter)
        for value in (value for n, value in before.items() if n not in carried):
            if isinstance(value, Number):  # it stays as it is: its factors are made once
                self.numbers.prepare(b, value)
        head, inside, self._finish = (b.append_basic_block(n) for n in ("head", "loop", "done"))
        b.branch(head)
        b.position_at_end(head)
        at = b.load(counter)
        b.cbranch(b.icmp_signed("<", at, limit), inside, self._finish)
        b.position_at_end(inside)
        for own in range(self.sets):
            self._known = before | {name: at}
            self._fetch(carried, own)
            body()
            self._keep(carried, own)
        b.store(b.add(at, constant(1, 64)), counter)
        b.branch(head)
        b.position_at_end(self._finish)
        for own in range(self.sets):
            self._known = dict(before)
            self._fetch(carried, own)
            self._of_sets.append(self._known)

    def leave(self) -> None:
        raise NotImplementedError("a loop that some lanes leave before others")

    def ordered(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        return reordered(statements)

    def _parts(self, value: Any) -> list[Value]:
        return self.numbers.settle(self.b, value) if isinstance(value, Number) else [value]

    def _keep(self, names: Sequence[str], own: int) -> None:
        for name in names:
            places = self._kept[f"{name} {own}"]
            for part, place in zip(self._parts(self._known[name]), places, strict=True):
                self.b.store(part, place)

    def _fetch(self, names: Sequence[str], own: int) -> None:
        for name in names:
            parts = [self.b.load(place) for place in self._kept[f"{name} {own}"]]
            value = self._known[name]
            number = isinstance(value, Number)
            self._known[name] = self.numbers.known(parts, value.width) if number else parts[0]

    # -- variables and numbers ----------------------------------------------------------------

    def has(self, name: str) -> bool:
        return name in self._known

    def load(self, name: str) -> Any:
        return self._known[name]

    def assign(self, name: str, value: Any) -> None:
        before = self._known.get(name)
        if before is not None and name != "valid" and self.kind(value) != self.kind(before):
            value = self.converted(value, self.kind(before))
        if self._where is not None:
            value = self._chosen(self._where, value, before)
        self._known[name] = value

    def _chosen(self, where: Value, value: Any, other: Any) -> Any:
        if isinstance(value, Number):
            return self.numbers.choose(self.b, where, value, other)
        if value.type == I64 or other.type == I64:
            value, other = (self._words(v)[0] for v in (value, other))
        return self.b.select(where, value, other)

    def integer(self, value: int) -> Value:
        return constant(value, 64)

    def constant(self, value: Any) -> Any:
        if isinstance(value, float):
            return vectors.splat_double(value)
        return self.numbers.constant(value.raw, self.widths["wide"])

    def kind(self, value: Any) -> str:
        if isinstance(value, Number):
            return "wide" if value.width == self.widths["wide"] else "sum"
        return "float" if value.type == DOUBLES else "int"

    def converted(self, value: Any, kind: str) -> Any:
        if isinstance(value, Number) and kind == "sum":
            return self.numbers.extended(self.b, value, self.widths["sum"])
        if isinstance(value, Number) or value.type == DOUBLES:
            raise TypeError(f"{self.kind(value)} is no {kind}; use wide(x) or approx(x)")
        if not isinstance(value, ir.Constant):
            raise TypeError(f"{value} is no {kind}")
        if kind == "float":
            return vectors.splat_double(float(value.constant))
        return self.numbers.constant(value.constant << self.numbers.fraction, self.widths[kind])

    # -- operations ---------------------------------------------------------------------------

    def negative(self, x: Any) -> Any:
        if isinstance(x, Number):
            return self.numbers.neg(self.b, x)
        return self.b.fneg(x) if x.type == DOUBLES else self.b.neg(x)

    def sum(self, sign: str, x: Any, y: Any) -> Any:
        b = self.b
        if isinstance(x, Number):
            operation = self.numbers.add if sign == "+" else self.numbers.sub
            return operation(b, x, y)
        floating = x.type == DOUBLES
        if sign == "+":
            return b.fadd(x, y) if floating else b.add(x, y)
        return b.fsub(x, y) if floating else b.sub(x, y)

    def product(self, x: Any, y: Any) -> Any:
        if isinstance(x, Number):
            return self.numbers.product(self.b, x, y)
        return self.b.fmul(x, y)

    def quotient(self, x: Value, y: Value) -> Value:
        return self.b.fdiv(x, y)

    def _lanes(self, condition: Value) -> Value:
        one_for_all = condition.type == BOOL
        return vectors.same(self.b, condition, CONDITIONS) if one_for_all else condition

    def opposite(self, condition: Value) -> Value:
        return self.b.not_(condition)

    def both(self, x: Value, y: Value) -> Value:
        return self.b.and_(self._lanes(x), self._lanes(y))

    def either(self, x: Value, y: Value) -> Value:
        return self.b.or_(self._lanes(x), self._lanes(y))

    def compare(self, order: str, x: Any, y: Any) -> Value:
        b = self.b
        if not isinstance(x, Number):
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

    def inside(self, x: Number, limit: Number) -> Value:
        return self.numbers.inside(self.b, x, limit)

    # -- functions ----------------------------------------------------------------------------

    def function(self, name: str, values: Sequence[Any]) -> list[Any]:
        b, x = self.b, values[0]
        if name == "abs":
            if isinstance(x, Number):
                return [self.numbers.absolute(b, x)]
            return [b.call(vectors.intrinsic(self.module, "fabs"), [x])]
        if name == "approx":
            return [self.numbers.to_double(b, x)]
        if name == "shifted":
            by = values[1]  # a literal is one word for all lanes
            by = vectors.same(b, by, WORDS) if by.type == I64 else by
            return [self.numbers.shifted(b, x, by)]
        if name == "wide":
            return [self._wide(x)]
        if not isinstance(x, Number):
            return [self.functions.of_doubles(b, name, x)]
        valid, found = self.functions.call(b, name, x, self.allocations)
        self._require(valid)
        return list(found)

    def _wide(self, x: Value) -> Number:
        top = vectors.splat_double(2.0 ** (INTEGER_BITS - 1))
        size = self.b.call(vectors.intrinsic(self.module, "fabs"), [x])
        fits = self.b.fcmp_ordered("<", size, top)
        self._require(fits)
        x = self.b.select(fits, x, vectors.splat_double(0.0))  # what fits not has no words
        return self.numbers.from_double(self.b, x)

    def _require(self, condition: Value) -> None:
        """`valid` only where this is true."""
        self._known["valid"] = self.b.and_(self.load("valid"), condition)
