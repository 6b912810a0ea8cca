"""Gragg's modified midpoint rule as one function, written for a field and an arithmetic.

The slopes stand in its loop and each coordinate is a variable, which halves the time of a step of
several coordinates; in the plane `verify.flows.extrapolation` calls them and loses little.
"""

from collections.abc import Callable, Sequence

from verify.algebra.ring import Poly, Ring
from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.program import Evaluator, Program

Rule = Callable[..., tuple[Number, ...]]


def gragg_rule(
    arithmetic: Arithmetic, slopes: Sequence[tuple[Ring, Poly]], names: Sequence[str]
) -> Rule:
    """(z, h, count) ↦ where `count` steps of h lead, smoothed at the end.

    `slopes`: those of the coordinates, in these names, which end with t where H depends on it.
    Call it inside the context.
    """
    program = Program()
    inputs = {name: program.input(name, static=False) for name in names}
    roots = [Evaluator(program, ring, inputs, False).evaluate(x) for ring, x in slopes]
    lowering = Lowering(program, arithmetic.functions)
    static, dynamic = lowering.lines(roots)
    moves = [(name, lowering.name(root)) for name, root in zip(names, roots, strict=False)]
    timed = len(names) > len(moves)

    def at(k: str) -> list[str]:
        return [f"t = t_0 + {k} * h", *dynamic] if timed else dynamic

    start = [f"{x}_0, {x} = {x}, {x} + h * {dx}" for x, dx in moves]
    onwards = [f"{x}_0, {x} = {x}, {x}_0 + twice * {dx}" for x, dx in moves]
    values = ", ".join(f"({x} + {x}_0 + h * {dx}) / 2" for x, dx in moves)
    lines = [
        f"def rule({', '.join(names)}, h, count):",
        *_in(1, [*static, "twice = 2 * h", *(["t_0 = t"] if timed else []), *dynamic, *start]),
        "    for k in range(1, count):",
        *_in(2, [*at("k"), *onwards]),
        *_in(1, [*at("count"), f"return ({values},)", ""]),
    ]
    constants = lowering.named_constants(arithmetic.number)
    given = {**arithmetic.functions, **constants, "range": range}
    rule: Rule = arithmetic.compile("\n".join(lines), "rule", given)
    return rule


def _in(levels: int, lines: Sequence[str]) -> list[str]:
    return ["    " * levels + line for line in lines]
