"""A subclass of matplotlib's figure that a notebook displays by itself, sized in points."""

import io
from typing import Any, Literal

from matplotlib.figure import Figure

# Inches; a point is the user unit of the SVG.
_POINT = 1 / 72
# Widths in points of a figure in half of the page, and of one that spans it.
NARROW, WIDE = 370, 900
# Dots per inch: two for each point, so that it is sharp on a fine screen.
_DOTS = 144
Layout = Literal["constrained"] | None


class Drawing(Figure):
    """A matplotlib figure that a notebook displays even if pyplot was never imported."""

    def _repr_png_(self) -> bytes:
        stream = io.BytesIO()
        self.savefig(stream, format="png", dpi=_DOTS)
        return stream.getvalue()


def sheet(height: float, width: float = NARROW, layout: Layout = "constrained") -> Drawing:
    """Return an empty figure of this size in points."""
    return Drawing(figsize=(width * _POINT, height * _POINT), layout=layout)


def canvas(height: float) -> tuple[Drawing, Any]:
    """Return a figure with one plot in it, and its axes."""
    figure = sheet(height)
    return figure, figure.add_subplot()


def canvas_on(ax: Any, height: float) -> tuple[Figure, Any]:
    """Return the caller's axes with their figure; without axes, a new figure with one plot."""
    return canvas(height) if ax is None else (ax.figure, ax)


def legend(figure: Figure | None, axes: Any, ncols: int = 1) -> None:
    """Set the legend of these axes below our figure; inside of them where `figure` is None."""
    if figure is None:
        axes.legend(handlelength=3.2)
    else:
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=ncols, handlelength=3.2)
