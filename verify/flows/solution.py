"""The exact solution of p' = −H_q, q' = H_p at one time, with its error bound.

In closed form where one is known (the named systems, whoever wrote them down, and p²/2 + V(q) with
a polynomial V of degree up to 4), else by the numerical flow, with more digits until two agree.
The numerical flow is Gragg's method extrapolated, which at the orders that many digits need is
faster than the Lie series: to t = 100 with 30 and 60 digits 0.2 and 0.7 s against 1.1 and 5.0 s on
the Duffing oscillator, 0.2 and 1.1 s against 0.4 and 2.2 s on the pendulum, 0.9 and 3.5 s against
10 and 56 s on Lennard-Jones (tests/bench/exact_flows.py; the Lie series as power series in t, of
order 43 and 76, with steps as long as its last terms allow).

The numerical flow with more and more digits, until two agree; poles in t are found before.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.exact import plain
from verify.errors import InputError
from verify.flows import closed_form
from verify.flows.closed_orbit import at_rest, closed_orbit
from verify.flows.extrapolation import Flow, NoFlowError
from verify.hamiltonians import known_flows
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.times_on_the_way import first_fault

METHOD = "numerical flow: Gragg's method, extrapolated"
_GUARD = 6  # digits beyond those asked for with which the first flow is followed
_MORE = 10  # and how many more the next one has
_TRIES = 6
_SAFETY = 2  # the better of two flows is nearer to the truth than they are to each other
_PARTS = 1024  # of the time, in which poles of H are looked for


def check_poles(hamiltonian: Hamiltonian, t0: Fraction, time: Fraction) -> None:
    """NoFlowError where H is not smooth at some time on the way."""
    part = time / _PARTS
    passed, words = first_fault(hamiltonian, t0, part, _PARTS)
    if words:
        between = f"t = {plain(t0 + passed * part, 6)} and {plain(t0 + (passed + 1) * part, 6)}"
        raise NoFlowError(f"between {between} H is not smooth; it is where `{words}`")


def confirmed(
    field: CanonicalField, start: Sequence[Fraction], time: Fraction, digits: int
) -> tuple[list[Fraction], Fraction]:
    """The coordinates after the time and a bound of the error of each, an estimate; NoFlowError.

    `start`: the coordinates, and t where H depends on it.
    """
    coordinates = len(field.names)
    before: list[Fraction] | None = None
    for k in range(_TRIES):
        flow = Flow(field, digits + _GUARD + k * _MORE)
        z = flow.follow(tuple(map(flow.number, start)), time)
        after = [flow.arithmetic.exact(x) for x in z[:coordinates]]
        if before is not None:
            bound = _SAFETY * max(abs(x - y) for x, y in zip(after, before, strict=True))
            if bound * 10**digits <= max(map(abs, (*start[:coordinates], *after))):
                return after, bound
        before = after
    raise NoFlowError("the digits asked for are lost along the orbit")


_TOLD = 12  # digits of a time at which a solution ends
_ROUGH, _POINTS = 12, 8  # digits and points with which a closed orbit is looked for
NOT_KNOWN = "not known"

_FORCED = "closed form of the forced oscillator"  # the one that is known in time
_FROM_START = Fraction(0)
State = tuple[Fraction, Fraction]  # p, q
Point = Mapping[str, Fraction]
ITSELF = "the initial value itself"


@dataclass(frozen=True)
class Solution:
    """z = φ_time(z₀), the coordinates by their names: `bound` ≥ |error| of each; `method` says how.

    In closed form the bound is `enclosed`, by ball arithmetic, and 0 where the solution is exact;
    else it is an estimate, by a second evaluation with more digits.
    """

    point: Point
    bound: Fraction
    method: str
    enclosed: bool = True

    @property
    def p(self) -> Fraction:
        """In the plane."""
        return self.point["p"]

    @property
    def q(self) -> Fraction:
        """In the plane."""
        return self.point["q"]


def exact_solution(
    hamiltonian: Hamiltonian,
    *,
    p: Fraction,
    q: Fraction,
    time: Fraction,
    digits: int,
    t0: Fraction = _FROM_START,
) -> Solution:
    """φ_time(p, q), whose bound is at most 10^−digits times the orbit's scale.

    Where H depends on time the orbit begins at t0, and `time` is how long it lasts.
    The orbit's scale is the largest of |p| and |q| at its two ends. Time may be negative. Raises
    InputError for a parameter without a value and for an H of p1 … pn, q1 … qn, which
    `solution_in_degrees` takes, and NoFlowError, saying why, where no solution reaches that time or
    where it could not be followed so far.
    """
    _check(hamiltonian, digits)
    itself = Solution({"p": p, "q": q}, Fraction(0), ITSELF)
    if time == 0:
        return itself
    if hamiltonian.time_dependent:
        state = known_flows.state_in_time(hamiltonian, (p, q, t0), time)
        if state is not None:
            return _in_closed_form(closed_form.enclosed(state, (p, q), digits), _FORCED)
        return numerical_solution(hamiltonian, itself.point, time, digits, t0)
    known = known_flows.closed_form(hamiltonian, p, q)
    rest = known.rest if known else at_rest(hamiltonian, canonical_field(hamiltonian)[0], (p, q))
    if rest:
        return itself
    if known is not None:
        return _in_closed_form(closed_form.evaluate(known, (p, q), time, digits), known.method)
    return numerical_solution(hamiltonian, itself.point, time, digits)


def _in_closed_form(end: closed_form.Evaluation, method: str) -> Solution:
    return Solution({"p": end.p, "q": end.q}, end.bound, method)


def numerical_solution(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int, t0: Fraction = _FROM_START
) -> Solution:
    """By the numerical flow with more and more digits, until two of them agree."""
    check_poles(hamiltonian, t0, time)
    field, _ = canonical_field(hamiltonian)
    start = [*point.values(), *([t0] if field.timed else [])]
    after, bound = confirmed(field, start, time, digits)
    return Solution(dict(zip(point, after, strict=True)), bound, METHOD, enclosed=False)


def leaves(hamiltonian: Hamiltonian, *, p: Fraction, q: Fraction, time: Fraction) -> str | None:
    """How the exact solution leaves every bound, as a short statement; None if it does not.

    It does where it blows up until that time ≥ 0, or goes to infinity as t grows (a pendulum that
    goes round does, by its angle). A statement that begins with `NOT_KNOWN` says that neither was
    found out. For what is known in closed form the answer is by exact algebra; else None is by an
    orbit that was seen to close. Raises InputError and NoFlowError as `exact_solution` does where
    H is not defined at the initial value.
    """
    told = leaves_by_algebra(hamiltonian, p=p, q=q, time=time)
    return _reason_to_leave(hamiltonian, (p, q)) if told == NOT_KNOWN else told


def leaves_by_algebra(
    hamiltonian: Hamiltonian, *, p: Fraction, q: Fraction, time: Fraction
) -> str | None:
    """As `leaves`, without following the orbit: `NOT_KNOWN` where algebra alone does not tell."""
    _check(hamiltonian, _TOLD)
    if time < 0:
        raise InputError("time", str(time), "must not be negative")
    if hamiltonian.time_dependent:
        raise InputError("hamiltonian", hamiltonian.formula, "depends on t; allowed: one without")
    known = known_flows.closed_form(hamiltonian, p, q)
    if known is not None:
        end = closed_form.blow_up(known, 1, _TOLD)
        if end is None:
            return known.goes()
        return f"it blows up at t = {plain(end, 6)}" if closed_form.ends_by(known, time) else None
    if at_rest(hamiltonian, canonical_field(hamiltonian)[0], (p, q)):
        return None
    for match in known_flows.named(hamiltonian):
        if match.system.goes is not None:
            return match.system.goes(match.values, p, q)
    return NOT_KNOWN


def _check(hamiltonian: Hamiltonian, digits: int) -> None:
    hamiltonian.check_planar()
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "needs a value")
    if not 1 <= digits <= closed_form.MOST_DIGITS:
        raise InputError("digits", digits, f"must be 1 … {closed_form.MOST_DIGITS}")


def _reason_to_leave(hamiltonian: Hamiltonian, start: State) -> str | None:
    try:
        orbit = closed_orbit(hamiltonian, start, _ROUGH, _POINTS)
    except NoFlowError as error:
        return f"{NOT_KNOWN}: {error}"
    if orbit.kind == "rotation":
        return "it goes to infinity as t grows: it goes round"
    return None
