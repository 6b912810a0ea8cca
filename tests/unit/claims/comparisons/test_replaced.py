"""Claims that are made again with another number in place of MSE."""

from fractions import Fraction
from typing import Any

import pytest
from pydantic import ValidationError

from tests.helpers.constructed.runs import CLAIM, Given, check, growing, made_findings, made_scene
from verify.claims.kinds.comparisons.replaced import ReplacedClaim
from verify.verdict import Verdict

ROW = ["-7.3010", "-7.0000", "-6.6990", "-6.5229", "-6.3979", "-6.3010"]  # lg(h/20000)
SIZES = [0.001, 0.002, 0.004, 0.006, 0.008, 0.01]
TABLE = {"kind": "table", "step_sizes": SIZES, "printed": ROW}
RATIO = {"kind": "monotone", "quantity": "mse_over_lambda", "direction": "decreases"}
FLAT = {"kind": "spread", "quantity": "mse", "factor": 2}


def replaced(mse: str, *again: dict[str, Any]) -> ReplacedClaim:
    return ReplacedClaim(**CLAIM, kind="replaced", mse=mse, again=again)


def holds(mse: str, *again: dict[str, Any]) -> Verdict:
    return check(replaced(mse, *again), growing).verdict


def test_what_is_said_of_the_number_of_steps_holds_of_it_and_not_of_mse() -> None:
    assert holds("1/N", TABLE, RATIO, FLAT).holds
    assert holds("mse", TABLE) is Verdict.REFUTED
    assert holds("mse", RATIO) is Verdict.REFUTED
    assert holds("mse", FLAT) is Verdict.REFUTED


def test_a_factor_a_shift_or_another_power_is_seen() -> None:
    assert holds("mse + 1/N", TABLE).holds
    assert holds("2/N", TABLE) is Verdict.REFUTED
    assert holds("1/N + 1/1000000000", TABLE) is Verdict.REFUTED
    assert holds("h/20000", TABLE).holds
    assert holds("h**2/20000", TABLE) is Verdict.REFUTED


def test_one_claim_that_does_not_hold_is_enough() -> None:
    result = check(replaced("1/N", TABLE, {**RATIO, "direction": "increases"}), growing)
    assert result.verdict is Verdict.REFUTED
    assert "1 of 2 claims hold" in result.evidence
    assert [row[-1] for row in result.details[1:]] == ["holds", "refuted"]


def test_a_value_that_is_not_known_leaves_it_open() -> None:
    def wide(h: Fraction, k: int) -> dict[str, Given]:
        return {**growing(h, k), "mse": (h**6, 1)}

    assert check(replaced("mse + 1/N", TABLE), wide).verdict is Verdict.UNDECIDED
    assert check(replaced("1/mse", TABLE), wide).verdict is Verdict.UNDECIDED


def test_a_run_that_left_the_range_leaves_it_open() -> None:
    scene = made_scene()
    findings = made_findings(scene, growing, status="left range", failed_step=9)
    result = replaced("1/N", TABLE).judge(findings)
    assert result.verdict is Verdict.UNDECIDED
    assert "left the range at step 9" in result.evidence


@pytest.mark.parametrize(
    ("mse", "again", "said"),
    [
        ("1/M", [TABLE], "unknown name"),
        ("1/N", [{"kind": "order", "order": 2}], "is no kind of claim on runs"),
        ("1/N", [{"kind": "replaced", "mse": "1", "again": [TABLE]}], "is no kind of claim"),
        ("1/N", [{"kind": "growth", "growth": "linear"}], "takes runs of its own"),
        ("1/N", [], "at least 1 item"),
    ],
)
def test_what_cannot_be_made_again_is_refused(mse: str, again: Any, said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        replaced(mse, *again)
