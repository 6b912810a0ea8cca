"""Certificates of proofs: accepted as they are written, refused with any coefficient changed."""

import ast
import copy
import json
import sys
from collections.abc import Iterator
from dataclasses import asdict
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from mpmath.ctx_mp import MPContext

from tests.helpers.sampled.certificates import as_read, of_every_in_time, of_text
from tests.oracle.printed_certificates import is_true
from verify.errors import InputError
from verify.proof.certificates import balls, checker
from verify.proof.certificates.checker import check
from verify.proof.certificates.established import Established, established
from verify.proof.certificates.every import of_every
from verify.proof.certificates.file import checked
from verify.proof.every import prove_every

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
        return as_read(of_every(prove_every(request.param)))
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


# -- what a forger may try ------------------------------------------------------------------------


def forged(**changes: Any) -> dict[str, Any]:
    return as_read(of_every(prove_every("lie1"))) | changes


def refused(data: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        check(data)


def test_a_derivative_by_another_name_is_no_other_derivative() -> None:
    """H_pq − H_qp is not empty, and is zero."""
    gap = [["1", "H_pq"], ["-1", "H_qp"]]
    data = forged()
    refused(data | {"leading": data["leading"] + gap}, "'H_qp' stands for nothing")


def test_a_map_that_is_not_the_identity_at_h_0_is_refused() -> None:
    """A negative order of agreement would skip h⁰, where p' = 2p has det J = 2."""
    twice = {"p_next": [[["2", "p"]]], "q_next": [[["1", "q"]]], "leading": [], "order": None}
    data = forged(**twice)
    refused(data | {"convergence_order": -1}, "whole number from 0")
    refused(data | {"convergence_order": 0}, "p 0 is not zero")


def test_stages_are_of_every_hamiltonian_and_of_no_other() -> None:
    """An H in the file may not be separable, whatever the flag says."""
    data = {"hamiltonian": [["1", "p", "q"]], "separable": True, "stages": [["1", "0", "0", "0"]]}
    refused(data, "every hamiltonian")
    check(data | {"hamiltonian": "every"})


def test_a_witness_gives_values_to_variables_and_to_nothing_else() -> None:
    """sin² + cos² − 1 is not zero where both are 7."""
    data = of_text("p**2/2 - cos(q)", "lie2")
    refused(data | {"witness": data["witness"] | {"#2": "7", "#3": "7"}}, "gives values to p, q")
    refused(data | {"witness": {"p": "1"}}, "gives values to p, q")
    refused(data | {"witness": {}}, "witness: is missing")


def test_a_mixed_derivative_is_no_name_where_h_is_separable() -> None:
    """It is zero there, and not a coefficient that is not."""
    data = forged(separable=True, order=1, leading=[["1", "H_pq"]], convergence_order=0)
    refused(data, "'H_pq' stands for nothing")


ZEROS = {
    "0": [["#9", "inverse", []]],
    "q - q": [["#9", "inverse", [["1", "q"], ["-1", "q"]]]],
    "sin² + cos² − 1": [
        ["#7", "sin", [["1", "q"]]],
        ["#8", "cos", [["1", "q"]]],
        ["#9", "inverse", [["1", "#7", "#7"], ["1", "#8", "#8"], ["-1"]]],
    ],
}


@pytest.mark.parametrize("zero", ZEROS)
def test_a_quotient_by_zero_makes_nothing_true(zero: str) -> None:
    """With w·u = 1 for u = 0, the cofactor −x of w·u − 1 would show that any x is zero."""
    data = of_text("p**2/2 - cos(q)", "symplectic-euler")
    data |= {"functions": ZEROS[zero], "witness": {"p": "1", "q": "1"}}
    data |= {"hamiltonian": [["1/2", "p", "p"]], "p_next": [[["1", "p"]], [["5", "p", "q"]]]}
    data |= {"q_next": [[["1", "q"]], [["1", "p"]]], "convergence_order": 0}
    data["cofactors"] = {"det 1": {"#9": [["-5", "q"]]}, "det 2": {"#9": [["5", "p"]]}}
    if len(ZEROS[zero]) > 1:
        data["cofactors"]["det 1"]["#7"] = [["5", "q", "#9"]]
        data["cofactors"]["det 2"]["#7"] = [["-5", "p", "#9"]]
    refused(data, "a denominator may be 0")


def test_what_is_beyond_its_range_is_refused_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    data = of_text("p**2/2 + q**2/2 + d*q**4/4", "lie2")
    for number in ("1e999999999", "9" * 5000, "1/0", "٣", "1_0", " 1", "nan", 1, None):
        refused(data | {"leading": [[number, "p"]]}, "leading")
    for whole in (10**9, 2.0, True, "3", -1, 0):
        refused(data | {"order": whole}, "order")
    refused(data | {"leading": [["1", *["p"] * 1000]]}, "factors")
    refused(data | {"parameters": ["d", "\x1b[2J"]}, "no new name")
    refused(data | {"scheme": "stormer-verlet"}, "no entry of this name")
    refused({key: x for key, x in data.items() if key != "cofactors"}, "cofactors is missing")
    powers = list(product(range(9), repeat=3))
    nested = [
        [f"#{n}", "exp", [["1", *["p"] * i, *["q"] * j, *["d"] * k, *inner] for i, j, k in powers]]
        for n, inner in enumerate(([], ["#0"], ["#1"]))
    ]
    monkeypatch.setattr(checker, "_MOST_WORK", 20_000)
    refused(data | {"functions": nested}, "too large")


def test_a_function_before_what_it_is_made_of_is_refused() -> None:
    data = of_text("sin(exp(q)) + p**2", "lie1")
    data["functions"] = data["functions"][::-1]
    refused(data, "stands for nothing")


def test_the_names_of_p_and_q_are_not_given_to_functions() -> None:
    data = of_text("p**2/2 - cos(q)", "lie2")
    data["functions"].append(["p", "exp", [["1", "q"]]])
    with pytest.raises(ValueError, match="new name"):
        check(data)


def test_a_leading_coefficient_of_zero_is_refused() -> None:
    with pytest.raises(ValueError, match=r"leading|order"):
        check(forged(leading=[]))
    with pytest.raises(ValueError, match=r"leading|order"):
        check(forged(order=None))
    with pytest.raises(ValueError, match=r"leading|order"):
        check(forged(order=0))


def test_a_witness_at_which_nothing_is_seen_is_refused() -> None:
    data = of_text("p**2/2 - cos(q)", "lie2")
    with pytest.raises(ValueError, match="witness"):
        check(data | {"witness": data["witness"] | {"p": "0"}})


def test_step_size_inside_a_coefficient_is_refused() -> None:
    data = forged()
    data["p_next"][0].append(["1", "h"])
    with pytest.raises(ValueError, match="'h' stands for nothing"):
        check(data)


@pytest.mark.parametrize(("kind", "x"), [("sin", 3), ("cos", -3), ("exp", 2), ("inverse", 7)])
def test_enclosures_contain_the_value(kind: str, x: int) -> None:
    context = MPContext()
    context.dps = 60
    exact = (lambda y: 1 / y) if kind == "inverse" else getattr(context, kind)
    for radius in (Fraction(0), Fraction(1, 1000)):
        middle, bound = balls.function(kind, (Fraction(x), radius))
        for end in (x - radius, x + radius):
            value = exact(context.mpf(end.numerator) / end.denominator)
            assert abs(context.mpf(middle.numerator) / middle.denominator - value) <= (
                context.mpf(bound.numerator) / bound.denominator + context.mpf(10) ** -50
            )
        assert bound < Fraction(1, 10**9) + 1000 * radius


# -- files and what has none -----------------------------------------------------------------------


def test_what_is_established_is_derived_from_what_is_checked() -> None:
    said = established(check(as_read(of_every(prove_every("lie2")))))
    assert (said.order, said.convergence_order, said.hamiltonian) == (3, 2, "every smooth H")
    assert said.scheme == "the Taylor series of the flow, cut off after h^2, up to O(h^4)"
    assert said.potential == "H_pp*H_qq/2 - H_pq**2/2"
    assert said.statement == (
        "det J − 1 = L h^3 + O(h^4), L not zero for some H, for every smooth H and this map, "
        "which agrees with the flow up to h^2, and L = X·G"
    )
    said = established(check(of_text("p**2/2 + d/(1 + q**2)", "symplectic-euler")))
    assert (said.order, said.leading, said.area_preserving) == (None, None, True)
    assert said.hamiltonian == "d/(q**2 + 1) + p**2/2"
    assert said.p_next == "p + h*(2*d*q/(q**2 + 1)**2)"
    assert (said.scheme, said.domain) == (None, ("q**2 + 1 != 0",))
    said = established(check(as_read(of_every(prove_every("implicit-midpoint")))))
    assert said.p_next == "p1 = p - h*(1)*H_q(p + (1/2)*(p1 - p), q + (1/2)*(q1 - q))"
    assert said.domain == ("the stages have a solution that depends smoothly on (p, q)",)


@pytest.mark.sample(5)
def test_what_is_printed_is_true_and_with_an_error_planted_is_not(
    certificate: dict[str, Any],
) -> None:
    if len(certificate.get("leading", "")) > 40:
        pytest.skip("takes long; it is as true as the shorter ones of its sort")
    said = asdict(established(check(certificate)))
    assert is_true(said, points=1)
    wrong = [{"p_next": f"{said['p_next']} + h*p*q"}] * ("p1 = " not in said["p_next"])
    if said["order"]:
        wrong += [{"leading": f"{said['leading']} + p"}, {"order": said["order"] + 1}]
        wrong.append({"convergence_order": said["order"]})
    for change in wrong:
        assert not is_true(said | change, points=1), change


def test_a_file_is_checked(tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    data = of_every(prove_every("lie2"))
    path.write_text(json.dumps(data))
    assert isinstance(checked(path), Established)
    for broken in (
        {**data, "leading": [["x", "p"]]},
        {**data, "p_next": 3},
        {**data, "order": "3"},
    ):
        path.write_text(json.dumps(broken))
        assert isinstance(checked(path), str)
    del data["q_next"]
    path.write_text(json.dumps(data))
    assert checked(path) == "q_next is missing"
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
        of_text(text, name)


def test_what_is_refuted_has_no_certificate() -> None:
    with pytest.raises(InputError, match="nothing to certify"):
        of_text("p**2/2 - cos(q)", "p_next = p; q_next = q")


def test_the_checker_is_small_and_imports_nothing_of_the_provers() -> None:
    """The files that decide, and those that print what was decided."""
    folder = Path(checker.__file__).parent
    imported, lines = set(), 0
    own = ("checker", "entries", "balls", "readers", "numbers", "coefficients")
    for name in (*own, "established"):
        source = (folder / f"{name}.py").read_text()
        lines += len(source.splitlines()) * (name != "established")
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Import):
                imported |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                imported.add(node.module or "")
    theirs = {f"verify.proof.certificates.{name}" for name in own}
    assert lines <= 1020
    assert {x.partition(".")[0] for x in imported - theirs} <= set(sys.stdlib_module_names)


def test_the_oracle_has_digits_enough_for_coefficients_of_any_length() -> None:
    """A shear by 10¹²⁰·H_q preserves area; 100 digits cannot tell after two powers of it."""
    data = as_read(of_every(prove_every("stormer-verlet", separable=True)))
    data["stages"][0][0] = str(10**120)
    said = asdict(established(check(data)))
    assert is_true(said, points=1)
    wrong = said | {"q_next": said["q_next"].replace("q1 = q", "q1 = q + h*p*q", 1)}
    assert not is_true(wrong, points=1)
