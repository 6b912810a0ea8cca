"""Claims that values have no pattern, which those of a growth law refute."""

from typing import Any

import pytest

from verify.claims.check import prepare
from verify.claims.file import load_claims
from verify.claims.findings import Findings
from verify.claims.kinds.comparisons.no_pattern import NoPatternClaim
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.verdict import Verdict

REFUTED, UNDECIDED = Verdict.REFUTED, Verdict.UNDECIDED

PATTERN = """
[[claim]]
id = "c"
kind = "no_pattern"
scheme = "{scheme}"
system = "duffing"
parameters = {{ delta = 1 }}
step_sizes = [0.01, 0.02]
initial_values = [{{ q = 0.5, p = 0 }}, {{ q = 0, p = 1.5 }}]
time = 20
within = {within}
"""


@pytest.mark.parametrize(
    ("scheme", "within", "expected"), [("lie2", "0.1", REFUTED), ("lie2", "1e-9", UNDECIDED)]
)
def test_values_that_follow_their_growth_law_have_a_pattern(
    tmp_path: Any, scheme: str, within: str, expected: Verdict
) -> None:
    path = tmp_path / "claims.toml"
    path.write_text(PATTERN.format(scheme=scheme, within=within))
    found = prepare(load_claims(path)).run(Store(None), where=THIS_PROCESS)
    assert [claim.verdict for claim in found] == [expected]


@pytest.mark.left_to_ci
def test_values_that_do_not_follow_the_law_are_not_refuted(tmp_path: Any) -> None:
    """The same runs with another Λ at the end of one of them."""
    path = tmp_path / "claims.toml"
    path.write_text(PATTERN.format(scheme="lie2", within="0.1"))
    check_ = prepare(load_claims(path))
    (claim,) = check_.claims
    assert isinstance(claim, NoPatternClaim)
    store = Store(None)
    check_.run(store, where=THIS_PROCESS)
    from verify.execution.execute import execute
    from verify.scenes.results.run import RunResult

    results = dict(execute(check_.plan, store, where=THIS_PROCESS))
    key = next(k for k, each in results.items() if isinstance(each, RunResult))
    run = results[key]
    assert isinstance(run, RunResult)
    lam = run.values["lambda"]
    doubled = lam.model_copy(update={"value": f"{float(lam.value) * 2:.12f}"})
    values = {**run.values, "lambda": doubled}
    results[key] = run.model_copy(update={"values": values})
    assert claim.judge(Findings(check_.file.scenes, results)).verdict is UNDECIDED
