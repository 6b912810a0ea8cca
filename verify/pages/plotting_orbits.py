"""Orbits drawn: a quantity or the drift of H̃ over t, or the states in the plane."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from verify.errors import InputError, unknown
from verify.notebook import cut
from verify.pages.figures.axes import grid_lines, line_style, scaled_ticks, time_axis
from verify.pages.figures.notebook_figure import canvas_on, legend
from verify.pages.plotting import shown
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
_HEIGHT, _SQUARE = 280, 380  # points
_LABEL = 40  # characters of a scheme


def plot_orbit(
    runs: RunResult | Sequence[RunResult], quantity: str = "energy_error", *, ax: Any = None
) -> Figure:
    """A quantity of the states of one run or several over t, or a phase portrait.

    `quantity`: energy_error, H − H₀; solution_error, |z − φ_t(z₀)| at 200 states at most, on a
    logarithmic axis; lambda; delta_j; p; q; or phase, p against q. `ax`: axes to draw it on, whose
    figure is then given back. A run's `points` say how many of its states there are. Raises
    InputError where there is nothing to draw.

    The solution error is held to the exact solution, in closed form where one is known.
    """
    if quantity not in QUANTITIES:
        raise unknown("quantity", quantity, QUANTITIES)
    given = _listed(runs)
    lines = [(label_of(run, given), *_points(run, quantity)) for run in given]
    return shown(lambda: _draw(lines, quantity, ax), ax)


def _listed(runs: RunResult | Sequence[RunResult]) -> list[RunResult]:
    given = [runs] if isinstance(runs, RunResult) else list(runs)
    if not given or not all(isinstance(run, RunResult) for run in given):
        raise InputError("runs", runs, "is no RunResult, and no list of them")
    return given


def _points(run: RunResult, quantity: str) -> tuple[Any, Any]:
    """What is drawn to the right, and upwards."""
    if quantity == "solution_error":
        found = run.solution_errors()
        return [float(t) for t, _ in found], [float(error) or float("nan") for _, error in found]
    orbit = run.orbit
    if quantity == PHASE:
        return orbit.q, orbit.p
    return orbit.t, getattr(orbit, "lambda_" if quantity == "lambda" else quantity)


def label_of(run: RunResult, among: Sequence[RunResult]) -> str:
    """By what the runs differ: scheme, h, the start."""
    parts = {
        "": run.scheme if len(run.scheme) <= _LABEL else cut(run.scheme)[:_LABEL] + "…",
        "h": run.step_size,
        "q": run.start_text("q"),
        "p": run.start_text("p"),
    }
    keys = {"": "scheme", "h": "step_size", "q": "q", "p": "p"}
    kept = [n for n in parts if n == "" or len({getattr(x, keys[n]) for x in among}) > 1]
    return ", ".join(f"{n} = {parts[n]}" if n else parts[n] for n in kept)


def plot_energy_drift(
    runs: RunResult | Sequence[RunResult], order: int = 4, *, ax: Any = None
) -> Figure:
    """|H − H₀| and |H̃ − H̃₀| of one run or several over t, on a logarithmic axis.

    One line for H and one for H̃ with each term up to h^order that is not 0: a symplectic scheme
    keeps H̃ the better the more terms it has, down to the rounding of the run. 1,000 states at most.
    `ax`: axes to draw it on, whose figure is then given back. Raises InputError for a scheme that
    has no modified Hamiltonian but H, as one that is not symplectic.
    """
    given = _listed(runs)
    lines = [
        (_drift_label(run, given, drift.power), *_drift_points(drift))
        for run in given
        for drift in run.energy_drifts(order)
    ]
    return shown(lambda: _draw(lines, _DRIFT, ax), ax)


def _drift_points(drift: EnergyDrift) -> tuple[list[float], list[float]]:
    # What is exactly 0, as at the start, has no logarithm.
    return [float(t) for t in drift.t], [abs(x) if x else float("nan") for x in drift.values]


def _drift_label(run: RunResult, among: Sequence[RunResult], power: int) -> str:
    name = "H" if power == 0 else f"H̃ to h{superscript(power)}"
    return name if len(among) == 1 else f"{label_of(run, among)}: {name}"


def _draw(lines: Sequence[tuple[str, Any, Any]], quantity: str, ax: Any) -> Figure:
    figure, axes = canvas_on(ax, _SQUARE if quantity == PHASE else _HEIGHT)
    for index, (label, x, y) in enumerate(lines):
        style = line_style(index, len(lines)) | {"marker": "", "linewidth": 1.1}
        axes.plot(x, y, label=label, **style)
    if quantity == PHASE:
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("q")
    else:
        time_axis(axes)
        if quantity in _LOGARITHMIC:
            axes.set_yscale("log")
        else:
            scaled_ticks(axes.yaxis, *axes.get_ylim())
    grid_lines(axes, "both" if quantity == PHASE else "y")
    axes.set_ylabel(_UPWARDS[quantity])
    legend(figure if ax is None else None, axes, ncols=2)
    return figure
