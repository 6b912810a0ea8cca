"""Every number system's values lie within their bounds of what balls enclose, or reach there.

One number system a sample, by its numbers, so that all of them get their turn. Where the step
solves equations, which balls do not do here, float64 is held against 40 digits.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import reduce
from itertools import pairwise

import flint

from verify import arithmetic as number_systems
from verify.arithmetic.arb import Ball, around, rational_ball, shown
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.any_sample import AnySample
from verify.exploration.oracles.ball_steps import BITS, BallState, ball_steps, defect, largest
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.runs.run import run
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult

_IN, _AFTER = 2, 1  # one in so many samples, and not those that are taken apart
_DIGITS = 30
_COMPILED = 997  # of so many samples one is run in a number system that compiles
_OBSERVABLES = ("lambda", "lambda_max", "mse", "delta_j_max")


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN, _AFTER) and sample.short)
    name = _turn(sample)
    wanted = _enclosed(sample)
    found = _run(sample, name, number_systems.about(name).digits or _DIGITS)
    with working_precision(BITS):
        _must_agree(found, wanted)


def _must_agree(found: RunResult, wanted: Mapping[str, Ball]) -> None:
    for quantity, value in found.values.items():
        if not _ball(value).overlaps(wanted[quantity]):
            within = f"{value.value} ± {value.bound}"
            true = shown(wanted[quantity], 20)
            raise Violation(f"{quantity} is {within} in {found.arithmetic}, and truly {true}")


def _turn(sample: Sample) -> str:
    """The number system that is looked at: one that compiles each kernel, in few samples."""
    seldom = sample.turn % _COMPILED == 0
    names = [n for n in number_systems.names() if number_systems.about(n).compiles == seldom]
    return names[sample.turn // (_COMPILED if seldom else _IN) % len(names)]


def _enclosed(sample: Sample) -> dict[str, Ball]:
    if sample.step_map.implicit:
        return {n: _ball(v) for n, v in _run(sample, "mpfr", 40).values.items()}
    steps = ball_steps(sample.step_map, sample.start, sample.steps)
    states = [state.sharp() for state in steps]
    with working_precision(BITS):
        return _of_states(states)


def _of_states(states: Sequence[BallState]) -> dict[str, Ball]:
    """The values of a run, from balls of its states."""
    errors = [abs(state.product - 1) for state in states[1:]]
    # det J of a single step, where no step before had det J = 0.
    changes = [abs(two.product / one.product - 1) for one, two in pairwise(states)]
    found = {**_place(states[-1]), "lambda": states[-1].product - 1}
    found["lambda_max"] = reduce(flint.arb.max, errors)
    found["delta_j_max"] = reduce(flint.arb.max, changes)
    found["mse"] = sum((x * x for x in changes), rational_ball(Fraction())) / len(changes)
    return found


def _place(state: BallState) -> dict[str, Ball]:
    """The coordinates, without t."""
    return {name: x for name, x in state.point.items() if name != "t"}


def _ball(value: Value) -> Ball:
    with working_precision(BITS):
        return around(Fraction(value.value), Fraction(value.bound))


def _run(
    sample: AnySample, arithmetic: str, digits: int, observables: Sequence[str] = _OBSERVABLES
) -> RunResult:
    found = run(
        sample.hamiltonian,
        sample.scheme.name,
        **sample.run_arguments,
        arithmetic=arithmetic,
        digits=digits,
        observables=observables,
    )
    only_if(found.status == "finished")
    return found


# -- in n degrees of freedom ----------------------------------------------------------------------

_OF_FORM = ("symplectic_defect_max", "symplectic_defect", "lambda", "delta_j_max")
_IN_DEGREES = 4  # one in so many samples
_STEPS_IN_DEGREES = 4


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The state, S, W, ΔJ and Λ of a few steps; W from the Jacobian of the run, not its sum."""
    only_if(sample.is_turn(_IN_DEGREES, _AFTER) and sample.short and sample.scheme.explicit)
    systems = [n for n in number_systems.names() if not number_systems.about(n).compiles]
    name = systems[sample.turn // _IN_DEGREES % len(systems)]
    brief = replace(sample, steps=min(sample.steps, _STEPS_IN_DEGREES))
    states = [s.sharp() for s in ball_steps(sample.step_map, sample.start, brief.steps)]
    found = _run(brief, name, number_systems.about(name).digits or _DIGITS, _OF_FORM)
    with working_precision(BITS):
        _must_agree(found, _of_run(states))


def _of_run(states: Sequence[BallState]) -> dict[str, Ball]:
    """The values of a run, from balls of its states."""
    last = states[-1]
    forms = [largest(defect(state.own)) for state in states[1:]]
    changes = [abs(state.own.det() - 1) for state in states[1:]]
    found = _place(last)
    found["symplectic_defect_max"] = reduce(flint.arb.max, forms)
    found["symplectic_defect"] = largest(defect(last.matrix))
    found["delta_j_max"] = reduce(flint.arb.max, changes)
    found["lambda"] = last.matrix.det() - 1
    return found
