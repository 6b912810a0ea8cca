"""How large the inverse of a tangent map may be, from what was noted of it in float64.

For 2 × 2, ‖M⁻¹‖ = ‖M‖/|det M|. In n degrees of freedom M⁻¹ = B⁻¹ MᵀΩ with B = MᵀΩM, which is
antisymmetric: its singular values come in pairs, |Pf B| is the product of one of each, and det M is
Pf B/Pf Ω. So ‖M⁻¹‖ ≤ ‖M‖ ‖B‖ⁿ⁻¹/|det M|, and ‖B‖² is at most the sum of the squares of its entries
above the diagonal. Where the map is nearly symplectic B stays near Ω, however large M grows.
"""

from collections.abc import Mapping

import flint

from verify.kernels.rounding import Ball

_ROUNDED = flint.arb(2) ** -48  # of an entry of MᵀΩM or of det M, relative to ‖M‖²


def least_of(size: int, seen: Mapping[str, Ball]) -> Ball:
    """d > 0 with ‖M‖/‖M⁻¹‖ ≥ d for all M that were carried; at most 0 where there is none."""
    lost = _ROUNDED * seen["growth_top"]
    if size == 2:
        return seen["det_low"] - lost
    n = size // 2
    largest = seen["form_top"].abs_upper().sqrt() * (1 + _ROUNDED)  # entry of the computed B
    terms = flint.arb(1)
    for k in range(1, n + 1):
        terms *= 2 * k - 1  # so many products in a Pfaffian
    # Each product of n entries, computed from entries that are off by `lost`.
    own = (largest + lost) ** n
    apart = terms * (own - largest**n + _ROUNDED * n * own)
    norm = largest + size * lost
    return (seen["det_low"] - apart) / norm ** (n - 1)


def square_of_norm(size: int, squares: Ball, least: Ball) -> Ball:
    """A bound of ‖M‖², from those of the sum of its entries' squares and of its determinant; or one
    of the mean of ‖M‖² over several M, from that of those sums."""
    if size > 2:
        return squares.abs_upper()
    return ((squares + (squares * squares - 4 * least * least).abs_upper().sqrt()) / 2).abs_upper()
