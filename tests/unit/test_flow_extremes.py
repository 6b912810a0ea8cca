"""Regions that are tiny, far away, or more than fixed point has room for."""

from fractions import Fraction

import pytest

from tests.unit.carried import linear_determinant
from tests.unit.test_flow import OSCILLATOR, carried, within

TRUE = linear_determinant("lie2", Fraction(1, 10), 10)


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
