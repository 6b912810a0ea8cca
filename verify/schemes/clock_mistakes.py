"""Which mistake the times of a splitting's parts look like."""

from collections.abc import Callable, Sequence

import sympy

from verify.schemes.splitting_conditions import LETTERS, Part

Clock = Callable[[sympy.Expr, sympy.Expr], sympy.Expr]  # sums of both kinds before ↦ the time

_HALF = sympy.Rational(1, 2)
# What is read in each part, by the sums of its own kind and of the other one before it.
_CLOCKS: dict[str, Clock] = {
    "as if the force were read at t in every part": lambda own, other: sympy.S.Zero,
    "as if the force were read at t + h in every part": lambda own, other: sympy.S.One,
    "as if the force were read at t + h/2 in every part": lambda own, other: _HALF,
    "as if each part read its own clock, and not that of the other flow": lambda own, other: own,
}


def mistake(parts: Sequence[Part], times: Sequence[sympy.Expr]) -> str:
    """What the kicks' times look like, in words; "" where they are right, or like nothing known.

    The drifts' are of no matter where T does not depend on time, and may be anything.

    >>> half = sympy.Rational(1, 2)
    >>> verlet = [("kick", half), ("drift", sympy.S.One), ("kick", half)]
    >>> mistake(verlet, (0, 0, 0)), mistake(verlet, (0, half, 1))
    ('as if the force were read at t in every part', '')
    """
    sums = dict.fromkeys(LETTERS, sympy.S.Zero)
    before: list[tuple[sympy.Expr, sympy.Expr, sympy.Expr]] = []
    for (kind, size), time in zip(parts, times, strict=True):
        if kind == "kick":
            before.append((sums["kick"], sums["drift"], sympy.sympify(time)))
        sums[kind] += size
    if all(time == other for _, other, time in before):
        return ""
    for words, clock in _CLOCKS.items():
        if all(sympy.simplify(time - clock(own, other)) == 0 for own, other, time in before):
            return words
    return ""
