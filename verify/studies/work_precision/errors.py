"""The errors of schemes, computed before anything is timed, in this process or in another."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from time import perf_counter

from verify.arithmetic.exact import text
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import Solution
from verify.scenes.results.work_precision import WorkPoint
from verify.studies.work_precision.peer_interface import InitialValueProblem
from verify.studies.work_precision.runs import Ladder, Problem, reference

Advance = Callable[[int], None]  # called with a number of points just done


@dataclass(frozen=True)
class Errors:
    """The errors of schemes.

    `solution`: the exact one at the time; `points`: not yet timed, by scheme and step size;
    `seconds`: the time that all of it took.
    """

    solution: Solution
    points: Mapping[tuple[str, Fraction], WorkPoint]
    seconds: float


def find_errors(
    initial_value_problem: InitialValueProblem,
    schemes: Sequence[str],
    step_sizes: Sequence[Fraction],
    advance: Advance,
) -> Errors:
    """Compute the errors of each scheme with each step size.

    Raises InputError where the exact solution does not reach the time.
    """
    start_time = perf_counter()
    try:
        exact = reference(**vars(initial_value_problem))
    except NoFlowError as error:
        raise InputError(
            "work_precision.time", text(initial_value_problem.time), str(error)
        ) from None
    problem = Problem.with_solution(initial_value_problem, exact)
    points = {}
    # One ladder at a time: each holds a compiled kernel.
    for ladder in (Ladder(problem, name) for name in schemes):
        for h in step_sizes:
            points[ladder.name, h] = ladder.point(h)
            advance(1)
    return Errors(exact, points, perf_counter() - start_time)
