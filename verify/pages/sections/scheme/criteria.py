"""The four criteria of area preservation, for one scheme."""

from verify.pages.sections.section import ReportSection
from verify.scenes.results.claim import CriterionResult
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import SceneResult
from verify.studies.criteria_verdicts import NAMES

CriteriaView = tuple[tuple[CriterionResult, str], ...]  # the results, each with a name


def _view(scene: SceneResult, proof: ProofResult, _: str) -> CriteriaView:
    criteria = (c for c in scene.criteria if c.scheme == proof.scheme)
    return tuple((c, NAMES.get(c.number, "")) for c in criteria)


SECTION = ReportSection(order=30, view=_view)
