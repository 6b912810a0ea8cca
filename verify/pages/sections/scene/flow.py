"""Regions carried by maps, as the page shows them: sentences, a table, a figure of each."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, plotted
from verify.pages.sections.flow_finding import IS, finding, findings, region_of
from verify.pages.sections.rows import Row
from verify.pages.sections.section import Picture, Place, Section
from verify.pages.text.typography import listed, number, step, whole
from verify.scenes.results.regions import EXACT_FLOW, FlowImage, FlowResult
from verify.scenes.results.report import SceneResult

if TYPE_CHECKING:
    from verify.pages.figures.flow_figure import Grid


@dataclass(frozen=True)
class RegionView:
    """One region: what it is, its images; no `plot` where nothing can be drawn."""

    result: FlowResult
    anchor: str
    title: str
    finding: str
    rows: tuple[Row, ...]
    plot: Plot | None


@dataclass(frozen=True)
class FlowView:
    """All that a scene asks for."""

    finding: tuple[str, ...]
    regions: tuple[RegionView, ...]

    def of(self, source: str) -> tuple[RegionView, ...]:
        return tuple(region for region in self.regions if region.result.source == source)


def _view(scene: SceneResult, anchor: str) -> FlowView | None:
    flows = scene.flows
    if not flows:
        return None
    regions = [_region(flow, f"flow-{i}-of-{anchor}") for i, flow in enumerate(flows)]
    return FlowView(tuple(findings(flows)), tuple(regions))


def _region(flow: FlowResult, anchor: str) -> RegionView:
    return RegionView(
        result=flow,
        anchor=anchor,
        title=_title(flow),
        finding=" ".join(finding(flow)),
        rows=tuple(map(_row, flow.images)),
        plot=_plot(flow, anchor),
    )


def _title(flow: FlowResult) -> str:
    what = f"{_the(flow)}, h{IS}{step(flow.step_size)}"
    return f"{flow.source}: {what}" if flow.source else f"{what[:1].upper()}{what[1:]}"


def _the(flow: FlowResult) -> str:
    q, p = map(number, flow.centre)
    begins = "" if flow.t0 is None else f", from t₀{IS}{number(flow.t0)}"
    return f"{flow.shape} at (q, p) = ({q}, {p}), scale {number(flow.scale)}{begins}"


# -- numbers --------------------------------------------------------------------------------------


def _cell(value: str | None, error: str | None, *, missing: str = "–") -> str | Markup:
    """A number with its error, where it has one."""
    if value is None or error is None:
        return missing if value is None else number(value)
    return Markup('{} <span class="bound">± {}</span>').format(number(value), number(error))


def _row(image: FlowImage) -> Row:
    no_mean = "0" if image.area_preserving else "–"
    cells = (
        whole(image.steps),
        number(image.time),
        _cell(image.area_change, image.probe_error, missing="not known"),
        _cell(image.mean_lambda, image.mean_lambda_error, missing=no_mean),
        _cell(image.distance, image.distance_error),
        _arithmetic(image),
    )
    disagreement = "the two measures disagree" if image.agree is False else ""
    return Row(image.map, cells, image.problem or disagreement)


def _arithmetic(image: FlowImage) -> str:
    if not image.arithmetic or image.arithmetic == "float64":
        return image.arithmetic
    return f"{image.arithmetic} ({image.digits} digits)"


# -- the figure -----------------------------------------------------------------------------------


def _plot(flow: FlowResult, anchor: str) -> Plot | None:
    """The drawing, and with it matplotlib, is imported only where there is an image."""
    if not flow.before or not any(image.outlines for image in flow.images):
        return None
    from verify.pages.figures.flow_figure import draw_flow, grid_of
    from verify.pages.sections.flow_pictures import picture_sentences

    grid, what = grid_of(flow), _the(flow)
    maps = listed(
        f"the {name}" if name == EXACT_FLOW else name
        for name in dict.fromkeys(image.map for image in flow.images)
    )
    lead = f"{what[:1].upper()}{what[1:]}, carried by {maps} with h{IS}{step(flow.step_size)}"
    found = " ".join(picture_sentences(flow, grid))
    return plotted(
        lambda: draw_flow(grid),
        name=f"panels-of-{anchor}",
        lead=lead,
        label=f"{lead}. {found}".strip(),
        caption=f"{_caption(flow, grid)} {found}".strip(),
    )


def _caption(flow: FlowResult, grid: "Grid") -> str:
    counts, shown = len({image.steps for image in flow.images}), len(grid.counts)
    under = "; broad and grey: the exact flow" * any(panel.exact for panel in grid.panels)
    some = f" {whole(shown)} of {whole(counts)} are drawn." if 0 < shown < counts else ""
    none = sorted({i.steps for i in flow.images} - {i.steps for i in flow.images if i.outlines})
    if none:
        some += f" At N{IS}{listed(map(whole, none))} there is no image."
    return (
        f"Grey: before; in colour: after N steps by each map{under}.{some} Tinted is "
        f"{region_of(flow)}, whose area is measured. One scale for q and p in all panels."
    )


_TERMS = {
    "Change of area": Markup(
        "The area inside the image of a closed outline, less that inside the outline, divided by "
        "the latter: ∮ p dq along both, refined until the quadrature’s own error is far below the "
        "change. It equals the mean of Λ over the region, which is computed beside it without any "
        "area."
    ),
    "Distance of outlines": Markup(
        "Hausdorff’s: the farthest that a point of either outline is from the other one."
    ),
}


def _pictures(view: FlowView) -> Iterator[Picture]:
    for each in view.regions:
        if each.plot is not None:
            yield Picture((2,), each.plot, Place(each.anchor, each.title))


SECTION = Section(
    order=20,
    title="Regions carried by maps",
    anchor="flow",
    view=_view,
    pictures=_pictures,
    terms=lambda _: _TERMS,
    shows="flow",
    drawn=lambda view, label: ((each.plot, each.finding) for each in view.of(label)),
)
