"""The base of claims that repeat other claims on the same runs with changed values."""

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
        """Return the claims that are repeated."""
        return list(self._build_claims())

    def _build_claims(self) -> Iterator[RunClaim]:
        for n, table in enumerate(self.again, start=1):
            kind = table.get("kind")
            model = models().get(kind) if isinstance(kind, str) else None
            # AgainClaim is excluded: a list of claims within one of them could nest forever.
            if model is None or not issubclass(model, RunClaim) or issubclass(model, AgainClaim):
                raise InputError("again", kind, "is no kind of claim on runs")
            # The stamp comes last: a table must not leave the scene and scheme of this claim.
            stamp = {"id": f"{self.id}-{n}", "scene": self.scene, "scheme": self.scheme}
            yield model.model_validate({**table, **stamp})

    def compare_twice(
        self, findings: Findings, changed_runs: Mapping[str, RunResult]
    ) -> list[tuple[ClaimResult, ClaimResult]]:
        """Return each claim's results by the original runs and by the changed ones."""
        again = Findings(findings.scenes, {**findings.results, **changed_runs})
        return [(claim.compare(findings), claim.compare(again)) for claim in self.claims()]

    def rows(self, both: Sequence[tuple[ClaimResult, ClaimResult]]) -> list[list[str]]:
        """Return a row for each claim: its keys in words, then both of its verdicts.

        A verdict that holds is written as `holds`, whether it is PROVED or MEASURED: both results
        are compared by the side that they take, and not by how certain they are.
        """
        words = (
            ", ".join(f"{k} {v}" for k, v in table.items() if isinstance(v, str | int))
            for table in self.again
        )
        return [
            [description, *("holds" if x.verdict.holds else x.verdict.lower() for x in pair)]
            for description, pair in zip(words, both, strict=True)
        ]

    def refuses(self, claim: RunClaim) -> str:
        """Return why this claim cannot be repeated; empty if it can."""
        return "takes runs of its own" if claim.always_own else ""
