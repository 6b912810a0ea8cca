"""Derivatives along the flow of every H, of a coordinate."""

from verify.algebra.series.jets import JetRing, Series
from verify.hamiltonians.jet_flow import JetFlow


def lie_derivatives(jets: JetRing, name: str, most: int) -> Series:
    """[y, X y, …, X^most y] of y = p or q."""
    flow = JetFlow(jets)
    return [flow.power(n)[flow.names.index(name)] for n in range(most + 1)]
