"""Text to exact expression: what is read has the value that was written."""

import sys

import pytest
import sympy
from hypothesis import given

from tests.examples import drawn
from tests.helpers.sampled.formulas import NAMES, evaluate, formulas, is_real, plain, points
from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import parse, symbol
from verify.errors import InputError

P, Q = symbol("p"), symbol("q")
HALF, THIRD = sympy.Rational(1, 2), sympy.Rational(1, 3)

READ = {
    "decimal": ("0.1", sympy.Rational(1, 10)),
    "decimal beyond a float": (
        "0.1234567890123456789",
        sympy.Rational(1234567890123456789, 10**19),
    ),
    "scientific": ("1e-3", sympy.Rational(1, 1000)),
    "capital exponent": ("2E2", sympy.Integer(200)),
    "no leading zero": (".5", HALF),
    "no trailing digits": ("5.", sympy.Integer(5)),
    "quotient": ("1/3", THIRD),
    "caret": ("q^2", Q**2),
    "caret to a negative power": ("q^-2", Q**-2),
    "power before sign": ("-q**2", -(Q**2)),
    "power before sign, constant": ("-2**2", sympy.Integer(-4)),
    "power from the right": ("2**3**2", sympy.Integer(512)),
    "caret from the right": ("2^3^2", sympy.Integer(512)),
    "minus from the left": ("p - q - 1", P - Q - 1),
    "quotient from the left": ("p/q/2", P / Q / 2),
    "quotient before product": ("1/2*q", Q / 2),
    "signs in a row": ("p*-+-q", P * Q),
    "exponent of an exact sum": ("q**(1/2 + 1/3)", Q ** sympy.Rational(5, 6)),
    "root of a square": ("4**(1/2)", sympy.Integer(2)),
    "square of a root": ("sqrt(q)**2", Q),
    "root of a fourth power": ("sqrt(q**4)", Q**2),
    "root of an odd power": ("(q**3)**(1/3)", (Q**3) ** THIRD),
    "root of a product": ("(p*q)**(1/3)", (P * Q) ** THIRD),
    "exponential of a logarithm": ("exp(log(q))", Q),
    "power zero": ("q**0", sympy.Integer(1)),
    "pi": ("cos(pi)", sympy.Integer(-1)),
    "nested": ("sin(cos(exp(q)))", sympy.sin(sympy.cos(sympy.exp(Q)))),
    "space and new lines": (" p **2\n\t+ q ", P**2 + Q),
    "parameter": ("delta*q", symbol("delta") * Q),
    "E is a parameter": ("E*q", symbol("E") * Q),
    "I is a parameter": ("I*q", symbol("I") * Q),
    "S and N are parameters": ("S*N", symbol("S") * symbol("N")),
    "Python's lambda_ is a parameter": ("lambda_", symbol("lambda_")),
}


@pytest.mark.parametrize(("text", "expected"), READ.values(), ids=READ.keys())
def test_a_formula_is_read_exactly(text: str, expected: sympy.Expr) -> None:
    assert parse(text) == expected


def test_a_symbol_is_real_so_that_a_hidden_modulus_is_seen() -> None:
    assert parse("q").is_real


def test_names_may_allow_time_and_the_step() -> None:
    assert parse("t*h", ("t", "h")) == symbol("t") * symbol("h")


def test_a_long_flat_sum_is_not_deeply_nested() -> None:
    text = " + ".join(f"q**{n % 60 + 1}/{n + 1}" for n in range(100))
    assert parse(text) == plain(text)


@given(text=formulas(), point=points("p", "q", "a"))
@drawn(80)
def test_a_formula_has_the_value_that_sympy_gives_it(text: str, point: dict) -> None:
    try:
        ours = parse(text)
    except InputError:
        return
    expected = evaluate(plain(text), point)
    assert not is_real(expected) or abs(evaluate(ours, point) - expected) <= 1e-30 * abs(expected)


@given(text=formulas())
@drawn(80)
def test_what_is_printed_reads_back_as_the_same_expression(text: str) -> None:
    try:
        expression = parse(text)
    except InputError:
        return
    again = parse(to_text(expression))
    if again == expression:
        return
    # sympy spreads a minus sign or a factor over a sum as it builds: then equal, not the same.
    ring, (gap,) = embed([again - expression], NAMES)
    assert ring.decide(gap).zero is True


@pytest.mark.parametrize(
    ("text", "is_"),
    [
        ("3*sqrt(-2*p)*sqrt(-2*p) + p", "-5*p"),
        ("1 - 2*sqrt(-p)*sqrt(-p)", "1 + 2*p"),
        ("q*sqrt(-3*p)*sqrt(-3*p)*2 - q*p", "-7*p*q"),
        ("2*(-p)**(1/3)*(-p)**(2/3) - p", "-3*p"),
    ],
)
def test_products_of_roots_that_sympy_leaves_nested_are_what_they_are(text: str, is_: str) -> None:
    """Of √(−2p)·√(−2p) sympy makes a product in a product, or one with several numbers."""
    assert parse(text) == parse(is_)
    ring, (x, y) = embed([parse(text), parse(is_)], ["p", "q"])
    assert ring.decide(x - y).zero is True


def test_a_product_with_several_numbers_is_their_product() -> None:
    p = symbol("p")
    nested = sympy.Add(p, sympy.Mul(6, -1, p, evaluate=False), evaluate=False)
    ring, (x,) = embed([nested], ["p"])
    assert ring.text(x) == "-5*p"


def test_a_formula_is_written_however_long_its_numbers_are() -> None:
    """And Python's own limit is as before afterwards."""
    most = sys.get_int_max_str_digits()
    assert len(to_text(sympy.Integer(10) ** 7000 * symbol("q"))) == 7001 + len("*q")
    assert sys.get_int_max_str_digits() == most > 0
