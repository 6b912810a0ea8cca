"""Explicit and implicit Runge–Kutta schemes by their coefficients."""

from verify.schemes.conditions.condition import ByConditions
from verify.schemes.conditions.every_hamiltonian import BySeries, RungeKutta
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.maps.kinds.implicit_runge_kutta import implicit_map
from verify.schemes.scheme import Scheme


def explicit(name: str, tableau: RungeKutta, *, order: int, source: str) -> Scheme:
    """The scheme of these coefficients, for any H."""
    return Scheme(
        name=name,
        order=order,
        area_preserving=False,
        explicit=True,
        symmetric=False,
        source=source,
        every_h=tableau,
    )


def implicit(
    name: str,
    tableau: ImplicitTableau,
    every_h: BySeries | ByConditions,
    *,
    order: int,
    source: str,
) -> Scheme:
    """The scheme of these coefficients, those of a Gauss method: symmetric, and of det J ≡ 1."""
    return Scheme(
        name=name,
        order=order,
        area_preserving=True,
        explicit=False,
        symmetric=True,
        source=source,
        build=lambda hamiltonian: implicit_map(hamiltonian, tableau),
        every_h=every_h,
    )
