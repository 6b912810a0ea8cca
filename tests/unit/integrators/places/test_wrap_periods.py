"""A period is one of the field itself: what nearly repeats does not, and half a period may do."""

import math
from fractions import Fraction

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.places.wrap_periods import find_wrapped_periods, periods_of, unwrap

PI = Fraction(math.pi)


@pytest.mark.parametrize(
    ("formula", "turns"),
    [
        ("p**2/2 - cos(q)", [0, 1]),
        ("p**2/2 - cos(3*q/2)", [0, Fraction(2, 3)]),
        ("p**2/2 - cos(q)**2", [0, Fraction(1, 2)]),
        ("p**2/2 - cos(2*q) - sin(3*q)/2", [0, 1]),
        ("cos(p)*cos(q)", [1, 1]),
        ("p**2/2 - cos(q) + q/7", [0, 1]),  # the force repeats, though H does not
        ("p**2/2 - cos(q) + q**2/1000", [0, 0]),
        ("p**2/2 - cos(q) + q**2/10**25", [0, 0]),
        ("p**2/2 - cos(q) - cos(sqrt(2)*q)", [0, 0]),
        ("p**2/2 + p*sin(q) + q**4/4", [0, 0]),
        ("p**2/2 - cos(q)*cos(t)", [0, 1]),
        ("p**2/2 + q**2/2", [0, 0]),
        ("sqrt(1/2 - p) - cos(q)", [0, 1]),  # at two of the points; and at one, which is too few
        ("sqrt(1/5 - p) - cos(q)", [0, 0]),
        ("p1**2/2 + p2**2/2 - cos(q1) - cos(q1 - q2)", [0, 0, 1, 1]),
        ("p1**2/2 + p2**2/2 - cos(q1) - cos(q1 - q2) + q2**2/10**20", [0, 0, 1, 0]),
    ],
)
def test_a_coordinate_has_the_period_of_the_field(formula: str, turns: list[Fraction]) -> None:
    text = formula.replace("10**25", f"{10**25}").replace("10**20", f"{10**20}")
    found = periods_of(Hamiltonian.parse(text))
    assert [x / (2 * PI) for x in found] == pytest.approx([float(x) for x in turns], abs=1e-14)


def test_a_step_is_compared_modulo_what_it_reduces_and_nothing_else() -> None:
    """Ends that are a whole number of periods from the flow's; and others."""
    pendulum, (_, period) = (
        Hamiltonian.parse("p**2/2 - cos(q)"),
        periods_of(Hamiltonian.parse("p**2/2 - cos(q)")),
    )
    flow, h = (Fraction(1), Fraction(7)), Fraction(1, 10**6)
    assert find_wrapped_periods([(flow, flow)], pendulum, h) == ()
    for k in (-2, -1, 1):
        ends = [((flow[0], flow[1] + k * period), flow), (flow, flow)]
        assert find_wrapped_periods(ends, pendulum, h) == (0, period)
    for off in (Fraction(1, 50), Fraction(1, 2), period / 2):
        assert find_wrapped_periods([((flow[0], flow[1] + period + off), flow)], pendulum, h) == ()
    assert find_wrapped_periods([((flow[0] + period, flow[1]), flow)], pendulum, h) == ()
    assert unwrap(flow[1] + 3 * period, Fraction(6), period) == flow[1]
    assert unwrap(flow[1], Fraction(6), Fraction(0)) == flow[1]
