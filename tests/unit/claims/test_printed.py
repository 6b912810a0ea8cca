"""Tables of printed decimals against runs: true to the last digit, false, or not to be told."""

from decimal import Decimal
from fractions import Fraction
from typing import Any

import mpmath
import pytest

from tests.helpers.constructed.runs import (
    CLAIM,
    FLAT,
    STARTS,
    STEP_SIZES,
    Given,
    Values,
    check,
    made_scene,
    one_changed,
)
from verify.claims.base_claim import Findings
from verify.claims.kinds.table import PrintedTableClaim
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.studies.tasks_of_scenes import plan_scenes
from verify.verdict import Verdict

MEASURED, REFUTED, UNDECIDED = Verdict.MEASURED, Verdict.REFUTED, Verdict.UNDECIDED
ENCLOSED = Verdict.ENCLOSED
H = [Fraction(h) for h in STEP_SIZES]
LAST = (H[-1], len(STARTS) - 1)  # where a mistake is put: at the last run of all
ROW = ["-19.3010", "-18.1234", "-17.0000", "-16.5229", "-15.9999", "-15.0001"]


def table(printed: list[str], step_sizes: list[Fraction] = H) -> PrintedTableClaim:
    return PrintedTableClaim(
        **CLAIM, kind="table", step_sizes=tuple(step_sizes), printed=tuple(printed)
    )


def as_in_row(share: Fraction = Fraction(0), bound: Any = 0) -> Values:
    """MSE with lg MSE = the printed number + share of its last unit, and a bound on the MSE."""

    def values(h: Fraction, _: int) -> dict[str, Given]:
        lg = Fraction(ROW[H.index(h)]) + share / 10**4
        with mpmath.workdps(40):
            mse = mpmath.nstr(mpmath.mpf(10) ** (mpmath.mpf(lg.numerator) / lg.denominator), 35)
        return {**FLAT, "mse": (mse, Fraction(mse) * Fraction(bound))}

    return values


@pytest.mark.parametrize("share", ["0", "0.49", "-0.49"])
def test_a_table_is_measured_where_every_value_rounds_to_what_is_printed(share: str) -> None:
    assert check(table(ROW), as_in_row(Fraction(share), "1e-7")).verdict is MEASURED


@pytest.mark.parametrize("share", ["0.51", "-0.51", "1", "-1"])
def test_a_table_is_refuted_where_values_round_to_another_digit(share: str) -> None:
    assert check(table(ROW), as_in_row(Fraction(share), "1e-7")).verdict is REFUTED


@pytest.mark.parametrize(("share", "bound"), [("0.499", "1e-4"), ("0.501", "1e-4"), ("0", "0.01")])
def test_a_table_is_undecided_where_a_ball_rounds_to_two_decimals(share: str, bound: str) -> None:
    assert check(table(ROW), as_in_row(Fraction(share), bound)).verdict is UNDECIDED


@pytest.mark.parametrize("place", range(len(ROW)))
@pytest.mark.parametrize("digit", [-1, -2, -3, -4, -6])
def test_a_table_with_one_digit_changed_is_refuted(place: int, digit: int) -> None:
    entry = ROW[place]
    changed = str((int(entry[digit]) + 1) % 10)
    wrong = [*ROW]
    wrong[place] = entry[:digit] + changed + entry[len(entry) + digit + 1 :]
    assert wrong[place] != entry
    assert len(wrong[place]) == len(entry)
    found = check(table(wrong), as_in_row())
    assert found.verdict is REFUTED
    said = f"1 of the {len(H)} printed values are not the lg MSE from each of the initial values"
    assert said in found.evidence


@pytest.mark.parametrize("given", ["1e-14", ("0", "1e-10"), ("1.1e-15", "1e-15")])
def test_one_run_that_differs_keeps_a_table_from_being_measured(given: Given) -> None:
    found = check(table(ROW), one_changed(LAST, "mse", given, as_in_row()))
    assert found.verdict is (REFUTED if given == "1e-14" else UNDECIDED)


def test_the_papers_row_is_refuted_and_named_as_one_over_n() -> None:
    row = ["-7.3010", "-7.0000", "-6.6990", "-6.5229", "-6.3979", "-6.3010"]
    found = check(table(row), as_in_row())
    assert found.verdict is REFUTED
    assert "the printed row is lg(1/N) = lg(h/T) to all its digits" in found.evidence
    assert "lg(1/N)" not in check(table([*row[:5], "-6.3011"]), as_in_row()).evidence
    powers = ["-6.0000", "-5.3979", "-4.7959", "-4.4437", "-4.1938", "-4.0000"]
    assert (
        "the printed row is lg(h^2) = lg(T^2/N^2) to" in check(table(powers), as_in_row()).evidence
    )
    shown = {cell for line in found.details for cell in line}
    assert set(row) | set(ROW) <= shown, "printed and computed values stand side by side"


def test_a_table_row_from_our_own_runs_is_measured_and_refuted_with_a_digit_changed() -> None:
    scene = made_scene(step_sizes=("0.05", "0.1"), starts=(("1.5", "0"),))
    grid = scene.grid.model_copy(update={"time": Fraction(5)})  # type: ignore[union-attr]
    scene = scene.model_copy(update={"grid": grid})
    findings = Findings(
        {"made": scene}, execute(plan_scenes([scene]), Store(None), where=THIS_PROCESS)
    )
    runs = findings.runs(scene, "lie2")
    logarithms = [mpmath.nstr(mpmath.log10(r.values["mse"].value), 15) for r in runs]
    printed = [f"{Decimal(x):.4f}" for x in logarithms]
    claim = table(printed, [Fraction(r.step_size) for r in runs])
    assert [claim.judge(findings)][0].verdict is ENCLOSED
    last = str((int(printed[1][-1]) + 1) % 10)
    wrong = table([printed[0], printed[1][:-1] + last], list(claim.step_sizes))
    assert [wrong.judge(findings)][0].verdict is REFUTED
