"""A scheme's step written into a kernel's program, without its derivatives by z or with them.

The algebras are step algebras (see `verify.schemes.steps.step_algebra`) whose values are operations
of a program. Equations are solved by Newton's method, with derivatives in the loop's program.

Derivatives are taken forwards, operation by operation of the step. Those of the field f at a stage
are elements of H's ring; they are evaluated together with f, and share its parts. The solution of
Z = R(Z, z) has the derivative ∂Z/∂z = (1 − ∂R/∂Z)⁻¹ ∂R/∂z.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.algebra.ring import Poly
from verify.hamiltonians.canonical_field import PlainField
from verify.kernels.step.evaluator import Evaluator, increments
from verify.kernels.step.matrix_operations import eliminate, one_minus
from verify.kernels.step.operations import NewtonLoop, StepProgram
from verify.schemes.steps.step_algebra import Number, StepAlgebra

Right = Callable[[StepAlgebra[Any], Sequence[Any]], list[Any]]  # (algebra, Z) → R(Z, z)


@dataclass(frozen=True, eq=False)
class ProgramValue:
    """A value: a program, and the index of an operation of it."""

    program: StepProgram
    index: int


@dataclass(frozen=True, eq=False)
class Dual(ProgramValue):
    """A value with its derivatives, as indices in the program, and the algebra that wrote it."""

    gradient: tuple[int, ...]
    algebra: TangentAlgebra


class ProgramAlgebra(StepAlgebra[ProgramValue]):
    """A step algebra that writes into `program`.

    `inputs`: the indices of h, the coordinates, t and the parameters by name. `outer`, of a loop's
    program: the algebra of the program around it, whose values become inputs here. `points`: the
    indices of the coordinates of all points at which f is evaluated.
    """

    def __init__(
        self,
        program: StepProgram,
        field: PlainField,
        inputs: Mapping[str, int],
        pipelined: bool,
        outer: ProgramAlgebra | None = None,
    ) -> None:
        self.program, self.field, self.pipelined = program, field, pipelined
        self.outer, self.outer_indices, self.points = outer, set[int](), set[int]()
        self.inputs = (
            inputs if outer is None else {n: self._take_over(index) for n, index in inputs.items()}
        )

    @property
    def nothing(self) -> ProgramValue:
        return self.value(self.program.constant(Fraction(0)))

    @property
    def size(self) -> int:
        return len(self.field.names)

    def along_flow(self, eta: int) -> list[ProgramValue]:
        moves = self.field.flow_changes(eta)
        return list(map(self.value, increments(self.evaluator(), moves, self.inputs["h"])))

    def slopes(
        self, changes: Sequence[ProgramValue], clock: Number, places: Sequence[int]
    ) -> list[ProgramValue]:
        evaluator = self.evaluator_at(changes, clock)
        return [self.value(evaluator.evaluate(self.field.slopes[k])) for k in places]

    def shear(
        self, changes: Sequence[ProgramValue], size: Number, clock: Number, places: Sequence[int]
    ) -> list[ProgramValue]:
        """Write the shear with the factors h and `size` in the coefficients of f, which are static:
        they are computed once."""
        evaluator, result = self.evaluator_at(changes, clock), list(changes)
        for k, move in zip(places, self.field.shears(size, places), strict=True):
            total = self.program.add(self.local_index(changes[k]), evaluator.evaluate(move))
            result[k] = self.value(total)
        return result

    def evaluator_at(self, changes: Sequence[ProgramValue], clock: Number) -> Evaluator:
        """Return an evaluator of ring elements at z + changes and at t + clock·h."""
        program, inputs = self.program, dict(self.inputs)
        for name, change in zip(self.field.names, changes, strict=True):
            inputs[name] = program.add(inputs[name], self.local_index(change))
            self.points.add(inputs[name])
        if self.field.timed:
            delay = program.mul(inputs["h"], self._coefficient(clock))
            inputs["t"] = program.add(inputs["t"], delay)
        return Evaluator(program, self.field.ring, inputs, self.pipelined)

    def move(
        self, change: ProgramValue, weights: Sequence[Number], slopes: Sequence[ProgramValue]
    ) -> ProgramValue:
        program, evaluator = self.program, self.evaluator()
        shares = [program.mul(self.inputs["h"], self._coefficient(w)) for w in weights]
        move = evaluator.combination(shares, [self.local_index(x) for x in slopes])
        return self.value(program.add(self.local_index(change), move))

    def add_share(self, x: ProgramValue, y: ProgramValue, share: Fraction) -> ProgramValue:
        program = self.program
        part = program.mul(program.constant(share), self.local_index(y))
        return self.value(program.add(self.local_index(x), part))

    def solve(self, count: int, right: Right) -> list[ProgramValue]:
        """Solve by Newton's method, from the initial value R(0, z)."""
        outer, number, inner = self.program, len(self.program.loops), StepProgram()
        starts = [self.local_index(x) for x in right(self, [self.nothing] * count)]
        unknowns = [inner.input(f"u{number}_{k}", static=False) for k in range(count)]
        algebra = ProgramAlgebra(inner, self.field, self.inputs, self.pipelined, self)
        tangents = TangentAlgebra(algebra, count)
        sides = tangents.read_right_side(right, [algebra.value(x) for x in unknowns])
        residuals = [inner.add(x, inner.neg(y.index)) for x, y in zip(unknowns, sides, strict=True)]
        # F(Z) = Z − R(Z, z) has the derivative 1 − ∂R/∂Z: a linear system gives the update.
        matrix = one_minus(inner, [side.gradient for side in sides])
        updates, pivots = eliminate(inner, matrix, [[x] for x in residuals])
        names = self.field.names
        # Unknown k is a change of coordinate k mod 2n, whose size tells whether an update is small.
        scale = [self.inputs[names[k % self.size]] for k in range(count)]
        steps = [x for (x,) in updates]
        loop = NewtonLoop(number, inner, *map(tuple, (steps, starts, scale, pivots)))
        return [self.value(index) for index in outer.solve(loop, sorted(algebra.outer_indices))]

    # -- values -------------------------------------------------------------------------------

    def value(self, index: int) -> ProgramValue:
        return ProgramValue(self.program, index)

    def local_index(self, x: ProgramValue) -> int:
        """Return the index of a value; a value of the outer program becomes an input of this
        one."""
        return x.index if x.program is self.program else self._take_over(x.index)

    def _take_over(self, index: int) -> int:
        assert self.outer is not None  # noqa: S101 - a value is of this program or of the outer one
        outer_program, program = self.outer.program, self.program
        op = outer_program.ops[index]
        if op.kind == "const":
            return program.constant(op.value)
        self.outer_indices.add(index)
        return program.input(f"v{index}", static=outer_program.static[index])

    def _coefficient(self, x: Number) -> int:
        if isinstance(x, Fraction):
            return self.program.constant(x)
        return self.evaluator().evaluate(x)

    def evaluator(self) -> Evaluator:
        return Evaluator(self.program, self.field.ring, self.inputs, self.pipelined)


class TangentAlgebra(StepAlgebra[Dual]):
    """The step algebra of values with derivatives: first by the coordinates, then by unknowns.

    `coordinates`: the number of coordinates by which derivatives are taken; 0 in a loop's program,
    where all values but the unknowns are constant. `outer`: the algebra whose derivatives come
    first instead. `unknowns`: the number of unknowns.
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
        self.first_unknown: int = outer.width if outer else coordinates
        self.width: int = self.first_unknown + unknowns
        self.program = plain.program
        self.zero, self.one = self.program.quotient(0, 1), self.program.quotient(1, 1)

    @property
    def nothing(self) -> Dual:
        return self._dual(self.zero, (self.zero,) * self.width)

    @property
    def size(self) -> int:
        return self.plain.size

    def read_right_side(self, right: Right, unknowns: Sequence[ProgramValue]) -> list[Dual]:
        """Return the right side at these unknowns, with its derivatives by them as well."""
        seeds = []
        for k, x in enumerate(unknowns):
            row = [self.zero] * self.width
            row[self.first_unknown + k] = self.one
            seeds.append(self._dual(x.index, tuple(row)))
        return [self._fit(x) for x in right(self, seeds)]

    def along_flow(self, eta: int) -> list[Dual]:
        values, evaluator = self.plain.along_flow(eta), self.plain.evaluator()
        rows = (self.field.gradient(x) for x in self.field.flow_changes(eta))
        nothing = [self.nothing] * self.size
        return [
            self._dual(value.index, self._chain([evaluator.evaluate(x) for x in row], nothing))
            for value, row in zip(values, rows, strict=True)
        ]

    def slopes(
        self, changes: Sequence[ProgramValue], clock: Number, places: Sequence[int]
    ) -> list[Dual]:
        evaluator, duals = self.plain.evaluator_at(changes, clock), list(map(self._fit, changes))
        slopes = [self.field.slopes[k] for k in places]
        values = [evaluator.evaluate(x) for x in slopes]
        return [
            self._evaluate_dual(evaluator, x, index, duals)
            for x, index in zip(slopes, values, strict=True)
        ]

    def shear(
        self, changes: Sequence[ProgramValue], size: Number, clock: Number, places: Sequence[int]
    ) -> list[Dual]:
        evaluator, before = self.plain.evaluator_at(changes, clock), list(map(self._fit, changes))
        after, result = self.plain.shear(changes, size, clock, places), list(before)
        for k, move in zip(places, self.field.shears(size, places), strict=True):
            row = self._evaluate_dual(evaluator, move, self.zero, before).gradient
            result[k] = self._dual(after[k].index, self._add(before[k].gradient, row))
        return result

    def move(
        self, change: ProgramValue, weights: Sequence[Number], slopes: Sequence[ProgramValue]
    ) -> Dual:
        total, plain = self._fit(change), self.plain
        index = plain.move(total, weights, slopes).index
        columns = list(zip(*(self._fit(x).gradient for x in slopes), strict=True))
        columns = columns or [()] * self.width
        moves = (plain.move(plain.nothing, weights, [*map(plain.value, x)]) for x in columns)
        return self._dual(index, self._add(total.gradient, [x.index for x in moves]))

    def add_share(self, x: ProgramValue, y: ProgramValue, share: Fraction) -> Dual:
        dual_x, dual_y = self._fit(x), self._fit(y)
        part = self.program.constant(share)
        scaled = [self.program.mul(part, entry) for entry in dual_y.gradient]
        index = self.plain.add_share(dual_x, dual_y, share).index
        return self._dual(index, self._add(dual_x.gradient, scaled))

    def solve(self, count: int, right: Right) -> list[Dual]:
        # Z = R(Z, z) is differentiated implicitly, at the solution: the iteration is not.
        values, program = self.plain.solve(count, right), self.program
        sides = TangentAlgebra(self.plain, count, self).read_right_side(right, values)
        matrix = one_minus(program, [side.gradient[self.width :] for side in sides])
        rows, _ = eliminate(program, matrix, [side.gradient[: self.width] for side in sides])
        return [self._dual(x.index, tuple(row)) for x, row in zip(values, rows, strict=True)]

    # -- gradients ----------------------------------------------------------------------------

    def _dual(self, index: int, gradient: tuple[int, ...]) -> Dual:
        return Dual(self.program, index, gradient, self)

    def _fit(self, x: ProgramValue) -> Dual:
        """Return the value with `width` derivatives: its own, those of the outer algebra followed
        by 0, or 0 for a value without derivatives."""
        if isinstance(x, Dual) and x.algebra is self:
            return x
        gradient = x.gradient if isinstance(x, Dual) and x.algebra is self.outer else ()
        return self._dual(
            self.plain.local_index(x), (*gradient, *[self.zero] * (self.width - len(gradient)))
        )

    def _evaluate_dual(
        self, evaluator: Evaluator, x: Poly, index: int, changes: Sequence[Dual]
    ) -> Dual:
        """Return the dual of a ring element at z + changes; `index`: its value."""
        row = [evaluator.evaluate(y) for y in self.field.gradient(x)]
        return self._dual(index, self._chain(row, changes))

    def _chain(self, row: Sequence[int], changes: Sequence[Dual]) -> tuple[int, ...]:
        """Return the derivatives Σ_j row_j ∂(z_j + change_j)."""
        add, mul = self.program.add, self.program.mul
        # ∂(z_j + change_j) = 1 + ∂change_j by z_j: the row itself is the contribution of the 1.
        total = [*row[: self.coordinates], *[self.zero] * (self.width - self.coordinates)]
        for slope, change in zip(row, changes, strict=True):
            total = [add(x, mul(slope, y)) for x, y in zip(total, change.gradient, strict=True)]
        return tuple(total)

    def _add(self, x: Sequence[int], y: Sequence[int]) -> tuple[int, ...]:
        return tuple(map(self.program.add, x, y))
