"""The way back: the distance of ρΦᴺρΦᴺ(z₀) from z₀, of N steps, turned, N steps, turned.

ρ is given by a formula for each coordinate, in their order; `-h` in its place means N steps of −h.
It takes a second run, so that no loop carries it.
"""

from verify.observables.observable import Observable, never


def member(formulas: str) -> Observable:
    """Return the observable of a reflection ρ, or of steps of −h."""
    by_step = formulas == "-h"
    return Observable(
        f"way_back: {formulas}",
        "way back by −h" if by_step else f"way back, ρ = ({formulas})",
        r"|\Phi_{-h}^N\Phi_h^N z_0 - z_0|" if by_step else r"|\rho\Phi^N\rho\Phi^N z_0 - z_0|",
        order=12,
        needs=None,
        lines=lambda loop: [],
        carried="",
        vanishes=never,
    )
