"""The growth of a run's tangent map M, its consequence for W = MᵀΩM − Ω, and its cause.

A scheme may amplify by itself, as lie2 does a harmonic oscillator, by 1 + h⁴/8 a step. The growth
that a scheme causes depends on h; the growth that the motion causes does not. So the run is done
once more with half the step size over the same time, and its tangent map is carried along, the
states with 20 digits and M in float64. If M grows exponentially there too, at a rate within a
factor of 2, the growth is the motion's. This is measured, and not proved.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt, log10
from typing import Literal

from verify.arithmetic.exact import decimal, magnitude, text
from verify.kernels.stepping import KernelRun
from verify.prose import Number, Prose, prose
from verify.runs.run_start import Start
from verify.runs.tangent_growth import finite_time_lyapunov
from verify.scenes.results.separation_parts import PowerLawResult, TangentGrowth
from verify.studies.separation.growth_fits import Motion, PowerLaw, classify_motion, fit_power_law
from verify.studies.separation.links import last_system
from verify.studies.separation.matrix_products import POINTS
from verify.studies.separation.mixed_run import marks_of
from verify.studies.separation.result import SHOWN, Split
from verify.studies.separation.way import Size

_DIGITS = 20
_RATE_FACTOR = 2  # rates within this factor of each other count as equal
_CONSEQUENCE_FOR_W = (
    "; W adds MᵀSM at every step, S of that step and M the tangent map so far, and so grows as "
    "areas do under M, at most like ‖M‖²"
)
Cause = Literal["motion", "scheme", "undecided"]
_CAUSE_TEXTS: dict[Cause, str] = {
    "motion": ": that growth is the motion's, not the scheme's",
    "scheme": ": that growth is the scheme's at this step size",
    "undecided": ": whether that growth is the motion's or the scheme's is not decided",
}


@dataclass(frozen=True)
class HalfStep:
    """The cause of the growth, and the finite-time Lyapunov exponent at half the step size.

    The exponent is None if that run left its range.
    """

    cause: Cause
    rate: float | None


def repeat_with_half_step(start: Start, steps: int, rate: float) -> HalfStep:
    """Repeat a run whose tangent map grew exponentially at that `rate`, with half the step size."""
    hamiltonian, h = start.hamiltonian, start.step_size
    half = {**start.point, "h": h / 2} | ({"t": start.t0} if hamiltonian.time_dependent else {})
    # Twice the steps of half the size cover the same time.
    run = KernelRun(hamiltonian, start.scheme, half, 2 * steps, frozenset(), 0, sections=POINTS)
    outcome = run.run(last_system().make(_DIGITS), tangent=True)
    if outcome.done < 2 * steps:
        return HalfStep("undecided", None)
    tops = [note["growth_top"] for note in outcome.tangents]
    size, time = len(hamiltonian.coordinates), steps * h
    halved_rate = finite_time_lyapunov(math.log(float(tops[-1])) / 2, size, float(time))
    # A rate that belongs to the motion does not depend on h.
    alike = rate < _RATE_FACTOR * halved_rate and halved_rate < _RATE_FACTOR * rate
    grows = classify_motion(marks_of(2 * steps, POINTS), tops) == "exponential"
    return HalfStep(
        "motion" if alike and grows else "undecided" if alike else "scheme", halved_rate
    )


def tangent_growth(split: Split, sizes: Sequence[Size], start: Start, steps: int) -> TangentGrowth:
    """Return the growth of M and its consequence for W; `split`: W by the closed form."""
    marks, last, time = split.marks, sizes[-1], start.step_size * steps
    squares, areas = [x.norm for x in sizes], [_root(x.areas) for x in sizes]
    motion = classify_motion(marks, squares)
    norm, count = float(_root(last.norm)), len(start.hamiltonian.coordinates)
    rate = finite_time_lyapunov(math.log(norm), count, float(time))
    half = repeat_with_half_step(start, steps, rate) if motion == "exponential" else None
    law, law_of_areas = (
        fit_power_law(marks, values, Fraction(0), motion) for values in (squares, areas)
    )
    truncation = split.tops["truncation"]
    law_of_w = (
        fit_power_law(marks, truncation, split.noise["truncation"], motion)
        if any(truncation)
        else None
    )
    if half:
        times = f"{log10(last.norm / sizes[0].norm):.1f}"
        meaning = _describe_exponential(times, rate, half, law_of_w is None)
    else:
        meaning = _describe_power(law_of_w, law, motion)
    return TangentGrowth(
        norm_squared=decimal(last.norm, SHOWN),
        areas=decimal(areas[-1], SHOWN),
        time=text(time),
        finite_time_lyapunov=_short(rate),
        motion=motion,
        cause=half.cause if half else None,
        at_half_step=_short(half.rate) if half and half.rate is not None else None,
        law=PowerLawResult(**law.fields),
        law_of_areas=PowerLawResult(**law_of_areas.fields),
        per_area=decimal(truncation[-1] / areas[-1], 3),
        meaning=meaning,
    )


def _describe_exponential(times: str, rate: float, half: HalfStep, vanishes: bool) -> Prose:
    """Describe a growth of ‖M‖² by 10^`times`; `vanishes`: S ≡ 0."""
    growth = prose(
        "‖M‖² grew exponentially, 10^", Number(times), "-fold, at a finite-time Lyapunov ",
        "exponent of ", Number(_short(rate)), " per unit of time",
    )  # fmt: skip
    if vanishes:
        return prose(growth, "; S ≡ 0 is proved, so that all of W is rounding, which M magnifies")
    half_step = prose(", and with half the step size the orbit leaves the range")
    if half.rate is not None:
        half_step = prose(", and of ", Number(_short(half.rate)), " with half the step size")
    return prose(growth, half_step, _CONSEQUENCE_FOR_W, _CAUSE_TEXTS[half.cause])


def _describe_power(law_of_w: PowerLaw | None, law: PowerLaw, motion: Motion) -> Prose:
    """Describe other growth by the laws of max |W|, None for S ≡ 0, and of ‖M‖²."""
    if law_of_w is None:
        return prose("W is exactly 0 in exact arithmetic: S ≡ 0")
    if law_of_w.exponent is None or law.exponent is None:
        return prose("how W grows with N is not measured: ", law_of_w.reason)
    words = {"bounded": "is bounded", "undecided": "follows no whole power"}
    law_text = words.get(law_of_w.name, f"grows like {law_of_w.name}")
    evidence = " (measured, not proved)"
    if motion == "polynomial":
        evidence += "; ‖M‖ does not grow exponentially"
    return prose(f"max |W| {law_text} in this run, with a fitted exponent of ",
                 Number(f"{law_of_w.exponent:.2f}"), "; ‖M‖² that of ",
                 Number(f"{law.exponent:.2f}"), evidence)  # fmt: skip


def _short(x: float) -> str:
    return f"{x:.4g}"


def _root(x: Fraction) -> Fraction:
    """Return √x to some twelve digits, however large or small x is."""
    # 24 significant digits under the root leave 12 in it.
    digits = max(0, 24 - magnitude(x)) if x else 0
    return Fraction(isqrt(int(x * 10 ** (2 * digits))), 10**digits)
