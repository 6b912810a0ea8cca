"""Where corners are and shear stretches, a curve is refined, and its error says how well."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
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
    measured,
    placed,
)
from verify.studies.regions import region_area as area_probe
from verify.studies.regions.region_area import Goal, Probe


def test_panels_end_at_corners_and_corners_are_kept() -> None:
    found = measured(SQUARE, MadePlane(bent))
    assert abs(found.change - Fraction(1, 3)) <= found.error < 1e-12
    arcs = {panel.arc for panel in found.panels}
    assert arcs == {0, 1, 2, 3}
    for arc in arcs:
        own = [panel for panel in found.panels if panel.arc == arc]
        assert (own[0].left, own[-1].right) == (0, 1)
        assert all(a.right == b.left for a, b in pairwise(own))


def test_a_corner_that_is_rounded_off_is_seen() -> None:
    def smoothed(x: Any, y: Any) -> tuple[Any, Any]:
        near = np.hypot(x - 1, y - 1) < 0.01
        return np.where(near, x * 0.999, x), np.where(near, y * 0.999, y)

    right = measured(SQUARE, MadePlane(lambda x, y: (x + 0, y + 0)))
    wrong = measured(SQUARE, MadePlane(smoothed))
    assert right.change == 0
    assert abs(wrong.change) > 1e-6
    assert wrong.error > 1e3 * right.error, "what is not smooth between corners is seen to be so"


def sheared(turns: float) -> MadePlane:
    """By an angle that grows with the radius; area is preserved."""

    def twist(x: Any, y: Any) -> tuple[Any, Any]:
        by = turns * (x * x + y * y)
        return x * np.cos(by) - y * np.sin(by), x * np.sin(by) + y * np.cos(by)

    return MadePlane(twist)


def test_the_curve_is_refined_where_shear_stretches_it_and_the_error_stays() -> None:
    goal = Goal(Fraction(0), Fraction(1, 10**9))
    outline = placed(CIRCLE, 1, 0, "1/2")
    found = [measured(outline, sheared(turns), goal) for turns in (0.1, 10.0, 60.0)]
    assert found[0].nodes < found[1].nodes < found[2].nodes
    for one in found:
        assert abs(one.change) <= one.error < 2e-9
    lengths = [panel.right - panel.left for panel in found[2].panels]
    assert max(lengths) > min(lengths), "only where it is needed"


def test_too_few_nodes_are_told_by_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(area_probe, "_MOST_ROUNDS", 0)
    found = measured(placed(CIRCLE, 1, 0, "1/2"), sheared(60.0))
    assert abs(found.change) > 1e-6
    assert abs(found.change) <= found.error


def test_several_outlines_are_measured_as_each_by_itself() -> None:
    plane = floats("lie2", Fraction(1, 10), 30, DUFFING)
    outlines = [placed(CAT, 1, 0, "1/2"), placed(CIRCLE, 0, 1, "1/9")]
    both = Probe(outlines, plane, [CHANGED, CHANGED]).measure()
    for outline, one in zip(outlines, both, strict=True):
        alone = measured(outline, plane, CHANGED)
        assert abs(one.change - alone.change) <= one.error + alone.error
        assert abs(one.area - alone.area) < 1e-14
