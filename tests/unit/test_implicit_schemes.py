"""Implicit schemes where they are solved: their equations hold; elsewhere they are refused."""

import pytest
import sympy

from tests.property.strategies import P, Q, plain
from verify import schemes
from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.proof.order import prove
from verify.verdict import Verdict

NONLINEAR = "p**2/2 - cos(q)"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("implicit-midpoint", "p**2/2 - cos(q)"),
        ("implicit-midpoint", "p*q**2"),
        ("implicit-symplectic-euler", "p**2*q"),
        ("implicit-symplectic-euler", "cos(p + q)"),
    ],
)
def test_an_implicit_scheme_that_is_not_solved_says_where_it_is_proved(
    name: str, text: str
) -> None:
    with pytest.raises(InputError, match=rf"^hamiltonian=.*{name} is implicit.*every-hamiltonian"):
        schemes.get(name).step_map(Hamiltonian.parse(text))


@pytest.mark.parametrize("text", ["p**2/2 + a*p*q + q**2", "p*q", "(p - 2*q)**2 + p"])
def test_the_implicit_midpoint_rule_satisfies_its_equation(text: str) -> None:
    step_map = schemes.get("implicit-midpoint").step_map(Hamiltonian.parse(text))
    half = {P: (P + step_map.p_next) / 2, Q: (Q + step_map.q_next) / 2}
    h, expression = plain("h"), plain(text)
    p_gap = step_map.p_next - P + h * expression.diff(Q).xreplace(half)
    q_gap = step_map.q_next - Q - h * expression.diff(P).xreplace(half)
    assert sympy.simplify(p_gap) == sympy.simplify(q_gap) == 0
    assert sympy.simplify(step_map.p_next - P + h * expression.diff(Q)) != 0


@pytest.mark.parametrize("text", ["p**4/4 + p*sin(q) + q**2", "exp(p) + p*q", NONLINEAR])
def test_the_implicit_symplectic_euler_satisfies_its_equation(text: str) -> None:
    step_map = schemes.get("implicit-symplectic-euler").step_map(Hamiltonian.parse(text))
    h, expression, put = plain("h"), plain(text), {P: step_map.p_next}
    assert sympy.simplify(step_map.p_next - P + h * expression.diff(Q).xreplace(put)) == 0
    assert sympy.simplify(step_map.q_next - Q - h * expression.diff(P).xreplace(put)) == 0
    proof = prove(step_map, schemes.get("implicit-symplectic-euler"))
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.convergence_order == 1
