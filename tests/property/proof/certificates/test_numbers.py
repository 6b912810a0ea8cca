"""The numbers of a certificate, against sympy's exact counting of roots and its remainders."""

from fractions import Fraction

import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.proof.certificates.named_numbers import AlgebraicNumber, QuotientRing, read_numbers
from verify.proof.certificates.readers import Poly

X, Y = sympy.symbols("x y")
whole = st.integers(-9, 9)
polynomials = st.lists(whole, min_size=2, max_size=7).filter(lambda c: c[-1] != 0)
ends = st.builds(Fraction, st.integers(-40, 40), st.integers(1, 9))


def accepted(polynomial: list[int], low: Fraction, high: Fraction) -> bool:
    try:
        read_numbers([["w", [str(c) for c in polynomial], str(low), str(high)]])
    except ValueError:
        return False
    return True


def exact(polynomial: list[int]) -> sympy.Poly:
    return sympy.Poly([*map(sympy.Integer, reversed(polynomial))], X)


def rational(x: Fraction) -> sympy.Rational:
    return sympy.Rational(x.numerator, x.denominator)


@drawn(200)
@given(polynomials, ends, ends)
def test_what_is_accepted_has_one_root_inside(
    polynomial: list[int], low: Fraction, high: Fraction
) -> None:
    if accepted(polynomial, low, high):
        found = exact(polynomial)
        assert found.count_roots(rational(low), rational(high)) == 1
        assert found.eval(rational(low)) * found.eval(rational(high)) < 0


@drawn(60)
@given(polynomials)
def test_every_simple_root_is_accepted_in_an_interval_that_is_short_enough(
    polynomial: list[int],
) -> None:
    found = exact(polynomial)
    assume(found.discriminant() != 0 and found.degree() > 0)
    for (low, high), _ in found.intervals(eps=sympy.Rational(1, 10**6)):
        a, b = Fraction(str(low)), Fraction(str(high))
        if a == b:  # a rational root is alone as far as that
            a, b = a - Fraction(1, 10**6), b + Fraction(1, 10**6)
        assert accepted(polynomial, a, b) or found.count_roots(rational(a), rational(b)) != 1


numbers = st.tuples(*[st.lists(whole, min_size=1, max_size=3)] * 2)
terms = st.lists(st.tuples(st.integers(-5, 5), st.integers(0, 5), st.integers(0, 5)), max_size=5)


@drawn(60)
@given(numbers, terms, terms)
def test_residues_are_the_remainders_by_both_polynomials(
    tails: tuple[list[int], list[int]], one: list[tuple[int, ...]], two: list[tuple[int, ...]]
) -> None:
    named = [
        AlgebraicNumber(name, (*tail, 2), Fraction(0), Fraction(1))
        for name, tail in zip("xy", tails, strict=True)
    ]
    residues = QuotientRing(named)
    found = residues.product(*(residues.reduce(made_of(each)) for each in (one, two)))
    relations = [
        sum((c * z**k for k, c in enumerate((*tail, 2))), sympy.S.Zero)
        for z, tail in zip((X, Y), tails, strict=True)
    ]
    product = expression(made_of(one)) * expression(made_of(two))
    _, rest = sympy.reduced(product, relations, X, Y, domain="QQ", order="lex")
    assert sympy.expand(expression(found) - rest) == 0


def made_of(each: list[tuple[int, ...]]) -> Poly:
    total: Poly = {}
    for c, m, n in each:
        key = ("x",) * m + ("y",) * n
        total[key] = total.get(key, Fraction(0)) + c
    return {key: c for key, c in total.items() if c}


def expression(x: Poly) -> sympy.Expr:
    each = (rational(c) * X ** m.count("x") * Y ** m.count("y") for m, c in x.items())
    return sympy.Add(*each)
