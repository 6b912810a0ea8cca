"""For which parameters an order is what it is, against proofs with values put in."""

from fractions import Fraction
from typing import Any

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import Proof, prove
from verify.proof.special_values import special_values
from verify.schemes import get

DUFFING = "p**2/2 + q**2/2 + delta*q**4/4"
MORSE = "p**2/2 + D*(1 - exp(-a*q))**2"
PENDULUM = "p**2/2 - g*m*cos(q/l)"
MIXED = "a*p**3 + b*q**3 + c*p*q"
QUARTIC = "p**2/(2*m) + k*q**2/2 + b*q**4"
NOT_KNOWN = (
    "(a, b) is outside of a set of measure 0, not found, on which the coefficient of h^3 is 0 at"
    " every point"
)


def proof(formula: str, scheme: str, **values: str) -> Proof:
    hamiltonian = Hamiltonian.parse(formula).with_values(values)
    return prove(get(scheme).step_map(hamiltonian))


@pytest.mark.parametrize(
    ("formula", "scheme", "asked"),
    [
        (DUFFING, "lie2", ["delta != 0"]),
        (DUFFING, "lie1", []),  # its h² coefficient is 1 + 3 δ q²
        ("p**2/2 + a*q**2", "lie2", ["a != 0"]),
        ("(1 + a**2)*(p**4 + q**4)", "lie2", []),
        (MIXED, "lie2", ["a != 0", "b != 0"]),
        (MIXED, "rk4", ["a != 0", "b != 0"]),
        (QUARTIC, "lie2", ["b != 0", "m != 0"]),
        (QUARTIC, "rk4", ["b**2 + k**2*m**2 != 0", "m != 0"]),
        (MORSE, "lie2", ["D != 0", "a != 0"]),
        (PENDULUM, "lie2", ["g != 0", "l != 0", "m != 0"]),
        ("p**2/2 - omega**2*cos(q)", "lie2", ["omega != 0"]),
        ("p**2/2 + cos(a*q) + b*q**4", "lie2", [NOT_KNOWN]),
        ("p**2/2 - cos(q)", "lie2", []),
        ("p**2/2 + log(q)", "lie2", ["q > 0"]),
        ("p**2/2 + a*log(q)", "stormer-verlet", ["q > 0", "H is smooth at the stages"]),
        ("p**2/2 + a*q**4", "implicit-midpoint",
         ["the stages have a solution that depends smoothly on (p, q)"]),
    ],
)  # fmt: skip
def test_the_domain_names_the_parameters(formula: str, scheme: str, asked: list[str]) -> None:
    assert list(proof(formula, scheme).domain.texts) == asked


@pytest.mark.parametrize(
    ("formula", "scheme", "inside", "outside"),
    [
        (DUFFING, "lie2", {"delta": "1/7"}, {"delta": "0"}),
        (MIXED, "lie2", {"a": "1", "b": "-2", "c": "0"}, {"a": "0", "b": "1", "c": "1"}),
        (MIXED, "rk4", {"a": "1", "b": "-2", "c": "0"}, {"a": "1", "b": "0", "c": "1"}),
        (QUARTIC, "rk4", {"b": "0", "k": "1", "m": "1"}, {"b": "0", "k": "0", "m": "1"}),
        (MORSE, "lie2", {"D": "3", "a": "-1"}, {"D": "3", "a": "0"}),
        (PENDULUM, "lie2", {"g": "3", "m": "-1", "l": "2"}, {"g": "0", "m": "1", "l": "1"}),
    ],
)
def test_the_order_is_this_one_in_the_domain_and_higher_outside(
    formula: str, scheme: str, inside: dict[str, str], outside: dict[str, str]
) -> None:
    symbolic = proof(formula, scheme)
    assert proof(formula, scheme, **inside).order == symbolic.order
    there = proof(formula, scheme, **outside)
    assert there.area_preserving or (there.order or 99) > (symbolic.order or 0)


def test_the_reason_says_where() -> None:
    assert str(proof(DUFFING, "lie2").reason).endswith("that of h^3 does not, where delta ≠ 0")
    assert str(proof(DUFFING, "lie2", delta="1").reason).endswith("that of h^3 does not")


def test_values_that_are_not_found_are_said_to_be_few() -> None:
    """Here they are eps = −1 with omega = 0; the condition does not repeat what is proved."""
    driven = proof("p**2/2 - (1 + eps*cos(omega*t))*cos(q)", "lie2")
    said = (
        "where (eps, omega) is outside of a set of measure 0, not found, on which the coefficient"
        " of h^3 is 0 at every point and time"
    )
    assert str(driven.reason).endswith(f"that of h^3 does not, {said}")
    assert proof("p**2/2 - (1 + eps*cos(omega*t))*cos(q)", "lie2", eps="-1", omega="0").order != 3


@pytest.mark.parametrize(
    ("formula", "found"),
    [
        (DUFFING, [("delta", 0, 4)]),
        ("p**2/2 - (a - 1/3)*cos(q)/a", [("a", Fraction(1, 3), None)]),
        (MIXED, [("a", 0, None), ("b", 0, None)]),
        ("(p**4 + q**4)*(a**2 - 2)", []),
        (PENDULUM, [("g", 0, None), ("m", 0, None)]),  # at l = 0 there is no H
        ("p**2/2 - cos(q)", []),
        ("p**2/2 + sin(a)*q**3", []),
        ("p**2/2 + (sqrt(a) - 1)*q**3", []),
        ("p**2/2 + (a**(2/3) - 1)*q**3", []),
    ],
)
def test_what_holds_at_a_value_that_is_left_out(formula: str, found: list[Any]) -> None:
    scheme = get("lie2")
    special = special_values(proof(formula, "lie2"), scheme)
    assert [(s.parameter, s.value) for s in special] == [(name, x) for name, x, _ in found]
    for each, (_, _, order) in zip(special, found, strict=True):
        assert order is None or each.proof.order == order
        assert order is not None or (each.proof.order or 99) > 3


def test_a_proof_speaks_of_points_where_all_is_defined() -> None:
    """As it is written: √(q − 10⁶) twice, and √a with √−a, which has no point."""
    far = proof("p**2/2 + sqrt(q - 1000000)**2*q", "lie2")
    assert (far.verdict, far.order) == ("PROVED", 4)
    assert far.witness["q"] > 10**6
    assert proof("p**2/2 + sqrt(a)*sqrt(-a)*q**3", "lie2").verdict == "UNDECIDED"
    nowhere = proof("p**2/2 + 0*sqrt(q)*sqrt(-q - 1)", "lie2")
    assert nowhere.verdict == "UNDECIDED"
    assert "no point is found" in nowhere.reason
