"""Products of determinants and of matrices, side by side: where they agree and where not."""

from fractions import Fraction

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.separation.truncation_and_rounding import separate

PLANE = Hamiltonian.parse("p**2/2 + a*q**2/2 + q**4/4", {"a": "1/3"})
BESIDE = Hamiltonian.parse("p1**2/2 + a*q1**2/2 + q1**4/4 + p2**2/2", {"a": "1/3"})
SHARED = ("truncation", "input", "trajectory")


@pytest.mark.parametrize("scheme", ["lie2", "lie4", "rk4", "explicit-midpoint"])
@pytest.mark.parametrize("way", ["plain", "closed_form"])
def test_beside_a_free_particle_dp1_dq1_of_w_is_lambda(scheme: str, way: str) -> None:
    """In exact arithmetic; what float64 multiplies is rounded differently, by definition."""
    found = separate(PLANE, scheme, q="1.5", p="0.1", step_size="0.05", steps=300)
    matrix = separate(
        BESIDE, scheme, q=["1.5", "0.3"], p=["0.1", "0.7"], step_size="0.05", steps=300
    )
    assert found.status == matrix.status == "finished"
    parts, entries = getattr(found, way).parts, getattr(matrix, way).parts
    for name in SHARED:
        one, other = getattr(parts, name), getattr(entries, name).entry(0, 2)
        apart = abs(Fraction(one.value) - Fraction(other.value))
        assert apart <= Fraction(one.bound) + Fraction(other.bound), name
        assert Fraction(one.bound) < abs(Fraction(one.value)) / 10**15, "it is known"
    assert parts.product.value != entries.product.entry(0, 2).value
    for place in ((0, 1), (0, 3), (1, 2), (1, 3), (2, 3)):
        assert entries.truncation.entry(*place).value == "0", "the particle has no part in it"
