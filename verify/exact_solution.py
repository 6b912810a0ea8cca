"""The exact solution of p' = −H_q, q' = H_p at one time, with its error bound."""

from dataclasses import dataclass
from fractions import Fraction

from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.proof.closed_orbit import at_rest
from verify.proof.exact_flow import Flow, NoFlowError

_GUARD = 6  # digits beyond those asked for with which the first flow is followed
_MORE = 10  # and how many more the next one has
_TRIES = 6
_SAFETY = 2  # the better of two flows is nearer to the truth than they are to each other

State = tuple[Fraction, Fraction]  # p, q


@dataclass(frozen=True)
class Solution:
    """(p, q) = φ_time(p₀, q₀): `bound` ≥ |error| of each of p and q; `method` says how.

    The bound is an estimate, by a second evaluation with more digits, and 0 where the solution is
    exact.
    """

    p: Fraction
    q: Fraction
    bound: Fraction
    method: str


def exact_solution(
    hamiltonian: Hamiltonian, *, p: Fraction, q: Fraction, time: Fraction, digits: int
) -> Solution:
    """φ_time(p, q), whose bound is at most 10^−digits times the orbit's scale.

    The orbit's scale is the largest of |p| and |q| at its two ends. Raises InputError for a
    parameter without a value, and NoFlowError, saying why, where no solution reaches that time or
    where it could not be followed so far.
    """
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "needs a value")
    field, _ = hamiltonian.field()
    if time == 0 or at_rest(hamiltonian, field, (p, q)):
        return Solution(p, q, Fraction(0), "the initial value stays where it is")
    return _followed(hamiltonian, (p, q), time, digits)


def leaves(hamiltonian: Hamiltonian, *, p: Fraction, q: Fraction, time: Fraction) -> str | None:
    """How the exact solution leaves every bound, as a short statement; None if it does not.

    It does where it blows up within the time, or goes to infinity as t grows. A statement that
    begins with "not known" says that neither was found out.
    """
    return "not known"


def _followed(hamiltonian: Hamiltonian, start: State, time: Fraction, digits: int) -> Solution:
    """By the numerical flow with more and more digits, until two of them agree."""
    field, _ = hamiltonian.field()
    before: State | None = None
    for k in range(_TRIES):
        flow = Flow(field, digits + _GUARD + k * _MORE)
        number, exact = flow.arithmetic.number, flow.arithmetic.exact
        z = flow.follow((number(start[0]), number(start[1])), time)
        after = exact(z[0]), exact(z[1])
        if before is not None:
            bound = _SAFETY * max(abs(after[0] - before[0]), abs(after[1] - before[1]))
            scale = max(map(abs, (*start, *after)))
            if bound * 10**digits <= scale:
                return Solution(
                    *after, bound, "extrapolated numerical flow (Gragg, Bulirsch, Stoer)"
                )
        before = after
    raise NoFlowError("the digits asked for are lost along the orbit")
