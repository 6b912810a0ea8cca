"""The largest step with bounded motion, and the map of step size and stiffness."""

from fractions import Fraction
from typing import Any

import pytest

from verify.flows.exact_orbit import exact_orbit
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.verdict_results import largest_step, linear_limit, stability_map

ONE, NONE = Fraction(1), Fraction(0)
HARMONIC = Hamiltonian.parse("p**2/2 + w**2*q**2/2", {"w": "3"})
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + d*q**4/4", {"d": "1"})
# Masses 1 with springs 1 and 4, whose normal frequencies are 1 and 3.
COUPLED = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + q2**2)/2 + k*(q1 - q2)**2", {"k": "2"})
PLANE: dict[str, Any] = {"p": NONE, "q": ONE}
DEGREES: dict[str, Any] = {"p": (NONE, NONE), "q": (ONE, NONE)}


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("scheme", ["lie3", "lie4", "symplectic-euler", "stormer-verlet", "rk4"])
def test_on_a_linear_problem_the_largest_step_is_that_of_linear_theory(scheme: str) -> None:
    found = largest_step(HARMONIC, scheme, p=NONE, q=ONE, time=Fraction(100))
    assert found.linear is not None
    assert found.bounded is not None
    assert found.unbounded is not None
    bounded, unbounded, linear = map(Fraction, (found.bounded, found.unbounded, found.linear))
    assert 1 < unbounded / bounded < Fraction(1002, 1000)
    assert abs(bounded / linear - 1) < Fraction(1, 50)


@pytest.mark.parametrize(
    ("h", "scheme", "start", "times"),
    [(HARMONIC, "lie2", PLANE, (30, 300)), (COUPLED, "euler", DEGREES, (5, 20))],
    ids=["plane", "degrees"],
)
def test_where_linear_theory_allows_no_step_it_is_the_time_that_decides(
    h: Hamiltonian, scheme: str, start: dict[str, Any], times: tuple[int, int]
) -> None:
    short, long = (largest_step(h, scheme, **start, time=Fraction(time)) for time in times)
    assert short.linear == long.linear == "0"
    assert short.bounded is not None
    assert long.bounded is not None
    assert Fraction(long.bounded) < Fraction(short.bounded)


def test_near_an_equilibrium_of_a_nonlinear_problem_linear_theory_holds() -> None:
    found = largest_step(
        DUFFING, "stormer-verlet", p=NONE, q=Fraction(1, 10**4), time=Fraction(300)
    )
    assert found.bounded is not None
    assert abs(Fraction(found.bounded) - 2) < Fraction(1, 20)


@pytest.mark.parametrize(
    ("formula", "start", "time", "said"),
    [
        ("p**2/2 + q**2/2 - q**3/3", PLANE | {"q": Fraction(3, 2)}, 10, "blows up at t = 3.14159"),
        ("(p1**2 + p2**2 - q1**2 - q2**2)/2", DEGREES, 40, "is 1e+06 times as far out as z0"),
    ],
    ids=["plane", "degrees"],
)
def test_an_exact_solution_that_leaves_has_no_largest_step(
    formula: str, start: dict[str, Any], time: int, said: str
) -> None:
    found = largest_step(Hamiltonian.parse(formula), "rk4", **start, time=Fraction(time))
    assert (found.bounded, found.unbounded) == (None, None)
    assert str(found.detail).startswith(f"the exact solution {said}")


def test_what_never_fails_is_told() -> None:
    free = Hamiltonian.parse("p**2/2")
    found = largest_step(free, "lie2", p=ONE, q=NONE, time=Fraction(10))
    assert found.unbounded is None
    assert found.detail == "bounded with every step size looked at"


def test_the_limit_of_a_scheme_that_linear_theory_does_not_know_is_none() -> None:
    assert linear_limit("p_next = p - h*q**3; q_next = q + h*p_next") is None
    assert linear_limit("stormer-verlet") == 2


def test_the_greatest_frequency_is_that_at_the_stiffest_point() -> None:
    orbit = exact_orbit(DUFFING, NONE, Fraction(5), Fraction(1))
    assert abs(float(orbit.frequency) - 76**0.5) < 1e-12  # 1 + 3 q² at q = 5


def test_the_map_turns_at_the_line_of_linear_theory() -> None:
    values = [Fraction(1), Fraction(10), Fraction(100)]
    sizes = [Fraction(n, 1000) for n in (19, 21, 190, 210, 1900, 2100)]
    found = stability_map(
        HARMONIC,
        "stormer-verlet",
        parameter="w",
        values=values,
        step_sizes=sizes,
        steps=800,
        p=NONE,
        q=ONE,
    )
    for value, linear, row in zip(values, found.linear, found.cells, strict=True):
        assert linear is not None
        assert Fraction(linear) == 2 / value
        expected = ["stable" if h < Fraction(linear) else "unstable: scheme" for h in sizes]
        assert [cell.kind for cell in row] == expected
