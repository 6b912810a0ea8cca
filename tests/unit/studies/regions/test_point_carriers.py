"""How many more bits are looked at of an outline that is small: by its longer side."""

from fractions import Fraction

import pytest

from tests.helpers.known_areas import polygon
from verify.studies.regions.point_carriers import smaller_than_one


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(
    ("longer", "bits"),
    [("1/1000", 9), ("1/1024", 9), ("1/1025", 10), ("1", 0), ("1000", 0), ("1/10**30", 99)],
)
def test_the_longer_side_counts_wherever_it_lies(longer: str, bits: int, turned: bool) -> None:
    size = Fraction(1, 10**30) if "**" in longer else Fraction(longer)
    flat, far = size / 10**6, Fraction(7)
    corners = [(far, far), (far + size, far), (far + size, far + flat), (far, far + flat)]
    if turned:
        corners = [(y, x) for x, y in corners]
    assert abs(smaller_than_one(polygon(*corners)) - bits) <= 1
