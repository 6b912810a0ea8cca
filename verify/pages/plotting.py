"""The figures of a report as matplotlib figures, to show, to restyle and to save.

Each function returns a `matplotlib.figure.Figure` on white; the caller may change `figure.axes` and
everything on them. Most functions that draw a single plot take `ax`, the axes to draw it on, and
then return their figure. For figures over the step size or the run time logarithms are taken before
anything is drawn, so that 1e-500 has a place too: the data are decimal logarithms, and the ticks
say 10ⁿ. All quantities are without units. If there is nothing to draw, InputError is raised.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from matplotlib.figure import Figure

from verify import observables
from verify.arithmetic.exact import decimal
from verify.errors import InputError, unknown_name
from verify.notebook import cut
from verify.pages.figures import flow_figure, kind_map_figure, over_time_figure
from verify.pages.figures import step_size_figures as size_figures
from verify.pages.figures import work_precision_figure as work_figure
from verify.pages.figures.axes import draw_grid, line_style, set_scaled_ticks, set_time_axis
from verify.pages.figures.captioned_plot import lg
from verify.pages.figures.flow_grid import grid_of
from verify.pages.figures.sheet import canvas_on, draw_legend, restyle_for_caller
from verify.pages.figures.work_precision_plots import error_panels
from verify.pages.sections.page_contents import ClaimView, rows_of
from verify.pages.sections.scheme.growth import select_drawable
from verify.pages.text.typography import superscript
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.growth import GrowthLawResult
from verify.scenes.results.regions import FlowResult
from verify.scenes.results.run import EnergyDrift, RunResult
from verify.scenes.results.separation import SeparationGrid
from verify.scenes.results.stability import StabilityMapResult
from verify.scenes.results.work_precision import WorkPrecisionResult

# The quantities of runs against the step size, with their labels.
QUANTITIES = {
    **{
        name: observable.plotted or observable.label
        for name, observable in observables.by_name().items()
    },
    "energy_error": "max |H − H₀|",
    "solution_error": "solution error",
}
PHASE = "phase"
# The quantities of one run over time, with their labels.
ORBIT_QUANTITIES = {
    "energy_error": "H − H₀",
    "solution_error": "solution error",
    "lambda": "Λ",
    "delta_j": "ΔJ",
    "p": "p",
    "q": "q",
    PHASE: "p",  # against q
}
_DRIFT = "drift"
_VERTICAL_LABELS = ORBIT_QUANTITIES | {_DRIFT: "|H̃ − H̃₀|"}
_LOGARITHMIC = ("solution_error", _DRIFT)
# Heights in points of a plot over time and of a phase portrait.
_TIME_HEIGHT, _PHASE_HEIGHT = 280, 380
# The limit on characters of a scheme's formula in a label.
_MAX_LABEL = 40


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
    `ax`: the axes to draw on. Raises InputError for another quantity, or if no line has two
    step sizes.
    """
    if quantity not in QUANTITIES:
        raise unknown_name("quantity", quantity, QUANTITIES)
    runs = list(runs)
    height_of = _LG_FUNCTIONS.get(quantity)
    schemes = dict.fromkeys(run.scheme for run in runs)
    lines = [
        size_figures.LogarithmicLine(
            f"{scheme}, {line.label}" if len(schemes) > 1 else line.label, line.points
        )
        for scheme in schemes
        for scheme_runs in [[run for run in runs if run.scheme == scheme]]
        for line in (
            size_figures.lines_of(scheme_runs, height_of)
            if height_of
            else size_figures.lines(scheme_runs, quantity)
        )
    ]
    if not lines:
        raise InputError("runs", len(runs), f"hold no {quantity} to draw at two step sizes or more")
    panel = size_figures.QuantityPanel(QUANTITIES[quantity], lines, slopes)
    return restyle_for_caller(lambda: size_figures.draw_against_step_size([panel], ax), ax)


def _lg_energy_error(run: RunResult) -> float:
    sizes = (abs(Fraction(text)) for text in run.orbit.texts("energy_error") if text)
    return lg(decimal(max(sizes, default=Fraction(0)), 7))


def _lg_solution_error(run: RunResult) -> float:
    return lg(run.solution_errors(1)[-1][1].value)


_LG_FUNCTIONS = {"energy_error": _lg_energy_error, "solution_error": _lg_solution_error}


def plot_over_time(run: RunResult) -> Figure:
    """Plot ΔJ = det J − 1 and Λ over t, as bands between extremes, for a run with a series.

    `run`: a RunResult, made with `points`. Returns a figure with a panel for each of the two.
    Raises InputError if the run holds no series.
    """
    if not run.series:
        raise InputError("run", run.scheme, "holds no series; run(…, points=400) keeps one")
    panels = over_time_figure.OrbitPanels("", ((run, "delta_j"), (run, "lam")))
    return restyle_for_caller(lambda: over_time_figure.draw_over_time([panels]))


def plot_separation(grid: SeparationGrid, *, ax: Any = None) -> Figure:
    """Plot the greatest |truncation| and |rounding| in Λ against the step size, with crossovers.

    `grid`: the result of `separate_grid` in the plane. `ax`: the axes to draw on, whose figure is
    then returned. Raises InputError unless both parts are known at two step sizes.
    """
    lines, marks = size_figures.lines_and_marks(grid)
    if len(lines) < 2:
        raise InputError(
            "grid", len(grid.points), "does not hold truncation and rounding at two step sizes"
        )
    return restyle_for_caller(
        lambda: size_figures.draw_truncation_against_rounding(lines, marks, ax), ax
    )


def plot_growth(laws: Sequence[GrowthLawResult]) -> Figure:
    """Plot Λ as predicted by the growth law and as measured, and their difference."""
    drawable = select_drawable(laws)
    if not drawable:
        raise InputError("laws", len(laws), "hold no prediction to draw at two step sizes")
    return restyle_for_caller(lambda: size_figures.draw_predicted_against_measured(drawable))


def plot_table(claim: ClaimResult) -> Figure:
    """Plot the lg MSE of a table, as printed and as computed, against the step size."""
    view = ClaimView(claim, anchor="", scene_anchor="", scene_title="")
    printed, computed_lines = rows_of(view) if view.is_table else (None, [])
    if printed is None or len(printed.points) < 2 or not computed_lines:
        raise InputError("claim", claim.id, "is no table with two step sizes to draw")
    return restyle_for_caller(
        lambda: size_figures.draw_printed_against_computed(computed_lines, printed)
    )


def plot_work_precision(found: WorkPrecisionResult) -> Figure:
    """Plot the solution error at T against run time in seconds, and against the step size.

    `found`: the result of `bench`. All axes are logarithmic; points limited by rounding are hollow.
    Returns a figure with the two panels. Raises InputError if no run has an error and a time.
    """
    panels = list(error_panels(found))
    if not panels:
        raise InputError("found", len(found.lines), "hold no run with an error and a run time")
    return restyle_for_caller(lambda: work_figure.draw_panels(panels, f"error at T = {found.time}"))


def plot_stability(over: StabilityMapResult) -> Figure:
    """Plot the verdicts on runs over the step size and a parameter of H."""
    return restyle_for_caller(lambda: kind_map_figure.draw_planes([over]))


def plot_flow(flow: FlowResult, plane: int | None = None) -> Figure:
    """Plot a region and its images by each map, q to the right and p upwards, on equal axes.

    `plane`: in n degrees of freedom, the k of the plane (q_k, p_k) on which they are projected, by
    default that of the region. Raises InputError if there is no image, or no such plane.
    """
    if not flow.before or not any(image.outlines for image in flow.images):
        raise InputError("flow", flow.shape, "holds no image to draw")
    degrees = len(flow.point) // 2 or 1
    if plane is not None and not 1 <= plane <= degrees:
        raise InputError("plane", plane, f"must be 1 … {degrees}")
    return restyle_for_caller(lambda: flow_figure.draw_flow(grid_of(flow, plane)))


# -- orbits over time, and in the plane -----------------------------------------------------------


def plot_orbit(
    runs: RunResult | Sequence[RunResult], quantity: str = "energy_error", *, ax: Any = None
) -> Figure:
    """Plot a quantity of the states of one or several runs over t, or a phase portrait.

    `quantity`: energy_error, H − H₀; solution_error, |z − φ_t(z₀)| at 200 states at most, on a
    logarithmic axis, with φ_t in closed form if one exists; lambda; delta_j; p; q; or phase, p
    against q. `ax`: the axes to draw on, whose figure is then returned. A run's `points` say how
    many of its states there are. Raises InputError if there is nothing to draw.
    """
    if quantity not in ORBIT_QUANTITIES:
        raise unknown_name("quantity", quantity, ORBIT_QUANTITIES)
    run_list = _as_run_list(runs)
    lines = [(label_run(run, run_list), *_curve_of(run, quantity)) for run in run_list]
    return restyle_for_caller(lambda: _draw(lines, quantity, ax), ax)


def _as_run_list(runs: RunResult | Sequence[RunResult]) -> list[RunResult]:
    run_list = [runs] if isinstance(runs, RunResult) else list(runs)
    if not run_list or not all(isinstance(run, RunResult) for run in run_list):
        raise InputError("runs", runs, "is no RunResult, and no list of them")
    return run_list


def _curve_of(run: RunResult, quantity: str) -> tuple[Any, Any]:
    """Return the abscissas and the ordinates of the curve."""
    if quantity == "solution_error":
        errors = run.solution_errors()
        return [float(t) for t, _ in errors], [float(error) or float("nan") for _, error in errors]
    orbit = run.orbit
    if quantity == PHASE:
        return orbit.q, orbit.p
    return orbit.t, getattr(orbit, "lambda_" if quantity == "lambda" else quantity)


def label_run(run: RunResult, among: Sequence[RunResult]) -> str:
    """Return a label of the run: its scheme, and those of h, q and p that differ among the runs."""
    parts = {
        "": run.scheme if len(run.scheme) <= _MAX_LABEL else cut(run.scheme)[:_MAX_LABEL] + "…",
        "h": run.step_size,
        "q": run.start_text("q"),
        "p": run.start_text("p"),
    }
    keys = {"": "scheme", "h": "step_size", "q": "q", "p": "p"}
    names = [n for n in parts if n == "" or len({getattr(x, keys[n]) for x in among}) > 1]
    return ", ".join(f"{n} = {parts[n]}" if n else parts[n] for n in names)


def plot_energy_drift(
    runs: RunResult | Sequence[RunResult], order: int = 4, *, ax: Any = None
) -> Figure:
    """Plot |H − H₀| and |H̃ − H̃₀| of one or several runs over t, on a logarithmic axis.

    There is a line for H and one for H̃ with each further term up to h^order that is not 0: the more
    terms H̃ has, the better a symplectic scheme conserves it, down to the rounding of the run. At
    most 1,000 states are used. `ax`: the axes to draw on, whose figure is then returned. Raises
    InputError for a scheme without a modified Hamiltonian, such as one that is not symplectic.
    """
    run_list = _as_run_list(runs)
    lines = [
        (_drift_label(run, run_list, drift.power), *_drift_points(drift))
        for run in run_list
        for drift in run.energy_drifts(order)
    ]
    return restyle_for_caller(lambda: _draw(lines, _DRIFT, ax), ax)


def _drift_points(drift: EnergyDrift) -> tuple[list[float], list[float]]:
    # A drift of exactly 0, as at the start, has no logarithm.
    return [float(t) for t in drift.t], [abs(x) if x else float("nan") for x in drift.values]


def _drift_label(run: RunResult, among: Sequence[RunResult], power: int) -> str:
    name = "H" if power == 0 else f"H̃ to h{superscript(power)}"
    return name if len(among) == 1 else f"{label_run(run, among)}: {name}"


def _draw(lines: Sequence[tuple[str, Any, Any]], quantity: str, ax: Any) -> Figure:
    figure, axes = canvas_on(ax, _PHASE_HEIGHT if quantity == PHASE else _TIME_HEIGHT)
    for index, (label, x, y) in enumerate(lines):
        style = line_style(index, len(lines)) | {"marker": "", "linewidth": 1.1}
        axes.plot(x, y, label=label, **style)
    if quantity == PHASE:
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("q")
    else:
        set_time_axis(axes)
        if quantity in _LOGARITHMIC:
            axes.set_yscale("log")
        else:
            set_scaled_ticks(axes.yaxis, *axes.get_ylim())
    draw_grid(axes, "both" if quantity == PHASE else "y")
    axes.set_ylabel(_VERTICAL_LABELS[quantity])
    draw_legend(figure if ax is None else None, axes, ncols=2)
    return figure
