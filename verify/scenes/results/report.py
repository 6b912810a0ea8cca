"""The results of a scene, and a whole report of results of all kinds."""

from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from verify.errors import InputError
from verify.formats import read_json
from verify.notebook import html_table
from verify.scenes.frozen import Frozen, Seconds
from verify.scenes.paper_sections import Assumption, Cause, PaperFigure
from verify.scenes.results.claim import ClaimResult, CriterionResult, StatementResult
from verify.scenes.results.exploration import Gallery
from verify.scenes.results.growth import GrowthLawResult
from verify.scenes.results.kept import KeptResult
from verify.scenes.results.orbit_points import PoincareResult, StroboscopicResult
from verify.scenes.results.proof_result import EveryResult, ProofResult
from verify.scenes.results.regions import FlowResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import SeparationGrid, SeparationGridInDegrees
from verify.scenes.results.stability import (
    LargestStepResult,
    OrbitMapResult,
    StabilityMapResult,
    StabilityResult,
)
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.verdict import Verdict

ReportFormat = Literal["areaproof report 1"]
FORMAT: ReportFormat = "areaproof report 1"


class SceneResult(Frozen):
    """All results of one scene.

    `time` is the length of its runs where it has a grid, and `t0` the time at which they start.
    `separations` are those of the grid's runs, one for each initial value; `crossovers` those of
    the sections [[separation]]; `form_separations` and `form_crossovers` are the same for W, in n
    degrees of freedom. `growth_laws` compare the grid's runs with the growth law of Λ;
    `growth_explains` is the part of a paper that the law explains, as the scene says. `every` holds
    the proofs on its schemes for every H, `work_precision` error against run time, `flows` regions
    carried by maps, `stroboscopic` orbits once in each period, `poincare` orbits where they pass a
    surface; `stability`, `largest_steps` and `stability_maps` the stability of the schemes,
    `orbit_maps` the kinds of orbits over two of their initial values. `keeps`: what each scheme
    keeps, where the scene asks; of equations, which stand in place of `hamiltonian`, all there is.
    """

    name: str
    title: str
    hamiltonian: str
    parameters: dict[str, str]
    source: str
    time: str | None
    t0: str = "0"
    proofs: tuple[ProofResult, ...]
    criteria: tuple[CriterionResult, ...]
    runs: tuple[RunResult, ...]
    series: tuple[RunResult, ...]
    separations: tuple[SeparationGrid, ...] = ()
    crossovers: tuple[SeparationGrid, ...] = ()
    form_separations: tuple[SeparationGridInDegrees, ...] = ()
    form_crossovers: tuple[SeparationGridInDegrees, ...] = ()
    growth_laws: tuple[GrowthLawResult, ...] = ()
    growth_explains: str = ""
    every: tuple[EveryResult, ...] = ()
    work_precision: WorkPrecisionResult | None = None
    flows: tuple[FlowResult, ...] = ()
    stroboscopic: tuple[StroboscopicResult, ...] = ()
    poincare: tuple[PoincareResult, ...] = ()
    stability: tuple[StabilityResult, ...] = ()
    largest_steps: tuple[LargestStepResult, ...] = ()
    stability_maps: tuple[StabilityMapResult, ...] = ()
    orbit_maps: tuple[OrbitMapResult, ...] = ()
    keeps: tuple[KeptResult, ...] = ()


class Provenance(Frozen):
    """The origin of a report: command, versions, machine, duration, and when it was `made`.

    `commit`: that of the checkout whose code was run, or "".
    """

    command: str
    versions: dict[str, str]
    machine: str
    seconds: Seconds
    kept: int  # results taken from an earlier, interrupted or finished, call
    computed: int
    made: str = ""
    commit: str = ""


class Report(Frozen):
    """A whole report; its JSON is `results.json`. `figures`: those of the paper, made again.

    `statements`: the statements of the paper whose readings the claims are, where statements are
    counted; `causes`: explanations why several of them do not hold; `assumptions`: what the
    paper leaves open, with the verdicts that depend on it. `gallery`: the worst scenes of
    a hunt. `left_out`: what was not computed and, first, what of the paper has no claim, which
    `not_claimed` repeats. `preface`: sentences before everything else, such as on the libraries
    installed.
    """

    format: ReportFormat = FORMAT
    title: str
    claims: tuple[ClaimResult, ...]
    statements: tuple[StatementResult, ...] = ()
    scenes: tuple[SceneResult, ...]
    causes: tuple[Cause, ...] = ()
    assumptions: tuple[Assumption, ...] = ()
    figures: tuple[PaperFigure, ...] = ()
    gallery: Gallery | None = None
    left_out: tuple[tuple[str, str], ...]
    not_claimed: tuple[tuple[str, str], ...] = ()
    preface: tuple[str, ...] = ()
    provenance: Provenance

    def _repr_html_(self) -> str:
        """Return a table of the claims, the refuted ones first, with the counts of verdicts."""
        if not self.claims:
            rows = [
                (scene.title, proof.scheme, str(proof.verdict), str(proof.reason))
                for scene in self.scenes
                for proof in scene.proofs
            ]
            return html_table(self.title, ("scene", "scheme", "verdict", "reason"), rows)
        claims = sorted(self.claims, key=lambda claim: claim.verdict is not Verdict.REFUTED)
        counts = ((v, sum(c.verdict is v for c in claims)) for v in Verdict)
        rows = [(str(c.verdict), c.source, c.id, c.evidence) for c in claims]
        foot = ", ".join(f"{n} {v.lower()}" for v, n in counts if n)
        return html_table(self.title, ("verdict", "source", "claim", "evidence"), rows, foot)


def read_report(path: Path) -> Report:
    """Read the report in a `results.json`; InputError, in one line, for any other content."""
    data = read_json(path, FORMAT)
    try:
        return Report.model_validate(data)
    except ValidationError as error:
        first_error = error.errors(include_url=False)[0]
        key = ".".join(map(str, first_error["loc"]))
        raise InputError("file", str(path), f"is no report: {key}: {first_error['msg']}") from None
