"""A charged particle in a magnetic field, and the driven potential of Hénon and Heiles."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy

import verify
from tests.helpers.textbook_hamiltonians import Example, example, gradients_apart
from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.flows.solution import solution_from
from verify.hamiltonians.run_domain import point_of

P1, P2, Q1, Q2, T = map(symbol, ("p1", "p2", "q1", "q2", "t"))
with mpmath.workdps(40):
    PI = Fraction(mpmath.nstr(mpmath.pi, 35))


def in_field(q: Any, p: Any, _: Any, b: Any, k: Any, c: Any) -> Any:
    """|p − A|²/2 + V with the potential A = b (−q2, q1)/2."""
    field = [-b * q[1] / 2, b * q[0] / 2]
    velocity = [p[j] - field[j] for j in (0, 1)]
    kinetic = sum(v * v for v in velocity) / 2
    return kinetic + (k * q[0] ** 2 + k * q[1] ** 2 + c * (q[0] * q[1]) ** 2) / 2


def driven(q: Any, p: Any, t: Any, epsilon: Any, omega: Any) -> Any:
    kinetic, circle = (p[0] ** 2 + p[1] ** 2) / 2, (q[0] ** 2 + q[1] ** 2) / 2
    force = epsilon * mpmath.cos(omega * t)
    return kinetic + circle + q[0] ** 2 * q[1] - q[1] ** 3 / 3 - force * q[0]


@pytest.mark.parametrize("regime", ["cyclotron", "trap", "coupled"])
def test_it_is_the_kinetic_momentum_and_a_potential(regime: str) -> None:
    assert gradients_apart(example("magnetic", regime), in_field) < 1e-30


@pytest.mark.parametrize("regime", ["weak", "near-resonance"])
def test_the_driven_one_is_that_of_henon_and_heiles_and_a_force(regime: str) -> None:
    assert gradients_apart(example("driven-henon-heiles", regime), driven) < 1e-30


def test_the_force_is_lorentzs() -> None:
    """v1' = b v2 − V_q1, v2' = −b v1 − V_q2."""
    exact = example("magnetic", "coupled").hamiltonian.expression
    b, k, c = map(symbol, "bkc")
    x, y = exact.diff(P1), exact.diff(P2)

    def rate(v: sympy.Expr) -> sympy.Expr:
        pairs = ((P1, Q1), (P2, Q2))
        return sum(v.diff(q) * exact.diff(p) - v.diff(p) * exact.diff(q) for p, q in pairs)

    assert sympy.expand(rate(x) - b * y + k * Q1 + c * Q1 * Q2**2) == 0
    assert sympy.expand(rate(y) + b * x + k * Q2 + c * Q1**2 * Q2) == 0


def after(at: Example, time: Fraction) -> dict[str, float]:
    start = point_of(at.hamiltonian, at.q, at.p)
    found = solution_from(at.hamiltonian, start, time, 20)
    return {name: float(value) for name, value in found.point.items()}


def test_without_a_potential_it_goes_round_with_the_cyclotron_frequency() -> None:
    at = example("magnetic", "cyclotron")
    b = at.values["b"]
    start = {name: float(x) for name, x in point_of(at.hamiltonian, at.q, at.p).items()}
    half, whole = (after(at, turn * PI / b) for turn in (1, 2))
    assert max(abs(whole[name] - start[name]) for name in start) < 1e-14
    first, other = (z["p1"] + float(b) * z["q2"] / 2 for z in (start, half))
    assert abs(first) > 1
    assert abs(first + other) < 1e-14, "after half a turn the velocity is reversed"


def test_in_the_trap_it_has_the_frequencies_of_fock() -> None:
    """√(k + b²/4) ± b/2, which are 2 and 1/2 for k = 1 and b = 3/2."""
    names = [P1, P2, Q1, Q2]
    hessian = sympy.hessian(example("magnetic", "trap").hamiltonian.exact, names)
    turn = sympy.Matrix([[0, 0, -1, 0], [0, 0, 0, -1], [1, 0, 0, 0], [0, 1, 0, 0]])
    x = sympy.Symbol("x")
    found = (turn * hessian).charpoly(x).as_expr()
    assert sympy.expand(found - (x**2 + 4) * (x**2 + sympy.Rational(1, 4))) == 0


@pytest.mark.parametrize("regime", ["cyclotron", "trap", "coupled"])
def test_lie2_runs_it_and_a_splitting_is_refused(regime: str) -> None:
    at = example("magnetic", regime)
    asked: dict[str, Any] = {"q": list(at.q), "p": list(at.p), "step_size": "0.01", "steps": 50}
    found = verify.run(at.hamiltonian, "lie2", digits=15, **asked)
    exact = after(at, Fraction(1, 2))
    assert all(abs(float(found.values[name]) - exact[name]) < 1e-3 for name in exact)
    assert float(found.values["symplectic_defect_max"]) > 1e-10
    with pytest.raises(InputError, match=r"T\(p\) \+ V\(q\)"):
        verify.run(at.hamiltonian, "stormer-verlet", **asked)


@pytest.mark.parametrize("scheme", ["stormer-verlet", "lie2"])
def test_the_drive_is_felt_in_a_run(scheme: str) -> None:
    at = example("driven-henon-heiles", "near-resonance")
    assert at.hamiltonian.time_dependent
    asked: dict[str, Any] = {"q": list(at.q), "p": list(at.p), "step_size": "0.01", "steps": 300}
    found = verify.run(at.hamiltonian, scheme, digits=15, **asked)
    still = verify.run("henon-heiles", scheme, digits=15, **asked)
    assert abs(float(found.values["q1"]) - float(still.values["q1"])) > 5e-3
    exact = solution_from(at.hamiltonian, point_of(at.hamiltonian, at.q, at.p), Fraction(3), 15)
    assert all(abs(float(found.values[x]) - float(exact.point[x])) < 1e-4 for x in exact.point)
