"""How far a run's states are from the exact solution through its start."""

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
    """(t, |z − φ_t(z₀)|), Euclidean in all coordinates, at so many states of the run at most.

    That of a float64 run is of its own numbers. The bound holds the exact solution's. Where no
    closed form is known the solution is followed from state to state, and the bound is an estimate:
    it holds how far that ends from the solution which is followed to the last state at once.
    Raises InputError where it cannot be followed so far.
    """
    table, begun = orbit_of(result, points), Start.of(result)
    times = [Fraction(t) for t in table.texts("t")]
    states = zip(*(table.texts(name) for name in begun.point), strict=True)
    digits = max(_MORE, result.digits + _DIGITS)
    try:
        exact = list(_solution(begun, times, digits))
    except NoFlowError as error:
        problem = f"no exact solution to hold it to: {error}"
        raise InputError("run", result.scheme, problem) from None
    return tuple(
        (t, _distance([Fraction(x) - y for x, y in zip(state, true, strict=True)], bound))
        for t, state, (true, bound) in zip(times, states, exact, strict=True)
    )


def _solution(begun: Start, times: list[Fraction], digits: int) -> Iterator[_Point]:
    """The solution and the bound of each coordinate at the times."""
    whole = solution_from(begun.hamiltonian, begun.point, times[-1] - begun.t0, digits, begun.t0)
    if not whole.enclosed:
        yield from _followed(begun, times, digits, whole)
        return
    for t in times:
        found = solution_from(begun.hamiltonian, begun.point, t - begun.t0, digits, begun.t0)
        yield tuple(found.point.values()), found.bound


def _followed(
    begun: Start, times: list[Fraction], digits: int, whole: Solution
) -> Iterator[_Point]:
    """The solution from one time to the next, held at its end to the one of a single piece.

    What errors grow by on the way is seen there: it is least at first and most at the end.
    """
    made: list[_Point] = []
    point, before, total = begun.point, begun.t0, Fraction(0)
    for t in times:
        found = solution_from(begun.hamiltonian, point, t - before, digits, before)
        point, before, total = found.point, t, total + found.bound
        made.append((tuple(point.values()), total))
    missed = max(abs(whole.point[name] - point[name]) for name in point) + whole.bound
    for state, bound in made:
        yield state, max(bound, missed)


def _distance(apart: Sequence[Fraction], bound: Fraction) -> Value:
    square = sum((x * x for x in apart), Fraction(0))
    scale = 1 << (2 * _BITS)
    size = Fraction(isqrt(square.numerator * scale // square.denominator), 1 << _BITS)
    return Value.of(size, len(apart) * bound + Fraction(1, 1 << _BITS), _DIGITS)
