"""Report → what the page's templates show: anchors, groups, sentences. Nothing is computed anew."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections import scene_plots
from verify.pages.sections.claim_view import Anchors, ClaimView
from verify.pages.sections.first_screen import FirstScreen, first_screen
from verify.pages.sections.paper_figure_view import PaperFigureView, paper_figure_views
from verify.pages.sections.scene_view import SceneView, scene_view
from verify.pages.text import words
from verify.scenes.results.report import Report
from verify.scenes.results.stability import Kind
from verify.verdict import Verdict

if TYPE_CHECKING:
    from verify.pages.sections.gallery_view import GalleryView

_NUMBERED = re.compile(r"\d+(?:\.\d+)*(?=\D|$)")


@dataclass(frozen=True)
class ClaimGroup:
    """The claims of one section of the paper; `title` is empty where no claim names a section."""

    title: str
    anchor: str
    claims: tuple[ClaimView, ...]
    counts: tuple[tuple[Verdict, int], ...]


@dataclass(frozen=True)
class PageView:
    """`paper_figures`: the paper's figures, made again; what they show stands nowhere else."""

    report: Report
    first: FirstScreen
    groups: tuple[ClaimGroup, ...]
    claims: tuple[ClaimView, ...]
    scenes: tuple[SceneView, ...]
    gallery: "GalleryView | None"
    paper_figures: tuple[PaperFigureView, ...]
    kinds: tuple[tuple[Kind, str], ...]  # verdicts on runs that occur, and what they mean
    terms: tuple[tuple[str, Markup], ...]  # those that its results need

    def groups_on(self, scene_anchor: str) -> list[ClaimGroup]:
        """Those with a claim on this scene."""
        return [g for g in self.groups if any(c.scene_anchor == scene_anchor for c in g.claims)]

    def figure_of(self, plot: Plot) -> PaperFigureView | None:
        """The paper's figure that shows it."""
        return next((f for f in self.paper_figures if any(p is plot for p in f.plots)), None)


def page_view(report: Report) -> PageView:
    anchors = Anchors()
    own = [anchors.take("system", scene.name) for scene in report.scenes]
    claims = _claims(report, own, anchors)
    scenes = tuple(
        scene_view(scene, anchor) for scene, anchor in zip(report.scenes, own, strict=True)
    )
    gallery = _gallery(report)
    return PageView(
        report=report,
        first=first_screen(report, claims, scenes, gallery),
        groups=tuple(groups(claims, anchors)),
        claims=claims,
        scenes=scenes,
        gallery=gallery,
        paper_figures=paper_figure_views(report.figures, scenes, claims, anchors),
        kinds=_kinds(scenes),
        terms=tuple(words.terms(report.scenes, gallery=bool(gallery and gallery.cards))),
    )


def _claims(report: Report, own: Sequence[str], anchors: Anchors) -> tuple[ClaimView, ...]:
    scenes = {s.name: (anchor, s.title) for s, anchor in zip(report.scenes, own, strict=True)}
    found = []
    for result in report.claims:
        anchor = anchors.take("claim", result.id)
        claim = ClaimView(result, anchor, *scenes.get(result.scene, ("", "")))
        if claim.is_table:
            claim = replace(claim, plot=scene_plots.table(claim, name=f"table-of-{anchor}"))
        found.append(claim)
    return tuple(found)


def _gallery(report: Report) -> "GalleryView | None":
    """The worst scenes, imported only where they were hunted for."""
    if report.gallery is None:
        return None
    from verify.pages.sections.gallery_view import gallery_view

    return gallery_view(report.gallery)


def _kinds(scenes: Sequence[SceneView]) -> tuple[tuple[Kind, str], ...]:
    if not any(scene.stability for scene in scenes):
        return ()
    from verify.pages.sections.stability_view import MEANINGS

    seen = {kind for scene in scenes if scene.stability for kind in scene.stability.kinds}
    return tuple((kind, meaning) for kind, meaning in MEANINGS.items() if kind in seen)


# -- the sections of the paper --------------------------------------------------------------------


def groups(claims: Sequence[ClaimView], anchors: Anchors) -> list[ClaimGroup]:
    """The claims by section, sections in the order of their numbers, those without one last."""
    by_section: dict[str, list[ClaimView]] = {}
    for claim in claims:
        by_section.setdefault(claim.result.section, []).append(claim)
    found = []
    for section in sorted(by_section, key=_place):
        own = by_section[section]
        title = section or ("Other claims" if len(by_section) > 1 else "")
        counted = Counter(c.result.verdict for c in own)
        counts = tuple((v, counted[v]) for v in Verdict if counted[v])
        found.append(ClaimGroup(title, anchors.take("section", title or "all"), tuple(own), counts))
    return found


def _place(section: str) -> tuple[int, list[int]]:
    """Sorts 4.2 before 4.10, then sections without a number, then what names none."""
    if match := _NUMBERED.match(section):
        return 0, [int(n) for n in match[0].split(".")]
    return (1 if section else 2), []
