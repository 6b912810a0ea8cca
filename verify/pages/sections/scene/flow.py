"""Regions carried by maps, as the page shows them: sentences, a table, a figure of each."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, arithmetic_of, plotted
from verify.pages.sections.flow_finding import finding, findings, mean_of, region_of
from verify.pages.sections.flow_words import words
from verify.pages.sections.rows import Row
from verify.pages.sections.section import Picture, Place, Section
from verify.pages.text.typography import IS, listed, map_name, number, step, whole
from verify.scenes.results.regions import FlowImage, FlowResult
from verify.scenes.results.report import SceneResult

if TYPE_CHECKING:
    from verify.pages.figures.flow_grid import Grid


@dataclass(frozen=True)
class RegionView:
    """One region: what it is, its images; no `plot` where nothing can be drawn. `plots`: that, and
    in n degrees of freedom the projections to the other planes after it.
    """

    result: FlowResult
    anchor: str
    title: str
    finding: str
    rows: tuple[Row, ...]
    plots: tuple[Plot, ...]
    heads: tuple[str, ...]
    about: str

    @property
    def plot(self) -> Plot | None:
        return self.plots[0] if self.plots else None


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
    said = words([flow])
    return RegionView(
        result=flow,
        anchor=anchor,
        title=_title(flow),
        finding=" ".join(finding(flow)),
        rows=tuple(map(_row, flow.images)),
        plots=tuple(_plots(flow, anchor)),
        heads=said.heads,
        about=said.about,
    )


def _title(flow: FlowResult) -> str:
    what = f"{_the(flow)}, h{IS}{step(flow.step_size)}"
    return f"{flow.source}: {what}" if flow.source else f"{what[:1].upper()}{what[1:]}"


def _the(flow: FlowResult) -> str:
    q, p = map(number, flow.centre)
    begins = "" if flow.t0 is None else f", from t₀{IS}{number(flow.t0)}"
    where = f"{flow.shape} at (q, p) = ({q}, {p}), scale {number(flow.scale)}{begins}"
    if flow.plane is None:
        return where
    own = f"q{flow.plane}", f"p{flow.plane}"
    beside = (f"{name}{IS}{number(x)}" for name, x in flow.point.items() if name not in own)
    return f"{where.replace('(q, p)', '({}, {})'.format(*own))}, {', '.join(beside)}"


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
        _cell(*mean_of(image), missing=no_mean),
        _planes(image) or _cell(image.distance, image.distance_error),
        arithmetic_of(image),
    )
    disagreement = "the two measures disagree" if image.agree is False else ""
    return Row(image.map, cells, image.problem or disagreement)


def _planes(image: FlowImage) -> str | Markup:
    """What the region's outline encloses in each plane, with its error."""
    seen = image.outlines[0].projections if image.outlines else ()
    return Markup(" ").join(_cell(x.area, x.area_error) for x in seen)


# -- the figure -----------------------------------------------------------------------------------


def _plots(flow: FlowResult, anchor: str) -> Iterator[Plot]:
    """The drawings; with them matplotlib is imported only where there is an image."""
    if not flow.before or not any(image.outlines for image in flow.images):
        return
    planes = range(1, len(flow.point) // 2 + 1)
    yield _plot(flow, f"panels-of-{anchor}", None)
    for k in (k for k in planes if k != flow.plane):
        yield _plot(flow, f"panels-{k}-of-{anchor}", k)


def _plot(flow: FlowResult, name: str, plane: int | None) -> Plot:
    from verify.pages.figures.flow_figure import draw_flow
    from verify.pages.figures.flow_grid import grid_of
    from verify.pages.sections.flow_pictures import picture_sentences

    grid, what = grid_of(flow, plane), _the(flow)
    maps = listed(map(map_name, dict.fromkeys(image.map for image in flow.images)))
    lead = f"{what[:1].upper()}{what[1:]}, carried by {maps} with h{IS}{step(flow.step_size)}"
    if flow.plane is not None:
        lead += f", as it is seen in ({', '.join(grid.axes)})"
    found = " ".join(picture_sentences(flow, grid))
    return plotted(
        lambda: draw_flow(grid),
        name=name,
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
    q, p = grid.axes
    before = "Grey: before; in" if len(grid.before[0]) > 1 else "In"
    measured = "whose area is measured" if flow.plane is None else "around which ∮ p·dq is measured"
    return (
        f"{before} colour: after N steps by each map{under}.{some} Tinted is {region_of(flow)}, "
        f"{measured}. One scale for {q} and {p} in all panels."
    )


def _terms(views: Sequence[FlowView]) -> dict[str, Markup]:
    every = (words([each.result for each in view.regions]).terms for view in views)
    return {term: meaning for own in every for term, meaning in own.items()}


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
    terms=_terms,
    shows="flow",
    drawn=lambda view, label: ((each.plot, each.finding) for each in view.of(label)),
)
