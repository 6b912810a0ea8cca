"""Errors of the solution, the largest over a run's last period, against the exact solution there.

Both are measured in long double at 300 times or more of that period; errors are in parts of the
orbit's reach and hold to 2 %, of which the samples leave out less than 0.1 %.
"""

import mpmath
import pytest

from tests.second.long_runs import LONG, STARTS, STEP_SIZES, LongRuns, Start, orbit

pytestmark = pytest.mark.left_to_ci

TENTH = 0.1
# Of the reach; a row for each start, a column for each step size.
ERRORS = {
    "duffing": [
        [0.00357, 0.01505, 0.06626, 0.1626, 0.3126, 0.5227],
        [0.01087, 0.06849, 0.4688, 1.352, 2.000, 0.0662],
        [0.3000, 1.728, 1.192, 1.720, 1.895, 1.864],
        [0.5111, 1.995, 1.919, 1.917, 1.994, 0.4594],
        [0.1114, 0.7944, 1.432, 1.899, 1.567, 1.485],
    ],
    "pendulum": [
        [0.00330, 0.01306, 0.05124, 0.1130, 0.1968, 0.3007],
        [0.00245, 0.00681, 0.00337, 0.04624, 0.1778, 0.4251],
        [0.00305, 0.03303, 0.2975, 0.9925, 1.876, 1.441],
        [0.0948, 0.7855, 1.937, 6.376, 15.22, 29.22],
        [0.00365, 0.04049, 0.3665, 1.190, 1.990, 0.5575],
    ],
}


def errors(runs: LongRuns, system: str) -> list[list[float]]:
    rows = [[run.worst for run in row] for row in runs.grid(system)]
    for row, numbers in zip(rows, ERRORS[system], strict=True):
        assert row == pytest.approx(numbers, rel=2e-2)
    return rows


def within(rows: list[list[float]]) -> int:
    return sum(error <= TENTH for row in rows for error in row)


def of_size(rows: list[list[float]], size: str) -> list[float]:
    return [row[STEP_SIZES.index(size)] for row in rows]


# -- the yardstick ---------------------------------------------------------------------------------


@pytest.mark.parametrize("start", STARTS)
def test_the_exact_solution_is_back_after_whole_periods(runs: LongRuns, start: Start) -> None:
    """The periods are elliptic integrals, which the Taylor series know nothing of."""
    for system in ("duffing", "pendulum"):
        period = orbit(system, start).period
        turns = int(LONG / period)
        q, p = runs.exact(system, start, turns * period)
        if (system, start) == ("pendulum", (1.5, 1.5)):  # it goes round
            q -= 2 * float(mpmath.pi) * turns
        assert (q, p) == pytest.approx(start, abs=1e-7)


@pytest.mark.parametrize("q0", [0.1, 0.5, 1.5])
def test_the_exact_solution_is_jacobi_s_at_the_end(runs: LongRuns, q0: float) -> None:
    with mpmath.workdps(30):
        start, time = mpmath.mpf(q0), mpmath.mpf(LONG)
        stiff = 1 + start**2
        cn = mpmath.ellipfun("cn", mpmath.sqrt(stiff) * time, m=start**2 / (2 * stiff))
        k = mpmath.sin(start / 2)
        cd = mpmath.ellipfun("cd", time, m=k**2)
        expected = {"duffing": float(start * cn), "pendulum": float(2 * mpmath.asin(k * cd))}
    for system, q in expected.items():
        assert runs.exact(system, (q0, 0.0), LONG)[0] == pytest.approx(q, abs=1e-8)


# -- the paper's runs ------------------------------------------------------------------------------


def test_6_of_30_duffing_runs_are_within_a_tenth(runs: LongRuns) -> None:
    rows = errors(runs, "duffing")
    assert within(rows) == 6
    assert min(map(min, rows)) == pytest.approx(3.57e-3, rel=2e-2)
    assert max(map(max, rows)) == pytest.approx(2.00, rel=2e-2)


def test_12_of_30_runs_of_the_pendulum_are_within_a_tenth(runs: LongRuns) -> None:
    """The farthest, which goes round, is off by 14.6 turns."""
    rows = errors(runs, "pendulum")
    assert within(rows) == 12
    assert min(map(min, rows)) == pytest.approx(2.45e-3, rel=2e-2)
    assert max(map(max, rows)) == pytest.approx(29.2, rel=2e-2)


def test_with_h_0_001_2_of_5_duffing_runs_are_within_a_tenth(runs: LongRuns) -> None:
    column = of_size(errors(runs, "duffing"), "0.001")
    assert [error <= TENTH for error in column] == [True, True, False, False, False]
    assert max(column) == pytest.approx(0.511, rel=2e-2)


def test_with_h_0_001_all_5_runs_of_the_pendulum_are_within_a_tenth(runs: LongRuns) -> None:
    """One with a twentieth of that to spare."""
    column = of_size(errors(runs, "pendulum"), "0.001")
    assert max(column) == column[3] == pytest.approx(0.0948, rel=1e-3)
    assert max(column) < TENTH


def test_with_h_0_01_no_run_of_the_pendulum_is_within_a_tenth(runs: LongRuns) -> None:
    column = of_size(errors(runs, "pendulum"), "0.01")
    assert min(column) == column[0] == pytest.approx(0.3007, rel=2e-2)
    assert max(column) == column[3] == pytest.approx(29.2, rel=2e-2)


def test_the_error_at_the_end_alone_would_depend_on_the_phase(runs: LongRuns) -> None:
    """With h = 0.001 from (0, 1.5) it is within a tenth, the largest over the period is not."""
    run = runs.grid("duffing")[4][0]
    assert run.end == pytest.approx(0.0686, rel=2e-2)
    assert run.worst == pytest.approx(0.1114, rel=2e-2)


def test_with_h_0_0001_the_pendulum_is_within_a_tenth_by_far(runs: LongRuns) -> None:
    """Figure 10, 2·10⁸ steps, in double precision, and the first 20 units of time."""
    (run,) = runs.of("pendulum", (1.5, 0.0), ("0.0001",), real="double")
    assert run.steps == 2 * 10**8
    assert run.worst == pytest.approx(1.6e-5, rel=5e-2)
    (start,) = runs.of("pendulum", (1.5, 0.0), ("0.0001",), time=20)
    assert start.worst == pytest.approx(2.146e-8, rel=1e-2)


def test_double_precision_is_enough_for_that(runs: LongRuns) -> None:
    """With a twentieth of its steps its rounding is not seen."""
    (fine,), (plain,) = (
        runs.of("pendulum", (1.5, 0.0), ("0.002",), real=real) for real in ("long double", "double")
    )
    assert plain.worst == pytest.approx(fine.worst, rel=1e-5)
