"""Functions that a flow evaluates, compiled for one field and one arithmetic.

Gragg's modified midpoint rule is one of them. Its loop evaluates the slopes in place and has a
variable for each coordinate, which saves a tenth to a third of the time of a step of several
coordinates.
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
from verify.kernels.step.evaluator import Evaluator
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.operations import StepProgram

Elements = Sequence[tuple[Ring, Poly]]
Function = Callable[..., tuple[Any, ...]]  # numbers of the arithmetic


def functions_at(
    arithmetic: Arithmetic, elements: Elements, names: Sequence[str] = ("p", "q")
) -> Function:
    """Return a function from the values of `names` to those of ring elements in these alone.

    The function must be called inside the arithmetic's context.
    """
    return ElementCode.from_elements(arithmetic, elements, names).build_function()


def defined_values(
    arithmetic: Arithmetic, function: Function, columns: Sequence[Sequence[Any]]
) -> list[Any]:
    """Evaluate a function with one value at points, given as one column for each coordinate.

    The numbers are Fractions, or numbers that gmpy2 can add to its own. A value is None where
    the function is not defined or too large.
    """
    zero = arithmetic.number(Fraction(0))
    try:
        with arithmetic.context():
            values = [
                x for (x,) in map(function, *([x + zero for x in column] for column in columns))
            ]
    except (ArithmeticError, ValueError):  # one point failed: each is tried alone
        points = list(zip(*columns, strict=True))
        if len(points) == 1:
            return [None]
        return [x for z in points for x in defined_values(arithmetic, function, [[x] for x in z])]
    return [x if arithmetic.finite(x) else None for x in values]


def energies_at(
    hamiltonian: Hamiltonian, digits: int, columns: Sequence[Sequence[Any]]
) -> list[Any]:
    """Evaluate H with `digits` digits at points, given as `defined_values` takes them.

    The values are numbers of MPFR, or None where H is not defined or too large.
    """
    return defined_values(*_energy(hamiltonian, digits), columns)


@lru_cache(maxsize=64)
def _energy(hamiltonian: Hamiltonian, digits: int) -> tuple[Arithmetic, Function]:
    """Return the arithmetic and H as a function of the coordinates; runs of one H share both."""
    arithmetic = mpfr.make(digits)
    return arithmetic, functions_at(arithmetic, [energy_of(hamiltonian)], hamiltonian.coordinates)


@dataclass(frozen=True)
class ElementCode:
    """Ring elements in some variables alone, as lines of code in which these are called `names`.

    `static`: the lines before a loop, and `dynamic` those in it. `values`: the names of the
    elements' values. `namespace`: the constants and functions that the lines refer to.
    """

    arithmetic: Arithmetic
    names: Sequence[str]
    static: Sequence[str]
    dynamic: Sequence[str]
    values: Sequence[str]
    namespace: Mapping[str, Any]

    @classmethod
    def from_elements(
        cls, arithmetic: Arithmetic, elements: Elements, names: Sequence[str]
    ) -> "ElementCode":
        program = StepProgram()
        # In the source the variables are z0, z1, …: a user may call a coordinate `v1` or `count`.
        in_source = [name if name == "t" else f"z{k}" for k, name in enumerate(names)]
        inputs = {
            name: program.input(text, static=False)
            for name, text in zip(names, in_source, strict=True)
        }
        roots = [Evaluator(program, ring, inputs, False).evaluate(x) for ring, x in elements]
        lowering = Lowering(program, arithmetic.functions)
        static, dynamic = lowering.lines(roots)
        constants = lowering.named_constants(arithmetic.number)
        values = [lowering.name(root) for root in roots]
        return cls(
            arithmetic, in_source, static, dynamic, values, {**arithmetic.functions, **constants}
        )

    def build_function(self) -> Function:
        """Return a function from z to the values, to be called inside the context."""
        lines = [
            f"def at({', '.join(self.names)}):",
            *_indent(1, [*self.static, *self.dynamic, f"return ({', '.join(self.values)},)", ""]),
        ]
        function: Function = self.arithmetic.compile("\n".join(lines), "at", self.namespace)
        return function

    def build_gragg_rule(self) -> Function:
        """Return a function (z, time, count) ↦ the coordinates after `count` steps in `time`.

        Gragg's smoothing follows the last step. The code's values must be the slopes of the
        coordinates; its names end with t where H depends on it, and each slope is then taken at the
        time of its point. The rule must be called inside the context.
        """
        # t has no slope: where there are more names than values, the last name is the time.
        moves = list(zip(self.names, self.values, strict=False))
        has_time = len(self.names) > len(moves)

        def slope_lines(t: str) -> list[str]:
            return [f"t = {t}", *self.dynamic] if has_time else list(self.dynamic)

        start = [f"{x}_0, {x} = {x}, {x} + h * {dx}" for x, dx in moves]
        onwards = [f"{x}_0, {x} = {x}, {x}_0 + twice * {dx}" for x, dx in moves]
        ends = ", ".join(f"({x} + {x}_0 + h * {dx}) / 2" for x, dx in moves)
        setup = ["h = time / count", "twice = 2 * h", *(["t_0 = t"] if has_time else [])]
        lines = [
            f"def rule({', '.join(self.names)}, time, count):",
            *_indent(1, [*self.static, *setup, *self.dynamic, *start]),
            "    for k in range(1, count):",
            *_indent(2, [*slope_lines("t_0 + k * h"), *onwards]),
            *_indent(1, [*slope_lines("t_0 + time"), f"return ({ends},)", ""]),
        ]
        namespace = {**self.namespace, "range": range}
        rule: Function = self.arithmetic.compile("\n".join(lines), "rule", namespace)
        return rule


def _indent(levels: int, lines: Sequence[str]) -> list[str]:
    return ["    " * levels + line for line in lines]
