"""Minimal polynomials of what roots make, against sympy's."""

import time

import pytest
import sympy

from verify.algebra.embedding import embed
from verify.proof.certificates.coefficient_entries import MinimalPolynomials

X = sympy.Symbol("x")
R, S, T = sympy.sqrt(2), sympy.sqrt(3), sympy.cbrt(2)
ONE = [
    R,
    T,
    sympy.root(sympy.Rational(7, 3), 5),
    1 / (R + S),
    1 / (2 - T),
    sympy.sqrt(3 + 2 * R),  # 1 + √2, of degree 2
    sympy.sqrt(1 + sympy.sqrt(2 + S)),
    sympy.root(1 + R * T, 3),
    1 / (1 + sympy.sqrt(5 + R) + S),
    sympy.sqrt(2 + R) * sympy.sqrt(2 - R),  # √2
]


def generators(number: sympy.Expr) -> tuple[MinimalPolynomials, dict[int, sympy.Expr]]:
    ring, _ = embed([number], ())
    return MinimalPolynomials(ring, 32), {
        g.index: ring.expression(ring.context.gens()[g.index]) for g in ring.generators
    }


@pytest.mark.parametrize("number", ONE, ids=str)
def test_each_generator_has_the_polynomial_that_sympy_finds(number: sympy.Expr) -> None:
    minimal, own = generators(number)
    assert own
    for index, expression in own.items():
        found = [int(c) for c in minimal.polynomial_of(index).coeffs()]
        wanted = sympy.minimal_polynomial(expression, X, polys=True).clear_denoms(convert=True)[1]
        assert found == [int(c) for c in reversed(wanted.all_coeffs())]


def test_what_is_not_made_by_roots_or_of_too_high_a_degree_has_none() -> None:
    minimal, own = generators(sympy.sqrt(sympy.pi))
    for index in own:
        with pytest.raises(ValueError, match="not made by roots"):
            minimal.polynomial_of(index)
    ring, _ = embed([sympy.root(3 + R, 5)], ())
    first, second = (g.index for g in ring.generators if g.kind == "root")
    assert MinimalPolynomials(ring, 10).polynomial_of(second).degree() == 10
    assert MinimalPolynomials(ring, 9).polynomial_of(first).degree() == 2
    with pytest.raises(ValueError, match="is of degree 10, or seems so; allowed: up to 9"):
        MinimalPolynomials(ring, 9).polynomial_of(second)


def test_long_decimals_under_roots_take_no_time() -> None:
    """sympy's own `minimal_polynomial` takes all memory of the machine for these."""
    texts = ("2.12312321313", "3.1231231", "5.21312312", "7.3123123123")
    roots = [sympy.sqrt(sympy.Rational(text)) for text in texts]
    begun = time.perf_counter()
    minimal, own = generators(1 / sympy.Add(*roots))
    assert max(minimal.polynomial_of(index).degree() for index in own) == 16
    assert time.perf_counter() - begun < 20
