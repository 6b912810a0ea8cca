"""Certificates in n degrees of freedom: what is accepted, and that what is forged is refused."""

import copy
from functools import cache
from typing import Any

import pytest

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.certification import certify_for_every_h as certificate_of_every
from verify.proof.certificates.certification import certify_for_one_h as certificate_of_one
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import EstablishedStatement, state_theorem
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes import get

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
MIXED = "(p1*q2 + p2)**2/2 + q1*exp(p1/2)/(1 + q2**2) + sin(q1)"
CHAIN = "p1**2/2 + p2**2/2 + p3**2/2 + a*q1**2*q2 + q3**2*q2"
DRIVEN = "p1**2/2 + p2**2/2 + q1*q2*cos(t) + q1**4"
CUBIC = "(p1**2 + p2**2)/2 + q1**2*q2"
EULER = ("p1_next = p1 - 2*h*q1*q2; p2_next = p2 - h*q1**2; q1_next = q1 + h*p1_next; "
         "q2_next = q2 + h*p2_next")  # fmt: skip
ONE = [(HENON, "lie1"), (HENON, "lie2"), (HENON, "lie3"), (MIXED, "lie2"), (CHAIN, "lie2"),
       (DRIVEN, "lie2"), (HENON, "rk4"), (HENON, "explicit-midpoint")]  # fmt: skip
EVERY = [("lie1", 2, False), ("lie2", 2, False), ("lie2", 3, False), ("lie2", 2, True),
         ("explicit-midpoint", 2, False), ("stormer-verlet", 3, False),
         ("implicit-midpoint", 2, False), ("stormer-verlet", 2, True)]  # fmt: skip


@cache
def _of_one(formula: str, scheme: str) -> dict[str, Any]:
    hamiltonian = Hamiltonian.parse(formula)
    return certificate_of_one(prove(get(scheme).step_map(hamiltonian), get(scheme)))


def of_one(formula: str, scheme: str) -> dict[str, Any]:
    return copy.deepcopy(_of_one(formula, scheme))


@cache
def of_every(scheme: str, degrees: int, timed: bool) -> dict[str, Any]:
    return certificate_of_every(prove_for_every_h(scheme, degrees=degrees, timed=timed))


def accepted(data: dict[str, Any]) -> EstablishedStatement:
    return state_theorem(check(data))


def refused(data: dict[str, Any], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        check(data)


@pytest.mark.parametrize(("formula", "scheme"), ONE)
def test_what_is_proved_of_one_is_accepted(formula: str, scheme: str) -> None:
    said = accepted(of_one(formula, scheme))
    proof = prove(get(scheme).step_map(Hamiltonian.parse(formula)), get(scheme))
    assert (said.order, said.convergence_order) == (proof.order, proof.convergence_order)
    assert (said.degrees, said.symplectic, said.area_preserving) == (proof.degrees, False, None)
    assert len(said.p_next) == len(said.q_next) == said.degrees


@pytest.mark.parametrize(("scheme", "degrees", "timed"), EVERY)
def test_what_is_proved_of_every_is_accepted(scheme: str, degrees: int, timed: bool) -> None:
    said = accepted(of_every(scheme, degrees, timed))
    assert f"in {degrees} degrees of freedom" in said.statement
    assert said.symplectic is (scheme in ("stormer-verlet", "implicit-midpoint"))


def test_a_symplectic_map_that_is_written_out_has_one_of_its_own() -> None:
    said = accepted(of_one(CUBIC, EULER))
    assert said.symplectic is True
    assert said.statement.startswith("S = JᵀΩJ − Ω = 0, for this H")


def test_a_map_with_h_in_its_functions_has_one() -> None:
    """Each of its coefficients is made in a ring of its own, and S in another."""
    formula = "(p1**2 + p2**2)/2 - cos(q1) - cos(q2)"
    bent = ("p1_next = p1 - sin(h)*sin(q1); q1_next = q1 + h*p1; p2_next = p2 - h*sin(q2); "
            "q2_next = q2 + sin(h)*p2")  # fmt: skip
    said = accepted(of_one(formula, bent))
    assert (said.order, said.convergence_order) == (2, 1)
    assert said.leading == "(cos(q1))*dp1∧dq1 + (cos(q2))*dp2∧dq2"


def test_what_preserves_volume_alone_is_no_symplectic_map() -> None:
    """p1 is stretched and p2 shrunk by factors of the product 1: S has entries, det J is 1."""
    data = of_one(CUBIC, EULER)
    for name, series in data["next"].items():
        data["next"][name] = series[:1]
    data |= {"convergence_order": 0, "order": None, "leading": []}
    assert accepted(data).symplectic
    data["next"]["p1"].append([["1", "p1"]])
    data["next"]["p2"].append([["-1", "p2"]])
    refused(data, "S 1 p1 q1 is not zero")


@pytest.mark.parametrize("formula", [HENON, MIXED])
def test_every_coefficient_counts(formula: str) -> None:
    data = of_one(formula, "lie2")
    for name, series in data["next"].items():
        for n in range(len(series)):
            forged = copy.deepcopy(data)
            forged["next"][name][n] = [*forged["next"][name][n], ["1/7", "p1", "q2"]]
            refused(forged, "is not zero")
    for key in ("leading", "potential"):
        for k in range(len(data[key])):
            forged = copy.deepcopy(data)
            forged[key][k][2] = [*forged[key][k][2], ["1/7", "p1", "q2"]]
            refused(forged, "is not zero")
            forged[key].pop(k)
            refused(forged, "is not zero")


def test_orders_may_be_said_too_low_and_never_too_high() -> None:
    data = of_one(HENON, "lie3")
    assert accepted(data | {"convergence_order": 1}).convergence_order == 1
    refused(data | {"convergence_order": 4}, "is not zero")
    refused(data | {"order": 3}, "longer than is said|is not zero")
    refused(data | {"order": 5}, "is not zero")
    refused(data | {"order": None}, "one says")
    refused(data | {"order": None, "leading": []}, "is not zero")


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"degrees": 0}, "degrees: 0 is no whole number"),
        ({"degrees": 17}, "degrees: 17 is no whole number"),
        ({"degrees": "2"}, "degrees: '2' is no whole number"),
        ({"degrees": 3}, "next: has a list for each of p1, p2, p3, q1, q2, q3"),
        ({"next": []}, "next: list is no object"),
        ({"leading": [["p2", "p1", []]]}, "leading: 'p2', 'p1' are no two coordinates"),
        ({"leading": [["p1", "p1", []]]}, "are no two coordinates in their order"),
        ({"leading": [["p1", "x", []]]}, "are no two coordinates in their order"),
        ({"leading": [["p1", "q1", [["1", "p2"]]]] * 2}, "'p1', 'q1' stand twice"),
        ({"leading": [["p1", "q1"]]}, "each entry is two coordinates and a polynomial"),
        ({"leading": [["p1", "q1", [["1", "p"]]]]}, "'p' stands for nothing"),
        ({"leading": [["p1", "q1", [["1", "q3"]]]]}, "'q3' stands for nothing"),
        ({"parameters": ["q2"]}, "parameters: 'q2' is no new name"),
        ({"witness": {"p1": "1"}}, "witness: gives values to the coordinates"),
        ({"witness": {"p1": "0", "p2": "0", "q1": "0", "q2": "0"}}, "may be 0 at the witness"),
        ({"p_next": []}, "no entry of this name: 'p_next'"),
        ({"cofactors": {"S 3 p1 q1": {"#1": []}}}, "has no relation"),
    ],
)
def test_what_has_no_meaning_is_refused(change: dict[str, Any], reason: str) -> None:
    refused(of_one(HENON, "lie2") | change, reason)


def test_derivatives_of_h_have_one_name() -> None:
    """H_q1p1 is not known beside H_p1q1, nor what is no coordinate, nor t without time."""
    data = of_every("lie2", 2, False)
    for name in ("H_q1p1", "H_p3", "H_p", "H_t", "H_p1t", "H_", "H_p0", "H_p01"):
        forged = data | {"leading": [["p1", "q1", [["1", name]]]]}
        refused(forged, "stands for nothing")
    refused(data | {"separable": True}, "stands for nothing")


def test_stages_are_symplectic_by_the_same_rule_as_in_the_plane() -> None:
    data = of_every("implicit-midpoint", 2, False)
    refused(data | {"stages": [["1", "1", "1", "1/2"]]}, "det A is not det B")
    refused(data | {"stages": [["1", "2", "1/2", "1/2"]]}, "det A is not det B")
    assert accepted(data | {"stages": [["1", "2", "1/2", "1/2"]], "separable": True}).symplectic


@pytest.mark.parametrize(
    ("formula", "scheme", "problem"),
    [
        ("(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)", "lie2", "it takes sin, cos, exp"),
        (HENON, "stormer-verlet", "is not written out as a polynomial"),
        (HENON, "p1_next = p1; p2_next = p2; q1_next = q1; q2_next = q2", "nothing to certify"),
    ],
)
def test_where_there_is_none_it_says_why(formula: str, scheme: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        of_one(formula, scheme)


def test_an_odd_taylor_polynomial_of_an_h_whose_form_vanishes_has_a_certificate() -> None:
    """S of lie1 is 0 where no derivative of H is of two variables: 0 telescopes, without β."""
    formula = "3*p1/4 + sin(3*q1)/2 + 7*p2/3 + cos(3*q2)/7 + (q1 - q2)**2/2"
    proof = prove(get("lie1").step_map(Hamiltonian.parse(formula)), get("lie1"))
    assert proof.symplectic
    assert proof.telescopes
    data = of_one(formula, "lie1")
    accepted(data)
    data["next"]["p1"][1][0][0] += "0"
    with pytest.raises(ValueError, match=r"is not zero|is not|differs"):
        check(data)
