"""For random H, schemes and outlines: the change of area is the mean of Λ."""

from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.known_areas import measured
from tests.helpers.sampled.formulas import polynomials
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.many_points import LeftRangeError
from verify.scenes.shapes.outline import Outline
from verify.scenes.shapes.user_outline import polygon
from verify.schemes import get
from verify.studies.regions.mean_lambda import mean_over
from verify.studies.regions.point_carriers import FloatCarrier
from verify.studies.regions.region_area import Goal

GOAL = Goal(change=Fraction(1, 10**5), area=Fraction(1, 10**13))
schemes = st.sampled_from(["lie1", "lie2", "lie3"])
coordinates = st.integers(-8, 8).map(lambda n: Fraction(n, 10))


@st.composite
def outlines(draw: st.DrawFn) -> tuple[Outline, tuple[float, float]]:
    """A triangle about some point, which is given too."""
    q, p = draw(coordinates), draw(coordinates)
    a, b, c = (draw(st.integers(1, 6).map(lambda n: Fraction(n, 10))) for _ in range(3))
    corners = [(q + a, p - a / 2), (q - b / 3, p + b), (q - c, p - c)]
    return polygon(corners).outlines[0], (float(q), float(p))


@pytest.mark.left_to_ci
@drawn(16)
@given(polynomials(degree=4, most_terms=3), schemes, outlines(), st.integers(1, 6))
def test_the_change_of_area_is_the_mean_of_lambda(
    formula: str, scheme: str, drawn: tuple[Outline, tuple[float, float]], steps: int
) -> None:
    hamiltonian, (outline, centre) = Hamiltonian.parse(formula), drawn
    h = Fraction(1, 50)
    assume(not get(scheme).step_map(hamiltonian).preserves_area)
    try:
        area = measured(outline, FloatCarrier(hamiltonian, scheme, h, steps, Fraction(0)), GOAL)
        mean = mean_over(outline, centre, hamiltonian, scheme, h, steps)
    except LeftRangeError:
        assume(False)
    off = abs(Fraction(mean.value) - area.change)
    assert off <= Fraction(mean.error) + area.error, (formula, scheme, steps, outline, area.change)
    # One step more is another map, and told from it.
    other = mean_over(outline, centre, hamiltonian, scheme, h, steps + 1)
    errors = Fraction(mean.error) + Fraction(other.error) + 2 * area.error
    if abs(Fraction(other.value) - Fraction(mean.value)) > 2 * errors:
        assert abs(Fraction(other.value) - area.change) > Fraction(other.error) + area.error
