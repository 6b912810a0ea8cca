"""The criteria against each other: on maps that are not the toolkit's examples, over [0, 1]."""

import math
from fractions import Fraction
from itertools import pairwise
from random import Random
from typing import Any

import mpmath
import pytest
import sympy

from tests.second.maps import Map, defects, determinant, duffing, mse, sin_cos, states, total

STEPS = (16, 64, 256)


def to_and_fro(e: Any) -> Map:
    """det = (1 + e)^q for q = ±1, between which it goes: e for √h."""

    def step(p: Any, q: Any) -> tuple[Any, Any]:
        # (1 + e)^q at q = ±1, as a line in q.
        wide, narrow = 1 + e, 1 / (1 + e)
        return -p * ((wide + narrow) / 2 + (wide - narrow) / 2 * q), -q

    return step


def late(h: Any) -> Map:
    """ΔJ = (kh)³: O(h³) for each k, and near 1 for the last ones."""
    return lambda p, q: (p + p * q**3, q + h)


def friction(h: Any) -> Map:
    """q'' + 2q' + q = 0 by Euler's method: div g = −2."""
    return lambda p, q: (p - h * (q + 2 * p), q + h * p)


def waves(h: float) -> Map:
    """Divergence cos 2πt, nothing over [0, 1] and 1/2π over [0, 1/4]."""
    return lambda p, q: (p + h * p * sin_cos(q * (2 * math.pi))[1], q + h)


def curved(h: Any) -> Map:
    """A smooth step whose g = (q² − p, q + p³) has no divergence; its h² part is arbitrary."""
    return lambda p, q: (p + h * (q**2 - p) + h * h * p * q, q + h * (q + p**3) + h * h * q**2)


def one(n: int) -> Fraction:
    return Fraction(1, n)


def test_delta_j_of_a_smooth_step_is_h_div_g_and_higher() -> None:
    p, q, h = sympy.symbols("p q h")
    g = [sympy.Function(name)(p, q) for name in "ab"]
    r = [sympy.Function(name)(p, q, h) for name in "cd"]
    step = sympy.Matrix([z + h * x + h**2 * y for z, x, y in zip((p, q), g, r, strict=True)])
    change = step.jacobian([p, q]).det() - 1
    divergence = sympy.diff(g[0], p) + sympy.diff(g[1], q)
    assert sympy.simplify(change.subs(h, 0).doit()) == 0
    assert sympy.simplify(sympy.diff(change, h).subs(h, 0).doit() - divergence) == 0


# -- 2 and 4 ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(20))
def test_the_total_error_is_at_most_what_the_largest_change_allows(seed: int) -> None:
    random = Random(seed)  # noqa: S311 - no secret
    largest = Fraction(random.randint(1, 50), 1000)
    changes = [largest * Fraction(random.randint(-99, 99), 99) for _ in range(60)]
    assert abs(total(changes)) <= math.expm1(60 * largest)


def test_criterion_2_implies_criterion_4_for_the_paper_s_scheme() -> None:
    """|Λ| ≤ exp(T max|ΔJ|/h) − 1, and both go to 0 with h, for T = 5."""
    bounds = []
    for n in (10, 20, 40, 80):
        h = 1 / n
        changes = defects(duffing(h), 1.5, 1.5, 5 * n)
        bounds.append(math.expm1(5 * max(map(abs, changes)) / h))
        assert abs(total(changes)) <= bounds[-1]
    assert all(b < 0.3 * a for a, b in pairwise(bounds))


def test_without_criterion_2_criterion_4_fails_for_friction() -> None:
    """max |ΔJ| = 2h − 2h² is no o(h), and Λ goes to e^−2 − 1."""
    for n in (100, 1000):
        change = determinant(friction(one(n)), Fraction(0), Fraction(1)) - 1
        assert change == -2 * one(n) + one(n) ** 2
        assert float(1 + change) ** n - 1 == pytest.approx(math.expm1(-2), rel=2 / n)


def _two_of_each_k_without_four() -> None:
    for n in STEPS:
        changes = defects(late(one(n)), Fraction(0), Fraction(0), n)
        assert changes[:4] == [(k * one(n)) ** 3 for k in range(4)]
        assert total([Fraction(float(x)) for x in changes]) > Fraction(n, 5)


def test_criterion_4_does_not_imply_criterion_2() -> None:
    for n in STEPS:
        e = Fraction(1, math.isqrt(n))  # √h
        for count in (n, n + 1):
            changes = defects(to_and_fro(e), Fraction(0), Fraction(1), count)
            assert abs(total(changes)) in (0, e)  # to 0
            assert changes[0] == e  # of one fixed k, as of the greatest
            assert max(changes) / one(n) >= 1 / e


def test_for_each_fixed_k_neither_of_2_and_4_implies_the_other() -> None:
    _two_of_each_k_without_four()
    test_criterion_4_does_not_imply_criterion_2()


def test_criterion_4_at_every_time_makes_a_smooth_step_one_of_criterion_2() -> None:
    """Λ(t) goes to exp ∫ div g − 1: 0 for every t only where div g = 0, and then ΔJ = O(h²)."""
    for n in STEPS:
        h = 1 / n
        changes = defects(curved(h), 0.3, 0.2, n)
        assert max(map(abs, changes)) < 12 * h * h
        assert all(abs(total(changes[:k])) < 12 * h for k in range(0, n, n // 8))


def test_criterion_4_at_one_time_alone_does_not() -> None:
    for n in STEPS:
        changes = defects(waves(1 / n), 0.0, 0.0, n)
        assert abs(total(changes)) < 2 / n
        assert max(map(abs, changes)) * n == pytest.approx(1)
    assert total(changes[: n // 4]) == pytest.approx(math.expm1(1 / (2 * math.pi)), rel=0.02)


def test_of_smooth_steps_those_of_criterion_2_are_those_of_criterion_4() -> None:
    """One with divergence has neither, one without both: 4 is no stronger there."""
    for step, both in ((friction, False), (curved, True)):
        n = 1024
        changes = defects(step(1 / n), 0.3, 0.2, n)
        assert (max(map(abs, changes)) * n < 0.05) == both
        assert (abs(total(changes)) < 0.05) == both


# -- 3 and 4 ---------------------------------------------------------------------------------------


def _three_without_four() -> None:
    for n in (100, 1000, 10000):
        change = -2 * one(n) + one(n) ** 2
        assert mse([change]) * n <= 4 * one(n)  # MSE = O(h²)
        assert float(1 + change) ** n - 1 < -0.86


def test_criterion_4_does_not_imply_criterion_3() -> None:
    for n in STEPS:
        changes = defects(to_and_fro(Fraction(1, math.isqrt(n))), Fraction(0), Fraction(1), n)
        assert total(changes) == 0
        assert mse(changes) >= one(n) / 2  # no o(h)


def test_neither_of_criteria_3_and_4_implies_the_other() -> None:
    _three_without_four()
    test_criterion_4_does_not_imply_criterion_3()


def test_smooth_steps_satisfy_criterion_3_with_and_without_criterion_4() -> None:
    """ΔJ = O(h), so that MSE = O(h²), whatever the divergence is."""
    for step, holds in ((friction, False), (waves, False), (curved, True)):
        values = []
        for n in STEPS:
            changes = defects(step(1 / n), 0.3, 0.0, n)
            values.append(mse(changes) * n)
        assert values[-1] < 5 / n
        assert values[0] > 3.5 * values[1] > 3.5**2 * values[2]
        everywhere = max(abs(total(changes[:k])) for k in range(0, n, n // 8))
        assert (everywhere < 0.05) == holds


def test_the_map_that_has_4_and_not_2_is_no_step_near_the_identity() -> None:
    (_, start), (_, end) = states(to_and_fro(Fraction(1, 100)), Fraction(0), Fraction(1), 1)
    assert abs(end - start) == 2


# -- the inference from one step size --------------------------------------------------------------


def test_numbers_at_one_step_size_are_those_of_a_map_without_the_criteria() -> None:
    """ΔJ = 10⁻¹¹ (1/20 ± 1) whatever h is."""
    up, down = (mpmath.mpf("1e-11") * (mpmath.mpf(1) / 20 + sign) for sign in (1, -1))
    with mpmath.workdps(40):
        pair = mpmath.log1p(up) + mpmath.log1p(down)
        sizes = {n: mpmath.expm1(20000 * n / 2 * pair) for n in (10**3, 10**6, 10**9, 10**12)}
        assert float(sizes[10**3]) == pytest.approx(1e-5, rel=1e-3)
        assert float(up) == pytest.approx(1e-11, rel=0.06)
        assert float(-down) == pytest.approx(1e-11, rel=0.06)
        assert sizes[10**6] > 0.009
        assert sizes[10**9] > 10000  # so that Λ does not go to 0 with h
        assert up * 10**12 > 10  # nor ΔJ/h


def test_that_map_is_one() -> None:
    small = Fraction(1, 10**11)
    changes = defects(
        lambda p, q: (-p * (1 + small * (Fraction(1, 20) + q)), -q), Fraction(0), Fraction(1), 4
    )
    assert set(changes) == {small * Fraction(21, 20), small * Fraction(-19, 20)}
