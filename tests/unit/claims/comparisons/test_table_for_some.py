"""A printed table for some value of a parameter."""

from math import log10
from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.claims.verdicts import prepare
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

CLAIM = """
[[claim]]
id = "c"
kind = "table_for_some"
scheme = "lie2"
system = "duffing"
parameters = {{ delta = 1 }}
parameter = "{parameter}"
values = {values}
time = 10
step_sizes = [0.1, 0.2]
initial_values = [{{ q = 0.5, p = 0 }}]
printed = ["{first}", "{second}"]
"""


def lg_mse(delta: float, h: float) -> str:
    """The same by a plain loop in doubles."""
    p, q, total, steps = 0.0, 0.5, 0.0, round(10 / h)
    for _ in range(steps):
        total += (3 * h**3 * delta * p * q + h**4 * (1 + 3 * delta * q * q) ** 2 / 4) ** 2
        force, slope = q + delta * q**3, 1 + 3 * delta * q * q
        p, q = p - h * force - h * h / 2 * p * slope, q + h * p - h * h / 2 * force
    return f"{log10(total / steps):.4f}"


def judged(folder: Path, values: str, first: str, second: str) -> ClaimResult:
    text = CLAIM.format(parameter="delta", values=values, first=first, second=second)
    path = folder / "claims.toml"
    path.write_text(text)
    (result,) = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    return result


def test_one_of_the_values_is_enough(tmp_path: Path) -> None:
    row = (lg_mse(2, 0.1), lg_mse(2, 0.2))
    assert judged(tmp_path, "[0.5, 2]", *row).verdict is Verdict.ENCLOSED
    assert judged(tmp_path, "[0.5, 3]", *row).verdict is Verdict.REFUTED
    shown = judged(tmp_path, "[0.5, 3]", *row)
    assert "delta = 0.5: computed lg MSE lies between" in shown.evidence
    assert [row[0] for row in shown.details] == [
        "initial value", "printed, for all", "q₀ = 0.5, p₀ = 0, delta = 0.5",
        "q₀ = 0.5, p₀ = 0, delta = 3",
    ]  # fmt: skip


def test_of_a_value_whose_runs_leave_the_range_nothing_is_known(tmp_path: Path) -> None:
    row = (lg_mse(2, 0.1), lg_mse(2, 0.2))
    result = judged(tmp_path, "[3, 1e30]", *row)
    assert result.verdict is Verdict.UNDECIDED
    assert "left the range" in result.evidence


def test_another_parameter_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(CLAIM.format(parameter="epsilon", values="[1]", first="-1", second="-1"))
    with pytest.raises(InputError, match=r"parameter=epsilon: unknown; .*delta"):
        load_claims(path)
