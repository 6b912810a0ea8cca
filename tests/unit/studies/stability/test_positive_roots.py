"""Positive roots: against products of known ones, in order, and by the signs beside them."""

from fractions import Fraction
from itertools import pairwise

import flint
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.studies.stability.positive_roots import positive_roots

Z = sympy.Symbol("z")


def polynomial(text: str) -> flint.fmpz_poly:
    return flint.fmpz_poly([int(c) for c in reversed(sympy.Poly(text, Z).all_coeffs())])


@drawn(60)
@given(st.lists(st.fractions(-9, 9, max_denominator=30), min_size=1, max_size=6))
def test_rational_roots_are_found_each_once(roots: list[Fraction]) -> None:
    product = flint.fmpz_poly([1])
    for root in roots:
        product *= flint.fmpz_poly([-root.numerator, root.denominator])
    found = positive_roots([product, product * flint.fmpz_poly([2, 0, 1])])
    expected = sorted({root for root in roots if root > 0})
    assert [Fraction(str(root.closed_form())) for root, _ in found] == expected
    assert all(low <= x <= high for x, (_, (low, high)) in zip(expected, found, strict=True))


@pytest.mark.parametrize(
    ("text", "forms"),
    [
        ("z**2 - 2", ["sqrt(2)"]),
        ("z**4 - 10*z**2 + 1", [None, None]),
        ("z**5 - 3", ["3**(1/5)"]),
        ("z**2 + z - 1", ["-1/2 + sqrt(5)/2"]),
        ("(z**2 + 1)*z*(z - 1)*(z + 4)", ["1"]),
        ("z**3", []),
        ("7", []),
    ],
)
def test_a_closed_form_is_given_where_roots_write_it(text: str, forms: list[str | None]) -> None:
    found = [root.closed_form() for root, _ in positive_roots([polynomial(text)])]
    assert [x if x is None else str(x) for x in found] == forms


def test_digits_are_those_of_sympy() -> None:
    polynomials = [polynomial("z**5 - 7*z**3 + z + 1"), polynomial("z**6 - z**4*35 + 504*z**2 - 9")]
    expected = [x for f in ("z**5 - 7*z**3 + z + 1", "z**6 - z**4*35 + 504*z**2 - 9")
                for x in sympy.Poly(f, Z).real_roots() if x > 0]  # fmt: skip
    found = [root for root, _ in positive_roots(polynomials)]
    assert [root.decimal(40) for root in found] == [str(x.evalf(40)) for x in sorted(expected)]
    assert found[-1].describe("y") == "positive root 2 of y**5 - 7*y**3 + y + 1"


def test_roots_that_hardly_differ_are_told_apart() -> None:
    close = [polynomial("z**2 - 2"), polynomial(f"{10**90}*z**3 - {10**90}*2*z - 1")]
    found = positive_roots(close)
    assert [str(root.closed_form()) for root, _ in found] == ["sqrt(2)", "None"]
    assert all(a[1] < b[0] for (_, a), (_, b) in pairwise(found))


def test_what_is_no_root_is_none() -> None:
    assert positive_roots([polynomial("z**2 + 1"), polynomial("z + 1")]) == []
    assert positive_roots([]) == []
