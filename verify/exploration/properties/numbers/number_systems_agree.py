"""Every number system's values lie within their bounds of what balls enclose, or reach there.

Each sample tests one number system, selected by its numbers, so that all of them get their turn. If
the step is implicit, which balls do not cover here, the reference is a run in 40 digits.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

import flint

from verify import arithmetic as number_systems
from verify.arithmetic.arb import Ball, format_ball, make_ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Violation, only_if
from verify.exploration.reference_steps import BITS, BallState, ball_steps, defect, largest
from verify.exploration.sample import Sample
from verify.runs.requested_run import run
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult

_TESTED_ONE_IN = 2  # `separated_parts_add_up` tests the others
_DIGITS = 30
_COMPILING_ONE_IN = 997  # the samples for number systems that compile a kernel, which takes long
_OBSERVABLES = ("lambda", "lambda_max", "mse", "delta_j_max")


def holds(sample: Sample) -> None:
    """Check one number system; W is computed from the tangent map of the run, not summed."""
    only_if(sample.is_turn(_TESTED_ONE_IN, after=1) and sample.short)
    name = _select_number_system(sample)
    expected = _enclose_values(sample)
    outcome = _run(sample, name, number_systems.about(name).digits or _DIGITS)
    for quantity, value in outcome.values.items():
        if not _ball(value).overlaps(expected[quantity]):
            printed = f"{value.value} ± {value.bound}"
            true = format_ball(expected[quantity], 20)
            raise Violation(f"{quantity} is {printed} in {name}, and truly {true}")


def _select_number_system(sample: Sample) -> str:
    """Select the number system to test; those that compile each kernel get few samples."""
    seldom = sample.turn % _COMPILING_ONE_IN == 0
    names = [n for n in number_systems.names() if number_systems.about(n).compiles == seldom]
    return names[sample.turn // (_COMPILING_ONE_IN if seldom else _TESTED_ONE_IN) % len(names)]


def _enclose_values(sample: Sample) -> dict[str, Ball]:
    if sample.step_map.implicit:
        return {n: _ball(v) for n, v in _run(sample, "mpfr", 40).values.items()}
    steps = ball_steps(sample.step_map, sample.start, sample.steps)
    states = [state.sharp() for state in steps]
    with working_precision(BITS):
        return _values_of_states(states)


def _values_of_states(states: Sequence[BallState]) -> dict[str, Ball]:
    """Compute the observables of a run from the balls of its states."""
    last, after = states[-1], states[1:]
    changes = [abs(state.step_jacobian.det() - 1) for state in after]
    return {
        **last.point,
        "lambda": last.product - 1,
        "lambda_max": reduce(flint.arb.max, [abs(state.product - 1) for state in after]),
        "delta_j_max": reduce(flint.arb.max, changes),
        "mse": sum((x * x for x in changes), rational_ball(Fraction())) / len(changes),
        "symplectic_defect": largest(defect(last.matrix)),
        "symplectic_defect_max": reduce(
            flint.arb.max, [largest(defect(s.step_jacobian)) for s in after]
        ),
    }


def _ball(value: Value) -> Ball:
    with working_precision(BITS):
        return make_ball(Fraction(value.value), Fraction(value.bound))


def _run(sample: Sample, arithmetic: str, digits: int) -> RunResult:
    of_structure = sample.hamiltonian.structure.of_step, sample.hamiltonian.structure.of_run
    result = run(
        sample.hamiltonian,
        sample.scheme.name,
        **sample.run_arguments,
        arithmetic=arithmetic,
        digits=digits,
        observables=tuple(dict.fromkeys((*_OBSERVABLES, *of_structure))),
    )
    only_if(result.status == "finished")
    return result
