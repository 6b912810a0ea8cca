"""How far a run's states are from the exact solution through its start."""

from collections.abc import Iterator
from fractions import Fraction
from math import isqrt

from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import exact_solution
from verify.hamiltonians import known_flows
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.orbit import orbit_of
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import RunResult

_DIGITS = 7  # of an error, at most
_MORE = 25  # digits of the exact solution, of the orbit's size
_BITS = 256  # of a square root
_State = tuple[Fraction, Fraction]  # p, q
_Point = tuple[Fraction, Fraction, Fraction]  # p, q, and the bound of both


def solution_errors(result: RunResult, points: int = 200) -> tuple[tuple[Fraction, Value], ...]:
    """(t, |z − φ_t(z₀)|), Euclidean in (p, q), at so many states of the run at most.

    That of a float64 run is of its own numbers. The bound holds the exact solution's. Where no
    closed form is known the solution is followed from state to state, and the bound is an estimate:
    it holds how far that ends from the solution which is followed to the last state at once.
    Raises InputError where it cannot be followed so far.
    """
    table = orbit_of(result, points)
    hamiltonian = Hamiltonian.parse(result.hamiltonian, result.parameters)
    t0 = Fraction(result.t0)
    times = [Fraction(t) for t in table.texts("t")]
    states = zip(table.texts("p"), table.texts("q"), strict=True)
    q, p = map(Fraction, result.plane_start)
    start = p, q
    digits = max(_MORE, result.digits + _DIGITS)
    try:
        exact = list(_solution(hamiltonian, start, t0, times, digits))
    except NoFlowError as error:
        problem = f"no exact solution to hold it to: {error}"
        raise InputError("run", result.scheme, problem) from None
    return tuple(
        (t, _distance(Fraction(p) - p_0, Fraction(q) - q_0, bound))
        for t, (p, q), (p_0, q_0, bound) in zip(times, states, exact, strict=True)
    )


def _solution(
    hamiltonian: Hamiltonian, start: _State, t0: Fraction, times: list[Fraction], digits: int
) -> Iterator[_Point]:
    """p, q and the bound of each at the times, of an orbit that begins at t0."""
    if known_flows.closed_form(hamiltonian, *start) is None:
        yield from _followed(hamiltonian, start, t0, times, digits)
        return
    for t in times:
        found = exact_solution(hamiltonian, p=start[0], q=start[1], time=t - t0, digits=digits)
        yield found.p, found.q, found.bound


def _followed(
    hamiltonian: Hamiltonian, start: _State, t0: Fraction, times: list[Fraction], digits: int
) -> Iterator[_Point]:
    """The solution from one time to the next, held at its end to the one of a single piece.

    What errors grow by on the way is seen there: it is least at first and most at the end.
    """
    made: list[_Point] = []
    (p, q), before, total = start, t0, Fraction(0)
    for t in times:
        found = exact_solution(hamiltonian, p=p, q=q, time=t - before, digits=digits, t0=before)
        p, q, before, total = found.p, found.q, t, total + found.bound
        made.append((p, q, total))
    whole = exact_solution(
        hamiltonian, p=start[0], q=start[1], time=before - t0, digits=digits, t0=t0
    )
    missed = max(abs(whole.p - p), abs(whole.q - q)) + whole.bound
    for p, q, bound in made:
        yield p, q, max(bound, missed)


def _distance(p: Fraction, q: Fraction, bound: Fraction) -> Value:
    square = p * p + q * q
    scale = 1 << (2 * _BITS)
    size = Fraction(isqrt(square.numerator * scale // square.denominator), 1 << _BITS)
    return Value.of(size, 2 * bound + Fraction(1, 1 << _BITS), _DIGITS)
