"""The time at which each part of a splitting reads its force or its velocity.

The right clock of a kick is advanced by the drifts, that of a drift by the kicks: a kick reads the
force at t + h·(drifts before it), a drift the velocity at t + h·(kicks before it). For then the
step is that of a splitting without time. With times x and y as further coordinates and X, Y their
momenta, H = T(p, y) + X + V(q, x) + Y is a sum of A = V(q, x) + Y, whose flow is the kick and
advances y, and of B = T(p, y) + X, whose flow is the drift and advances x. After the canonical
change (y, Y) → (Y, −y) A is a function of coordinates and B one of momenta. The conditions for
T(p) + V(q) hold in any number of degrees of freedom; so with right clocks every splitting keeps
its order for every H = T(p, t) + V(q, t). Nyström methods, which have theirs for quadratic T alone,
do not where T depends on t: that B is not quadratic in the momenta.

Where the drifts do not add up to 1, the kicks' clock does not reach the step's end. That is no
fault of the clock: the condition Σ drifts = 1 fails, of order 1.
"""

from collections.abc import Sequence

import sympy

from verify.algebra.ring import Poly, Ring

Times = tuple[sympy.Expr | None, ...]  # of the parts, as parts of h; None where it is the right one


def right_clocks(ring: Ring, parts: Sequence[tuple[str, Poly]]) -> list[Poly]:
    """The times that keep the order, of letters K and D with sizes: for each part the sum of the
    other kind's before it."""
    clocks, found = {"K": ring.zero, "D": ring.zero}, []
    for kind, size in parts:
        found.append(clocks[kind])
        other = "D" if kind == "K" else "K"
        clocks[other] = ring.reduce(clocks[other] + size)
    return found
