"""Eq. 9 to 12, for p alone, for q alone, and for both: what they say of exact numbers."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy

from tests.second.maps import duffing, jacobian, level_map, states

P, Q, H = sympy.symbols("p q h")
LEVEL = Q - P**3
LEVELS = -LEVEL + LEVEL**2 / 2


def lie(hamiltonian: Any, y: Any) -> Any:
    """dy/dt along Eq. 1."""
    slope = sympy.diff(hamiltonian, P) * sympy.diff(y, Q)
    return sympy.expand(slope - sympy.diff(hamiltonian, Q) * sympy.diff(y, P))


def turn(eta: int, h: Any, z: Any) -> Any:
    """One step of lieη for the oscillator, z = q + ip, whose exact solution is e^(−it) z."""
    return z * sum((mpmath.mpc(0, -1) * h) ** n / mpmath.factorial(n) for n in range(eta + 1))


def test_eq_9_for_p_alone_fails_from_two_points_with_one_p() -> None:
    step = duffing(Fraction(1, 10))
    (one, _), (other, _) = step(Fraction(0), Fraction(0)), step(Fraction(0), Fraction(1))
    assert abs(one - other) == Fraction(1, 5)  # (1 + hL) · 0 on the right


def test_eq_9_for_q_alone_fails_from_two_points_with_one_q() -> None:
    step = duffing(Fraction(1, 10))
    (_, one), (_, other) = step(Fraction(0), Fraction(1)), step(Fraction(1), Fraction(1))
    assert abs(one - other) == Fraction(1, 10)


def test_in_one_norm_the_two_points_part_by_no_more_than_a_constant_allows() -> None:
    h = Fraction(1, 10)
    step = duffing(h)
    one, other = step(Fraction(0), Fraction(0)), step(Fraction(0), Fraction(1))
    apart = max(abs(x - y) for x, y in zip(one, other, strict=True))
    # In the greatest of |p|, |q| ‖J‖ is at most 1 + h(4 + 2h) for p = 0, q ≤ 1.
    assert apart <= 1 + h * (4 + 2 * h)


@pytest.mark.parametrize("eta", range(1, 7))
def test_eq_9_with_both_one_step_from_the_start_has_0_on_the_right(eta: int) -> None:
    with mpmath.workdps(40):
        for h in (mpmath.mpf("0.1"), mpmath.mpf("0.01")):
            start = mpmath.mpc(1, 0)
            exact = mpmath.expj(-h) * start
            numerical, from_exact = turn(eta, h, start), turn(eta, h, start)
            assert from_exact == numerical
            left = turn(eta, h, exact) - turn(eta, h, numerical)
            local = h ** (eta + 1) / mpmath.factorial(eta + 1)
            assert abs(abs(left) / local - 1) < h
            assert left.real != 0
            assert left.imag != 0  # p alone, q alone


def test_the_left_side_of_eq_9_after_two_steps_is_1_67e_4() -> None:
    h = mpmath.mpf("0.1")
    left = turn(2, h, mpmath.expj(-h)) - turn(2, h, turn(2, h, mpmath.mpc(1, 0)))
    assert abs(left) == pytest.approx(1.67e-4, rel=3e-3)


def test_with_the_exact_state_on_the_right_eq_9_holds_for_the_oscillator() -> None:
    h = mpmath.mpf("0.1")
    gap = mpmath.expj(-h) - turn(2, h, mpmath.mpc(1, 0))
    left = abs(turn(2, h, gap))
    assert abs(gap) < left <= (1 + h) * abs(gap)


# -- Eq. 10 and 11: H = −u + u²/2, u = q − p³, from (0, 0) -----------------------------------------


def test_lie2_of_that_h_is_the_map_in_use() -> None:
    lines = [sympy.expand(z + H * lie(LEVELS, z) + H**2 / 2 * lie(LEVELS, lie(LEVELS, z)))
             for z in (P, Q)]  # fmt: skip
    steps = level_map(H)(P, Q)
    assert [sympy.expand(x - y) for x, y in zip(lines, steps, strict=True)] == [0, 0]


def test_t_and_its_cube_solve_that_h() -> None:
    t = sympy.Symbol("t")
    on = {P: t, Q: t**3}
    assert sympy.expand(-sympy.diff(LEVELS, Q).subs(on)) == 1
    assert sympy.expand(sympy.diff(LEVELS, P).subs(on)) == 3 * t**2


def test_p_has_no_local_error_from_any_point() -> None:
    first = lie(LEVELS, P)
    assert first != 0
    assert lie(LEVELS, first) == 0  # and so every further one


def test_q_has_a_local_error() -> None:
    third = lie(LEVELS, lie(LEVELS, lie(LEVELS, Q)))
    assert third.subs({P: 0, Q: 0}) == 6


@pytest.mark.parametrize("n", [2, 10, 100])
def test_eq_10_for_p_alone_says_0_where_the_error_is_h_to_the_fourth(n: int) -> None:
    h = Fraction(1, n)
    (_, _), (first, _), (second, _) = states(level_map(h), Fraction(0), Fraction(0), 2)
    assert first == h  # so that e_1 = 0, and with C = 0 all of the right side
    assert second - 2 * h == h**4


@pytest.mark.parametrize(
    ("n", "error"), [(10, 4.54e-3), (100, 4.95e-5), (1000, 4.995e-7), (10000, 4.9995e-9)]
)
def test_eq_11_for_p_alone_says_0_where_the_error_is_half_h_squared(n: int, error: float) -> None:
    with mpmath.workdps(40):
        h = mpmath.mpf(1) / n
        p, _ = states(level_map(h), mpmath.mpf(0), mpmath.mpf(0), n)[-1]
        assert float(p - 1) == pytest.approx(error, rel=1e-3)
        assert h**2 * (1 - h) / 2 <= p - 1 <= h**2 / 2


def test_it_makes_no_difference_that_eq_7_prints_one_step_from_the_exact_state() -> None:
    h, t = Fraction(1, 10), Fraction(3, 7)
    p, _ = level_map(h)(t, t**3)
    assert p == t + h


# -- Eq. 12 ----------------------------------------------------------------------------------------


def test_eq_12_as_a_product_fails_for_the_duffing_oscillator() -> None:
    p, q, h = Fraction(0), Fraction(1), Fraction(1, 10)
    product = [a * p + b * q for a, b in jacobian(duffing(h), p, q)]
    assert product == [Fraction(-4, 10), Fraction(98, 100)]
    assert list(duffing(h)(p, q)) == [Fraction(-2, 10), Fraction(99, 100)]


def test_eq_12_as_a_product_holds_without_the_cubic_force() -> None:
    p, q, h = Fraction(2, 3), Fraction(1, 5), Fraction(1, 10)
    step = duffing(h, delta=0)
    assert [a * p + b * q for a, b in jacobian(step, p, q)] == list(step(p, q))
