"""Tables 1 and 2: the mean squared error from every start with every step size, by a program in C.

ΔJ is in closed form (`test_sentences.py` derives it), the sums are in long double.
"""

import math
from itertools import pairwise

import pytest

from tests.second.long_runs import LONG, PRINTED, STEP_SIZES, LongRuns, Run
from tests.second.maps import defects, duffing, mse, pendulum, total

over_20000 = pytest.mark.left_to_ci

# lg MSE over T = 20000, one row for each start, by this folder's program.
TABLES = {
    "duffing": [
        [-21.9453, -20.1384, -18.3291, -17.2672, -16.5100, -15.9188],
        [-19.0786, -17.2724, -15.4660, -14.4090, -13.6583, -13.0753],
        [-16.8193, -15.0130, -13.2055, -12.1453, -11.3884, -10.7948],
        [-16.5350, -14.7285, -12.9204, -11.8584, -11.0981, -10.4984],
        [-17.3910, -15.5847, -13.7779, -12.7195, -11.9663, -11.3790],
    ],
    "pendulum": [
        [-23.4979, -21.6670, -19.7741, -18.6030, -17.7312, -17.0306],
        [-20.7410, -18.9347, -17.1283, -16.0712, -15.3207, -14.7378],
        [-19.0907, -17.2845, -15.4782, -14.4215, -13.6716, -13.0896],
        [-18.7609, -16.9547, -15.1484, -14.0915, -13.3411, -12.7585],
        [-18.9598, -17.1536, -15.3474, -14.2907, -13.5408, -12.9590],
    ],
}


def lg(x: float) -> float:
    return math.log10(x)


def four(x: float) -> str:
    """As the tables print it."""
    return f"{lg(x):.4f}"


def all_differ_from_printed(runs: LongRuns, system: str) -> None:
    rows = runs.grid(system)
    for row, numbers in zip(rows, TABLES[system], strict=True):
        assert [round(lg(run.mse), 4) for run in row] == pytest.approx(numbers, abs=1.01e-4)
        assert not set(PRINTED) & {four(run.mse) for run in row}
    assert all(float(PRINTED[0]) > lg(run.mse) + 3 for row in rows for run in row)


def spread(runs: LongRuns, system: str) -> float:
    """By what factor the MSE varies over the starts, at most."""
    columns = zip(*runs.grid(system), strict=True)
    sizes: list[list[float]] = [[run.mse for run in column] for column in columns]
    return max(max(each) / min(each) for each in sizes)


def test_the_program_s_sums_are_those_of_the_map_s_own_determinants(runs: LongRuns) -> None:
    """By dual numbers, over T = 2, to the digits of double precision."""
    for system, step in (("duffing", duffing(0.01)), ("pendulum", pendulum(0.01))):
        (run,) = runs.of(system, (1.5, 1.5), ("0.01",), time=2)
        changes = defects(step, 1.5, 1.5, 200)
        assert run.steps == 200
        assert run.mse == pytest.approx(mse(changes), rel=1e-8)
        assert run.largest == pytest.approx(max(map(abs, changes)), rel=1e-8)
        assert run.area == pytest.approx(total(changes), abs=1e-13)


@over_20000
def test_no_printed_value_of_table_1_is_the_mse_from_a_start(runs: LongRuns) -> None:
    all_differ_from_printed(runs, "duffing")


@over_20000
def test_no_printed_value_of_table_2_is_the_mse_from_a_start(runs: LongRuns) -> None:
    all_differ_from_printed(runs, "pendulum")


def test_both_printed_rows_are_lg_of_1_over_n() -> None:
    assert tuple(f"{lg(float(h) / LONG):.4f}" for h in STEP_SIZES) == PRINTED
    near = [tuple(f"{lg(float(h) / t):.4f}" for h in STEP_SIZES) for t in (19_997, 20_003)]
    assert PRINTED not in near


@over_20000
def test_over_no_shorter_time_is_a_mean_as_great_as_table_1_prints(runs: LongRuns) -> None:
    """No mean of squares is greater than the greatest of them."""
    greatest = max(run.largest**2 for row in runs.grid("duffing") for run in row)
    assert lg(greatest) == pytest.approx(-10.1402, abs=1e-4)
    assert lg(greatest) < min(map(float, PRINTED)) - 2.8


@over_20000
def test_over_no_shorter_time_is_a_mean_as_great_as_table_2_prints(runs: LongRuns) -> None:
    greatest = max(run.largest**2 for row in runs.grid("pendulum") for run in row)
    assert lg(greatest) == pytest.approx(-12.2086, abs=1e-4)
    assert lg(greatest) < min(map(float, PRINTED)) - 4.9


@over_20000
@pytest.mark.parametrize(
    ("delta", "least", "greatest"),
    [(0.01, -25.13, -14.64), (0.1, -23.93, -12.64), (10.0, -19.92, -7.93)],
)
def test_no_printed_value_of_table_1_is_the_mse_for_another_delta(
    runs: LongRuns, delta: float, least: float, greatest: float
) -> None:
    rows = runs.grid("duffing", time=200, delta=delta)
    values = [lg(run.mse) for row in rows for run in row]
    assert (min(values), max(values)) == pytest.approx((least, greatest), abs=6e-3)
    for row in rows:
        assert not set(PRINTED) & {four(run.mse) for run in row}
        # MSE goes as h⁶, the printed row as h.
        assert row[1].mse / row[0].mse > 60


@over_20000
@pytest.mark.parametrize("factor", [2, 1000])
def test_the_duffing_mse_varies_over_the_starts_by_more(runs: LongRuns, factor: int) -> None:
    assert spread(runs, "duffing") == pytest.approx(2.57e5, rel=3e-2)
    assert spread(runs, "duffing") > factor


@over_20000
@pytest.mark.parametrize("factor", [2, 1000])
def test_the_pendulum_s_mse_varies_over_the_starts_by_more(runs: LongRuns, factor: int) -> None:
    assert spread(runs, "pendulum") == pytest.approx(5.5e4, rel=3e-2)
    assert spread(runs, "pendulum") > factor


@over_20000
def test_no_duffing_mse_is_of_the_order_of_a_millionth_with_h_0_01(runs: LongRuns) -> None:
    values = [run.mse for run in runs.at("duffing", "0.01")]
    assert values == pytest.approx([1.2056e-16, 8.4088e-14, 1.6040e-11, 3.1743e-11, 4.178e-12],
                                   rel=1e-3)  # fmt: skip
    assert all(abs(lg(x) + 6) > 0.5 for x in values)
    assert max(values) < 3.2e-11


@over_20000
def test_no_mse_of_the_pendulum_is_of_the_order_of_a_millionth_with_h_0_01(
    runs: LongRuns,
) -> None:
    values = [run.mse for run in runs.at("pendulum", "0.01")]
    assert values == pytest.approx([9.32e-18, 1.829e-15, 8.135e-14, 1.7438e-13, 1.0991e-13],
                                   rel=2e-3)  # fmt: skip
    assert all(abs(lg(x) + 6) > 0.5 for x in values)


def _with_1_over_n(rows: list[list[Run]]) -> list[list[float]]:
    return [[1 / run.steps for run in row] for row in rows]


def _table_is_right(rows: list[list[float]]) -> None:
    for row in rows:
        assert tuple(map(four, row)) == PRINTED
        assert all(one < two for one, two in pairwise(row))
        assert abs(lg(row[-1]) + 6) < 0.5
    assert all(max(column) <= 2 * min(column) for column in zip(*rows, strict=True))


@over_20000
def test_with_1_over_n_all_that_is_said_of_table_1_is_right(runs: LongRuns) -> None:
    """Figure 1(b) among it: the ratio to |Λ| falls, from all starts alike, and is below 1."""
    rows = runs.grid("duffing")
    _table_is_right(_with_1_over_n(rows))
    for row in rows:
        ratios = [1 / run.steps / abs(run.area) for run in row]
        assert all(one > two for one, two in pairwise(ratios))
        assert max(ratios) < 1
    with pytest.raises(AssertionError):
        _table_is_right([[run.mse for run in row] for row in rows])


@over_20000
def test_with_1_over_n_all_that_is_said_of_table_2_is_right(runs: LongRuns) -> None:
    rows = runs.grid("pendulum")
    _table_is_right(_with_1_over_n(rows))
    with pytest.raises(AssertionError):
        _table_is_right([[run.mse for run in row] for row in rows])


def _with_one_entry_0(runs: LongRuns, system: str) -> float:
    """The greatest sum of the squares of ΔJ, beside the 1 of a determinant that is left at 0."""
    for row in runs.grid(system):
        assert tuple(four(run.mse + 1 / run.steps) for run in row) == PRINTED
        assert tuple(four(run.mse + 2 / run.steps) for run in row) != PRINTED  # two entries
    return max(run.mse * run.steps for row in runs.grid(system) for run in row)


@over_20000
def test_one_determinant_that_is_left_at_0_makes_table_1(runs: LongRuns) -> None:
    assert _with_one_entry_0(runs, "duffing") == pytest.approx(6.35e-5, rel=2e-3)


@over_20000
def test_one_determinant_that_is_left_at_0_makes_table_2(runs: LongRuns) -> None:
    assert _with_one_entry_0(runs, "pendulum") == pytest.approx(3.49e-7, rel=2e-3)
