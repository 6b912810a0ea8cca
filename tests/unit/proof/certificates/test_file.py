"""Certificates of proofs: accepted as they are written, refused with any coefficient changed."""

import ast
import copy
import json
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from mpmath.ctx_mp import MPContext

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates import checker
from verify.proof.certificates.checker import check
from verify.proof.certificates.every import of_every
from verify.proof.certificates.file import checked, statement
from verify.proof.certificates.one import of_one
from verify.proof.every import prove_every
from verify.proof.order import prove
from verify.proof.potential import potential_of
from verify.schemes import get

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
]
EVERY = ["lie1", "lie2", "lie3", "lie4", "symplectic-euler"]


def of(text: str, name: str) -> dict[str, Any]:
    scheme = get(name)
    proof = prove(scheme.step_map(Hamiltonian.parse(text)), scheme)
    return as_read(of_one(proof, potential_of(proof, scheme)))


def as_read(data: dict[str, Any]) -> dict[str, Any]:
    return json.loads(json.dumps(data))  # type: ignore[no-any-return]


CERTIFICATES = {f"{text}, {name}": (text, name) for text, name in ONE}


@pytest.fixture(scope="module", params=[*CERTIFICATES, *EVERY])
def certificate(request: pytest.FixtureRequest) -> dict[str, Any]:
    if request.param in EVERY:
        return as_read(of_every(prove_every(request.param)))
    return of(*CERTIFICATES[request.param])


def polynomials(data: dict[str, Any]) -> Iterator[list[list[str]]]:
    """The polynomials that the statement rests on; a cofactor is only the way to it."""
    for key in ("hamiltonian", "leading", "potential"):
        if isinstance(data.get(key), list):
            yield data[key]
    for key in ("p_next", "q_next"):
        yield from data.get(key, [])


def test_a_certificate_holds(certificate: dict[str, Any]) -> None:
    check(certificate)


def test_a_certificate_with_one_changed_coefficient_is_refused(certificate: dict[str, Any]) -> None:
    changed = copy.deepcopy(certificate)
    count = 0
    for polynomial in polynomials(changed):
        for term in polynomial:
            right = term[0]
            for wrong in (-Fraction(right), Fraction(right) + 1, Fraction(right) * Fraction(8, 7)):
                term[0] = str(wrong)
                with pytest.raises(ValueError, match="is"):
                    check(changed)
                count += 1
            term[0] = right
    check(changed)
    assert count or "stages" in changed


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
    data = of("p**2/2 - cos(q)", "lie3")
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
    midpoint = {"format": "", "hamiltonian": "every", "separable": False, "stages": []}
    midpoint["stages"] = [["1", "1", "1/2", "1/2"]]
    check(midpoint)
    right = midpoint["stages"][0][entry]
    if wrong != right:
        midpoint["stages"][0][entry] = wrong
        with pytest.raises(ValueError, match="det A"):
            check(midpoint)


# -- what a forger may try ------------------------------------------------------------------------


def forged(**changes: Any) -> dict[str, Any]:
    return as_read(of_every(prove_every("lie1"))) | changes


def test_a_derivative_by_another_name_is_no_other_derivative() -> None:
    """H_pq − H_qp is not empty, and is zero."""
    gap = [["1", "H_pq"], ["-1", "H_qp"]]
    data = forged()
    data["leading"] = data["leading"] + gap
    with pytest.raises(ValueError, match="name"):
        check(data)


def test_a_function_before_what_it_is_made_of_is_refused() -> None:
    data = of("sin(exp(q)) + p**2", "lie1")
    data["functions"] = data["functions"][::-1]
    with pytest.raises((ValueError, LookupError)):
        check(data)


def test_the_names_of_p_and_q_are_not_given_to_functions() -> None:
    data = of("p**2/2 - cos(q)", "lie2")
    data["functions"].append(["p", "exp", [["1", "q"]]])
    with pytest.raises(ValueError, match="new name"):
        check(data)


def test_a_leading_coefficient_of_zero_is_refused() -> None:
    with pytest.raises(ValueError, match="leading"):
        check(forged(leading=[]))
    with pytest.raises(ValueError, match="leading"):
        check(forged(order=None))
    with pytest.raises(ValueError, match="leading"):
        check(forged(order=0))


def test_a_witness_at_which_nothing_is_seen_is_refused() -> None:
    data = of("p**2/2 - cos(q)", "lie2")
    with pytest.raises(ValueError, match="witness"):
        check(data | {"witness": {"p": "0", "q": "1"}})


def test_step_size_inside_a_coefficient_is_refused() -> None:
    data = forged()
    data["p_next"][0].append(["1", "h"])
    with pytest.raises(ValueError, match="free of h"):
        check(data)


@pytest.mark.parametrize(("kind", "x"), [("sin", 3), ("cos", -3), ("exp", 2), ("inverse", 7)])
def test_enclosures_contain_the_value(kind: str, x: int) -> None:
    context = MPContext()
    context.dps = 60
    exact = (lambda y: 1 / y) if kind == "inverse" else getattr(context, kind)
    for radius in (Fraction(0), Fraction(1, 1000)):
        middle, bound = checker.function(kind, (Fraction(x), radius))
        for end in (x - radius, x + radius):
            value = exact(context.mpf(end.numerator) / end.denominator)
            assert abs(context.mpf(middle.numerator) / middle.denominator - value) <= (
                context.mpf(bound.numerator) / bound.denominator + context.mpf(10) ** -50
            )
        assert bound < Fraction(1, 10**9) + 1000 * radius


# -- files and what has none -----------------------------------------------------------------------


def test_the_statement_is_read_from_what_is_checked() -> None:
    data = as_read(of_every(prove_every("lie2")))
    said = statement(data)
    assert "h^3" in said
    assert "every smooth H" in said
    assert "X·G" in said
    assert "T(p) + V(q)" in statement(data | {"separable": True})
    assert "the H that it holds" in statement(of("p**2/2 - cos(q)", "lie2"))


def test_a_file_is_checked(tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    data = of_every(prove_every("lie2"))
    path.write_text(json.dumps(data))
    assert checked(path)[0]
    for broken in (
        {**data, "leading": [["x", "p"]]},
        {**data, "p_next": 3},
        {**data, "order": "3"},
    ):
        path.write_text(json.dumps(broken))
        assert not checked(path)[0]
    del data["q_next"]
    path.write_text(json.dumps(data))
    accepted, reason = checked(path)
    assert not accepted
    assert "q_next" in reason
    for text in ("{", "[]", '{"format": "other"}'):
        path.write_text(text)
        with pytest.raises(InputError):
            checked(path)
    with pytest.raises(InputError):
        checked(tmp_path / "none.json")


@pytest.mark.parametrize(
    ("text", "name"), [("p**2/2 + log(q)", "lie2"), ("p**2/2 + sqrt(1 + q**2)", "lie1")]
)
def test_functions_that_the_checker_does_not_know_have_no_certificate(text: str, name: str) -> None:
    with pytest.raises(InputError, match="no certificate"):
        of(text, name)


def test_what_is_refuted_has_no_certificate() -> None:
    with pytest.raises(InputError, match="nothing to certify"):
        of("p**2/2 - cos(q)", "p_next = p; q_next = q")


def test_the_checker_is_small_and_imports_nothing_of_ours() -> None:
    source = Path(checker.__file__).read_text()
    assert len(source.splitlines()) <= 150
    imported = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            imported.add(node.module)
    assert imported <= {"re", "fractions", "math", "typing"}
