"""Texts that are too long to be factored: their values are those of what they write."""

import re
from typing import Any

import mpmath
import pytest
import sympy

from verify.algebra.embedding import embed
from verify.algebra.formula import parse, symbol
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

DIGITS = 20


def value_of(text: str, at: dict[sympy.Symbol, Any]) -> Any:
    """Of the formula, read by Python with each integer in it a number of mpmath's.

    sympy would take ten seconds to read a thousand terms.
    """
    places = {str(x): mpmath.mpf(v.p) / v.q for x, v in at.items()}
    known = {"mpf": mpmath.mpf, "sin": mpmath.sin, "cos": mpmath.cos, **places}
    return eval(re.sub(r"\b\d+\b", r"mpf(\g<0>)", text), known)  # noqa: S307 - the ring's text


def agrees(text: str, base: sympy.Expr, power: int, at: dict[sympy.Symbol, Any]) -> bool:
    with mpmath.workdps(2 * DIGITS):
        true = sympy.N(base.subs(at), 2 * DIGITS) ** power
        return bool(abs(value_of(text, at) - true) < mpmath.mpf(10) ** -DIGITS)


def test_what_is_too_long_to_be_factored_is_written_as_it_stands() -> None:
    field, _ = canonical_field(Hamiltonian.parse("p**3/3 + p**2*q**2 - cos(q)"))
    ring, (p, q) = field.ring, field.start
    inner = p**2 - field.slopes[0]
    long = ring.reduce((inner + p + 2 * q + 1) ** 12)
    assert len(long) > 300
    text = ring.text(long)
    assert "None" not in text
    at = {symbol("p"): sympy.Rational(1, 3), symbol("q"): sympy.Rational(-2, 7)}
    base = ring.expression(inner) + symbol("p") + 2 * symbol("q") + 1
    assert agrees(text, base, 12, at)
    assert not agrees(text + " + 1/10**15", base, 12, at)


def test_a_parameter_named_like_anything_keeps_its_name_in_a_long_text() -> None:
    names = ("g5_", "a_1", "g_1")
    formula = "+".join(f"{name}*p**{k}*q**{3 - k}" for k, name in enumerate(names)) + "+sin(q)"
    field = canonical_field(Hamiltonian.parse(formula))[0]
    h_p, h_q = field.gradient(field.energy)
    long = field.ring.reduce((h_p + h_q + 1) ** 6)
    assert len(long) > 300
    text = field.ring.text(long)
    at = {symbol(n): sympy.Rational(k + 2, 7) for k, n in enumerate(("p", "q", *names))}
    base = field.ring.expression(h_p) + field.ring.expression(h_q) + 1
    assert agrees(text, base, 6, at)
    assert not agrees(text.replace("g5_", "g_1"), base, 6, at)


def test_where_h_is_0_terms_with_it_are_gone_and_so_it_is_in_arguments() -> None:
    p, h = symbol("p"), symbol("h")
    for x in (
        sympy.cos(p + h) * (p + h) ** 2 + h * sympy.sin(p),
        sympy.sin(h * p) * p + sympy.exp(h) / (1 + p * h),
        p / h,  # no number there
    ):
        ring, (element,) = embed([x], ("p", "h"))
        there = ring.expression_at(element, {h: sympy.S.Zero})
        assert there == ring.expression(element).subs(h, 0)
        assert not there.has(h)
    assert there.has(sympy.zoo)


@pytest.mark.parametrize("formula", ["tanh(q/h)", "1/sinh(1/(h*q))", "1/cosh(1/(h*q))"])
def test_where_it_is_no_expression_it_is_no_number(formula: str) -> None:
    """sympy compares what becomes nan within with a number, or not, as its sets are ordered."""
    names = {name: symbol(name) for name in "qh"}
    ring, (element,) = embed([sympy.sympify(formula, names)], ("q", "h"))
    for _ in range(3):
        there = ring.expression_at(element, {symbol("h"): sympy.S.Zero})
        assert there.has(sympy.nan, sympy.zoo, sympy.oo)
        element = ring.diff(element, "h")


@pytest.mark.parametrize(
    "formula",
    [
        "log((q + 1)**20)",
        "log(q*(q + 1))",
        "atan(p*(q**2 + 1))",
        "log(q**2/2 + 1/2)",
        "log(cos(q) + 2)",
        "exp(q**2 + q)",
        "sqrt(q**2 + q + 1)",
        "pi*q",
    ],
)
def test_functions_are_written_of_what_they_were_of(formula: str) -> None:
    ring, (x,) = embed([parse(formula)], ["p", "q"])
    assert ring.text(x) == formula
