"""Panels side by side, as SVG: their places, and the names of what several of them share."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure

from verify.pages.figures.axes import grid_lines, round_numbers
from verify.pages.figures.notebook_figure import NARROW, WIDE, sheet


def panels_beside(
    count: int, *, in_a_row: int, height: float, beside: float = 0, shared: bool = True
) -> tuple[Figure, Any]:
    """A figure with so many panels in rows of one `height`, and all the places there are.

    Those that stay empty have no axes. `beside`: height of what is below the panels; `shared`:
    whether all have the same axes.
    """
    columns = min(count, in_a_row)
    rows = -(-count // columns)
    figure = sheet(height * rows + beside, WIDE if columns > 1 else NARROW)
    panels: Any = figure.subplots(rows, columns, sharex=shared, sharey=shared, squeeze=False)
    for axes in panels.flat[count:]:
        axes.set_axis_off()
    return figure, panels


def name_states(panels: Any, titles: Sequence[str], names: Sequence[str], room: float) -> None:
    """Names the panels and the coordinates to the right and upwards, with round numbers."""
    for axes, title in zip(panels.flat, titles, strict=False):
        axes.set_title(title)
        axes.set_xlabel(names[0])
        axes.margins(room)
        round_numbers(axes)
        axes.tick_params(labelbottom=True)
        grid_lines(axes, "both")
    for row in panels:
        row[0].set_ylabel(names[1], rotation=0, labelpad=10)


def name_marks(figure: Figure, panels: Any, ncols: int) -> None:
    """One legend below all panels, each mark in it once."""
    named = {
        label: handle
        for axes in panels.flat
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(named.values(), named, loc="outside lower center", ncols=ncols, handlelength=1.6)
