"""The scheme satisfies these of the paper's criteria."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any, Literal

from pydantic import Field

from verify.claims.base_claim import Findings
from verify.claims.quantified_claims import OF_DELTA_J, OF_LAMBDA, marks_for_scene
from verify.claims.run_claims import RunClaim
from verify.execution.task import Task
from verify.prose import Prose, join_prose, prose
from verify.scenes.observables import CLOSED_FORM
from verify.scenes.results.claim import ClaimResult
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.studies.kinds.proofs import proof_task
from verify.verdict import Verdict

# Criteria 1 and 2 are about ΔJ as a function; 3 and 4 may also need numbers of runs.
_BY_PROOF_ALONE = {1, 2}


class CriteriaClaim(RunClaim):
    """Criteria of area preservation, by their numbers."""

    obstacle = ""
    kind: Literal["criteria"]
    numbers: Annotated[
        tuple[Annotated[int, Field(ge=1, le=4, strict=True)], ...], Field(min_length=1)
    ]
    """The criteria that are satisfied."""

    def observables(self) -> tuple[str, ...]:
        return CLOSED_FORM

    def check_grid(self, name: str, scene: Scene) -> None:
        """Accept a scene without a grid, for a proof may decide the criteria without a run."""

    def _with_grid(
        self, label: str, scene: Scene, base: Grid | None, runs: Mapping[str, Any]
    ) -> tuple[str, Scene]:
        if not runs:
            return f"{label}: claim {self.id}", scene
        return super()._with_grid(label, scene, base, runs)

    def tasks(self, scene: Scene) -> Iterable[Task]:
        if not set(self.numbers) <= _BY_PROOF_ALONE:
            yield from super().tasks(scene)
        yield proof_task(scene, self.scheme)

    def judge(self, findings: Findings) -> ClaimResult:
        """Return the weakest of the criteria's verdicts."""
        return self.compare(findings)

    def checked_by(self, result: ClaimResult, findings: Findings) -> Sequence[Prose]:
        """Return the marks of the proof about ΔJ, and for criterion 4 also about Λ."""
        if result.verdict is not Verdict.PROVED:
            return ()
        about = OF_DELTA_J | OF_LAMBDA if 4 in self.numbers else OF_DELTA_J
        return marks_for_scene(self, findings, about)

    def compare(self, findings: Findings) -> ClaimResult:
        scene = findings.scene(self.scene)
        criteria = [findings.criterion(scene, self.scheme, n) for n in self.numbers]
        evidence = join_prose(
            "; ", (prose(f"criterion {c.number}: ", c.evidence) for c in criteria)
        )
        verdicts = [c.verdict for c in criteria]
        # The claim on all of them is as strong as the weakest verdict.
        for weak in (Verdict.REFUTED, Verdict.UNDECIDED, Verdict.MEASURED):
            if weak in verdicts:
                return self.result(weak, evidence)
        return self.result(Verdict.PROVED, evidence)


CLAIM = CriteriaClaim
