"""Schemes by their coefficients, forged: with a coefficient changed, or a number that is none, a
certificate is refused."""

import copy
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import pytest

from tests.helpers.sampled.certificates import as_read, of_every_in_time
from tests.oracle.printed_certificates import is_true
from verify.proof.certificates import named_numbers
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import EstablishedStatement, state_theorem
from verify.proof.order_for_every_h import prove_for_every_h

TABLEAUX = ["gauss4", "gauss6"]


def certificate(name: str) -> dict[str, Any]:
    return as_read(certify_for_every_h(prove_for_every_h(name)))


def accepted(data: dict[str, Any]) -> EstablishedStatement:
    return state_theorem(check(data))


def refused(data: dict[str, Any], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        check(data)


# -- a wrong coefficient --------------------------------------------------------------------------


def coefficients_of(data: dict[str, Any]) -> Iterator[tuple[list[Any], int]]:
    for row in [*data["tableau"]["a"], data["tableau"]["b"]]:
        for k in range(len(row)):
            yield row, k


@pytest.mark.parametrize("name", TABLEAUX)
@pytest.mark.parametrize("by", [[["1/100"]], [["1/3", "w"]]])
def test_a_changed_coefficient_of_a_tableau_is_refused(name: str, by: list[list[str]]) -> None:
    data = certificate(name)
    for row, k in coefficients_of(data):
        right = row[k]
        terms = [[right]] if isinstance(right, str) else right
        row[k] = [*terms, *by]
        refused(data, r"tableau: b_\d a_\d\d \+ .* is not zero")
        row[k] = "0"
        refused(data, r"tableau: b_\d a_\d\d \+ .* is not zero")
        row[k] = [*terms, *by, *([f"-{c}", *rest] for c, *rest in by)]
        assert accepted(data)
        row[k] = right


def test_a_number_with_another_polynomial_makes_no_tableau_symplectic() -> None:
    """1/(2w) is w/6 where w² = 3, and there alone."""
    data = certificate("gauss4")
    data["tableau"]["a"][0][1] = [["1/4"], ["-1/18", "w", "w", "w"]]
    assert accepted(data).symplectic
    data["numbers"] = [["w", ["-2", "0", "1"], "1", "2"]]
    refused(data, r"tableau: b_1 a_12 \+ b_2 a_21 - b_1 b_2 is not zero")


SHARES: dict[str, Any] = {
    "hamiltonian": "every",
    "separable": False,
    "numbers": [["w", ["-2", "0", "1"], "1", "2"]],
    "stages": [
        [[["1", "w"]], [["1/2", "w", "w", "w"]], [["-1"], ["1", "w"]], [["2"], ["-1", "w"]]],
    ],
}


@pytest.mark.parametrize("entry", range(4))
def test_a_changed_kick_drift_or_share_of_a_stage_is_refused(entry: int) -> None:
    """Of kick = drift = √2, and shares √2 − 1 and 2 − √2, whose sum is 1."""
    data = copy.deepcopy(SHARES)
    assert accepted(data).domain
    for more in (["1/7"], ["1", "w"], ["1", "w", "w"]):
        forged = copy.deepcopy(data)
        forged["stages"][0][entry].append(more)
        refused(forged, "det A is not det B")
        if entry < 2:  # for H = T(p) + V(q) the two may differ
            assert accepted(forged | {"separable": True})


def test_any_size_of_a_shear_preserves_area_but_no_kick_may_look_at_what_it_moves() -> None:
    data = certificate("yoshida4")
    data["stages"][0][0].append(["22/7", "w"])
    assert accepted(data)
    data["stages"][0][1] = [["1/1000", "w"]]
    refused(data, "det A is not det B")


def test_the_times_of_a_tableau_are_any_and_are_said() -> None:
    data = of_every_in_time("gauss4")
    assert "H_q(P1, Q1, t + (-w/6 + 1/2)*h)" in accepted(data).p_next
    data["tableau"]["c"] = ["0", [["1", "w"]]]
    said = accepted(data)
    assert "H_q(P1, Q1, t)" in said.p_next
    assert "H_q(P2, Q2, t + (w)*h)" in said.p_next
    assert is_true(asdict(said), points=1)
    del data["tableau"]["c"]
    refused(data, "tableau: has a, b, c")
    refused(certificate("gauss4") | {"time_dependent": True}, "tableau: has a, b, c")


# -- what a forger may try ------------------------------------------------------------------------

ROOT = ["w", ["-3", "0", "1"], "1", "2"]


@pytest.mark.parametrize(
    ("number", "reason"),
    [
        (["w", ["-3", "0", "1"], "2", "1"], r"w is in no interval, \[2, 1\]"),
        (["w", ["-3", "0", "1"], "1", "1"], "w is in no interval"),
        (["w", ["-3", "0", "1"], "2", "3"], r"no two signs at the ends of \[2, 3\]"),
        (["w", ["-3", "0", "1"], "-2", "2"], "no two signs"),
        (["w", ["3", "0", "1"], "-2", "2"], "no two signs"),
        (["w", ["-4", "0", "1"], "0", "2"], "no two signs"),  # a root at an end
        (["w", ["9", "0", "-6", "0", "1"], "1", "2"], "no two signs"),  # a double root
        (["w", ["0", "-1", "0", "1"], "-2", "2"], "not seen to have one root alone"),  # three
        (["w", ["-1", "3", "-3", "1"], "0", "3"], "not seen to have one root"),  # (w − 1)³
        (["w", ["-3", "2"], "1", "2"], None),  # 3/2
        (["w", ["3"], "1", "2"], "a degree of 1 to 32"),
        (["w", [], "1", "2"], "a degree of 1 to 32"),
        (["w", ["-3", "1", "0"], "1", "4"], "its last coefficient is not 0"),
        (["w", ["-3", *["0"] * 32, "1"], "1", "2"], "a degree of 1 to 32"),
        (["w", ["-3/2", "0", "1"], "1", "2"], "has whole coefficients"),
        (["w", ["-3", "0", 1], "1", "2"], "numbers: w: 1 is no rational number"),
        (["w", ["-3", "0", ["1"]], "1", "2"], "list is no rational number"),
        (["w", ["-" + "3" * 500, "0", "1"], "1", "2"], "more than 200 digits"),
        (["w", ["-3", "0", "1"], "1", "nan"], "'nan' is no rational number"),
        (["w", ["-3", "0", "1"], "1", None], "None is no rational number"),
        (["w", "-3", "1", "2"], "numbers: w: '-3' is no list"),
        (["w", ["-3", "0", "1"], "1"], "each is a name, a polynomial and the ends"),
        ([["w"], ["-3", "0", "1"], "1", "2"], "list is no text"),
        ("w", "'w' is no list"),
    ],
)
def test_a_number_is_one_root_and_no_other(number: Any, reason: str | None) -> None:
    data = {"hamiltonian": "every", "separable": True, "numbers": [number]}
    data["stages"] = [[[["1", "w"]], "0", "0", "0"]]
    if reason is None:
        assert accepted(data).numbers[0].startswith("w = the root of ")
    else:
        refused(data, reason)


@pytest.mark.parametrize(
    "name",
    ["p", "q", "p1", "q12", "P1", "h", "t", "sin", "pi", "e", "H_p", "H", "#1", "w x", "lambda",
     "𝑝", "\x1b[2J", "", "w" * 40, "w\n"],
)  # fmt: skip
def test_a_number_has_a_name_that_stands_for_nothing_else(name: str) -> None:
    data = {"hamiltonian": "every", "separable": True, "numbers": [[name, *ROOT[1:]]]}
    refused(data | {"stages": [[[["1", name]], "0", "0", "0"]]}, "numbers: .* is no new name")


def test_every_number_is_named_once_and_used() -> None:
    data = certificate("gauss4")
    refused(data | {"numbers": [ROOT, ROOT]}, "'w' is no new name")
    refused(data | {"numbers": [ROOT, ["u", *ROOT[1:]]]}, "numbers: nothing asks for u")
    refused(data | {"numbers": []}, "tableau: 'w' stands for nothing")
    refused(data | {"numbers": [[f"w{k}", *ROOT[1:]] for k in range(9)]}, "more than 8")
    refused(data | {"numbers": {}}, "numbers: dict is no list")
    lie = as_read(certify_for_every_h(prove_for_every_h("lie1")))
    refused(lie | {"numbers": [ROOT]}, "no entry of this name: 'numbers'")


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"tableau": []}, "tableau: list is no object"),
        ({"tableau": {"a": [], "b": []}}, "tableau: has 1 to 32 rows"),
        ({"tableau": {"a": [["1/2"]]}}, "tableau: has a, b"),
        ({"tableau": {"a": [["1/2"]], "b": ["1"], "c": ["0"]}}, "tableau: has a, b"),
        ({"tableau": {"a": [["1/2"]], "b": ["1", "0"]}}, "a row has 1 numbers"),
        ({"tableau": {"a": [["1/2"], ["1/2"]], "b": ["1", "0"]}}, "a row has 2 numbers"),
        ({"tableau": {"a": [["1/2"] * 40] * 40, "b": ["1"] * 40}}, "1 to 32 rows"),
        ({"tableau": {"a": [[0.5]], "b": ["1"]}}, "0.5 is no rational number"),
        ({"tableau": {"a": [[[["1/2", "u"]]]], "b": ["1"]}}, "'u' stands for nothing"),
        ({"tableau": {"a": [[[["1/2", "p"]]]], "b": ["1"]}}, "'p' stands for nothing"),
        ({"tableau": {"a": [[["1/2", "w"]]], "b": ["1"]}}, "tableau: '1/2' is no list"),
        ({"stages": [[[["1", "w"]], "0", "0", "0"]]}, "no entry of this name: 'tableau'"),
        ({"hamiltonian": [["1", "p", "q"]]}, "tableau: are those of every hamiltonian"),
        ({"order": None}, "no entry of this name: 'order'"),
        ({"separable": "no"}, "separable: 'no' is not true or false"),
    ],
)
def test_a_tableau_that_has_no_meaning_is_refused(change: dict[str, Any], reason: str) -> None:
    refused(certificate("gauss4") | change, reason)


def test_what_grows_too_long_is_refused_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """By reducing a high power the coefficients grow with every step."""
    data = certificate("gauss4")
    data["numbers"] = [["w", ["-3", "9" * 199, "7"], "0", "1"]]
    data["tableau"]["a"][0][1] = [["1", *["w"] * 200]]
    refused(data, "is too large to be checked here")
    monkeypatch.setattr(named_numbers, "_MOST_WORK", 20)
    refused(certificate("gauss6"), "is too large to be checked here")


def test_a_sum_that_grows_with_each_of_its_terms_is_refused_quickly() -> None:
    terms = [[f"1/{10**1998 + 2 * k + 1}"] for k in range(400)]
    data = certificate("yoshida4")
    data["stages"][0][0] = terms
    refused(data, "stages: a coefficient grows too long")
    refused(
        as_read(certify_for_every_h(prove_for_every_h("lie1"))) | {"leading": terms},
        "leading: a coefficient",
    )


def test_numbers_that_depend_on_each_other_show_nothing() -> None:
    """u is 1 + √2 and w is √2: true, and not seen by the polynomial of each."""
    data = copy.deepcopy(SHARES)
    data["numbers"].append(["u", ["-1", "-2", "1"], "2", "3"])
    data["stages"][0][3] = [["3"], ["-1", "u"]]
    refused(data, "det A is not det B")


def test_stages_of_before_are_read_as_before() -> None:
    data = certificate("stormer-verlet")
    assert data["stages"][0] == ["1/2", "0", "0", "0"]
    assert "numbers" not in data
    assert accepted(data | {"numbers": []}) == accepted(data)
    with_terms = data | {"stages": [[[["1/4"], ["1/4"]], [], [["0"]], "0"], *data["stages"][1:]]}
    assert accepted(with_terms) == accepted(data)
