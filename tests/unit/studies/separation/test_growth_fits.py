"""How rounding grows and where it overtakes: synthetic walks and drifts, made crossings."""

import math
import random
from fractions import Fraction
from itertools import accumulate
from statistics import mean, stdev

import pytest

from verify.studies.separation.growth_fits import (
    classify_motion,
    find_crossover,
    fit_growth,
    fit_power_law,
    select_log_spaced,
)

POINTS = 2048
MARKS = [10 * k for k in range(1, POINTS + 1)]


def walk(seed: int, drift: float = 0, points: int = POINTS) -> list[Fraction]:
    """Sums of normal numbers, as the tiny rationals that rounding makes."""
    draw = random.Random(seed)  # noqa: S311 - repeatable, not secret
    sums = accumulate(draw.gauss(drift, 1) for _ in range(points))
    return [Fraction(round(x * 2**20), 2**70) for x in sums]


def test_random_walks_are_recognised_and_hardly_ever_called_a_drift() -> None:
    found = [fit_growth(MARKS, walk(seed), Fraction(0)) for seed in range(80)]
    names = [each.name for each in found]
    assert names.count("random walk") >= 64
    assert names.count("drift") <= 2


def test_the_standard_error_is_the_scatter_of_walks_and_not_of_one_regression() -> None:
    for points in (256, POINTS):
        marks = MARKS[:points]
        found = [fit_growth(marks, walk(seed, points=points), Fraction(0)) for seed in range(60)]
        slopes = [each.exponent for each in found if each.exponent is not None]
        errors = [each.standard_error for each in found if each.standard_error is not None]
        assert len(slopes) == len(errors) == 60
        assert abs(mean(slopes) - 0.5) < 0.08
        assert 0.75 < mean(errors) / stdev(slopes) < 1.35, points


@pytest.mark.parametrize("seed", range(20))
def test_drifts_are_recognised_with_noise_on_them(seed: int) -> None:
    assert fit_growth(MARKS, walk(seed, drift=1), Fraction(0)).name == "drift"
    assert fit_growth(MARKS, [-x for x in walk(seed, drift=1)], Fraction(0)).name == "drift"


def test_an_exact_drift_has_exponent_1_and_still_an_honest_error() -> None:
    found = fit_growth(MARKS, [Fraction(n, 10**30) for n in MARKS], Fraction(0))
    assert found.name == "drift"
    assert found.exponent == pytest.approx(1)
    assert found.standard_error is not None
    assert found.standard_error > 0.1
    assert (found.first, found.last, found.points) == (80, 20480, 32)


def test_what_is_neither_is_undecided() -> None:
    bounded = [Fraction(1, 10**16) * (2 + k % 3) for k in range(POINTS)]
    quadratic = [Fraction(n * n, 10**30) for n in MARKS]
    assert fit_growth(MARKS, bounded, Fraction(0)).name == "undecided"
    assert fit_growth(MARKS, quadratic, Fraction(0)).name == "undecided"
    slow = [Fraction(round(1e9 * n**0.25), 10**30) for n in MARKS]
    assert fit_growth(MARKS, slow, Fraction(0)).reason.endswith("holds 0 and ½")


def test_an_oscillation_that_grows_like_n_is_a_drift() -> None:
    values = [Fraction(round(1e6 * n * math.sin(n / 40)), 10**30) for n in MARKS]
    assert fit_growth(MARKS, values, Fraction(0)).name == "drift"


def test_nothing_is_fitted_within_the_noise_or_over_too_few_decades() -> None:
    values = [Fraction(n, 10**30) for n in MARKS]
    above = fit_growth(MARKS, values, Fraction(30, 10**30))
    assert (above.first, above.exponent is None) == (310, False), "from 10 times the noise"
    for noise in (Fraction(70, 10**30), Fraction(1)):
        found = fit_growth(MARKS, values, noise)
        assert (found.name, found.exponent, found.standard_error) == ("undecided", None, None)
        assert "decades" in found.reason
    assert fit_growth(MARKS[:100], values[:100], Fraction(0)).exponent is None
    assert fit_growth(MARKS, [Fraction(0)] * POINTS, Fraction(0)).points == 0


def test_log_spaced_indices_are_spread_and_hold_both_ends() -> None:
    chosen = select_log_spaced(range(1000), range(1, 1001), 10)
    assert chosen == sorted(set(chosen))
    assert (chosen[0], chosen[-1], len(chosen)) == (0, 999, 10)
    assert select_log_spaced([3, 4], [30, 40], 10) == [3, 4]


# -- powers of N, beside the motion's -------------------------------------------------------------

STEPS = tuple(range(4, 2049, 4))


@pytest.mark.parametrize(("power", "name"), [(0, "bounded"), (1, "N"), (2, "N²")])
def test_a_power_is_found_under_an_oscillation(power: int, name: str) -> None:
    sizes = [Fraction(n**power * (2 + math.sin(n))) for n in STEPS]
    law = fit_power_law(STEPS, sizes, Fraction(0), "polynomial")
    assert law.name == name
    assert law.exponent == pytest.approx(power, abs=0.2)


@pytest.mark.parametrize("power", [0.5, 1.5, 3])
def test_what_is_near_no_whole_power_is_undecided(power: float) -> None:
    sizes = [Fraction(n**power) for n in STEPS]
    assert fit_power_law(STEPS, sizes, Fraction(0), "polynomial").name == "undecided"


def test_nothing_is_fitted_to_noise_to_little_or_to_what_grows_exponentially() -> None:
    sizes = [Fraction(n) for n in STEPS]
    assert fit_power_law(STEPS, sizes, Fraction(10**6), "polynomial").exponent is None
    assert fit_power_law(STEPS[:20], sizes[:20], Fraction(0), "polynomial").exponent is None
    assert fit_power_law(STEPS, sizes, Fraction(0), "exponential").name == "exponential"
    assert fit_power_law(STEPS, [Fraction(0)] * 512, Fraction(0), "exponential").name == "bounded"


def test_a_power_of_the_tangent_map_is_not_taken_for_an_exponential() -> None:
    linear = [Fraction(4 + n * n) for n in STEPS]
    assert classify_motion(STEPS, linear) == "polynomial"
    assert classify_motion(STEPS, [Fraction(4)] * len(STEPS)) == "undecided", "it has not grown"
    squares = [Fraction(math.exp(n / 100)) for n in STEPS]
    assert classify_motion(STEPS, squares) == "exponential"


# -- crossovers -----------------------------------------------------------------------------------

F = Fraction


def test_a_crossover_of_power_laws_is_found_where_they_cross() -> None:
    """Truncation h⁴ and rounding 10⁻¹²/h cross at h = 10^(−12/5)."""
    points = [(h, h**4, F(1, 10**12) / h) for h in (F(1, 10**k) for k in (1, 2, 3, 4))]
    found = find_crossover(points[::-1])
    assert found.bracket == (F(1, 1000), F(1, 100))
    assert found.step_size == pytest.approx(10**-2.4)
    assert find_crossover(points) == found, "in any order"


@pytest.mark.parametrize(
    ("rounding", "said"),
    [
        ((0, 0, 0), "truncation is larger at every"),
        ((9, 9, 9), "rounding is larger at every"),
        ((0, 9, 9), "truncation is larger at the smallest"),
        ((9, 0, 9), "rounding is larger at the largest"),
    ],
)
def test_there_is_none_where_the_ends_say_so(rounding: tuple[int, ...], said: str) -> None:
    found = find_crossover([(F(k), F(1), F(x)) for k, x in enumerate(rounding, 1)])
    assert (found.step_size, found.bracket) == (None, None)
    assert said in found.reason


def test_where_noise_decides_the_bracket_holds_every_change() -> None:
    points = [(F(2**k), F(1), F(x)) for k, x in enumerate((16, 16, F(1, 2), 2, F(1, 16), F(1, 16)))]
    found = find_crossover(points)
    assert found.bracket == (2, 16)
    assert found.step_size == pytest.approx(math.sqrt(32))
    assert "noise" in found.reason


def test_one_step_size_or_an_exact_zero_gives_no_number() -> None:
    assert find_crossover([(F(1), F(1), F(2))]).step_size is None
    assert find_crossover([]).bracket is None
    found = find_crossover([(F(1), F(0), F(2)), (F(2), F(3), F(2))])
    assert (found.step_size, found.bracket) == (None, (1, 2))
