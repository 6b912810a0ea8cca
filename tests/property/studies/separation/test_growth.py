"""The growth of rounding, and where it overtakes truncation, on drawn values."""

import math
from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.studies.separation.growth_fits import find_crossover, fit_growth, log, select_log_spaced

quick = drawn(40)
values = st.builds(Fraction, st.integers(-50, 50), st.integers(1, 10**6))
sizes = st.builds(lambda n, k: Fraction(n) / 10**k, st.integers(1, 99), st.integers(0, 30))


@quick
@given(st.integers(1, 10**9), st.integers(1, 10**9), st.integers(0, 3000))
def test_a_logarithm_is_that_of_numbers_beyond_float64_too(n: int, d: int, k: int) -> None:
    true = math.log(n) - math.log(d) - k * math.log(10)
    assert math.isclose(log(Fraction(n, d * 10**k)), true, abs_tol=1e-9)


@quick
@given(
    st.lists(st.integers(1, 10**6), unique=True, min_size=1, max_size=80).map(sorted),
    st.integers(2, 20),
)
def test_log_spaced_marks_hold_the_ends_and_the_first_beyond_each_goal(
    at: list[int], most: int
) -> None:
    indices = [3 * k for k in range(len(at))]
    chosen = select_log_spaced(indices, at, most)
    if len(at) <= most:
        assert chosen == indices
        return
    assert chosen == sorted(set(chosen))
    assert len(chosen) <= most
    assert (chosen[0], chosen[-1]) == (indices[0], indices[-1])
    goals = [math.log(at[0]) + math.log(at[-1] / at[0]) * k / (most - 1) for k in range(most)]
    wanted = {
        next((i for i, x in zip(indices, at, strict=True) if math.log(x) >= g - 1e-9), indices[-1])
        for g in goals
    }
    assert set(chosen) == wanted


# -- growth ---------------------------------------------------------------------------------------

MARKS = [5 * k for k in range(1, 601)]
exponents = st.sampled_from([Fraction(k, 4) for k in range(13)])


def power(n: int, exponent: Fraction) -> Fraction:
    return Fraction(round(2**40 * n ** float(exponent)), 2**140)


@quick
@given(exponents, st.booleans(), st.integers(20, 600))
def test_a_power_of_n_has_its_exponent_and_the_name_of_what_the_error_holds(
    exponent: Fraction, sign: bool, count: int
) -> None:
    marks = MARKS[:count]
    found = fit_growth(marks, [power(n, exponent) * (-1) ** (n * sign) for n in marks], Fraction(0))
    reach = math.log10(marks[-1] / marks[7])
    assert (found.first, found.last) == (marks[7], marks[-1])
    assert found.points == len(select_log_spaced(range(7, count), marks[7:], 32))
    if reach < 1.5:
        assert (found.exponent, found.standard_error, found.name) == (None, None, "undecided")
        assert f"over {reach:.1f} decades" in found.reason
        return
    assert found.exponent is not None
    assert found.standard_error is not None
    assert abs(found.exponent - float(exponent)) < 1e-3
    error = 1.65 * math.log(marks[-1] / marks[7]) ** -1.5
    assert math.isclose(found.standard_error, error, rel_tol=1e-6)
    held = [x for x in (0.0, 0.5, 1.0) if abs(found.exponent - x) <= 2.5 * error]
    names = {0.5: "random walk", 1.0: "drift"}
    assert found.name == (names.get(held[0], "undecided") if len(held) == 1 else "undecided")
    said = " and ".join({0.0: "0", 0.5: "½", 1.0: "1"}[x] for x in held) or "neither ½ nor 1"
    assert found.reason.endswith(f"holds {said}")
    assert f"{found.exponent:.3f} ± {2.5 * error:.3f}" in found.reason


@quick
@given(st.integers(1, 4000), st.integers(2, 12))
def test_what_is_within_ten_times_the_noise_is_left_out(noise: int, spread: int) -> None:
    values = [Fraction(n) for n in MARKS]
    found = fit_growth(MARKS, values, Fraction(noise, 7))
    above = [n for k, n in enumerate(MARKS) if k >= 7 and 7 * n > 10 * noise]
    assert (found.first, found.last) == ((above[0], above[-1]) if above else (0, 0))
    jumps = [Fraction((7 * k) % spread) ** 3 for k in range(len(MARKS))]
    scattered = fit_growth(
        MARKS, [n + 3000 * x for n, x in zip(MARKS, jumps, strict=True)], Fraction(0)
    )
    assert scattered.standard_error is not None
    assert scattered.standard_error >= 1.65 * math.log(MARKS[-1] / MARKS[7]) ** -1.5 * (1 - 1e-9)


@quick
@given(st.integers(1, 40))
def test_scatter_that_is_more_than_a_walks_is_told(size: int) -> None:
    """One leap in a straight line: the regression's own error is the greater."""
    values = [Fraction(n) * (10 ** (8 * size) if n > 1500 else 1) for n in MARKS]
    found = fit_growth(MARKS, values, Fraction(0))
    assert found.standard_error is not None
    assert found.standard_error > 1.65 * math.log(MARKS[-1] / MARKS[7]) ** -1.5


def test_five_checkpoints_are_fitted_and_four_are_not() -> None:
    marks = [*range(1, 8), 100, 1000, 10_000, 100_000, 1_000_000]
    for count, fitted in ((11, False), (12, True)):
        found = fit_growth(marks[:count], [Fraction(n) for n in marks[:count]], Fraction(0))
        assert found.points == count - 7
        assert (found.exponent is not None) == fitted


# -- crossovers -----------------------------------------------------------------------------------

points = st.lists(st.tuples(sizes, sizes, sizes), max_size=6, unique_by=lambda x: x[0])


@drawn(100)
@given(points, st.randoms(use_true_random=False))
def test_a_crossover_lies_between_the_last_small_and_the_first_large_step(
    given_: list[tuple[Fraction, Fraction, Fraction]], mixed: object
) -> None:
    found, ordered = find_crossover(given_), sorted(given_)
    assert find_crossover(given_[::-1]) == found
    rounding = [r > t for _, t, r in ordered]
    if len(ordered) < 2:
        said = "one step size"
    elif all(rounding):
        said = "rounding is larger at every"
    elif not any(rounding):
        said = "truncation is larger at every"
    elif not rounding[0]:
        said = "truncation is larger at the smallest"
    elif rounding[-1]:
        said = "rounding is larger at the largest"
    else:
        low = next(k for k, x in enumerate(rounding) if not x) - 1
        high = max(k for k, x in enumerate(rounding) if x) + 1
        (h1, t1, r1), (h2, t2, r2) = ordered[low], ordered[high]
        assert found.bracket == (h1, h2)
        assert found.step_size is not None
        assert ("neighbours" in found.reason) == (high - low == 1)
        y1, y2 = (math.log10(t / r) for t, r in ((t1, r1), (t2, r2)))
        at = math.log10(h1) + (0 - y1) / (y2 - y1) * math.log10(h2 / h1) if y2 != y1 else None
        if at is not None:
            assert math.isclose(found.step_size, 10**at, rel_tol=1e-6)
        return
    assert (found.step_size, found.bracket) == (None, None)
    assert said in found.reason


@quick
@given(sizes, sizes, sizes, st.booleans())
def test_a_part_that_is_exactly_0_gives_a_bracket_and_no_number(
    h: Fraction, t: Fraction, r: Fraction, first: bool
) -> None:
    small = (h, Fraction(0), r) if first else (h, min(t, r) / 2, max(t, r))
    large = (2 * h, max(t, r), min(t, r) / 2) if first else (2 * h, t, Fraction(0))
    found = find_crossover([large, small])
    assert (found.step_size, found.bracket) == (None, (h, 2 * h))
    assert "exactly 0" in found.reason
