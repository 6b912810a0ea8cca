"""Explicit Euler: p' = p − h H_q(p, q), q' = q + h H_p(p, q). It is the map of lie1."""

from verify.schemes.methods.taylor.lie import lie_series

ALIASES = ("explicit-euler", "forward-euler")
SCHEME = lie_series(
    "euler", 1, source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2"
)
