"""Compositions of shears, Störmer–Verlet and Yoshida's, against what they are defined as."""

from collections.abc import Sequence
from fractions import Fraction

import pytest
import sympy

from tests.helpers.planted.splittings import SPLITTINGS
from tests.helpers.sampled.formulas import P, Q, plain
from tests.helpers.stepping.stepper import Stepper
from verify import schemes
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.schemes.conditions.splitting_conditions import Part, Splitting
from verify.schemes.maps.kinds import splittings
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict

NONLINEAR = "p**2/2 - cos(q)"


def shears(name: str, parts: Sequence[Part]) -> StepMap:
    return splittings.build(Splitting(tuple(parts)), Hamiltonian.parse(NONLINEAR), name)


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


_THIRD, _FIFTH = 1 / (2 - sympy.cbrt(2)), 1 / (2 - sympy.root(2, 5))
_TRIPLE = (_THIRD, 1 - 2 * _THIRD, _THIRD)
_SUZUKI = 1 / (4 - sympy.cbrt(4))
OF_VERLET = {
    "yoshida4": _TRIPLE,
    "suzuki4": (_SUZUKI, _SUZUKI, 1 - 4 * _SUZUKI, _SUZUKI, _SUZUKI),
    "triple-jump6": [a * b for a in (_FIFTH, 1 - 2 * _FIFTH, _FIFTH) for b in _TRIPLE],
}


@pytest.mark.parametrize("name", OF_VERLET)
def test_a_composition_makes_the_steps_of_verlet_one_after_the_other(name: str) -> None:
    verlet = schemes.get("stormer-verlet")
    hamiltonian = Hamiltonian.parse(NONLINEAR)
    parts = [(kind, step * x) for step in OF_VERLET[name] for kind, x in verlet.every_h.parts]
    at = {"p": Fraction(3, 7), "q": Fraction(5, 11), "h": Fraction(1, 9), "steps": 3}
    one, other, wrong = (
        Stepper(step_map).run(**at)
        for step_map in (
            schemes.get(name).step_map(hamiltonian),
            shears(name, parts),
            shears(name, parts[6:9] + parts[:6] + parts[9:]),
        )
    )
    assert all(abs(x - y) < 1e-55 for x, y in zip(one, other, strict=True))
    assert any(abs(x - y) > 1e-6 for x, y in zip(one, wrong, strict=True))


@pytest.mark.parametrize("gamma", ["27/20", "1/3"])
def test_yoshida_with_another_coefficient_has_order_2_and_is_refuted(gamma: str) -> None:
    outer = sympy.Rational(gamma)
    inner = 1 - 2 * outer
    sizes = [outer / 2, outer, (outer + inner) / 2, inner, (outer + inner) / 2, outer, outer / 2]
    parts = list(zip(["kick", "drift"] * 3 + ["kick"], sizes, strict=True))
    proof = prove(shears("yoshida4", parts), schemes.get("yoshida4"))
    assert (proof.verdict, proof.convergence_order) == (Verdict.REFUTED, 2)
    assert proof.area_preserving is True
