"""A scheme that claims det J ≡ 1 has it: by the proof, and by J's four entries at a point.

Where the step solves equations the entries are multiplied along a run with 80 digits. These may not
do to solve them: what 160 digits find elsewhere, or not at all, is not held against the scheme.
"""

from collections.abc import Mapping
from fractions import Fraction

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.oracles.ball_steps import BITS, ball_steps, defect, entries, largest, unlike
from verify.exploration.oracles.mpfr_runs import jacobian_of_run
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees

_DIGITS, _STEPS = 80, 2
_BY_DIFFERENCES = 8  # one in so many samples of several degrees of freedom that solves equations
_BITS_OF_DIFFERENCES = 700
_SMALL = Fraction(1, 10**30)  # where H is steep, the entries lose twenty digits in a step


def holds(sample: Sample) -> None:
    only_if(sample.scheme.area_preserving and sample.ordinary)
    if sample.proof.area_preserving is False:
        raise Violation(f"the proof says that ΔJ has order {sample.proof.order}")
    if sample.step_map.implicit:
        _by_a_run(sample)
        return
    after = ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    if not after.product.contains(1):
        raise Violation(f"det J is {unlike(after.product, rational_ball(Fraction(1)))}")


def _by_a_run(sample: Sample) -> None:
    found = _run(sample, _DIGITS)
    change = found["lambda_plain"]
    if abs(change) <= _SMALL * _size(found):
        return
    again = _run(sample, 2 * _DIGITS)
    only_if(all(abs(found[n] - again[n]) <= _SMALL * _size(again) for n in ("p", "q")))
    raise Violation(f"Π det J − 1 is {decimal(change, 6)} after {_STEPS} steps")


def _run(sample: Sample, digits: int) -> Mapping[str, Fraction]:
    found = sample.run("mpfr", digits, "lambda_plain", steps=_STEPS)
    only_if(found.done == _STEPS)
    return found.values


def _size(found: Mapping[str, Fraction]) -> Fraction:
    return 1 + abs(found["p"]) + abs(found["q"])


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """S ≡ 0 by the proof, and S of a step by balls; where equations are solved of the Jacobian of
    two steps that differences of runs give."""
    only_if(sample.scheme.area_preserving and sample.brief)
    if sample.ordinary and sample.proof.symplectic is False:
        raise Violation(f"the proof says that S has order {sample.proof.order}")
    if sample.step_map.implicit:
        _by_differences(sample)
        return
    after = ball_steps(sample.step_map, sample.start, 1)[-1].sharp()
    with working_precision(BITS):
        form = defect(after.own)
    if not all(x.contains(0) for x in entries(form)):
        raise Violation(f"S is not 0; its greatest |entry| is {largest(form).str(6)}")


def _by_differences(sample: SampleInDegrees) -> None:
    only_if(sample.is_turn(_BY_DIFFERENCES) and sample.short)
    found, known = jacobian_of_run(sample)
    with working_precision(_BITS_OF_DIFFERENCES):
        seen = largest(defect(found))
        wrong = seen > known
    if wrong:
        raise Violation(f"W is {seen.str(6)} after {_STEPS} steps, by differences of runs")
