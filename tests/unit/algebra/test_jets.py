"""The jets of every H, and series over them: what sympy's derivatives of one H make of them."""

import pytest
import sympy

from tests.helpers.jets_of_one_h import along, at, at_place, value_at_place
from tests.helpers.lie_derivatives import lie_derivatives
from tests.helpers.sampled.formulas import P, Q, plain
from verify.algebra.formula import parse, symbol
from verify.algebra.jets import Jets, JetsInDegrees
from verify.algebra.power_series import Derivatives, Series, expand_at

CUBIC = plain("p**3*q/3 + p*q**2 - 2*q**4 + p**2*q**2/5")
SEPARABLE = plain("p**3/3 + p**2/2 - 2*q**4 + q")
PAIR = "p1**2*q2 + (p2 + q1*p1)**3/3 + q1**2*q2**2*p2 + p1*p2*q1"


@pytest.mark.left_to_ci
def test_derivatives_along_the_flow_are_those_of_any_hamiltonian() -> None:
    jets = Jets(5)
    for name, y in (("p", P), ("q", Q)):
        for x in lie_derivatives(jets, name, 4):
            assert at(jets, x, CUBIC) == sympy.expand(y)
            y = along(y, CUBIC)


def test_a_separable_hamiltonian_has_no_mixed_derivatives() -> None:
    jets = Jets(4, separable=True)
    assert jets.h(1, 1) == 0
    for x, y in zip(lie_derivatives(jets, "p", 3), lie_derivatives(Jets(4), "p", 3), strict=True):
        assert at(jets, x, SEPARABLE) == at(Jets(4), y, SEPARABLE)


def test_a_derivative_beyond_those_there_are_is_refused() -> None:
    with pytest.raises(OverflowError):
        lie_derivatives(Jets(2), "p", 3)


def test_a_shifted_derivative_is_taylors_formula() -> None:
    jets = Jets(6)
    dp = [jets.zero, jets.one, 2 * jets.one, jets.zero]
    dq = [jets.zero, -3 * jets.one, jets.zero, jets.one]
    h = sympy.Symbol("h")
    moved = CUBIC.diff(P).subs({P: P + h + 2 * h**2, Q: Q - 3 * h + h**3}, simultaneous=True)
    expected = sympy.Poly(sympy.expand(moved), h).all_coeffs()[::-1]
    moves = [(name, Series.from_coefficients(jets, x, 3)) for name, x in (("p", dp), ("q", dq))]
    for n, x in enumerate(expand_at(Derivatives(jets, jets.h(1, 0)), moves, 3).coefficients):
        assert at(jets, x, CUBIC) == sympy.expand(expected[n])


def test_mixed_derivatives_in_two_degrees_are_those_of_one_hamiltonian() -> None:
    names, energy = ["p1", "p2", "q1", "q2"], parse(PAIR)
    jets = JetsInDegrees(names, 4)
    x = (
        jets.first("p1") * jets.derivative((1, 0, 1, 0))
        + jets.variable("q2") * jets.first("q2") ** 2
    )
    p1, q1, q2 = map(symbol, ("p1", "q1", "q2"))
    same = energy.diff(p1) * energy.diff(p1, q1) + q2 * energy.diff(q2) ** 2
    for name in names:
        ours = at_place(jets, jets.diff(jets.diff(x, name), "p1"), energy)
        assert ours == value_at_place(same.diff(symbol(name), p1), names)
