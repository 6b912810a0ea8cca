"""The paper's figures, made again: which of our pictures show them, and what the paper draws."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.by_key import by_key
from verify.pages.sections.claim_view import Anchors, ClaimView
from verify.pages.sections.given import Given, SceneView
from verify.pages.sections.section import Entry, Place, Section, walk
from verify.scenes.paper_figures import PaperFigure

_NAMED = re.compile(r"^fig(ure|\.)?\s+", re.IGNORECASE)


@dataclass(frozen=True)
class PaperFigureView:
    """`finding`: what was measured of what is drawn, where it is a flow; `claims`: in its order."""

    figure: PaperFigure
    anchor: str
    plots: tuple[Plot, ...]
    finding: str
    claims: tuple[ClaimView, ...]
    scene: SceneView | None

    @property
    def is_over(self) -> bool:
        """Whether it takes the whole width of the page."""
        return any(plot.span == "full" for plot in self.plots)

    @property
    def drawn_from(self) -> list[tuple[str, list[ClaimView]]]:
        """What the paper draws from it: each statement once, with its readings."""
        return list(by_key(self.claims, lambda c: c.result.statement or c.result.id).items())


def _views(given: Given) -> tuple[PaperFigureView, ...]:
    """In the order in which they are given; what is not in the report is left out of each."""
    # Of those with one name the first counts.
    by_name = {scene.result.name: scene for scene in reversed(given.scenes)}
    by_id = {claim.result.id: claim for claim in reversed(given.claims)}
    drawn: set[int] = set()
    figures = given.report.figures
    return tuple(_view(f, by_name, by_id, given.anchors, drawn) for f in figures)


def _view(
    figure: PaperFigure,
    scenes: Mapping[str, SceneView],
    claims: Mapping[str, ClaimView],
    anchors: Anchors,
    drawn: set[int],
) -> PaperFigureView:
    """`drawn` are the plots that earlier figures show; no picture stands twice."""
    scene = scenes.get(figure.scene)
    found = list(_drawn(figure, scene)) if scene else []
    own = [plot for plot, _ in found if plot is not None and id(plot) not in drawn]
    drawn.update(map(id, own))
    return PaperFigureView(
        figure=figure,
        anchor=anchors.take("figure", _NAMED.sub("", figure.label)),
        plots=tuple(own),
        finding=" ".join(said for _, said in found if said),
        claims=tuple(claims[name] for name in figure.claims if name in claims),
        scene=scene,
    )


def _drawn(figure: PaperFigure, scene: SceneView) -> Iterator[tuple[Plot | None, str]]:
    """The plots that show it, each with what is said of it."""
    for each in walk(scene.sections):
        if each.section.shows == figure.shows:
            yield from each.section.drawn(each.view, figure.label)


def _keeps(views: Sequence[PaperFigureView]) -> Iterator[tuple[Plot, Place]]:
    for view in views:
        yield from ((plot, Place(view.anchor, view.figure.label)) for plot in view.plots)


SECTION = Section(
    order=20,
    title="The paper’s figures, made again",
    anchor="figures",
    view=_views,
    entries=lambda views: (Entry(v.anchor, _NAMED.sub("", v.figure.label)) for v in views),
    is_numbered=True,
    keeps=_keeps,
)
