"""Sums of monomials are read past sympy's own sums and products, to the same expressions."""

from fractions import Fraction

import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.algebra.expressions.monomials import monomials_of, names_in
from verify.algebra.formula import parse, symbol

NAMES = ("p", "q", "a", "delta", "x1")
NUMBERS = st.builds(Fraction, st.integers(-9, 9), st.integers(1, 4))
TERMS = st.tuples(NUMBERS, st.dictionaries(st.sampled_from(NAMES), st.integers(0, 4), max_size=3))


def text_of(terms: list[tuple[Fraction, dict[str, int]]]) -> str:
    def term(c: Fraction, powers: dict[str, int]) -> str:
        factors = [f"{name}**{n}" if n > 1 else name for name, n in powers.items() if n]
        return "*".join([f"({c.numerator})/{c.denominator}", *factors])

    return " + ".join(term(*each) for each in terms)


def by_sympy(terms: list[tuple[Fraction, dict[str, int]]]) -> sympy.Expr:
    return sympy.Add(
        *(
            sympy.Mul(sympy.Rational(c), *(symbol(name) ** n for name, n in powers.items()))
            for c, powers in terms
        )
    )


@drawn(100)
@given(terms=st.lists(TERMS, min_size=1, max_size=12))
def test_a_sum_of_monomials_is_what_sympy_makes_of_it(
    terms: list[tuple[Fraction, dict[str, int]]],
) -> None:
    found, true = parse(text_of(terms), source="formula"), by_sympy(terms)
    assert (found, found.args, hash(found)) == (true, true.args, hash(true))
    assert (str(found), found.is_commutative) == (str(true), True)
    assert found.expand() == true.expand()
    assert sympy.simplify(found + 1 - true) == 1


@drawn(50)
@given(
    terms=st.lists(TERMS, min_size=1, max_size=6), more=st.sampled_from(["sin(q)", "1/p", "a**2/q"])
)
def test_monomials_are_told_from_what_is_none(
    terms: list[tuple[Fraction, dict[str, int]]], more: str
) -> None:
    plain = by_sympy(terms)
    read = monomials_of(plain)
    assert read is not None
    again = (
        sympy.Mul(number, *(symbol(name) ** n for name, n in powers)) for number, powers in read
    )
    assert sympy.Add(*again) == plain
    assert names_in(plain) == {each.name for each in plain.free_symbols}
    other = plain + parse(more, source="formula")
    assert monomials_of(other) is None
    assert names_in(other) == {each.name for each in other.free_symbols}
