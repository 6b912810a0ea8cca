"""Which figures error against run time asks for, and what stands in them.

The drawing, and with it matplotlib, is imported only where something is drawn.
"""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from math import isfinite, log10
from statistics import median
from typing import TYPE_CHECKING

from verify.pages.figures.captioned_plot import Plot, plotted
from verify.pages.figures.logarithm import lg
from verify.pages.text.typography import listed, superscript
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import LimitedBy, WorkLine, WorkPoint, WorkPrecisionResult

if TYPE_CHECKING:
    from verify.pages.figures.work_precision_figure import Mark, Panel


def plots(found: WorkPrecisionResult, *, name: str) -> Iterator[Plot]:
    """The figures for which there is something to draw."""
    if any(_timed(line) for line in found.lines):
        yield _errors(found, name)
    if any(_area(line) for line in found.lines):
        yield _areas(found, name)
    if any(point.certified for point in found.systems):
        yield _digits(found, name)


def _errors(found: WorkPrecisionResult, name: str) -> Plot:
    from verify.pages.figures import work_precision_figure as figure

    return plotted(
        lambda: figure.draw_panels(error_panels(found)),
        name=f"work-of-{name}",
        lead=f"Solution error at T = {found.time} against run time, and against the step size h",
        caption=_caption([x for x in found.lines if _timed(x) and not x.peer]),
    )


def error_panels(found: WorkPrecisionResult) -> "list[Panel]":
    """Solution error against run time and, of the schemes, against the step size."""
    from verify.pages.figures import work_precision_figure as figure

    lines = [line for line in found.lines if _timed(line)]
    own = [line for line in lines if not line.peer]
    against_time = figure.Panel(
        "(a) error against run time",
        f"run time over [0, {found.time}] in seconds",
        tuple(
            figure.DrawnLine(_labelled(line), tuple(_by_time(line)), _place(found, line), line.peer)
            for line in lines
        ),
        tuple(_floor(own)),
    )
    against_h = figure.Panel(
        "(b) error against h",
        "step size h",
        tuple(
            figure.DrawnLine(line.name, tuple(_by_step(line)), _place(found, line)) for line in own
        ),
        tuple(_floor(own, by_step=True)),
    )
    return [against_time, against_h] if own else [against_time]


def _areas(found: WorkPrecisionResult, name: str) -> Plot:
    from verify.pages.figures import work_precision_figure as figure

    lines = [line for line in found.lines if _area(line)]
    panel = figure.Panel(
        "(c) |Λ| against run time",
        f"run time over [0, {found.time}] in seconds",
        tuple(
            figure.DrawnLine(_labelled(line, of_area=True), tuple(_area(line)), _place(found, line))
            for line in lines
        ),
    )
    caption = "Λ in float64 by the closed form of ΔJ."
    keeping = [line for line in found.lines if line.area_preserving]
    if keeping:
        caption += (
            f" For {listed(line.name for line in keeping)} ΔJ ≡ 0 is proved and Λ is 0; what is "
            "drawn, hollow, is what rounding makes of the plain product of determinants."
        )
    if none := [line.name for line in keeping if line not in lines]:
        caption += f" That of {listed(none)} is exactly 1 and has no place here."
    lead = f"|Λ| over [0, {found.time}] against run time"
    return plotted(
        lambda: figure.draw_panels([panel]), name=f"area-of-{name}", lead=lead, caption=caption
    )


def _digits(found: WorkPrecisionResult, name: str) -> Plot:
    from verify.pages.figures import work_precision_figure as figure

    names = dict.fromkeys(p.arithmetic for p in found.systems if p.certified)
    lines = tuple(
        figure.DrawnLine(
            arithmetic,
            tuple(
                figure.Mark(log10(p.seconds_median), float(p.certified))
                for p in found.systems
                if p.arithmetic == arithmetic and p.certified and p.seconds_median
            ),
            place,
        )
        for place, arithmetic in enumerate(names)
    )
    lead = f"Certified digits of the end state against run time, {_systems_of(found)}"
    panel = figure.Panel("(d) certified digits", "run time in seconds", lines, logarithmic=False)
    said = (
        "Run time is the stepping with all that certifies it, on the clock; that of float64 is its "
        "compiled loop’s."
    )
    return plotted(
        lambda: figure.draw_panels([panel]), name=f"digits-of-{name}", lead=lead, caption=said
    )


def _systems_of(found: WorkPrecisionResult) -> str:
    return f"{found.systems_scheme} at h = {found.systems_step_size}"


def _caption(own: Sequence[WorkLine]) -> str:
    orders = {line.name: line.error_slope for line in own}
    none = [f"{name} ({slope.reason})" for name, slope in orders.items() if slope.value is None]
    said = "Slopes are of the points that truncation limits, where they have settled."
    if none:
        said += f" None is given for {listed(none)}."
    if any(point.limited_by == "failed" for line in own for point in line.points):
        said += " A failed run stands where as many steps would have ended."
    return said


def _labelled(line: WorkLine, *, of_area: bool = False) -> str:
    slope = line.lambda_slope if of_area else line.error_slope
    return f"{line.name}, slope {float(slope.value):.2f}" if slope.value else line.name


def _place(found: WorkPrecisionResult, line: WorkLine) -> int:
    """Its number among the schemes, or among the peers."""
    return [other.name for other in found.lines if other.peer is line.peer].index(line.name)


def _timed(line: WorkLine) -> list[WorkPoint]:
    return [p for p in line.points if p.seconds_median and p.error]


def _by_time(line: WorkLine) -> Iterator["Mark"]:
    """Error against run time; the first and the last of a line with a label."""
    timed = _timed(line)
    for point in line.points:
        label = _end_label(point, timed)
        yield from _mark(_run_time(point, timed), point.error, point.limited_by, label)


def _by_step(line: WorkLine) -> Iterator["Mark"]:
    """Error against the step size."""
    for point in line.points:
        x = lg(point.step_size) if point.step_size else None
        yield from _mark(x, point.error, point.limited_by)


def _area(line: WorkLine) -> list["Mark"]:
    """|Λ| against run time; the plain product's where Λ is exactly 0."""
    found: list[Mark] = []
    timed = _timed(line)
    for point in timed:
        value = point.lam_plain if line.area_preserving else point.lam
        label = _end_label(point, timed)
        found += _mark(_run_time(point, timed), value, point.lambda_limited_by, label)
    return found


def _mark(
    x: float | None, value: Value | None, limited_by: LimitedBy | None, label: str = ""
) -> Iterator["Mark"]:
    """None where there is no place for it: no abscissa, or no known digit of the value."""
    from verify.pages.figures.work_precision_figure import Mark

    if x is not None and limited_by == "failed":
        yield Mark(x, None)
    elif x is not None and value and isfinite(lg(value.value)):
        yield Mark(x, lg(value.value), limited_by != "rounding", label)


def _run_time(point: WorkPoint, timed: Sequence[WorkPoint]) -> float | None:
    """lg of the run time; of a failed run, of what as many steps take elsewhere on the line."""
    if point.seconds_median:
        return log10(point.seconds_median)
    rates = [p.seconds_median / p.steps for p in timed if p.seconds_median and p.steps]
    return log10(median(rates) * point.steps) if rates and point.steps else None


def _floor(own: Sequence[WorkLine], *, by_step: bool = False) -> Iterator[tuple[float, float]]:
    for line in own:
        for point in line.points:
            x = lg(point.step_size) if by_step and point.step_size else _run_time(point, ())
            if point.rounding and x is not None and isfinite(lg(point.rounding.value)):
                yield x, lg(point.rounding.value)


def _end_label(point: WorkPoint, timed: Sequence[WorkPoint]) -> str:
    """Of the first and of the last of these points."""
    if point not in (*timed[:1], *timed[-1:]):
        return ""
    if point.step_size:
        return f"h = {_short(point.step_size)}"
    return f"tol {_short(point.tolerance or '')}"


def _short(text: str) -> str:
    """Two digits, as a power of ten where it is small."""
    if "/" in text:
        return text
    if Decimal(text) > Decimal("0.001"):
        return f"{float(Decimal(text)):.2g}"
    mantissa, _, power = f"{Decimal(text):.1e}".partition("e")
    scale = f"10{superscript(int(power))}"
    return scale if float(mantissa) == 1 else f"{mantissa}·{scale}"


# -- a file of its own ----------------------------------------------------------------------------


def standalone(found: WorkPrecisionResult) -> str:
    """All figures below one another, as one SVG document."""
    from verify.pages.figures.svg import document

    return document([plot.svg for plot in plots(found, name="bench")])
