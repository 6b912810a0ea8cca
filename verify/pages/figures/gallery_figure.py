"""A scene of the gallery: its orbit in the (q, p) plane, and Λ's parts over steps, as SVG."""

from collections.abc import Iterator, Sequence
from math import isfinite, log10, nan

from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    Mark,
    decades,
    grid_lines,
    line_style,
    mark_places,
    round_numbers,
)
from verify.pages.figures.logarithm import lg
from verify.pages.figures.notebook_figure import canvas
from verify.pages.figures.svg import INK, SERIES
from verify.pages.text.typography import NBSP, whole
from verify.scenes.results.exploration import GalleryScene

_HEIGHT = 330
_MOST_UNLIKE = 4  # a plane so many times as long as it is high has one scale for both axes
_LEAST_SPAN = 1e-3  # of the greatest |q|, |p|: an orbit's points have six digits
_ROOM = 0.08  # of the axes, around the orbit
_WIDE = 1.3  # of the plane's frame: its width by its height
_ASIDE = 0.5  # of the axes: what a mark's label takes


# -- the orbit ------------------------------------------------------------------------------------


def draw_orbit(points: Sequence[tuple[str, str]], steps: int) -> Figure:
    """The points (q, p) in turn, q to the right and p upwards; its two ends are marked."""
    figure, axes = canvas(_HEIGHT)
    q, p = [float(q) for q, _ in points], [float(p) for _, p in points]
    style = {"color": SERIES[0], "linewidth": 0.9, "marker": ".", "markersize": 3.5}
    axes.plot(q, p, **style)
    ends = {"linestyle": "none", "color": INK, "clip_on": False}
    axes.plot(q[:1], p[:1], marker="o", markersize=8, fillstyle="none", label="start", **ends)
    axes.plot(q[-1:], p[-1:], marker="s", markersize=5, label=f"after {whole(steps)}", **ends)
    low, high = _limits(q, p)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    if _alike(q, p):
        axes.set_aspect("equal")
    grid_lines(axes, "both")
    round_numbers(axes)
    axes.set_xlabel("q")
    axes.set_ylabel("p", rotation=0, labelpad=10)
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def _limits(q: Sequence[float], p: Sequence[float]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """The least and the greatest (q, p) with some room, also where nothing moves."""
    least = _LEAST_SPAN * (max(map(abs, (*q, *p))) or 1.0)
    spans = [(1 + 2 * _ROOM) * max(_span(values), least) for values in (q, p)]
    if _alike(q, p):  # then one scale, in a frame that is filled
        spans = [max(spans[0], _WIDE * spans[1]), max(spans[0] / _WIDE, spans[1])]
    middles = [(min(values) + max(values)) / 2 for values in (q, p)]
    both = list(zip(middles, spans, strict=True))
    return tuple(m - s / 2 for m, s in both), tuple(m + s / 2 for m, s in both)


def _alike(q: Sequence[float], p: Sequence[float]) -> bool:
    """Whether one scale for both axes shows the orbit."""
    return max(_span(q), _span(p)) <= _MOST_UNLIKE * min(_span(q), _span(p))


def _span(values: Sequence[float]) -> float:
    return max(values) - min(values)


# -- truncation and rounding ----------------------------------------------------------------------


def draw_parts(each: GalleryScene) -> Figure:
    """|truncation| and |rounding| on logarithmic axes; a dashed line where one overtakes."""
    series = each.separation.plain.series if each.separation.plain else ()
    figure, axes = canvas(_HEIGHT)
    x = [log10(at.steps) for at in series]
    kinds = ("truncation", "truncation"), ("total", "rounding, the plain way")
    for index, (part, label) in enumerate(kinds):
        y = [_place(getattr(at, part)) for at in series]
        if any(map(isfinite, y)):
            axes.plot(x, y, label=label, **line_style(index, len(kinds)))
    axes.margins(x=0.05, y=0.06)
    if found := list(marks(each)):
        mark_places(axes, found, _ASIDE)
    grid_lines(axes)
    decades(axes.xaxis, most=6)
    decades(axes.yaxis)
    axes.set_xlabel("steps N (logarithmic)")
    axes.set_title("|part of Λ|")
    figure.legend(loc="outside lower center", ncols=2, handlelength=3.2)
    return figure


def _place(size: str) -> float:
    """What is 0, or of no known digit, breaks the line."""
    place = lg(size)
    return place if isfinite(place) else nan


def marks(each: GalleryScene) -> Iterator[Mark]:
    """Where rounding overtakes truncation, and where truncation does so for good.

    Rounding that is the larger from the first checkpoint on has overtaken nothing.
    """
    series = each.separation.plain.series if each.separation.plain else ()
    after, over = each.meaningless_after, each.meaningful_from
    if series and after is not None and after > series[0].steps:
        yield log10(after), f"rounding overtakes, N{NBSP}={NBSP}{whole(after)}"
    if over is not None:
        yield log10(over), f"truncation overtakes, N{NBSP}={NBSP}{whole(over)}"
