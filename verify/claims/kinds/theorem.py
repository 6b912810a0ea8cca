"""What a paper says in words, judged by the function of that `name` in `verify.papers`."""

from collections.abc import Iterable
from typing import Literal, Self

from pydantic import model_validator

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.errors import unknown
from verify.execution.task import Task
from verify.papers import check_theorem, names
from verify.papers.argument import Argument
from verify.papers.task import TheoremTask
from verify.prose import joined
from verify.scenes.results.claim import ClaimResult


class TheoremClaim(Claim):
    """A claim in words, which has neither scene nor scheme."""

    on_scene = False
    only_here = "a theorem says nothing of drawn Hamiltonians"
    kind: Literal["theorem"]
    name: str
    """The name of its function in `verify.papers`."""
    scheme: str = ""
    """None."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.name not in names():
            raise unknown("name", self.name, names())
        return self

    def tasks_without_scene(self) -> Iterable[Task]:
        yield self._task

    @property
    def _task(self) -> TheoremTask:
        return TheoremTask(name=self.name)

    def judge(self, findings: Findings) -> ClaimResult:
        known = findings.results.get(self._task.key)
        found = known if isinstance(known, Argument) else check_theorem(self.name)
        result = self.result(found.verdict, found.evidence, found.details, found.proof)
        own = {name: getattr(found, name) for name in ("checked_by", "given", "steps")}
        own["remark"] = joined(" ", [*filter(None, (found.remark, result.remark))])
        return result.model_copy(update=own)


CLAIM = TheoremClaim
