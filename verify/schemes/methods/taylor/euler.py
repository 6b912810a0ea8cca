"""Explicit Euler: p' = p − h H_q(p, q), q' = q + h H_p(p, q). It is the map of lie1."""

from verify.schemes.every_hamiltonian import TaylorSeries
from verify.schemes.methods.taylor.lie import lie_map
from verify.schemes.scheme import Scheme

EXAMPLES = ("euler",)


def make(name: str) -> Scheme | None:
    if name not in EXAMPLES:
        return None
    return Scheme(
        name=name,
        order=1,
        area_preserving=False,
        explicit=True,
        symmetric=False,
        source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2",
        build=lambda hamiltonian: lie_map(hamiltonian, 1),
        every_h=TaylorSeries(1),
    )
