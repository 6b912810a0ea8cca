"""Error against run time: sentences, figures and tables."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot, known_digits
from verify.pages.sections.section import Picture, ReportSection
from verify.pages.sections.table_rows import Group, TableRow
from verify.pages.text import legend
from verify.pages.text.typography import NBSP, number, start, step, whole
from verify.scenes.results import work_precision
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.report import SceneResult
from verify.structures import AREA, SYMPLECTIC

_HEADS = {AREA: ("order of Λ", "Λ, plain"), SYMPLECTIC: ("order of max |W|", "max |W|")}
# The space between a count and its unit, which becomes a no-break space.
_UNIT_SPACE = re.compile(r"(\d) ")


@dataclass(frozen=True)
class WorkPrecisionView:
    result: work_precision.WorkPrecisionResult
    heads: tuple[str, str]  # those of two columns: the order of the defect, and a second defect
    finding: tuple[str, ...]
    plots: tuple[Plot, ...]
    schemes: tuple[TableRow, ...]
    groups: tuple[Group, ...]
    systems: tuple[TableRow, ...]
    count: int
    provenance: str


def _view(scene: SceneResult, anchor: str) -> WorkPrecisionView | None:
    result = scene.work_precision
    if result is None:
        return None
    from verify.pages.figures.work_precision_plots import plots

    schemes = [line for line in result.lines if not line.peer]
    return WorkPrecisionView(
        result=result,
        heads=_HEADS[result.structure],
        finding=tuple(_finding(result)),
        plots=tuple(plots(result, name=anchor)),
        schemes=tuple(_scheme_row(line) for line in schemes),
        groups=tuple(_group(line) for line in result.lines),
        systems=tuple(_system_row(point) for point in result.systems),
        count=sum(len(line.points) for line in result.lines),
        provenance=_describe_provenance(result),
    )


# -- sentences ------------------------------------------------------------------------------------


def _finding(result: work_precision.WorkPrecisionResult) -> Iterator[str]:
    yield (
        f"The error is that of the float64 state after T = {number(result.time)} from "
        f"{start(result)}, "
        "against the exact solution, which is known to within "
        f"{number(result.reference_bound)}."
    )
    if result.rounded_down:
        yield f"{result.rounded_down}."
    points = [point for line in result.lines if not line.peer for point in line.points]
    rounded = sum(point.limited_by == "rounding" for point in points)
    failed = sum(point.limited_by == "failed" for point in points)
    if rounded:
        yield (
            f"Of {whole(len(points))} runs, {whole(rounded)} "
            f"{'is' if rounded == 1 else 'are'} limited by rounding: hollow, and in no slope."
        )
    if failed:
        yield f"{whole(failed)} {'run' if failed == 1 else 'runs'} left the range of float64."


def _describe_provenance(result: work_precision.WorkPrecisionResult) -> str:
    return (
        f"Reference: {result.reference}, its bound estimated by a second evaluation with more "
        "digits. "
        f"Run times: {result.clock} on {result.machine}, the least and the median of "
        f"{result.repeats} rounds over all points in turn, after a warm-up; what an empty call "
        "takes is subtracted, compilation is apart. The loops are compiled and step the state "
        f"alone. A point is limited by rounding where that may be more than "
        f"{100 * float(result.rounding_share):g}{NBSP}% of its error. At equal run time only runs "
        f"are compared whose error is not larger than the orbit itself, {number(result.scale)}."
    )


# -- tables ---------------------------------------------------------------------------------------


def _scheme_row(line: work_precision.WorkLine) -> TableRow:
    cells = (
        "–" if line.order is None else str(line.order),
        _format_slope(line.error_slope),
        "0, proved" if line.area_preserving else _format_slope(line.lambda_slope),
        *_operations(line.cost),
        _seconds(line.compile_seconds),
    )
    return TableRow(line.name, cells)


def _format_slope(slope: work_precision.SlopeResult) -> str:
    if slope.value is None:
        return "–"
    return f"{float(slope.value):.2f}{NBSP}±{NBSP}{float(slope.standard_error or 0):.2f}"


def _operations(cost: work_precision.CostResult | None) -> tuple[str, str | Markup]:
    if cost is None:
        return "–", "–"
    operations = _UNIT_SPACE.sub(rf"\1{NBSP}", cost.text)
    if cost.gradient is None:
        return operations, "–"
    gradient = (
        Markup("{}{}H<sub>{}</sub>").format(n, NBSP, name[-1]) for name, n in cost.gradient.items()
    )
    return operations, Markup(", ").join(gradient)


def _group(line: work_precision.WorkLine) -> Group:
    about = "compiled in " if not line.peer else "made ready in "
    about += f"{_seconds(line.compile_seconds)} s"
    return Group(line.name, [_row(point) for point in line.points], about)


def _row(point: work_precision.WorkPoint) -> TableRow:
    label = step(point.step_size) if point.step_size else number(point.tolerance or "")
    steps = "–" if point.steps is None else whole(point.steps)
    if point.limited_by == "failed":
        step_note = f" at step {whole(point.failed_step)}" if point.failed_step else ""
        return TableRow(label, (steps,), f"failed{step_note}: {point.reason}")
    values = (point.error, point.rounding, point.energy, point.lam, _second_defect(point))
    times = (point.seconds_min, point.seconds_median)
    limit = "its tolerance" if point.limited_by == "tolerance" else point.limited_by
    cells = (*map(known_digits, values), *map(_seconds, times), limit)
    return TableRow(label, (steps, *cells))


def _second_defect(point: work_precision.WorkPoint) -> Value | None:
    """Return Λ by the plain product; in n degrees of freedom max |W|."""
    return point.symplectic_defect or point.lam_plain


def _system_row(point: work_precision.SystemPoint) -> TableRow:
    cells = (
        str(point.digits),
        point.certified or f"– ({point.reason})",
        _seconds(point.seconds_min),
        _seconds(point.seconds_median),
        f"{point.error_kind} ({point.reason})" if point.reason else point.error_kind,
    )
    return TableRow(point.arithmetic, cells)


def _seconds(seconds: float | None) -> str:
    return "–" if seconds is None else number(f"{seconds:.2e}")


SECTION = ReportSection(
    order=10,
    title="Error against run time",
    anchor="work",
    view=_view,
    pictures=lambda view: [Picture((5,), plot) for plot in view.plots],
    terms=lambda _: legend.terms_of("work-precision") | legend.terms_of_runs(),
)
