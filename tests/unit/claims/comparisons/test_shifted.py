"""Verdicts that would be the same if steps were counted from 1."""

from fractions import Fraction
from typing import Any

import pytest
from pydantic import ValidationError

from tests.helpers.constructed.runs import CLAIM, Given, check, growing
from verify.arithmetic.arb import precision
from verify.claims.base_claim import Findings
from verify.claims.kinds.comparisons.shifted import ShiftedClaim
from verify.hamiltonians import systems
from verify.scenes.scene import scene_from
from verify.verdict import Verdict

MEASURED, REFUTED = Verdict.MEASURED, Verdict.REFUTED

FIXED = {"q": Fraction(1), "p": Fraction(0)}


def shifted(*again: dict[str, Any]) -> ShiftedClaim:
    return ShiftedClaim(**CLAIM, kind="shifted", again=again)


MONOTONE = {"kind": "monotone", "quantity": "abs_lambda", "direction": "increases"}


def test_a_verdict_that_one_step_more_or_less_does_not_change() -> None:
    def values(h: Fraction, k: int) -> dict[str, Given]:
        return {**growing(h, k), "lambda": h * (k + 1), **FIXED}

    found = check(shifted(MONOTONE), values)
    assert found.verdict is MEASURED
    assert "1 of 1 verdicts are the same" in found.evidence


def test_a_verdict_that_hangs_on_one_step_is_refuted() -> None:
    """ΔJ of the pendulum is about h⁴/4 at the ends: Λ of that size turns with the count."""

    def values(h: Fraction, k: int) -> dict[str, Given]:
        return {**growing(h, k), "lambda": Fraction("1e-10") + h * Fraction("1e-16"), **FIXED}

    found = check(shifted(MONOTONE), values)
    assert found.verdict is REFUTED
    assert "0 of 1 verdicts are the same" in found.evidence


def test_the_other_count_is_that_of_the_run_itself_one_step_on(tmp_path: Any) -> None:
    """Λ and MSE over z_1 … z_N, by a run of N steps that starts at z_1."""
    from verify.claims.kinds.comparisons import shifted as module
    from verify.runs.requested_run import run
    from verify.studies.kinds.grid import grid_task

    exact, steps = systems.get("pendulum").hamiltonian(), 50
    scene = scene_from(
        {"name": "made", "system": "pendulum", "schemes": ["lie2"],
         "grid": {"steps": steps, "step_sizes": ["0.1"], "initial_values": [{"q": "1", "p": "0"}]}},
        "by hand",
    )  # fmt: skip
    task = grid_task(scene, "lie2", Fraction(1, 10), 0)
    first = run(exact, "lie2", q=1, p=0, step_size="0.1", steps=steps, digits=25)
    onward = run(exact, "lie2", q=1, p=0, step_size="0.1", steps=1, digits=30)
    later = run(
        exact, "lie2", q=onward.values["q"].value, p=onward.values["p"].value,
        step_size="0.1", steps=steps, digits=25,
    )  # fmt: skip
    findings = Findings({"made": scene}, {task.key: first})
    with precision():
        changed, _ = module._shift_runs(findings, [task], exact, "lie2")
    for name in ("lambda", "mse"):
        by_shift = Fraction(changed[task.key].values[name].value)
        assert abs(by_shift / Fraction(later.values[name].value) - 1) < Fraction(1, 10**15)
        assert abs(by_shift / Fraction(first.values[name].value) - 1) > Fraction(1, 10**6)


@pytest.mark.parametrize(
    ("table", "problem"),
    [
        ({"kind": "order", "order": 3}, "is no kind of claim on runs"),
        ({"kind": "monotonous"}, "is no kind of claim on runs"),
        ({"kind": "shifted", "again": []}, "is no kind of claim on runs"),
        ({**MONOTONE, "quantity": "delta_j_max"}, "is not made of lambda and mse"),
    ],
)
def test_only_claims_on_lambda_and_mse_are_made_again(table: dict[str, Any], problem: str) -> None:
    with pytest.raises(ValidationError, match=problem):
        shifted(table)
