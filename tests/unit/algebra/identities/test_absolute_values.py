"""Roots of squares as formulas are read: of what has one sign, and of what may have either."""

import pytest
import sympy

from verify.algebra.formula import parse
from verify.errors import InputError


@pytest.mark.parametrize(
    ("text", "equal"),
    [
        ("sqrt((q**2-q+1)**2)", "q**2-q+1"),
        ("sqrt((sin(q)-2)**2)", "2-sin(q)"),
        ("sqrt((1+sin(q))**2*(p+1))", "sqrt(p+1)*(1+sin(q))"),
        ("((q**2-q+1)**2)**(1/4)", "sqrt(q**2-q+1)"),
        ("sqrt((p*q+p**2+q**2)**2)", "p**2+p*q+q**2"),
        ("sqrt((-1-q**2)**2)", "1+q**2"),
    ],
)
def test_the_root_of_a_square_of_what_has_one_sign_is_read(text: str, equal: str) -> None:
    assert sympy.expand(parse(text) - parse(equal)) == 0


@pytest.mark.parametrize(
    "text",
    ["sqrt((q-1)**2)", "sqrt((exp(q)-1)**2)", "sqrt((1/2+sin(q))**2)", "sqrt((q**2-3*q+1)**2)",
     "sqrt((p**2+3*p*q+q**2)**2)", "sqrt(((q**2-q+1)*p)**2)", "sqrt((delta+q**2)**2)"],
)  # fmt: skip
def test_of_what_may_have_either_it_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="not smooth"):
        parse(text)
