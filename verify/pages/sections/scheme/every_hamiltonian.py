"""The properties of a scheme that are proved for every Hamiltonian, if requested."""

from verify.pages.sections.section import ReportSection
from verify.scenes.results.proof_result import EveryResult, ProofResult
from verify.scenes.results.report import SceneResult


def _view(scene: SceneResult, proof: ProofResult, _: str) -> EveryResult | None:
    return next((result for result in scene.every if result.scheme == proof.scheme), None)


SECTION = ReportSection(order=20, view=_view)
