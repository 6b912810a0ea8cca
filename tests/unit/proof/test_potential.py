"""Telescoping for one H: True with a G that is checked here by sympy, False by an equilibrium."""

from typing import Any

import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.plane import potential
from verify.proof.plane.potential import Potential, potential_of
from verify.schemes import get
from verify.schemes.steps.two_form import TwoForm

OWN = "p_next = p - h*sin(q) - h**2/2*p*cos(q); q_next = q + h*(p - h/2*sin(q))"
HOLDS = [
    ("p**2/2 + q**2/2 + d*q**4/4", "lie2"),
    ("p**2/2 - cos(q)", "lie4"),
    ("p**2*q + q**3*p/3 + exp(p*q)", "lie2"),
    ("p**2/2 + q**3/3", "lie3"),  # odd, and yet: −2 q²/3 is the derivative of 2 p/3
    ("p**2/2 - exp(q)", "lie3"),
    ("p**2/2 - cos(q)", OWN),
]
FAILS = [
    ("p**2/2 + q**2/2 + d*q**4/4", "lie1"),
    ("p**2/2 - cos(q)", "lie3"),
    ("p*q", "lie1"),
    ("p**2/2 + cos(q)", "lie1"),  # at q = ±π too
]


def found(text: str, name: str) -> tuple[Hamiltonian, sympy.Expr, Potential]:
    hamiltonian, scheme = Hamiltonian.parse(text), get(name)
    proof = prove(scheme.step_map(hamiltonian), scheme)
    return hamiltonian, proof.leading, potential_of(proof, scheme)


def along(hamiltonian: Hamiltonian, y: sympy.Expr) -> sympy.Expr:
    exact = hamiltonian.exact
    return exact.diff(P) * y.diff(Q) - exact.diff(Q) * y.diff(P)


@pytest.mark.parametrize(("text", "name"), HOLDS)
def test_a_potential_has_the_leading_coefficient_as_its_derivative(text: str, name: str) -> None:
    hamiltonian, leading, result = found(text, name)
    assert result.holds is True
    assert result.potential is not None
    assert sympy.simplify(along(hamiltonian, result.potential) - leading) == 0


@pytest.mark.parametrize(("text", "name"), FAILS)
def test_an_equilibrium_rules_every_potential_out(text: str, name: str) -> None:
    _, _, result = found(text, name)
    assert (result.holds, result.potential) == (False, None)
    assert "equilibrium" in result.reason


def test_what_is_neither_found_nor_ruled_out_is_left_open() -> None:
    _, _, result = found("p**2/2 + q**3/3", "lie1")  # 2 q, and no polynomial G
    assert result.holds is None


def test_a_map_that_preserves_area_has_nothing_to_telescope() -> None:
    _, _, result = found("p**2/2 - cos(q)", "symplectic-euler")
    assert (result.holds, result.potential) == (True, 0)


def test_a_wrong_formula_is_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    true = potential.potential_of_lie

    def twice(flow: Any, eta: int) -> TwoForm:
        form = true(flow, eta)
        return TwoForm.from_entries(form.ring, form.names, lambda a, b: 2 * form.entry(a, b))

    monkeypatch.setattr(potential, "potential_of_lie", twice)
    assert found("p**2/2 - cos(q)", "lie2")[2].holds is None
