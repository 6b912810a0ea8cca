"""What chains of W's entries become in a result: matrices, greatest entries, and how W grew.

Whether an exponential growth of the tangent map is the motion's, or the scheme's at this step.

A scheme may amplify by itself, as lie2 does a harmonic oscillator, by 1 + h⁴/8 a step. What a
scheme does so depends on h; what the motion does, does not. So the run's tangent map is carried
along once more, in float64 beside 20 digits, with half the step size over the same time: where it
grows exponentially there too, at a rate within a factor of 2, the growth is the motion's. That is
measured, and not proved.

How W_N and the tangent map grow with N, as one run shows it: measured, and not proved.

W_N = Σ_k M_kᵀ S_k M_k, M_k the tangent map of k steps, so that W can grow though no step's S does:
it is a 2-form, and grows as areas do under M, like σ₁σ₂ of M's two greatest singular values, which
is ‖M‖² at most. Where motion is quasi-periodic ‖M‖ grows like N at most; a fit of the envelope of
max |W| over the checkpoints, in logarithms, says whether W stays bounded or grows like N or N². In
chaos ‖M‖ grows exponentially and no power is fitted: what W grows by then is the motion's.

Whether it grew exponentially is told as everywhere (`verify.runs.tangent_growth`), and of an M that
has hardly grown nothing is said.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import isqrt, log10
from typing import Any, Literal

from verify.arithmetic.exact import decimal, magnitude, text
from verify.kernels.stepping import KernelRun
from verify.prose import Number, Prose, prose
from verify.runs.start import Start
from verify.runs.tangent_growth import finite_time_lyapunov, is_exponential
from verify.scenes.results.separation_in_degrees import (
    FormAt,
    FormEvaluation,
    FormParts,
    FormPartsInTime,
    FormValue,
    PowerLawResult,
    TangentGrowth,
)
from verify.studies.separation.chain import Chain
from verify.studies.separation.form_chain import FormChains
from verify.studies.separation.form_run import POINTS, Size
from verify.studies.separation.growth import LEAST, WIDTH, Envelope, Fit, log, with_error
from verify.studies.separation.links import last_system
from verify.studies.separation.mixed_run import marks_of
from verify.studies.separation.way import Way

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
    own = finite_time_lyapunov(math.log(float(tops[-1])) / 2, size, float(time))
    alike = rate < _ALIKE * own and own < _ALIKE * rate
    grows = motion_of(marks_of(2 * steps, POINTS), tops) == "exponential"
    return Halved("motion" if alike and grows else "undecided" if alike else "scheme", own)


_SHOWN = 7  # digits of what a figure shows
_SO_W = (
    "; W adds MᵀSM at every step, S of that step and M the tangent map so far, and so grows as "
    "areas do under M, at most like ‖M‖²"
)
_WHOSE: dict[Cause, str] = {
    "motion": ": that growth is the motion's, not the scheme's",
    "scheme": ": that growth is the scheme's at this step size",
    "undecided": ": whether that growth is the motion's or the scheme's is not decided",
}


class FormWay(Way):
    """All entries of W for one way to evaluate it, and how M moved."""

    def __init__(self, chains: Sequence[Chain], sizes: Sequence[Size], motion: Kind) -> None:
        super().__init__(chains)
        self.sizes, self.motion = sizes, motion

    def evaluation(self, digits: int) -> FormEvaluation:
        """As results have it."""
        size, entries = _size(len(self.chains)), self.values(digits)
        parts = {_named(name): FormValue.of(each, size) for name, each in entries.items()}
        return FormEvaluation(
            parts=FormPartsInTime(**parts) if "clock" in parts else FormParts(**parts),
            largest=self.largest,
            growth=self.growth,
            law=self.law("lambda_working"),
            series=tuple(
                FormAt(
                    steps=self.marks[k],
                    norm_squared=decimal(self.sizes[k].norm, _SHOWN),
                    parts={_named(name): text for name, text in texts.items()},
                )
                for k, texts in self.series()
            ),
            error_kind=self.kind,
        )

    def law(self, name: str) -> PowerLawResult:
        """How the greatest entry of a quantity grows with N."""
        law = power_law(self.marks, self.tops[name], self.noise[name], self.motion)
        return PowerLawResult(**law.fields)

    def tangent(self, time: Fraction, half: Callable[[float], Halved]) -> TangentGrowth:
        """How M grew, and what follows for W; `half` tells of an exponential rate whose it is."""
        last, size = self.sizes[-1], _size(len(self.chains))
        rate = finite_time_lyapunov(math.log(float(_root(last.norm))), size, float(time))
        halved = half(rate) if self.motion == "exponential" else None
        areas = [_root(x.areas) for x in self.sizes]
        laws = [
            power_law(self.marks, each, Fraction(0), self.motion)
            for each in ([x.norm for x in self.sizes], areas)
        ]
        return TangentGrowth(
            norm_squared=decimal(last.norm, _SHOWN),
            areas=decimal(areas[-1], _SHOWN),
            time=text(time),
            finite_time_lyapunov=_short(rate),
            motion=self.motion,
            cause=halved.cause if halved else None,
            at_half_step=_short(halved.rate) if halved and halved.rate is not None else None,
            law=PowerLawResult(**laws[0].fields),
            law_of_areas=PowerLawResult(**laws[1].fields),
            per_area=decimal(self.tops["truncation"][-1] / areas[-1], 3),
            meaning=self._exponential(rate, halved) if halved else self._power(laws[0]),
        )

    def _exponential(self, rate: float, halved: Halved) -> Prose:
        times = Number(f"{log10(self.sizes[-1].norm / self.sizes[0].norm):.1f}")
        own = prose("‖M‖² grew exponentially, 10^", times, "-fold, at a finite-time Lyapunov ",
                    "exponent of ", Number(_short(rate)), " per unit of time")  # fmt: skip
        if not any(self.tops["truncation"]):
            return prose(own, "; S ≡ 0 is proved, so that all of W is rounding, which M magnifies")
        again = prose(", and with half the step size the orbit leaves the range")
        if halved.rate is not None:
            again = prose(", and of ", Number(_short(halved.rate)), " with half the step size")
        return prose(own, again, _SO_W, _WHOSE[halved.cause])

    def _power(self, law: PowerLaw) -> Prose:
        if not any(self.tops["truncation"]):
            return prose("W is exactly 0 in exact arithmetic: S ≡ 0")
        tops, noise = self.tops["truncation"], self.noise["truncation"]
        own = power_law(self.marks, tops, noise, self.motion)
        if own.exponent is None or law.exponent is None:
            return prose("how W grows with N is not measured: ", own.reason)
        words = {"bounded": "is bounded", "undecided": "follows no whole power"}
        said = words.get(own.name, f"grows like {own.name}")
        measured = " (measured, not proved)"
        if self.motion == "polynomial":
            measured += "; ‖M‖ does not grow exponentially"
        return prose(f"max |W| {said} in this run, with a fitted exponent of ",
                     Number(f"{own.exponent:.2f}"), "; ‖M‖² that of ",
                     Number(f"{law.exponent:.2f}"), measured)  # fmt: skip


def split_in_degrees(chains: FormChains, begun: Start, steps: int, digits: int) -> dict[str, Any]:
    """What the each of W give of a result."""
    motion = motion_of(chains.marks, [x.norm for x in chains.sizes])
    plain, closed = (
        FormWay(each, chains.sizes, motion) for each in (chains.plain, chains.closed_form)
    )
    half = partial(halved, begun, steps)
    methods = dict.fromkeys(x for chain in chains.plain for x in chain.methods)
    return {
        "arithmetic": chains.arithmetic,
        "plain": plain.evaluation(digits),
        "closed_form": closed.evaluation(digits),
        "tangent": closed.tangent(begun.step_size * steps, half),
        "error_method": "; ".join(methods),
        "seconds": chains.seconds,
    }


def _short(x: float) -> str:
    return f"{x:.4g}"


def _named(name: str) -> str:
    return "w_working" if name == "lambda_working" else name


def _root(x: Fraction) -> Fraction:
    """√x to some twelve digits, of any size."""
    digits = max(0, 24 - magnitude(x)) if x else 0
    return Fraction(isqrt(int(x * 10 ** (2 * digits))), 10**digits)


def _size(entries: int) -> int:
    """The rows of an antisymmetric matrix with so many entries above its diagonal."""
    size = 2
    while size * (size - 1) // 2 < entries:
        size += 2
    return size
