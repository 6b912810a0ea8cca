"""Whether an exponential growth of the tangent map is the motion's, or the scheme's at this step.

A scheme may amplify by itself, as lie2 does a harmonic oscillator, by 1 + h⁴/8 a step. What a
scheme does so depends on h; what the motion does, does not. So the run's tangent map is carried
along once more, in float64 beside 20 digits, with half the step size over the same time: where it
grows exponentially there too, at a rate within a factor of 2, the growth is the motion's. That is
measured, and not proved.
"""

from dataclasses import dataclass
from math import log
from typing import Literal

from verify.kernels.stepping import KernelRun
from verify.runs.start import Start
from verify.runs.tangent_growth import finite_time_lyapunov
from verify.studies.separation.form_growth import motion_of
from verify.studies.separation.form_run import POINTS
from verify.studies.separation.links import last_system
from verify.studies.separation.mixed_run import marks_of

_DIGITS = 20
_ALIKE = 2  # rates within this factor of each other

Cause = Literal["motion", "scheme", "undecided"]


@dataclass(frozen=True)
class Halved:
    """Whose the growth is, and the finite-time Lyapunov exponent at half the step size; None where
    that run left its range."""

    cause: Cause
    rate: float | None


def halved(begun: Start, steps: int, rate: float) -> Halved:
    """Of a run whose tangent map grew exponentially at that `rate`."""
    hamiltonian, h = begun.hamiltonian, begun.step_size
    half = {**begun.point, "h": h / 2} | ({"t": begun.t0} if hamiltonian.time_dependent else {})
    run = KernelRun(hamiltonian, begun.scheme, half, 2 * steps, frozenset(), 0, sections=POINTS)
    outcome = run.run(last_system().make(_DIGITS), tangent=True)
    if outcome.done < 2 * steps:
        return Halved("undecided", None)
    tops = [note["growth_top"] for note in outcome.tangents]
    size, time = len(hamiltonian.coordinates), steps * h
    own = finite_time_lyapunov(log(float(tops[-1])) / 2, size, float(time))
    alike = rate < _ALIKE * own and own < _ALIKE * rate
    grows = motion_of(marks_of(2 * steps, POINTS), tops) == "exponential"
    return Halved("motion" if alike and grows else "undecided" if alike else "scheme", own)
