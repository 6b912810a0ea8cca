"""A program's operations → lines of source, separated into those before the loop and those in
it."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import gmpy2

from verify.arithmetic.number import Number
from verify.kernels.step import newton
from verify.kernels.step.kinds import Call, Input, Inverse, Opposite, Pi, Root, Solution, Solving
from verify.kernels.step.operations import Loop, Program

_INFIX = {"add": "+", "sub": "-", "mul": "*"}
_GUARD = 64  # bits of a given root beyond those of the arithmetic


@dataclass
class Lowering:
    """Writes a program's values as variables `prefix` + index.

    `functions`: the names an arithmetic has; cos and sin of one argument are written as one call
    where it has `cos_sin` or `sin_cos`. Where it has no `root`, the root of a number is a number
    too, known to its `bits`. `guard`: a condition on `{x}` that a number in range satisfies (see
    `verify.arithmetic.number_system`).
    """

    program: Program
    functions: Collection[str]
    prefix: str = "v"
    bits: int = 0
    guard: str | None = None
    _already_written: set[int] = field(default_factory=set)

    def name(self, index: int) -> str:
        """Return the variable that holds an operation's value."""
        return f"{self.prefix}{index}"

    def live(self, roots: Sequence[int]) -> list[int]:
        """Return the operations that the roots need, in their order."""
        return self.program.live(roots)

    def lines(self, roots: Sequence[int]) -> tuple[list[str], list[str]]:
        """Return the lines that compute the roots: those before the loop, and those in it."""
        program, live = self.program, self.live(roots)
        ops, prefix, static_ones = program.ops, self.prefix, program.static
        static: list[str] = []
        dynamic: list[str] = []
        for index in live:
            op = ops[index]
            if op.kind == "add" or op.kind == "sub" or op.kind == "mul":
                x, y = op.args
                line = f"{prefix}{index} = {prefix}{x} {_INFIX[op.kind]} {prefix}{y}"
            elif op.kind == "const" or index in self._already_written:
                continue
            elif op.kind == "loop":
                before, inside = self._newton(program.loops[op.number])
                static += before
                dynamic += inside
                continue
            else:
                line = self._pair(index, live) or f"{self.name(index)} = {self._operation(index)}"
            (static if static_ones[index] else dynamic).append(line)
        return static, dynamic

    def _pair(self, index: int, live: Sequence[int]) -> str | None:
        """Write cos and sin of one argument as one call, where the arithmetic has that."""
        op = self.program.ops[index]
        both = next((f for f in ("cos_sin", "sin_cos") if f in self.functions), None)
        names = both.split("_") if both else ()
        if op.kind != "call" or op.function.name not in names:
            return None
        calls = {
            other.function.name: i
            for i in live
            if isinstance(other := self.program.ops[i], Call) and other.args == op.args
        }
        # A combined call pays only where both values are needed.
        if not calls.keys() >= {*names}:
            return None
        self._already_written |= {calls[name] for name in names}
        first, second = (self.name(calls[name]) for name in names)
        return f"{first}, {second} = {both}({self.name(op.args[0])})"

    def inner(self, loop: Loop) -> "Lowering":
        """Return the lowering of an inner loop's program, with a prefix of its own."""
        return Lowering(loop.inner, self.functions, f"n{loop.number}_", self.bits)

    def _newton(self, loop: Loop) -> tuple[list[str], list[str]]:
        """Return the lines before the outer loop, and the inner loop."""
        inner = self.inner(loop)
        static, turn = inner.lines([*loop.updates, *loop.determinants])
        loop_source = newton.Source(
            prefix=f"u{loop.number}_",
            starts=[self.name(index) for index in loop.starts],
            updates=[inner.name(index) for index in loop.updates],
            added_to=[self.name(index) for index in loop.added_to],
            determinants=[inner.name(index) for index in loop.determinants],
            turn=turn,
            guard=self.guard,
        )
        return static, loop_source.lines()

    def function(self, index: int) -> str | None:
        """Return the name of the function that an operation calls, where it calls one."""
        op = self.program.ops[index]
        if op.kind == "root" and self._radicand(op) is None:
            return "sqrt" if op.degree == 2 else "root"
        return op.function.name if op.kind == "call" else None

    def function_names(self, roots: Sequence[int]) -> set[str]:
        """Return the names of all functions that the roots need, including those in inner loops."""
        live = self.live(roots)
        names = {name for index in live if (name := self.function(index))}
        for loop in self.loops(live):
            names |= self.inner(loop).function_names([*loop.updates, *loop.determinants])
        return names

    def solves(self, roots: Sequence[int]) -> bool:
        """Return True if equations are solved for the roots."""
        return bool(self.loops(self.live(roots)))

    def loops(self, live: Sequence[int]) -> list[Loop]:
        """Return the inner loops among live operations, in their order."""
        ops = (self.program.ops[index] for index in live)
        return [self.program.loops[op.number] for op in ops if op.kind == "loop"]

    def _operation(self, index: int) -> str:
        op = self.program.ops[index]
        args = [self.name(a) for a in op.args]
        match op:
            case Input(name):
                return name
            case Pi():
                return "pi"
            case Opposite():
                return f"-{args[0]}"
            case Inverse():
                return f"1 / {args[0]}"
            case Solution((loop,), number):
                solving = self.program.ops[loop]
                assert isinstance(solving, Solving)  # noqa: S101 - what finds it is a loop
                return f"u{solving.number}_{number}"
            case Root() if self._radicand(op) is not None:
                return f"number_{self.name(index)}"
            case Root(_, degree) if degree != 2:
                return f"root({args[0]}, {degree})"
        return f"{self.function(index)}({args[0]})"

    def _radicand(self, op: Root) -> Fraction | None:
        """Return the number whose root this is, where there is one and the arithmetic has no
        function for the root."""
        inner = self.program.ops[op.args[0]]
        if op.degree == 2 or "root" in self.functions or inner.kind != "const":
            return None
        return inner.value if inner.value > 0 else None

    def named_constants(
        self, number: Callable[[Fraction], Number], roots: Sequence[int] | None = None
    ) -> dict[str, Number]:
        """Return the constants, and roots of numbers, as numbers by their names in the source.

        `roots`: those alone that these need.
        """
        program, constants = self.program, dict[str, Number]()
        live = range(len(program.ops)) if roots is None else self.live(roots)
        for index in live:
            op = program.ops[index]
            if op.kind == "const":
                constants[self.name(index)] = number(op.value)
            elif op.kind == "root" and (radicand := self._radicand(op)) is not None:
                root = _root(radicand, op.degree, self.bits + _GUARD)
                constants[f"number_{self.name(index)}"] = number(root)
        for loop in self.loops(live):
            inner_roots = None if roots is None else [*loop.updates, *loop.determinants]
            constants |= self.inner(loop).named_constants(number, inner_roots)
        return constants


def _root(x: Fraction, degree: int, bits: int) -> Fraction:
    """Return x^(1/degree), less than 2^(1 − bits) below it, for x > 0."""
    # iroot rounds down, so the result is below the root by less than one unit of 2^−bits, and the
    # integer division by less than one more.
    scaled = (x.numerator << degree * bits) // x.denominator
    return Fraction(int(gmpy2.iroot(gmpy2.mpz(scaled), degree)[0]), 1 << bits)
