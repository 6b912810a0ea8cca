"""Planted errors of the area's probe are seen, and rounding is measured."""

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from tests.helpers.known_areas import (
    CAT,
    CHANGED,
    CIRCLE,
    DUFFING,
    SQUARE,
    MadePlane,
    bent,
    floats,
    linear_determinant,
    measured,
    pi,
    placed,
    still,
    wide,
)
from verify.studies.regions import region_area as area_probe
from verify.studies.regions.region_area import Goal, MeasuredArea, Probe

TRUE = linear_determinant("lie3", Fraction(1, 20), 40)


def test_a_panel_that_is_dropped_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right = Probe._build_result

    def planted(self: Probe, families: Any, *rest: Any) -> MeasuredArea:
        return right(self, families[1:], *rest)

    monkeypatch.setattr(Probe, "_build_result", planted)
    found = measured(SQUARE, MadePlane(bent))
    assert abs(found.change - Fraction(1, 3)) > 100 * found.error


def test_steps_that_are_wrong_by_one_are_seen() -> None:
    found = measured(placed(CIRCLE, 1, 0, "1/2"), floats("lie3", Fraction(1, 20), 41))
    assert abs(found.change - TRUE) > 100 * found.error
    assert abs(found.change - linear_determinant("lie3", Fraction(1, 20), 41)) <= found.error


@pytest.mark.left_to_ci
def test_a_wrong_number_of_the_rule_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right = area_probe.rule

    def planted(bits: int) -> Any:
        made = right(bits)
        swept = made.area_matrix.copy()
        swept[2, 3] += swept[2, 3] // 10**6
        return type(made)(made.bits, made.nodes, made.weights, made.derivative, swept)

    monkeypatch.setattr(area_probe, "rule", planted)
    area = measured(CIRCLE, still()).area
    assert abs(area / pi(Fraction(1)) - 1) > 1e-9


def test_rounding_is_measured_in_both_arithmetics() -> None:
    """A map that loses digits in float64 says so."""

    def lossy(x: Any, y: Any) -> tuple[Any, Any]:
        return (x + 1000) - 1000, y + 0

    found = measured(CIRCLE, MadePlane(lossy), Goal(Fraction(0), Fraction(1, 10**9)))
    assert abs(found.change) <= found.error
    assert found.rounding_error > 1e-13
    assert measured(CIRCLE, still()).rounding_error < 1e-15


def test_a_sample_of_panels_in_finer_arithmetic_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    outline = placed(CAT, 1, 0, "1/2")
    plane = wide("lie2", Fraction(1, 20), 40, DUFFING)
    few = measured(outline, plane, CHANGED)
    monkeypatch.setattr(plane, "sampled", 1 << 30)
    every = measured(outline, plane, CHANGED)
    assert few.change == every.change
    assert every.rounding_error / 8 <= few.rounding_error <= 8 * every.rounding_error


@pytest.mark.parametrize("sampled", [1, 3, 10, 1000])
def test_the_rounding_of_a_sample_stands_for_all_panels(sampled: int) -> None:
    """100 panels of two halves, each of which loses 5 units, without regard to its sign."""
    panels = [SimpleNamespace(start=k, parts=(7 * k, -k)) for k in range(100)]
    probe = object.__new__(Probe)
    vars(probe).update(
        goals=[None],
        carrier=SimpleNamespace(radius=None, sampled=sampled, finer=None),
        _select_outline=lambda families, _: families,
        _images=lambda starts, _: starts,
        _areas=lambda starts: [(7 * k + 2, -k - 3) for k in starts],
    )
    (found,) = probe._roundings([SimpleNamespace(halves=panels)])  # type: ignore[list-item]
    assert found == 2 * 5 * len(panels)
