"""The properties of a scheme that are proved for every Hamiltonian, where requested."""

from verify.pages.sections.section import Section
from verify.scenes.results.proof import EveryResult, ProofResult
from verify.scenes.results.report import SceneResult


def _view(scene: SceneResult, proof: ProofResult, _: str) -> EveryResult | None:
    return next((each for each in scene.every if each.scheme == proof.scheme), None)


SECTION = Section(order=20, view=_view)
