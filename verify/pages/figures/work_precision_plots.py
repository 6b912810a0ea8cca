"""Which figures error against run time asks for, and what stands in them.

The drawing, and with it matplotlib, is imported only where something is drawn.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import isfinite, log10
from statistics import median
from string import ascii_lowercase
from typing import TYPE_CHECKING

from verify.pages.figures.captioned_plot import Plot, plotted
from verify.pages.figures.logarithm import lg
from verify.pages.text.typography import interval, listed
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.work_precision import LimitedBy, WorkLine, WorkPoint, WorkPrecisionResult
from verify.structures import SYMPLECTIC

if TYPE_CHECKING:
    from verify.pages.figures.work_precision_figure import DrawnLine, Mark, Panel

_RUN_TIME = "run time in seconds"


def plots(found: WorkPrecisionResult, *, name: str) -> Iterator[Plot]:
    """All that there is to draw, as the panels of one figure."""
    own = [line for line in found.lines if not line.peer]
    told = [
        (list(error_panels(found)), _caption([line for line in own if _timed(line)])),
        (list(_area_panels(found)), _of_areas(found)),
        (list(_digit_panels(found)), _of_digits(found)),
    ]
    panels = [panel for own_panels, _ in told for panel in own_panels]
    if not panels:
        return
    from verify.pages.figures.work_precision_figure import draw_panels

    lettered = [
        replace(panel, title=f"({letter}) {panel.title}") if len(panels) > 1 else panel
        for letter, panel in zip(ascii_lowercase, panels, strict=False)
    ]
    what = listed(panel.title for panel in panels)
    yield plotted(
        lambda: draw_panels(lettered),
        name=f"work-of-{name}",
        lead=f"Over {interval(found.t0, found.time)}: {what}",
        caption=" ".join(caption for own_panels, caption in told if own_panels and caption),
    )


def error_panels(found: WorkPrecisionResult) -> "Iterator[Panel]":
    """Solution error against run time and, of the schemes, against the step size."""
    lines = [line for line in found.lines if _timed(line)]
    own = [line for line in lines if not line.peer]
    if lines:
        from verify.pages.figures.work_precision_figure import Panel

        of_time = tuple(_drawn(found, line, _by_time(line)) for line in lines)
        yield Panel("error against run time", _RUN_TIME, of_time, tuple(_floor(own)))
    if own:
        of_step = tuple(_drawn(found, line, _by_step(line)) for line in own)
        floor = tuple(_floor(own, by_step=True))
        yield Panel("error against h", "step size h", of_step, floor)


def _area_panels(found: WorkPrecisionResult) -> "Iterator[Panel]":
    lines = tuple(_drawn(found, line, _area(line)) for line in found.lines if _area(line))
    if lines:
        from verify.pages.figures.work_precision_figure import Panel

        yield Panel(f"{found.structure.size} against run time", _RUN_TIME, lines)


def _of_areas(found: WorkPrecisionResult) -> str:
    keeping = [line for line in found.lines if line.area_preserving]
    if found.structure is SYMPLECTIC:
        kept = listed(line.name for line in keeping)
        said = f" For {kept} S ≡ 0 is proved, and W is 0." if keeping else ""
        return f"max |W| is the greatest entry of W, the symplectic defect of the run.{said}"
    caption = "Λ in float64 by the closed form of ΔJ."
    if keeping:
        caption += (
            f" For {listed(line.name for line in keeping)} ΔJ ≡ 0 is proved and Λ is 0; what is "
            "drawn, hollow, is what rounding makes of the plain product of determinants."
        )
    if none := [line.name for line in keeping if not _area(line)]:
        caption += f" That of {listed(none)} is exactly 1 and has no place here."
    return caption


def _digit_panels(found: WorkPrecisionResult) -> "Iterator[Panel]":
    names = dict.fromkeys(p.arithmetic for p in found.systems if p.certified)
    if not names:
        return
    from verify.pages.figures.work_precision_figure import DrawnLine, Mark, Panel

    lines = tuple(
        DrawnLine(
            arithmetic,
            arithmetic,
            tuple(
                Mark(log10(p.seconds_median), float(p.certified))
                for p in found.systems
                if p.arithmetic == arithmetic and p.certified and p.seconds_median
            ),
            place,
        )
        for place, arithmetic in enumerate(names)
    )
    yield Panel("certified digits", "run time in seconds", lines, logarithmic=False)


def _of_digits(found: WorkPrecisionResult) -> str:
    return (
        f"Certified digits are of the end state by {_systems_of(found)}; run time there is the "
        "stepping with all that certifies it, that of float64 its compiled loop’s."
    )


def _drawn(found: WorkPrecisionResult, line: WorkLine, marks: "Iterable[Mark]") -> "DrawnLine":
    from verify.pages.figures.work_precision_figure import DrawnLine

    return DrawnLine(line.name, _labelled(line), tuple(marks), _place(found, line), line.peer)


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


def _labelled(line: WorkLine) -> str:
    slope = line.error_slope
    return f"{line.name}, slope {float(slope.value):.2f}" if slope.value else line.name


def _place(found: WorkPrecisionResult, line: WorkLine) -> int:
    """Its number among the schemes, or among the peers."""
    return [other.name for other in found.lines if other.peer is line.peer].index(line.name)


def _timed(line: WorkLine) -> list[WorkPoint]:
    return [p for p in line.points if p.seconds_median and p.error]


def _by_time(line: WorkLine) -> Iterator["Mark"]:
    """Error against run time."""
    timed = _timed(line)
    for point in line.points:
        yield from _mark(_run_time(point, timed), point.error, point.limited_by)


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
        value = point.lam_plain if line.area_preserving else point.area_error
        found += _mark(_run_time(point, timed), value, point.lambda_limited_by)
    return found


def _mark(x: float | None, value: Value | None, limited_by: LimitedBy | None) -> Iterator["Mark"]:
    """None where there is no place for it: no abscissa, or no known digit of the value."""
    from verify.pages.figures.work_precision_figure import Mark

    if x is not None and limited_by == "failed":
        yield Mark(x, None)
    elif x is not None and value and isfinite(lg(value.value)):
        yield Mark(x, lg(value.value), limited_by != "rounding")


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


# -- a file of its own ----------------------------------------------------------------------------


def standalone(found: WorkPrecisionResult) -> str:
    """All figures below one another, as one SVG document."""
    from verify.pages.figures.svg import document

    return document([plot.svg for plot in plots(found, name="bench")])
