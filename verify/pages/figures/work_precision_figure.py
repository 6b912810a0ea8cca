"""Error and |Λ| against run time and step size, digits against run time, as inline SVG.

A full mark is limited by truncation, a hollow one by rounding; a cross at the upper edge is a run
that failed; grey dots are the rounding part of each error. A line has its name beside it, if there
is room.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.markers import CARETUPBASE, MarkerStyle
from matplotlib.transforms import Bbox

from verify.pages.figures.axes import (
    DASHES,
    MARKERS,
    draw_grid,
    set_decade_ticks,
    set_whole_number_ticks,
)
from verify.pages.figures.label_place import lies_in
from verify.pages.figures.sheet import INK, SERIES, WIDE, sheet

# In points: the width of a figure of one panel; the heights of a panel and of a row of the legend.
_SINGLE_WIDTH, _PANEL_HEIGHT, _LEGEND_ROW_HEIGHT = 400, 200, 17
_ENTRIES_PER_COLUMN = 2  # those of the legend below each column of panels
_MARKER_SIZE = 5.5
# Markers without a face, as the marks of a peer are neither full nor hollow.
_PEER_MARKERS = ("1", "2", "3", "4")
_LABEL_SIZE = 10
# The offsets in points to try for a name beside its mark.
_OFFSETS = (
    (6, 3), (6, -11), (-6, 3), (-6, -11), (0, 8), (0, -16), (8, -4), (-8, -4), (10, 12), (-10, 12),
    (10, -20), (-10, -20),
)  # fmt: skip
# The greatest visible lg: a greater error says nothing about the orbit, and would flatten others.
_MAX_LG = 4
# The distance in pixels between the points of a line that a label must not cover.
_PIXEL_GAP = 5
_Box = tuple[float, float, float, float]  # x0, y0, x1, y1


@dataclass(frozen=True)
class WorkMark:
    """A point by the finite logarithms of its abscissa and its ordinate.

    `is_full`: True if truncation limits it. `y` is None for a failed run.
    """

    x: float
    y: float | None
    is_full: bool = True


@dataclass(frozen=True)
class DrawnLine:
    """A line of marks.

    `label`: its entry in the legend, if it is in the first panel. `style_index`: the number of its
    style, the same in all panels; peers have styles of their own.
    """

    name: str
    label: str
    marks: tuple[WorkMark, ...]
    style_index: int
    is_peer: bool = False


@dataclass(frozen=True)
class WorkPanel:
    """Lines over one abscissa; `floor` holds the rounding parts as (x, y)."""

    title: str
    axis: str
    lines: tuple[DrawnLine, ...]
    floor: tuple[tuple[float, float], ...] = ()
    is_logarithmic: bool = True

    def is_beyond(self, mark: WorkMark) -> bool:
        """Return True if the value lies above the visible range."""
        return self.is_logarithmic and mark.y is not None and mark.y > _MAX_LG


def draw_panels(panels: Sequence[WorkPanel], quantity: str = "") -> Figure:
    """Draw the panels, two in a row, with one legend for all: the labels of the first panel.

    `quantity`: the label of all vertical axes, if the titles do not suffice.
    """
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    entries = _entries(panels)
    legend_rows = -(-len(entries) // (_ENTRIES_PER_COLUMN * columns))
    width = WIDE if columns > 1 else _SINGLE_WIDTH
    figure = sheet(_PANEL_HEIGHT * rows + _LEGEND_ROW_HEIGHT * legend_rows + 16, width)
    figure.set_dpi(72)
    FigureCanvasAgg(figure)
    engine: Any = figure.get_layout_engine()
    engine.set(hspace=0.04, wspace=0.04)
    all_axes: Any = figure.subplots(rows, columns, squeeze=False).flat
    for axes, panel in zip(all_axes, panels, strict=False):
        _panel(axes, panel)
        axes.set_ylabel(quantity)
    for axes in all_axes[len(panels) :]:
        axes.set_axis_off()
    figure.legend(
        handles=entries, loc="outside lower center", ncols=_ENTRIES_PER_COLUMN * columns,
        handlelength=3.0, columnspacing=1.2, fontsize=10,
    )  # fmt: skip
    # The layout is computed once, and then names are placed where nothing else is.
    engine.execute(figure)
    figure.set_layout_engine("none")
    for axes, panel in zip(all_axes, panels, strict=False):
        _place_names(axes, panel)
    return figure


def style(line: DrawnLine) -> dict[str, Any]:
    """Return colour, marker and dash of a line; with more lines than colours, new pairs of them."""
    index = line.style_index
    if line.is_peer:
        marker = _PEER_MARKERS[index % len(_PEER_MARKERS)]
        return {"color": INK, "marker": marker, "markersize": 7, "linewidth": 0.8}
    shifted = (index + index // len(SERIES)) % len(MARKERS)
    look: dict[str, Any] = {
        "color": SERIES[index % len(SERIES)], "linewidth": 1.2,
        "marker": MARKERS[shifted], "markersize": _MARKER_SIZE,
    }  # fmt: skip
    return look | ({"dashes": DASHES[shifted]} if DASHES[shifted] else {})


# -- one panel ------------------------------------------------------------------------------------


def _panel(axes: Any, panel: WorkPanel) -> None:
    if panel.floor:
        x, y = zip(*panel.floor, strict=True)
        axes.plot(x, y, linestyle="none", marker=".", markersize=3.5, color=INK, alpha=0.4)
    for line in panel.lines:
        _line(axes, panel, line)
    axes.margins(x=0.09, y=0.07)
    # Without a limit, a single value beyond the range would compress all others.
    if any(panel.is_beyond(m) for line in panel.lines for m in line.marks):
        axes.set_ylim(_bottom(panel) - 1, _MAX_LG)
    _mark_edge(axes, panel)
    draw_grid(axes, "both")
    set_decade_ticks(axes.xaxis)
    if panel.is_logarithmic:
        set_decade_ticks(axes.yaxis, max_ticks=8)
    else:
        set_whole_number_ticks(axes.yaxis)
    axes.set_title(panel.title)
    axes.set_xlabel(panel.axis)


def _line(axes: Any, panel: WorkPanel, line: DrawnLine) -> None:
    look = style(line)
    finished = [m for m in line.marks if m.y is not None]
    line_only = {k: v for k, v in look.items() if k not in ("marker", "markersize")}
    axes.plot([m.x for m in finished], [m.y for m in finished], **line_only)
    for is_full in (True, False):
        marks = [m for m in finished if m.is_full is is_full and not panel.is_beyond(m)]
        face = look["color"] if is_full else "none"
        axes.plot(
            [m.x for m in marks], [m.y for m in marks], linestyle="none", color=look["color"],
            marker=look["marker"], markersize=look["markersize"], markerfacecolor=face,
            markeredgewidth=1.1,
        )  # fmt: skip


def _bottom(panel: WorkPanel) -> float:
    heights = [m.y for line in panel.lines for m in line.marks if m.y is not None]
    return min((*heights, *(y for _, y in panel.floor)))


def _mark_edge(axes: Any, panel: WorkPanel) -> None:
    """Mark failed runs by a cross at the upper edge, values beyond it by a caret."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.05 * (high - low))
    for line in panel.lines:
        failed = [m.x for m in line.marks if m.y is None]
        values_beyond = [m.x for m in line.marks if panel.is_beyond(m)]
        for abscissas, marker in ((failed, "x"), (values_beyond, CARETUPBASE)):
            if not abscissas:
                continue  # an unclipped line without points would still take room in the layout
            axes.plot(
                abscissas, [0.985] * len(abscissas), transform=axes.get_xaxis_transform(),
                linestyle="none", marker=marker, markersize=7, markeredgewidth=1.6, clip_on=False,
                color=style(line)["color"],
            )  # fmt: skip


# -- legend ---------------------------------------------------------------------------------------


def _legend_of_marks(panels: Sequence[WorkPanel]) -> list[Line2D]:
    """Return legend entries for the marks that occur."""
    marks = [m for panel in panels for line in panel.lines for m in line.marks]
    has_hollow = any(not m.is_full and m.y is not None for m in marks)
    has_failed = any(m.y is None for m in marks)
    has_values_beyond = any(
        panel.is_beyond(m) for panel in panels for line in panel.lines for m in line.marks
    )
    has_floor = any(panel.floor for panel in panels)
    explanations: tuple[tuple[bool, str, dict[str, Any]], ...] = (
        (has_hollow, "hollow: limited by rounding", {"marker": "o", "markerfacecolor": "none"}),
        (has_failed, "× at the edge: failed", {"marker": "x"}),
        (has_values_beyond, "beyond the edge", {"marker": MarkerStyle(CARETUPBASE)}),
        (has_floor, "floor: rounding part", {"marker": ".", "alpha": 0.4}),
    )
    grey: dict[str, Any] = {"color": INK, "linestyle": "none", "markersize": _MARKER_SIZE}
    return [
        Line2D([], [], label=label, **grey, **look)
        for occurs, label, look in explanations
        if occurs
    ]


def _entries(panels: Sequence[WorkPanel]) -> list[Line2D]:
    lines = [Line2D([], [], label=line.label, **style(line)) for line in panels[0].lines]
    return [*lines, *_legend_of_marks(panels)]


# -- names ----------------------------------------------------------------------------------------


def _place_names(axes: Any, panel: WorkPanel) -> None:
    """Write each line's name near its last mark, or near another; omit it without room."""
    renderer = axes.figure.canvas.get_renderer()
    occupied = [(x - 3, y - 3, x + 3, y + 3) for x, y in _covered_pixels(axes, panel)]
    room = axes.get_window_extent(renderer)
    for line in panel.lines:
        shown_marks = [m for m in line.marks if m.y is not None and not panel.is_beyond(m)]
        text = axes.annotate(
            line.name, (0, 0), xytext=(0, 0), textcoords="offset points",
            fontsize=_LABEL_SIZE, color=style(line)["color"],
        )  # fmt: skip
        marks_in_order = [*shown_marks[-1:], *shown_marks[:1], *shown_marks[1:-1]]
        if not any(_find_room(text, (m.x, m.y), occupied, room, renderer) for m in marks_in_order):
            text.remove()


def _covered_pixels(axes: Any, panel: WorkPanel) -> Iterator[tuple[float, float]]:
    """Yield points under marks, lines and the floor in pixels, a few pixels apart."""
    to_pixels = axes.transData.transform
    for x, y in panel.floor:
        yield tuple(to_pixels((x, y)))
    for line in panel.lines:
        pixels = [tuple(to_pixels((m.x, m.y))) for m in line.marks if m.y is not None]
        yield from pixels
        for (x0, y0), (x1, y1) in pairwise(pixels):
            count = int(max(abs(x1 - x0), abs(y1 - y0)) / _PIXEL_GAP)
            for k in range(1, count):
                yield x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count


def _find_room(
    text: Any, point: tuple[float, float | None], occupied: list[_Box], room: Bbox, renderer: Any
) -> bool:
    """Move the text to the first free offset from the point; return False if there is none."""
    text.xy = point
    for x, y in _OFFSETS:
        text.set_ha("left" if x > 0 else "right" if x < 0 else "center")
        text.set_position((x, y))
        box = text.get_window_extent(renderer)
        x0, y0, x1, y1 = map(float, box.extents)
        if lies_in(box, room) and all(
            x1 < a or c < x0 or y1 < b or d < y0 for a, b, c, d in occupied
        ):  # as `Bbox.overlaps`, which takes ten times as long
            occupied.append((x0, y0, x1, y1))
            return True
    return False
