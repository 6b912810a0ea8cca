"""Measures of how bad a scene is for float64, or for its scheme, which a hunt maximises.

Each value is a decimal logarithm. It is None if the orbit leaves a bounded part of the phase space,
or if the numerator or the denominator is 0 or has no known digit. ΔJ = det J − 1 is the area error
of one step, and Λ = Π (1 + ΔJ_k) − 1 that of a run; in n degrees of freedom S and W are the defects
of the symplectic form, of one step and of a run.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import magnitude
from verify.exploration.sample import Sample
from verify.kernels.stepping import RunOutcome
from verify.lockstep import run_alone
from verify.studies.separation.chain import Trail
from verify.studies.separation.links import separate_chains
from verify.studies.separation.mixed_run import Stopped

DIGITS = 40  # decimal digits of the runs that stand for exact arithmetic
# The parts of Λ are computed to one digit for each ten of the run; they use more digits inside.
_DIGITS_PER_DIGIT_OF_PARTS = 10
_ORBIT_POINTS = 100  # of an orbit in a figure
_MAX_COORDINATE = 10  # a run that goes farther from the origin is no ordinary scene
_ROUNDOFF = Fraction(1, 2**53)  # the largest relative rounding error of float64
_NOISE_FACTOR = 10  # a value below this multiple of its bound has no certain digit


@dataclass(frozen=True)
class Measure:
    """A measure with its description.

    `value(sample, digits)`: returns its decimal logarithm, or None. `sentence`: describes it in the
    plane; `several`: in n degrees of freedom, "" for a measure that exists in the plane alone.
    """

    sentence: str
    value: Callable[[Any, int], float | None]
    several: str = ""

    def evaluate(self, sample: Sample, digits: int) -> float | None:
        """Return its value for a sample; None if it does not exist in its degrees of freedom."""
        return self.value(sample, digits) if self.describe(sample.hamiltonian.degrees) else None

    def describe(self, degrees: int) -> str:
        """Return its description for that number of degrees of freedom; "" if it does not exist."""
        return self.sentence if degrees == 1 else self.several


def rounding_share(sample: Sample, digits: int = DIGITS) -> float | None:
    """Return lg of the greatest rounding part of Λ over its greatest truncation part, in one run.

    The maxima over the checkpoints are compared, since Λ itself may pass through 0, where a
    relative error is infinite.
    """
    if _run_if_near(sample, digits) is None:
        return None
    try:
        # The separation uses more working digits than are requested.
        chains = run_alone(
            separate_chains(*sample.kernel_inputs, max(1, digits // _DIGITS_PER_DIGIT_OF_PARTS))
        )
    except Stopped:
        return None
    (chain,) = chains.plain
    truncation, rounding = (_greatest(*chain.trail(n)) for n in ("truncation", "total"))
    return None if not truncation or not rounding else _lg(rounding / truncation)


def _greatest(trail: Trail, bound: Fraction) -> Fraction:
    """Return the greatest |value|; 0 if no digit of it is certain, since noise is not hunted."""
    greatest = trail.largest
    return greatest if greatest > _NOISE_FACTOR * bound else Fraction(0)


def digits_lost(sample: Sample, digits: int = DIGITS) -> float | None:
    """Return lg of the error of float64's coordinates after the run, in units of its roundoff.

    The error is relative to the greatest coordinate along the orbit: near the origin a relative
    error may be large without any loss that matters.
    """
    accurate = _run_if_near(sample, digits)
    if accurate is None:
        return None
    outcome = sample.run("float64", 17)
    return (
        None if outcome.done < sample.steps else _lg_error_in_roundoffs(sample, accurate, outcome)
    )


def _lg_error_in_roundoffs(
    sample: Sample, accurate: RunOutcome, outcome: RunOutcome
) -> float | None:
    names = tuple(sample.point)
    size = max(abs(x[n]) for x in (sample.point, *accurate.trail) for n in names)
    error = max(abs(outcome.values[n] - accurate.values[n]) for n in names)
    return None if not size or not error else _lg(error / (size * _ROUNDOFF))


def growth(sample: Sample, digits: int = DIGITS) -> float | None:
    """Return lg of the greatest |Λ| of the run, computed with that number of digits.

    In n degrees of freedom it is the greatest |entry| of W over the run.
    """
    value = _observable(sample, digits, sample.hamiltonian.structure.over_run)
    return _lg(value) if value else None


def defect_of_step(sample: Sample, digits: int = DIGITS) -> float | None:
    """Return lg of the greatest |ΔJ| of a step over h^r, where r is the proved order of ΔJ.

    In n degrees of freedom it is the greatest |entry| of S of a step.
    """
    order = sample.proof.order if sample.ordinary else None
    if order is None:
        return None
    value = _observable(sample, digits, sample.hamiltonian.structure.of_step)
    return _lg(value / sample.step_size**order) if value else None


def _observable(sample: Sample, digits: int, name: str) -> Fraction | None:
    """Return an observable of the run; None as `_run_if_near`."""
    run = _run_if_near(sample, digits, name)
    return run.values[name] if run else None


def orbit(sample: Sample) -> list[tuple[Fraction, Fraction]]:
    """Return points (q, p) of the run with 40 digits, from the initial value on."""
    trail = sample.run("mpfr", DIGITS, sections=_ORBIT_POINTS).trail
    return [(sample.point["q"], sample.point["p"]), *((x["q"], x["p"]) for x in trail)]


def _run_if_near(sample: Sample, digits: int, *observables: str) -> RunOutcome | None:
    """Return a run with that number of digits; None if it ends early, or the orbit goes far.

    In n degrees of freedom also None if the kernel is long, or if observables are requested that
    are 0, as the scheme is symplectic by its conditions.
    """
    if not sample.hamiltonian.planar and (
        not sample.short or (observables and sample.step_map.symplectic_by_conditions)
    ):
        return None
    outcome = sample.run("mpfr", digits, *observables)
    if outcome.done < sample.steps:
        return None
    is_near = all(abs(x[name]) <= _MAX_COORDINATE for x in outcome.trail for name in sample.point)
    return outcome if is_near else None


def _lg(x: Fraction) -> float:
    # lg x = e + lg(x/10^e): the quotient has the size of a float, which x itself may not.
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
