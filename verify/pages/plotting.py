"""The report's figures as matplotlib figures, to show, to restyle and to save.

Each function returns a `matplotlib.figure.Figure` on white; the caller may change `figure.axes` and
everything on them. A function that draws a single plot takes `ax`, the axes to draw it on, and then
returns their figure. Logarithms are taken before anything is drawn, so that 1e-500 has its place
too: the data of a logarithmic axis are decimal logarithms, and its ticks say 10ⁿ. All quantities
are without units. An `InputError` is raised where there is nothing to draw.
"""

import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from matplotlib.figure import Figure

from verify import observables
from verify.arithmetic.exact import decimal
from verify.errors import InputError, unknown_name
from verify.pages.figures import (
    crossover_figure,
    figures,
    flow_figure,
    growth_figure,
    over_time_figure,
    stability_figure,
)
from verify.pages.figures import work_precision_figure as work_figure
from verify.pages.figures.flow_grid import grid_of
from verify.pages.figures.logarithm import lg
from verify.pages.figures.svg import page_style
from verify.pages.figures.work_precision_plots import error_panels
from verify.pages.sections.claim_view import ClaimView
from verify.pages.sections.scheme.growth import select_drawable
from verify.pages.sections.scheme_plots import rows_of
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.growth import GrowthLawResult
from verify.scenes.results.regions import FlowResult
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import SeparationGrid
from verify.scenes.results.stability import StabilityMapResult
from verify.scenes.results.work_precision import WorkPrecisionResult

QUANTITIES = {
    **{name: each.plotted or each.label for name, each in observables.by_name().items()},
    "energy_error": "max |H − H₀|",
    "solution_error": "solution error",
}
_DIGITS = 7


def plot_runs(
    runs: Sequence[RunResult],
    quantity: str = "lambda",
    *,
    slopes: Sequence[int] = (),
    ax: Any = None,
) -> Figure:
    """Plot a quantity against the step size, with a line for each scheme and initial value.

    `runs`: several RunResults, or a Sweep. `quantity`: a key of `QUANTITIES`; "energy_error" is the
    greatest |H − H₀| of a run's `orbit`, "solution_error" the distance of its last state from the
    exact solution. A grey guide is drawn above the points for each of `slopes`, powers of h.
    `ax`: the axes to draw on. Raises InputError for another quantity, or where no line has two
    step sizes.
    """
    if quantity not in QUANTITIES:
        raise unknown_name("quantity", quantity, QUANTITIES)
    runs = list(runs)
    place = _LOG_PLACES.get(quantity)
    schemes = dict.fromkeys(run.scheme for run in runs)
    lines = [
        figures.Line(f"{scheme}, {line.label}" if len(schemes) > 1 else line.label, line.points)
        for scheme in schemes
        for scheme_runs in [[run for run in runs if run.scheme == scheme]]
        for line in (
            figures.lines_of(scheme_runs, place) if place else figures.lines(scheme_runs, quantity)
        )
    ]
    if not lines:
        raise InputError("runs", len(runs), f"hold no {quantity} to draw at two step sizes or more")
    panel = figures.Quantity(QUANTITIES[quantity], lines, slopes)
    return restyle_for_caller(lambda: figures.draw_against_step_size([panel], ax), ax)


def _energy_error(run: RunResult) -> float:
    sizes = (abs(Fraction(text)) for text in run.orbit.texts("energy_error") if text)
    return lg(decimal(max(sizes, default=Fraction(0)), _DIGITS))


def _solution_error(run: RunResult) -> float:
    return lg(run.solution_errors(1)[-1][1].value)


_LOG_PLACES = {"energy_error": _energy_error, "solution_error": _solution_error}


def plot_over_time(run: RunResult) -> Figure:
    """Plot ΔJ = det J − 1 and Λ over t, as bands between extremes, for a run with a series."""
    if not run.series:
        raise InputError("run", run.scheme, "holds no series; run(…, points=400) keeps one")
    panels = over_time_figure.OrbitPanels("", ((run, "delta_j"), (run, "lam")))
    return restyle_for_caller(lambda: over_time_figure.draw_over_time([panels]))


def plot_separation(grid: SeparationGrid, *, ax: Any = None) -> Figure:
    """Plot the greatest |truncation| and |rounding| in Λ against the step size, with crossovers."""
    lines, marks = crossover_figure.lines_and_marks(grid)
    if len(lines) < 2:
        raise InputError(
            "grid", len(grid.points), "does not hold truncation and rounding at two step sizes"
        )
    return restyle_for_caller(
        lambda: crossover_figure.draw_truncation_against_rounding(lines, marks, ax), ax
    )


def plot_growth(laws: Sequence[GrowthLawResult]) -> Figure:
    """Plot Λ as predicted by the growth law and as measured, and their difference."""
    drawable = select_drawable(laws)
    if not drawable:
        raise InputError("laws", len(laws), "hold no prediction to draw at two step sizes")
    return restyle_for_caller(lambda: growth_figure.draw_predicted_against_measured(drawable))


def plot_table(claim: ClaimResult) -> Figure:
    """Plot the lg MSE of a table, as printed and as computed, against the step size."""
    view = ClaimView(claim, anchor="", scene_anchor="", scene_title="")
    printed, computed_lines = rows_of(view) if view.is_table else (figures.Line("", ()), [])
    if len(printed.points) < 2 or not computed_lines:
        raise InputError("claim", claim.id, "is no table with two step sizes to draw")
    return restyle_for_caller(
        lambda: figures.draw_printed_against_computed(computed_lines, printed)
    )


def plot_work_precision(found: WorkPrecisionResult) -> Figure:
    """Plot the solution error at T against run time in seconds, and against the step size."""
    panels = list(error_panels(found))
    if not panels:
        raise InputError("found", len(found.lines), "hold no run with an error and a run time")
    return restyle_for_caller(lambda: work_figure.draw_panels(panels, f"error at T = {found.time}"))


def plot_stability(over: StabilityMapResult) -> Figure:
    """Plot the verdicts in the plane of step size and stiffness."""
    return restyle_for_caller(lambda: stability_figure.draw_planes([over]))


def plot_flow(flow: FlowResult, plane: int | None = None) -> Figure:
    """Plot a region and its images by each map, q to the right and p upwards, on equal axes.

    `plane`: in n degrees of freedom, the k of the plane (q_k, p_k) on which they are projected; by
    default that of the region. Raises InputError where there is no image, or no such plane.
    """
    if not flow.before or not any(image.outlines for image in flow.images):
        raise InputError("flow", flow.shape, "holds no image to draw")
    degrees = len(flow.point) // 2 or 1
    if plane is not None and not 1 <= plane <= degrees:
        raise InputError("plane", plane, f"must be 1 … {degrees}")
    return restyle_for_caller(lambda: flow_figure.draw_flow(grid_of(flow, plane)))


def restyle_for_caller(draw: Callable[[], Figure], ax: Any = None) -> Figure:
    """Draw the figure on white, with its titles moved to the vertical axes.

    `ax`: the caller's axes that it is drawn on; nothing else of their figure is touched.
    """
    # What the caller sets in place of our labels may be a formula between dollar signs.
    with page_style(**{"figure.facecolor": "white", "axes.facecolor": "white"}):
        figure = draw()
        for axes in figure.axes if ax is None else [ax]:
            for text in (axes.title, axes.xaxis.label, axes.yaxis.label):
                # The page's labels are plain text, but a caller's label may be a formula between
                # dollar signs.
                text.set_parse_math(True)
            title = axes.get_title(loc="left")
            if axes.get_ylabel():
                continue
            axes.set_ylabel(re.sub(r"^\([a-z]\) |:.*", "", title))
            if ax is not None or len(figure.axes) == 1:
                axes.set_title("", loc="left")
    return figure
