"""A statement in words, judged by the function of that `name` in `verify.papers`."""

from collections.abc import Iterable
from typing import Literal, Self

from pydantic import model_validator

from verify.claims.base_claim import Claim, Findings
from verify.errors import unknown_name
from verify.execution.task import Task
from verify.papers import check_theorem, names
from verify.papers.argument import Argument
from verify.papers.task import TheoremTask
from verify.prose import join_prose
from verify.scenes.results.claim import ClaimResult


class TheoremClaim(Claim):
    """A claim in words, which has neither scene nor scheme."""

    on_scene = False
    obstacle = "a theorem says nothing of drawn Hamiltonians"
    kind: Literal["theorem"]
    name: str
    """The name of its function in `verify.papers`."""
    scheme: str = ""
    """None."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.name not in names():
            raise unknown_name("name", self.name, names())
        return self

    def tasks_without_scene(self) -> Iterable[Task]:
        yield self._task

    @property
    def _task(self) -> TheoremTask:
        return TheoremTask(name=self.name)

    def judge(self, findings: Findings) -> ClaimResult:
        stored = findings.results.get(self._task.key)
        argument = stored if isinstance(stored, Argument) else check_theorem(self.name)
        result = self.result(argument.verdict, argument.evidence, argument.details, argument.proof)
        update = {name: getattr(argument, name) for name in ("checked_by", "given", "steps")}
        update["remark"] = join_prose(" ", [*filter(None, (argument.remark, result.remark))])
        return result.model_copy(update=update)


CLAIM = TheoremClaim
