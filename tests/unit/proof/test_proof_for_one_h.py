"""A defect beyond all powers that are looked at refutes who claims that there is none."""

from dataclasses import replace

import pytest

from verify import schemes
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.verdict import Verdict

FREE = Hamiltonian.parse("p**2/2")
LATE = "p_next = p*cosh(h**7); q_next = q + h*p"  # ΔJ = h¹⁴/2 + …


@pytest.mark.parametrize(("claims", "verdict"), [(True, Verdict.REFUTED), (False, Verdict.PROVED)])
def test_a_late_defect_is_held_against_what_is_claimed(claims: bool, verdict: Verdict) -> None:
    scheme = replace(schemes.get(LATE), area_preserving=claims)
    proof = prove(scheme.step_map(FREE), scheme)
    assert (proof.verdict, proof.area_preserving, proof.order) == (verdict, False, None)
    assert "ΔJ is not the zero function, and its coefficients up to h^12 vanish" in proof.reason


@pytest.mark.parametrize(("claims", "verdict"), [(True, Verdict.REFUTED), (False, Verdict.PROVED)])
def test_so_it_is_in_two_degrees(claims: bool, verdict: Verdict) -> None:
    coupled = Hamiltonian.parse("p1**2/2 + p2**2/2 + q1*q2")
    text = (
        "p1_next = (p1 - h*q2)*cosh(h**7); p2_next = p2 - h*q1; "
        "q1_next = q1 + h*p1_next; q2_next = q2 + h*p2_next"
    )
    scheme = replace(schemes.get(text), area_preserving=claims)
    proof = prove(scheme.step_map(coupled), scheme)
    assert (proof.verdict, proof.symplectic, proof.order) == (verdict, False, None)
    assert "S is not the zero form" in proof.reason
