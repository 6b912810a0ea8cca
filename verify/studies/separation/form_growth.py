"""How W_N and the tangent map grow with N, as one run shows it: measured, and not proved.

W_N = Σ_k M_kᵀ S_k M_k, M_k the tangent map of k steps, so that W can grow though no step's S does:
it is a 2-form, and grows as areas do under M, like σ₁σ₂ of M's two greatest singular values, which
is ‖M‖² at most. Where motion is quasi-periodic ‖M‖ grows like N at most; a fit of the envelope of
max |W| over the checkpoints, in logarithms, says whether W stays bounded or grows like N or N². In
chaos ‖M‖ grows exponentially and no power is fitted: what W grows by then is the motion's.

Whether it grew exponentially is told as everywhere (`verify.runs.tangent_growth`), and of an M that
has hardly grown nothing is said.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from verify.prose import prose
from verify.runs.tangent_growth import is_exponential
from verify.studies.separation.growth import LEAST, WIDTH, Envelope, Fit, log, with_error

Law = Literal["bounded", "N", "N²", "exponential", "undecided"]
Kind = Literal["exponential", "polynomial", "undecided"]
_LAWS: tuple[Law, ...] = ("bounded", "N", "N²")
_NEAR = 0.25  # of a whole exponent, at least
_GROWN = 10  # times ‖M‖² has grown where something is said of how
_DECADES = 1.2
_SHORT = "too few checkpoints above noise for a fit"


@dataclass(frozen=True)
class PowerLaw(Fit):
    """That of a greatest size."""

    name: Law


def motion_of(marks: Sequence[int], squares: Sequence[Fraction]) -> Kind:
    """Whether ‖M‖ grew exponentially in this run; from ‖M‖²."""
    if len(marks) < LEAST or max(squares) < _GROWN * squares[0]:
        return "undecided"
    found = is_exponential([float(n) for n in marks], [log(x) / 2 for x in squares])
    return "undecided" if found is None else "exponential" if found else "polynomial"


def power_law(
    marks: Sequence[int], values: Sequence[Fraction], noise: Fraction, motion: Kind
) -> PowerLaw:
    """The law of sizes at equidistant numbers of steps, each known to within `noise`."""
    envelope = Envelope(marks, values, noise)
    if not envelope.tops[-1]:
        return PowerLaw(None, None, "bounded", prose("exactly 0 at every checkpoint"))
    if motion == "exponential":
        return PowerLaw(None, None, "exponential", prose("‖M‖ grows exponentially: no power fits"))
    if not envelope.reaches(_DECADES):
        return PowerLaw(None, None, "undecided", prose(_SHORT))
    exponent, error = envelope.slope()
    width = max(_NEAR, WIDTH * error)
    held = [k for k in range(len(_LAWS)) if abs(exponent - k) <= width]
    name: Law = _LAWS[held[0]] if len(held) == 1 else "undecided"
    near = f" is near {held[0]}" if len(held) == 1 else " is near no whole exponent, or near two"
    shown = with_error(exponent, WIDTH * error)
    return PowerLaw(exponent, error, name, prose("fitted exponent ", *shown, near))
