"""What an export says of L, which functions it speaks of, and which it refuses."""

from collections.abc import Sequence
from typing import Any

import pytest

from tests.helpers.rocq.exports import certificate, export, export_of, proved
from verify.errors import InputError
from verify.proof.assistant.nonzero_witness import energy_that_shows
from verify.proof.certificates.checker import check
from verify.proof.certificates.entries import Expansion

NOT_ZERO, UNSAID = "first_coefficient_is_not_zero", "is not shown here"


def of(hamiltonian: str, scheme: str = "lie2") -> dict[str, Any]:
    return proved(["--hamiltonian", hamiltonian, "--scheme", scheme])


@pytest.mark.parametrize(
    "hamiltonian", ["p**2/2 - cos(q + 1/3)", "p**2/2 + exp(p + 2)*cos(2*q - 1)", "p**2/2 - a/q"]
)
def test_l_is_shown_to_be_not_zero_where_functions_may_be_taken_of_0(hamiltonian: str) -> None:
    found = export_of(of(hamiltonian))
    assert NOT_ZERO in found.theorems
    assert "L not zero" in found.facts.statement
    assert UNSAID not in found.text


def test_what_is_not_shown_is_not_said() -> None:
    found = export_of(of("p**2/2 + exp(q**2 + 1)"))
    assert NOT_ZERO not in found.theorems
    assert "not zero" not in found.facts.statement
    assert (
        f"That L is not zero, so that the order is this one and no higher, {UNSAID}" in found.text
    )


def test_more_energies_are_tried_than_those_with_one_term_and_at_0() -> None:
    entries = check(certificate("every_kick"))
    assert isinstance(entries, Expansion)
    # One of the derivatives alone, and p = 0, would not do for any of the terms.
    leading = {("H_p", "H_q", "p"): 1, ("H_p", "H_p", "p"): -1, ("H_q", "p"): 1, ("H_q", "q"): -1}
    object.__setattr__(entries, "leading", {("p", "q"): leading})
    found = energy_that_shows(entries)
    assert found is not None
    assert found.point["p"] or found.point["q"]
    assert found.energy


def with_functions(functions: Sequence[Any], text: str = "p**2/2 + q**4") -> dict[str, Any]:
    return {**of(text), "functions": list(functions), "witness": {"p": "1", "q": "1"}}


def test_functions_that_nothing_is_made_of_are_left_out() -> None:
    plain = export_of(with_functions([]))
    unused = [[f"#{k}", "inverse", [["1", "q", "q"], [str(k)]]] for k in range(1, 301)]
    assert export_of(with_functions(unused)).text == plain.text


def test_a_partner_is_kept() -> None:
    assert "(Cosine 5, (Name 2)); (Sine 4, (Name 2))" in export("pendulum_lie2").text


@pytest.mark.left_to_ci
def test_functions_nested_too_deeply_are_refused_in_one_line() -> None:
    def nested(depth: int) -> str:
        return "q" if not depth else f"sin({nested(depth - 1)})"

    assert export_of(of(f"p**2/2 + {nested(20)}", "lie1")).theorems
    with pytest.raises(InputError, match="nested more than 20 deep, which coqc takes long for"):
        export_of(of(f"p**2/2 + {nested(21)}", "lie1"))


def test_two_names_of_one_function_are_seen_through() -> None:
    data = certificate("two_names")
    assert len(data["functions"]) == 2
    assert export("two_names").theorems == export("quotient").theorems


def test_what_is_no_sum_of_multiples_is_refused() -> None:
    data = certificate("two_names")
    data["functions"] = [*data["functions"][:-1], ["#99", "inverse", [["2", "q", "q"]]]]
    with pytest.raises(InputError, match="is refused"):
        export_of(data)
