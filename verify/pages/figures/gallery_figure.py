"""Figures of a scene of the gallery: the orbit in the (q, p) plane, and the parts of Λ."""

from collections.abc import Iterator, Sequence
from math import isfinite, log10, nan

from matplotlib.figure import Figure

from verify.pages.figures.axes import (
    LabelledAbscissa,
    draw_grid,
    line_style,
    mark_places,
    set_decade_ticks,
    set_round_ticks,
)
from verify.pages.figures.captioned_plot import lg
from verify.pages.figures.sheet import INK, SERIES, canvas
from verify.pages.text.typography import NBSP, whole
from verify.scenes.results.exploration import GalleryScene

_HEIGHT = 330
# The greatest ratio of the two extents for which both axes have one scale.
_MAX_RATIO = 4
# The least extent of an axis, as a part of the greatest |q| or |p|: the points have six digits.
_LEAST_SPAN = 1e-3
# The margin around the orbit, as a part of the axes.
_MARGIN = 0.08
# The width of the plane's frame divided by its height.
_FRAME_RATIO = 1.3
# The width of a mark's label, as a part of the axes.
_LABEL_WIDTH = 0.5


# -- the orbit ------------------------------------------------------------------------------------


def draw_orbit(points: Sequence[tuple[str, str]], steps: int) -> Figure:
    """Draw the orbit's points (q, p), q to the right and p upwards, and mark its two ends."""
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
    if _has_one_scale(q, p):
        axes.set_aspect("equal")
    draw_grid(axes, "both")
    set_round_ticks(axes)
    axes.set_xlabel("q")
    axes.set_ylabel("p", rotation=0, labelpad=10)
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def _limits(q: Sequence[float], p: Sequence[float]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the least and the greatest (q, p), with a margin also if nothing moves."""
    least = _LEAST_SPAN * (max(map(abs, (*q, *p))) or 1.0)
    spans = [(1 + 2 * _MARGIN) * max(_span(values), least) for values in (q, p)]
    if _has_one_scale(q, p):  # the limits then fill a frame of this ratio
        spans = [max(spans[0], _FRAME_RATIO * spans[1]), max(spans[0] / _FRAME_RATIO, spans[1])]
    middles = [(min(values) + max(values)) / 2 for values in (q, p)]
    centred_spans = list(zip(middles, spans, strict=True))
    return tuple(m - s / 2 for m, s in centred_spans), tuple(m + s / 2 for m, s in centred_spans)


def _has_one_scale(q: Sequence[float], p: Sequence[float]) -> bool:
    """Return True if one scale suits both axes."""
    return max(_span(q), _span(p)) <= _MAX_RATIO * min(_span(q), _span(p))


def _span(values: Sequence[float]) -> float:
    return max(values) - min(values)


# -- truncation and rounding ----------------------------------------------------------------------


def draw_parts(scene: GalleryScene) -> Figure:
    """Draw |truncation| and |rounding| on logarithmic axes, with dashed lines at `marks`."""
    series = scene.separation.plain.series if scene.separation.plain else ()
    figure, axes = canvas(_HEIGHT)
    x = [log10(point.steps) for point in series]
    parts = ("truncation", "truncation"), ("total", "rounding, the plain way")
    for index, (part, label) in enumerate(parts):
        y = [_finite_lg(getattr(point, part)) for point in series]
        if any(map(isfinite, y)):
            axes.plot(x, y, label=label, **line_style(index, len(parts)))
    axes.margins(x=0.05, y=0.06)
    if crossings := list(marks(scene)):
        mark_places(axes, crossings, _LABEL_WIDTH)
    draw_grid(axes)
    set_decade_ticks(axes.xaxis, max_ticks=6)
    set_decade_ticks(axes.yaxis)
    axes.set_xlabel("steps N (logarithmic)")
    axes.set_title("|part of Λ|")
    figure.legend(loc="outside lower center", ncols=2, handlelength=3.2)
    return figure


def _finite_lg(size: str) -> float:
    """Return lg of the size; for 0, or if no digit is known, nan, which breaks the line."""
    logarithm = lg(size)
    return logarithm if isfinite(logarithm) else nan


def marks(scene: GalleryScene) -> Iterator[LabelledAbscissa]:
    """Yield the steps after which rounding is the larger part, and after which truncation is again.

    If rounding is larger from the first checkpoint on, it has not overtaken truncation.
    """
    series = scene.separation.plain.series if scene.separation.plain else ()
    lost_after, resumes_at = scene.meaningless_after, scene.meaningful_from
    if series and lost_after is not None and lost_after > series[0].steps:
        yield log10(lost_after), f"rounding overtakes, N{NBSP}={NBSP}{whole(lost_after)}"
    if resumes_at is not None:
        yield log10(resumes_at), f"truncation overtakes, N{NBSP}={NBSP}{whole(resumes_at)}"
