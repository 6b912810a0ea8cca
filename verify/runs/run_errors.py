"""Errors of a run's states against the exact motion: solution errors and drifts of energy.

The solution error is the distance of a state from the exact solution through the run's start.

The exact flow conserves H. A symplectic scheme conserves its modified Hamiltonian H̃, truncated
after a power of h, up to the next power: the more terms, the smaller is the remainder, as long as h
is small enough for the series (Hairer, Lubich, Wanner, Geometric Numerical Integration, IX.8).
Energies are enclosed by balls at the states as they are noted; a drift is the difference of two
midpoints, as accurate as the noted states.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import isqrt
from typing import NamedTuple

from verify import schemes
from verify.algebra.enclosure import Enclosures
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.exact import whole
from verify.arithmetic.number_system import bits_for
from verify.arithmetic.systems import float64
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import ExactSolution, solution_from
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane.modified_equation import ModifiedEquation
from verify.proof.plane.modified_for_one_h import MOST_ORDER, modified_for_one_h
from verify.runs.orbit_table import orbit_of
from verify.runs.run_start import Start
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.run import MOST_POINTS, EnergyDrift, RunResult

_ERROR_DIGITS = 7  # limit of the digits of an error that are printed
_LEAST_EXACT_DIGITS = 25  # digits of the exact solution, relative to the orbit's size
_ROOT_BITS = 256  # binary places of a square root
_GUARD_BITS = 60  # bits that may cancel in a difference of energies
_POINTS = 1000  # default limit of the points of a drift


class _ExactState(NamedTuple):
    """A state of the exact solution, with the bound of the error of each coordinate."""

    coordinates: tuple[Fraction, ...]
    bound: Fraction


# -- solution errors ------------------------------------------------------------------------------


def solution_errors(result: RunResult, points: int = 200) -> tuple[tuple[Fraction, Value], ...]:
    """Return (t, |z − φ_t(z₀)|), Euclidean in all coordinates, at states of the run.

    `points`: the limit of the number of states. For a float64 run z are the run's own numbers. The
    bound includes that of the exact solution. If no closed form is known, the solution is followed
    from state to state, and the bound is an estimate: it includes the distance of its end from a
    solution that is followed to the last time at once. Raises InputError if the solution cannot be
    followed so far.
    """
    table, start = orbit_of(result, points), Start.from_result(result)
    times = [Fraction(t) for t in table.texts("t")]
    states = zip(*(map(Fraction, table.texts(name)) for name in start.point), strict=True)
    digits = max(_LEAST_EXACT_DIGITS, result.digits + _ERROR_DIGITS)
    try:
        exact = list(_solve_at(start, times, digits))
    except NoFlowError as error:
        problem = f"no exact solution to hold it to: {error}"
        raise InputError("run", result.scheme, problem) from None
    return tuple(
        (t, _distance(state, exact_state))
        for t, state, exact_state in zip(times, states, exact, strict=True)
    )


def _solve_at(start: Start, times: list[Fraction], digits: int) -> Iterator[_ExactState]:
    """Yield the exact solution at each time, with its bound."""
    last = solution_from(start.hamiltonian, start.point, times[-1] - start.t0, digits, start.t0)
    # Without a closed form a solution from the start for each time takes long: one walk visits all
    # times.
    if not last.enclosed:
        yield from _follow(start, times, digits, last)
        return
    for t in times:
        solution = solution_from(start.hamiltonian, start.point, t - start.t0, digits, start.t0)
        yield _ExactState(tuple(solution.point.values()), solution.bound)


def _follow(
    start: Start, times: list[Fraction], digits: int, last: ExactSolution
) -> Iterator[_ExactState]:
    """Follow the solution from one time to the next; compare its end with `last`.

    `last` was followed to the end at once. The end shows how much errors grow on the way, as they
    are taken to be greatest there.
    """
    rows: list[_ExactState] = []
    point, before, total = start.point, start.t0, Fraction(0)
    for t in times:
        solution = solution_from(start.hamiltonian, point, t - before, digits, before)
        # The errors of the pieces add up; their growth along the orbit is in `mismatch` instead.
        point, before, total = solution.point, t, total + solution.bound
        rows.append(_ExactState(tuple(point.values()), total))
    mismatch = max(abs(last.point[name] - point[name]) for name in point) + last.bound
    for state in rows:
        yield state._replace(bound=max(state.bound, mismatch))


def _distance(state: Sequence[Fraction], exact: _ExactState) -> Value:
    # The integer square root is within 2^−_ROOT_BITS of the root, which the bound includes.
    pairs = zip(state, exact.coordinates, strict=True)
    square = sum(((x - y) ** 2 for x, y in pairs), Fraction(0))
    scale = 1 << (2 * _ROOT_BITS)
    size = Fraction(isqrt(square.numerator * scale // square.denominator), 1 << _ROOT_BITS)
    bound = len(state) * exact.bound + Fraction(1, 1 << _ROOT_BITS)
    return Value.from_bound(size, bound, _ERROR_DIGITS)


# -- drifts of energy -----------------------------------------------------------------------------


def energy_drifts(result: RunResult, order: int = 4, points: int = _POINTS) -> list[EnergyDrift]:
    """Return the drifts of H, and of H̃ truncated after each of its terms up to h^order.

    Terms that are 0 are skipped. `points`: the limit of the number of states. Raises InputError if
    the scheme has no modified Hamiltonian that differs from H, as when the first term is not
    Hamiltonian, and for an H that depends on time, whose value no scheme conserves.
    """
    whole("order", order, 1, MOST_ORDER)
    whole("points", points, 1, MOST_POINTS)
    hamiltonian = Hamiltonian.parse(result.hamiltonian, result.parameters)
    if hamiltonian.time_dependent:
        problem = "depends on t: no energy is kept, and its drift says nothing"
        raise InputError("hamiltonian", hamiltonian.formula, problem)
    scheme = schemes.get(result.scheme)
    equation = modified_for_one_h(scheme.step_map(hamiltonian), scheme, order)
    ring, energies = _energies(equation)
    if len(energies) < 2:
        reason = f"has no modified Hamiltonian but H, up to h^{order}: {equation.reason}"
        raise InputError("run", result.scheme, reason)
    table = orbit_of(result, points)
    binary = result.arithmetic == float64.NAME
    rows = list(zip(*(_numbers(table.texts(n), binary) for n in ("p", "q")), strict=True))
    step_size = Fraction(result.step_size)
    enclosures = Enclosures(ring, [x for _, x in energies])
    # H̃ has high powers of the state, and a drift is a small difference of large energies.
    bits = (
        4 * bits_for(float64.NUMBER_SYSTEM.digits or 17 if binary else result.digits) + _GUARD_BITS
    )
    balls = [enclosures.enclose_at({"p": p, "q": q, "h": step_size}, bits) for p, q in rows]
    start = balls[0]
    t = tuple(Fraction(text) for text in table.texts("t"))
    return [
        EnergyDrift(
            power,
            t,
            tuple(None if z is None or start is None else float(z[k] - start[k]) for z in balls),
        )
        for k, (power, _) in enumerate(energies)
    ]


def _energies(equation: ModifiedEquation) -> tuple[Ring, list[tuple[int, Poly]]]:
    """Return H̃ truncated after each term that is not 0, with the power of h of that term."""
    energies: list[tuple[int, Poly]] = []
    for term in equation.known:
        assert term.energy is not None  # noqa: S101 - set for every known term of one H
        ring, x = term.energy
        if term.power == 0 or not x.is_zero():
            # Each energy adds one term h^k H_k to the one before.
            before = energies[-1][1] if energies else ring.zero
            energies.append((term.power, before + ring.variable("h") ** term.power * x))
    if not energies:
        raise InputError("run", equation.scheme, "H is not found as an energy of the first term")
    return ring, energies


def _numbers(texts: Sequence[str], binary: bool) -> list[Fraction]:
    """Return the exact numbers of a column; for a float64 run, those of its doubles."""
    return [Fraction(float(text)) if binary else Fraction(text) for text in texts]
