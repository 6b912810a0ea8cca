"""Which flow an H is recognised to have, in other words too, and what only looks like it."""

from fractions import Fraction
from typing import Any

import pytest

from tests.unit.flows.test_solution import DUFFING, ELLIPSES, KEPLER, PENDULUM, apart, solve
from verify.flows.solution import numerical_solution
from verify.hamiltonians.flow_recognition import closed_form, named_systems, potential, uncouple
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of

SAME: dict[str, tuple[str, str]] = {
    "duffing": ("p**2/2 + q**2/2 + q**4/4", DUFFING),
    "shifted": ("p**2/2 + 1 - cos(q)", PENDULUM),
    "morse": ("p**2/2 + 2*(1 - exp(-3*q/2))**2", "p**2/2 + D*(1 - exp(-a*q))**2"),
    "morse-expanded": ("p**2/2 - 4*exp(-q) + 2*exp(-2*q) + 7", "p**2/2 + D*(1 - exp(-a*q))**2"),
    "morse-mirrored": ("p**2/2 + 3*(exp(q) - 1)**2", "p**2/2 + D*(1 - exp(-a*q))**2"),
    "toda": ("p**2/2 + exp(q) + exp(-q) - 2", "p**2/2 + exp(q) + exp(-q)"),
    "twist": ("p**4/4 + p**2*q**2/2 + q**4/4", "(p**2 + q**2)**2/4"),
    "any-quartic": ("3*p**2 + q - q**2/7 + q**3/5 + q**4", ""),
    "a-mass": ("p**2/20 + 10*q**2", ""),
    "double-well": ("p**2/2 + (q**2 - 4)**2/4", ""),
}


TIMES = ("1/7", "3", "-2")
SAME_FLOWS = [
    *(
        pytest.param(Hamiltonian.parse(formula), "1/3", "1/2", "7/5", 30, id=name)
        for name, (formula, _) in SAME.items()
    ),
    *(
        pytest.param(KEPLER, *start, time, 25, id=f"{name}, t = {time}",
                     marks=pytest.mark.sample(2))
        for name, start in ELLIPSES.items() for time in TIMES
    ),
]  # fmt: skip


@pytest.mark.parametrize(("formula", "system"), SAME.values(), ids=SAME)
def test_a_known_flow_is_recognised_in_other_words(formula: str, system: str) -> None:
    hamiltonian = Hamiltonian.parse(formula)
    assert closed_form(hamiltonian, Fraction(1, 3), Fraction(1, 2)) is not None
    if system:
        assert system in {n.system.formula for n in named_systems(hamiltonian)} or potential(
            hamiltonian
        )


@pytest.mark.parametrize(("h", "p", "q", "time", "digits"), SAME_FLOWS)
def test_a_closed_form_is_where_the_numerical_flow_ends(
    h: Hamiltonian, p: Any, q: Any, time: str, digits: int
) -> None:
    end = solve(h, p, q, time, digits)
    other = numerical_solution(h, point_of(h, q, p), Fraction(time), digits, Fraction(0))
    assert end.enclosed
    assert "closed form" in end.method
    assert ("ellipse" in end.method) == (h is KEPLER)
    assert not other.enclosed
    assert apart(end, other) <= end.bound + other.bound < Fraction(1, 10 ** (digits - 2))


def test_the_parameters_are_read_off() -> None:
    (flow,) = named_systems(Hamiltonian.parse("p**2/2 + 2*(1 - exp(-3*q/2))**2"))
    assert (flow.system.name, dict(flow.values)) == ("morse", {"D": 2, "a": Fraction(3, 2)})


OTHERS = [
    "p**2/2 + 2*(1 - exp(-3*q/2))**2 + q", "p**2/2 - cos(q)/2", "p**2 - cos(q)",
    "p**2/2 + q**5", "p**2/2 + q*p**2", "p**4/4 + q**2/2", "p**2/2 + exp(q) + 2*exp(-q)",
    "p + q**2", "p**2/2 + 2*exp(-3*q) - 4*exp(-q)", "p**2/2 + pi*q**2", "cos(p) - cos(q)",
    "p**2/2 + p*q + q**2", "p**4/4 + p**2*q**2/3 + q**4/4", "q**2/2", "p**3 + exp(p*q) + sin(q)",
]  # fmt: skip


@pytest.mark.parametrize("formula", OTHERS)
def test_what_only_looks_like_a_known_flow_is_not_taken_for_one(formula: str) -> None:
    assert closed_form(Hamiltonian.parse(formula), Fraction(1, 3), Fraction(1, 2)) is None


def test_another_potential_is_not_taken_for_keplers() -> None:
    """1/r + r²/10⁶: at two points near the centre it looks the same."""
    other = Hamiltonian.parse("(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2) + (q1**2 + q2**2)/10**6")
    start = ELLIPSES["pericentre"]
    end = solve(other, *start, 1, 25)
    assert not end.enclosed
    assert apart(end, solve(KEPLER, *start, 1, 25)) > Fraction(1, 10**8)


def test_parts_are_those_coordinates_that_are_coupled() -> None:
    whole = Hamiltonian.parse("p1**2/2 - cos(q1) + p2**2/2 + q2**4/4 + p3*q4 + p4*q3")
    parts = [names for _, names in uncouple(whole)]
    assert parts == [("p1", "q1"), ("p2", "q2"), ("p3", "p4", "q3", "q4")]
