"""The order of a step of arrays that lets neither symbols nor dual numbers through."""

import math
import struct
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tests.helpers.programs.judged import judged
from tests.unit.integrators.degrees import test_check_step as known
from verify.integrators.results import Claims, Finding
from verify.verdict import Verdict

Step = Callable[..., Any]


def packed(x: Any) -> float:
    """The float, by a way that no other number takes."""
    return float(struct.unpack("d", struct.pack("d", x))[0])


def blind(step: Step) -> Step:
    """The same step, of floats alone."""

    def own(p, q, h):
        p, q = (np.array([packed(x) for x in z]) for z in (p, q))
        return step(p, q, packed(h))

    return own


def in_time(p, q, t, h):
    """A kick at the middle of the step: of order 2."""
    p, q, t, h = [packed(x) for x in p], [packed(x) for x in q], packed(t), packed(h)
    q = [x + h / 2 * y for x, y in zip(q, p, strict=True)]
    kick = known.force(q) + np.array([math.cos(t + h / 2), 0])
    p = [x + h * y for x, y in zip(p, kick, strict=True)]
    return p, [x + h / 2 * y for x, y in zip(q, p, strict=True)]


def still(p, q, t, h):
    """The same at the step's beginning: of order 1."""
    p, q, t, h = [packed(x) for x in p], [packed(x) for x in q], packed(t), packed(h)
    q = [x + h / 2 * y for x, y in zip(q, p, strict=True)]
    kick = known.force(q) + np.array([math.cos(t), 0])
    p = [x + h * y for x, y in zip(p, kick, strict=True)]
    return p, [x + h / 2 * y for x, y in zip(q, p, strict=True)]


def found(step: Step, formula: str = known.HENON, **claims: Any) -> Finding:
    return judged(step, Claims(**claims), hamiltonian=formula)


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("step", "order", "symplectic"),
    [(known.euler, 1, False), (known.verlet, 2, True), (known.rk4, 4, False),
     (known.yoshida, 4, True)],
)  # fmt: skip
def test_the_order_is_seen(step: Step, order: int, symplectic: bool) -> None:
    said = found(blind(step), order=order)
    assert (said.how, said.verdict) == ("floats", Verdict.MEASURED)
    assert (said.convergence_order, said.order_decided) == (order, True)
    assert said.symplectic is symplectic
    assert f"the map's order is {order}" in str(said.reason)
    more = found(blind(step), order=order + 1)
    assert more.verdict is Verdict.REFUTED
    assert f"up to h^{order} only" in str(more.reason)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("step", [known.wrong_weights, known.no_potential])
def test_what_is_no_scheme_for_this_h_is_refuted(step: Step) -> None:
    said = found(blind(step))
    assert said.verdict is Verdict.REFUTED
    assert "not a scheme for this H" in str(said.reason)


@pytest.mark.left_to_ci
def test_a_clock_that_stands_still_is_seen() -> None:
    driven = f"{known.HENON} - q1*cos(t)"
    assert found(in_time, driven).convergence_order == 2
    assert found(still, driven, order=2).verdict is Verdict.REFUTED


def test_where_the_flow_is_known_nowhere_the_order_is_told_to_be_unknown() -> None:
    """Every probed point lies outside of where H is smooth."""
    outside = "p1**2/2 + p2**2/2 + sqrt(q1 - 50)**3 + sqrt(40 - q1) + q2**2"

    def any_step(p, q, h):
        return [packed(x) for x in p], [packed(x) for x in q]

    said = found(any_step, outside)
    assert (said.verdict, said.order_decided) == (Verdict.UNDECIDED, False)
    assert "H has no exact solution" in str(said.reason)
