"""Error against run time: each scheme over a ladder of step sizes, peers, number systems.

The errors, as `verify.studies.work_precision.ladder` defines them, are computed first. Then all
points are timed together, interleaved (`verify.studies.work_precision.timing`), so that their run
times can be compared; nothing else of this program runs meanwhile.
`verify.studies.work_precision.work_lines` fits orders and compares lines.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from statistics import median
from time import perf_counter

from verify.arithmetic import about
from verify.arithmetic.exact import text, upper
from verify.arithmetic.systems import float64
from verify.execution.provenance import machine
from verify.hamiltonians.run_domain import coordinate_texts
from verify.runs.requested_run import run
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult
from verify.scenes.results.work_precision import SystemPoint, WorkPoint, WorkPrecisionResult
from verify.studies.work_precision import peers as peer_catalogue
from verify.studies.work_precision.ladder import (
    ROUNDING_SHARE,
    Advance,
    SchemeErrors,
    SchemeLadder,
    build_failed_point,
)
from verify.studies.work_precision.peers import Answer, InitialValueProblem, PeerError, Solver
from verify.studies.work_precision.problem import SHOWN, ReferenceProblem, size
from verify.studies.work_precision.timing import (
    RunTime,
    choose_clock,
    do_nothing,
    subtract_or_none,
    time_interleaved,
)
from verify.studies.work_precision.work_lines import build_line, compare_all, log10_of


@dataclass
class _Timing:
    """A point with the calls to time: that of its loop, and one that makes no step."""

    point: WorkPoint
    call: Callable[[], object] | None
    blank: Callable[[], object] = do_nothing


def work_precision(
    initial_value_problem: InitialValueProblem,
    *,
    schemes: Sequence[str],
    step_sizes: Sequence[Fraction],
    repeats: int,
    number_systems: Sequence[str],
    digits: Sequence[int],
    number_systems_scheme: str,
    number_systems_step_size: Fraction,
    peers: Sequence[str],
    peers_left_out: Sequence[tuple[str, str]],
    errors: SchemeErrors,
    advance: Advance,
) -> WorkPrecisionResult:
    """Measure errors and run times of each scheme with each step size, of peers and number systems.

    Run times are the least and the median of `repeats` rounds, in seconds. The number systems are
    measured on one scheme at one step size, with each number of `digits`. `peers` are measured over
    their tolerances; `peers_left_out` has the others, each with the reason. `errors`: those of the
    schemes, as `find_errors` returns them. `advance` is called with the number of points of peers
    just done.
    """
    start_time = perf_counter()
    hamiltonian = initial_value_problem.hamiltonian
    problem = ReferenceProblem.with_solution(initial_value_problem, errors.solution)
    _wake_compiler()
    ladders = [SchemeLadder(problem, name) for name in schemes]
    scheme_timings = [
        [_scheme_point(ladder, h, errors.points[ladder.name, h]) for h in step_sizes]
        for ladder in ladders
    ]
    others = [_peer(problem, name, advance) for name in peers]
    # All points are timed in the same rounds, so that their times can be compared.
    overhead = _time_calls([*scheme_timings, *(timings for timings, _ in others)], repeats)
    lines = [
        build_line([t.point for t in timings], ladder.scheme, ladder.preserves_area, ladder.cost,
             ladder.compile_seconds, problem.scale, hamiltonian.structure)
        for ladder, timings in zip(ladders, scheme_timings, strict=True)
    ]  # fmt: skip
    lines += [
        build_line([t.point for t in timings], name, None, None, compile_seconds)
        for name, (timings, compile_seconds) in zip(peers, others, strict=True)
    ]
    pairs = [(name, n) for name in number_systems for n in _select_digits(name, digits)]
    systems = _system_points(
        problem, number_systems_scheme, number_systems_step_size, pairs, repeats
    )
    return WorkPrecisionResult(
        **hamiltonian.texts,
        time=text(initial_value_problem.time),
        t0=text(initial_value_problem.t0),
        q=coordinate_texts(hamiltonian, initial_value_problem.point, "q"),
        p=coordinate_texts(hamiltonian, initial_value_problem.point, "p"),
        repeats=repeats,
        clock=choose_clock()[1],
        overhead=overhead,
        rounding_share=text(ROUNDING_SHARE),
        scale=problem.scale,
        reference=problem.solution.method,
        reference_bound=upper(problem.solution.bound),
        machine=machine(),
        lines=tuple(lines),
        comparisons=compare_all(lines, problem.scale, hamiltonian.structure),
        systems=tuple(systems),
        systems_scheme=number_systems_scheme,
        systems_step_size=text(number_systems_step_size),
        left_out=tuple(peers_left_out),
        seconds=errors.seconds + perf_counter() - start_time,
    )


def _wake_compiler() -> None:
    """Compile a function: a process's first compilation takes longer, and is no scheme's."""
    source = "def same(steps, x):\n    for k in range(steps):\n        x = x\n    return steps, x\n"
    float64.compiled_at_once(anew=True).compile(source, "same", {})(1, 1.0)


def _scheme_point(ladder: SchemeLadder, h: Fraction, point: WorkPoint) -> _Timing:
    if point.limited_by == "failed":
        return _Timing(point, None)
    return _Timing(point, ladder.call(h), ladder.call(h, blank=True))


def _time_calls(groups: list[list[_Timing]], repeats: int) -> float:
    """Store the run times in the points, less those of blank calls; return that of an empty call.

    Times are in seconds.
    """
    timings = [t for group in groups for t in group if t.call]
    blanks = list({_identity_of(t.blank): t.blank for t in timings}.values())
    calls = [*(t.call for t in timings if t.call), *blanks, do_nothing]
    times = time_interleaved(calls, repeats)
    empty = dict(zip(map(_identity_of, blanks), times[len(timings) :], strict=False))
    for timing, time in zip(timings, times, strict=False):
        blank = empty.get(_identity_of(timing.blank), times[-1])
        net_time = subtract_or_none(time, blank)
        if net_time is not None:
            seconds = {"seconds_min": net_time.least, "seconds_median": net_time.median}
            timing.point = timing.point.model_copy(update=seconds)
    return times[-1].median


def _identity_of(blank: Callable[[], object]) -> int:
    """Return a key of a blank call: those of one kernel are all alike."""
    return id(getattr(blank, "func", blank))


# -- peers ----------------------------------------------------------------------------------------


def _peer(problem: ReferenceProblem, name: str, advance: Advance) -> tuple[list[_Timing], float]:
    """Return a peer's points over its tolerances, and the seconds of its first preparation."""
    module, timings, compile_seconds = peer_catalogue.get(name), [], 0.0
    for tolerance in module.TOLERANCES:
        try:
            solver: Solver = module.make(problem, tolerance)
            answer = solver.solve()
        except PeerError as error:
            point = build_failed_point(name, tolerance=text(tolerance), reason=str(error))
            timings.append(_Timing(point, None))
        else:
            compile_seconds = compile_seconds or solver.compile_seconds
            timings.append(_Timing(_peer_point(problem, name, tolerance, answer), solver.solve))
        advance(1)
    return timings, compile_seconds


def _peer_point(
    problem: ReferenceProblem, name: str, tolerance: Fraction, answer: Answer
) -> WorkPoint:
    if not all(abs(x) < float("inf") for x in answer.state):
        return build_failed_point(
            name, tolerance=text(tolerance), reason="left the range of float64"
        )
    state = tuple(map(Fraction, answer.state))
    return WorkPoint(
        scheme=name,
        tolerance=f"{float(tolerance):.0e}",
        steps=answer.steps,
        evaluations=answer.evaluations,
        error=Value.from_bound(*problem.error(state), SHOWN),
        energy=problem.energy_error(state),
        limited_by="tolerance",
    )


# -- number systems -------------------------------------------------------------------------------


def _system_points(
    problem: ReferenceProblem,
    scheme: str,
    h: Fraction,
    pairs: Sequence[tuple[str, int]],
    repeats: int,
) -> list[SystemPoint]:
    """Return the end state's certified digits against run time, for each system and its digits.

    The run times are those of one scheme at one step size.
    """

    def go(name: str, digits: int) -> RunResult:
        q, p = (coordinate_texts(problem.hamiltonian, problem.point, letter) for letter in "qp")
        return run(
            problem.hamiltonian, scheme, q=q, p=p, step_size=h, t0=problem.t0,
            steps=problem.time // h, arithmetic=name, digits=digits, observables=(),
        )  # fmt: skip

    # A run's `seconds` are those of its steps: the first compiles before them, and counts as well.
    rounds = [[go(*pair) for pair in pairs] for _ in range(repeats)]
    points = []
    for k, ((name, digits), result) in enumerate(zip(pairs, rounds[0], strict=True)):
        seconds = [pair[k].seconds for pair in rounds]
        time: RunTime | None = RunTime(min(seconds), median(seconds))
        if name == float64.NAME:  # compiled, as it is in the other figures
            time = _time_compiled_float(SchemeLadder(problem, scheme), h, repeats)
        points.append(_system_point(name, digits, result, time))
    return points


def _select_digits(name: str, requested: Sequence[int]) -> Sequence[int]:
    fixed_digits = about(name).digits
    return requested if fixed_digits is None else (fixed_digits,)


def _time_compiled_float(ladder: SchemeLadder, h: Fraction, repeats: int) -> RunTime | None:
    time, blank = time_interleaved([ladder.call(h), ladder.call(h, blank=True)], repeats)
    return subtract_or_none(time, blank)


def _system_point(name: str, digits: int, result: RunResult, time: RunTime | None) -> SystemPoint:
    is_finished = result.status == "finished"
    reason = result.fallback if is_finished else f"{result.status}: {result.error_method}"
    return SystemPoint(
        arithmetic=result.arithmetic if is_finished else name,
        digits=digits,
        certified=_digits_of_state(result) if is_finished else None,
        error_kind=result.error_kind,
        error_method=result.error_method,
        seconds_min=time.least if is_finished and time else None,
        seconds_median=time.median if is_finished and time else None,
        reason=reason,
    )


def _digits_of_state(result: RunResult) -> str | None:
    """Return −lg(bound / size) of the state, with one decimal."""
    state = list(result.values.values())  # the run has no observables
    if not state:
        return None
    length = size(tuple(Fraction(x.value) for x in state))
    bound = sum(Fraction(x.bound) for x in state)
    if not bound or not length:
        return None
    part = bound / length
    return f"{-log10_of(f'{part.numerator}/{part.denominator}'):.1f}"
