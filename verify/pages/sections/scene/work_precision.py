"""Error against run time as the page shows it: sentences, figures and tables, all from the data."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, few_digits
from verify.pages.sections.rows import Group, Row
from verify.pages.sections.section import Picture, Section
from verify.pages.text import words
from verify.pages.text.typography import NBSP, number, start, step, whole
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.report import SceneResult
from verify.scenes.results.work_precision import (
    CostResult,
    SlopeResult,
    SystemPoint,
    WorkLine,
    WorkPoint,
    WorkPrecisionResult,
)
from verify.structures import AREA, SYMPLECTIC

_HEADS = {AREA: ("order of Λ", "Λ, plain"), SYMPLECTIC: ("order of max |W|", "max |W|")}
_UNIT = re.compile(r"(\d) ")  # a count and what is counted stay on one line


@dataclass(frozen=True)
class WorkPrecisionView:
    result: WorkPrecisionResult
    heads: tuple[str, str]  # of the order of what is lost, and of what is the sharper
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]
    schemes: tuple[Row, ...]
    groups: tuple[Group, ...]
    systems: tuple[Row, ...]
    count: int
    computed: str


def _view(scene: SceneResult, anchor: str) -> WorkPrecisionView | None:
    found = scene.work_precision
    if found is None:
        return None
    from verify.pages.figures.work_precision_plots import plots

    own = [line for line in found.lines if not line.peer]
    return WorkPrecisionView(
        result=found,
        heads=_HEADS[found.structure],
        finding=tuple(_finding(found)),
        plots=tuple(plots(found, name=anchor)),
        schemes=tuple(_scheme(line) for line in own),
        groups=tuple(_group(line) for line in found.lines),
        systems=tuple(_system(point) for point in found.systems),
        count=sum(len(line.points) for line in found.lines),
        computed=_computed(found),
    )


# -- sentences ------------------------------------------------------------------------------------


def _finding(found: WorkPrecisionResult) -> Iterator[str]:
    yield (
        f"The error is that of the float64 state after T = {number(found.time)} from "
        f"{start(found)}, "
        "against the exact solution, which is known to within "
        f"{number(found.reference_bound)}."
    )
    if found.rounded_down:
        yield f"{found.rounded_down}."
    points = [point for line in found.lines if not line.peer for point in line.points]
    rounded = sum(point.limited_by == "rounding" for point in points)
    lost = sum(point.limited_by == "failed" for point in points)
    if rounded:
        yield (
            f"Of {whole(len(points))} runs, {whole(rounded)} "
            f"{'is' if rounded == 1 else 'are'} limited by rounding: hollow, and in no slope."
        )
    if lost:
        yield f"{whole(lost)} {'run' if lost == 1 else 'runs'} left the range of float64."


def _computed(found: WorkPrecisionResult) -> str:
    return (
        f"Reference: {found.reference}, its bound estimated by a second evaluation with more "
        "digits. "
        f"Run times: {found.clock} on {found.machine}, the least and the median of "
        f"{found.repeats} rounds over all points in turn, after a warm-up; what an empty call "
        "takes is subtracted, compilation is apart. The loops are compiled and step the state "
        f"alone. A point is limited by rounding where that may be more than "
        f"{100 * float(found.rounding_share):g}{NBSP}% of its error. At equal run time only runs "
        f"are compared whose error is not larger than the orbit itself, {number(found.scale)}."
    )


# -- tables ---------------------------------------------------------------------------------------


def _scheme(line: WorkLine) -> Row:
    cells = (
        "–" if line.order is None else str(line.order),
        _slope(line.error_slope),
        "0, proved" if line.area_preserving else _slope(line.lambda_slope),
        *_operations(line.cost),
        _seconds(line.compile_seconds),
    )
    return Row(line.name, cells)


def _slope(found: SlopeResult) -> str:
    if found.value is None:
        return "–"
    return f"{float(found.value):.2f}{NBSP}±{NBSP}{float(found.standard_error or 0):.2f}"


def _operations(cost: CostResult | None) -> tuple[str, str | Markup]:
    if cost is None:
        return "–", "–"
    shown = _UNIT.sub(rf"\1{NBSP}", cost.text)
    if cost.gradient is None:
        return shown, "–"
    counted = (
        Markup("{}{}H<sub>{}</sub>").format(n, NBSP, name[-1]) for name, n in cost.gradient.items()
    )
    return shown, Markup(", ").join(counted)


def _group(line: WorkLine) -> Group:
    about = "compiled in " if not line.peer else "made ready in "
    about += f"{_seconds(line.compile_seconds)} s"
    return Group(line.name, [_row(point) for point in line.points], about)


def _row(point: WorkPoint) -> Row:
    label = step(point.step_size) if point.step_size else number(point.tolerance or "")
    steps = "–" if point.steps is None else whole(point.steps)
    if point.limited_by == "failed":
        at = f" at step {whole(point.failed_step)}" if point.failed_step else ""
        return Row(label, (steps,), f"failed{at}: {point.reason}")
    values = (point.error, point.rounding, point.energy, point.lam, _sharper(point))
    times = (point.seconds_min, point.seconds_median)
    limit = "its tolerance" if point.limited_by == "tolerance" else point.limited_by
    cells = (*map(few_digits, values), *map(_seconds, times), limit)
    return Row(label, (steps, *cells))


def _sharper(point: WorkPoint) -> Value | None:
    """Λ by the plain product; in n degrees of freedom max |W|."""
    return point.symplectic_defect or point.lam_plain


def _system(point: SystemPoint) -> Row:
    cells = (
        str(point.digits),
        point.certified or f"– ({point.reason})",
        _seconds(point.seconds_min),
        _seconds(point.seconds_median),
        f"{point.error_kind} ({point.reason})" if point.reason else point.error_kind,
    )
    return Row(point.arithmetic, cells)


def _seconds(seconds: float | None) -> str:
    return "–" if seconds is None else number(f"{seconds:.2e}")


_TERMS = {
    "Limited by rounding": Markup(
        "The float64 run differs from the same steps in exact arithmetic by a part of its error "
        "that counts: smaller steps make it no better. Such points are hollow, and no slope is "
        "fitted to them."
    )
}
SECTION = Section(
    order=10,
    title="Error against run time",
    anchor="work",
    view=_view,
    pictures=lambda view: [Picture((5,), plot) for plot in view.plots],
    terms=lambda _: _TERMS | words.RAN,
)
