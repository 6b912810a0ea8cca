"""How bad a scene is for float64, or for its scheme: what worst-case hunting makes as large as can.

Each is a decimal logarithm, None where the scene has none: its orbit leaves a bounded part of the
plane, or what is divided, or what it is divided by, is 0 or of no known digit.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import magnitude
from verify.exploration.sample import Sample
from verify.kernels.stepping import Outcome
from verify.lockstep import alone
from verify.studies.separation.links import separated_chains
from verify.studies.separation.stepper.run import Stopped
from verify.studies.separation.stepper.trail import Trail

DIGITS = 40  # of what stands for exact arithmetic
_SHARE = 10  # of them, a digit of Λ's parts: these need more by themselves
_POINTS = 100  # of an orbit that is drawn
_FAR = 10  # a run that goes farther from the origin is of no ordinary scene
_ROUNDOFF = Fraction(1, 2**53)


@dataclass(frozen=True)
class Measure:
    """`value(sample, digits)`: lg of it, or None; `sentence`: what it is, and `several` what it is
    in n degrees of freedom; "" of one that is of the plane.
    """

    sentence: str
    value: Callable[[Any, int], float | None]
    several: str = ""

    def of(self, sample: Sample, digits: int) -> float | None:
        """Its value for a sample; None where it is not of so many degrees of freedom."""
        return self.value(sample, digits) if self.said(sample.hamiltonian.degrees) else None

    def said(self, degrees: int) -> str:
        """What it is, in so many degrees of freedom."""
        return self.sentence if degrees == 1 else self.several


def rounding_share(sample: Sample, digits: int = DIGITS) -> float | None:
    """lg of the greatest rounding part over the greatest truncation part, at checkpoints of a run.

    The greatest ones, as Λ itself may pass through 0, where any error is infinitely large.
    """
    if _stays(sample, digits) is None:
        return None
    try:
        chains = alone(separated_chains(*sample.kernel_inputs, max(1, digits // _SHARE)))
    except Stopped:
        return None
    (chain,) = chains.plain
    truncation, rounding = (_greatest(*chain.trail(n)) for n in ("truncation", "total"))
    return None if not truncation or not rounding else _lg(rounding / truncation)


def _greatest(trail: Trail, bound: Fraction) -> Fraction:
    """The greatest |value|; 0 where no digit of it is known, since noise is not what is hunted."""
    top = trail.largest
    return top if top > 10 * bound else Fraction(0)


def digits_lost(sample: Sample, digits: int = DIGITS) -> float | None:
    """lg of the error of float64's coordinates after the run, in units of its roundoff.

    Relative to the farthest that the orbit is from the origin: where it comes near to that, no
    digit is lost that anything hangs on.
    """
    exact = _stays(sample, digits)
    if exact is None:
        return None
    found = sample.run("float64", 17)
    return None if found.done < sample.steps else _lost(sample, exact, found)


def _lost(sample: Sample, exact: Outcome, found: Outcome) -> float | None:
    names = tuple(sample.point)
    size = max(abs(x[n]) for x in (sample.point, *exact.trail) for n in names)
    error = max(abs(found.values[n] - exact.values[n]) for n in names)
    return None if not size or not error else _lg(error / (size * _ROUNDOFF))


def growth(sample: Sample, digits: int = DIGITS) -> float | None:
    """lg of the greatest |Λ| of the run, in numbers of so many digits: no rounding is in it; in n
    degrees of freedom of the greatest |entry| of W of the whole run."""
    value = _observed(sample, digits, sample.hamiltonian.structure.over_run)
    return _lg(value) if value else None


def defect_of_step(sample: Sample, digits: int = DIGITS) -> float | None:
    """lg of the greatest |ΔJ| of the run, in n degrees of freedom of the greatest |entry| of S of
    any step, over h to the power that is proved of it."""
    order = sample.proof.order if sample.ordinary else None
    if order is None:
        return None
    value = _observed(sample, digits, sample.hamiltonian.structure.of_step)
    return _lg(value / sample.step_size**order) if value else None


def _observed(sample: Sample, digits: int, name: str) -> Fraction | None:
    """The observable of the run; None of one that goes far."""
    run = _stays(sample, digits, name)
    return run.values[name] if run else None


def orbit(sample: Sample) -> list[tuple[Fraction, Fraction]]:
    """Points (q, p) of the run with 40 digits, from the initial value on."""
    trail = sample.run("mpfr", DIGITS, sections=_POINTS).trail
    return [(sample.point["q"], sample.point["p"]), *((x["q"], x["p"]) for x in trail)]


def _stays(sample: Sample, digits: int, *observables: str) -> Outcome | None:
    """The run with so many digits; None where it goes far, or, in n degrees of freedom, where its
    kernel is long or nothing is to be observed."""
    if not sample.hamiltonian.planar and (
        not sample.short or (observables and sample.step_map.symplectic_by_conditions)
    ):
        return None
    found = sample.run("mpfr", digits, *observables)
    if found.done < sample.steps:
        return None
    near = all(abs(x[name]) <= _FAR for x in found.trail for name in sample.point)
    return found if near else None


def _lg(x: Fraction) -> float:
    e = magnitude(x)
    return e + math.log10(x / Fraction(10) ** e)


MEASURES = {
    "rounding-share": Measure(
        "greatest rounding part of Λ over its greatest truncation part", rounding_share
    ),
    "digits-lost": Measure(
        "error of float64's p and q at the end, in roundoffs",
        digits_lost,
        "error of float64's coordinates at the end, in roundoffs",
    ),
    "growth": Measure("greatest |Λ| of the run", growth, "greatest |entry| of W of the run"),
    "defect": Measure(
        "greatest |ΔJ| of a step over its proved power of h",
        defect_of_step,
        "greatest |entry| of S of a step over its proved power of h",
    ),
}
