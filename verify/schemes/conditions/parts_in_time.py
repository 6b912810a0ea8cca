"""The step of kicks p − a h V'(q) and drifts q + a h T'(p) in turn, and when each is made.

Where H depends on time, each part has a time of its own. By default a kick is made at t + h times
the sum of the drifts before it, and a drift at t + h times the sum of the kicks before it: two
clocks, each of which the other flow advances. So the parts are flows of an autonomous H in two more
degrees of freedom, in which the clocks are coordinates, and the order that the parts have for every
separable H stays. A time that is given is a part of h as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

from verify.algebra.ring import Poly
from verify.late import sympy
from verify.schemes.conditions.splitting_conditions import LETTERS, Part
from verify.schemes.steps.step_algebra import Step, StepAlgebra

Times: TypeAlias = "tuple[sympy.Expr | None, ...]"  # those that are given, None for one that is not


def right_times(parts: Sequence[Part]) -> tuple[sympy.Expr, ...]:
    """The time of each part by the two clocks, in parts of h.

    >>> half = sympy.Rational(1, 2)
    >>> right_times([("kick", half), ("drift", sympy.S.One), ("kick", half)])
    (0, 1/2, 1)
    """
    return sums_before(parts, own=False)


def sums_before(parts: Sequence[Part], *, own: bool) -> tuple[sympy.Expr, ...]:
    """What the parts of its own kind, or of the other kind, add up to before each."""
    sums, found = dict.fromkeys(LETTERS, sympy.S.Zero), []
    for kind, size in parts:
        (read,) = (each for each in LETTERS if (each == kind) is own)
        found.append(sums[read])
        sums[kind] += size
    return tuple(found)


def all_times(parts: Sequence[Part], given: Times = ()) -> tuple[sympy.Expr, ...]:
    """The time of each part: the one that is given, else that of `right_times`."""
    own = given or (None,) * len(parts)
    both = zip(own, right_times(parts), strict=True)
    return tuple(right if time is None else time for time, right in both)


def shears_step(kinds: Sequence[str], sizes: Sequence[Poly], times: Sequence[Poly]) -> Step:
    """How z' is made: the sizes and times of kicks and drifts in the ring of H's field."""

    def changes(algebra: StepAlgebra[Any]) -> list[Any]:
        n = algebra.size // 2
        moves = {"kick": range(n), "drift": range(n, 2 * n)}
        result = [algebra.nothing] * algebra.size
        for kind, size, time in zip(kinds, sizes, times, strict=True):
            result = algebra.sheared(result, size, time, moves[kind])
        return result

    return changes
