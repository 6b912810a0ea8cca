"""Named systems of several degrees of freedom: what they are, and that proofs take them."""

from fractions import Fraction

import pytest
import sympy

import verify
from verify.algebra.formula import symbol
from verify.hamiltonians import systems
from verify.hamiltonians.coordinates import numbered_names
from verify.hamiltonians.run_domain import check_start
from verify.proof.proof_for_one_h import Proof

SEVERAL = systems.all_systems(2)
ALL = {name: x for name, x in systems.all_systems(None).items() if x.degrees > 1}
P1, P2, Q1, Q2, G = map(symbol, ("p1", "p2", "q1", "q2", "g"))


def test_there_are_those_of_the_textbooks() -> None:
    assert {"henon-heiles", "kepler", "double-pendulum", "coupled-pendulums"} <= set(SEVERAL)
    assert {"fput", "three-body", "outer-solar-system", "magnetic"} <= set(ALL)
    assert not set(ALL) & set(systems.all_systems())


@pytest.mark.parametrize("name", ALL)
def test_a_system_explains_itself_and_its_examples_are_points(name: str) -> None:
    system = ALL[name]
    assert system.title
    assert system.source
    assert system.regimes
    assert system.hamiltonian().coordinates == numbered_names(system.degrees)
    for regime in system.regimes.values():
        assert set(regime) == {"p", "q", *system.parameters}
        values = {name: regime[name] for name in system.parameters}
        q, p = (regime[letter].split(", ") for letter in "qp")
        check_start(system.hamiltonian(values), q, p)


@pytest.mark.parametrize("name", systems.names())
def test_the_degrees_that_its_text_says_are_those_of_its_hamiltonian(name: str) -> None:
    system = systems.get(name)
    assert system.degrees == system.hamiltonian().degrees


def test_the_double_pendulum_is_that_of_its_lagrangian() -> None:
    """L = θ1'² + θ2'²/2 + θ1' θ2' cos(θ1 − θ2) + g (2 cos θ1 + cos θ2), by Legendre."""
    v1, v2 = sympy.symbols("v1 v2")
    lagrangian = v1**2 + v2**2 / 2 + v1 * v2 * sympy.cos(Q1 - Q2)
    lagrangian += G * (2 * sympy.cos(Q1) + sympy.cos(Q2))
    solved = sympy.solve([lagrangian.diff(v1) - P1, lagrangian.diff(v2) - P2], [v1, v2])
    legendre = (P1 * v1 + P2 * v2 - lagrangian).subs(solved)
    ours = SEVERAL["double-pendulum"].hamiltonian().expression
    assert sympy.simplify(legendre - ours) == 0


def test_kepler_starts_at_the_pericentre_of_its_eccentricity() -> None:
    for regime in SEVERAL["kepler"].regimes.values():
        (p1, p2), (q1, q2) = ([Fraction(x) for x in regime[n].split(",")] for n in "pq")
        energy, spin = p2**2 / 2 - 1 / abs(q1), q1 * p2
        assert (p1, q2, energy) == (0, 0, Fraction(-1, 2)), "its semi-major axis is 1"
        assert (1 - q1) ** 2 == 1 - spin**2, "e² = 1 − L²"


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", SEVERAL)
def test_proofs_take_it(name: str) -> None:
    lie2, midpoint = (verify.prove(name, scheme) for scheme in ("lie2", "implicit-midpoint"))
    assert isinstance(lie2, Proof)
    assert (lie2.order, lie2.symplectic, lie2.telescopes) == (3, False, True)
    assert (midpoint.verdict, midpoint.convergence_order) == ("PROVED", 2)
    assert midpoint.area_preserving
