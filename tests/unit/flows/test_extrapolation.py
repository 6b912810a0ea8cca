"""The numerical flow over long times."""

import math
from fractions import Fraction

import pytest

from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian


def test_a_flow_is_followed_there_and_back() -> None:
    flow = NumericalFlow(canonical_field(Hamiltonian.parse("p**2/2 + q**6/6"))[0], 25)
    z0 = flow.number(Fraction(1)), flow.number(Fraction(1, 3))
    there = flow.follow(z0, Fraction(60))
    back = flow.follow(there, Fraction(-60))
    assert math.hypot(*(float(x - y) for x, y in zip(back, z0, strict=True))) < 1e-15


def test_the_cost_of_following_is_bounded_and_the_time_reached_is_said() -> None:
    flow = NumericalFlow(canonical_field(Hamiltonian.parse("p**2/2 + q**6/6"))[0], 15)
    z0 = flow.number(Fraction(1)), flow.number(Fraction(1, 3))
    with pytest.raises(NoFlowError, match=r"^50 steps lead only to t = -?\d"):
        flow.follow(z0, Fraction(10**8), most_steps=50)


def test_the_flow_of_a_point_at_rest_stays() -> None:
    flow = NumericalFlow(canonical_field(Hamiltonian.parse("p**2/2 + q**6/6"))[0], 15)
    zero = flow.number(Fraction(0))
    assert flow.follow((zero, zero), Fraction(10**8)) == (zero, zero)


def test_a_flow_that_starts_where_h_is_not_defined_is_no_flow() -> None:
    flow = NumericalFlow(canonical_field(Hamiltonian.parse("p**2/2 + 1/q"))[0], 15)
    with pytest.raises(NoFlowError, match="where H is defined"):
        flow.follow((flow.number(Fraction(1)), flow.number(Fraction(0))), Fraction(1))


def test_a_flow_that_falls_into_a_pole_ends_there() -> None:
    """p²/2 − 1/q from rest at q = 1 falls into the pole at t = π/√8."""
    flow = NumericalFlow(canonical_field(Hamiltonian.parse("p**2/2 - 1/q"))[0], 15)
    z0 = flow.number(Fraction(0)), flow.number(Fraction(1))
    with pytest.raises(NoFlowError, match=r"at about t = 1\.110[67]"):
        flow.follow(z0, Fraction(2))


def test_a_step_that_is_followed_keeps_the_precision_it_was_asked_for() -> None:
    """The control of a step rounded to a float64: harmonic motion to 60 digits over 100 units."""
    flow = NumericalFlow(canonical_field(Hamiltonian.parse("p**2/2 + q**2/2"))[0], 60)
    z0 = flow.number(Fraction(0)), flow.number(Fraction(1))
    _, q = flow.follow(z0, Fraction(100))
    with flow.arithmetic.context():
        cosine = flow.arithmetic.functions["cos"](flow.number(Fraction(100)))
        assert abs(q - cosine) < 1e-57
