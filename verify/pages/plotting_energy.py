"""The drift of H and of the modified Hamiltonian along runs, drawn."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from verify.errors import InputError
from verify.pages.figures.axes import grid_lines, line_style, time_axis
from verify.pages.figures.notebook_figure import canvas_on, legend
from verify.pages.plotting import shown
from verify.pages.plotting_orbits import label_of
from verify.pages.text.typography import superscript
from verify.scenes.results.energy_drift import EnergyDrift
from verify.scenes.results.run import RunResult

_HEIGHT = 280  # points


def plot_energy_drift(
    runs: RunResult | Sequence[RunResult], order: int = 4, *, ax: Any = None
) -> Figure:
    """|H − H₀| and |H̃ − H̃₀| of one run or several over t, on a logarithmic axis.

    One line for H and one for H̃ with each term up to h^order that is not 0: a symplectic scheme
    keeps H̃ the better the more terms it has, down to the rounding of the run. 1,000 states at most.
    `ax`: axes to draw it on, whose figure is then given back. Raises InputError for a scheme that
    has no modified Hamiltonian but H, as one that is not symplectic.
    """
    given = [runs] if isinstance(runs, RunResult) else list(runs)
    if not given or not all(isinstance(run, RunResult) for run in given):
        raise InputError("runs", runs, "is no RunResult, and no list of them")
    lines = [
        (_label(run, given, drift.power), drift)
        for run in given
        for drift in run.energy_drifts(order)
    ]
    return shown(lambda: _draw(lines, ax), ax)


def _label(run: RunResult, among: Sequence[RunResult], power: int) -> str:
    name = "H" if power == 0 else f"H̃ to h{superscript(power)}"
    return name if len(among) == 1 else f"{label_of(run, among)}: {name}"


def _draw(lines: Sequence[tuple[str, EnergyDrift]], ax: Any) -> Figure:
    figure, axes = canvas_on(ax, _HEIGHT)
    for index, (label, drift) in enumerate(lines):
        style = line_style(index, len(lines)) | {"marker": "", "linewidth": 1.1}
        # What is exactly 0, as at the start, has no logarithm.
        sizes = [abs(x) if x else float("nan") for x in drift.values]
        axes.plot([float(t) for t in drift.t], sizes, label=label, **style)
    time_axis(axes)
    axes.set_yscale("log")
    axes.set_ylabel("|H̃ − H̃₀|")
    grid_lines(axes, "y")
    legend(figure if ax is None else None, axes, ncols=2)
    return figure
