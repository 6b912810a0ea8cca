"""Schemes of kicks and drifts in turn, p − a h V'(q) and q + a h T'(p), for H = T(p) + V(q)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import cycle

from verify.lazy_sympy import sympy
from verify.schemes.conditions.splitting_conditions import (
    LETTERS,
    Nearby,
    Part,
    Splitting,
    Times,
)
from verify.schemes.scheme import Scheme


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
    """Return the scheme of these kicks and drifts; every such scheme preserves area.

    `times`: the time of each part, in parts of h; the right times if left out. `nearby`,
    `nearby_in_time`: see `verify.schemes.conditions.splitting_conditions.Splitting`.
    """
    clock_times = times if any(x is not None for x in times) else ()
    return Scheme(
        name=name,
        order=order,
        area_preserving=True,
        symmetric=symmetric,
        source=source,
        every_h=Splitting(
            tuple(parts), times=tuple(clock_times), nearby=nearby, nearby_in_time=nearby_in_time
        ),
    )


def alternating(first: str, sizes: Iterable[sympy.Expr | Fraction]) -> tuple[Part, ...]:
    """Return kicks and drifts in turn with these sizes, beginning with a `first`."""
    kinds = cycle([first, *(kind for kind in LETTERS if kind != first)])
    return tuple(zip(kinds, map(_exact, sizes), strict=False))


def _exact(size: sympy.Expr | Fraction) -> sympy.Expr | Fraction:
    return size if isinstance(size, Fraction) else sympy.sympify(size)


def palindrome(first: str, half: Sequence[sympy.Expr | Fraction]) -> tuple[Part, ...]:
    """Return the palindrome of kicks and drifts whose first half, with the middle, is `half`."""
    return alternating(first, [*half, *half[-2::-1]])


def compose(first: str, steps: Sequence[sympy.Expr]) -> tuple[Part, ...]:
    """Return the composition of Störmer–Verlet steps of these sizes.

    Each step is half a `first`, a part of the other kind, and half a `first`.
    """
    # The half parts between steps a and b are of one kind, and make one part (a + b)/2.
    inner = [
        size
        for step, after in zip(steps, [*steps[1:], None], strict=True)
        for size in (step, (step + after) / 2 if after is not None else step / 2)
    ]
    return alternating(first, [steps[0] / 2, *inner])
