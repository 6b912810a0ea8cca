"""The schemes on a scene, each with its own sections."""

from collections.abc import Sequence
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
from verify.scenes.frozen import OfScheme
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import SceneResult


@dataclass(frozen=True)
class SchemeView:
    """A scheme with its place on the page; of equations without an H, with any result of it."""

    proof: OfScheme
    anchor: str
    sections: tuple[VisibleSection, ...]

    @property
    def entry(self) -> ContentsEntry:
        """Its entry in the contents."""
        return ContentsEntry(self.anchor, Markup("<code>{}</code>").format(self.proof.scheme_title))


def _view(scene: SceneResult, anchor: str) -> tuple[SchemeView, ...]:
    # Equations have no such proofs, and may have runs alone.
    by_scheme: dict[str, OfScheme] = {
        x.scheme: x for x in (*scene.keeps, *scene.runs, *scene.series)
    }
    by_scheme |= {x.scheme: x for x in scene.keeps}
    proofs: Sequence[OfScheme] = scene.proofs or [*by_scheme.values()]
    schemes = (_scheme(scene, proof, f"scheme-{k}-of-{anchor}") for k, proof in enumerate(proofs))
    return tuple(scheme for scheme in schemes if scene.proofs or scheme.sections)


def _scheme(scene: SceneResult, proof: OfScheme, anchor: str) -> SchemeView:
    place, of_field = SectionPlace(anchor, proof.scheme_title), not isinstance(proof, ProofResult)
    files = of_scheme.FILES
    visible = select_sections(files, place, scene, proof, anchor, of_field=of_field)
    return SchemeView(proof, anchor, visible)


SECTION = ReportSection(
    order=40,
    view=_view,
    entries=lambda view: (scheme.entry for scheme in view),
    inner=lambda view: (section for scheme in view for section in scheme.sections),
)
