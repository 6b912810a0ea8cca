"""Homogeneous maps, and the fields of quadratic Hamiltonians, under which linear stays linear."""

from verify.claims.theorems.checks.check import Check, vanishes
from verify.claims.theorems.checks.differential import Differential, Flow


def euler(power: int = 2) -> Check:
    """d/ds [Φ(sz)/s] = [J(sz) sz − Φ(sz)]/s² for a generic Φ; `power` stands for the 2."""
    names = ["u", "s", "F", "F_p", "F_q", "p", "q"]
    ring = Differential(names)
    u, s, f, f_p, f_q, p, q = (ring[name] for name in names)
    ring.relate(u * s - 1)  # u = 1/s
    ring.set_gradient("s", s=ring.context.constant(1))
    ring.set_gradient("u", s=-u * u)
    ring.set_gradient("F", s=f_p * p + f_q * q)
    right = (f_p * s * p + f_q * s * q - f) * u**power
    return vanishes(
        "d/ds [Φ(sz)/s] − [J(sz) sz − Φ(sz)]/s² for a component of a generic Φ",
        ring.reduce(ring.diff(f * u, "s") - right),
    )


def stays_linear(bent: int = 0) -> Check:
    """X y is linear where y is and H is a quadratic form; `bent` p² is added to y."""
    names = ["p", "q", "a", "b", "c", "alpha", "beta"]
    ring = Differential(names)
    p, q, a, b, c, alpha, beta = (ring[name] for name in names)
    ring.set_gradient("p", p=ring.context.constant(1), q=ring.zero)
    ring.set_gradient("q", p=ring.zero, q=ring.context.constant(1))
    flow = Flow(ring, a * p + b * q, b * p + c * q)
    along = flow.derive(alpha * p + beta * q + bent * p * p)
    linear = (a * beta - b * alpha) * p + (b * beta - c * alpha) * q
    return vanishes(
        "X(αp + βq) − (aβ − bα)p − (bβ − cα)q for H = a p²/2 + b pq + c q²/2", along - linear
    )
