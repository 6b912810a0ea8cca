"""The mean of Λ over a region, against exact integrals and against the change of area."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from tests.helpers.known_areas import (
    DUFFING,
    OSCILLATOR,
    PENDULUM,
    floats,
    linear_determinant,
    measured,
)
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.shapes import named as shapes
from verify.scenes.shapes.outline import Outline
from verify.studies.regions import mean_lambda as region_mean
from verify.studies.regions.mean_lambda import _sample_cells, find_middle, mean_over
from verify.studies.regions.region_area import Goal

CIRCLE, SQUARE, CAT = (shapes.get(name).outlines[0] for name in ("circle", "square", "cat"))
CHANGED = Goal(change=Fraction(1, 10**4), area=Fraction(1, 10**14))
H, N = Fraction(1, 10), 30


def placed(outline: Outline, q: Any, p: Any, scale: Any) -> Outline:
    return outline.place_at(Fraction(q), Fraction(p), Fraction(scale))


def integral(f: Any, outline: Outline, centre: tuple[float, float]) -> float:
    arcs = range(len(outline.arcs))
    cells = [(k, s / 8, (s + 1) / 8, 0.0, 1.0) for k in arcs for s in range(8)]
    x, y, weights = _sample_cells(outline, centre, cells)
    return float(weights @ f(x, y))


@pytest.mark.parametrize("centre", [(0.0, 0.0), (0.3, -0.2), (5.0, 1.0)])
def test_polynomials_over_a_square_and_a_disc_are_integrated_exactly(centre: Any) -> None:
    """Also where the rays come from a point outside: what they sweep twice cancels."""
    size = 1.0 + 100 * (centre[0] > 1)
    assert abs(integral(lambda x, y: 1 + 0 * x, SQUARE, centre) - 4) < 1e-14 * size
    assert abs(integral(lambda x, y: x**4 * y**2, SQUARE, centre) - 4 / 15) < 1e-13 * size**2
    assert abs(integral(lambda x, y: x**2 * y**2, CIRCLE, centre) - np.pi / 24) < 1e-13 * size**2


def test_the_mean_for_a_linear_map_is_the_determinant() -> None:
    found = mean_over(CAT, (0.0, 0.0), OSCILLATOR, "lie3", H, N)
    true = float(linear_determinant("lie3", H, N))
    assert abs(found.value - true) <= found.error < 1e-10 * abs(true)


@pytest.mark.parametrize("outline", [CIRCLE, SQUARE], ids=["circle", "square"])
def test_the_middle_of_what_is_the_same_on_all_sides_is_its_centre(outline: Outline) -> None:
    assert find_middle(placed(outline, 3, "-1/2", "1/4")) == pytest.approx((3, -0.5), abs=1e-15)


def test_rays_from_the_middle_of_a_cat_do_not_leave_it() -> None:
    """What is swept has one sign: no ray meets the outline twice."""
    cells = [(arc, k / 8, (k + 1) / 8, 0.0, 1.0) for arc in range(len(CAT.arcs)) for k in range(8)]
    signs = np.sign(_sample_cells(CAT, find_middle(CAT), cells)[2])
    outside = np.sign(_sample_cells(CAT, (5.0, 1.0), cells)[2])
    assert len(set(signs)) == 1 < len(set(outside))


@pytest.mark.parametrize("outline", [CIRCLE, SQUARE, CAT], ids=["circle", "square", "cat"])
@pytest.mark.parametrize("hamiltonian", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
def test_the_mean_is_the_change_of_area(hamiltonian: Hamiltonian, outline: Outline) -> None:
    own = placed(outline, 1, 0, "1/2")
    found = mean_over(own, (1.0, 0.0), hamiltonian, "lie2", H, N)
    area = measured(own, floats("lie2", H, N, hamiltonian), CHANGED)
    assert abs(Fraction(found.value) - area.change) <= Fraction(found.error) + area.error
    assert found.error <= 2e-3 * abs(found.value)


def apart(monkeypatch: pytest.MonkeyPatch, planted: Any, steps: int = N) -> float:
    """By how many of its errors the mean is away from the change of area."""
    own = placed(SQUARE, 1, 0, "1/2")
    with monkeypatch.context() as patch:
        patch.setattr(region_mean, "_sample_cells", planted)
        found = mean_over(own, (1.0, 0.0), DUFFING, "lie2", H, steps)
    area = measured(own, floats("lie2", H, N, DUFFING), CHANGED)
    return abs(found.value - float(area.change)) / (found.error + float(area.error))


def test_half_the_region_a_flipped_sign_and_a_step_too_many_are_seen(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def half(*given: Any) -> Any:
        """What rays to two of the four sides sweep."""
        x, y, weights = _sample_cells(*given)
        return x, y, np.where(x - 1 > y, weights, 0.0)

    def one_sign(*given: Any) -> Any:
        x, y, weights = _sample_cells(*given)
        return 2 - x, y + 0.5, weights

    assert apart(monkeypatch, _sample_cells) <= 1
    assert apart(monkeypatch, half) > 10
    assert apart(monkeypatch, one_sign) > 10
    assert apart(monkeypatch, _sample_cells, steps=N + 1) > 10


def test_sums_that_agree_by_chance_are_not_taken_for_right() -> None:
    """Where Λ varies much over the region, the sum of all cells may stand still for a while."""
    own = placed(CAT, 1, 0, "1/2")
    h, steps = Fraction(1, 50), 3000
    found = mean_over(own, (1.0, 0.0), DUFFING, "lie2", h, steps)
    area = measured(own, floats("lie2", h, steps, DUFFING), CHANGED)
    assert abs(found.value - float(area.change)) <= found.error + float(area.error)


def test_the_sign_of_lambda_counts() -> None:
    own = placed(CIRCLE, 1, 0, "1/2")
    for scheme in ("lie2", "lie3"):
        found = mean_over(own, (1.0, 0.0), OSCILLATOR, scheme, H, N)
        assert found.value * float(linear_determinant(scheme, H, N)) > 0
    assert linear_determinant("lie2", H, N) > 0 > linear_determinant("lie3", H, N)
