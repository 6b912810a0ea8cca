"""Regions that are tiny, far away, or more than fixed point has room for."""

from fractions import Fraction

import pytest

from tests.helpers.carried_regions import OSCILLATOR, carried, within
from tests.helpers.known_areas import linear_determinant
from verify.scenes.region_sections import PlacedShape
from verify.studies.regions import region_area
from verify.studies.regions.outline_images import _greatest_with_error

FEWER_NODES = 20_000  # what no number of nodes follows these do not either
TRUE = linear_determinant("lie2", Fraction(1, 10), 10)


@pytest.mark.sample(2)
@pytest.mark.parametrize("scale", ["1e-30", "1e-200", "1e6"])
@pytest.mark.parametrize("digits", [17, 33])
def test_a_regions_size_does_not_matter(scale: str, digits: int) -> None:
    shape = {"shape": "circle", "scale": scale}
    image = carried(hamiltonian=OSCILLATOR, shape=shape, digits=digits, mean_lambda=False)
    assert image.problem == ""
    assert within(image, TRUE)


def test_a_small_region_far_from_the_origin_is_given_more_digits() -> None:
    """In float64 its points are all but one."""
    shape = {"shape": "circle", "centre": {"q": 1, "p": 0}, "scale": "1e-15"}
    image = carried(hamiltonian=OSCILLATOR, shape=shape, mean_lambda=False)
    assert image.arithmetic != "float64"
    assert within(image, TRUE)


def test_what_fixed_point_has_no_room_for_goes_to_mpfr() -> None:
    shape = {"shape": "square", "centre": {"q": 1_000_000, "p": 0}}
    image = carried(hamiltonian=OSCILLATOR, shape=shape, digits=33, mean_lambda=False)
    assert image.arithmetic == "mpfr"
    assert within(image, TRUE)


def test_a_wrong_determinant_is_not_within() -> None:
    shape = {"shape": "circle", "scale": "1e-30"}
    image = carried(hamiltonian=OSCILLATOR, shape=shape, mean_lambda=False)
    assert not within(image, TRUE * Fraction(1_000_001, 1_000_000))


@pytest.mark.parametrize("scale", ["1e101", "1e900"])
def test_a_shape_beyond_what_floats_hold_is_refused(scale: str) -> None:
    with pytest.raises(ValueError, match="the shape reaches beyond"):
        PlacedShape(shape="circle", scale=scale)
    PlacedShape(shape="circle", scale="1e99")


def test_an_image_that_is_far_away_has_an_area_but_no_distance() -> None:
    """Points of 10²⁹⁰, which no grid of float64 holds and no square."""
    image = carried(hamiltonian=OSCILLATOR, scheme="lie1", h="1/2", steps=6000, distance=True)
    assert image.problem == ""
    assert within(image, linear_determinant("lie1", Fraction(1, 2), 6000))
    assert image.distance is None


def test_where_the_exact_flow_blows_up_the_schemes_area_is_still_known() -> None:
    shape = {"shape": "circle", "centre": {"q": -1, "p": 0}, "scale": "0.1"}
    given = {"hamiltonian": "p**2/2 + q**3/3", "shape": shape, "h": "1/2", "distance": True}
    image = carried(steps=8, **given)
    assert image.distance is None
    assert image.area_change is not None
    assert image.problem == ""
    assert carried(steps=1, **given).distance is not None


def test_a_curve_too_long_for_the_nodes_is_not_tried_with_more_digits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """float64's nodes do not resolve it, and so none do; a small change does need more digits."""
    monkeypatch.setattr(region_area, "MOST_NODES", FEWER_NODES)
    pendulum = "p**2/2 - cos(q)"
    shape = {"shape": "circle", "scale": "0.1"}
    torn = carried(hamiltonian=pendulum, shape=shape, h=1000, steps=5, mean_lambda=False)
    assert torn.arithmetic == "float64"
    assert "is not 100 times below" in torn.problem
    small = carried(hamiltonian=pendulum, shape=shape, h="1e-4", steps=1, mean_lambda=False)
    assert small.arithmetic != "float64"
    assert small.problem == ""


def test_a_greatest_value_is_no_better_known_than_those_that_may_be_greater() -> None:
    assert _greatest_with_error([(1.0, 0.25), (0.5, 0.125)]) == (1.0, 0.25)
    assert _greatest_with_error([(1.0, 0.25), (0.5, 2.0)]) == (1.0, 1.5)


def test_an_image_that_is_not_resolved_is_told_even_where_area_is_preserved(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A step a thousand long shears the face beyond what any number of nodes follows."""
    monkeypatch.setattr(region_area, "MOST_NODES", FEWER_NODES)
    image = carried(scheme="symplectic-euler", h=1000, steps=3, mean_lambda=False)
    assert "is not resolved" in image.problem
    assert image.area_change is None
    assert carried(scheme="symplectic-euler", mean_lambda=False).problem == ""
