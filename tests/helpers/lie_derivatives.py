"""Derivatives along the flow of every H in the plane."""

from verify.algebra.jets import Jets, Poly, Series
from verify.hamiltonians.canonical_field import JetField


def lie_derivatives(jets: Jets, name: str, most: int) -> Series:
    """[y, X y, …, X^most y] of y = p or q."""
    flow = JetField(jets)
    return [flow.power(n)[flow.names.index(name)] for n in range(most + 1)]


def along_flow(jets: Jets, x: Poly) -> Poly:
    """X x, or D x where H depends on time."""
    along = jets.h(1, 0) * jets.diff(x, "q") - jets.h(0, 1) * jets.diff(x, "p")
    return along + jets.diff(x, "t") if jets.timed else along
