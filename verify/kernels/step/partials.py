"""Partial derivatives of a program's values by its inputs, written into the same program.

They are taken forwards, operation by operation. The derivatives of a polynomial in Horner's form
are its inner sums, and no operation is written twice: so derivatives cost little beside the values.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.functions import by_name
from verify.kernels.step.kinds import Call, Op
from verify.kernels.step.operations import StepProgram

Gradient = Mapping[int, int]  # input → derivative, both as indices; derivatives 0 are left out


class Partials:
    """The derivatives ∂/∂x of a program's values, for inputs x, which are indices."""

    def __init__(self, program: StepProgram, inputs: Sequence[int]) -> None:
        self.program, self.inputs = program, tuple(inputs)
        self._gradients: dict[int, Gradient] = {}

    def gradient(self, index: int) -> list[int]:
        """Return the indices of ∂/∂x of a value, input by input.

        Raises NotImplementedError if the value depends on a solution of equations.
        """
        for live_index in self.program.live([index]):
            if live_index not in self._gradients:
                self._gradients[live_index] = self._compute_gradient(live_index)
        zero, partials = self.program.constant(Fraction(0)), self._gradients[index]
        return [partials.get(x, zero) for x in self.inputs]

    def _compute_gradient(self, index: int) -> Gradient:
        if index in self.inputs:
            return {index: self.program.constant(Fraction(1))}
        op = self.program.ops[index]
        # A value that does not depend on the inputs has an empty gradient: the program stays short.
        if self.program.static[index] or op.kind == "input":
            return {}
        parts = [self._gradients[a] for a in op.args]
        if op.kind in ("loop", "solved"):
            raise NotImplementedError("the derivative of a solution of equations")
        varying = [x for part in parts for x in part]
        slopes = self._slopes(index, op) if varying else ()
        return {x: self._chain(x, parts, slopes) for x in dict.fromkeys(varying)}

    def _chain(self, x: int, parts: Sequence[Gradient], slopes: Sequence[int]) -> int:
        """Return the index of Σ slope · ∂argument/∂x."""
        program = self.program
        total = program.constant(Fraction(0))
        for part, slope in zip(parts, slopes, strict=True):
            if x in part:
                total = program.add(total, program.mul(slope, part[x]))
        return total

    def _slopes(self, index: int, op: Op) -> tuple[int, ...]:
        """Return the indices of the derivatives of the operation by each of its arguments."""
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
                return (write_derivative(program, op, index),)
        return ()

    def _of_root(self, index: int, degree: int) -> int:
        """Return the index of the derivative of y = x^(1/n), as 1/(n y^(n − 1))."""
        program = self.program
        # It is not y/(n x), since x may be a value that nothing else needs in the loop.
        below = program.mul(program.quotient(degree, 1), program.power(index, degree - 1))
        return program.inverse(below)


def write_derivative(program: StepProgram, call: Call, index: int) -> int:
    """Return the index of f′(x), where y = f(x) is the call's value, of index `index`."""

    def apply(name: str, x: Operand) -> Operand:
        if name == "inverse":
            return Operand(program, program.inverse(x.index))
        if name == "sqrt":
            return Operand(program, program.root(x.index, 2))
        return Operand(program, program.call(by_name()[name], x.index))

    # The derivative may use the function's value, which the program already has.
    x, y = Operand(program, call.args[0]), Operand(program, index)
    slope: Operand = call.function.derivative(x, y, apply)
    return slope.index


@dataclass(frozen=True, eq=False)
class Operand:
    """A program's value, by its index, with operators + − * that write into the program."""

    program: StepProgram
    index: int

    def _at(self, index: int) -> "Operand":
        return Operand(self.program, index)

    def __neg__(self) -> "Operand":
        return self._at(self.program.neg(self.index))

    def __mul__(self, other: "Operand") -> "Operand":
        return self._at(self.program.mul(self.index, other.index))

    def __radd__(self, number: int) -> "Operand":
        return self._at(self.program.add(self.program.quotient(number, 1), self.index))

    def __rsub__(self, number: int) -> "Operand":
        return number + -self
