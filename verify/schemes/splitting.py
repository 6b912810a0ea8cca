"""Compositions of the two shears of H = T(p) + V(q): kicks p − a h V'(q), drifts q + a h T'(p).

Where H depends on time, each part has a time of its own. By default a kick is made at t + h times
the sum of the drifts before it, and a drift at t + h times the sum of the kicks before it: two
clocks, each of which the other flow advances. So the parts are flows of an autonomous H in two more
degrees of freedom, in which the clocks are coordinates, and the order that the parts have for every
separable H stays. A time that is given is a part of h as well.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import cycle
from typing import Any, TypeAlias

from verify.algebra.ring import Poly
from verify.late import sympy
from verify.schemes.maps.step_algebra import Step, StepAlgebra
from verify.schemes.scheme import Scheme
from verify.schemes.splitting_conditions import LETTERS, Nearby, Part, Splitting

Times: TypeAlias = "tuple[sympy.Expr | None, ...]"  # those that are given, None for one that is not


def splitting(
    name: str,
    parts: Sequence[Part],
    *,
    order: int,
    symmetric: bool,
    source: str,
    times: Times = (),
    nearby: Nearby | None = None,
    nearby_in_time: Nearby | None = None,
) -> Scheme:
    """The scheme that kicks and drifts by these parts of h in turn; every one preserves area.

    `times`: that of each part, in parts of h; left out, the two clocks' own. `nearby`,
    `nearby_in_time`: see `verify.schemes.splitting_conditions.Splitting`.
    """
    own = times if any(x is not None for x in times) else ()
    return Scheme(
        name=name,
        order=order,
        area_preserving=True,
        explicit=True,
        symmetric=symmetric,
        source=source,
        every_h=Splitting(
            tuple(parts), times=tuple(own), nearby=nearby, nearby_in_time=nearby_in_time
        ),
    )


def alternating(first: str, sizes: Iterable[sympy.Expr | Fraction]) -> tuple[Part, ...]:
    """Kicks and drifts in turn, `first` one of them, of these parts of h."""
    kinds = cycle([first, *(kind for kind in LETTERS if kind != first)])
    return tuple(zip(kinds, map(_exact, sizes), strict=False))


def _exact(size: sympy.Expr | Fraction) -> sympy.Expr | Fraction:
    return size if isinstance(size, Fraction) else sympy.sympify(size)


def palindrome(first: str, half: Sequence[sympy.Expr | Fraction]) -> tuple[Part, ...]:
    """As `alternating`, forth and back again; the last of `half` stands once, in the middle."""
    return alternating(first, [*half, *half[-2::-1]])


def composed(first: str, steps: Sequence[sympy.Expr]) -> tuple[Part, ...]:
    """Störmer–Verlet steps of these parts of h, each half a `first`, the other, half a `first`.

    Neighbouring halves are one part.
    """
    inner = [
        size
        for step, after in zip(steps, [*steps[1:], None], strict=True)
        for size in (step, (step + after) / 2 if after is not None else step / 2)
    ]
    return alternating(first, [steps[0] / 2, *inner])


def right_times(parts: Sequence[Part]) -> tuple[sympy.Expr, ...]:
    """The time of each part by the two clocks, in parts of h.

    >>> right_times(alternating("kick", [sympy.Rational(1, 2), sympy.S.One, sympy.Rational(1, 2)]))
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
