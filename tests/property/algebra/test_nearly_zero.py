"""Numbers and functions that are nearly 0, and are not: no means of the ring takes one for 0.

Whole coefficients by lattice reduction (LLL) make a sum of algebraic numbers, logarithms or
arctangents as small as wanted, 2⁻³⁰ to 2⁻²⁰⁰, where balls of few bits hold 0, and only a bound from
below, a relation that holds, or a witness with more bits can decide.
"""

from collections.abc import Sequence
from functools import cache

import flint
import mpmath
import pytest
import sympy

from verify.algebra.embedding import embed
from verify.algebra.formula import parse

FAMILIES = {
    "degree 3": ["1", "2**(1/3)", "4**(1/3)"],
    "degree 4": ["1", "sqrt(2)", "sqrt(3)", "sqrt(6)"],
    "degree 4, nested": ["1", "sqrt(2)", "sqrt(1+sqrt(2))", "sqrt(2)*sqrt(1+sqrt(2))"],
    "degree 5": ["1", "2**(1/5)", "4**(1/5)", "8**(1/5)", "16**(1/5)"],
    "degree 6": ["1", "3**(1/6)", "3**(1/3)", "sqrt(3)", "9**(1/3)", "3**(5/6)"],
    "seventh of a turn": ["1", "cos(2*pi/7)", "cos(4*pi/7)"],
    "ninth of a turn": ["1", "cos(pi/9)", "cos(2*pi/9)"],
    "logarithms": ["log(2)", "log(3)", "log(5)"],
    "arctangents": ["pi", "atan(1/2)", "atan(1/5)"],
    "powers of pi": ["1", "pi", "pi**2"],
    "powers of e": ["1", "exp(1)", "exp(2)", "exp(3)"],
}
BITS = 30, 45, 60, 80, 103, 114, 136, 200
# What is made of the number x: zero where x is, and nowhere else.
AROUND = {
    "alone": "{x}",
    "times a function": "({x})*sin(q)",
    "beside an identity": "sin(q)**2 + cos(q)**2 - 1 + q*({x})",
    "in an exponent": "exp(q)*exp(({x})*q) - exp(q)",
    "under a root": "sqrt(1 + q**2 + ({x})**2) - sqrt(1 + q**2)",
    "in a logarithm": "log(2 + q**2 + ({x})) - log(2 + q**2)",
    "in a phase": "sin(q + ({x})) - sin(q)",
    "in an arctangent": "atan(q + ({x})) - atan(q)",
}
mp = mpmath.mp.clone()
mp.dps = 200


@cache
def sizes(family: str) -> list[mpmath.mpf]:
    return [mp.mpf(str(sympy.N(sympy.sympify(x, rational=True), 200))) for x in FAMILIES[family]]


@cache
def coefficients(family: str, bits: int) -> tuple[int, ...]:
    """Whole numbers, not all of them 0, with which the sum is about 2^−bits."""
    values = sizes(family)
    count = len(values)
    scale = mp.mpf(2) ** (bits * count // (count - 1))
    rows = [
        [*(int(i == j) for j in range(count)), int(mp.nint(x * scale))]
        for i, x in enumerate(values)
    ]
    shortest = flint.fmpz_mat(rows).lll().tolist()[0]
    return tuple(int(x) for x in shortest[:count])


def combination(family: str, chosen: Sequence[int]) -> str:
    return " + ".join(f"({c})*{x}" for c, x in zip(chosen, FAMILIES[family], strict=True))


def decide(text: str) -> bool | None:
    expression = parse(text)
    ring, (x,) = embed([expression], sorted(map(str, expression.free_symbols)))
    return ring.decide(x).zero


@pytest.mark.sample(40)
@pytest.mark.parametrize("bits", BITS)
@pytest.mark.parametrize("family", FAMILIES)
def test_a_number_that_is_nearly_0_is_not(family: str, bits: int) -> None:
    chosen = coefficients(family, bits)
    size = abs(mp.fsum(c * x for c, x in zip(chosen, sizes(family), strict=True)))
    assert 0 < size < mp.mpf(2) ** (3 - bits)
    number = combination(family, chosen)
    # A twin that is 0: what is said False of is not everything.
    assert decide(f"{number} - ({number})") is True
    for made in ("alone", "times a function", "beside an identity"):
        assert decide(AROUND[made].format(x=number)) is False, made


@pytest.mark.sample(24)
@pytest.mark.parametrize("bits", [45, 114, 200])
@pytest.mark.parametrize("family", ["degree 3", "degree 4", "seventh of a turn", "logarithms"])
@pytest.mark.parametrize("made", AROUND)
def test_a_function_that_nearly_vanishes_does_not(made: str, family: str, bits: int) -> None:
    assert (
        decide(AROUND[made].format(x=combination(family, coefficients(family, bits)))) is not True
    )
