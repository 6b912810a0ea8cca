"""How far a scheme can be pushed: the largest step with bounded motion, and the (h, stiffness) map.

Linear theory says of a step size h that h ω has to lie in the scheme's interval (see
`verify.studies.stability.linear`), ω² being the greatest det Hess H on the exact orbit, where that
is stiffest. What bounded motion is, is told in `verify.studies.stability.run_motion`.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.exact import decimal
from verify.arithmetic.systems import mpfr
from verify.errors import InputError
from verify.flows.orbit import ExactOrbit, exact_orbit
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose, prose
from verify.studies.stability.linear import linear_stability
from verify.studies.stability.trail import Run
from verify.studies.stability.verdict_on_run import Judgement, bounded, judge

_FINER = Fraction(1001, 1000)  # how near the largest step is found
_LADDER = Fraction(119, 100)  # about 2^(1/4), between the step sizes that are looked at first
_BELOW, _ABOVE = 8, 8  # they range from so many times below the linear limit to so many above
_MOST_STEPS = 200_000  # of the smallest step that is looked at


@lru_cache(maxsize=256)
def linear_limit(scheme: str) -> Fraction | None:
    """The stability interval in hω, to 30 digits; None where it has no end or is not known."""
    try:
        found = linear_stability(scheme)
    except InputError:
        return None
    if found.interval.is_infinite:
        return None
    return Fraction(found.decimal())


def frequency(orbit: ExactOrbit) -> Fraction:
    """The greatest ω on the orbit, to some 20 digits; 0 where nothing oscillates."""
    if orbit.stiffness <= 0:
        return Fraction(0)
    arithmetic = mpfr.make(20)
    with arithmetic.context():
        omega = arithmetic.functions["sqrt"](arithmetic.number(orbit.stiffness))
    return arithmetic.exact(omega)


@dataclass(frozen=True)
class LargestStep:
    """See `verify.scenes.results.stability.LargestStepResult`."""

    orbit: ExactOrbit
    bounded: Fraction | None
    unbounded: Fraction | None
    linear: Fraction | None
    detail: Prose


def largest_step(
    hamiltonian: Hamiltonian, scheme: str, p: Fraction, q: Fraction, time: Fraction
) -> LargestStep:
    """The largest h with bounded motion in float64 until `time`, by bisection.

    From small steps upwards until the first that is not bounded; beyond it there may be other
    steps with bounded motion, by resonance, which are not looked for.
    """
    orbit = exact_orbit(hamiltonian, p, q, time)
    omega, limit = frequency(orbit), linear_limit(scheme)
    linear = limit / omega if limit is not None and omega else None
    if orbit.kind == "escapes":
        return LargestStep(orbit, None, None, linear, prose("the exact solution ", orbit.summary))

    def stays(h: Fraction) -> bool:
        steps = time // h
        return steps >= 1 and bounded(Run(hamiltonian, scheme, h, q, p, steps))

    middle = linear or (1 / omega if omega else time / 100)
    good, bad = _bracket(stays, min(middle, time / 2), time)
    if bad is None:
        everywhere = prose("bounded with every step size looked at")
        return LargestStep(orbit, good, None, linear, everywhere)
    if good is None:
        nowhere = prose("not bounded with any step size looked at")
        return LargestStep(orbit, None, bad, linear, nowhere)
    while bad / good > _FINER:
        middle = _short((good + bad) / 2)
        good, bad = (middle, bad) if stays(middle) else (good, middle)
    return LargestStep(orbit, good, bad, linear, Prose())


def _bracket(
    stays: Callable[[Fraction], bool], middle: Fraction, time: Fraction
) -> tuple[Fraction | None, Fraction | None]:
    """A step size with bounded motion and the next one without, where there are such."""
    h = _short(middle / _BELOW)
    if not stays(h):
        bad = h
        while time / h <= _MOST_STEPS:
            h = _short(h / 2)
            if stays(h):
                return h, bad
            bad = h
        return None, bad
    good = h
    while h < min(middle * _ABOVE, time):
        h = _short(h * _LADDER)
        if not stays(h):
            return good, h
        good = h
    return good, None


def _short(h: Fraction) -> Fraction:
    """h to six digits."""
    return Fraction(decimal(h, 6))


def stability_map(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    parameter: str,
    values: Sequence[Fraction],
    step_sizes: Sequence[Fraction],
    steps: int,
    p: Fraction,
    q: Fraction,
) -> Iterator[tuple[Fraction | None, list[Judgement]]]:
    """For each value of the parameter: the step size of linear theory, and the verdicts."""
    given = dict(hamiltonian.values)
    limit = linear_limit(scheme)
    for value in values:
        own = hamiltonian.with_values(given | {parameter: value})
        longest = max(step_sizes) * steps
        omega = frequency(exact_orbit(own, p, q, longest))
        run = Run(own, scheme, step_sizes[0], q, p, steps)
        row = [judge(replace(run, step_size=h)) for h in step_sizes]
        yield (limit / omega if limit is not None and omega else None), row
