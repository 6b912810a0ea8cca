"""The leading coefficient for every H against det J of random ones, in numbers.

ΔJ comes from sympy's derivatives of the step, evaluated with 120 digits at a step size so small
that ΔJ/h^(η+1) and the coefficient agree to 30 digits.
"""

from fractions import Fraction

import mpmath
import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.lie_derivatives import along_flow
from tests.helpers.sampled.formulas import (
    P,
    Q,
    evaluate,
    lie_step,
    plain,
    plain_delta_j,
    points,
    polynomials,
    trigonometric,
)
from verify.algebra.jets import Jets
from verify.exploration.properties.plane.order_by_jets import delta_j as delta_j_of
from verify.hamiltonians.canonical_field import JetField
from verify.proof.telescoping import potential_of_lie
from verify.schemes.conditions.every_hamiltonian import TaylorSeries

SMALL = Fraction(1, 10**45)


def at(jets: Jets, x: object, hamiltonian: sympy.Expr, point: dict[str, Fraction]) -> mpmath.mpf:
    values = [evaluate(hamiltonian.diff(P, i, Q, j), point, 120) for i, j in jets.indices]
    total = mpmath.mpf(0)
    for monomial, c in x.to_dict().items():  # type: ignore[attr-defined]
        term = mpmath.mpf(int(c.numer())) / int(c.denom())
        for n, value in zip(monomial[2:], values, strict=True):
            term *= value ** int(n)
        total += term
    return total


@pytest.mark.left_to_ci
@drawn(40)
@given(
    text=polynomials(degree=4, most_terms=3) | trigonometric(),
    eta=st.integers(1, 4),
    point=points("p", "q"),
)
def test_the_leading_coefficient_is_the_limit_of_delta_j(
    text: str, eta: int, point: dict[str, Fraction]
) -> None:
    hamiltonian = plain(text)
    jets = Jets(eta + 2)
    leading = list(delta_j_of(jets, *TaylorSeries(eta).taylor(jets, eta + 1)))[-1]
    delta_j = plain_delta_j(*lie_step(hamiltonian, eta))
    with mpmath.workdps(120 + 45 * (eta + 1)):
        small = {**point, "h": SMALL}
        limit = evaluate(delta_j, small, 120 + 45 * (eta + 1)) / mpmath.mpf(10) ** (-45 * (eta + 1))
        expected = at(jets, leading, hamiltonian, point)
        assert abs(limit - expected) < mpmath.mpf(10) ** -30
        assume(abs(expected) > mpmath.mpf(10) ** -6)
        assert abs(limit + expected) > mpmath.mpf(10) ** -30, "the other sign"
        if eta % 2 == 0:
            potential = potential_of_lie(JetField.from_jets(jets), eta).divergence
            assert abs(limit - at(jets, along_flow(jets, potential), hamiltonian, point)) < 1e-30
