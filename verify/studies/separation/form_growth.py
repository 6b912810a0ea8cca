"""How W_N and the tangent map grow with N, as one run shows it: measured, and not proved.

W_N = Σ_k M_kᵀ S_k M_k, M_k the tangent map of k steps, so that W can grow though no step's S does:
it is a 2-form, and grows as areas do under M, like σ₁σ₂ of M's two greatest singular values, which
is ‖M‖² at most. Where motion is quasi-periodic ‖M‖ grows like N at most; a fit of the envelope of
max |W| over the checkpoints, in logarithms, says whether W stays bounded or grows like N or N². In
chaos ‖M‖ grows exponentially and no power is fitted: what W grows by then is the motion's.

Whether it grew exponentially is told as everywhere (`verify.runs.tangent_growth`), and of an M that
has hardly grown nothing is said.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from verify.arithmetic.arb import slope
from verify.prose import Number, Prose, prose
from verify.runs.tangent_growth import is_exponential
from verify.studies.separation.growth import log, log_spaced
from verify.studies.separation.trail import Trail

Law = Literal["bounded", "N", "N²", "exponential", "undecided"]
Kind = Literal["exponential", "polynomial", "undecided"]
_LAWS: tuple[Law, ...] = ("bounded", "N", "N²")
_NEAR = 0.25  # of a whole exponent, at least
_WIDTH = 2.5  # standard errors, each way
_GROWN = 10  # times ‖M‖² has grown where something is said of how
_FIRST, _LEAST, _MOST = 8, 5, 32  # checkpoints: left out, of a fit at least, and at most
_DECADES = 1.2
_ABOVE = 10  # times the error bound
_SHORT = "too few checkpoints above noise for a fit"


@dataclass(frozen=True)
class PowerLaw:
    """max ~ N^exponent as it was fitted; no exponent where nothing was."""

    exponent: float | None
    standard_error: float | None
    name: Law
    reason: Prose


def motion_of(marks: Sequence[int], squares: Sequence[Fraction]) -> Kind:
    """Whether ‖M‖ grew exponentially in this run; from ‖M‖²."""
    if len(marks) < _LEAST or max(squares) < _GROWN * squares[0]:
        return "undecided"
    found = is_exponential([float(n) for n in marks], [log(x) / 2 for x in squares])
    return "undecided" if found is None else "exponential" if found else "polynomial"


def power_law(
    marks: Sequence[int], values: Sequence[Fraction], noise: Fraction, motion: Kind
) -> PowerLaw:
    """The law of sizes at equidistant numbers of steps, each known to within `noise`."""
    tops = Trail.of(values).envelope()
    if not tops[-1]:
        return PowerLaw(None, None, "bounded", prose("exactly 0 at every checkpoint"))
    if motion == "exponential":
        return PowerLaw(None, None, "exponential", prose("‖M‖ grows exponentially: no power fits"))
    usable = [k for k, x in enumerate(tops) if k + 1 >= _FIRST and x > _ABOVE * noise]
    chosen = log_spaced(usable, [marks[k] for k in usable], _MOST)
    reach = math.log10(marks[chosen[-1]] / marks[chosen[0]]) if chosen else 0.0
    if len(chosen) < _LEAST or reach < _DECADES:
        return PowerLaw(None, None, "undecided", prose(_SHORT))
    found, error = slope([(math.log(marks[k]), log(tops[k])) for k in chosen])
    width = max(_NEAR, _WIDTH * error)
    held = [k for k in range(len(_LAWS)) if abs(found - k) <= width]
    name: Law = _LAWS[held[0]] if len(held) == 1 else "undecided"
    near = f" is near {held[0]}" if len(held) == 1 else " is near no whole exponent, or near two"
    shown = Number(f"{found:.3f}"), " ± ", Number(f"{_WIDTH * error:.3f}")
    return PowerLaw(found, error, name, prose("fitted exponent ", *shown, near))
