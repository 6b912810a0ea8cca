"""The paper's figures, made again from our runs, with the claims that the paper draws from them."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.page_contents import Anchors, ClaimView, PageContents, SceneView
from verify.pages.sections.section import ContentsEntry, ReportSection, SectionPlace, walk
from verify.pages.sections.table_rows import by_key
from verify.scenes.paper_sections import PaperFigure

_FIGURE_PREFIX = re.compile(r"^fig(ure|\.)?\s+", re.IGNORECASE)


@dataclass(frozen=True)
class PaperFigureView:
    """A figure of the paper; `finding`: the measurements of a flow; `claims`: in its order."""

    figure: PaperFigure
    anchor: str
    plots: tuple[Plot, ...]
    finding: str
    claims: tuple[ClaimView, ...]
    scene: SceneView | None

    @property
    def is_full_width(self) -> bool:
        """True if the figure takes the whole width of the page."""
        return any(plot.span == "full" for plot in self.plots)

    @property
    def claims_by_statement(self) -> list[tuple[str, list[ClaimView]]]:
        """The statements that the paper draws from the figure, each with its readings."""
        return list(by_key(self.claims, lambda c: c.result.statement or c.result.id).items())


def _views(contents: PageContents) -> tuple[PaperFigureView, ...]:
    """Return the figures in their order, without what is not in the report."""
    # If several have one name, the first counts; hence the reversed order.
    by_name = {scene.result.name: scene for scene in reversed(contents.scenes)}
    by_id = {claim.result.id: claim for claim in reversed(contents.claims)}
    drawn_ids: set[int] = set()
    figures = contents.report.figures
    return tuple(_view(f, by_name, by_id, contents.anchors, drawn_ids) for f in figures)


def _view(
    figure: PaperFigure,
    scenes: Mapping[str, SceneView],
    claims: Mapping[str, ClaimView],
    anchors: Anchors,
    drawn_ids: set[int],
) -> PaperFigureView:
    """Return the view of a figure without the plots in `drawn_ids`, which earlier figures show."""
    scene = scenes.get(figure.scene)
    candidates = list(_candidate_plots(figure, scene)) if scene else []
    new_plots = [plot for plot, _ in candidates if plot is not None and id(plot) not in drawn_ids]
    drawn_ids.update(map(id, new_plots))
    return PaperFigureView(
        figure=figure,
        anchor=anchors.take("figure", _FIGURE_PREFIX.sub("", figure.label)),
        plots=tuple(new_plots),
        finding=" ".join(finding for _, finding in candidates if finding),
        claims=tuple(claims[name] for name in figure.claims if name in claims),
        scene=scene,
    )


def _candidate_plots(figure: PaperFigure, scene: SceneView) -> Iterator[tuple[Plot | None, str]]:
    """Yield the plots that show the figure, each with its finding."""
    for section in walk(scene.sections):
        if section.section.shows == figure.shows:
            yield from section.section.matching_plots(section.view, figure.label)


def _keeps(views: Sequence[PaperFigureView]) -> Iterator[tuple[Plot, SectionPlace]]:
    for view in views:
        yield from ((plot, SectionPlace(view.anchor, view.figure.label)) for plot in view.plots)


SECTION = ReportSection(
    order=20,
    title="The paper’s figures, made again",
    anchor="figures",
    view=_views,
    entries=lambda views: (
        ContentsEntry(v.anchor, _FIGURE_PREFIX.sub("", v.figure.label)) for v in views
    ),
    is_numbered=True,
    keeps=_keeps,
)
