"""Figure 1: MSE/|Λ| against the step size, and the order of the starts by |Λ|; criterion 3."""

import math
from collections.abc import Callable
from itertools import pairwise

import pytest

from tests.second.long_runs import LONG, PRINTED, STARTS, STEP_SIZES, LongRuns, Run, energy

Rows = list[list[Run]]


def ratio(run: Run) -> float:
    return run.mse / abs(run.area)


def drawn(run: Run) -> float:
    """With 1/N for the MSE, as Table 1 has it."""
    return 1 / run.steps / abs(run.area)


def falling(rows: Rows, quantity: Callable[[Run], float]) -> list[list[bool]]:
    """Of each start, whether it falls from each step size to the next."""
    return [[quantity(two) < quantity(one) for one, two in pairwise(row)] for row in rows]


def count(ways: list[list[bool]]) -> int:
    """In how many of the 25 pairs it falls."""
    assert [len(way) for way in ways] == [5] * 5
    return sum(map(sum, ways))


def orders(rows: Rows) -> list[str]:
    """The starts' numbers in the order of |Λ|, for each step size."""
    sizes = [[abs(run.area) for run in column] for column in zip(*rows, strict=True)]
    return ["".join(str(i + 1) for i in sorted(range(5), key=each.__getitem__)) for each in sizes]


@pytest.mark.left_to_ci
def test_the_ratio_grows_between_all_25_pairs_over_20000(runs: LongRuns) -> None:
    rows = runs.grid("duffing")
    assert count(falling(rows, ratio)) == 0
    assert ratio(rows[0][0]) == pytest.approx(2.201e-17, rel=5e-4)
    assert ratio(rows[0][1]) == pytest.approx(1.764e-16, rel=5e-4)


def test_the_ratio_grows_between_24_of_25_pairs_over_50(runs: LongRuns) -> None:
    rows = runs.grid("duffing", time=50)
    assert count(falling(rows, ratio)) == 1
    assert ratio(rows[0][0]) == pytest.approx(8.884e-15, rel=5e-4)
    assert ratio(rows[0][1]) == pytest.approx(7.094e-14, rel=5e-4)


@pytest.mark.left_to_ci
def test_the_ratio_as_drawn_falls_between_all_25_pairs(runs: LongRuns) -> None:
    rows = runs.grid("duffing")
    assert count(falling(rows, drawn)) == 25
    ends = [(drawn(row[0]), drawn(row[-1])) for row in rows]
    assert ends[0] == pytest.approx((9.71e-3, 9.68e-5), rel=1e-3)
    assert ends[3] == pytest.approx((2.85e-4, 2.47e-6), rel=2e-3)


@pytest.mark.left_to_ci
def test_the_ratio_as_drawn_goes_the_same_way_from_all_starts(runs: LongRuns) -> None:
    ways = falling(runs.grid("duffing"), drawn)
    assert all(way == ways[0] for way in ways)


def test_over_50_not_even_the_ratio_as_drawn_goes_the_same_way(runs: LongRuns) -> None:
    ways = falling(runs.grid("duffing", time=50), drawn)
    assert not all(way == ways[0] for way in ways)


@pytest.mark.left_to_ci
def test_over_20000_the_starts_stand_in_one_order_at_all_step_sizes(runs: LongRuns) -> None:
    """That of energy: a pattern."""
    by_energy = sorted(range(5), key=lambda i: energy("duffing", STARTS[i]))
    assert orders(runs.grid("duffing")) == ["".join(str(i + 1) for i in by_energy)] * 6
    assert "".join(str(i + 1) for i in by_energy) == "12534"


def test_over_50_the_starts_stand_in_no_common_order(runs: LongRuns) -> None:
    expected = ["12345", "13245", "12345", "12354", "21354", "21354"]
    assert orders(runs.grid("duffing", time=50)) == expected


def _powers(values: list[float]) -> list[float]:
    """The power of h that each number goes with up to the next."""
    pairs = pairwise(zip(map(float, STEP_SIZES), values, strict=True))
    return [(y - x) / math.log10(k / h) for (h, x), (k, y) in pairs]


def test_the_printed_numbers_of_both_tables_fall_as_h_and_no_faster() -> None:
    """Criterion 3 asks for a higher-order infinitesimal of h."""
    for x, h in zip(PRINTED, STEP_SIZES, strict=True):
        assert abs(float(x) - math.log10(float(h)) + math.log10(LONG)) < 5.2e-5  # its rounding
    assert _powers(list(map(float, PRINTED))) == pytest.approx([1] * 5, abs=1.5e-3)


def test_the_mean_squared_errors_themselves_fall_faster(runs: LongRuns) -> None:
    for row in runs.grid("pendulum", time=50):
        assert min(_powers([math.log10(run.mse) for run in row])) > 5.9
