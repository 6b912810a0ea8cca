"""The figures' own class: matplotlib's, which a notebook shows by itself, sized in points."""

import io
from typing import Any, Literal

from matplotlib.figure import Figure

_POINT = 1 / 72  # inch; a point is the user unit of the SVG
NARROW, WIDE = 370, 900  # of a figure in half of the page, of one that spans it
_DOTS = 144  # an inch; twice a point, so that it is sharp on a fine screen too
Layout = Literal["constrained"] | None


class Drawing(Figure):
    """A matplotlib figure that is shown also where pyplot was never imported."""

    def _repr_png_(self) -> bytes:
        stream = io.BytesIO()
        self.savefig(stream, format="png", dpi=_DOTS)
        return stream.getvalue()


def sheet(height: float, width: float = NARROW, layout: Layout = "constrained") -> Drawing:
    """An empty figure of that size in points."""
    return Drawing(figsize=(width * _POINT, height * _POINT), layout=layout)


def canvas(height: float) -> tuple[Drawing, Any]:
    """A figure with one plot in it."""
    figure = sheet(height)
    return figure, figure.add_subplot()


def canvas_on(ax: Any, height: float) -> tuple[Figure, Any]:
    """The caller's axes and their figure; a figure with one plot in it where there are none."""
    return canvas(height) if ax is None else (ax.figure, ax)


def legend(figure: Figure | None, axes: Any, ncols: int = 1) -> None:
    """A legend of these axes below the figure of ours; inside of them where it is the caller's."""
    if figure is None:
        axes.legend(handlelength=3.2)
    else:
        handles, labels = axes.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=ncols, handlelength=3.2)
