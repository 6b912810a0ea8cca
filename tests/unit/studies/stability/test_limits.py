"""The largest step with bounded motion, and the map of step size and stiffness."""

from fractions import Fraction

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.limits import frequency, largest_step, linear_limit, stability_map

ONE, NONE = Fraction(1), Fraction(0)
HARMONIC = Hamiltonian.parse("p**2/2 + w**2*q**2/2", {"w": "3"})
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + d*q**4/4", {"d": "1"})


@pytest.mark.parametrize("scheme", ["lie3", "lie4", "symplectic-euler", "stormer-verlet", "rk4"])
def test_on_a_linear_problem_the_largest_step_is_that_of_linear_theory(scheme: str) -> None:
    found = largest_step(HARMONIC, scheme, NONE, ONE, Fraction(300))
    assert found.linear is not None
    assert found.bounded is not None
    assert found.unbounded is not None
    assert 1 < found.unbounded / found.bounded < Fraction(1002, 1000)
    assert abs(found.bounded / found.linear - 1) < Fraction(1, 50)


def test_where_linear_theory_allows_no_step_it_is_the_time_that_decides() -> None:
    short, long = (largest_step(HARMONIC, "lie2", NONE, ONE, Fraction(time)) for time in (30, 300))
    assert short.linear == long.linear == 0
    assert short.bounded is not None
    assert long.bounded is not None
    assert long.bounded < short.bounded


def test_near_an_equilibrium_of_a_nonlinear_problem_linear_theory_holds() -> None:
    found = largest_step(DUFFING, "stormer-verlet", NONE, Fraction(1, 10**4), Fraction(300))
    assert found.bounded is not None
    assert abs(found.bounded - 2) < Fraction(1, 20)


def test_an_exact_solution_that_leaves_has_no_largest_step() -> None:
    cubic = Hamiltonian.parse("p**2/2 + q**2/2 - q**3/3")
    found = largest_step(cubic, "rk4", NONE, Fraction(3, 2), Fraction(10))
    assert (found.bounded, found.unbounded) == (None, None)
    assert found.detail == "the exact solution blows up at t = 3.14159"


def test_what_never_fails_is_told() -> None:
    free = Hamiltonian.parse("p**2/2")
    found = largest_step(free, "lie2", ONE, NONE, Fraction(10))
    assert found.unbounded is None
    assert found.detail == "bounded with every step size looked at"


def test_the_limit_of_a_scheme_that_linear_theory_does_not_know_is_none() -> None:
    assert linear_limit("p_next = p - h*q**3; q_next = q + h*p_next") is None
    assert linear_limit("stormer-verlet") == 2


def test_the_greatest_frequency_is_that_at_the_stiffest_point() -> None:
    found = largest_step(DUFFING, "stormer-verlet", NONE, Fraction(5), Fraction(1))
    assert abs(float(frequency(found.orbit)) - 76**0.5) < 1e-12  # 1 + 3 q² at q = 5


def test_the_map_turns_at_the_line_of_linear_theory() -> None:
    values = [Fraction(1), Fraction(10), Fraction(100)]
    sizes = [Fraction(n, 1000) for n in (19, 21, 190, 210, 1900, 2100)]
    rows = list(
        stability_map(
            HARMONIC,
            "stormer-verlet",
            parameter="w",
            values=values,
            step_sizes=sizes,
            steps=800,
            p=NONE,
            q=ONE,
        )
    )
    for value, (linear, row) in zip(values, rows, strict=True):
        assert linear == 2 / value
        expected = ["stable" if h < linear else "unstable: scheme" for h in sizes]
        assert [judgement.kind for judgement in row] == expected
