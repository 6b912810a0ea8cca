"""What a forger may try on a certificate of one H or of every H: it is refused."""

from itertools import product
from typing import Any

import pytest

from tests.helpers.sampled.certificates import as_read, of_text
from verify.proof.certificates import checker
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.certificates.checker import check
from verify.proof.order_for_every_h import prove_for_every_h


def forged(**changes: Any) -> dict[str, Any]:
    return as_read(certify_for_every_h(prove_for_every_h("lie1"))) | changes


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
    for name in ("p1", "q2", "p10", "p"):  # names of coordinates, of whatever H
        refused(data | {"parameters": ["d", name]}, f"'{name}' is no new name")
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
