"""A name that is likely meant for a p or q that is missing."""

import pytest

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian


@pytest.mark.parametrize(
    ("formula", "named"),
    [
        ("v**2/2 + x**2/2", "has no p and no q; are v, x meant"),
        ("p**2/2 + x**2/2", "has no q; is x meant"),
        ("p1**2/2 + p**2/2 + q**2", "has p1 beside p and q; allowed: p and q alone"),
        ("p1**2/2 + q3*p3", "has p1, p3, q3, and neither p2 nor q2"),
        ("p1 + p70", "has 70 degrees of freedom; allowed: up to 64"),
        ("P**2/2 + Q**2/2", "are P, Q meant"),
        ("p**2/2 - cos(theta)", "has no q; is theta meant"),
        ("vx*q", "has no p; is vx meant"),
        ("y**2/2 + q**2/2", "has no p; is y meant"),
        ("dq/dt + p", "has no q; is dq meant"),
        ("p**2/2 + pq", r"has no q, and pq would be a parameter; write p\*q"),
        ("p**2/2 - cosq", r"and cosq would be a parameter; write cos\(q\)"),
    ],
)
def test_it_is_refused_with_that_meaning(formula: str, named: str) -> None:
    with pytest.raises(InputError, match=named):
        Hamiltonian.parse(formula)


@pytest.mark.parametrize(
    "formula",
    ["p**2/2", "p**2/(2*m)", "m*g*q", "omega**2*q**2", "a + b", "3", "p*v", "phi*q",
     "alpha*p**2", "M*g*q", "p**2/2 + q**2/2 + x*q + v*p", "p**2/2 + q0", "V*q",
     "p*q + pq", "p + cosq*q", "pendulum*p + q", "mu*p**2"],
)  # fmt: skip
def test_what_may_well_be_a_parameter_is_one(formula: str) -> None:
    assert Hamiltonian.parse(formula).parameters is not None


def test_a_name_with_a_value_is_a_parameter() -> None:
    assert Hamiltonian.parse("p**2/2 + x", {"x": 2}).parameters == ("x",)
    with pytest.raises(InputError, match="is x meant"):
        Hamiltonian.parse("p**2/2 + x", {"x": None})


def test_numbered_names_are_coordinates_unless_they_have_a_value() -> None:
    several = Hamiltonian.parse("p1**2/2 + k*q2 + t")
    assert several.coordinates == ("p1", "p2", "q1", "q2")
    assert (several.degrees, several.parameters, several.planar) == (2, ("k",), False)
    named = Hamiltonian.parse("p**2/2 + q1*q", {"q1": 2})
    assert (named.coordinates, named.parameters) == (("p", "q"), ("q1",))
    assert Hamiltonian.parse("p**2/2 + q0*q").parameters == ("q0",)


def test_what_is_of_the_plane_refuses_several_degrees_in_one_line() -> None:
    several = Hamiltonian.parse("p1**2/2 + q1**2*q2")
    with pytest.raises(InputError, match="is of p1, p2, q1, q2; what is asked for takes p and"):
        several.check_planar()
    Hamiltonian.parse("p**2/2 + q").check_planar()
