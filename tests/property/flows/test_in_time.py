"""The exact flow of an H that depends on time, held against mpmath's Taylor series and itself."""

from fractions import Fraction

import mpmath
import pytest

from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import ExactSolution, exact_solution, leaves_by_algebra
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.runs.run_errors import solution_errors

START = {"p": Fraction(0), "q": Fraction(3, 2)}
PENDULUM = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"
# H, and p' and q' written out by hand
CASES = {
    PENDULUM: lambda t, p, q: (-(1 + mpmath.cos(2 * t) / 2) * mpmath.sin(q), p),
    "p**2/(2*(1 + t**2)) + t*q**3": lambda t, p, q: (-3 * t * q * q, p / (1 + t * t)),
    "p*q*sin(t) + exp(-t)*p**2/2": lambda t, p, q: (
        -p * mpmath.sin(t), q * mpmath.sin(t) + mpmath.exp(-t) * p),
}  # fmt: skip


def flow(
    formula: str, time: object, t0: object, digits: int = 25, **start: Fraction
) -> ExactSolution:
    hamiltonian = Hamiltonian.parse(formula)
    at = {**START, **start}
    return exact_solution(
        hamiltonian, p=at["p"], q=at["q"], time=Fraction(str(time)), t0=Fraction(str(t0)),
        digits=digits,
    )  # fmt: skip


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize("formula", CASES)
@pytest.mark.parametrize(("t0", "time"), [("0", "1.5"), ("1/3", "-0.7")])
def test_it_is_that_of_mpmath(formula: str, t0: str, time: str) -> None:
    found, slope = flow(formula, time, t0), CASES[formula]
    with mpmath.workdps(30):
        begin, length = (mpmath.mpf(x.numerator) / x.denominator for x in map(Fraction, (t0, time)))
        sign = mpmath.sign(length)
        # backwards as the flow of −f over a time that grows
        solved = mpmath.odefun(
            lambda s, z: [sign * x for x in slope(begin + sign * s, *z)], 0, [0, mpmath.mpf("1.5")]
        )
        p, q = solved(abs(length))
        for ours, theirs in ((found.p, p), (found.q, q)):
            assert abs(mpmath.mpf(ours.numerator) / ours.denominator - theirs) < 1e-22
    assert not found.enclosed


def test_there_and_back_and_in_two_pieces() -> None:
    there = flow(PENDULUM, 3, "1/3")
    back = flow(PENDULUM, -3, "10/3", p=there.p, q=there.q)
    assert abs(back.p) + abs(back.q - Fraction(3, 2)) < Fraction(1, 10**22)
    middle = flow(PENDULUM, 1, "1/3")
    whole = flow(PENDULUM, 2, "4/3", p=middle.p, q=middle.q)
    assert abs(whole.q - there.q) < Fraction(1, 10**22)


def test_the_start_counts() -> None:
    """The negative control: the flow from another t0 is another one."""
    assert abs(flow(PENDULUM, 3, 0).q - flow(PENDULUM, 3, "1/100").q) > Fraction(1, 1000)


def test_where_h_opens_it_is_said_and_no_value_given() -> None:
    for t0, time in ((0, 2), (2, -2)):
        with pytest.raises(NoFlowError, match="H is not smooth; it is where"):
            flow("p**2/2 + q**2/(2*(1 - t)**2)", time, t0)
    before = flow("p**2/2 + q**2/(2*(1 - t)**2)", "1/2", 0)
    assert before.bound < Fraction(1, 10**20)


def test_whether_it_stays_bounded_is_not_told_of_such_an_h() -> None:
    with pytest.raises(InputError, match="depends on t"):
        leaves_by_algebra(Hamiltonian.parse(PENDULUM), **START, time=Fraction(1))


def test_solution_errors_of_a_run_shrink_with_its_order() -> None:
    hamiltonian = Hamiltonian.parse(PENDULUM)

    def last(h: Fraction) -> Fraction:
        made = run(hamiltonian, "rk4", **START, step_size=h, steps=int(2 / h), t0="1/3")
        time, error = solution_errors(made, 4)[-1]
        assert time == Fraction(7, 3)
        return Fraction(error.value)

    assert 12 < last(Fraction(1, 10)) / last(Fraction(1, 20)) < 20
