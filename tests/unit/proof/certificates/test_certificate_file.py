"""Certificates of proofs: accepted as they are written, refused with any coefficient changed."""

import copy
import json
from collections.abc import Iterator
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.sampled.certificates import as_read, of_every_in_time, of_text
from tests.oracle.printed_certificates import is_true
from verify.errors import InputError
from verify.proof.certificates.certificate_file import check_file
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import EstablishedStatement, state_theorem
from verify.proof.order_for_every_h import prove_for_every_h

ONE = [
    ("p**2/2 + q**2/2 + d*q**4/4", "lie2"),
    ("p**2/2 - cos(q)", "lie2"),
    ("p**2/2 - cos(q)", "lie3"),
    ("p**2/2 - cos(q)", "symplectic-euler"),
    ("p**2/2 + 1/(1 + q**2)", "lie3"),
    ("exp(p*q)", "lie2"),
    ("p**2/2 + exp(-q) + q + 5", "lie2"),
    ("p**2/2 + sin(p + q)*cos(p)", "lie1"),
    ("sin(exp(q)) + p**2", "lie1"),
    ("p**2/2 + q**3/3", "lie3"),
    ("p**2/2 - (1 + cos(2*t)/2)*cos(q)", "lie2"),
    ("p**2/2 - (1 + cos(2*t)/2)*cos(q)", "lie3"),
    ("p**2/2 + q**4/4 - d*q**2*t**2 + sin(t)", "symplectic-euler"),
    ("p**2/2 + d*q**3/(1 + t**2)", "lie2"),
    ("t*p*q + exp(t)*q**2", "lie2"),
]
EVERY = ["lie1", "lie2", "lie3", "lie4", "symplectic-euler"]
EVERY_IN_TIME = ["lie1", "lie2", "lie3", "symplectic-euler", "implicit-midpoint"]

CERTIFICATES = {f"{text}, {name}": (text, name) for text, name in ONE}


@pytest.fixture(
    scope="module", params=[*CERTIFICATES, *EVERY, *(f"{name} in time" for name in EVERY_IN_TIME)]
)
def certificate(request: pytest.FixtureRequest) -> dict[str, Any]:
    if request.param.endswith(" in time"):
        return of_every_in_time(request.param.removesuffix(" in time"))
    if request.param in EVERY:
        return as_read(certify_for_every_h(prove_for_every_h(request.param)))
    return of_text(*CERTIFICATES[request.param])


def polynomials(data: dict[str, Any]) -> Iterator[list[list[str]]]:
    """The polynomials that the statement rests on; a cofactor is only the way to it."""
    for key in ("hamiltonian", "leading", "potential"):
        if isinstance(data.get(key), list):
            yield data[key]
    for key in ("p_next", "q_next"):
        yield from data.get(key, [])


def test_a_certificate_holds(certificate: dict[str, Any]) -> None:
    check(certificate)


@pytest.mark.sample(12)
def test_a_certificate_with_one_changed_coefficient_is_refused(certificate: dict[str, Any]) -> None:
    changed = copy.deepcopy(certificate)
    count = 0
    for polynomial in polynomials(changed):
        for term in polynomial:
            right = term[0]
            x = Fraction(right)
            term[0] = str((-x, x + 1, x * Fraction(8, 7))[count % 3])  # each in one of three ways
            with pytest.raises(ValueError, match="is"):
                check(changed)
            count += 1
            term[0] = right
    check(changed)
    assert count or "stages" in changed


@pytest.mark.sample(7)
def test_a_certificate_with_a_term_dropped_or_a_power_more_is_refused(
    certificate: dict[str, Any],
) -> None:
    changed = copy.deepcopy(certificate)
    for polynomial in polynomials(changed):
        for k in range(len(polynomial)):
            term = polynomial.pop(k)
            with pytest.raises(ValueError, match="is"):
                check(changed)
            polynomial.insert(k, [*term, "p"])
            with pytest.raises(ValueError, match="is"):
                check(changed)
            polynomial[k] = term
    check(changed)


@pytest.mark.parametrize("key", ["order", "convergence_order"])
def test_an_order_off_by_one_is_refused(certificate: dict[str, Any], key: str) -> None:
    if certificate.get(key) is None:
        pytest.skip("it has none")
    with pytest.raises(ValueError, match="is"):
        check(certificate | {key: certificate[key] + 1})
    if key == "order":
        with pytest.raises(ValueError, match="is"):
            check(certificate | {key: certificate[key] - 1})


def test_a_changed_cofactor_is_refused() -> None:
    data = of_text("p**2/2 - cos(q)", "lie3")
    assert data["cofactors"]
    for cofactors in data["cofactors"].values():
        for terms in cofactors.values():
            right = terms[0][0]
            terms[0][0] = str(Fraction(right) + 1)
            with pytest.raises(ValueError, match="is not zero"):
                check(data)
            terms[0][0] = right
    check(data)


STAGES = ["2", "1/2", "-1", "0"]


@pytest.mark.parametrize("wrong", STAGES)
@pytest.mark.parametrize("entry", range(4))
def test_a_changed_stage_is_refused(entry: int, wrong: str) -> None:
    midpoint: dict[str, Any] = {"hamiltonian": "every", "separable": False}
    midpoint["stages"] = [["1", "1", "1/2", "1/2"]]
    check(midpoint)
    right = midpoint["stages"][0][entry]
    if wrong != right:
        midpoint["stages"][0][entry] = wrong
        with pytest.raises(ValueError, match="det A"):
            check(midpoint)


# -- files and what has none -----------------------------------------------------------------------


@pytest.mark.sample(5)
def test_what_is_printed_is_true_and_with_an_error_planted_is_not(
    certificate: dict[str, Any],
) -> None:
    if len(certificate.get("leading", "")) > 40:
        pytest.skip("takes long; it is as true as the shorter ones of its sort")
    said = asdict(state_theorem(check(certificate)))
    assert is_true(said, points=1)
    wrong = [{"p_next": f"{said['p_next']} + h*p*q"}] * ("p1 = " not in said["p_next"])
    if said["order"]:
        wrong += [{"leading": f"{said['leading']} + p"}, {"order": said["order"] + 1}]
        wrong.append({"convergence_order": said["order"]})
    for change in wrong:
        assert not is_true(said | change, points=1), change


def test_a_file_is_checked(tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    data = certify_for_every_h(prove_for_every_h("lie2"))
    path.write_text(json.dumps(data))
    assert isinstance(check_file(path), EstablishedStatement)
    for broken in (
        {**data, "leading": [["x", "p"]]},
        {**data, "p_next": 3},
        {**data, "order": "3"},
    ):
        path.write_text(json.dumps(broken))
        assert isinstance(check_file(path), str)
    del data["q_next"]
    path.write_text(json.dumps(data))
    assert check_file(path) == "q_next is missing"
    for text in ("{", "[]", '{"format": "other"}'):
        path.write_text(text)
        with pytest.raises(InputError):
            check_file(path)
    with pytest.raises(InputError):
        check_file(tmp_path / "none.json")


@pytest.mark.parametrize(
    ("text", "name"), [("p**2/2 + log(q)", "lie2"), ("p**2/2 + sqrt(1 + q**2)", "lie1")]
)
def test_functions_that_the_checker_does_not_know_have_no_certificate(text: str, name: str) -> None:
    with pytest.raises(InputError, match="no certificate"):
        of_text(text, name)


def test_what_is_refuted_has_no_certificate() -> None:
    with pytest.raises(InputError, match="nothing to certify"):
        of_text("p**2/2 - cos(q)", "p_next = p; q_next = q")
