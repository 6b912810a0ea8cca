"""Regions carried by maps, as the page shows them: sentences, a table, a figure of each."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from reports.plots import Plot
from reports.typography import NBSP, listed, number, step, whole
from verify.flow_results import EXACT_FLOW, FlowImage, FlowResult

_IS = f"{NBSP}={NBSP}"
_SEEN = Fraction(1, 1000)  # of an area: an eye does not see less in a picture


@dataclass(frozen=True)
class Cell:
    """A number with its error; `value` alone where it has none, or where it is a word."""

    value: str
    error: str = ""


@dataclass(frozen=True)
class ImageRow:
    map: str
    steps: str
    time: str
    change: Cell
    mean: Cell
    distance: Cell
    arithmetic: str
    problem: str


@dataclass(frozen=True)
class CarriedView:
    """One region: what it is, its images; no `plot` where nothing can be drawn."""

    result: FlowResult
    anchor: str
    title: str
    finding: str
    rows: tuple[ImageRow, ...]
    plot: Plot | None


@dataclass(frozen=True)
class FlowView:
    """All that a scene asks for."""

    finding: tuple[str, ...]
    regions: tuple[CarriedView, ...]

    def of(self, source: str) -> tuple[CarriedView, ...]:
        return tuple(region for region in self.regions if region.result.source == source)


def flow_view(flows: Sequence[FlowResult], anchor: str) -> FlowView:
    regions = [_carried(flow, f"flow-{i}-of-{anchor}") for i, flow in enumerate(flows)]
    return FlowView(tuple(_findings(flows)), tuple(regions))


def _carried(flow: FlowResult, anchor: str) -> CarriedView:
    return CarriedView(
        result=flow,
        anchor=anchor,
        title=_title(flow),
        finding=" ".join(_finding(flow)),
        rows=tuple(map(_row, flow.images)),
        plot=_plot(flow, anchor),
    )


def _title(flow: FlowResult) -> str:
    what = f"{_the(flow)}, h{_IS}{step(flow.step_size)}"
    return f"{flow.source}: {what}" if flow.source else f"{what[:1].upper()}{what[1:]}"


def _the(flow: FlowResult) -> str:
    q, p = map(number, flow.centre)
    return f"{flow.shape} at (q, p) = ({q}, {p}), scale {number(flow.scale)}"


# -- sentences on all of a scene ------------------------------------------------------------------

Found = tuple[FlowResult, FlowImage]


def _findings(flows: Sequence[FlowResult]) -> Iterator[str]:
    images = [(flow, image) for flow in flows for image in flow.images]
    changing = [each for each in images if each[1].area_preserving is not True]
    known = [each for each in changing if each[1].area_change is not None]
    if known:
        yield _largest(known)
        yield _probe(known)
        yield from _means(known)
    yield from _preserved([each for each in images if each[1].area_preserving])
    yield from _distances([each for each in images if each[1].distance is not None])
    problems = [each for each in images if each[1].problem]
    if problems:
        count = "image has" if len(problems) == 1 else "images have"
        yield f"{whole(len(problems))} {count} no known change of area; the table says why."


def _largest(known: Sequence[Found]) -> str:
    flow, image = max(known, key=lambda each: _size(each[1].area_change))
    return (
        f"The largest relative change of area is that by {image.map} with {_at(flow, image)}: "
        f"{_change(image)}."
    )


def _probe(known: Sequence[Found]) -> str:
    """How far below the change the probe's error is, in the worst case."""
    ratios = [
        _size(image.area_change) / Fraction(image.probe_error)
        for _, image in known
        if image.probe_error and Fraction(image.probe_error)
    ]
    if not ratios:
        return "The probe’s own error is 0."
    least = whole(_floor_of(min(ratios)))
    if len(ratios) == 1:
        return f"The probe’s own error is {least} times smaller."
    return f"The probe’s own error is at least {least} times smaller than the change it measures."


def _floor_of(ratio: Fraction) -> int:
    """Two digits, rounded downwards."""
    count = int(ratio)
    unit = int("1" + "0" * max(0, len(str(count)) - 2))
    return count // unit * unit


def _means(known: Sequence[Found]) -> Iterator[str]:
    compared = [image for _, image in known if image.agree is not None]
    if not compared:
        return
    apart = sum(not image.agree for image in compared)
    all_of = "In the one image" if len(compared) == 1 else f"In all {whole(len(compared))} images"
    if apart:
        yield (
            f"The mean of Λ over the region, computed without any area, differs from it in "
            f"{whole(apart)} of {whole(len(compared))} images: one of the two is wrong there."
        )
    else:
        yield (
            f"{all_of} the mean of Λ over the region, computed without any area, is the same "
            "within the errors, as it must be by the change of variables."
        )


def _preserved(images: Sequence[Found]) -> Iterator[str]:
    schemes = list(dict.fromkeys(i.map for _, i in images if i.map != EXACT_FLOW))
    exact = any(image.map == EXACT_FLOW for _, image in images)
    whose = [f"det J ≡ 1 is proved for {listed(schemes)}"] if schemes else []
    if exact:
        whose.append("the exact flow preserves area by Liouville’s theorem")
    measured = [image for _, image in images if image.area_change is not None]
    if not whose or not measured:
        return
    said = " and ".join(whose)
    above = [i for i in measured if _size(i.area_change) > Fraction(i.probe_error or 0)]
    most = max(measured, key=lambda image: Fraction(image.probe_error or 0))
    if above:
        yield (
            f"{_capital(said)}, but for {whole(len(above))} of these images the probe measures a "
            "change that is larger than its error: the probe is wrong there."
        )
        return
    yield (
        f"{_capital(said)}; what the probe measures there is below its own error, at most "
        f"{number(most.probe_error or '0')}."
    )


def _capital(text: str) -> str:
    return text if text.startswith("det") else text[0].upper() + text[1:]


def _distances(images: Sequence[Found]) -> Iterator[str]:
    """For each scheme, how far its outlines are from the exact ones at most."""
    by_map: dict[str, list[Found]] = {}
    for each in images:
        by_map.setdefault(each[1].map, []).append(each)
    parts = []
    for name, own in by_map.items():
        flow, image = max(own, key=lambda each: _size(each[1].distance))
        parts.append(f"{name} up to {_pair(image.distance, image.distance_error)} "
                     f"({_at(flow, image)})")  # fmt: skip
    if parts:
        yield f"From the exact flow’s outlines those by a scheme are away: {listed(parts)}."


# -- sentences on one region ----------------------------------------------------------------------


def _finding(flow: FlowResult) -> Iterator[str]:
    """The change of area of each scheme after the most steps; what is proved; distances."""
    last: dict[str, FlowImage] = {}
    for image in sorted(flow.images, key=lambda image: image.steps):
        last[image.map] = image
    for image in (i for name, i in last.items() if name != EXACT_FLOW):
        yield _finding_of(flow, image)


def _finding_of(flow: FlowResult, image: FlowImage) -> str:
    start = f"{image.map} with {_at(flow, image)}"
    if image.area_change is None:
        return f"{start}: no change of area is known ({image.problem or 'none was measured'})."
    away = ""
    if image.distance is not None:
        apart = _pair(image.distance, image.distance_error)
        away = f" Its outlines are up to {apart} away from the exact ones."
    if image.area_preserving:
        change = f"(measured: {_change(image)})"
        return f"{start} keeps the area of {_region(flow)} by proof {change}.{away}"
    unseen = "; by eye nothing is seen" if _size(image.area_change) < _SEEN else ""
    text = f"{start} changes the area of {_region(flow)} by {_change(image)} of it{unseen}."
    doubt = ""
    if image.agree is False:
        mean = _pair(image.mean_lambda, image.mean_lambda_error)
        doubt = (
            f" The mean of Λ over it, which must be the same, is {mean}: one of the two is wrong."
        )
    return f"{text}{doubt}{away}"


def _region(flow: FlowResult) -> str:
    """The region whose area it is: the first outline's."""
    name = flow.before[0].name if flow.before else flow.shape
    return f"the {flow.shape}" if name == flow.shape else f"the {flow.shape}’s {name}"


# -- numbers --------------------------------------------------------------------------------------


def _size(text: str | None) -> Fraction:
    return abs(Fraction(text or 0))


def _at(flow: FlowResult, image: FlowImage) -> str:
    return f"h{_IS}{step(flow.step_size)}, N{_IS}{whole(image.steps)}"


def _change(image: FlowImage) -> str:
    return _pair(image.area_change, image.probe_error)


def _pair(value: str | None, error: str | None) -> str:
    """value ± error."""
    cell = _cell(value, error)
    return f"{cell.value}{NBSP}±{NBSP}{cell.error}" if cell.error else cell.value


def _cell(value: str | None, error: str | None, *, missing: str = "–") -> Cell:
    if value is None:
        return Cell(missing)
    if error is None:
        return Cell(number(value))
    return Cell(number(value), number(error))


def _row(image: FlowImage) -> ImageRow:
    proved = image.area_preserving is True
    return ImageRow(
        map=image.map,
        steps=whole(image.steps),
        time=number(image.time),
        change=_cell(image.area_change, image.probe_error, missing="not known"),
        mean=_cell(image.mean_lambda, image.mean_lambda_error, missing="0" if proved else "–"),
        distance=_cell(image.distance, image.distance_error),
        arithmetic=_arithmetic(image),
        problem=image.problem or ("the two measures disagree" if image.agree is False else ""),
    )


def _arithmetic(image: FlowImage) -> str:
    if not image.arithmetic or image.arithmetic == "float64":
        return image.arithmetic
    return f"{image.arithmetic} ({image.digits} digits)"


# -- the figure -----------------------------------------------------------------------------------


def _plot(flow: FlowResult, anchor: str) -> Plot | None:
    """The drawing, and with it matplotlib, is imported only where there is an image."""
    if not flow.before or not any(image.outlines for image in flow.images):
        return None
    from reports.flow_figure import flow_panels, grid_of

    grid, what = grid_of(flow), _the(flow)
    maps = listed(f"the {name}" if name == EXACT_FLOW else name for name in grid.columns)
    lead = f"{what[:1].upper()}{what[1:]}, carried by {maps} with h{_IS}{step(flow.step_size)}"
    svg = flow_panels(grid, name=f"panels-of-{anchor}", label=f"{lead}.")
    return Plot(svg, f"{lead}.", _caption(flow, len(grid.rows)), wide=len(grid.columns) > 1)


def _caption(flow: FlowResult, rows: int) -> str:
    counts = len({image.steps for image in flow.images})
    placed = "a row for each number of steps N" if rows else "labelled by the number of steps N"
    some = f" {whole(rows)} of {whole(counts)} are drawn." if rows and rows < counts else ""
    return (
        f"Grey: before. In colour: where each map carries it, {placed}.{some} What is tinted is "
        f"{_region(flow)}, whose area is measured. One scale for q and for p in all panels."
    )
