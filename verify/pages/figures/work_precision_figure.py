"""Error and |Λ| against run time and step size, digits against run time, as inline SVG.

Full marks are limited by truncation, hollow ones by rounding; a cross at the upper edge is a run
that failed; grey dots are the rounding part of each error. A line has its name beside it, where
there is room.
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

from verify.pages.figures.axes import DASHES, MARKERS, decades, grid_lines, whole_numbers
from verify.pages.figures.label_place import within
from verify.pages.figures.notebook_figure import WIDE, sheet
from verify.pages.figures.svg import INK, SERIES

_WIDTH = 400
_PANEL, _LEGEND_ROW, _IN_A_ROW = 200, 17, 2
_SIZE = 5.5
_PEER_MARKERS = ("1", "2", "3", "4")  # without a face: a peer's marks are neither full nor hollow
_LABEL = 10
_OFFSETS = (
    (6, 3), (6, -11), (-6, 3), (-6, -11), (0, 8), (0, -16), (8, -4), (-8, -4), (10, 12), (-10, 12),
    (10, -20), (-10, -20),
)  # fmt: skip
_TOP = 4  # decades: an error or a Λ beyond that is no longer about the orbit, and hides the others
_APART = 5  # pixels between places of a line that a label must not cover
_Box = tuple[float, float, float, float]  # x0, y0, x1, y1


@dataclass(frozen=True)
class Mark:
    """A point, by finite logarithms: of the abscissa and of the ordinate.

    `full`: limited by truncation. A failed run has no `y`.
    """

    x: float
    y: float | None
    full: bool = True


@dataclass(frozen=True)
class DrawnLine:
    """One line of marks. `label`: its entry in the legend, which is that of the first panel.
    `place`: which of the looks it has, the same in every figure; those of peers are apart."""

    name: str
    label: str
    marks: tuple[Mark, ...]
    place: int
    peer: bool = False


@dataclass(frozen=True)
class Panel:
    """Lines over one abscissa; `floor` holds the rounding parts as (x, y)."""

    title: str
    axis: str
    lines: tuple[DrawnLine, ...]
    floor: tuple[tuple[float, float], ...] = ()
    logarithmic: bool = True

    def beyond(self, mark: Mark) -> bool:
        """Whether the value lies above what is shown."""
        return self.logarithmic and mark.y is not None and mark.y > _TOP


def draw_panels(shown: Sequence[Panel], quantity: str = "") -> Figure:
    """The panels, two in a row, with one legend for all: the labels of the first.

    `quantity`: what stands at all vertical axes, where the titles do not suffice.
    """
    columns = min(2, len(shown))
    rows = -(-len(shown) // columns)
    entries = _entries(shown)
    legend_rows = -(-len(entries) // (_IN_A_ROW * columns))
    width = WIDE if columns > 1 else _WIDTH
    figure = sheet(_PANEL * rows + _LEGEND_ROW * legend_rows + 16, width)
    figure.set_dpi(72)
    FigureCanvasAgg(figure)
    engine: Any = figure.get_layout_engine()
    engine.set(hspace=0.04, wspace=0.04)
    all_axes: Any = figure.subplots(rows, columns, squeeze=False).flat
    for axes, panel in zip(all_axes, shown, strict=False):
        _panel(axes, panel)
        axes.set_ylabel(quantity)
    for axes in all_axes[len(shown) :]:
        axes.set_axis_off()
    figure.legend(
        handles=entries, loc="outside lower center", ncols=_IN_A_ROW * columns,
        handlelength=3.0, columnspacing=1.2, fontsize=10,
    )  # fmt: skip
    # The layout is made once, so that names can be placed where nothing else is.
    engine.execute(figure)
    figure.set_layout_engine("none")
    for axes, panel in zip(all_axes, shown, strict=False):
        _place_names(axes, panel)
    return figure


def style(line: DrawnLine) -> dict[str, Any]:
    """Colour, mark and dash of a line; beyond the colours they combine anew."""
    index = line.place
    if line.peer:
        marker = _PEER_MARKERS[index % len(_PEER_MARKERS)]
        return {"color": INK, "marker": marker, "markersize": 7, "linewidth": 0.8}
    shifted = (index + index // len(SERIES)) % len(MARKERS)
    found: dict[str, Any] = {
        "color": SERIES[index % len(SERIES)], "marker": MARKERS[shifted], "markersize": _SIZE,
        "linewidth": 1.2,
    }  # fmt: skip
    return found | ({"dashes": DASHES[shifted]} if DASHES[shifted] else {})


# -- one panel ------------------------------------------------------------------------------------


def _panel(axes: Any, panel: Panel) -> None:
    if panel.floor:
        x, y = zip(*panel.floor, strict=True)
        axes.plot(x, y, linestyle="none", marker=".", markersize=3.5, color=INK, alpha=0.4)
    for line in panel.lines:
        _line(axes, panel, line)
    axes.margins(x=0.09, y=0.07)
    if any(panel.beyond(m) for line in panel.lines for m in line.marks):
        axes.set_ylim(_bottom(panel) - 1, _TOP)
    _at_the_edge(axes, panel)
    grid_lines(axes, "both")
    decades(axes.xaxis)
    if panel.logarithmic:
        decades(axes.yaxis, most=8)
    else:
        whole_numbers(axes.yaxis)
    axes.set_title(panel.title)
    axes.set_xlabel(panel.axis)


def _line(axes: Any, panel: Panel, line: DrawnLine) -> None:
    look = style(line)
    known = [m for m in line.marks if m.y is not None]
    bare = {k: v for k, v in look.items() if k not in ("marker", "markersize")}
    axes.plot([m.x for m in known], [m.y for m in known], **bare)
    for full in (True, False):
        marks = [m for m in known if m.full is full and not panel.beyond(m)]
        face = look["color"] if full else "none"
        axes.plot(
            [m.x for m in marks], [m.y for m in marks], linestyle="none", color=look["color"],
            marker=look["marker"], markersize=look["markersize"], markerfacecolor=face,
            markeredgewidth=1.1,
        )  # fmt: skip


def _bottom(panel: Panel) -> float:
    placed = [m.y for line in panel.lines for m in line.marks if m.y is not None]
    return min((*placed, *(y for _, y in panel.floor)))


def _at_the_edge(axes: Any, panel: Panel) -> None:
    """At the upper edge a cross where a run failed, a caret where a value lies beyond it."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.05 * (high - low))
    for line in panel.lines:
        failed = [m.x for m in line.marks if m.y is None]
        beyond = [m.x for m in line.marks if panel.beyond(m)]
        for places, marker in ((failed, "x"), (beyond, CARETUPBASE)):
            if not places:
                continue  # an unclipped line without points would still ask for room
            axes.plot(
                places, [0.985] * len(places), transform=axes.get_xaxis_transform(),
                linestyle="none", marker=marker, markersize=7, markeredgewidth=1.6, clip_on=False,
                color=style(line)["color"],
            )  # fmt: skip


# -- legend ---------------------------------------------------------------------------------------


def _explained(shown: Sequence[Panel]) -> list[Line2D]:
    """What the marks mean, as far as they occur."""
    marks = [m for panel in shown for line in panel.lines for m in line.marks]
    hollow = any(not m.full and m.y is not None for m in marks)
    failed = any(m.y is None for m in marks)
    beyond = any(panel.beyond(m) for panel in shown for line in panel.lines for m in line.marks)
    floor = any(panel.floor for panel in shown)
    known: tuple[tuple[bool, str, dict[str, Any]], ...] = (
        (hollow, "hollow: limited by rounding", {"marker": "o", "markerfacecolor": "none"}),
        (failed, "× at the edge: failed", {"marker": "x"}),
        (beyond, "beyond the edge", {"marker": MarkerStyle(CARETUPBASE)}),
        (floor, "floor: rounding part", {"marker": ".", "alpha": 0.4}),
    )
    grey: dict[str, Any] = {"color": INK, "linestyle": "none", "markersize": _SIZE}
    return [Line2D([], [], label=label, **grey, **look) for seen, label, look in known if seen]


def _entries(shown: Sequence[Panel]) -> list[Line2D]:
    lines = [Line2D([], [], label=line.label, **style(line)) for line in shown[0].lines]
    return [*lines, *_explained(shown)]


# -- names ----------------------------------------------------------------------------------------


def _place_names(axes: Any, panel: Panel) -> None:
    """Each name near its line's last mark, or its first, or between, where it covers nothing."""
    renderer = axes.figure.canvas.get_renderer()
    taken = [(x - 3, y - 3, x + 3, y + 3) for x, y in _covered(axes, panel)]
    inside = axes.get_window_extent(renderer)
    for line in panel.lines:
        seen = [m for m in line.marks if m.y is not None and not panel.beyond(m)]
        text = axes.annotate(
            line.name, (0, 0), xytext=(0, 0), textcoords="offset points",
            fontsize=_LABEL, color=style(line)["color"],
        )  # fmt: skip
        ends = [*seen[-1:], *seen[:1], *seen[1:-1]]
        if not any(_settles(text, (m.x, m.y), taken, inside, renderer) for m in ends):
            text.remove()


def _covered(axes: Any, panel: Panel) -> Iterator[tuple[float, float]]:
    """Pixels under marks, lines and the floor, a few apart."""
    to_pixels = axes.transData.transform
    for x, y in panel.floor:
        yield tuple(to_pixels((x, y)))
    for line in panel.lines:
        places = [tuple(to_pixels((m.x, m.y))) for m in line.marks if m.y is not None]
        yield from places
        for (x0, y0), (x1, y1) in pairwise(places):
            count = int(max(abs(x1 - x0), abs(y1 - y0)) / _APART)
            for k in range(1, count):
                yield x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count


def _settles(
    text: Any, at: tuple[float, float | None], taken: list[_Box], inside: Bbox, renderer: Any
) -> bool:
    text.xy = at
    for x, y in _OFFSETS:
        text.set_ha("left" if x > 0 else "right" if x < 0 else "center")
        text.set_position((x, y))
        box = text.get_window_extent(renderer)
        x0, y0, x1, y1 = map(float, box.extents)
        if within(box, inside) and all(
            x1 < a or c < x0 or y1 < b or d < y0 for a, b, c, d in taken
        ):  # as matplotlib's Bbox.overlaps says, which takes ten times as long
            taken.append((x0, y0, x1, y1))
            return True
    return False
