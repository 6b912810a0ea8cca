"""The figure of error against run time: its panels, their lines and its caption.

The drawing, and with it matplotlib, is imported only if something is drawn.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import isfinite, log10
from statistics import median
from string import ascii_lowercase
from typing import TYPE_CHECKING

from verify.pages.figures.captioned_plot import Plot, captioned_plot, lg
from verify.pages.text.typography import interval, join_and
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import LimitedBy, WorkLine, WorkPoint, WorkPrecisionResult
from verify.structures import SYMPLECTIC

if TYPE_CHECKING:
    from verify.pages.figures.work_precision_figure import DrawnLine, WorkMark, WorkPanel

_RUN_TIME = "run time in seconds"


def plots(result: WorkPrecisionResult, *, name: str) -> Iterator[Plot]:
    """Yield one figure, whose panels show everything that can be drawn; none if nothing can."""
    schemes = [line for line in result.lines if not line.peer]
    panel_groups = [
        (list(error_panels(result)), _caption([line for line in schemes if _timed_points(line)])),
        (list(_area_panels(result)), _caption_of_areas(result)),
        (list(_digit_panels(result)), _caption_of_digits(result)),
    ]
    panels = [panel for group, _ in panel_groups for panel in group]
    if not panels:
        return
    from verify.pages.figures.work_precision_figure import draw_panels

    lettered = [
        replace(panel, title=f"({letter}) {panel.title}") if len(panels) > 1 else panel
        for letter, panel in zip(ascii_lowercase, panels, strict=False)
    ]
    titles = join_and(panel.title for panel in panels)
    yield captioned_plot(
        lambda: draw_panels(lettered),
        name=f"work-of-{name}",
        lead=f"Over {interval(result.t0, result.time)}: {titles}",
        caption=" ".join(caption for group, caption in panel_groups if group and caption),
    )


def error_panels(result: WorkPrecisionResult) -> "Iterator[WorkPanel]":
    """Yield the solution error against run time and, for the schemes, against the step size."""
    lines = [line for line in result.lines if _timed_points(line)]
    schemes = [line for line in lines if not line.peer]
    if lines:
        from verify.pages.figures.work_precision_figure import WorkPanel

        lines_by_time = tuple(_drawn_line(result, line, _marks_by_time(line)) for line in lines)
        yield WorkPanel(
            "error against run time", _RUN_TIME, lines_by_time, tuple(_floor_points(schemes))
        )
    if schemes:
        lines_by_step = tuple(_drawn_line(result, line, _marks_by_step(line)) for line in schemes)
        floor = tuple(_floor_points(schemes, by_step=True))
        yield WorkPanel("error against h", "step size h", lines_by_step, floor)


def _area_panels(result: WorkPrecisionResult) -> "Iterator[WorkPanel]":
    lines = tuple(
        _drawn_line(result, line, _area_marks(line)) for line in result.lines if _area_marks(line)
    )
    if lines:
        from verify.pages.figures.work_precision_figure import WorkPanel

        yield WorkPanel(f"{result.structure.size} against run time", _RUN_TIME, lines)


def _caption_of_areas(result: WorkPrecisionResult) -> str:
    preserving = [line for line in result.lines if line.area_preserving]
    if result.structure is SYMPLECTIC:
        names = join_and(line.name for line in preserving)
        sentence = f" For {names} S ≡ 0 is proved, and W is 0." if preserving else ""
        return f"max |W| is the greatest entry of W, the symplectic defect of the run.{sentence}"
    caption = "Λ in float64 by the closed form of ΔJ."
    if preserving:
        caption += (
            f" For {join_and(line.name for line in preserving)} ΔJ ≡ 0 is proved and Λ is 0; what "
            "is drawn, hollow, is what rounding makes of the plain product of determinants."
        )
    if undrawn := [line.name for line in preserving if not _area_marks(line)]:
        caption += f" That of {join_and(undrawn)} is exactly 1 and has no place here."
    return caption


def _digit_panels(result: WorkPrecisionResult) -> "Iterator[WorkPanel]":
    names = dict.fromkeys(p.arithmetic for p in result.systems if p.certified)
    if not names:
        return
    from verify.pages.figures.work_precision_figure import DrawnLine, WorkMark, WorkPanel

    lines = tuple(
        DrawnLine(
            arithmetic,
            arithmetic,
            tuple(
                WorkMark(log10(p.seconds_median), float(p.certified))
                for p in result.systems
                if p.arithmetic == arithmetic and p.certified and p.seconds_median
            ),
            style_index,
        )
        for style_index, arithmetic in enumerate(names)
    )
    yield WorkPanel("certified digits", "run time in seconds", lines, is_logarithmic=False)


def _caption_of_digits(result: WorkPrecisionResult) -> str:
    return (
        f"Certified digits are of the end state by {result.systems_scheme} at h = "
        f"{result.systems_step_size}; run time there is the stepping with all that certifies it, "
        "that of float64 its compiled loop’s."
    )


def _drawn_line(
    result: WorkPrecisionResult, line: WorkLine, marks: "Iterable[WorkMark]"
) -> "DrawnLine":
    from verify.pages.figures.work_precision_figure import DrawnLine

    return DrawnLine(
        line.name, _label_with_slope(line), tuple(marks), _style_index(result, line), line.peer
    )


def _caption(lines: Sequence[WorkLine]) -> str:
    orders = {line.name: line.error_slope for line in lines}
    undecided = [
        f"{name} ({slope.reason})" for name, slope in orders.items() if slope.value is None
    ]
    caption = "Slopes are of the points that truncation limits, where they have settled."
    if undecided:
        caption += f" None is given for {join_and(undecided)}."
    if any(point.limited_by == "failed" for line in lines for point in line.points):
        caption += " A failed run stands where as many steps would have ended."
    return caption


def _label_with_slope(line: WorkLine) -> str:
    slope = line.error_slope
    return f"{line.name}, slope {float(slope.value):.2f}" if slope.value else line.name


def _style_index(result: WorkPrecisionResult, line: WorkLine) -> int:
    """Return the line's index among the schemes, or among the peers."""
    return [other_line.name for other_line in result.lines if other_line.peer is line.peer].index(
        line.name
    )


def _timed_points(line: WorkLine) -> list[WorkPoint]:
    return [p for p in line.points if p.seconds_median and p.error]


def _marks_by_time(line: WorkLine) -> Iterator["WorkMark"]:
    """Yield the marks of error against run time."""
    timed = _timed_points(line)
    for point in line.points:
        yield from _marks_of(_run_time(point, timed), point.error, point.limited_by)


def _marks_by_step(line: WorkLine) -> Iterator["WorkMark"]:
    """Yield the marks of error against the step size."""
    for point in line.points:
        x = lg(point.step_size) if point.step_size else None
        yield from _marks_of(x, point.error, point.limited_by)


def _area_marks(line: WorkLine) -> list["WorkMark"]:
    """Return the marks of the area error against run time.

    If a scheme preserves area, they are those of Λ by the plain product, which is rounding alone.
    """
    marks: list[WorkMark] = []
    timed = _timed_points(line)
    for point in timed:
        value = point.lam_plain if line.area_preserving else point.area_error
        marks += _marks_of(_run_time(point, timed), value, point.lambda_limited_by)
    return marks


def _marks_of(
    x: float | None, value: Value | None, limited_by: LimitedBy | None
) -> Iterator["WorkMark"]:
    """Yield the mark, unless it has no abscissa, or no digit of the value is known."""
    from verify.pages.figures.work_precision_figure import WorkMark

    if x is not None and limited_by == "failed":
        yield WorkMark(x, None)
    elif x is not None and value and isfinite(lg(value.value)):
        yield WorkMark(x, lg(value.value), limited_by != "rounding")


def _run_time(point: WorkPoint, timed: Sequence[WorkPoint]) -> float | None:
    """Return lg of the run time; for a failed run, of the time that its steps would have taken."""
    if point.seconds_median:
        return log10(point.seconds_median)
    # The time of a step is the median of those of the runs in `timed`.
    rates = [p.seconds_median / p.steps for p in timed if p.seconds_median and p.steps]
    return log10(median(rates) * point.steps) if rates and point.steps else None


def _floor_points(
    lines: Sequence[WorkLine], *, by_step: bool = False
) -> Iterator[tuple[float, float]]:
    for line in lines:
        for point in line.points:
            x = lg(point.step_size) if by_step and point.step_size else _run_time(point, ())
            if point.rounding and x is not None and isfinite(lg(point.rounding.value)):
                yield x, lg(point.rounding.value)


# -- a file of its own ----------------------------------------------------------------------------


def standalone(result: WorkPrecisionResult) -> str:
    """Return the figure as an SVG document of its own."""
    from verify.pages.figures.svg import document

    return document([plot.svg for plot in plots(result, name="bench")])
