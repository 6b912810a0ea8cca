"""A scheme's step written into a kernel's program, without its derivatives by z or with them.

See `verify.schemes.steps.step_algebra`; a value is an operation of a program. Equations are solved
by Newton's method, with derivatives taken in the loop's own program.

Derivatives are made forwards, with what a step is made of. Those of f at a stage are elements of
H's ring, evaluated beside f itself, so that they share what f is made of; where equations are
solved, Z = R(Z, z), they are ∂Z/∂z = (1 − ∂R/∂Z)⁻¹ ∂R/∂z.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.algebra.ring import Poly
from verify.hamiltonians.canonical_field import CanonicalField
from verify.kernels.step.increments import increments
from verify.kernels.step.operations import Loop, Program
from verify.kernels.step.program import Evaluator
from verify.schemes.steps.step_algebra import Number, StepAlgebra

Right = Callable[[StepAlgebra[Any], Sequence[Any]], list[Any]]


@dataclass(frozen=True, eq=False)
class Value:
    """An operation, by its index, of the program that it stands in."""

    program: Program
    index: int


@dataclass(frozen=True, eq=False)
class Dual(Value):
    """The same with its derivatives, as indices in the program, of the algebra that it is of."""

    gradient: tuple[int, ...]
    algebra: TangentAlgebra


class ProgramAlgebra(StepAlgebra[Value]):
    """Writes into `program`; `named` has the inputs: h, the coordinates, t, the parameters.

    `outer`: what a loop's program takes values over from. `points`: the coordinates of where f is
    looked at.
    """

    def __init__(
        self,
        program: Program,
        field: CanonicalField,
        named: Mapping[str, int],
        pipelined: bool,
        outer: ProgramAlgebra | None = None,
    ) -> None:
        self.program, self.field, self.pipelined = program, field, pipelined
        self.outer, self.taken, self.points = outer, set[int](), set[int]()
        self.named = named if outer is None else {n: self._taken(at) for n, at in named.items()}

    @property
    def nothing(self) -> Value:
        return self.value(self.program.constant(Fraction(0)))

    @property
    def size(self) -> int:
        return len(self.field.names)

    def along_flow(self, eta: int) -> list[Value]:
        n, evaluator, moves = self.size // 2, self.evaluator(), self.field.flow_changes(eta)
        pairs = [
            increments(evaluator, self.field.ring, pair, self.named["h"])
            for pair in zip(moves[:n], moves[n:], strict=True)
        ]
        return [self.value(pair[part]) for part in (0, 1) for pair in pairs]

    def slopes(self, changes: Sequence[Value], clock: Number, places: Sequence[int]) -> list[Value]:
        at = self.at(changes, clock)
        return [self.value(at.evaluate(self.field.slopes[k])) for k in places]

    def sheared(
        self, changes: Sequence[Value], size: Number, clock: Number, places: Sequence[int]
    ) -> list[Value]:
        """With h and the size in the coefficients of f, which are made once."""
        at, result = self.at(changes, clock), list(changes)
        for k, move in zip(places, self.field.shears(size, places), strict=True):
            total = self.program.add(self.own(changes[k]), at.evaluate(move))
            result[k] = self.value(total)
        return result

    def at(self, changes: Sequence[Value], clock: Number) -> Evaluator:
        """What evaluates elements of the ring at z + changes, and at t + clock h."""
        program, named = self.program, dict(self.named)
        for name, change in zip(self.field.names, changes, strict=True):
            named[name] = program.add(named[name], self.own(change))
            self.points.add(named[name])
        if self.field.timed:
            late = program.mul(named["h"], self._coefficient(clock))
            named["t"] = program.add(named["t"], late)
        return Evaluator(program, self.field.ring, named, self.pipelined)

    def moved(self, change: Value, weights: Sequence[Number], slopes: Sequence[Value]) -> Value:
        program, evaluator = self.program, self.evaluator()
        shares = [program.mul(self.named["h"], self._coefficient(w)) for w in weights]
        move = evaluator.combination(shares, [self.own(x) for x in slopes])
        return self.value(program.add(self.own(change), move))

    def between(self, x: Value, y: Value, share: Fraction) -> Value:
        program = self.program
        part = program.mul(program.constant(share), self.own(y))
        return self.value(program.add(self.own(x), part))

    def solved(self, count: int, right: Right) -> list[Value]:
        """By Newton's method, from what the right side is at 0."""
        outer, number, inner = self.program, len(self.program.loops), Program()
        starts = [self.own(x) for x in right(self, [self.nothing] * count)]
        own = [inner.input(f"u{number}_{k}", static=False) for k in range(count)]
        algebra = ProgramAlgebra(inner, self.field, self.named, self.pipelined, self)
        tangents = TangentAlgebra(algebra, count)
        sides = tangents.read(right, [algebra.value(x) for x in own])
        residuals = [inner.add(x, inner.neg(y.index)) for x, y in zip(own, sides, strict=True)]
        matrix = _less_one(inner, [side.gradient for side in sides])
        updates, pivots = eliminated(inner, matrix, [[x] for x in residuals])
        names = self.field.names
        scale = [self.named[names[k % self.size]] for k in range(count)]
        steps = [x for (x,) in updates]
        loop = Loop(number, inner, *map(tuple, (steps, starts, scale, pivots)))
        return [self.value(at) for at in outer.solve(loop, sorted(algebra.taken))]

    # -- values -------------------------------------------------------------------------------

    def value(self, index: int) -> Value:
        return Value(self.program, index)

    def own(self, x: Value) -> int:
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
        return self.evaluator().evaluate(x)

    def evaluator(self) -> Evaluator:
        return Evaluator(self.program, self.field.ring, self.named, self.pipelined)


class TangentAlgebra(StepAlgebra[Dual]):
    """With derivatives: the coordinates' own among the first, where `outer` is none and they move;
    then, of `unknowns` that are seeds, theirs. In a loop's program all but the unknowns is held.
    """

    def __init__(
        self,
        plain: ProgramAlgebra,
        unknowns: int = 0,
        outer: TangentAlgebra | None = None,
        coordinates: int = 0,
    ) -> None:
        self.plain, self.outer, self.field = plain, outer, plain.field
        self.coordinates: int = outer.coordinates if outer else coordinates
        self.first: int = outer.width if outer else coordinates  # of the unknowns
        self.width: int = self.first + unknowns
        self.program = plain.program
        self.zero, self.one = self.program.quotient(0, 1), self.program.quotient(1, 1)

    @property
    def nothing(self) -> Dual:
        return self._dual(self.zero, (self.zero,) * self.width)

    @property
    def size(self) -> int:
        return self.plain.size

    def read(self, right: Right, unknowns: Sequence[Value]) -> list[Dual]:
        """What a right side is of these unknowns, with its derivatives by them too."""
        seeds = []
        for k, x in enumerate(unknowns):
            row = [self.zero] * self.width
            row[self.first + k] = self.one
            seeds.append(self._dual(x.index, tuple(row)))
        return [self._fit(x) for x in right(self, seeds)]

    def along_flow(self, eta: int) -> list[Dual]:
        values, evaluator = self.plain.along_flow(eta), self.plain.evaluator()
        rows = (self.field.gradient(x) for x in self.field.flow_changes(eta))
        nothing = [self.nothing] * self.size
        return [
            self._dual(value.index, self._chained([evaluator.evaluate(x) for x in row], nothing))
            for value, row in zip(values, rows, strict=True)
        ]

    def slopes(self, changes: Sequence[Value], clock: Number, places: Sequence[int]) -> list[Dual]:
        at, moved = self.plain.at(changes, clock), list(map(self._fit, changes))
        slopes = [self.field.slopes[k] for k in places]
        values = [at.evaluate(x) for x in slopes]
        return [self._at(at, x, index, moved) for x, index in zip(slopes, values, strict=True)]

    def sheared(
        self, changes: Sequence[Value], size: Number, clock: Number, places: Sequence[int]
    ) -> list[Dual]:
        at, before = self.plain.at(changes, clock), list(map(self._fit, changes))
        after, result = self.plain.sheared(changes, size, clock, places), list(before)
        for k, move in zip(places, self.field.shears(size, places), strict=True):
            row = self._at(at, move, self.zero, before).gradient
            result[k] = self._dual(after[k].index, self._added(before[k].gradient, row))
        return result

    def moved(self, change: Value, weights: Sequence[Number], slopes: Sequence[Value]) -> Dual:
        total, plain = self._fit(change), self.plain
        index = plain.moved(total, weights, slopes).index
        columns = list(zip(*(self._fit(x).gradient for x in slopes), strict=True))
        columns = columns or [()] * self.width
        moves = (plain.moved(plain.nothing, weights, [*map(plain.value, x)]) for x in columns)
        return self._dual(index, self._added(total.gradient, [x.index for x in moves]))

    def between(self, x: Value, y: Value, share: Fraction) -> Dual:
        one, other = self._fit(x), self._fit(y)
        part = self.program.constant(share)
        moved = [self.program.mul(part, at) for at in other.gradient]
        index = self.plain.between(one, other, share).index
        return self._dual(index, self._added(one.gradient, moved))

    def solved(self, count: int, right: Right) -> list[Dual]:
        values, program = self.plain.solved(count, right), self.program
        sides = TangentAlgebra(self.plain, count, self).read(right, values)
        matrix = _less_one(program, [side.gradient[self.width :] for side in sides])
        rows, _ = eliminated(program, matrix, [side.gradient[: self.width] for side in sides])
        return [self._dual(x.index, tuple(row)) for x, row in zip(values, rows, strict=True)]

    # -- gradients ----------------------------------------------------------------------------

    def _dual(self, index: int, gradient: tuple[int, ...]) -> Dual:
        return Dual(self.program, index, gradient, self)

    def _fit(self, x: Value) -> Dual:
        """With as many derivatives as there are here; what comes from elsewhere is held."""
        if isinstance(x, Dual) and x.algebra is self:
            return x
        known = x.gradient if isinstance(x, Dual) and x.algebra is self.outer else ()
        return self._dual(self.plain.own(x), (*known, *[self.zero] * (self.width - len(known))))

    def _at(self, at: Evaluator, x: Poly, index: int, changes: Sequence[Dual]) -> Dual:
        """An element at z + changes, with its derivatives."""
        row = [at.evaluate(y) for y in self.field.gradient(x)]
        return self._dual(index, self._chained(row, changes))

    def _chained(self, row: Sequence[int], changes: Sequence[Dual]) -> tuple[int, ...]:
        """Σ_j row_j ∂(z_j + change_j)."""
        add, mul = self.program.add, self.program.mul
        total = [*row[: self.coordinates], *[self.zero] * (self.width - self.coordinates)]
        for slope, change in zip(row, changes, strict=True):
            total = [add(x, mul(slope, y)) for x, y in zip(total, change.gradient, strict=True)]
        return tuple(total)

    def _added(self, one: Sequence[int], other: Sequence[int]) -> tuple[int, ...]:
        return tuple(map(self.program.add, one, other))


def _less_one(program: Program, rows: Sequence[Sequence[int]]) -> list[list[int]]:
    """1 − the matrix of these rows."""
    matrix = [list(map(program.neg, row)) for row in rows]
    for k, row in enumerate(matrix):
        row[k] = program.add(program.quotient(1, 1), row[k])
    return matrix


def eliminated(
    program: Program, matrix: Sequence[Sequence[int]], right: Sequence[Sequence[int]]
) -> tuple[list[list[int]], list[int]]:
    """The solutions of linear systems whose matrix is 1 + O(h), one a column of the right side, row
    by row, and the pivots that are not 1.

    Without pivoting: at h = 0 the diagonal is 1.
    """
    add, mul, neg = program.add, program.mul, program.neg
    size, rows = len(matrix), [[*row, *more] for row, more in zip(matrix, right, strict=True)]
    width = len(rows[0])
    pivots, over = [], []
    for k in range(size):
        pivot = rows[k][k]
        one = program.is_constant(pivot, 1)
        pivots += [] if one else [pivot]
        over.append(pivot if one else program.inverse(pivot))
        for i in range(k + 1, size):
            factor = mul(rows[i][k], over[k])
            for j in range(k + 1, width):
                rows[i][j] = add(rows[i][j], neg(mul(factor, rows[k][j])))
    solved: list[list[int]] = [[] for _ in range(size)]
    for k in reversed(range(size)):
        for column in range(width - size):
            total = rows[k][size + column]
            for j in range(k + 1, size):
                total = add(total, neg(mul(rows[k][j], solved[j][column])))
            solved[k].append(mul(total, over[k]))
    return solved, pivots or [program.constant(Fraction(1))]
