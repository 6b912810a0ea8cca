"""At one step size Λ goes up and down over the initial values without any pattern.

Refuted by one pattern, its growth law (see `verify.proof.growth_law`): a boundary term, and one
that grows with T at a rate that is an average over the orbit. Where it predicts every Λ up to
`within` of |Λ|, the values follow it. Where it does not, that shows nothing of other patterns, and
the claim is UNDECIDED.
"""

from collections.abc import Iterable
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import shown
from verify.arithmetic.exact import decimal, text
from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import QUANTITIES, start_of
from verify.execution.task import Task
from verify.prose import Formula, Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.growth import AverageResult, PredictionResult
from verify.scenes.scene import Scene
from verify.scenes.values import Number as ExactNumber
from verify.studies.growth.prediction import predictions
from verify.studies.growth.task import GrowthTask
from verify.verdict import Verdict

_DIGITS = 30  # of the time averages, as a scene’s own growth laws have them


class NoPatternClaim(RunClaim):
    """No law in Λ over the initial values."""

    only_here = "a pattern is over the initial values of its own scene"
    autonomous = planar = True
    kind: Literal["no_pattern"]
    within: Annotated[ExactNumber, Field(gt=0, lt=1)]
    """A law that predicts every Λ to this part of it is a pattern."""

    def quantities(self) -> tuple[str, ...]:
        return ("lambda",)

    def _laws(self, scene: Scene) -> list[GrowthTask]:
        given, starts = scene.hamiltonian_fields(), scene.grid.in_the_plane if scene.grid else ()
        return [
            GrowthTask(**given, scheme=self.scheme, q=at.q, p=at.p, digits=_DIGITS) for at in starts
        ]

    def tasks(self, scene: Scene) -> Iterable[Task]:
        yield from super().tasks(scene)
        yield from self._laws(scene)

    def compare(self, findings: Findings) -> ClaimResult:
        scene = findings.scene(self.scene)
        exact = scene.exact_hamiltonian()
        found: list[PredictionResult] = []
        details = [["initial value", "h", "Λ by its law", "Λ", "(law − Λ)/|Λ|"]]
        for row, task in zip(self.run_rows(findings), self._laws(scene), strict=True):
            law = findings.results[task.key]
            assert isinstance(law, AverageResult)  # noqa: S101 - the key is a law's
            for run, each in zip(row, predictions(exact, law, row), strict=True):
                lam = shown(QUANTITIES["lambda"](run), 4)
                gap = each.difference.value if each.difference else "unknown"
                details.append([start_of(run), run.step_size, each.predicted.value, lam, gap])
                found.append(each)
        gaps = [abs(Fraction(x.difference.value)) for x in found if x.difference is not None]
        near = sum(gap <= self.within for gap in gaps)
        if not gaps or near < sum(len(row) for row in self.run_rows(findings)):
            evidence = prose(
                f"its growth law predicts {near} of {len(details) - 1} values of Λ up to ",
                Number(text(self.within)), " of them; another pattern was not looked for",
            )  # fmt: skip
            return self.result(Verdict.UNDECIDED, evidence, details)
        evidence = prose(
            "each Λ is a boundary term and ", Formula("h^(η+1)"), " T times an average over the "
            f"orbit: this law predicts all {len(gaps)} values up to ",
            number(decimal(max(gaps), 2)), " of them, whatever the initial value",
        )  # fmt: skip
        return self.result(Verdict.REFUTED, evidence, details)


CLAIM = NoPatternClaim
