"""Partial derivatives of a program's values by its inputs, written into the same program.

Forwards, operation by operation. A polynomial that is nested by Horner's rule has its inner sums
as derivatives, and no operation is written twice, so that they cost little beside the values.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from verify.kernels.step.operations import Op, Program
from verify.kernels.step.slopes import slope_of

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
