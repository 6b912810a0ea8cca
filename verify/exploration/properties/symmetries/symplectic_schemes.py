"""A scheme that claims det J ≡ 1 has it: by the proof, and by J's four entries at a point.

Where the step solves equations the entries are multiplied along a run with 80 digits. These may not
do to solve them: what 160 digits find elsewhere, or not at all, is not held against the scheme.
"""

from fractions import Fraction

from verify import arithmetic as number_systems
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import decimal
from verify.exploration.ball_steps import ball_steps, unlike
from verify.exploration.property import Violation
from verify.exploration.sample import Sample
from verify.kernels.stepping import KernelRun

_DIGITS, _STEPS = 80, 2
_SMALL = Fraction(1, 10**30)  # where H is steep, the entries lose twenty digits in a step


def holds(sample: Sample) -> bool:
    if not sample.scheme.area_preserving or not sample.ordinary:
        return False
    if sample.proof.area_preserving is False:
        raise Violation(f"the proof says that ΔJ has order {sample.proof.order}")
    if sample.step_map.implicit:
        return _by_a_run(sample)
    states = ball_steps(sample.step_map, sample.p, sample.q, sample.step_size, 1)
    if states is None or not states[-1].sharp:
        return False
    if not states[-1].product.contains(1):
        raise Violation(f"det J is {unlike(states[-1].product, rational_ball(Fraction(1)))}")
    return True


def _by_a_run(sample: Sample) -> bool:
    found = _run(sample, _DIGITS)
    if found is None:
        return False
    change = found["lambda_plain"]
    if abs(change) <= _SMALL * _size(found):
        return True
    again = _run(sample, 2 * _DIGITS)
    if again is None or any(abs(found[n] - again[n]) > _SMALL * _size(again) for n in ("p", "q")):
        return False
    raise Violation(f"Π det J − 1 is {decimal(change, 6)} after {_STEPS} steps")


def _run(sample: Sample, digits: int) -> dict[str, Fraction] | None:
    wanted = frozenset({"lambda_plain"})
    run = KernelRun(sample.hamiltonian, sample.scheme.name, sample.start, _STEPS, wanted, 0)
    found = run.run(number_systems.get("mpfr", digits))
    return found.values if found.done == _STEPS else None


def _size(found: dict[str, Fraction]) -> Fraction:
    return 1 + abs(found["p"]) + abs(found["q"])
