"""A theorem's argument is a task: computed by workers, kept, and what a claim is judged by."""

from pathlib import Path

import pytest

from verify.claims.kinds.theorem import TheoremClaim
from verify.claims.verdicts import add_claims, judge_claim
from verify.execution.execute import Store, execute
from verify.execution.keeper import NOTHING
from verify.execution.plan import Plan
from verify.papers import check_theorem
from verify.papers.argument import Argument
from verify.papers.task import TheoremTask
from verify.prose import prose
from verify.verdict import Verdict

NAMES = ("criterion-4", "lie-exponential", "determinant-classification")


def claim(name: str) -> TheoremClaim:
    return TheoremClaim(id=name, kind="theorem", name=name)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_kept_is_what_was_found(name: str, tmp_path: Path) -> None:
    plan, store = Plan(), Store(tmp_path)
    assert not add_claims(plan, [claim(name)], {})
    first = execute(plan, store)
    again = Store(tmp_path)
    kept = execute(plan, again)
    assert again.taken == 1
    assert [*first.values()] == [*kept.values()] == [check_theorem(name)]
    without = judge_claim(claim(name), {}, {}, store)
    assert judge_claim(claim(name), {}, kept, store) == without
    assert without.verdict is check_theorem(name).verdict


def test_the_verdict_is_that_of_the_result() -> None:
    task, store = TheoremTask(name=NAMES[0]), Store(None)
    found = task.compute(NOTHING)
    assert isinstance(found, Argument)
    planted = found.model_copy(update={"verdict": Verdict.UNDECIDED, "evidence": prose("planted")})
    judgement = judge_claim(claim(NAMES[0]), {}, {task.key: planted}, store)
    assert (judgement.verdict, str(judgement.evidence)) == (Verdict.UNDECIDED, "planted")
