"""The schemes on a scene, each with its own sections."""

from dataclasses import dataclass

from markupsafe import Markup

from verify.pages.sections import scheme as of_scheme
from verify.pages.sections.section import (
    ContentsEntry,
    ReportSection,
    SectionPlace,
    VisibleSection,
    select_sections,
)
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import SceneResult


@dataclass(frozen=True)
class SchemeView:
    """A scheme with its place on the page."""

    proof: ProofResult
    anchor: str
    sections: tuple[VisibleSection, ...]

    @property
    def entry(self) -> ContentsEntry:
        """Its entry in the contents."""
        return ContentsEntry(self.anchor, Markup("<code>{}</code>").format(self.proof.scheme))


def _view(scene: SceneResult, anchor: str) -> tuple[SchemeView, ...]:
    return tuple(
        _scheme(scene, proof, f"scheme-{index}-of-{anchor}")
        for index, proof in enumerate(scene.proofs)
    )


def _scheme(scene: SceneResult, proof: ProofResult, anchor: str) -> SchemeView:
    place = SectionPlace(anchor, proof.scheme)
    return SchemeView(proof, anchor, select_sections(of_scheme.FILES, place, scene, proof, anchor))


SECTION = ReportSection(
    order=40,
    view=_view,
    entries=lambda view: (scheme.entry for scheme in view),
    inner=lambda view: (section for scheme in view for section in scheme.sections),
)
