"""The base of claims that make other claims again, of the same runs with other values in them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from verify.claims.findings import Findings
from verify.claims.kinds import models
from verify.claims.on_runs import RunClaim
from verify.errors import InputError
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult


class AgainClaim(RunClaim):
    """`again`: claims of the same scene and scheme, each its kind and its keys."""

    only_here = "which claims are made again is a matter of their own scene"
    again: Annotated[tuple[dict[str, Any], ...], Field(min_length=1, max_length=100)]
    """Claims of the same scene and scheme, each its kind and its keys."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        for claim in self.claims():
            problem = self.refuses(claim)
            if problem:
                raise InputError("again", claim.kind, problem)
        return self

    def claims(self) -> list[RunClaim]:
        """The claims that are made again."""
        return list(self._made())

    def _made(self) -> Iterator[RunClaim]:
        for n, table in enumerate(self.again, start=1):
            kind = table.get("kind")
            model = models().get(kind) if isinstance(kind, str) else None
            if model is None or not issubclass(model, RunClaim) or issubclass(model, AgainClaim):
                raise InputError("again", kind, "is no kind of claim on runs")
            stamp = {"id": f"{self.id}-{n}", "scene": self.scene, "scheme": self.scheme}
            yield model.model_validate({**table, **stamp})

    def twice(
        self, findings: Findings, changed: Mapping[str, RunResult]
    ) -> list[tuple[ClaimResult, ClaimResult]]:
        """Each claim's results by the runs as they are, and with the changed ones among them."""
        again = Findings(findings.scenes, {**findings.results, **changed})
        return [(claim.compare(findings), claim.compare(again)) for claim in self.claims()]

    def rows(self, both: Sequence[tuple[ClaimResult, ClaimResult]]) -> list[list[str]]:
        """For each claim its keys in words, and on which side of its question it is, twice.

        How sure it is of that, its result says.
        """
        words = (
            ", ".join(f"{k} {v}" for k, v in table.items() if isinstance(v, str | int))
            for table in self.again
        )
        return [
            [said, *("holds" if x.verdict.holds else x.verdict.lower() for x in pair)]
            for said, pair in zip(words, both, strict=True)
        ]

    def refuses(self, claim: RunClaim) -> str:
        """Why this claim cannot be made again; empty where it can."""
        return "takes runs of its own" if claim.always_own else ""
