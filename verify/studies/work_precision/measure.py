"""Error against run time: each scheme over a ladder of step sizes, peers, number systems.

Errors first (`verify.studies.work_precision.errors`), then one interleaved timing of all points
together (`verify.studies.work_precision.timing`), so that their run times can be compared; nothing
else of this program runs meanwhile. What the errors are is told in
`verify.studies.work_precision.runs`, what is made of the points in
`verify.studies.work_precision.lines`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from statistics import median
from time import perf_counter

from verify.arithmetic import about
from verify.arithmetic.exact import text, upper
from verify.arithmetic.systems import float64
from verify.execution.machine import machine
from verify.hamiltonians.start import shown_of
from verify.runs.run import run
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult
from verify.scenes.results.work_precision import SystemPoint, WorkPoint, WorkPrecisionResult
from verify.studies.work_precision import peers as peer_catalogue
from verify.studies.work_precision.errors import Advance, Errors
from verify.studies.work_precision.lines import comparisons, lg, line
from verify.studies.work_precision.peer_interface import (
    Answer,
    InitialValueProblem,
    PeerError,
    Solver,
)
from verify.studies.work_precision.runs import ROUNDING_SHARE, SHOWN, Ladder, Problem, failed, size
from verify.studies.work_precision.timing import Timed, above, clock, interleaved, nothing


@dataclass
class _Timing:
    """A point with what is timed of it: the call, and the call that does nothing."""

    point: WorkPoint
    call: Callable[[], object] | None
    blank: Callable[[], object] = nothing


def work_precision(
    asked: InitialValueProblem,
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
    errors: Errors,
    advance: Advance,
) -> WorkPrecisionResult:
    """Errors and run times of each scheme with each step size, of peers, and of number systems with
    so many digits, on one scheme at one step size. `errors`: those of the schemes.
    """
    begun = perf_counter()
    hamiltonian, problem = asked.hamiltonian, Problem.of(asked, errors.solution)
    _wake_compiler()
    ladders = [Ladder(problem, name) for name in schemes]
    own = [
        [_scheme_point(ladder, h, errors.points[ladder.name, h]) for h in step_sizes]
        for ladder in ladders
    ]
    others = [_peer(problem, name, advance) for name in peers]
    overhead = _time([*own, *(timings for timings, _ in others)], repeats)
    lines = [
        line([t.point for t in timings], ladder.scheme, ladder.preserves_area, ladder.cost,
             ladder.compile_seconds, problem.scale, hamiltonian.structure)
        for ladder, timings in zip(ladders, own, strict=True)
    ]  # fmt: skip
    lines += [
        line([t.point for t in timings], name, None, None, compiled)
        for name, (timings, compiled) in zip(peers, others, strict=True)
    ]
    pairs = [(name, n) for name in number_systems for n in _digits(name, digits)]
    systems = _system_points(
        problem, number_systems_scheme, number_systems_step_size, pairs, repeats
    )
    return WorkPrecisionResult(
        **hamiltonian.texts,
        time=text(asked.time),
        t0=text(asked.t0),
        q=shown_of(hamiltonian, asked.point, "q"),
        p=shown_of(hamiltonian, asked.point, "p"),
        repeats=repeats,
        clock=clock()[1],
        overhead=overhead,
        rounding_share=text(ROUNDING_SHARE),
        scale=problem.scale,
        reference=problem.solution.method,
        reference_bound=upper(problem.solution.bound),
        machine=machine(),
        lines=tuple(lines),
        comparisons=comparisons(lines, problem.scale, hamiltonian.structure),
        systems=tuple(systems),
        systems_scheme=number_systems_scheme,
        systems_step_size=text(number_systems_step_size),
        left_out=tuple(peers_left_out),
        seconds=errors.seconds + perf_counter() - begun,
    )


def _wake_compiler() -> None:
    """The first compilation of a process takes longer than the next; no scheme shall pay that."""
    source = "def same(steps, x):\n    for k in range(steps):\n        x = x\n    return steps, x\n"
    float64.compiled_at_once(anew=True).compile(source, "same", {})(1, 1.0)


def _scheme_point(ladder: Ladder, h: Fraction, point: WorkPoint) -> _Timing:
    if point.limited_by == "failed":
        return _Timing(point, None)
    return _Timing(point, ladder.call(h), ladder.call(h, blank=True))


def _time(groups: list[list[_Timing]], repeats: int) -> float:
    """Puts the run times into the points; returns what an empty call takes."""
    timed = [t for group in groups for t in group if t.call]
    blanks = list({_of(t.blank): t.blank for t in timed}.values())
    calls = [*(t.call for t in timed if t.call), *blanks, nothing]
    found = interleaved(calls, repeats)
    empty = dict(zip(map(_of, blanks), found[len(timed) :], strict=False))
    for each, taken in zip(timed, found, strict=False):
        blank = empty.get(_of(each.blank), found[-1])
        left = above(taken, blank)
        if left is not None:
            seconds = {"seconds_min": left.least, "seconds_median": left.median}
            each.point = each.point.model_copy(update=seconds)
    return found[-1].median


def _of(blank: Callable[[], object]) -> int:
    """One kernel's blank calls are all alike."""
    return id(getattr(blank, "func", blank))


# -- peers ----------------------------------------------------------------------------------------


def _peer(problem: Problem, name: str, advance: Advance) -> tuple[list[_Timing], float]:
    """Its points over its tolerances, and what making it ready took the first time."""
    module, timings, compiled = peer_catalogue.get(name), [], 0.0
    for tolerance in module.TOLERANCES:
        try:
            solver: Solver = module.make(problem, tolerance)
            answer = solver.solve()
        except PeerError as error:
            point = failed(name, tolerance=text(tolerance), reason=str(error))
            timings.append(_Timing(point, None))
        else:
            compiled = compiled or solver.compile_seconds
            timings.append(_Timing(_peer_point(problem, name, tolerance, answer), solver.solve))
        advance(1)
    return timings, compiled


def _peer_point(problem: Problem, name: str, tolerance: Fraction, answer: Answer) -> WorkPoint:
    if not all(abs(x) < float("inf") for x in answer.state):
        return failed(name, tolerance=text(tolerance), reason="left the range of float64")
    state = tuple(map(Fraction, answer.state))
    return WorkPoint(
        scheme=name,
        tolerance=f"{float(tolerance):.0e}",
        steps=answer.steps,
        evaluations=answer.evaluations,
        error=Value.of(*problem.error(state), SHOWN),
        energy=problem.energy_error(state),
        limited_by="tolerance",
    )


# -- number systems -------------------------------------------------------------------------------


def _system_points(
    problem: Problem, scheme: str, h: Fraction, pairs: Sequence[tuple[str, int]], repeats: int
) -> list[SystemPoint]:
    """Certified digits of the end state against run time, for each number system with its digits.

    The run times are those of one scheme at one step size.
    """

    def go(name: str, digits: int) -> RunResult:
        q, p = (shown_of(problem.hamiltonian, problem.point, letter) for letter in "qp")
        return run(
            problem.hamiltonian, scheme, q=q, p=p, step_size=h, t0=problem.t0,
            steps=problem.time // h, arithmetic=name, digits=digits, observables=(),
        )  # fmt: skip

    # A run's `seconds` are those of its steps: the first compiles before them, and counts as well.
    rounds = [[go(*each) for each in pairs] for _ in range(repeats)]
    points = []
    for k, ((name, digits), result) in enumerate(zip(pairs, rounds[0], strict=True)):
        taken = [each[k].seconds for each in rounds]
        timed: Timed | None = Timed(min(taken), median(taken))
        if name == float64.NAME:  # compiled, as it is in the other figures
            timed = _compiled_float(Ladder(problem, scheme), h, repeats)
        points.append(_system_point(name, digits, result, timed))
    return points


def _digits(name: str, asked: Sequence[int]) -> Sequence[int]:
    own = about(name).digits
    return asked if own is None else (own,)


def _compiled_float(ladder: Ladder, h: Fraction, repeats: int) -> Timed | None:
    taken, blank = interleaved([ladder.call(h), ladder.call(h, blank=True)], repeats)
    return above(taken, blank)


def _system_point(name: str, digits: int, result: RunResult, timed: Timed | None) -> SystemPoint:
    known = result.status == "finished"
    reason = result.fallback if known else f"{result.status}: {result.error_method}"
    return SystemPoint(
        arithmetic=result.arithmetic if known else name,
        digits=digits,
        certified=_digits_of_state(result) if known else None,
        error_kind=result.error_kind,
        error_method=result.error_method,
        seconds_min=timed.least if known and timed else None,
        seconds_median=timed.median if known and timed else None,
        reason=reason,
    )


def _digits_of_state(result: RunResult) -> str | None:
    """−lg(bound / size) of the state, with one decimal."""
    state = list(result.values.values())  # no observable was asked for
    if not state:
        return None
    length = size(tuple(Fraction(x.value) for x in state))
    bound = sum(Fraction(x.bound) for x in state)
    if not bound or not length:
        return None
    part = bound / length
    return f"{-lg(f'{part.numerator}/{part.denominator}'):.1f}"
