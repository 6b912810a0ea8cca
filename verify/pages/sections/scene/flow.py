"""Regions carried by maps: sentences, a table, and a figure of each."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, captioned_plot, name_arithmetic
from verify.pages.sections.flow_finding import finding, findings, mean_of, region_of
from verify.pages.sections.flow_vocabulary import vocabulary_of
from verify.pages.sections.section import Picture, ReportSection, SectionPlace
from verify.pages.sections.table_rows import TableRow
from verify.pages.text.typography import IS, join_and, map_name, number, step, whole
from verify.scenes.results.regions import FlowImage, FlowResult
from verify.scenes.results.report import SceneResult

if TYPE_CHECKING:
    from verify.pages.figures.flow_grid import PanelGrid


@dataclass(frozen=True)
class RegionView:
    """One region and its images.

    `plots`: that of the region's own plane, and in n degrees of freedom those of the projections on
    the other planes after it; empty if nothing can be drawn. `plot`: the first of them, or None.
    """

    result: FlowResult
    anchor: str
    title: str
    finding: str
    rows: tuple[TableRow, ...]
    plots: tuple[Plot, ...]
    heads: tuple[str, ...]
    about: str

    @property
    def plot(self) -> Plot | None:
        return self.plots[0] if self.plots else None


@dataclass(frozen=True)
class FlowView:
    """All regions of a scene."""

    finding: tuple[str, ...]
    regions: tuple[RegionView, ...]

    def regions_from(self, source: str) -> tuple[RegionView, ...]:
        return tuple(region for region in self.regions if region.result.source == source)


def _view(scene: SceneResult, anchor: str) -> FlowView | None:
    flows = scene.flows
    if not flows:
        return None
    regions = [_region(flow, f"flow-{i}-of-{anchor}") for i, flow in enumerate(flows)]
    return FlowView(tuple(findings(flows)), tuple(regions))


def _region(flow: FlowResult, anchor: str) -> RegionView:
    vocabulary = vocabulary_of([flow])
    return RegionView(
        result=flow,
        anchor=anchor,
        title=_title(flow),
        finding=" ".join(finding(flow)),
        rows=tuple(map(_row, flow.images)),
        plots=tuple(_plots(flow, anchor)),
        heads=vocabulary.heads,
        about=vocabulary.about,
    )


def _title(flow: FlowResult) -> str:
    description = f"{_describe_region(flow)}, h{IS}{step(flow.step_size)}"
    return (
        f"{flow.source}: {description}"
        if flow.source
        else f"{description[:1].upper()}{description[1:]}"
    )


def _describe_region(flow: FlowResult) -> str:
    q, p = map(number, flow.centre)
    start_note = "" if flow.t0 is None else f", from t₀{IS}{number(flow.t0)}"
    region_text = f"{flow.shape} at (q, p) = ({q}, {p}), scale {number(flow.scale)}{start_note}"
    if flow.plane is None:
        return region_text
    plane_names = f"q{flow.plane}", f"p{flow.plane}"
    other_coordinates = (
        f"{name}{IS}{number(x)}" for name, x in flow.point.items() if name not in plane_names
    )
    in_its_plane = region_text.replace("(q, p)", "({}, {})".format(*plane_names))
    return f"{in_its_plane}, {', '.join(other_coordinates)}"


# -- numbers --------------------------------------------------------------------------------------


def _format_cell(value: str | None, error: str | None, *, missing: str = "–") -> str | Markup:
    """Return a number with its error, if it has one."""
    if value is None or error is None:
        return missing if value is None else number(value)
    return Markup('{} <span class="bound">± {}</span>').format(number(value), number(error))


def _row(image: FlowImage) -> TableRow:
    no_mean = "0" if image.area_preserving else "–"
    cells = (
        whole(image.steps),
        number(image.time),
        _format_cell(image.area_change, image.probe_error, missing="not known"),
        _format_cell(*mean_of(image), missing=no_mean),
        _projection_areas(image) or _format_cell(image.distance, image.distance_error),
        name_arithmetic(image),
    )
    disagreement = "the two measures disagree" if image.agree is False else ""
    return TableRow(image.map, cells, image.problem or disagreement)


def _projection_areas(image: FlowImage) -> str | Markup:
    """Return the area that the image of the outline encloses in each plane, with its error."""
    projections = image.outlines[0].projections if image.outlines else ()
    return Markup(" ").join(_format_cell(x.area, x.area_error) for x in projections)


# -- the figure -----------------------------------------------------------------------------------


def _plots(flow: FlowResult, anchor: str) -> Iterator[Plot]:
    """Yield the plots, if there is an image; only then is matplotlib imported."""
    if not flow.before or not any(image.outlines for image in flow.images):
        return
    planes = range(1, len(flow.point) // 2 + 1)
    yield _plot(flow, f"panels-of-{anchor}", None)
    for k in (k for k in planes if k != flow.plane):
        yield _plot(flow, f"panels-{k}-of-{anchor}", k)


def _plot(flow: FlowResult, name: str, plane: int | None) -> Plot:
    from verify.pages.figures.flow_figure import draw_flow, line_width
    from verify.pages.figures.flow_grid import grid_of, picture_sentences

    grid, region = grid_of(flow, plane), _describe_region(flow)
    maps = join_and(map(map_name, dict.fromkeys(image.map for image in flow.images)))
    lead = f"{region[:1].upper()}{region[1:]}, carried by {maps} with h{IS}{step(flow.step_size)}"
    if flow.plane is not None:
        lead += f", as it is seen in ({', '.join(grid.axes)})"
    sentences = " ".join(picture_sentences(flow, grid, line_width(grid)))
    return captioned_plot(
        lambda: draw_flow(grid),
        name=name,
        lead=lead,
        label=f"{lead}. {sentences}".strip(),
        caption=f"{_caption(flow, grid)} {sentences}".strip(),
    )


def _caption(flow: FlowResult, grid: "PanelGrid") -> str:
    counts, drawn_count = len({image.steps for image in flow.images}), len(grid.counts)
    exact_note = "; broad and grey: the exact flow" * any(
        panel.exact_curves for panel in grid.panels
    )
    notes = (
        f" {whole(drawn_count)} of {whole(counts)} are drawn." if 0 < drawn_count < counts else ""
    )
    missing_steps = sorted(
        {i.steps for i in flow.images} - {i.steps for i in flow.images if i.outlines}
    )
    if missing_steps:
        notes += f" At N{IS}{join_and(map(whole, missing_steps))} there is no image."
    q, p = grid.axes
    opening = "Grey: before; in" if len(grid.before[0]) > 1 else "In"
    measure = "whose area is measured" if flow.plane is None else "around which ∮ p·dq is measured"
    return (
        f"{opening} colour: after N steps by each map{exact_note}.{notes} Tinted is "
        f"{region_of(flow)}, {measure}. One scale for {q} and {p} in all panels."
    )


def _terms(views: Sequence[FlowView]) -> dict[str, Markup]:
    vocabularies = (vocabulary_of([region.result for region in view.regions]) for view in views)
    return {term: meaning for words in vocabularies for term, meaning in words.terms.items()}


def _pictures(view: FlowView) -> Iterator[Picture]:
    for region in view.regions:
        if region.plot is not None:
            yield Picture((2,), region.plot, SectionPlace(region.anchor, region.title))


SECTION = ReportSection(
    order=20,
    title="Regions carried by maps",
    anchor="flow",
    view=_view,
    pictures=_pictures,
    terms=_terms,
    shows="flow",
    matching_plots=lambda view, label: (
        (region.plot, region.finding) for region in view.regions_from(label)
    ),
)
