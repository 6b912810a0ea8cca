"""Compositions of shears, Störmer–Verlet and Yoshida's, against what they are defined as."""

import pytest
import sympy

from tests.property.strategies import P, Q, plain
from tests.unit.planted import SPLITTINGS
from verify import schemes
from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.proof.order import prove
from verify.splitting import shears
from verify.verdict import Verdict

NONLINEAR = "p**2/2 - cos(q)"


@pytest.mark.parametrize("name", SPLITTINGS)
def test_a_composition_of_shears_refuses_what_is_not_separable_by_its_name(name: str) -> None:
    with pytest.raises(InputError, match=rf"^hamiltonian=.*{name} is explicit only"):
        schemes.get(name).step_map(Hamiltonian.parse("p**2/2 + p*q"))


def test_verlet_kicks_drifts_and_kicks() -> None:
    step_map = schemes.get("stormer-verlet").step_map(Hamiltonian.parse(NONLINEAR))
    half = P - plain("h*sin(q)/2")
    q_next = Q + plain("h") * half
    assert sympy.expand(step_map.q_next - q_next) == 0
    assert sympy.expand(step_map.p_next - half + plain("h") / 2 * sympy.sin(q_next)) == 0


def test_yoshida_composes_three_steps_of_verlet_and_its_coefficients_are_exact() -> None:
    gamma = 1 / (2 - sympy.cbrt(2))
    at = {P: sympy.Rational(3, 7), Q: sympy.Rational(5, 11), plain("h"): sympy.Rational(1, 9)}
    verlet = schemes.get("stormer-verlet").step_map(Hamiltonian.parse(NONLINEAR))
    p, q = at[P], at[Q]
    for part in (gamma, 1 - 2 * gamma, gamma):
        put = {P: p, Q: q, plain("h"): part * at[plain("h")]}
        p, q = (x.subs(put).evalf(60) for x in (verlet.p_next, verlet.q_next))
    ours = schemes.get("yoshida4").step_map(Hamiltonian.parse(NONLINEAR))
    for one, other in zip((ours.p_next, ours.q_next), (p, q), strict=True):
        assert abs(one.subs(at).evalf(60) - other) < sympy.Rational(1, 10**50)


@pytest.mark.parametrize("gamma", ["27/20", "1/3"])
def test_yoshida_with_another_coefficient_has_order_2_and_is_refuted(gamma: str) -> None:
    outer = sympy.Rational(gamma)
    inner = 1 - 2 * outer
    sizes = [outer / 2, outer, (outer + inner) / 2, inner, (outer + inner) / 2, outer, outer / 2]
    parts = list(zip(["kick", "drift"] * 3 + ["kick"], sizes, strict=True))
    proof = prove(shears(Hamiltonian.parse(NONLINEAR), "yoshida4", parts), schemes.get("yoshida4"))
    assert (proof.verdict, proof.convergence_order) == (Verdict.REFUTED, 2)
    assert proof.area_preserving is True
