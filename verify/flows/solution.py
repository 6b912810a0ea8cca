"""The exact solution of p' = −H_q, q' = H_p at one time, with its error bound.

H is split into its uncoupled parts. A part in one degree of freedom has a closed form where
one is known (the named systems, whoever wrote them down, and p²/2 + V(q) with a polynomial V of
degree up to 4); so has Kepler's problem if the orbit is an ellipse. Every other part is followed by
the numerical flow, with more and more digits until two runs agree. Poles of H in t are searched
first.

The numerical flow is Gragg's method extrapolated, which at the orders that many digits need is
faster than the Lie series: to t = 100 with 30 and 60 digits 0.2 and 0.7 s against 1.1 and 5.0 s on
the Duffing oscillator, 0.2 and 1.1 s against 0.4 and 2.2 s on the pendulum, 0.9 and 3.5 s against
10 and 56 s on Lennard-Jones (tests/bench/exact_flows.py; the Lie series as power series in t, of
order 43 and 76, with steps as long as its last terms allow).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import NumberOrList, plain
from verify.effort import MAX_CALLS, answer_unless_long
from verify.errors import InputError
from verify.flows import ball_evaluation
from verify.flows.closed_orbit import is_equilibrium
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians import flow_recognition
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.flow_recognition import uncouple
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import find_first_fault, point_of
from verify.hamiltonians.systems import get
from verify.hamiltonians.systems.several.kepler import is_ellipse, state_on_ellipse
from verify.structures import AREA, SYMPLECTIC

Point = Mapping[str, Fraction]
METHOD = "numerical flow: Gragg's method, extrapolated"
_FORCED_METHOD = "closed form of the forced oscillator"  # the only one of an H with t
_ELLIPSE_METHOD = "closed form of Kepler's ellipse"
ITSELF = "the initial value itself"
NOT_KNOWN = "not known"
_FROM_START = Fraction(0)
_GUARD_DIGITS = 6  # digits of the first flow beyond the requested ones
_EXTRA_DIGITS = 10  # digits that each later flow adds
_ATTEMPTS = 6
_SAFETY = 2  # ratio of the estimated bound to the difference of two flows
_POLE_INTERVALS = 1024  # parts of the time, in each of which poles of H are searched
_TIME_DIGITS = 12  # the digits to which a blow-up time is computed


@dataclass(frozen=True)
class ExactSolution:
    """The state z = φ_time(z₀), with a bound of the error of each coordinate.

    `point` has a rational for each coordinate, by name; `bound` ≥ |error| of each. `method` says
    how it was computed. If `enclosed`, the solution has a closed form and the bound comes from ball
    arithmetic, or is 0 as `point` is exact; else the bound is an estimate by a second evaluation
    with more digits.
    """

    point: Point
    bound: Fraction
    method: str
    enclosed: bool = True

    @property
    def p(self) -> Fraction:
        """The momentum, in the plane."""
        return self.point["p"]

    @property
    def q(self) -> Fraction:
        """The displacement, in the plane."""
        return self.point["q"]


def exact_solution(
    hamiltonian: Hamiltonian,
    *,
    p: NumberOrList,
    q: NumberOrList,
    time: Fraction,
    digits: int,
    t0: Fraction = _FROM_START,
) -> ExactSolution:
    """Return the exact solution of Hamilton's equations after a time, φ_time(q, p), with its bound.

    `p`, `q`: the initial value, a number each in the plane and a list of n numbers each in n
    degrees of freedom. `time`: how long the solution lasts, in the unit of t; it may be negative.
    `digits`: from 1 to 10,000; the bound of each coordinate is at most 10^−digits times the largest
    coordinate, in size, at the two ends. `t0`: the time at which it begins, where H depends on t.

    Returns an `ExactSolution`. Raises InputError for a parameter without a value, a number of
    digits out of range and lists of another length, and NoFlowError, whose message says why, if
    no solution reaches that time or if it could not be followed so far.
    """
    return solution_from(hamiltonian, point_of(hamiltonian, q, p), time, digits, t0)


def solution_from(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int, t0: Fraction = _FROM_START
) -> ExactSolution:
    """Return φ_time(point), with a bound of at most 10^−digits times the orbit's scale.

    Where H depends on time the orbit begins at t0, and `time` is how long it lasts.
    The orbit's scale is the largest coordinate, in size, at its two ends. Time may be negative.
    Raises InputError for a parameter without a value, and NoFlowError, saying why, if no
    solution reaches that time or if it could not be followed so far.
    """
    _check(hamiltonian, digits)
    if time == 0:
        return ExactSolution(point, Fraction(0), ITSELF)
    coordinates: dict[str, Fraction] = {}
    solutions = []
    for part, names in uncouple(hamiltonian):
        part_point = {name: point[old] for name, old in zip(part.coordinates, names, strict=True)}
        solve_closed_form = {AREA: _solve_in_plane, SYMPLECTIC: _solve_ellipse}[part.structure]
        solution = solve_closed_form(part, part_point, time, digits, t0)
        solutions.append(solution or numerical_solution(part, part_point, time, digits, t0))
        coordinates |= dict(zip(names, solutions[-1].point.values(), strict=True))
    return ExactSolution(
        {name: coordinates[name] for name in hamiltonian.coordinates},
        max(solution.bound for solution in solutions),
        "; ".join(dict.fromkeys(solution.method for solution in solutions)),
        all(solution.enclosed for solution in solutions),
    )


def _check(hamiltonian: Hamiltonian, digits: int) -> None:
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "needs a value")
    if not 1 <= digits <= ball_evaluation.MOST_DIGITS:
        raise InputError("digits", digits, f"must be 1 … {ball_evaluation.MOST_DIGITS}")


# -- in closed form -------------------------------------------------------------------------------


def _closed_form_solution(
    point: Point, evaluation: ball_evaluation.Evaluation, method: str
) -> ExactSolution:
    after, bound = evaluation
    return ExactSolution(dict(zip(point, after, strict=True)), bound, method)


def _solve_in_plane(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int, t0: Fraction
) -> ExactSolution | None:
    """Return the solution in closed form, or None if no closed form is known."""
    p, q = start = tuple(point.values())
    if hamiltonian.time_dependent:
        state = flow_recognition.state_in_time(hamiltonian, (p, q, t0), time)
        if state is None:
            return None
        return _closed_form_solution(
            point, ball_evaluation.evaluate_enclosure(state, start, digits), _FORCED_METHOD
        )
    motion = flow_recognition.closed_form(hamiltonian, p, q)
    is_at_rest = (
        motion.is_at_rest
        if motion
        else is_equilibrium(hamiltonian, canonical_field(hamiltonian)[0], (p, q))
    )
    if is_at_rest:
        return ExactSolution(point, Fraction(0), ITSELF)
    if motion is None:
        return None
    return _closed_form_solution(
        point, ball_evaluation.evaluate(motion, start, time, digits), motion.method
    )


def _solve_ellipse(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int, t0: Fraction
) -> ExactSolution | None:
    """Return the closed form if H is Kepler's and the orbit is an ellipse, else None."""
    mu = answer_unless_long(lambda: _kepler_strength(hamiltonian), None, MAX_CALLS)
    if mu is None:
        return None
    p1, p2, q1, q2 = start = tuple(point.values())
    q, p = (q1, q2), (p1, p2)
    if not is_ellipse(mu, q, p):
        return None
    after = ball_evaluation.evaluate_enclosure(
        lambda: state_on_ellipse(mu, q, p, time), start, digits
    )
    return _closed_form_solution(point, after, _ELLIPSE_METHOD)


@lru_cache(maxsize=64)
def _kepler_strength(hamiltonian: Hamiltonian) -> Fraction | None:
    """Return μ if H is that of Kepler's problem plus a constant, else None."""
    kepler = get("kepler").hamiltonian({}).expression
    if len(hamiltonian.coordinates) != 4 or hamiltonian.time_dependent:
        return None
    if hamiltonian.exact.is_polynomial():  # a quick test, as simplifying takes seconds
        return None
    mu = symbol("mu")
    # At p = 0, Kepler's H is −μ at q = (1, 0) and −μ/2 at q = (2, 0): their difference, which a
    # constant does not change, is μ/2.
    points = [dict.fromkeys(map(symbol, ("p1", "p2", "q2")), 0) | {symbol("q1"): k} for k in (1, 2)]
    first, second = (hamiltonian.exact.subs(x) for x in points)
    value = sympy.nsimplify(2 * (second - first)) if (second - first).is_number else None
    if value is None or not value.is_Rational:
        return None
    difference = sympy.simplify(hamiltonian.exact - kepler.subs(mu, value))
    is_constant = difference.is_number and not difference.free_symbols
    return Fraction(int(value.p), int(value.q)) if is_constant else None


def leaves_by_algebra(
    hamiltonian: Hamiltonian, *, p: Fraction, q: Fraction, time: Fraction
) -> str | None:
    """Describe how the exact solution leaves every bound; None if it does not.

    A solution leaves if it blows up by `time` ≥ 0, or if it goes to infinity as t grows (so does
    the angle of a pendulum that goes round). The answer is by exact algebra, and `NOT_KNOWN` if
    that does not decide. Raises InputError as `exact_solution` does, and for an H that depends on
    t, and NoFlowError if H is not defined at the initial value.
    """
    hamiltonian.check_planar()
    _check(hamiltonian, _TIME_DIGITS)
    if time < 0:
        raise InputError("time", str(time), "must not be negative")
    if hamiltonian.time_dependent:
        raise InputError("hamiltonian", hamiltonian.formula, "depends on t; allowed: one without")
    motion = flow_recognition.closed_form(hamiltonian, p, q)
    if motion is not None:
        end = ball_evaluation.blow_up(motion, 1, _TIME_DIGITS)
        if end is None:
            return motion.goes()
        return (
            f"it blows up at t = {plain(end, 6)}"
            if ball_evaluation.may_end_by(motion, time)
            else None
        )
    if is_equilibrium(hamiltonian, canonical_field(hamiltonian)[0], (p, q)):
        return None
    for match in flow_recognition.named_systems(hamiltonian):
        if match.system.goes is not None:
            return match.system.goes(match.values, p, q)
    return NOT_KNOWN


# -- by the numerical flow ------------------------------------------------------------------------


def numerical_solution(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int, t0: Fraction = _FROM_START
) -> ExactSolution:
    """Solve by the numerical flow with more and more digits, until two runs agree."""
    check_poles(hamiltonian, t0, time)
    field, _ = canonical_field(hamiltonian)
    start = [*point.values(), *([t0] if field.timed else [])]
    after, bound = follow_confirmed(field, start, time, digits)
    return ExactSolution(dict(zip(point, after, strict=True)), bound, METHOD, enclosed=False)


def check_poles(hamiltonian: Hamiltonian, t0: Fraction, time: Fraction) -> None:
    """Raise NoFlowError if H is not smooth at some time between t0 and t0 + time."""
    part = time / _POLE_INTERVALS
    fault = find_first_fault(hamiltonian, t0, part, _POLE_INTERVALS)
    if fault is not None:
        begin = t0 + fault.step * part
        between = f"t = {plain(begin, 6)} and {plain(begin + part, 6)}"
        raise NoFlowError(f"between {between} H is not smooth; it is where `{fault.condition}`")


def follow_confirmed(
    field: CanonicalField, start: Sequence[Fraction], time: Fraction, digits: int
) -> tuple[list[Fraction], Fraction]:
    """Follow the numerical flow with more and more digits until two runs agree.

    Returns the coordinates after the time and a bound of the error of each, which is an estimate.
    `start`: the coordinates, and t where H depends on it. Raises NoFlowError.
    """
    coordinates = len(field.names)
    before: list[Fraction] | None = None
    for k in range(_ATTEMPTS):
        flow = NumericalFlow(field, digits + _GUARD_DIGITS + k * _EXTRA_DIGITS)
        z = flow.follow(tuple(map(flow.number, start)), time)
        after = [flow.arithmetic.exact(x) for x in z[:coordinates]]
        if before is not None:
            # The error of the finer flow is well below the difference of the two; the factor
            # allows for a coarser one that is right by luck.
            bound = _SAFETY * max(abs(x - y) for x, y in zip(after, before, strict=True))
            if bound * 10**digits <= max(map(abs, (*start[:coordinates], *after))):
                return after, bound
        before = after
    raise NoFlowError("the digits asked for are lost along the orbit")
