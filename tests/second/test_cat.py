"""The cat's area and outlines after lie2's steps, h = 0.01, and after symplectic Euler's.

The areas by an equidistant rule with derivatives by FFT around the head, and once more by the mean
of Λ over its inside.
"""

import numpy as np
import pytest

from tests.helpers.programs.compilers import needed
from tests.second.cat import Array, Carrier, area, around, distance, head, outlines, placed

HERE, ELSEWHERE = (1.0, 0.0), (1.5, 1.5)  # q, p of the cat's middle
ALL = 20_000  # steps
TENTH = 0.1  # of the face's width, which is called one unit


@pytest.fixture(scope="module")
def carrier(tmp_path_factory: pytest.TempPathFactory) -> Carrier:
    needed("gcc")
    return Carrier(tmp_path_factory.mktemp("outlines"))


def change(carrier: Carrier, middle: tuple[float, float], steps: int, count: int = 4096) -> float:
    """Of the head's area, as a part of it."""
    points = placed(head(around(count)), *middle)
    image, _ = carrier.lie2(points, steps)
    return area(image) / area(points) - 1


def mean_error(carrier: Carrier, middle: tuple[float, float], rings: int, count: int) -> float:
    """The mean of Λ inside the head, which its rays from (0, 0) meet once.

    z = s·head(t), 0 < s < 1, has the area s |head × head'| ds dt.
    """
    z = np.array([1, 1j]) @ np.array(head(around(count)))
    turns = np.fft.fftfreq(count, 1 / count)
    swept = (z.conj() * np.fft.ifft(1j * turns * np.fft.fft(z))).imag
    assert swept.min() > 0
    nodes, weights = np.polynomial.legendre.leggauss(rings)
    at = (nodes + 1) / 2
    inside = (at[:, None] * z).ravel()
    weight = ((weights * at)[:, None] * swept).ravel()
    _, factors = carrier.lie2(placed((inside.real, inside.imag), *middle), ALL)
    return float(weight @ (factors - 1) / weight.sum())


def apart(
    carrier: Carrier, scheme: str, steps: int, count: int, middle: tuple[float, float] = HERE
) -> dict[str, float]:
    """The distance of three outlines' images from the exact ones."""
    shapes, distances = list(outlines()), {}
    for name, shape in (("head", shapes[0]), ("ear", shapes[3]), ("whisker", shapes[8])):
        points = placed(shape(around(count)), *middle)
        exact = carrier.exact(points, steps / 100)
        if scheme == "lie2":
            image, _ = carrier.lie2(points, steps)
        else:
            image = carrier.symplectic_euler(points, steps)
        distances[name] = distance(image, exact)
    return distances


def test_the_face_is_0_919_wide_and_green_s_formula_measures_a_circle() -> None:
    t: Array = around(4096)
    assert np.ptp(placed(head(t), *HERE)[0]) == pytest.approx(0.919, abs=1e-3)
    assert area(placed((np.cos(t), np.sin(t)), 3, 4)) == pytest.approx(np.pi / 4, rel=1e-13)
    assert len(list(outlines())) == 15


@pytest.mark.parametrize(
    ("steps", "expected"), [(5_000, 2.80476e-5), (10_000, 1.32810e-4), (ALL, 3.46586e-4)]
)
def test_at_1_0_the_cat_s_area_changes(carrier: Carrier, steps: int, expected: float) -> None:
    assert change(carrier, HERE, steps) == pytest.approx(expected, rel=3e-6)


@pytest.mark.parametrize(
    ("steps", "expected"), [(5_000, 3.38807e-4), (10_000, 8.16011e-4), (ALL, 1.76307e-3)]
)
def test_at_1_5_1_5_the_cat_s_area_changes_by_more(
    carrier: Carrier, steps: int, expected: float
) -> None:
    assert change(carrier, ELSEWHERE, steps) == pytest.approx(expected, rel=3e-6)


def test_of_three_changes_at_1_5_1_5_the_last_is_more_than_a_thousandth(carrier: Carrier) -> None:
    changes = [change(carrier, ELSEWHERE, steps) for steps in (5_000, 10_000, ALL)]
    assert [x > 1e-3 for x in changes] == [False, False, True]
    assert max(changes) == pytest.approx(1.76307e-3, rel=3e-6)


@pytest.mark.parametrize("middle", [HERE, ELSEWHERE])
def test_more_points_do_not_change_the_change(
    carrier: Carrier, middle: tuple[float, float]
) -> None:
    few, many = (change(carrier, middle, ALL, count) for count in (2048, 4096))
    assert few == pytest.approx(many, abs=1e-10)


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("middle", "expected"), [(HERE, 3.46586e-4), (ELSEWHERE, 1.76307e-3)])
def test_the_change_is_the_mean_of_the_total_error_inside(
    carrier: Carrier, middle: tuple[float, float], expected: float
) -> None:
    assert mean_error(carrier, middle, 64, 512) == pytest.approx(expected, rel=1e-5)


def test_symplectic_euler_leaves_the_area_as_it_is(carrier: Carrier) -> None:
    points = placed(head(around(4096)), *HERE)
    image = carrier.symplectic_euler(points, ALL)
    assert abs(area(image) / area(points) - 1) < 1e-11


@pytest.mark.left_to_ci
def test_symplectic_euler_s_outlines_are_farther_off_than_a_tenth(carrier: Carrier) -> None:
    """After 10,000 steps: a whisker and an ear. The face's outline itself is hardly within it."""
    distances = apart(carrier, "symplectic-euler", 10_000, 1600)
    assert distances["whisker"] == pytest.approx(0.1394, rel=2e-3)
    assert distances["ear"] == pytest.approx(0.1377, rel=2e-3)
    assert distances["head"] == pytest.approx(0.0993, rel=5e-3)
    assert max(distances.values()) > TENTH


@pytest.mark.left_to_ci
def test_lie2_s_outlines_are_nearer_than_a_tenth(carrier: Carrier) -> None:
    assert max(apart(carrier, "lie2", ALL, 800).values()) < 0.8 * TENTH


@pytest.mark.left_to_ci
def test_at_1_5_1_5_lie2_s_outlines_are_farther_off_than_a_tenth(carrier: Carrier) -> None:
    distances = apart(carrier, "lie2", ALL, 1600, ELSEWHERE)
    assert max(distances.values()) > 1.1 * TENTH
    assert max(distances.values()) == pytest.approx(0.1237, rel=0.05)
