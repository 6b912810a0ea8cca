"""A user's own Runge–Kutta method, by Butcher's tableau: `0 |; 1/2 | 1/2; | 0 1; order 2`.

Rows are parted by `;`: the time of a stage, a bar, and its entries, up to the diagonal or all of
them; the row of weights has nothing before its bar. Entries are exact: decimals, quotients, `sqrt`
and powers. `order` is the claimed order, 1 if left out.
"""

from collections.abc import Sequence
from fractions import Fraction

import sympy

from verify.algebra.formula import parse
from verify.errors import InputError
from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.methods.user.splitting import order_of
from verify.schemes.scheme import Scheme

EXAMPLES = ()  # names are texts that users write
_MOST_STAGES = 20
_FORM = "write it as '0 |; 1/2 | 1/2; | 0 1; order 2', the weights last"


def make(name: str) -> Scheme | None:
    """Return the scheme for a text with bars; None for another text. InputError for a bad one."""
    if "|" not in name or "=" in name:
        return None
    lines = [line.strip() for line in name.split(";") if line.strip()]
    order = order_of(name, lines.pop().removeprefix("order")) if "|" not in lines[-1] else 1
    rows = [tuple(part.split() for part in line.split("|")) for line in lines]
    count = len(rows) - 1
    if not 1 <= count <= _MOST_STAGES or any(len(row) != 2 for row in rows):
        raise InputError("scheme", name, _FORM)
    times, entries = zip(*rows, strict=True)
    has_times = [len(x) == 1 for x in times]
    if has_times != [True] * count + [False] or times[-1] or len(entries[-1]) != count:
        raise InputError("scheme", name, _FORM)
    matrix = [_fill(name, row, k, count) for k, row in enumerate(entries[:-1])]
    numbers = [[parse(x, (), source="scheme") for x in row] for row in (*matrix, entries[-1])]
    clock = [parse(x, (), source="scheme") for (x,) in times[:-1]]
    return _scheme("; ".join(" ".join(line.split()) for line in lines), numbers, clock, order)


def _fill(name: str, row: Sequence[str], k: int, count: int) -> list[str]:
    if len(row) not in (k, k + 1, count):
        problem = f"stage {k + 1} has {len(row)} entries; allowed: {k}, {k + 1} or {count}"
        raise InputError("scheme", name, problem)
    return [*row, *["0"] * (count - len(row))]


def _scheme(
    text: str, numbers: Sequence[Sequence[sympy.Expr]], clock: Sequence[sympy.Expr], order: int
) -> Scheme:
    *matrix, weights = numbers
    for row, total in [*zip(matrix, clock, strict=True), (weights, sympy.S.One)]:
        if sympy.simplify(sympy.Add(*row) - total) != 0:
            problem = f"{' + '.join(map(str, row))} is {sympy.Add(*row)}, not {total}"
            rule = "a row adds up to its time, the weights to 1"
            raise InputError("scheme", text, f"{problem}; {rule}")
    count = len(weights)
    explicit = all(matrix[i][j] == 0 for i in range(count) for j in range(i, count))
    every_h: RungeKutta | TreeConditions
    if explicit and all(x.is_Rational for row in numbers for x in row):
        rows = tuple(tuple(map(_fraction, row[:k])) for k, row in enumerate(matrix))
        every_h = RungeKutta(rows, tuple(map(_fraction, weights)))
    else:
        every_h = TreeConditions(ImplicitTableau.from_numbers(matrix, weights))
    text = text if order == 1 else f"{text}; order {order}"
    return Scheme(
        text, order=order, explicit=explicit, every_h=every_h, source="the user's tableau"
    )


def _fraction(x: sympy.Rational) -> Fraction:
    return Fraction(int(x.p), int(x.q))
