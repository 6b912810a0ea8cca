"""The largest step and the map of step size and stiffness in n degrees of freedom."""

from fractions import Fraction
from typing import Any

import pytest

from tests.unit.studies.stability.test_verdict_results import COUPLED, DEGREES
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.scenes.scene import scene_from
from verify.studies.stability.verdict_results import largest_step, stability_map

HENON_HEILES = systems.get("henon-heiles").hamiltonian({})
REGULAR: dict[str, Any] = {
    "q": (Fraction(0), Fraction(1, 10)),
    "p": (Fraction(2, 5), Fraction(0)),
}


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("scheme", "limit"), [("stormer-verlet", 2), ("rk4", 8**0.5)])
def test_on_a_quadratic_h_the_largest_step_is_that_of_its_fastest_normal_mode(
    scheme: str, limit: float
) -> None:
    found = largest_step(COUPLED, scheme, **DEGREES, time=Fraction(80))
    assert found.q == ("1", "0")
    assert found.bounded is not None
    assert found.linear is not None
    assert float(found.linear) == pytest.approx(limit / 3, rel=1e-3)
    assert float(found.bounded) == pytest.approx(limit / 3, rel=0.02)


@pytest.mark.left_to_ci
def test_criteria_beside_the_bounds_make_the_step_smaller_where_they_are_not_kept() -> None:
    """A symplectic scheme keeps the form at every step size; its energy error is of order 2."""
    most, finer = Fraction(1, 100), Fraction(1, 400)
    given: dict[str, Any] = {**REGULAR, "time": Fraction(15)}
    plain = largest_step(HENON_HEILES, "stormer-verlet", **given)
    of_form = largest_step(HENON_HEILES, "stormer-verlet", **given, symplectic_defect=most)
    one, four = (
        largest_step(HENON_HEILES, "stormer-verlet", **given, energy_error=x) for x in (most, finer)
    )
    assert of_form.bounded == plain.bounded
    assert plain.bounded is not None
    assert one.bounded is not None
    assert four.bounded is not None
    assert float(one.bounded) < float(plain.bounded) / 2
    assert float(one.bounded) / float(four.bounded) == pytest.approx(2, rel=0.1)
    lie2 = largest_step(HENON_HEILES, "lie2", **given, symplectic_defect=most)
    free = largest_step(HENON_HEILES, "lie2", **given)
    assert lie2.bounded is not None
    assert free.bounded is not None
    assert float(lie2.bounded) < float(free.bounded) / 4


@pytest.mark.left_to_ci
def test_the_map_turns_at_the_line_of_linear_theory() -> None:
    values = [Fraction(0), Fraction(4)]  # frequencies 1 and 1, 1 and √17
    sizes = [Fraction(n, 100) for n in (47, 50, 195, 205)]
    found = stability_map(
        COUPLED,
        "stormer-verlet",
        parameter="k",
        values=values,
        step_sizes=sizes,
        steps=60,
        **DEGREES,
    )
    for most, linear, row in zip((2, 2 / 17**0.5), found.linear, found.cells, strict=True):
        assert linear is not None
        assert float(linear) == pytest.approx(most, rel=1e-3)
        expected = ["stable" if h < most else "unstable: scheme" for h in sizes]
        assert [cell.kind for cell in row] == expected


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"energy_error": "0"}, "energy_error=0: must be greater than 0"),
        ({"initial_value": {"q": 1, "p": 0}}, "p=0: has 1 of 2 numbers"),
    ],
)
def test_mistakes_are_told(more: dict[str, Any], said: str) -> None:
    section = {"time": 1, "initial_value": {"q": [0, "0.1"], "p": [0, 0]}, **more}
    given = {"system": "henon-heiles", "schemes": ["rk4"], "largest_step": [section]}
    with pytest.raises(InputError, match=said):
        scene_from(given, "mine")


def test_the_form_is_carried_in_up_to_four_degrees_of_freedom() -> None:
    start = {"q": ["0.1"] * 5, "p": [0] * 5}
    section = {"time": 1, "initial_value": start, "symplectic_defect": "0.1"}
    parameters = {"n": 5, "alpha": "1/4", "beta": 0}
    given = {"system": "fput", "parameters": parameters, "schemes": ["rk4"]}
    with pytest.raises(InputError, match="up to 4 degrees of freedom"):
        scene_from({**given, "largest_step": [section]}, "mine")
    del section["symplectic_defect"]
    scene_from({**given, "largest_step": [section]}, "mine")
