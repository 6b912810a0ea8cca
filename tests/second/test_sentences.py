"""What Section 2 and 3 say of derivatives, of every step, and of what MSE(J) measures."""

import math
from fractions import Fraction
from random import Random
from typing import Any

import mpmath
import pytest
import sympy

from tests.second.maps import (
    Map,
    defects,
    determinant,
    duffing,
    mse,
    pendulum,
    states,
    symplectic_euler,
)

P, Q, H, T = sympy.symbols("p q h t")


def lie(hamiltonian: Any, y: Any) -> Any:
    """Eq. 5: the sum of both parts' derivatives."""
    slope = sympy.diff(hamiltonian, P) * sympy.diff(y, Q)
    return sympy.expand(slope - sympy.diff(hamiltonian, Q) * sympy.diff(y, P))


def powers(hamiltonian: Any, y: Any, order: int) -> list[Any]:
    """y, Xy, …"""
    made = [y]
    for _ in range(order):
        made.append(lie(hamiltonian, made[-1]))
    return made


def rotation(c: float, s: float) -> Map:
    return lambda p, q: (c * p - s * q, c * q + s * p)


# -- MSE and the solution --------------------------------------------------------------------------


@pytest.mark.parametrize(("n", "error"), [(10, 0.0425), (100, 0.00421), (1000, 0.000421)])
def test_symplectic_euler_has_no_mse_and_an_error_in_its_solution(n: int, error: float) -> None:
    p, q = states(symplectic_euler(1 / n, delta=0), 0.0, 1.0, n)[-1]
    off = max(abs(q - math.cos(1)), abs(p + math.sin(1)))
    assert off == pytest.approx(error, rel=2e-3)
    exactly = symplectic_euler(Fraction(1, n), delta=0)
    assert mse(defects(exactly, Fraction(0), Fraction(1), 10)) == 0


def test_the_exact_flow_of_another_frequency_has_no_mse_and_no_accuracy_at_all() -> None:
    """The error does not go to 0 with h either."""
    for n in (10, 100, 1000):
        h = 2.0 / n
        turn = rotation(math.cos(h), math.sin(h))
        assert abs(determinant(turn, 0.0, 1.0) - 1) < 1e-15
        _, q = states(turn, 0.0, 1.0, n)[-1]
        assert abs(q - math.cos(1)) > 0.9


# -- derivatives -----------------------------------------------------------------------------------


def test_a_linear_system_has_higher_derivatives_of_functions_too() -> None:
    linear = P**2 / 2 + P * Q + Q**2
    first, second = powers(linear, Q, 2)[1:]
    assert sympy.Poly(first, P, Q).terms() == [((1, 0), 1), ((0, 1), 1)]  # p + q: no variable
    assert second == -Q
    assert [sympy.Poly(sympy.diff(linear, z), P, Q).total_degree() for z in (P, Q)] == [1, 1]


def test_a_nonlinear_system_has_a_first_derivative_that_is_a_variable() -> None:
    quartic = P**2 / 2 + Q**4 / 4
    assert powers(quartic, Q, 1)[1] == P
    assert sympy.Poly(sympy.diff(quartic, Q), P, Q).total_degree() == 3


def test_eq_5_gives_the_flow_of_an_h_that_is_no_sum() -> None:
    """H = pq + p²q² keeps c = pq: q goes as e^((1 + 2c)t), p as its inverse."""
    mixed = P * Q + P**2 * Q**2
    assert sympy.expand(sympy.diff(mixed, P, Q)) == 1 + 4 * P * Q  # 0 for a sum
    rate = 1 + 2 * P * Q
    for y, sign in ((Q, 1), (P, -1)):
        flow = sympy.series(y * sympy.exp(sign * rate * H), H, 0, 6).removeO()
        for n, term in enumerate(powers(mixed, y, 5)):
            coefficient = flow.coeff(H, n) * sympy.factorial(n)
            assert sympy.expand(term - coefficient) == 0


def test_a_sum_has_no_mixed_derivative() -> None:
    assert sympy.diff(P**2 / 2 - sympy.cos(Q), P, Q) == 0


@pytest.mark.parametrize("y", [P, Q])
def test_the_scheme_is_the_taylor_series_of_the_solution_for_every_h(y: Any) -> None:
    """By the chain rule along p(t), q(t), for an H without a formula."""
    hamiltonian = sympy.Function("H")(P, Q)
    along = {P: sympy.Function("x")(T), Q: sympy.Function("y")(T)}
    h_p, h_q = (sympy.diff(hamiltonian, z) for z in (P, Q))
    back = {along[P]: P, along[Q]: Q}
    derivative = y
    for term in powers(hamiltonian, y, 3)[1:]:
        moved = sympy.diff(derivative.subs(along, simultaneous=True).doit(), T)
        moved = moved.subs({along[P].diff(T): -h_q, along[Q].diff(T): h_p}, simultaneous=True)
        derivative = sympy.expand(moved.doit().subs(back, simultaneous=True).doit())
        assert sympy.expand(derivative - term) == 0


def _by_recursion(start: tuple[float, float], order: int) -> tuple[list[Any], list[Any]]:
    """Taylor coefficients of p and q of the Duffing oscillator, by Cauchy products."""
    p, q = [Fraction(start[0])], [Fraction(start[1])]
    for n in range(order):
        cube = sum(
            (q[i] * q[j] * q[n - i - j] for i in range(n + 1) for j in range(n - i + 1)),
            start=Fraction(0),
        )
        p.append(-(q[n] + cube) / (n + 1))
        q.append(p[n] / (n + 1))
    return p, q


@pytest.mark.parametrize("start", [(0.0, 1.5), (1.5, 1.5), (-0.25, 0.125)])
def test_derivatives_of_the_duffing_solution_are_those_of_the_scheme(
    start: tuple[float, float],
) -> None:
    hamiltonian = P**2 / 2 + Q**2 / 2 + Q**4 / 4
    at = dict(zip((P, Q), map(sympy.Rational, start), strict=True))
    for y, series in zip((P, Q), _by_recursion(start, 6), strict=True):
        for n, term in enumerate(powers(hamiltonian, y, 6)):
            assert Fraction(str(term.subs(at))) == series[n] * math.factorial(n)


def test_derivatives_of_the_pendulum_s_solution_are_those_of_the_scheme() -> None:
    """Against mpmath's solution of the equation, differentiated by differences."""
    hamiltonian, start = P**2 / 2 - sympy.cos(Q), (mpmath.mpf(3) / 2, mpmath.mpf(3) / 2)
    with mpmath.workdps(40):
        solve = mpmath.odefun(lambda _, z: [-mpmath.sin(z[1]), z[0]], 0, start)
        for which, y in ((0, P), (1, Q)):
            numbers = mpmath.taylor(lambda t, k=which: solve(t)[k], 0, 4, direction=1, h=1e-8)
            for n, term in enumerate(powers(hamiltonian, y, 4)):
                value = term.subs({P: 1.5, Q: 1.5}).evalf(30)
                coefficient = float(value) / math.factorial(n)
                assert float(numbers[n]) == pytest.approx(coefficient, rel=1e-5, abs=1e-6)


def test_eq_19_and_27_are_those_series_of_order_two() -> None:
    for hamiltonian, step in (
        (P**2 / 2 + Q**2 / 2 + Q**4 / 4, duffing(H)),
        (P**2 / 2 - sympy.cos(Q), None),
    ):
        series = [y + H * lie(hamiltonian, y) + H**2 / 2 * lie(hamiltonian, lie(hamiltonian, y))
                  for y in (P, Q)]  # fmt: skip
        if step:
            printed = step(P, Q)
        else:
            s, c = sympy.sin(Q), sympy.cos(Q)
            printed = (P - H * s - H**2 / 2 * P * c, Q + H * P - H**2 / 2 * s)
        assert [sympy.expand(x - y) for x, y in zip(series, printed, strict=True)] == [0, 0]


# -- errors in every step --------------------------------------------------------------------------


@pytest.mark.parametrize("n", [1, 10, 100, 1000])
def test_a_duffing_step_without_an_error_begins_at_q_1_p_minus_four_thirds_h(n: int) -> None:
    h = Fraction(1, n)
    assert determinant(duffing(h), -4 * h / 3, Fraction(1)) == 1
    assert determinant(duffing(h), -4 * h / 3 + Fraction(1, 10**6), Fraction(1)) != 1


@pytest.mark.parametrize("h", [0.1, 0.01])
def test_a_pendulum_step_without_an_error_begins_on_a_curve(h: float) -> None:
    q = 1.0
    p = h / 2 * math.cos(q) ** 2 / math.sin(q)
    assert abs(determinant(pendulum(h), p, q) - 1) < 1e-15
    assert abs(determinant(pendulum(h), p + 1, q) - 1) > 0.3 * h**3


def test_for_each_q_but_one_p_the_duffing_step_has_an_error() -> None:
    """ΔJ is h³ (a p + b) with b > 0: zero for one p or none, and so on a set of measure 0."""
    delta = sympy.Symbol("delta", positive=True)
    change = sympy.expand(sympy.Matrix(duffing(H, delta)(P, Q)).jacobian([P, Q]).det() - 1)
    line = sympy.Poly(change, P)
    assert line.degree() == 1
    constant = sympy.factor(line.coeff_monomial(1))
    assert sympy.expand(constant - H**4 * (1 + 3 * delta * Q**2) ** 2 / 4) == 0
    assert sympy.expand(line.coeff_monomial(P) - 3 * delta * H**3 * Q) == 0


def test_for_each_q_but_one_p_the_pendulum_s_step_has_an_error() -> None:
    """Where sin q = 0, cos² q = 1 and there is none."""
    s, c = sympy.sin(Q), sympy.cos(Q)
    step = sympy.Matrix([P - H * s - H**2 / 2 * P * c, Q + H * P - H**2 / 2 * s])
    change = sympy.expand(step.jacobian([P, Q]).det() - 1)
    expected = H**4 / 4 * c**2 - H**3 / 2 * P * s
    assert sympy.simplify(change - expected) == 0


def test_of_ten_thousand_states_none_has_a_step_without_an_error() -> None:
    random = Random(1)  # noqa: S311 - no secret
    h = Fraction(1, 100)
    for _ in range(10_000):
        p, q = (Fraction(random.randrange(-(10**6), 10**6), 10**6) for _ in "pq")
        assert 12 * p * q != -h * (1 + 3 * q * q) ** 2
