"""The mark of the small checker: of a certificate that it accepted in this run, and of no other."""

from typing import Any

import pytest

from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.checked import proof_marks
from verify.proof.checked.proved_statement import (
    ALL,
    DEFECT,
    ProvedStatement,
    statement_for_every_h,
    statement_for_one_h,
)
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes import get


def marks(proved: ProvedStatement) -> list[str]:
    return [str(mark) for mark in proof_marks.small_checker_marks(proved)]


def one(system: str, scheme: str, **values: int) -> ProvedStatement:
    hamiltonian = systems.get(system).hamiltonian().with_values(values)
    proof = prove(get(scheme).step_map(hamiltonian), get(scheme))
    return statement_for_one_h(proof, hamiltonian, get(scheme), ALL)


def every(scheme: str) -> ProvedStatement:
    return statement_for_every_h(prove_for_every_h(scheme), get(scheme), ALL)


def made_by(*certificates: Any, about: Any = DEFECT) -> ProvedStatement:
    return ProvedStatement(get("lie2"), about, False, True, False, 1, certificates=certificates)


def forged() -> Any:
    """The certificate of lie2, with another leading coefficient."""
    data = certify_for_every_h(prove_for_every_h("lie2"))
    (first, *names), *others = data["leading"]
    return {**data, "leading": [[f"{first}1", *names], *others]}


def test_the_mark_is_what_the_certificate_establishes() -> None:
    assert marks(one("pendulum", "lie2")) == [
        "small checker: det J − 1 = L h^3 + O(h^4), L not zero, for this H and this map, which "
        "agrees with the flow up to h^2; L = -p*sin(q)/2"
    ]
    assert marks(every("symplectic-euler")) == [
        "small checker: det J = 1 for every smooth H = T(p) + V(q) and the scheme of these stages"
    ]
    (timed,) = marks(statement_for_every_h(prove_for_every_h("lie2", timed=True), get("lie2"), ALL))
    assert "for every smooth H(p, q, t)" in timed


def test_a_parameter_without_a_value_is_a_symbol_in_the_mark() -> None:
    hamiltonian = Hamiltonian(systems.get("duffing").hamiltonian().expression)
    scheme = get("lie2")
    proof = prove(scheme.step_map(hamiltonian), scheme)
    (mark,) = marks(statement_for_one_h(proof, hamiltonian, scheme, ALL))
    assert mark.endswith("L = 3*delta*p*q")


def test_where_the_map_has_no_certificate_that_of_every_h_tells_of_preserved_area() -> None:
    for scheme in ("stormer-verlet", "implicit-midpoint", "gauss4"):
        (mark,) = marks(one("pendulum", scheme))
        assert mark.startswith("small checker: det J = 1 for every smooth H")


def test_a_map_that_is_no_polynomial_in_h_and_changes_area_has_no_mark() -> None:
    assert marks(one("pendulum", "rk4")) == []


def test_in_degrees_s_is_certified_and_of_det_j_nothing() -> None:
    hamiltonian = systems.get("henon-heiles").hamiltonian()
    proof, scheme = prove(get("lie2").step_map(hamiltonian), get("lie2")), get("lie2")
    (mark,) = marks(statement_for_one_h(proof, hamiltonian, scheme, DEFECT))
    assert "S = JᵀΩJ − Ω = L h^3" in mark
    assert marks(statement_for_one_h(proof, hamiltonian, scheme, frozenset({"volume"}))) == []
    verlet = prove_for_every_h("stormer-verlet", degrees=2)
    (mark,) = marks(statement_for_every_h(verlet, get("stormer-verlet"), frozenset({"volume"})))
    assert "S = JᵀΩJ − Ω = 0" in mark


# -- planted errors -------------------------------------------------------------------------------


def test_a_certificate_that_is_refused_makes_no_mark() -> None:
    true = made_by(lambda: certify_for_every_h(prove_for_every_h("lie2")))
    assert len(marks(true)) == 1
    assert marks(made_by(forged)) == []


def test_after_one_that_is_refused_no_other_is_tried() -> None:
    """It is of this proof, and wrong: a mark by another way would hide that."""
    assert marks(made_by(forged, lambda: certify_for_every_h(prove_for_every_h("lie2")))) == []


def test_what_cannot_be_certified_leaves_the_next_or_nothing() -> None:
    def none() -> Any:
        raise InputError("map", "x", "no certificate")

    assert len(marks(made_by(none, lambda: certify_for_every_h(prove_for_every_h("lie2"))))) == 1
    assert marks(made_by(none)) == []
    assert marks(made_by()) == []


def test_what_is_not_asked_is_not_certified() -> None:
    def never() -> Any:
        pytest.fail("a certificate was made")

    assert marks(made_by(never, about=frozenset({"product"}))) == []


def test_a_proof_that_takes_long_to_certify_is_not() -> None:
    assert every("lie6").certificates
    assert not every("lie7").certificates
