"""LaTeX: exact equations; decimals of the irrational constants stand in comments."""

from collections.abc import Iterator

import sympy

from verify.algebra.formula import symbol
from verify.effort import MAX_CALLS, limit_effort
from verify.schemes.export.program import Program

SUFFIX = ".tex"
RESERVED: frozenset[str] = frozenset()


def render(program: Program) -> str:
    """Return an `align*` environment, of amsmath: the parts, J and ΔJ."""
    comments = [f"% {line}" for line in program.head()[:2]]
    irrational = [c.comment for c in program.constants if c.enclosure]
    comments += [f"% {comment.removesuffix(', rounded to nearest')}" for comment in irrational]
    rows = [*_steps(program)]
    if len(program.parts) == 1:
        (pair,), state = program.parts, list(map(symbol, program.coordinates))
        with limit_effort("map", program.scheme, "to write its Jacobian", 10 * MAX_CALLS):
            entries = [sympy.factor_terms(x.diff(y)) for x in pair for y in state]
        matrix = sympy.Matrix(len(state), len(state), entries)
        rows.append(rf"J &= {sympy.latex(matrix)}")
    if program.delta_j is not None:
        rows.append(rf"\Delta J &= {sympy.latex(program.delta_j)}")
    body = " \\\\\n".join(f"  {row}" for row in rows)
    return "\n".join([*comments, r"\begin{align*}", body, r"\end{align*}"]) + "\n"


def _steps(program: Program) -> Iterator[str]:
    """Yield the equations of p_1, q_1, p_2, …, part by part; the last of each is p' or q'."""
    names = {symbol(name): _name(name) for name in program.coordinates}
    changes = {z: sum(pair[n] != z for pair in program.parts) for n, z in enumerate(names)}
    now, counts = {z: z for z in names}, dict.fromkeys(names, 0)
    for pair in program.parts:
        after = dict(now)
        for z, x in zip(names, pair, strict=True):
            if x == z and changes[z]:
                continue
            counts[z] += 1
            number = names[z].partition("_")[2].strip("{}")  # p_1 in the second part is p_{1,2}
            index = f"{number},{counts[z]}" if number else str(counts[z])
            last = counts[z] >= changes[z]
            mark = "'" if last else f"_{{{index}}}"
            base = names[z] if last else names[z].partition("_")[0]
            yield rf"{base}{mark} &= {sympy.latex(x.xreplace(now))}"
            after[z] = sympy.Symbol(f"{base}{mark}", real=True)
        now = after


def _name(coordinate: str) -> str:
    letter, number = coordinate[0], coordinate[1:]
    return f"{letter}_{{{number}}}" if number else letter
