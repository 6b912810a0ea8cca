"""What is seen of steps that compare values or hide in floats, and what is said not to be."""

import math
from typing import Any

import pytest

from tests.helpers.programs import user_steps as own_steps
from tests.helpers.programs.judged import judged as found_of
from verify.integrators.results import Claims, Finding
from verify.verdict import Verdict


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-5, 1e-6, 1e-7, 1e-8])
def test_what_a_loops_tolerance_leaves_is_refuted_with_its_size(tolerance: float) -> None:
    found = found_of(own_steps.midpoint_to(tolerance), Claims(area_preserving=True))
    assert (found.verdict, found.order) == ("REFUTED", None)
    assert found.largest is not None
    assert tolerance / 100 < found.largest < 100 * tolerance
    assert found.counterexample is not None
    if tolerance < 1e-5:  # what is claimed and seen does not need what is not
        assert found_of(own_steps.midpoint_to(tolerance), Claims(order=2)).verdict == "MEASURED"
        assert found_of(own_steps.midpoint_to(tolerance), Claims(order=3)).verdict == "REFUTED"


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("claims", [Claims(order=1), Claims(area_preserving=True)])
@pytest.mark.parametrize("change", [1e-2, 1e-3, 1e-4])
def test_a_friction_beside_a_loop_with_a_tolerance_is_seen(change: float, claims: Claims) -> None:
    assert found_of(own_steps.midpoint_to(1e-9, change), claims).verdict == "REFUTED"


def test_a_small_friction_in_a_black_box_is_not_taken_for_an_order() -> None:
    """ΔJ = O(h) contradicts the order 2 that is read off above it."""
    found = found_of(own_steps.midpoint_to(1e-15, 1e-9), Claims(order=2))
    assert found.verdict == "UNDECIDED"
    assert "which no map of order 2 does" in found.reason


@pytest.mark.parametrize("change", [0, 1e-6, 1e-8])
def test_a_black_box_tells_which_error_it_would_not_show(change: float) -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        new = own_steps.verlet(math.fmod(p, 99), q, h)
        return p + (new[0] - p) * (1 + change), q + (new[1] - q) * (1 + change)

    (note,) = (n for n in found_of(step).notes if n.startswith("in floats: an error"))
    unseen = float(note.partition("below about ")[2].partition(" of them")[0])
    assert 0.9 * change < unseen < max(10 * change, 1e-8)


def test_area_alone_does_not_show_a_scheme() -> None:
    """h^(3/2) in the step leaves its order open, though det J ≡ 1 is seen."""

    def step(p: Any, q: Any, h: Any) -> Any:
        root = math.sqrt(h)
        p = p - h * math.sin(q) * (1 + root)
        return p, q + h * p

    assert found_of(step, Claims(area_preserving=True)).verdict == "UNDECIDED"
    assert not Finding(Verdict.UNDECIDED, "", "duals", area_preserving=True).scheme
