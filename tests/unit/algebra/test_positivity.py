"""Signs that elements have everywhere, where they are defined, and whether that is convex."""

from typing import Any

import pytest

from verify.algebra.embedding import embed
from verify.algebra.formula import parse
from verify.algebra.positivity import (
    is_convex,
    point_of,
    sign_everywhere,
    size_of_base,
)
from verify.algebra.ring import Ring


def element(text: str) -> tuple[Ring, Any]:
    ring, (x,) = embed([parse(text)], ("p", "q", "delta"))
    return ring, x


SIGNS = {  # the sign, and the sign if 0 is left out
    "2+sin(q)": (1, 1),
    "1+sin(q)": (1, None),
    "3-sin(q)**2-cos(p)*sin(q)": (1, 1),
    "1-sin(q)-cos(p)": (None, None),
    "q**2+p**2": (1, None),
    "(1+8*q**2)*(q**2+q+2)": (1, 1),
    "q*p+q**2+p**2": (1, None),
    "q*p*3+q**2+p**2": (None, None),
    "-1-q**4": (-1, -1),
    "q": (None, None),
    "q**3+1": (None, None),
    "q**2-2*q+2": (1, 1),
    "q**2-2*q+1/2": (None, None),
    "exp(q)-1": (None, None),
    "exp(q)+q**2": (1, 1),
    "exp(2*q)+3*exp(q)+1": (1, 1),
    "exp(2*q)-3*exp(q)+1": (None, None),
    "exp(q)+log(2)": (1, 1),
    "exp(q)+log(1/2)": (None, None),
    "log(1+exp(q))": (1, 1),
    "atan(2+q**4)": (1, 1),
    "1/(1+q**2)": (1, 1),
    "1/q": (None, None),
    "cosh(q)-sqrt(2)": (None, None),
    "p**2*cosh(q)+pi": (1, 1),
    # Of what is positive a function may not be, and it may be of what is not.
    "log(1/2+q**2)": (None, None),
    "log(1/2+exp(q))": (None, None),
    "1+p**2*log(1/2+q**2)": (None, None),
    "log(log(2+q**2))": (None, None),
    "log(2+q**2)": (1, 1),
    "exp(q)*log(3+q**2)": (1, 1),
    "sqrt(1/2+q**2)-1": (None, None),
    "1/(q**2-1)": (None, None),
    "sinh(q)": (None, None),
    "sinh(1+q**2)": (1, 1),
    "atan(q)": (None, None),
    "sin(1+q**2)": (None, None),
    "cos(1+q**2)": (None, None),
    "tan(1+q**2)": (None, None),
    "tanh(q)": (None, None),
    "tanh(1+q**2)": (1, 1),
}


@pytest.mark.parametrize("text", SIGNS)
def test_a_sign_is_shown_where_there_is_one_and_only_there(text: str) -> None:
    ring, x = element(text)
    for sign in (1, -1):
        loose, strict = SIGNS[text]
        assert sign_everywhere(ring, sign * x) == (loose and sign * loose)
        assert sign_everywhere(ring, sign * x, strict=True) == (strict and sign * strict)


CONVEX = {
    "atan(q)": True,
    "atan(1/q)": False,
    "atan(1/(1+q**2))": True,
    "atan(1/(p**2+q**2))": False,
    "atan(1/q)*sqrt(q)": True,
    "atan(1/q)*log(-3*q)": True,
    "atan(1/q)*log(q+1)": False,
    "atan(1/q)*log(q*p)": False,
    "atan(1/q)*log(q*(1+p**2))": True,
    "atan(tan(q))": False,
    "atan(log(p+q))": True,
    "atan(sqrt(q**2-1))": False,
    "atan(sqrt(q**2-1))*log(q-1)*log(q+1)": True,
}


@pytest.mark.parametrize("text", CONVEX)
def test_where_arctangents_are_defined_is_convex_or_not_shown_to_be(text: str) -> None:
    ring, x = element(text)
    arguments = [g.inner for g in ring.generators_in(x) if g.kind == "atan"]
    assert is_convex(ring, arguments, inside=x) is CONVEX[text]


@pytest.mark.parametrize(
    ("text", "found"),
    [("log(q)-log(2*q)+log(2)", True), ("log(-q)-log(-2*q)+log(2)", True),
     ("log(q)-log(3*q)", False), ("log(-q)*sqrt(q)", False), ("1/(sqrt(6)-sqrt(2)-1)", False)],
)  # fmt: skip
def test_a_point_is_one_where_the_element_is_defined_and_may_be_zero(
    text: str, found: bool
) -> None:
    ring, x = element(text)
    assert (point_of(ring, x) is not None) is found


def test_the_base_of_a_power_has_its_sign() -> None:
    ring, x = element("-4-4*q**2")
    assert size_of_base(ring, x**2, 2) == (16, -x / 4)
    assert size_of_base(ring, x**3, 3) is None, "a negative number has no root"
    assert size_of_base(ring, -(x**3), 3) == (64, -x / 4)
    assert size_of_base(ring, ring.variable("q") ** 2, 2) is None
