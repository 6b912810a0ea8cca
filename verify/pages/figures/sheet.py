"""Empty figures in the page's style: colours, settings, sizes in points, and a legend.

A notebook displays such a figure without pyplot.
"""

import io
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Literal

import matplotlib
from matplotlib.figure import Figure

INK = "#010203"
# The colours of Okabe and Ito, the pale ones darkened; style.css has those of the dark theme.
SERIES = ("#0072b2", "#c44e00", "#00805c", "#a5407f", "#7a6200", "#2f6fd0", "#8a3ffc", "#5b6670")

FONT_SIZE = 12  # points
# These and matplotlib's defaults hold in place of the user's matplotlibrc.
_SETTINGS: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "areaproof",
    "font.family": "DejaVu Sans",
    "font.size": FONT_SIZE,
    "axes.titlesize": FONT_SIZE,
    "axes.titlelocation": "left",
    "axes.labelsize": FONT_SIZE,
    "legend.fontsize": 11,
    "text.color": INK,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "legend.frameon": False,
    "mathtext.default": "regular",
    "text.usetex": False,
    "text.parse_math": False,  # a name or a source with dollar signs stays text
    "path.simplify": False,
}
# Inches in a point, which is the user unit of the SVG.
_INCHES_PER_POINT = 1 / 72
# Widths in points of a figure in half of the page, and of one that spans it.
NARROW, WIDE = 370, 900
# Two dots for each point, so that a figure is sharp on a fine screen.
_DOTS_PER_INCH = 144
Layout = Literal["constrained"] | None


@contextmanager
def page_style(**changes: object) -> Iterator[None]:
    """Set the page's matplotlib settings within the context, and restore the previous ones."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_SETTINGS | changes)
        yield


class Drawing(Figure):
    """A matplotlib figure that a notebook displays even if pyplot was never imported."""

    def _repr_png_(self) -> bytes:
        stream = io.BytesIO()
        self.savefig(stream, format="png", dpi=_DOTS_PER_INCH)
        return stream.getvalue()


def sheet(height: float, width: float = NARROW, layout: Layout = "constrained") -> Drawing:
    """Return an empty figure of this size in points."""
    return Drawing(figsize=(width * _INCHES_PER_POINT, height * _INCHES_PER_POINT), layout=layout)


def canvas(height: float) -> tuple[Drawing, Any]:
    """Return a figure with one plot in it, and its axes."""
    figure = sheet(height)
    return figure, figure.add_subplot()


def canvas_on(ax: Any, height: float) -> tuple[Figure, Any]:
    """Return the caller's axes with their figure; without axes, a new figure with one plot."""
    return canvas(height) if ax is None else (ax.figure, ax)


def draw_legend(figure: Figure | None, axes: Any, ncols: int = 1) -> None:
    """Draw the legend of these axes below our figure, or inside the axes if `figure` is None."""
    if figure is None:
        axes.legend(handlelength=3.2)
    else:
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=ncols, handlelength=3.2)


# -- a caller's figures ---------------------------------------------------------------------------


def restyle_for_caller(draw: Callable[[], Figure], ax: Any = None) -> Figure:
    """Draw the figure on white for a caller, with its titles moved to the vertical axes.

    `ax`: the axes of the caller on which it is drawn; nothing else of their figure is changed.
    """
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
