"""The exact flow in n degrees of freedom: closed forms against numbers, and what ends an orbit."""

from fractions import Fraction

import pytest

from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import (
    ExactSolution,
    exact_solution,
    numerical_solution,
    solution_from,
)
from verify.hamiltonians import systems
from verify.hamiltonians.flow_recognition import uncouple
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of

KEPLER = systems.get("kepler").hamiltonian({"mu": 1})
HENON = systems.get("henon-heiles").hamiltonian({})
DIGITS = 25
Start = tuple[list[str], list[str]]  # q, p
ELLIPSES: dict[str, Start] = {
    "circle": (["1", "0"], ["0", "1"]),
    "pericentre": (["2/5", "0"], ["0", "2"]),
    "on the way": (["3/5", "-1/3"], ["1/2", "4/5"]),
    "backwards": (["3/5", "1/3"], ["-1/2", "-4/5"]),
    "e = 0.999": (["1/1013", "0"], ["0", "45"]),
    "nearly straight": (["1/2", "0"], ["1/3", "1/50"]),
}


def after(hamiltonian: Hamiltonian, start: Start, time: str, digits: int = DIGITS) -> ExactSolution:
    q, p = start
    return exact_solution(hamiltonian, q=q, p=p, time=Fraction(time), digits=digits)


def apart(one: ExactSolution, other: ExactSolution) -> Fraction:
    return max(abs(one.point[name] - other.point[name]) for name in one.point)


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", ELLIPSES)
@pytest.mark.parametrize("time", ["1/7", "3", "-2"])
def test_an_ellipse_in_closed_form_is_that_of_the_numerical_flow(name: str, time: str) -> None:
    found = after(KEPLER, ELLIPSES[name], time)
    start = point_of(KEPLER, *ELLIPSES[name])
    other = numerical_solution(KEPLER, start, Fraction(time), DIGITS, Fraction(0))
    assert found.enclosed
    assert "ellipse" in found.method
    assert not other.enclosed
    assert apart(found, other) <= found.bound + other.bound


def test_a_circle_is_known_without_any_equation() -> None:
    """cos and sin of t, to 40 digits, from a library that has nothing to do with it."""
    from mpmath import mp, mpf

    found = after(KEPLER, ELLIPSES["circle"], "1000", 40)
    with mp.workdps(60):
        for name, true in (("q1", mp.cos(1000)), ("q2", mp.sin(1000)), ("p1", -mp.sin(1000))):
            x = found.point[name]
            assert abs(mpf(x.numerator) / x.denominator - true) < mpf(10) ** -40
    assert found.bound < Fraction(1, 10**40)


def test_energy_and_angular_momentum_stay_on_a_long_thin_ellipse() -> None:
    found = after(KEPLER, ELLIPSES["e = 0.999"], "100", 50)
    p1, p2, q1, q2 = found.point.values()
    turn = Fraction(45, 1013)
    assert abs(q1 * p2 - q2 * p1 - turn) < Fraction(1, 10**45)
    # (|p|²/2 − H)² |q|² = 1
    energy = Fraction(45**2, 2) - 1013
    kinetic = (p1 * p1 + p2 * p2) / 2 - energy
    assert abs(kinetic * kinetic * (q1 * q1 + q2 * q2) - 1) < Fraction(1, 10**45)


@pytest.mark.parametrize(
    ("start", "time"), [((["1", "0"], ["0", "2"]), "3"), ((["1", "0"], ["1/2", "0"]), "1/2")]
)  # fmt: skip
def test_what_is_no_ellipse_is_followed(start: Start, time: str) -> None:
    found = after(KEPLER, start, time)
    assert not found.enclosed
    assert "numerical flow" in found.method


def test_another_potential_is_not_taken_for_keplers() -> None:
    """1/r + r²/10⁶: at two points near the centre it looks the same."""
    other = Hamiltonian.parse("(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2) + (q1**2 + q2**2)/10**6")
    found = after(other, ELLIPSES["pericentre"], "1")
    assert not found.enclosed
    assert apart(found, after(KEPLER, ELLIPSES["pericentre"], "1")) > Fraction(1, 10**8)


def test_a_constant_does_not_change_the_flow() -> None:
    other = Hamiltonian.parse("(p1**2 + p2**2)/2 - 3/sqrt(q1**2 + q2**2) + 5/7")
    found = after(other, ELLIPSES["on the way"], "1")
    assert found.enclosed


def test_a_collision_is_told() -> None:
    with pytest.raises(NoFlowError):
        after(KEPLER, (["1", "0"], ["0", "0"]), "2")


def test_parts_that_are_not_coupled_are_the_planes() -> None:
    whole = Hamiltonian.parse("p1**2/2 - cos(q1) + p2**2/2 + q2**4/4 + p3*q4 + p4*q3")
    parts = uncouple(whole)
    assert [names for _, names in parts] == [("p1", "q1"), ("p2", "q2"), ("p3", "p4", "q3", "q4")]
    start = point_of(whole, ["1", "1/2", "1", "0"], ["0", "1/3", "0", "1"])
    found = solution_from(whole, start, Fraction(3), DIGITS)
    for k, formula in ((1, "p**2/2 - cos(q)"), (2, "p**2/2 + q**4/4")):
        own = exact_solution(
            Hamiltonian.parse(formula), p=start[f"p{k}"], q=start[f"q{k}"], time=Fraction(3),
            digits=DIGITS,
        )  # fmt: skip
        assert abs(found.point[f"q{k}"] - own.q) <= found.bound + own.bound
    assert not found.enclosed  # the last part is followed


def test_where_all_parts_have_closed_forms_the_whole_has() -> None:
    whole = Hamiltonian.parse("p1**2/2 - cos(q1) + p2**2/2 + q2**4/4")
    assert after(whole, (["1", "1/2"], ["0", "1"]), "50").enclosed


def test_the_numerical_flow_keeps_its_energy_and_comes_back() -> None:
    start: Start = (["0.3", "-0.1"], ["0.1", "0.2"])
    found = after(HENON, start, "5", 30)
    back = solution_from(HENON, found.point, Fraction(-5), 30)
    begun = point_of(HENON, *start)
    assert max(abs(back.point[name] - begun[name]) for name in begun) < Fraction(1, 10**27)
    ring = dict(found.point.items())

    def energy(z: dict[str, Fraction]) -> Fraction:
        p1, p2, q1, q2 = (z[n] for n in ("p1", "p2", "q1", "q2"))
        return (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3

    assert abs(energy(ring) - energy(dict(begun))) < Fraction(1, 10**28)


def test_in_time_it_is_the_planes_beside_what_rests() -> None:
    driven = Hamiltonian.parse("p1**2/2 + q1**2*cos(t)/2 + p2*q2*p1**2")
    start = point_of(driven, ["1", "0"], ["1/3", "0"])
    found = solution_from(driven, start, Fraction(2), DIGITS, Fraction(1, 3))
    plane = exact_solution(
        Hamiltonian.parse("p**2/2 + q**2*cos(t)/2"), p=Fraction(1, 3), q=Fraction(1),
        time=Fraction(2), digits=DIGITS, t0=Fraction(1, 3),
    )  # fmt: skip
    assert abs(found.point["q1"] - plane.q) <= found.bound + plane.bound
    assert found.point["q2"] == 0


def test_what_cannot_be_asked_is_refused() -> None:
    free = Hamiltonian.parse("p1**2/2 + a*q1*q2 + p2**2")
    with pytest.raises(InputError, match="parameter=a: needs a value"):
        after(free, (["1", "0"], ["0", "0"]), "1")
    with pytest.raises(InputError, match="digits"):
        after(HENON, (["1", "0"], ["0", "0"]), "1", 0)
    opened = Hamiltonian.parse("p1**2/2 + q1**2*q2/(1 - t) + p2**2")
    with pytest.raises(NoFlowError, match="H is not smooth"):
        after(opened, (["1", "0"], ["0", "0"]), "2")
