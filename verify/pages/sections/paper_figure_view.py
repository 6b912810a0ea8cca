"""The paper's figures, made again: which of our pictures show them, and what the paper draws."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.claim_view import Anchors, ClaimView
from verify.pages.sections.scene_view import SceneView
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


def paper_figure_views(
    figures: Sequence[PaperFigure],
    scenes: Sequence[SceneView],
    claims: Sequence[ClaimView],
    anchors: Anchors,
) -> tuple[PaperFigureView, ...]:
    """In the order in which they are given; what is not in the report is left out of each."""
    by_name: dict[str, SceneView] = {}
    for scene in scenes:
        by_name.setdefault(scene.result.name, scene)
    by_id: dict[str, ClaimView] = {}
    for claim in claims:
        by_id.setdefault(claim.result.id, claim)
    drawn: set[int] = set()
    return tuple(_view(figure, by_name, by_id, anchors, drawn) for figure in figures)


def _view(
    figure: PaperFigure,
    scenes: Mapping[str, SceneView],
    claims: Mapping[str, ClaimView],
    anchors: Anchors,
    drawn: set[int],
) -> PaperFigureView:
    """`drawn` are the plots that earlier figures show; no picture stands twice."""
    scene = scenes.get(figure.scene)
    own = [plot for plot in _plots(figure, scene) if id(plot) not in drawn] if scene else []
    drawn.update(map(id, own))
    carried = scene.flows.of(figure.label) if scene and scene.flows else ()
    return PaperFigureView(
        figure=figure,
        anchor=anchors.take("figure", _NAMED.sub("", figure.label)),
        plots=tuple(own),
        finding=" ".join(c.finding for c in carried) if figure.shows == "flow" else "",
        claims=tuple(claims[name] for name in figure.claims if name in claims),
        scene=scene,
    )


def _plots(figure: PaperFigure, scene: SceneView) -> Iterator[Plot]:
    if figure.shows == "flow":
        regions = scene.flows.of(figure.label) if scene.flows else ()
        yield from (region.plot for region in regions if region.plot is not None)
    for scheme in scene.schemes:
        if figure.shows == "runs":
            yield from scheme.plots
        elif figure.shows == "series":
            series = zip(scheme.series, scheme.sources, strict=True)
            yield from (plot for plot, source in series if source == figure.label)
