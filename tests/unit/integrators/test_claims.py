"""What is claimed of a step that is no scheme: the order is refuted, and what it has is not."""

from collections.abc import Callable
from typing import Any

import pytest

from tests.helpers.programs import remembering_steps
from tests.helpers.programs import user_steps as own_steps
from tests.helpers.programs.judged import judged as found_of
from verify.integrators.results import NO_CLAIMS, Claims

Function = Callable[..., Any]


@pytest.mark.left_to_ci
@pytest.mark.parametrize("function", [remembering_steps.nearly_the_force, own_steps.flipped])
def test_area_is_not_refuted_where_the_order_is(function: Function) -> None:
    """An error of 10⁻¹¹ in the force shows at steps of 10⁻¹¹."""
    for claims in (NO_CLAIMS, Claims(area_preserving=True), Claims(1, area_preserving=True)):
        found = found_of(function, claims)
        assert (found.verdict, found.area_preserving) == ("REFUTED", True)
        assert "the order is refuted, not det J ≡ 1, which is proved: not a sch" in found.reason
        assert found.counterexample is not None
        assert "from the exact flow after one step" in found.counterexample.quantity


def test_of_a_wrong_area_nothing_of_the_kind_is_said() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        return own_steps.lie2(p, q, h * (1 + 1e-11))

    found = found_of(step, Claims(area_preserving=True))
    assert found.verdict == "REFUTED"
    assert found.reason.startswith("det J ≡ 1 is claimed; ")
    kept = found_of(step, Claims(area_order=3))
    assert "the order is refuted, not ΔJ = O(h^3), which is proved" in kept.reason
