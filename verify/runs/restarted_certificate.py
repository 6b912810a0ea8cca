"""Certificates of runs whose flow contracts: the tangent map begins anew at each of many notes."""

from fractions import Fraction
from functools import partial

from verify import arithmetic as number_systems
from verify.arithmetic.arb import bounds
from verify.arithmetic.exact import magnitude
from verify.arithmetic.number_system import Arithmetic
from verify.kernels.chunked_loop import Progress
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.lockstep import Course
from verify.runs.a_posteriori_bound import certify
from verify.runs.estimates import Bounds, digits_of, missing_in
from verify.runs.orbit_bound import linear_error

_SECTIONS = (16, 128, 1024, 8192)  # the more, the more a flow may contract, and the wider the bound
_ATTEMPTS = 8
_SPARE_DIGITS = 3
_MOST_WORK = 10**7  # digits times steps: some seconds; or four times the first digits
METHOD = "a-posteriori bound with tangent maps of many sections"


def certify_restarted(
    kernel_run: KernelRun, arithmetic: Arithmetic, digits: int, progress: Progress | None
) -> Course[tuple[Bounds, RunOutcome] | None]:
    """Return a run's values to `digits` digits with rigorous bounds, and the run; None if there are
    no such bounds."""
    # Of a series there is a note for each of its points.
    allowed = (kernel_run.points,) if kernel_run.points else _SECTIONS
    sizes = [sections for sections in allowed if sections <= kernel_run.steps]
    most_digits = max(4 * digits_of(arithmetic), _MOST_WORK // kernel_run.steps)
    for _ in range(_ATTEMPTS):
        if not sizes or digits_of(arithmetic) > most_digits:
            break
        run = kernel_run.restarting(sizes[0])
        # The first section alone mostly shows that more sections are needed.
        has_bound = partial(_has_bound, run, arithmetic)
        outcome = yield from run.run_in_turn(
            arithmetic, tangent=True, progress=progress, enough=has_bound
        )
        error = linear_error(run, arithmetic, outcome) if outcome.done == run.steps else None
        if error is None:
            sizes = sizes[1:]
            continue
        errors = certify(run, arithmetic, outcome) or {}
        if outcome.values.keys() - run.aside <= errors.keys():
            values = {n: (x, errors[n]) for n, x in outcome.values.items() if n in errors}
            missing = missing_in(run, values, digits)
            if missing <= 0:
                return Bounds(values, METHOD, rigorous=True), outcome
        else:
            missing = digits + magnitude(bounds(error)[1] or Fraction(1)) + _SPARE_DIGITS
            # A state that has its digits has its bound: 1 + Λ, which is near 0, has none yet.
            missing = missing if missing > 0 else digits_of(arithmetic)
        arithmetic = number_systems.get(arithmetic.name, digits_of(arithmetic) + missing + 2)
    return None


def _has_bound(run: KernelRun, arithmetic: Arithmetic, outcome: RunOutcome) -> bool:
    return linear_error(run, arithmetic, outcome, 0) is not None
