"""Every named shape, found by itself: closed, simple, counterclockwise, smooth, and exact."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest

from verify.arithmetic.float_context import FLOAT, number
from verify.errors import InputError
from verify.scenes.shapes import named as shapes
from verify.scenes.shapes.outline import Arc, Outline

OUTLINES = [
    pytest.param(outline, id=f"{shape.name}-{outline.name}")
    for shape in map(shapes.get, shapes.names())
    for outline in shape.outlines
]
every_outline = pytest.mark.parametrize("outline", OUTLINES)


def precise(digits: int) -> Any:
    mp = mpmath.MPContext()
    mp.dps = digits
    return mp


def polyline(outline: Outline, points: int) -> np.ndarray:
    s = np.arange(points) / points
    return np.concatenate([np.stack(arc(FLOAT, s), axis=1) for arc in outline.arcs])


def crossings(points: np.ndarray) -> list[tuple[int, int]]:
    """The pairs of a closed polyline's sides that meet, but for neighbours: all are looked at."""
    a, b = points, np.roll(points, -1, axis=0)

    def side(of: np.ndarray) -> np.ndarray:
        """Twice the area of the triangle of each side (row) with each point (column)."""
        along, to = (b - a)[:, None, :], of[None, :, :] - a[:, None, :]
        return along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]

    parted = side(a) * side(b) <= 0
    meet = parted & parted.T
    low, high = np.minimum(a, b), np.maximum(a, b)
    meet &= (low[:, None] <= high[None]).all(axis=2) & (low[None] <= high[:, None]).all(axis=2)
    apart = np.abs(np.subtract.outer(np.arange(len(a)), np.arange(len(a))))
    meet &= (apart > 1) & (apart < len(a) - 1)
    return [(int(i), int(j)) for i, j in np.argwhere(meet)]


def area(points: np.ndarray) -> float:
    x, y = points.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


def joins(outline: Outline) -> Iterator[tuple[Arc, Arc]]:
    yield from zip(outline.arcs, (*outline.arcs[1:], outline.arcs[0]), strict=True)


def gap(mp: Any, outline: Outline) -> float:
    """The greatest distance of an arc's end from the next one's beginning."""
    one, zero = mp.mpf(1), mp.mpf(0)
    return max(
        float(abs(end - start))
        for before, after in joins(outline)
        for end, start in zip(before(mp, one), after(mp, zero), strict=True)
    )


def turn_at_the_join(outline: Outline) -> float:
    """|derivative at s = 1 − derivative at s = 0|, relative, of a curve of one arc."""
    mp = precise(60)
    step = mp.mpf(10) ** -20
    (arc,) = outline.arcs
    ends = []
    for s in (mp.mpf(0), mp.mpf(1)):
        (x0, y0), (x1, y1) = arc(mp, s - step), arc(mp, s + step)
        ends.append(((x1 - x0) / (2 * step), (y1 - y0) / (2 * step)))
    size = max(abs(c) for c in ends[0])
    return float(max(abs(a - b) for a, b in zip(*ends, strict=True)) / size)


def test_the_shapes_find_themselves() -> None:
    assert {"circle", "square", "cat"} <= set(shapes.names())
    for name in shapes.names():
        shape = shapes.get(name)
        assert shape.name == name
        assert shapes.get(name) is shape
        names = [outline.name for outline in shape.outlines]
        assert len(names) == len(set(names))
    assert shapes.get("cat").outlines[0].name == "head"


def test_an_unknown_shape_is_bad_input_that_lists_the_known_ones() -> None:
    with pytest.raises(InputError, match=r"shape=dog: unknown; allowed: cat, circle, square"):
        shapes.get("dog")


@every_outline
def test_the_arcs_join_to_full_precision(outline: Outline) -> None:
    assert gap(FLOAT, outline) < 1e-15
    assert gap(precise(30), outline) < 1e-29
    assert gap(precise(100), outline) < 1e-99


def test_a_gap_is_seen() -> None:
    mp = precise(30)
    open_arc = Outline("open", (lambda mp, s: (s, s * s + 0 * mp.pi),))
    assert gap(mp, open_arc) == 1


@every_outline
def test_float64_agrees_with_thirty_digits(outline: Outline) -> None:
    mp = precise(30)
    places = [Fraction(k, 64) for k in range(65)] + [Fraction(k, 97) for k in range(98)]
    for arc in outline.arcs:
        floats = np.array([float(s) for s in places])
        xs, ys = arc(FLOAT, floats)
        for s, x, y in zip(floats, xs, ys, strict=True):
            exact = arc(mp, mp.mpf(float(s)))
            assert abs(mp.mpf(float(x)) - exact[0]) < 1e-15, s
            assert abs(mp.mpf(float(y)) - exact[1]) < 1e-15, s


@pytest.mark.left_to_ci
@every_outline
def test_the_outline_is_simple_and_counterclockwise(outline: Outline) -> None:
    points = polyline(outline, 600)
    assert crossings(points) == []
    assert area(points) > 0
    assert area(points[::-1]) < 0


def test_a_crossing_is_seen() -> None:
    s = 2 * np.pi * (np.arange(100) + 0.3) / 100
    eight = np.stack((np.sin(s), np.sin(2 * s)), axis=1)
    assert crossings(eight)


@every_outline
def test_an_outline_of_one_arc_is_smooth_where_it_closes(outline: Outline) -> None:
    if len(outline.arcs) == 1:
        assert turn_at_the_join(outline) < 1e-18


def test_a_corner_is_seen() -> None:
    def drop(mp: Any, s: Any) -> tuple[Any, Any]:
        return mp.sin(2 * mp.pi * s), mp.sin(mp.pi * s) * mp.exp(-s)

    assert turn_at_the_join(Outline("drop", (drop,))) > 0.1


@every_outline
def test_an_outline_of_one_arc_needs_no_absurd_resolution(outline: Outline) -> None:
    """Its Fourier coefficients beyond 96 are rounding, so that 200 nodes resolve it."""
    if len(outline.arcs) == 1:
        x, y = polyline(outline, 1024).T
        spectrum = np.abs(np.fft.fft(x + 1j * y)) / 1024
        assert spectrum[96:-95].max() < 5e-16 < spectrum[1:3].max()


def test_the_cat_has_a_mirror_image_of_itself() -> None:
    by_name = {outline.name: outline for outline in shapes.get("cat").outlines}
    pairs = [(n, n.replace("left", "right")) for n in by_name if n.startswith("left")]
    assert len(pairs) == 6
    for left, right in pairs:
        mirrored = polyline(by_name[left], 500) * (-1, 1)
        other = polyline(by_name[right], 500)
        far = np.linalg.norm(mirrored[:, None] - other[None], axis=2).min(axis=1).max()
        assert far < 2e-3, left


def test_the_cat_is_about_one_in_radius_and_its_features_are_in_its_face() -> None:
    head, *features = shapes.get("cat").outlines
    rim = polyline(head, 600)
    assert 0.8 < np.abs(rim).max() < 1.2
    for outline in features:
        if "whisker" not in outline.name:
            for x, y in polyline(outline, 60):
                assert winding(rim - (x, y)) == 1, outline.name


def winding(points: np.ndarray) -> int:
    z = points[:, 0] + 1j * points[:, 1]
    return round(float(np.angle(np.roll(z, -1) / z).sum() / (2 * np.pi)))


def test_a_placed_shape_is_scaled_about_the_origin_and_moved() -> None:
    mp = precise(30)
    placed = shapes.get("square").place_at(Fraction(3, 10), Fraction(-2), Fraction(1, 2))
    x, y = placed.outlines[0].arcs[0](mp, mp.mpf(0))
    assert x == number(mp, Fraction(3, 10)) - mp.mpf(1) / 2
    assert y == mp.mpf(-5) / 2
