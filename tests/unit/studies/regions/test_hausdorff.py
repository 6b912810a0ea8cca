"""The Hausdorff distance of outlines: known cases, brute force, and what must not pass for it."""

import time
from typing import Any

import numpy as np
import pytest

from verify.errors import InputError
from verify.studies.regions import hausdorff as module
from verify.studies.regions.hausdorff import (
    RELATIVE,
    Distance,
    _enclose_directed,
    boxes,
    hausdorff,
    nearest,
    new_stack,
    segments,
    to_segment,
)

Array = Any
SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def circle(radius: float, points: int, centre: tuple[float, float] = (0.0, 0.0)) -> Array:
    turn = 2 * np.pi * np.arange(points) / points
    return np.stack((np.cos(turn), np.sin(turn)), axis=1) * radius + centre


def sagitta(radius: float, points: int) -> float:
    return float(radius * (1 - np.cos(np.pi / points)))


def divided(curve: Array, parts: int) -> Array:
    """The closed polyline through as many more points."""
    share = np.arange(parts)[None, :, None] / parts
    after = np.roll(curve, -1, axis=0)
    return (curve[:, None] * (1 - share) + after[:, None] * share).reshape(-1, 2)


def distances_by_brute_force(points: Array, curve: Array) -> Array:
    """The distance of each point from the closed polyline: every pair is looked at."""
    start, along = curve, np.roll(curve, -1, axis=0) - curve
    to = points[:, None] - start[None]
    length = np.maximum((along**2).sum(axis=1), 1e-300)
    part = np.clip((to * along).sum(axis=2) / length, 0, 1)
    off = to - part[..., None] * along
    return np.sqrt((off**2).sum(axis=2).min(axis=1))


def by_brute_force(points: Array, curve: Array) -> float:
    return float(distances_by_brute_force(points, curve).max())


def holds(found: Distance, true: float, slack: float = 0.0) -> bool:
    return abs(found.value - true) <= found.bound + slack


@pytest.mark.parametrize(("first", "second"), [(1.0, 1.5), (1.5, 1.0), (1.0, 1.001), (3.0, 0.25)])
def test_two_concentric_circles(first: float, second: float) -> None:
    found = hausdorff(
        [circle(first, 900)], [circle(second, 701)], sagitta(first, 900), sagitta(second, 701)
    )
    assert holds(found, abs(first - second))
    assert found.bound < 1e-4


@pytest.mark.parametrize("shift", [(0.3, 0.4), (3.0, 4.0), (3e-7, 4e-7)])
def test_a_circle_and_its_translate(shift: tuple[float, float]) -> None:
    n = 1001
    found = hausdorff([circle(2, n)], [circle(2, n, shift)], sagitta(2, n), sagitta(2, n))
    assert holds(found, float(np.hypot(*shift)))


def test_the_bound_without_the_sagittas_would_be_too_small() -> None:
    """The control of the two tests above: 20 points on a circle are not the circle."""
    curves = [circle(1, 20)], [circle(1.5, 13)]
    assert not holds(hausdorff(*curves), 0.5)
    assert holds(hausdorff(*curves, sagitta(1, 20), sagitta(1.5, 13)), 0.5)


@pytest.mark.parametrize("sagittas", [(0.5, 0.0), (0.0, 0.5), (0.25, 0.5)])
def test_each_curves_sagitta_is_a_part_of_the_bound(sagittas: tuple[float, float]) -> None:
    found = hausdorff([SQUARE], [SQUARE + 2.0], *sagittas)
    assert max(sagittas) <= found.bound <= sum(sagittas) + 1e-9
    assert holds(found, float(np.hypot(2, 2)))


def test_a_polygon_and_itself() -> None:
    """Also where its points are others, or begin elsewhere, or run the other way."""
    for other in (SQUARE, divided(SQUARE, 7), np.roll(SQUARE, 1, axis=0), SQUARE[::-1]):
        found = hausdorff([SQUARE], [other])
        assert holds(found, 0.0)
        assert found.bound < 1e-14
    assert hausdorff([SQUARE], [SQUARE]).value == 0


def test_both_directions_count() -> None:
    """A curve with a part far away is near to no part of the other, though each part is near it."""
    near, far = circle(1, 300), circle(0.1, 300, (10, 0))
    for first, second in (([near], [near, far]), ([near, far], [near])):
        assert holds(hausdorff(first, second), 9.1, 1e-3)
    one, two = segments([near]), segments([near, far])
    assert _enclose_directed(one, two, 0.0, 1e-14)[1] < 1e-13, (
        "a distance of one direction is refuted"
    )
    assert _enclose_directed(two, one, 0.0, 1e-14)[0] > 9


def test_the_maximum_within_a_segment_is_found() -> None:
    """Every vertex of the first lies on the second, and the middle of its lower side does not."""
    lid = np.array([[-4.0, 0.0], [-4.0, 5.0], [4.0, 5.0], [4.0, 0.0]])
    without = np.array([[-4.0, 0.0], [-4.0, 5.0], [4.0, 5.0], [4.0, 0.0], [4.0, 4.9], [-4.0, 4.9]])
    assert by_brute_force(lid, without) == 0, "all vertices lie on it"
    true = by_brute_force(divided(lid, 4000), without)
    assert true > 3.9
    assert holds(hausdorff([lid], [without]), true, 1e-3)


def test_agreement_with_brute_force_on_curves_drawn_at_random() -> None:
    random = np.random.default_rng(5)
    for case in range(24):
        sets = []
        for _ in range(2):
            count = int(random.integers(1, 4))
            sizes = random.integers(1, 25, size=count)
            sets.append([random.normal(size=(n, 2)) * random.choice([0.1, 1, 5]) for n in sizes])
        found = hausdorff(*sets)
        lengths, true = [], 0.0
        for mine, others in (sets, sets[::-1]):
            for curve in mine:
                fine = divided(curve, 300)
                distances = np.stack([distances_by_brute_force(fine, o) for o in others])
                true = max(true, float(distances.min(axis=0).max()))
                lengths.append(np.linalg.norm(np.roll(fine, -1, axis=0) - fine, axis=1).max())
        assert found.value >= true - 1e-12, case
        assert found.value <= true + max(lengths) / 2 + found.bound, case
        assert found.bound <= 2 * RELATIVE * found.value + 1e-12


def test_the_distance_lies_in_its_enclosure_however_wide_that_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The loops as plain Python, with another accuracy."""
    monkeypatch.setattr(module, "_compile_loop", lambda: module._directed_distance)
    random = np.random.default_rng(7)
    missed = 0
    for _ in range(40):
        first, second = (segments([random.normal(size=(6, 2))]) for _ in range(2))
        monkeypatch.setattr(module, "RELATIVE", 1e-12)
        low, high = _enclose_directed(first, second, 0.0, 1e-14)
        monkeypatch.setattr(module, "RELATIVE", 0.2)
        least, most = _enclose_directed(first, second, 0.0, 1e-14)
        assert least <= high
        assert low <= most <= least * 1.2 + 1e-13
        missed += least < low - 1e-6
    assert missed > 3, "the lower end by itself would have been wrong"


def test_the_nearest_segment_is_found_whatever_is_looked_at_first() -> None:
    random = np.random.default_rng(6)
    for n in (1, 7, 8, 9, 100, 257):
        rows = segments([random.normal(size=(n, 2))])
        tree = boxes(rows)
        for x, y in random.normal(size=(20, 2)) * 2:
            squares = [to_segment(x, y, row) for row in rows]
            for hint in {0, n // 2, n - 1}:
                square, index = nearest(x, y, rows, tree, hint, new_stack())
                assert square == min(squares) == squares[index]


def test_segments_and_points_of_no_length() -> None:
    point, other = np.array([[1.0, 2.0]]), np.array([[4.0, 6.0], [4.0, 6.0], [4.0, 6.0]])
    assert holds(hausdorff([point], [other]), 5.0)


def test_very_small_and_very_large_curves() -> None:
    for size in (1e-140, 1e-9, 1e9, 1e149):
        found = hausdorff([circle(size, 999)], [circle(2 * size, 999)])
        assert abs(found.value / size - 1) < 1e-3
        assert found.bound < 1e-4 * size
    assert holds(hausdorff([circle(1e-160, 9)], [circle(2e-160, 9)]), 1e-160)


def test_ten_thousand_points_each_take_far_less_than_a_second() -> None:
    hausdorff([SQUARE], [SQUARE])  # compiled
    n = 10_000
    turn = 2 * np.pi * np.arange(n) / n
    radius = 1 + 0.3 * np.sin(turn)
    spirals = [
        np.stack((radius * np.cos(turn + k * radius), radius * np.sin(turn + k * radius)), axis=1)
        for k in (40.0, 40.01)
    ]
    begin = time.perf_counter()
    found = hausdorff(spirals[:1], spirals[1:])
    assert time.perf_counter() - begin < 1
    assert 0.001 < found.value < 0.02


@pytest.mark.parametrize(
    ("curves", "problem"),
    [
        ([], "there is none"),
        ([np.zeros((0, 2))], "not an array of points"),
        ([np.zeros((4, 3))], "not an array of points"),
        ([np.zeros(4)], "not an array of points"),
        ([np.array([[0.0, np.nan]])], "not finite"),
        ([SQUARE, np.array([[0.0, np.inf]])], "not finite"),
        ([np.array([[1e151, 0.0]])], "beyond"),
    ],
)
def test_bad_curves_are_refused(curves: list[Array], problem: str) -> None:
    with pytest.raises(InputError, match=f"first=.*{problem}"):
        hausdorff(curves, [SQUARE])
    with pytest.raises(InputError, match=f"second=.*{problem}"):
        hausdorff([SQUARE], curves)


@pytest.mark.parametrize("sagitta", [-1.0, float("nan"), float("inf")])
def test_a_bad_sagitta_is_refused(sagitta: float) -> None:
    with pytest.raises(InputError, match=r"sagitta_second=.*at least 0"):
        hausdorff([SQUARE], [SQUARE], 0.0, sagitta)
