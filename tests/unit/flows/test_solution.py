"""The exact solution: its digits, its parts, extreme inputs."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
from flint import arb

from verify.arithmetic.arb import make_ball
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.flows import solution as solution_module
from verify.flows.ball_evaluation import MOST_DIGITS, evaluate
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.flows.solution import (
    ExactSolution,
    exact_solution,
    leaves_by_algebra,
    solution_from,
)
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.named_system import Motion, exactly
from verify.hamiltonians.run_domain import point_of

DUFFING = "p**2/2 + q**2/2 + delta*q**4/4"
PENDULUM = "p**2/2 - cos(q)"
CUBIC = "p**2/2 + q**2/2 - q**3/3"
LENNARD_JONES = "p**2/2 + 4*((1/q)**12 - (1/q)**6)"
PI = "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899"
HENON = systems.get("henon-heiles").hamiltonian({})
KEPLER = systems.get("kepler").hamiltonian({"mu": 1})
ELLIPSES: dict[str, tuple[list[str], list[str]]] = {
    "circle": (["0", "1"], ["1", "0"]),
    "pericentre": (["0", "2"], ["2/5", "0"]),
    "on the way": (["1/2", "4/5"], ["3/5", "-1/3"]),
    "backwards": (["-1/2", "-4/5"], ["3/5", "1/3"]),
    "e = 0.999": (["0", "45"], ["1/1013", "0"]),
    "nearly straight": (["1/3", "1/50"], ["1/2", "0"]),
}  # p, q
REGIMES = [(name, r) for name, system in systems.all_systems().items() for r in system.regimes]


def solve(
    formula: str | Hamiltonian, p: Any, q: Any, time: Any, digits: int = 30, **parameters: Any
) -> ExactSolution:
    """From p and q, of which each is a number, or a list in several degrees of freedom."""
    exact = Hamiltonian.parse(formula, parameters) if isinstance(formula, str) else formula
    return exact_solution(exact, p=p, q=q, time=Fraction(time), digits=digits)


def apart(one: ExactSolution, other: ExactSolution) -> Fraction:
    return max(abs(one.point[name] - other.point[name]) for name in one.point)


def where(formula: str, p: Any, q: Any, time: Any = 100, **parameters: Any) -> str | None:
    hamiltonian = Hamiltonian.parse(formula, parameters)
    return leaves_by_algebra(hamiltonian, p=Fraction(p), q=Fraction(q), time=Fraction(time))


def near(value: Fraction, true: Any, digits: int) -> bool:
    return bool(abs(mpmath.mpf(value.numerator) / value.denominator - true) < 10.0**-digits)


# -- digits ---------------------------------------------------------------------------------------


@pytest.mark.sample(30)
@pytest.mark.parametrize("digits", [5, 30, 100])
@pytest.mark.parametrize(("name", "regime"), REGIMES, ids=map("-".join, REGIMES))
def test_the_bound_holds_and_is_as_small_as_asked_for(name: str, regime: str, digits: int) -> None:
    system = systems.get(name)
    in_time = system.time_dependent and system.flow_in_time is None
    if digits == 100 and (name in ("lennard-jones", "toda-oscillator") or in_time):
        digits = 40
    values, p, q = system.regime(regime)
    hamiltonian, time = system.hamiltonian(values), Fraction(3, 4)
    found, finer = (
        exact_solution(hamiltonian, p=p, q=q, time=time, digits=d) for d in (digits, digits + 20)
    )
    scale = max(map(abs, (p, q, found.p, found.q)))
    assert found.bound * 10**digits <= scale
    for x, y in ((found.p, finer.p), (found.q, finer.q)):
        assert abs(x - y) <= found.bound + finer.bound


RETURNS: dict[str, tuple[Hamiltonian, Any, Any, int, Callable[..., Fraction]]] = {
    "lennard-jones": (
        Hamiltonian.parse(LENNARD_JONES), "1/10", "3/2", 2,
        lambda p, q: p**2 / 2 + 4 * (1 / q**12 - 1 / q**6),
    ),
    "henon-heiles": (
        HENON, ["0.1", "0.2"], ["0.3", "-0.1"], 5,
        lambda p1, p2, q1, q2: (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("h", "p", "q", "time", "energy"), RETURNS.values(), ids=RETURNS)
def test_without_a_closed_form_it_keeps_its_energy_and_goes_back_to_where_it_came_from(
    h: Hamiltonian, p: Any, q: Any, time: int, energy: Callable[..., Fraction]
) -> None:
    start, end = point_of(h, q, p), solve(h, p, q, time)
    assert "numerical" in end.method
    back = solution_from(h, end.point, Fraction(-time), 30)
    assert max(abs(back.point[name] - start[name]) for name in start) < Fraction(1, 10**27)
    assert abs(energy(**end.point) - energy(**start)) < Fraction(1, 10**28)


@pytest.mark.parametrize("noise", [arb(1, 1e-9), arb.nan(), arb.pos_inf()])
def test_a_ball_that_no_precision_makes_narrow_has_no_digits(noise: Any) -> None:
    motion = Motion(lambda _: (noise, arb(1)), "noise")
    with pytest.raises(NoFlowError, match="loses more than"):
        evaluate(motion, (Fraction(1), Fraction(1)), Fraction(1), 20)


def test_a_modulus_that_rounds_to_1_takes_more_precision() -> None:
    """At 2 ± 10⁻¹⁰⁰ the pendulum's two fates part at t ≈ 230; 30 digits do not see it."""
    over, under = (solve(PENDULUM, 2 + Fraction(x, 10**100), 0, 1000, 10) for x in (1, -1))
    assert over.q > 28
    assert under.q < 4


@pytest.mark.parametrize("time", ["1e4", "1e40"])
@pytest.mark.parametrize("formula", [PENDULUM, "p**2/2 + q**2/2 + q**4/4"])
def test_a_long_time_keeps_h_within_its_enclosure(formula: str, time: str) -> None:
    """Energy at the end, in balls around what is told, holds that at the start."""
    for p, q in (("1/3", "3/2"), ("5/2", "1"), ("-3", "-7/2")):
        found = solve(formula, p, q, time, 40)
        assert found.enclosed
        with working_precision(500):
            before = energy(formula, arb(exactly(Fraction(p))), arb(exactly(Fraction(q))))
            after = energy(formula, *(make_ball(x, found.bound) for x in (found.p, found.q)))
            assert after.overlaps(before)
            wrong = make_ball(found.p + 100 * found.bound, found.bound)
            off = energy(formula, wrong, make_ball(found.q, found.bound))
            assert not off.overlaps(before), "the control: a state outside of its bound"


def energy(formula: str, p: Any, q: Any) -> Any:
    return p**2 / 2 - q.cos() if formula == PENDULUM else p**2 / 2 + q**2 / 2 + q**4 / 4


def test_energy_and_angular_momentum_stay_on_a_long_thin_ellipse() -> None:
    p1, p2, q1, q2 = solve(KEPLER, *ELLIPSES["e = 0.999"], 100, 50).point.values()
    turn = Fraction(45, 1013)
    assert abs(q1 * p2 - q2 * p1 - turn) < Fraction(1, 10**45)
    # (|p|²/2 − H)² |q|² = 1
    kinetic = (p1 * p1 + p2 * p2) / 2 - (Fraction(45**2, 2) - 1013)
    assert abs(kinetic * kinetic * (q1 * q1 + q2 * q2) - 1) < Fraction(1, 10**45)


def test_on_a_circle_it_is_cos_and_sin_of_t() -> None:
    """To 40 digits, from a library that has nothing to do with it."""
    end = solve(KEPLER, *ELLIPSES["circle"], 1000, 40)
    with mpmath.workdps(60):
        cos, sin = mpmath.cos(1000), mpmath.sin(1000)
        assert all(near(end.point[n], x, 40) for n, x in (("q1", cos), ("q2", sin), ("p1", -sin)))
    assert end.bound < Fraction(1, 10**40)


ENCLOSED: dict[str, tuple[Hamiltonian, Any, Any, int]] = {
    "pendulum": (Hamiltonian.parse(PENDULUM), "1/10", "3/2", 2),
    "ellipse-with-a-constant": (
        Hamiltonian.parse("(p1**2 + p2**2)/2 - 3/sqrt(q1**2 + q2**2) + 5/7"),
        *ELLIPSES["on the way"], 1,
    ),
    "each-of-two-parts": (
        Hamiltonian.parse("p1**2/2 - cos(q1) + p2**2/2 + q2**4/4"),
        ["0", "1"], ["1", "1/2"], 50,
    ),
}  # fmt: skip
FOLLOWED: dict[str, tuple[Hamiltonian, Any, Any, Any]] = {
    "lennard-jones": (Hamiltonian.parse(LENNARD_JONES), "1/10", "3/2", 2),
    "morse-barrier": (Hamiltonian.parse("p**2/2 - (1 - exp(-q))**2"), 0, "1/2", 1),
    "hyperbola": (KEPLER, ["0", "2"], ["1", "0"], 3),
    "straight-line": (KEPLER, ["1/2", "0"], ["1", "0"], "1/2"),
}


@pytest.mark.parametrize(("h", "p", "q", "time"), ENCLOSED.values(), ids=ENCLOSED)
def test_what_has_a_closed_form_is_enclosed(h: Hamiltonian, p: Any, q: Any, time: int) -> None:
    assert solve(h, p, q, time, 25).enclosed


@pytest.mark.parametrize(("h", "p", "q", "time"), FOLLOWED.values(), ids=FOLLOWED)
def test_what_is_followed_is_not_called_enclosed(h: Hamiltonian, p: Any, q: Any, time: Any) -> None:
    end = solve(h, p, q, time, 25)
    assert not end.enclosed
    assert "numerical flow" in end.method


# -- parts ----------------------------------------------------------------------------------------

PARTS: dict[str, tuple[str, Any, Any, int, Fraction, list[str], set[str]]] = {
    "the-last-part-followed": (
        "p1**2/2 - cos(q1) + p2**2/2 + q2**4/4 + p3*q4 + p4*q3",
        ["0", "1/3", "0", "1"], ["1", "1/2", "1", "0"], 3, Fraction(0),
        ["p**2/2 - cos(q)", "p**2/2 + q**4/4"], set(),
    ),
    "in-time-beside-what-rests": (
        "p1**2/2 + q1**2*cos(t)/2 + p2*q2*p1**2", ["1/3", "0"], ["1", "0"], 2, Fraction(1, 3),
        ["p**2/2 + q**2*cos(t)/2"], {"p2", "q2"},
    ),
}  # fmt: skip


@pytest.mark.parametrize(
    ("formula", "p", "q", "time", "t0", "planes", "resting"), PARTS.values(), ids=PARTS
)
def test_a_part_that_is_not_coupled_moves_as_it_does_in_the_plane(
    formula: str, p: Any, q: Any, time: int, t0: Fraction, planes: list[str], resting: set[str]
) -> None:
    whole = Hamiltonian.parse(formula)
    end = solution_from(whole, point_of(whole, q, p), Fraction(time), 25, t0)
    for k, text in enumerate(planes):
        plane = exact_solution(Hamiltonian.parse(text), p=p[k], q=q[k], time=Fraction(time),
                               digits=25, t0=t0)  # fmt: skip
        for name in "pq":
            gap = abs(end.point[f"{name}{k + 1}"] - plane.point[name])
            assert gap <= end.bound + plane.bound
    assert not end.enclosed
    assert {name for name, x in end.point.items() if x == 0} == resting


# -- bad input -------------------------------------------------------------------------------------


def test_a_parameter_without_a_value_is_bad_input() -> None:
    with pytest.raises(InputError, match=r"^parameter=delta: needs a value"):
        solve(DUFFING, 0, 1, 1)
    with pytest.raises(InputError, match=r"^parameter=a: needs a value"):
        solve("p1**2/2 + a*q1*q2 + p2**2", ["0", "0"], ["1", "0"], 1)
    with pytest.raises(InputError, match=r"^parameter=delta: needs a value"):
        where(DUFFING, 0, 1)


def test_an_h_of_several_degrees_of_freedom_is_bad_input() -> None:
    kepler = systems.get("kepler").hamiltonian({"mu": 1})
    with pytest.raises(InputError, match=r"^p=1: has 1 of 2 numbers; H is of p1, p2"):
        exact_solution(kepler, p=Fraction(1), q=Fraction(1), time=Fraction(1), digits=20)
    with pytest.raises(InputError, match=r"^hamiltonian=.* is of p1, p2, q1, q2; "):
        leaves_by_algebra(kepler, p=Fraction(1), q=Fraction(1), time=Fraction(1))


@pytest.mark.parametrize("digits", [0, -1, MOST_DIGITS + 1])
def test_digits_beyond_the_limits_are_bad_input(digits: int) -> None:
    with pytest.raises(InputError, match=r"^digits="):
        solve(PENDULUM, 0, 1, 1, digits)
    with pytest.raises(InputError, match=r"^digits="):
        solve(HENON, ["0", "0"], ["1", "0"], 1, digits)


# -- the numerical flow ----------------------------------------------------------------------------


def test_a_numerical_flow_that_is_cut_short_is_not_an_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The control of the two flows' agreement: a step too long by 10⁻²⁵ at the lower precision."""

    class Wrong(NumericalFlow):
        def follow(self, z: Any, time: Fraction, most_steps: int = 1000) -> Any:
            off = Fraction(1) + Fraction(self.arithmetic.bits, 10**27)
            return super().follow(z, time * off, most_steps)

    monkeypatch.setattr(solution_module, "NumericalFlow", Wrong)
    with pytest.raises(NoFlowError, match="digits asked for are lost"):
        solve("p**2/2 + q**6", 1, 1, 1, 30)
