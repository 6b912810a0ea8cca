"""A scheme's step written into a kernel's program, in n degrees of freedom.

See `verify.schemes.step_algebra`; a value is an operation of a program. Equations are
solved by Newton's method, with derivatives taken in the loop's own program.

Partial derivatives of a program's values by its inputs, written into the same program.

Forwards, operation by operation. A polynomial that is nested by Horner's rule has its inner sums
as derivatives, and no operation is written twice, so that they cost little beside the values.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.hamiltonians.canonical_field import CanonicalField
from verify.kernels.step.increments import increments
from verify.kernels.step.operations import Loop, Op
from verify.kernels.step.program import Evaluator, Program
from verify.kernels.step.slopes import slope_of
from verify.schemes.step_algebra import Number, StepAlgebra

Gradient = Mapping[int, int]  # by input, of what is not 0


class Partials:
    """∂/∂x of a program's values, x being these of its inputs, by their indices."""

    def __init__(self, program: Program, inputs: Sequence[int]) -> None:
        self.program, self.inputs = program, tuple(inputs)
        self._found: dict[int, Gradient] = {}

    def gradient(self, index: int) -> list[int]:
        """The indices of ∂/∂x of a value, input by input.

        Raises NotImplementedError of a value for which equations are solved.
        """
        for at in self.program.live([index]):
            if at not in self._found:
                self._found[at] = self._of(at)
        zero, own = self.program.constant(Fraction(0)), self._found[index]
        return [own.get(x, zero) for x in self.inputs]

    def _of(self, index: int) -> Gradient:
        if index in self.inputs:
            return {index: self.program.constant(Fraction(1))}
        op = self.program.ops[index]
        if self.program.static[index] or op.kind == "input":
            return {}
        parts = [self._found[a] for a in op.args]
        if op.kind in ("loop", "solved"):
            raise NotImplementedError("the derivative of a solution of equations")
        moved = [x for part in parts for x in part]
        slopes = self._slopes(index, op) if moved else ()
        return {x: self._chain(x, parts, slopes) for x in dict.fromkeys(moved)}

    def _chain(self, x: int, parts: Sequence[Gradient], slopes: Sequence[int]) -> int:
        """Σ slope · ∂argument/∂x."""
        program = self.program
        total = program.constant(Fraction(0))
        for part, slope in zip(parts, slopes, strict=True):
            if x in part:
                total = program.add(total, program.mul(slope, part[x]))
        return total

    def _slopes(self, index: int, op: Op) -> tuple[int, ...]:
        """∂ of the operation by each of its arguments."""
        program = self.program
        one = program.constant(Fraction(1))
        match op.kind:
            case "add":
                return one, one
            case "sub":
                return one, program.neg(one)
            case "neg":
                return (program.neg(one),)
            case "mul":
                return op.args[1], op.args[0]
            case "inverse":
                return (program.neg(program.mul(index, index)),)
            case "root":
                return (self._of_root(index, op.degree),)
            case "call":
                return (slope_of(program, op, index),)
        return ()

    def _of_root(self, index: int, degree: int) -> int:
        """y/(n x) of y = x^(1/n), as 1/(n y^(n − 1))."""
        program = self.program
        below = program.mul(program.quotient(degree, 1), program.power(index, degree - 1))
        return program.inverse(below)


_ZERO = Fraction(0)


@dataclass(frozen=True, eq=False)
class Value:
    """An operation, by its index, of the program that it stands in."""

    program: Program
    index: int


class ProgramAlgebra:
    """Writes into `program`; `named` has the inputs: h, the coordinates, t, the parameters.

    `outer`: what a loop's program takes values over from.
    """

    def __init__(
        self,
        program: Program,
        field: CanonicalField,
        named: Mapping[str, int],
        pipelined: bool,
        outer: "ProgramAlgebra | None" = None,
    ) -> None:
        self.program, self.field, self.pipelined = program, field, pipelined
        self.outer, self.taken = outer, set[int]()
        self.named = named if outer is None else {n: self._taken(at) for n, at in named.items()}

    @property
    def nothing(self) -> Value:
        return self._value(self.program.constant(_ZERO))

    @property
    def size(self) -> int:
        return len(self.field.names)

    def along_flow(self, eta: int) -> list[Value]:
        n, ring, h = self.size // 2, self.field.ring, self.field.ring.variable("h")
        terms = [self.field.term(k) for k in range(1, eta + 1)]
        total = [
            sum((h**k * x for k, x in enumerate(own, start=1)), ring.zero)
            for own in zip(*terms, strict=True)
        ]
        evaluator = Evaluator(self.program, ring, self.named, self.pipelined)
        pairs = [
            increments(evaluator, ring, pair, self.named["h"])
            for pair in zip(total[:n], total[n:], strict=True)
        ]
        return [self._value(pair[part]) for part in (0, 1) for pair in pairs]

    def slopes(self, changes: Sequence[Value], clock: Number, places: Sequence[int]) -> list[Value]:
        program, named = self.program, dict(self.named)
        for name, change in zip(self.field.names, changes, strict=True):
            named[name] = program.add(named[name], self._own(change))
        if self.field.timed:
            late = program.mul(named["h"], self._coefficient(clock))
            named["t"] = program.add(named["t"], late)
        evaluator = Evaluator(program, self.field.ring, named, self.pipelined)
        return [self._value(evaluator.evaluate(self.field.slopes[k])) for k in places]

    def moved(self, change: Value, weights: Sequence[Number], slopes: Sequence[Value]) -> Value:
        program, total = self.program, self._own(change)
        for w, slope in zip(weights, slopes, strict=True):
            share = program.mul(self.named["h"], self._coefficient(w))
            total = program.add(total, program.mul(share, self._own(slope)))
        return self._value(total)

    def between(self, x: Value, y: Value, share: Fraction) -> Value:
        program = self.program
        part = program.mul(program.constant(share), self._own(y))
        return self._value(program.add(self._own(x), part))

    def solved(
        self, count: int, right: Callable[[StepAlgebra[Value], Sequence[Value]], list[Value]]
    ) -> list[Value]:
        """By Newton's method, from what the right side is at 0."""
        outer, number, inner = self.program, len(self.program.loops), Program()
        starts = [self._own(x) for x in right(self, [self.nothing] * count)]
        own = [inner.input(f"u{number}_{k}", static=False) for k in range(count)]
        algebra = ProgramAlgebra(inner, self.field, self.named, self.pipelined, self)
        found = [algebra._own(x) for x in right(algebra, [algebra._value(x) for x in own])]
        residuals = [inner.add(x, inner.neg(y)) for x, y in zip(own, found, strict=True)]
        partials = Partials(inner, own)
        updates, pivots = _eliminated(inner, [partials.gradient(x) for x in residuals], residuals)
        names = self.field.names
        scale = [self.named[names[k % self.size]] for k in range(count)]
        loop = Loop(number, inner, *map(tuple, (updates, starts, scale, pivots)))
        return [self._value(at) for at in outer.solve(loop, sorted(algebra.taken))]

    # -- values -------------------------------------------------------------------------------

    def _value(self, index: int) -> Value:
        return Value(self.program, index)

    def _own(self, x: Value) -> int:
        """A value's index; one of the outer program becomes an input of the loop."""
        return x.index if x.program is self.program else self._taken(x.index)

    def _taken(self, index: int) -> int:
        assert self.outer is not None  # noqa: S101 - there are values of two programs at most
        given, program = self.outer.program, self.program
        op = given.ops[index]
        if op.kind == "const":
            return program.constant(op.value)
        self.taken.add(index)
        return program.input(f"v{index}", static=given.static[index])

    def _coefficient(self, x: Number) -> int:
        if isinstance(x, Fraction):
            return self.program.constant(x)
        return Evaluator(self.program, self.field.ring, self.named, self.pipelined).evaluate(x)


def _eliminated(
    program: Program, matrix: Sequence[Sequence[int]], right: Sequence[int]
) -> tuple[list[int], list[int]]:
    """The solution of a linear system whose matrix is 1 + O(h), and the pivots that are not 1.

    Without pivoting: at h = 0 the diagonal is 1.
    """
    add, mul, neg = program.add, program.mul, program.neg
    size, rows = len(matrix), [[*row, x] for row, x in zip(matrix, right, strict=True)]
    pivots, over = [], []
    for k in range(size):
        pivot = rows[k][k]
        one = program.is_constant(pivot, 1)
        pivots += [] if one else [pivot]
        over.append(pivot if one else program.inverse(pivot))
        for i in range(k + 1, size):
            factor = mul(rows[i][k], over[k])
            for j in range(k + 1, size + 1):
                rows[i][j] = add(rows[i][j], neg(mul(factor, rows[k][j])))
    found: list[int] = [0] * size
    for k in reversed(range(size)):
        total = rows[k][size]
        for j in range(k + 1, size):
            total = add(total, neg(mul(rows[k][j], found[j])))
        found[k] = mul(total, over[k])
    return found, pivots or [program.constant(Fraction(1))]
