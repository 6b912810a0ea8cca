"""Formulas with decimals of eight digits and more: the order is that of exact numbers near them."""

from typing import Any

import pytest

from verify import schemes
from verify.claims.base_claim import Findings
from verify.claims.kinds import models
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.plane.modified_for_one_h import modified_for_one_h
from verify.proof.proof_for_one_h import Proof
from verify.scenes.scene import Scene
from verify.verdict import Verdict

OSCILLATOR = Hamiltonian.parse("p**2/2 + q**2/2")
PENDULUM = systems.get("pendulum").hamiltonian()
HENON = systems.get("henon-heiles").hamiltonian()
# exp(hA) of the oscillator up to h^4; ΔJ is −h⁶/72 + ….
ROTATION = (
    "p_next = (1 - h**2/2 + {a}*h**4)*p - (h - {b}*h**3)*q; "
    "q_next = (1 - h**2/2 + {a}*h**4)*q + (h - {b}*h**3)*p"
)
# Kicks and a drift; the two halves of the kick differ by what their digits leave.
VERLET = (
    "p_next = p - {a}*h*sin(q) - {b}*h*sin(q + h*p - {a}*h**2*sin(q)); "
    "q_next = q + h*p - {a}*h**2*sin(q)"
)


def proof_of(hamiltonian: Hamiltonian, text: str) -> Proof:
    scheme = schemes.get(text)
    return prove(scheme.step_map(hamiltonian), scheme)


@pytest.mark.parametrize(
    ("a", "b"), [("0.041666666667", "0.16666666667"), ("0.0416666666666666", "0.16666667")]
)
def test_a_residue_of_the_digits_ends_no_order(a: str, b: str) -> None:
    proof = proof_of(OSCILLATOR, ROTATION.format(a=a, b=b))
    assert (proof.convergence_order, proof.convergence_decided) == (4, True)
    assert proof.verdict in (Verdict.ENCLOSED, Verdict.MEASURED)
    assert "order 4 of exact coefficients near the printed ones" in proof.reason
    assert "ΔJ has no term up to h^5 with exact coefficients" in proof.reason


@pytest.mark.parametrize(
    ("a", "b", "order"),
    [("0.041666676667", "0.16666666667", 3), ("0.041666666667", "0.16666676667", 2)],
)
def test_a_wrong_digit_ends_it(a: str, b: str, order: int) -> None:
    proof = proof_of(OSCILLATOR, ROTATION.format(a=a, b=b))
    assert (proof.convergence_order, proof.convergence_decided) == (order, True)


def test_exact_numbers_and_short_decimals_are_what_they_are() -> None:
    for a, b in (("1/24", "1/6"), ("0.0416667", "1/6"), ("0.04166667", "0.166667")):
        proof = proof_of(OSCILLATOR, ROTATION.format(a=a, b=b))
        assert proof.verdict is Verdict.PROVED
        assert "near" not in proof.reason
    assert proof_of(OSCILLATOR, ROTATION.format(a="1/24", b="1/6")).convergence_order == 4


def test_numbers_within_a_function_are_looked_at_by_its_series() -> None:
    proof = proof_of(PENDULUM, VERLET.format(a="0.50000000001", b="0.49999999998"))
    assert (proof.convergence_order, proof.convergence_decided) == (2, True)
    wrong = proof_of(PENDULUM, VERLET.format(a="0.50000010001", b="0.49999999998"))
    assert wrong.convergence_order == 0


def test_a_parameter_of_h_is_exact() -> None:
    heavy = Hamiltonian.parse("p**2/2 + 9.80665001*q")
    fall = "p_next = p - {g}*h; q_next = q + h*p - {g}*h**2/2"
    exact = proof_of(heavy, fall.format(g="9.80665001"))
    assert (exact.verdict, exact.convergence_decided) == (Verdict.PROVED, True)
    assert "near" not in proof_of(heavy, "p_next = p - 9.80665001*h; q_next = q + h*p").reason
    off = "p_next = p - 9.80665001*h*1.0000000001; q_next = q + h*p"
    assert proof_of(heavy, off).convergence_order == 1  # by the other number alone


def test_several_degrees() -> None:
    text = (
        "p1_next = p1 - {a}*h*(q1 + 2*q1*q2); p2_next = p2 - h*(q2 + q1**2 - q2**2); "
        "q1_next = q1 + h*p1_next; q2_next = q2 + {b}*h*p2_next"
    )
    scheme = schemes.get(text.format(a="1.00000000001", b="0.99999999999"))
    proof = prove(scheme.step_map(HENON), scheme)
    assert (proof.convergence_order, proof.convergence_decided) == (1, True)
    assert "S has no term up to h^8 with exact coefficients" in proof.reason
    wrong = schemes.get(text.format(a="1.00000010001", b="0.99999999999"))
    assert prove(wrong.step_map(HENON), wrong).verdict is Verdict.REFUTED


def test_a_modified_equation_takes_its_digits_for_what_they_are() -> None:
    scheme = schemes.get(ROTATION.format(a="0.041666666667", b="0.16666666667"))
    found = modified_for_one_h(scheme.step_map(OSCILLATOR), scheme, 3)
    assert found.verdict in (Verdict.ENCLOSED, Verdict.MEASURED)
    half = schemes.get("p_next = p - 1.00000001*h*q; q_next = q + h*p_next")
    assert modified_for_one_h(half.step_map(OSCILLATOR), half, 2).verdict in (
        Verdict.ENCLOSED,
        Verdict.MEASURED,
    )
    wrong = schemes.get("p_next = p - 1.00001001*h*q; q_next = q + h*p_next")
    assert modified_for_one_h(wrong.step_map(OSCILLATOR), wrong, 2).verdict is Verdict.REFUTED


def claimed(kind: str, value: Any, scheme: str, **more: Any) -> Verdict:
    model = models()[kind]
    keys = {"id": "c", "scene": "made", "scheme": scheme, "kind": kind, kind: value, **more}
    made = Scene(hamiltonian="p**2/2 + q**2/2", schemes=(scheme,), name="made")
    return model.model_validate(keys).judge(Findings({"made": made})).verdict


def test_claims_are_held_against_exact_numbers_near_the_printed_ones() -> None:
    right = ROTATION.format(a="0.041666666667", b="0.16666666667")
    wrong = ROTATION.format(a="0.041666676667", b="0.16666676667")
    holds = {Verdict.ENCLOSED, Verdict.MEASURED}
    for kind, value in (("convergence_order", 4), ("defect_order", 6)):
        assert claimed(kind, value, right) in holds
        assert claimed(kind, value, right, at_least=True) in holds
        assert claimed(kind, value, wrong) is Verdict.REFUTED
        assert claimed(kind, value - 1, right) is Verdict.REFUTED
        assert claimed(kind, value + 1, right, at_least=True) is Verdict.REFUTED
    assert claimed("area_preserving", True, right) is Verdict.REFUTED  # −h⁶/72 is no digit's
    turned = "p_next = p - 1.00000001*h*q; q_next = q + h*p - 1.00000000*h**2*q"
    assert claimed("area_preserving", True, turned) is Verdict.UNDECIDED
    assert claimed("symplectic", True, turned) is Verdict.UNDECIDED
    spoilt = "p_next = p - 1.00010001*h*q; q_next = q + h*p - 1.00000000*h**2*q"
    assert claimed("area_preserving", True, spoilt) is Verdict.REFUTED
