"""The change of ∮ p·dq: exact values, Stokes' theorem, maps that keep it, and planted errors."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import verify
from tests.helpers.carried_regions import (
    OSCILLATOR,
    carried,
    change_of_area,
    mean_of_defect,
    within,
)
from tests.helpers.known_areas import linear_determinant
from verify.scenes.results.regions import EXACT_FLOW
from verify.studies.regions import mean_lambda, point_carriers

COUPLED = "p1**2/2 + p2**2/2 + q1**2 + 3*q2**2/2 + q1*q2/2 + p1*q2/3"
HENON = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3"
POINT = {"p1": Fraction(2, 5), "p2": Fraction(0), "q1": Fraction(0), "q2": Fraction(1, 10)}
DRIVEN = {
    "hamiltonian": "p**2/2 - (1 + cos(2*t)/2)*cos(q)", "t0": Fraction(1, 3), "h": "1/20",
    "steps": 30, "shape": {"shape": "circle", "centre": {"q": 1, "p": 0}, "scale": "1/4"},
}  # fmt: skip


def degrees(plane: int = 1, shape: str = "circle", **more: Any) -> dict[str, Any]:
    """A region in the plane of one pair of coordinates, by Hénon and Heiles' Hamiltonian."""
    centre = {"q": POINT[f"q{plane}"], "p": POINT[f"p{plane}"]}
    place = {"shape": shape, "centre": centre, "scale": Fraction(1, 10)}
    return {"hamiltonian": HENON, "steps": 6, "point": POINT, "plane": plane, "shape": place} | more


# -- exact values ---------------------------------------------------------------------------------


COSTLY = (pytest.mark.left_to_ci, pytest.mark.sample(3))


def minors_of_coupled_oscillators(plane: int) -> list[Fraction]:
    """Of M = (1 + hA + h²A²/2)⁶, lie2's: by how much the plane's area grows in each projection."""
    third, half, h = Fraction(1, 3), Fraction(1, 2), Fraction(1, 10)
    a = np.array([[0, 0, -2, -half], [-third, 0, -half, -3], [1, 0, 0, third], [0, 1, 0, 0]])
    m = np.linalg.matrix_power(np.eye(4, dtype=int) + h * a + h * h / 2 * (a @ a), 6)
    i, j = plane - 1, plane + 1  # p_i and q_i
    return [m[k, i] * m[k + 2, j] - m[k, j] * m[k + 2, i] for k in (0, 1)]


def of_coupled_oscillators(plane: int) -> Any:
    minors = minors_of_coupled_oscillators(plane)
    region = degrees(plane, hamiltonian=COUPLED)
    return pytest.param(region, sum(minors) - 1, minors, marks=COSTLY)


@pytest.mark.parametrize("digits", [17, 40])
@pytest.mark.parametrize(
    ("region", "true", "minors"),
    [
        ({"hamiltonian": OSCILLATOR, "scheme": "lie3"},
         linear_determinant("lie3", Fraction(1, 10), 10), []),
        of_coupled_oscillators(1),
        of_coupled_oscillators(2),
    ],
    ids=["plane", "(q1, p1)", "(q2, p2)"],
)  # fmt: skip
def test_a_linear_map_changes_it_by_what_its_matrix_says(
    region: dict[str, Any], true: Fraction, minors: list[Fraction], digits: int
) -> None:
    """By the determinant; in n degrees of freedom by the sum of the projections' minors."""
    image = carried(**region, digits=digits)
    assert within(image, true)
    assert image.agree
    mean, mean_error = mean_of_defect(image)
    assert abs(mean - true) <= mean_error
    assert 100 * change_of_area(image)[1] < abs(true)
    assert (image.arithmetic == "float64") == (digits == 17)
    for seen, minor in zip(image.outlines[0].projections, minors, strict=True):
        assert abs(Fraction(seen.area) - minor) <= Fraction(seen.area_error) < Fraction(1, 10**9)


# -- what keeps it, and what does not -------------------------------------------------------------


@pytest.mark.parametrize(
    ("region", "scheme"),
    [
        (DRIVEN, EXACT_FLOW),
        (degrees(), EXACT_FLOW),
        (degrees(), "stormer-verlet"),
        (degrees(), "implicit-midpoint"),
    ],
    ids=["driven-flow", "degrees-flow", "degrees-stormer-verlet", "degrees-implicit-midpoint"],
)
def test_a_symplectic_map_keeps_it_within_the_error(region: dict[str, Any], scheme: str) -> None:
    image = carried(**region, scheme=scheme)
    change, error = change_of_area(image)
    assert image.area_preserving
    assert abs(change) <= error < Fraction(1, 10**9)
    assert image.mean_defect is image.mean_lambda is None
    shares = [Fraction(x.area) for x in image.outlines[0].projections]
    assert len(shares) == (2 if "plane" in region else 0)
    if shares:
        assert abs(sum(shares) - 1) < Fraction(1, 10**8)
        assert abs(shares[1]) > Fraction(1, 10**4), "it is the sum that is kept"


COSTLIER = (pytest.mark.left_to_ci, pytest.mark.sample(2))


@pytest.mark.parametrize(
    ("region", "times"),
    [
        pytest.param(DRIVEN, 100, id="driven"),
        pytest.param(DRIVEN | {"digits": 25}, 100, id="driven, 25 digits"),
        pytest.param(degrees(2, digits=30, steps=20), 10_000, id="(q2, p2), 30 digits"),
        *(
            pytest.param(degrees(1, "cat", steps=20, scheme=scheme), 100, id=f"a cat, {scheme}",
                         marks=COSTLIER) for scheme in ("lie2", "lie3", "rk4")
        ),
    ],
)  # fmt: skip
def test_the_change_is_the_mean_of_the_defect(region: dict[str, Any], times: int) -> None:
    """And so many times as large as the probe's error: the target is 100, of lie2 and a cat."""
    image = carried(**region)
    (change, error), (mean, mean_error) = change_of_area(image), mean_of_defect(image)
    assert not image.problem
    assert image.area_preserving is False
    assert image.agree is True
    assert 0 < error * times <= abs(change)
    assert abs(change - mean) <= error + mean_error
    assert (error + mean_error) * 100 < abs(mean)
    assert (image.arithmetic == "float64") == (region.get("digits", 17) == 17)


# -- planted errors -------------------------------------------------------------------------------


def of_another_region(right: Any) -> Any:
    return lambda outline, *rest: right(
        outline.place_at(Fraction(1, 50), Fraction(0), Fraction(1)), *rest
    )


def with_defect(change: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """A PointMap whose defect of p1 and q1 is another."""

    def plant(right: Any) -> Any:
        class Planted(right):  # type: ignore[misc]
            def __call__(self, **points: Any) -> Any:
                image = super().__call__(**points)
                return {**image, "w_0_2": change(image)}

        return Planted

    return plant


def with_one_momentum_off(right: Any) -> Any:
    """By 10⁻⁶ of itself: no picture shows it."""

    def planted(point_map: Any, place: Any, points: Any) -> Any:
        q1, q2, p1, p2 = right(point_map, place, points)
        return q1, q2, p1 * (1 + 1e-6), p2

    return planted


PLANTS: dict[str, tuple[dict[str, Any], ModuleType, str, Callable[[Any], Any]]] = {
    "the mean of another region": (
        {"steps": 30}, mean_lambda, "_sample_cells", of_another_region,
    ),
    "a wrong defect": (
        degrees(steps=20), mean_lambda, "PointMap",
        with_defect(lambda image: image["w_0_2"] * (1 + 1e-5)),
    ),
    "the defect of another plane": (
        degrees(steps=20), mean_lambda, "PointMap", with_defect(lambda image: image["w_1_3"]),
    ),
    "a curve that is carried wrongly": (
        degrees(steps=20), point_carriers, "_apply_map", with_one_momentum_off,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("region", "module", "name", "plant"), PLANTS.values(), ids=PLANTS)
def test_a_planted_error_is_noticed(
    region: dict[str, Any], module: ModuleType, name: str, plant: Callable[[Any], Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    assert carried(**region).agree
    monkeypatch.setattr(module, name, plant(getattr(module, name)))
    assert carried(**region).agree is False


def test_a_wrong_flow_does_not_keep_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The control of the exact flow's 0: what is not symplectic is measured as such."""
    right = point_carriers.exact_points

    def planted(*arguments: Any) -> Any:
        flow = right(*arguments)
        return replace(flow, points={**flow.points, "p2": flow.points["p2"] * (1 + 1e-6)})

    monkeypatch.setattr(point_carriers, "exact_points", planted)
    assert not within(carried(**degrees(), scheme=EXACT_FLOW), Fraction(0))


# -- from Python ----------------------------------------------------------------------------------


def test_a_call_takes_lists_and_a_plane() -> None:
    flow = verify.flow(
        "henon-heiles", "lie2", centre=([0, "1/10"], ["2/5", 0]), plane=2, scale="1/10",
        step_size="0.1", steps=6, exact=False,
    )  # fmt: skip
    assert flow.centre == ("0.1", "0")
    assert (flow.plane, flow.point["p1"]) == (2, "0.4")
    assert flow.images[0].agree
    assert flow.images[0].area_change == carried(**degrees(2)).area_change
