"""The slope of a function in a program, written into the same program."""

from dataclasses import dataclass

from verify.functions import by_name
from verify.kernels.step.kinds import Call
from verify.kernels.step.operations import Program


@dataclass(frozen=True, eq=False)
class Operand:
    """A program's value, by its index, with + − * that are written into the program."""

    program: Program
    index: int

    def _with(self, index: int) -> "Operand":
        return Operand(self.program, index)

    def __neg__(self) -> "Operand":
        return self._with(self.program.neg(self.index))

    def __mul__(self, other: "Operand") -> "Operand":
        return self._with(self.program.mul(self.index, other.index))

    def __radd__(self, number: int) -> "Operand":
        return self._with(self.program.add(self.program.quotient(number, 1), self.index))

    def __rsub__(self, number: int) -> "Operand":
        return number + -self


def slope_of(program: Program, call: Call, index: int) -> int:
    """Return the index of f'(x), where y = f(x) is the value of that index."""

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
