"""Systems whose H depends on time: their forces by hand, proofs, exact flows, and where they are
refused."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy

from verify.algebra.formula import symbol
from verify.calls.inputs import hamiltonian_from
from verify.flows.solution import exact_solution, numerical_solution
from verify.hamiltonians import systems
from verify.hamiltonians.systems.driven import forced_oscillator
from verify.proof.order_for_one_h import prove
from verify.scenes.scene import Scene
from verify.schemes import get

p, q, t = map(symbol, "pqt")
NAMES = [name for name, system in systems.all_systems().items() if system.time_dependent]
FORCES: dict[str, Callable[..., Any]] = {  # q'' of each, in the letters that its title has
    "chirped-oscillator": lambda omega0, gamma, a, b: (
        -(omega0**2) * q + gamma * sympy.sin(a * t + b * t**2)),
    "driven-duffing": lambda alpha, beta, gamma, omega: (
        -alpha * q - beta * q**3 + gamma * sympy.cos(omega * t)),
    "driven-pendulum": lambda epsilon, omega: -(1 + epsilon * sympy.cos(omega * t)) * sympy.sin(q),
    "forced-oscillator": lambda omega0, gamma, omega: (
        -(omega0**2) * q + gamma * sympy.cos(omega * t)),
    "mathieu": lambda a, b: -(a - 2 * b * sympy.cos(2 * t)) * q,
    "paul-trap": lambda U, V, Omega: -(U + V * sympy.cos(Omega * t)) * q,
}  # fmt: skip
FORCED = systems.get("forced-oscillator")


def test_there_are_six() -> None:
    assert sorted(NAMES) == sorted(FORCES)


@pytest.mark.parametrize("name", NAMES)
def test_the_field_is_the_one_that_its_equation_says(name: str) -> None:
    system = systems.get(name)
    exact = system.hamiltonian().expression
    values = {n: symbol(n) for n in system.parameters}
    assert sympy.simplify(-exact.diff(q) - FORCES[name](**values)) == 0
    assert exact.diff(p) == p


@pytest.mark.parametrize("name", NAMES)
def test_lie2_is_of_order_3_in_area_and_verlet_preserves_it(name: str) -> None:
    system = systems.get(name)
    values, *_ = system.regime(next(iter(system.regimes)))
    hamiltonian = system.hamiltonian(values)
    lie, verlet = (prove(get(s).step_map(hamiltonian), get(s)) for s in ("lie2", "stormer-verlet"))
    assert lie.order in (3, 4)  # of a linear one with a constant coefficient 4
    assert (lie.verdict, verlet.verdict, verlet.area_preserving) == ("PROVED", "PROVED", True)
    assert (lie.convergence_order, verlet.convergence_order) == (2, 2)


@pytest.mark.parametrize("regime", FORCED.regimes)
@pytest.mark.parametrize(("t0", "time"), [("0", "3/2"), ("-7/3", "5"), ("1", "-2")])
def test_the_forced_oscillator_in_closed_form_is_the_numerical_flow(
    regime: str, t0: str, time: str
) -> None:
    values, first_p, first_q = FORCED.regime(regime)
    hamiltonian = FORCED.hamiltonian(values)
    asked = {"p": first_p, "q": first_q, "time": Fraction(time), "t0": Fraction(t0)}
    found = exact_solution(hamiltonian, digits=40, **asked)
    assert found.enclosed
    assert found.bound < Fraction(1, 10**39)
    if not hamiltonian.time_dependent:  # a constant force: the potential's own closed form
        return
    start = {"p": first_p, "q": first_q}
    other = numerical_solution(hamiltonian, start, Fraction(time), 25, Fraction(t0))
    assert abs(found.p - other.p) + abs(found.q - other.q) < Fraction(1, 10**23)


def test_a_wrong_resonance_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The planted error: in resonance the amplitude without its growth."""
    values, first_p, first_q = FORCED.regime("resonance")
    hamiltonian = FORCED.hamiltonian(values)
    asked = {"p": first_p, "q": first_q, "time": Fraction(4), "t0": Fraction(1), "digits": 20}
    right = exact_solution(hamiltonian, **asked)
    near = {**values, "omega": values["omega"] + Fraction(1, 10**12)}
    beside = exact_solution(FORCED.hamiltonian(near), **asked)
    assert abs(right.q - beside.q) < Fraction(1, 10**10)  # it is the limit from outside
    whole = forced_oscillator.rational_ball
    monkeypatch.setattr(
        forced_oscillator, "rational_ball", lambda x: whole(x * 2 if x == Fraction(4) else x)
    )
    assert abs(right.q - exact_solution(hamiltonian, **asked).q) > Fraction(1, 100)


def test_mathieu_has_the_exponent_of_its_unstable_regime() -> None:
    """Over a period π the monodromy matrix of a = 1, b = 1/2 has an eigenvalue beyond 1."""
    values, *_ = systems.get("mathieu").regime("unstable")
    hamiltonian = systems.get("mathieu").hamiltonian(values)
    with mpmath.workdps(40):
        period = Fraction(str(mpmath.nstr(mpmath.pi, 35)))
    columns = [
        exact_solution(hamiltonian, p=Fraction(a), q=Fraction(1 - a), time=period, digits=20)
        for a in (0, 1)
    ]
    trace = columns[0].q + columns[1].p
    determinant = columns[1].p * columns[0].q - columns[1].q * columns[0].p
    assert abs(determinant - 1) < Fraction(1, 10**18)
    assert abs(trace) > 2


def test_it_is_found_by_its_name() -> None:
    assert hamiltonian_from(systems.get("mathieu"), {"a": 1}).time_dependent
    assert hamiltonian_from("Mathieu").time_dependent


def test_a_scene_has_it_by_its_name() -> None:
    scene = Scene(system="mathieu", parameters={"a": 2, "b": "1/2"}, schemes=("lie2",), t0="1/3")
    assert scene.exact_hamiltonian().time_dependent
