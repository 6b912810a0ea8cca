"""The way back: the distance of ρΦᴺρΦᴺ(z₀) from z₀, of N steps, turned, N steps, turned.

ρ is given by a formula for each coordinate, in their order. It takes a second run, so that no loop
carries it.
"""

from verify.observables.observable import Observable, never


def member(formulas: str) -> Observable:
    """Return the observable of a reflection ρ."""
    return Observable(
        f"way_back: {formulas}",
        f"way back, ρ = ({formulas})",
        r"|\rho\Phi^N\rho\Phi^N z_0 - z_0|",
        order=12,
        needs=None,
        lines=lambda loop: [],
        carried="",
        vanishes=never,
    )
