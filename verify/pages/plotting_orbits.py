"""Plots of orbits: a quantity or the drift of H̃ over t, or the states in the plane."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from verify.errors import InputError, unknown_name
from verify.notebook import cut
from verify.pages.figures.axes import draw_grid, line_style, set_scaled_ticks, set_time_axis
from verify.pages.figures.notebook_figure import canvas_on, legend
from verify.pages.plotting import restyle_for_caller
from verify.pages.text.typography import superscript
from verify.scenes.results.run import EnergyDrift, RunResult

PHASE = "phase"
QUANTITIES = {
    "energy_error": "H − H₀",
    "solution_error": "solution error",
    "lambda": "Λ",
    "delta_j": "ΔJ",
    "p": "p",
    "q": "q",
    PHASE: "p",  # against q
}
_DRIFT = "drift"
_UPWARDS = QUANTITIES | {_DRIFT: "|H̃ − H̃₀|"}
_LOGARITHMIC = ("solution_error", _DRIFT)
# Heights in points of a plot over time and of a phase portrait.
_HEIGHT, _SQUARE = 280, 380
# Characters of a scheme's formula in a label.
_LABEL = 40


def plot_orbit(
    runs: RunResult | Sequence[RunResult], quantity: str = "energy_error", *, ax: Any = None
) -> Figure:
    """Plot a quantity of the states of one or several runs over t, or a phase portrait.

    `quantity`: energy_error, H − H₀; solution_error, |z − φ_t(z₀)| at 200 states at most, on a
    logarithmic axis; lambda; delta_j; p; q; or phase, p against q. `ax`: the axes to draw on, whose
    figure is then returned. A run's `points` say how many of its states there are. Raises
    InputError where there is nothing to draw.

    The solution error is the distance from the exact solution, in closed form where one exists.
    """
    if quantity not in QUANTITIES:
        raise unknown_name("quantity", quantity, QUANTITIES)
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
    """Return a label of the run that says how it differs from the others: scheme, h, start."""
    parts = {
        "": run.scheme if len(run.scheme) <= _LABEL else cut(run.scheme)[:_LABEL] + "…",
        "h": run.step_size,
        "q": run.start_text("q"),
        "p": run.start_text("p"),
    }
    # An input that is the same for all runs does not tell them apart, and is left out of the label.
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
    # What is exactly 0, as at the start, has no logarithm.
    return [float(t) for t in drift.t], [abs(x) if x else float("nan") for x in drift.values]


def _drift_label(run: RunResult, among: Sequence[RunResult], power: int) -> str:
    name = "H" if power == 0 else f"H̃ to h{superscript(power)}"
    return name if len(among) == 1 else f"{label_run(run, among)}: {name}"


def _draw(lines: Sequence[tuple[str, Any, Any]], quantity: str, ax: Any) -> Figure:
    figure, axes = canvas_on(ax, _SQUARE if quantity == PHASE else _HEIGHT)
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
    axes.set_ylabel(_UPWARDS[quantity])
    legend(figure if ax is None else None, axes, ncols=2)
    return figure
