"""Panels side by side, as SVG: their places, and the labels that several of them share."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import draw_grid, set_round_ticks
from verify.pages.figures.notebook_figure import NARROW, WIDE, sheet


def make_panels(
    count: int, *, in_a_row: int, height: float, legend_height: float = 0, shared: bool = True
) -> tuple[Figure, Any]:
    """Return a figure with `count` panels in rows of `height`, and an array of all their axes.

    Places that stay empty show no axes. `legend_height`: the height of the legend below the panels;
    `shared`: True if all panels have the same axes.
    """
    columns = min(count, in_a_row)
    rows = -(-count // columns)
    figure = sheet(height * rows + legend_height, WIDE if columns > 1 else NARROW)
    panels: Any = figure.subplots(rows, columns, sharex=shared, sharey=shared, squeeze=False)
    for axes in panels.flat[count:]:
        axes.set_axis_off()
    return figure, panels


def name_states(panels: Any, titles: Sequence[str], names: Sequence[str], room: float) -> None:
    """Set the titles of the panels and the names of their coordinates, with round numbers."""
    for axes, title in zip(panels.flat, titles, strict=False):
        axes.set_title(title)
        axes.set_xlabel(names[0])
        axes.margins(room)
        set_round_ticks(axes)
        axes.tick_params(labelbottom=True)
        draw_grid(axes, "both")
    for row in panels:
        row[0].set_ylabel(names[1], rotation=0, labelpad=10)


def name_marks(figure: Figure, panels: Any, ncols: int) -> None:
    """Set one legend below all panels, with each mark once."""
    handles = {
        label: handle
        for axes in panels.flat
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(
        handles.values(), handles, loc="outside lower center", ncols=ncols, handlelength=1.6
    )
