"""The solution error: distances of a run's states from the exact solution through its start."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import isqrt

from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import Solution, solution_from
from verify.runs.orbit import orbit_of
from verify.runs.start import Start
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult

_DIGITS = 7  # of an error, at most
_MORE = 25  # digits of the exact solution, of the orbit's size
_BITS = 256  # of a square root
_Point = tuple[tuple[Fraction, ...], Fraction]  # the coordinates, and the bound of each


def solution_errors(result: RunResult, points: int = 200) -> tuple[tuple[Fraction, Value], ...]:
    """Return (t, |z − φ_t(z₀)|), Euclidean in all coordinates, at up to so many states of the run.

    For a float64 run z are its own numbers. The bound includes that of the exact solution. Where no
    closed form is known the solution is followed from state to state, and the bound is an estimate:
    it includes the distance of its end from a solution that is followed to the last state at once.
    Raises InputError where it cannot be followed so far.
    """
    table, start = orbit_of(result, points), Start.from_result(result)
    times = [Fraction(t) for t in table.texts("t")]
    states = zip(*(table.texts(name) for name in start.point), strict=True)
    digits = max(_MORE, result.digits + _DIGITS)
    try:
        exact = list(_solve_at(start, times, digits))
    except NoFlowError as error:
        problem = f"no exact solution to hold it to: {error}"
        raise InputError("run", result.scheme, problem) from None
    return tuple(
        (t, _distance([Fraction(x) - y for x, y in zip(state, true, strict=True)], bound))
        for t, state, (true, bound) in zip(times, states, exact, strict=True)
    )


def _solve_at(start: Start, times: list[Fraction], digits: int) -> Iterator[_Point]:
    """Yield the solution and the bound of each coordinate at the times."""
    whole = solution_from(start.hamiltonian, start.point, times[-1] - start.t0, digits, start.t0)
    # Without a closed form each time would need a solution from the start: one walk visits all of
    # them.
    if not whole.enclosed:
        yield from _follow(start, times, digits, whole)
        return
    for t in times:
        solution = solution_from(start.hamiltonian, start.point, t - start.t0, digits, start.t0)
        yield tuple(solution.point.values()), solution.bound


def _follow(start: Start, times: list[Fraction], digits: int, whole: Solution) -> Iterator[_Point]:
    """Follow the solution from one time to the next, and compare its end with that of one piece.

    The end shows how much errors grow on the way: they are least at first and greatest there.
    """
    rows: list[_Point] = []
    point, before, total = start.point, start.t0, Fraction(0)
    for t in times:
        solution = solution_from(start.hamiltonian, point, t - before, digits, before)
        # The errors of the pieces add up; what they grow by on the way is not among them, but in
        # `mismatch`.
        point, before, total = solution.point, t, total + solution.bound
        rows.append((tuple(point.values()), total))
    mismatch = max(abs(whole.point[name] - point[name]) for name in point) + whole.bound
    for state, bound in rows:
        yield state, max(bound, mismatch)


def _distance(difference: Sequence[Fraction], bound: Fraction) -> Value:
    # The integer square root is within 2^−_BITS of the root, which the bound includes.
    square = sum((x * x for x in difference), Fraction(0))
    scale = 1 << (2 * _BITS)
    size = Fraction(isqrt(square.numerator * scale // square.denominator), 1 << _BITS)
    return Value.from_bound(size, len(difference) * bound + Fraction(1, 1 << _BITS), _DIGITS)
