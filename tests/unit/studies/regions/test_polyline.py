"""Curves as polylines: how far they are from the curve, thinned, and as text."""

import numpy as np
import pytest

from tests.helpers.known_areas import measured, still
from verify.scenes.shapes import named as shapes
from verify.studies.regions.hausdorff import hausdorff
from verify.studies.regions.panels import densify
from verify.studies.regions.polyline import (
    format_points,
    parse_points,
    thin,
    trace_outlines,
)


def panels_of(name: str) -> list[tuple[np.ndarray, np.ndarray]]:
    return [panel.start for panel in measured(shapes.get(name).outlines[0], still()).panels]


@pytest.mark.parametrize("points", [300, 5_000, 40_000])
def test_a_dense_circle_lies_on_it_and_its_sagitta_is_told(points: int) -> None:
    found, sagitta = densify(panels_of("circle"), points)
    assert np.abs(np.hypot(*found.T) - 1).max() < 1e-14
    true = 1 - np.cos(np.pi / len(found))
    assert true <= sagitta <= 2 * true + 1e-15


def test_the_corners_of_a_dense_square_are_there() -> None:
    found, sagitta = densify(panels_of("square"), 1000)
    for corner in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        assert np.hypot(*(found - corner).T).min() < 1e-13
    assert sagitta < 1e-13


def test_a_panel_left_out_is_seen_in_the_sagitta() -> None:
    assert densify(panels_of("circle")[:-1])[1] > 1e-4


@pytest.mark.parametrize("tolerance", [1e-1, 1e-3, 1e-5])
def test_a_thinned_curve_stays_within_the_tolerance(tolerance: float) -> None:
    found, _ = densify(panels_of("cat"), 4000)
    few = thin(found, tolerance)
    assert len(few) < len(found) / 2
    assert hausdorff([found], [few]).value <= tolerance * (1 + 1e-9)
    kept = {tuple(point) for point in found}
    assert all(tuple(point) in kept for point in few)
    coarser = thin(found, 20 * tolerance)
    assert hausdorff([found], [coarser]).value > tolerance, "the tolerance is used"


def test_points_that_repeat_and_a_single_point_are_thinned_too() -> None:
    assert len(thin(np.array([[1.0, 2.0]]), 0.1)) == 1
    assert len(thin(np.array([[1.0, 2.0]] * 5), 0.1)) == 1
    square = np.array([[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 1.0]])
    assert {tuple(p) for p in thin(square, 1e-9)} == {(0, 0), (1, 0), (1, 1), (0, 1)}


def test_no_point_of_the_smallest_curve_is_lost() -> None:
    least = float(np.finfo(np.float64).smallest_subnormal)
    triangle = np.array([[0, 0], [least, 0], [0, least]])
    assert np.array_equal(thin(triangle, 0), triangle)


def test_text_is_read_back_to_five_digits() -> None:
    points = np.array([[1.23456789, -2e-7], [12345678.0, 0.0]])
    assert format_points(points) == "1.2346,-2e-07 1.2346e+07,0"
    assert np.allclose(parse_points(format_points(points)), points, rtol=1e-4, atol=0)


def test_a_shape_is_drawn_near_enough() -> None:
    for name in ("cat", "square", "circle"):
        curves = trace_outlines(shapes.get(name))
        assert len(curves) == len(shapes.get(name).outlines)
        true, sagitta = densify(panels_of(name), 20_000)
        far = hausdorff([true], curves[:1], sagitta)
        assert far.value <= 2 / 400
