"""The bound of what rounding makes of a traced step holds what its inputs' errors make of it."""

from types import SimpleNamespace
from typing import Any

import mpmath
import pytest

from verify.integrators.measures.agreement import _evaluate_node

MP = mpmath.mp.clone()
MP.dps = 40
OPERATIONS: dict[str, Any] = {
    "add": lambda x, y: x + y, "subtract": lambda x, y: x - y, "multiply": lambda x, y: x * y,
    "divide": lambda x, y: x / y, "sin": lambda x: MP.sin(x), "exp": lambda x: MP.exp(x),
    "log": lambda x: MP.log(x), "sqrt": lambda x: MP.sqrt(x), "cosh": lambda x: MP.cosh(x),
    "tan": lambda x: MP.tan(x), "atan": lambda x: MP.atan(x),
}  # fmt: skip
PLACES = [(0.3, 1.7), (2.5, 0.04), (1.1, -3.0)]


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", OPERATIONS)
def test_each_inputs_error_is_magnified_by_the_slope(name: str, place: tuple[float, float]) -> None:
    """Each alone, and both: the bound is what is reached, to first order."""
    function, two = OPERATIONS[name], name in ("add", "subtract", "multiply", "divide")
    values = list(place) if two else [place[0]]
    node, small = SimpleNamespace(operation=name, value=None), 1e-7
    for off in ([small, 0.0], [0.0, small / 3], [small, small / 3]):
        errors = off[: len(values)]
        value, error = _evaluate_node(node, list(zip(values, errors, strict=True)), {})  # type: ignore[arg-type]
        exact = function(*(MP.mpf(x) for x in values))
        assert value == pytest.approx(float(exact), rel=1e-14)
        signs = [(a, b) for a in (1, -1) for b in (1, -1)]
        moved = [
            function(*(MP.mpf(x) + s * e for x, e, s in zip(values, errors, sign, strict=False)))
            for sign in signs
        ]
        largest = float(max(abs(x - exact) for x in moved))
        assert error == pytest.approx(largest, rel=1e-4, abs=1e-30)


@pytest.mark.parametrize("power", [-3, -1, 2, 3, 7])
def test_a_power_is_rounded_as_often_as_it_may_be_multiplied(power: int) -> None:
    node, (x, e) = SimpleNamespace(operation="power", value=power), (1.3, 1e-7)
    value, error = _evaluate_node(node, [(x, e)], {})  # type: ignore[arg-type]
    assert value == pytest.approx(x**power)
    slope = abs(power * x ** (power - 1)) * e
    assert slope <= error == pytest.approx(slope, rel=1e-5)
    _, alone = _evaluate_node(node, [(x, 0.0)], {})  # type: ignore[arg-type]
    assert 2.0**-54 * abs(power * value) <= alone <= 2.0**-50 * abs(power * value)
