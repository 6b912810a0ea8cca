"""A printed table is right for some of these values of a parameter that it does not name."""

from collections.abc import Iterable
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.kinds.table import PrintedTableClaim
from verify.claims.quantities import NoValueError, all_hold
from verify.errors import InputError, unknown_name
from verify.execution.task import Task
from verify.prose import Number, join_prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.scenes.scene import Scene
from verify.scenes.values import ExactNumber
from verify.studies.kinds.grid import grid_tasks
from verify.verdict import Verdict


class TableForSomeClaim(PrintedTableClaim):
    """A table with an unnamed parameter, REFUTED if it is refuted for each of the given values."""

    obstacle = "a printed table is that of its own runs"
    kind: Literal["table_for_some"]  # type: ignore[assignment]
    parameter: str
    """A parameter of H."""
    values: Annotated[tuple[ExactNumber, ...], Field(min_length=1, max_length=100)]
    """The values of it for which the runs are done."""

    def check_scene(self, scene: Scene) -> None:
        super().check_scene(scene)
        if self.parameter not in scene.parameters:
            raise unknown_name("parameter", self.parameter, scene.parameters)
        if scene.grid is None:
            raise InputError("values", self.parameter, "are of runs; give step_sizes and time")

    def _scenes(self, scene: Scene) -> list[Scene]:
        return [
            scene.model_copy(update={"parameters": {**scene.parameters, self.parameter: value}})
            for value in self.values
        ]

    def tasks(self, scene: Scene) -> Iterable[Task]:
        return [
            task
            for changed_scene in self._scenes(scene)
            for task in grid_tasks(changed_scene, self.scheme)
        ]

    def compare(self, findings: Findings) -> ClaimResult:
        verdicts: list[Verdict] = []
        details: list[list[str]] = []
        parts = []
        for value, scene in zip(self.values, self._scenes(findings.scene(self.scene)), strict=True):
            setting = prose(f"{self.parameter} = ", Number(text(Fraction(value))))
            try:
                entries = self.entries(self.run_rows(findings, scene))
            except NoValueError as error:
                verdicts.append(Verdict.UNDECIDED)
                parts.append(prose(setting, ": ", error.reason))
                continue
            verdicts.append(all_hold([entry for row in entries.verdicts for entry in row]))
            parts.append(prose(setting, ": ", self.describe_range(entries.values)))
            head, *rows = entries.details
            printed = [rows.pop(0)] if self.printed else []
            details += [] if details else [head, *printed]
            details += [[prose(row[0], ", ", setting), *row[1:]] for row in rows]
        evidence = join_prose("; ", parts)
        # One value for which the table is right, or may be, keeps the claim from being refuted.
        for best in (Verdict.MEASURED, Verdict.UNDECIDED):
            if best in verdicts:
                return self.result(best, evidence, details)
        return self.result(Verdict.REFUTED, evidence, details)

    def runs(self, findings: Findings) -> list[RunResult]:
        scenes = self._scenes(findings.scene(self.scene))
        return [run for scene in scenes for run in findings.runs(scene, self.scheme)]


CLAIM = TableForSomeClaim
