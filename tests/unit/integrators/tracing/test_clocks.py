"""The order of a step whose coefficients are rounded: residues of their size are taken for 0."""

import math
from fractions import Fraction

import flint
import pytest

from verify.algebra.power_series import Series
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.clocks import _rounded_order

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4")
MOST = 4


def series(order: int, off: Fraction, at: int) -> tuple[Series, Series]:
    """The flow's series up to h^order, with the coefficient of h^at too large by that part."""
    field, _ = canonical_field(DUFFING)
    made = []
    for place in (0, 1):
        terms = [field.power(n)[place] / math.factorial(n) for n in range(order + 1)]
        if at <= order:
            terms[at] = terms[at] * flint.fmpq((1 + off).numerator, off.denominator)
        made.append(Series.from_coefficients(field.ring, terms, MOST))
    return made[0], made[1]


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_it_is_the_power_up_to_which_all_coefficients_are_the_flows(order: int) -> None:
    field, _ = canonical_field(DUFFING)
    assert _rounded_order(field, series(order, Fraction(0), 0)) == order
    assert _rounded_order(field, series(MOST, Fraction(0), 0)) is None


@pytest.mark.parametrize("at", [1, 2, 3])
def test_a_residue_of_roundings_size_is_none_and_a_larger_one_is(at: int) -> None:
    field, _ = canonical_field(DUFFING)
    assert _rounded_order(field, series(3, Fraction(1, 2**50), at)) == 3
    assert _rounded_order(field, series(3, Fraction(1, 2**30), at)) == at - 1
