"""The report's figures as matplotlib figures, to show, to restyle and to save.

Each function gives a `matplotlib.figure.Figure` with white ground; `figure.axes` and all that
stands on them are the caller's. What is one plot takes `ax`, axes to draw it on; their figure is
then given back. Logarithms are taken before anything is drawn, so that 1e-500 has
its place too: the data of a logarithmic axis are decimal logarithms, and its ticks say 10ⁿ. All
quantities are without units. What there is nothing to draw of is an `InputError`.
"""

import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from matplotlib.figure import Figure

from verify import observables
from verify.arithmetic.exact import decimal
from verify.errors import InputError, unknown
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
from verify.pages.figures.svg import styled
from verify.pages.figures.work_precision_plots import error_panels
from verify.pages.sections.claim_view import ClaimView
from verify.pages.sections.scheme.growth import orbits
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
    """A quantity of `QUANTITIES` against the step size, one line a scheme and initial value.

    `runs`: several RunResults, or a Sweep. "energy_error" is the greatest |H − H₀| of a run's
    `orbit`, "solution_error" the distance of its last state from the exact solution. A grey guide
    stands above the points for each of `slopes`, powers of h.
    """
    if quantity not in QUANTITIES:
        raise unknown("quantity", quantity, QUANTITIES)
    runs = list(runs)
    place = _PLACES.get(quantity)
    schemes = dict.fromkeys(run.scheme for run in runs)
    lines = [
        figures.Line(f"{scheme}, {line.label}" if len(schemes) > 1 else line.label, line.points)
        for scheme in schemes
        for own in [[run for run in runs if run.scheme == scheme]]
        for line in (figures.lines_of(own, place) if place else figures.lines(own, quantity))
    ]
    if not lines:
        raise InputError("runs", len(runs), f"hold no {quantity} to draw at two step sizes or more")
    drawn = figures.Quantity(QUANTITIES[quantity], lines, slopes)
    return shown(lambda: figures.draw_against_step_size([drawn], ax), ax)


def _energy_error(run: RunResult) -> float:
    sizes = (abs(Fraction(text)) for text in run.orbit.texts("energy_error") if text)
    return lg(decimal(max(sizes, default=Fraction(0)), _DIGITS))


def _solution_error(run: RunResult) -> float:
    return lg(run.solution_errors(1)[-1][1].value)


_PLACES = {"energy_error": _energy_error, "solution_error": _solution_error}


def plot_over_time(run: RunResult) -> Figure:
    """ΔJ = det J − 1 and Λ over t of a run that holds a series, as bands between their extremes."""
    if not run.series:
        raise InputError("run", run.scheme, "holds no series; run(…, points=400) keeps one")
    both = over_time_figure.Along("", ((run, "delta_j"), (run, "lam")))
    return shown(lambda: over_time_figure.draw_over_time([both]))


def plot_separation(grid: SeparationGrid, *, ax: Any = None) -> Figure:
    """The greatest |truncation| and |rounding| in Λ against the step size, and where they cross."""
    lines, marks = crossover_figure.contents(grid)
    if len(lines) < 2:
        raise InputError(
            "grid", len(grid.points), "does not hold truncation and rounding at two step sizes"
        )
    return shown(lambda: crossover_figure.draw_truncation_against_rounding(lines, marks, ax), ax)


def plot_growth(laws: Sequence[GrowthLawResult]) -> Figure:
    """Λ as the growth law predicts it and as measured, and by what they differ."""
    drawable = orbits(laws)
    if not drawable:
        raise InputError("laws", len(laws), "hold no prediction to draw at two step sizes")
    return shown(lambda: growth_figure.draw_predicted_against_measured(drawable))


def plot_table(claim: ClaimResult) -> Figure:
    """A table's lg MSE as it is printed and as it is computed, against the step size."""
    view = ClaimView(claim, anchor="", scene_anchor="", scene_title="")
    printed, computed = rows_of(view) if view.is_table else (figures.Line("", ()), [])
    if len(printed.points) < 2 or not computed:
        raise InputError("claim", claim.id, "is no table with two step sizes to draw")
    return shown(lambda: figures.draw_printed_against_computed(computed, printed))


def plot_work_precision(found: WorkPrecisionResult) -> Figure:
    """Solution error at T against run time in seconds, and against the step size."""
    panels = list(error_panels(found))
    if not panels:
        raise InputError("found", len(found.lines), "hold no run with an error and a run time")
    return shown(lambda: work_figure.draw_panels(panels, f"error at T = {found.time}"))


def plot_stability(over: StabilityMapResult) -> Figure:
    """Verdicts in the plane of step size and stiffness."""
    return shown(lambda: stability_figure.draw_planes([over]))


def plot_flow(flow: FlowResult, plane: int | None = None) -> Figure:
    """A region and its images by each map, q to the right and p upwards, on equal axes.

    `plane`: in n degrees of freedom the k of the plane (q_k, p_k) to which they are projected; that
    in which the region lay, where it is left out.
    """
    if not flow.before or not any(image.outlines for image in flow.images):
        raise InputError("flow", flow.shape, "holds no image to draw")
    degrees = len(flow.point) // 2 or 1
    if plane is not None and not 1 <= plane <= degrees:
        raise InputError("plane", plane, f"must be 1 … {degrees}")
    return shown(lambda: flow_figure.draw_flow(grid_of(flow, plane)))


def shown(draw: Callable[[], Figure], ax: Any = None) -> Figure:
    """The figure on white; what a title says is drawn stands at the vertical axis.

    `ax`: the caller's axes that it is drawn on; nothing else of their figure is touched.
    """
    # What the caller sets in place of our labels may be a formula between dollar signs.
    with styled(**{"figure.facecolor": "white", "axes.facecolor": "white"}):
        figure = draw()
        for axes in figure.axes if ax is None else [ax]:
            for text in (axes.title, axes.xaxis.label, axes.yaxis.label):
                text.set_parse_math(True)
            named = axes.get_title(loc="left")
            if axes.get_ylabel():
                continue
            axes.set_ylabel(re.sub(r"^\([a-z]\) |:.*", "", named))
            if ax is not None or len(figure.axes) == 1:
                axes.set_title("", loc="left")
    return figure
