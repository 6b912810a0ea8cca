"""What was found for a scene, and a whole report: results of all kinds put together."""

from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from verify.errors import InputError
from verify.formats import read_json
from verify.notebook import html_table
from verify.scenes.causes import Cause
from verify.scenes.frozen import Frozen, Seconds
from verify.scenes.paper_figures import PaperFigure
from verify.scenes.results.claim import ClaimResult, CriterionResult
from verify.scenes.results.exploration import Gallery
from verify.scenes.results.growth import GrowthLawResult
from verify.scenes.results.orbit_sections import PoincareResult, StroboscopicResult
from verify.scenes.results.proof import EveryResult, ProofResult
from verify.scenes.results.regions import FlowResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import SeparationGrid, SeparationGridInDegrees
from verify.scenes.results.stability import (
    LargestStepResult,
    OrbitMapResult,
    StabilityMapResult,
    StabilityResult,
)
from verify.scenes.results.statement import StatementResult
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.verdict import Verdict

ReportFormat = Literal["areaproof report 1"]
FORMAT: ReportFormat = "areaproof report 1"


class SceneResult(Frozen):
    """Everything found for one scene; `time` is the length of its runs where it has a grid, and
    `t0` when they start.

    `separations` are those of the grid's runs, one an initial value; `crossovers` those that the
    scene asks for beside it; `form_separations` and `form_crossovers` are the same of W, in n
    degrees of freedom. `growth_laws` hold the grid's runs against the growth law of Λ;
    `growth_explains` is what of a paper the scene says that the law explains. `every` holds what is
    proved of its schemes for every H, `work_precision` error against run time,
    `flows` what maps do to regions, `stroboscopic` orbits once in each period, `poincare` orbits
    where they pass a surface;
    `stability`, `largest_steps` and `stability_maps` how stable they are, `orbit_maps` what orbits
    do over two of their initial values.
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


class Provenance(Frozen):
    """What made a report: the command, versions, machine, time it took, and when it was `made`.

    `commit`: that of the checkout whose code it was, or "".
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

    `statements`: those of the paper whose readings the claims are, where statements are counted;
    `causes`: what explains that several of them do not hold.
    `gallery`: the worst scenes that a hunt found. `preface`: what is said before all else, such as
    which libraries are installed.
    """

    format: ReportFormat = FORMAT
    title: str
    claims: tuple[ClaimResult, ...]
    statements: tuple[StatementResult, ...] = ()
    scenes: tuple[SceneResult, ...]
    causes: tuple[Cause, ...] = ()
    figures: tuple[PaperFigure, ...] = ()
    gallery: Gallery | None = None
    left_out: tuple[tuple[str, str], ...]
    preface: tuple[str, ...] = ()
    provenance: Provenance

    def _repr_html_(self) -> str:
        """How many claims have which verdict, then each claim, the refuted ones first."""
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
    """The report in a `results.json`. InputError, one line, for what is none of this format."""
    data = read_json(path, FORMAT)
    try:
        return Report.model_validate(data)
    except ValidationError as error:
        told = error.errors(include_url=False)[0]
        where = ".".join(map(str, told["loc"]))
        raise InputError("file", str(path), f"is no report: {where}: {told['msg']}") from None
