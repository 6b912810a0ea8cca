"""What a flow evaluates, written as functions for a field and an arithmetic.

Gragg's modified midpoint rule is one of them: the slopes stand in its loop and each coordinate is a
variable, which takes a tenth to a third off a step of several coordinates.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from verify.algebra.ring import Poly, Ring
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import mpfr
from verify.hamiltonians.canonical_field import energy_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.program import Evaluator, Program

Elements = Sequence[tuple[Ring, Poly]]
Function = Callable[..., tuple[Any, ...]]  # numbers of the arithmetic


def functions_at(
    arithmetic: Arithmetic, elements: Elements, names: Sequence[str] = ("p", "q")
) -> Function:
    """(p, q) ↦ the values of ring elements in these names alone; call it inside the context."""
    return Written.of(arithmetic, elements, names).at()


def defined_values(own: Arithmetic, at: Function, columns: Sequence[Sequence[Any]]) -> list[Any]:
    """A function's one value at points, given by each coordinate's numbers: Fractions, or what
    gmpy2 adds to its own. None where it has none there, or one too large."""
    zero = own.number(Fraction(0))
    try:
        with own.context():
            found = [x for (x,) in map(at, *([x + zero for x in column] for column in columns))]
    except (ArithmeticError, ValueError):  # at one of them: at which, each says by itself
        points = list(zip(*columns, strict=True))
        if len(points) == 1:
            return [None]
        return [x for z in points for x in defined_values(own, at, [[x] for x in z])]
    return [x if own.finite(x) else None for x in found]


def energies_at(
    hamiltonian: Hamiltonian, digits: int, columns: Sequence[Sequence[Any]]
) -> list[Any]:
    """H to so many digits at points, given by each coordinate's numbers, as `defined_values` has
    them: numbers of MPFR, or None where it is not defined or too large."""
    return defined_values(*_energy(hamiltonian, digits), columns)


@lru_cache(maxsize=64)
def _energy(hamiltonian: Hamiltonian, digits: int) -> tuple[Arithmetic, Function]:
    """What H is evaluated in, and H as a function of the coordinates; runs of one H share it."""
    arithmetic = mpfr.make(digits)
    return arithmetic, functions_at(arithmetic, [energy_of(hamiltonian)], hamiltonian.coordinates)


@dataclass(frozen=True)
class Written:
    """Ring elements in these names alone as lines: those before a loop and in it, what they call
    the values, and what the names in them stand for."""

    arithmetic: Arithmetic
    names: Sequence[str]
    static: Sequence[str]
    dynamic: Sequence[str]
    values: Sequence[str]
    given: Mapping[str, Any]

    @classmethod
    def of(cls, arithmetic: Arithmetic, elements: Elements, names: Sequence[str]) -> "Written":
        program = Program()
        inputs = {name: program.input(name, static=False) for name in names}
        roots = [Evaluator(program, ring, inputs, False).evaluate(x) for ring, x in elements]
        lowering = Lowering(program, arithmetic.functions)
        static, dynamic = lowering.lines(roots)
        constants = lowering.named_constants(arithmetic.number)
        values = [lowering.name(root) for root in roots]
        return cls(
            arithmetic, names, static, dynamic, values, {**arithmetic.functions, **constants}
        )

    def at(self) -> Function:
        """z ↦ the values; call it inside the context."""
        lines = [
            f"def at({', '.join(self.names)}):",
            *_in(1, [*self.static, *self.dynamic, f"return ({', '.join(self.values)},)", ""]),
        ]
        at: Function = self.arithmetic.compile("\n".join(lines), "at", self.given)
        return at

    def gragg_rule(self) -> Function:
        """(z, time, count) ↦ where `count` steps lead in that time, smoothed at the end.

        The values are the coordinates' slopes; the names end with t where H depends on it: then
        each slope is taken at its own time. Call it inside the context.
        """
        moves = list(zip(self.names, self.values, strict=False))
        timed = len(self.names) > len(moves)

        def at(t: str) -> list[str]:
            return [f"t = {t}", *self.dynamic] if timed else list(self.dynamic)

        start = [f"{x}_0, {x} = {x}, {x} + h * {dx}" for x, dx in moves]
        onwards = [f"{x}_0, {x} = {x}, {x}_0 + twice * {dx}" for x, dx in moves]
        ends = ", ".join(f"({x} + {x}_0 + h * {dx}) / 2" for x, dx in moves)
        begun = ["h = time / count", "twice = 2 * h", *(["t_0 = t"] if timed else [])]
        lines = [
            f"def rule({', '.join(self.names)}, time, count):",
            *_in(1, [*self.static, *begun, *self.dynamic, *start]),
            "    for k in range(1, count):",
            *_in(2, [*at("t_0 + k * h"), *onwards]),
            *_in(1, [*at("t_0 + time"), f"return ({ends},)", ""]),
        ]
        given = {**self.given, "range": range}
        rule: Function = self.arithmetic.compile("\n".join(lines), "rule", given)
        return rule


def _in(levels: int, lines: Sequence[str]) -> list[str]:
    return ["    " * levels + line for line in lines]
