"""Runge–Kutta methods by their coefficients: order, symplecticity, and a misprinted row."""

import pytest
from sympy import Rational, S, sqrt

from verify.audits.library_claims import claims_of
from verify.audits.methods.integrator import ExactTableau, ReleasedIntegrator
from verify.audits.methods.tableau_proofs import order_of, repair, symplecticity
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.methods.runge_kutta.gauss4 import TABLEAU as GAUSS4
from verify.schemes.methods.runge_kutta.gauss6 import TABLEAU as GAUSS6
from verify.verdict import Verdict


def rational(*rows: str) -> ImplicitTableau:
    """The last row has the weights."""
    numbers = [[Rational(x) for x in row.split()] for row in rows]
    count = len(numbers[-1])
    return ImplicitTableau.from_numbers(
        [[*r, *[S.Zero] * count][:count] for r in numbers[:-1]], numbers[-1]
    )


RK4 = rational("0", "1/2", "0 1/2", "0 0 1", "1/6 1/3 1/3 1/6")
TRAPEZOIDAL = rational("0 0", "1/2 1/2", "1/2 1/2")
MIDPOINT = rational("1/2", "1")
LAWSON = rational(
    "0", "1/2", "3/16 1/16", "0 0 1/2", "0 -3/16 3/8 9/16", "1/7 4/7 6/7 -12/7 8/7",
    "7/90 0 16/45 2/15 16/45 7/90",
)  # fmt: skip
MISPRINTED = ImplicitTableau.from_numbers(
    [*LAWSON.rows[:2], (Rational(1, 8), Rational(1, 8), *LAWSON.rows[2][2:]), *LAWSON.rows[3:]],
    LAWSON.weights,
)


@pytest.mark.parametrize(
    ("tableau", "order", "symplectic"),
    [
        (RK4, 4, False), (TRAPEZOIDAL, 2, False), (MIDPOINT, 2, True), (GAUSS4, 4, True),
        (GAUSS6, 6, True), (LAWSON, 5, False), (MISPRINTED, 2, False),
    ],
)  # fmt: skip
def test_order_and_symplecticity_are_proved(
    tableau: ImplicitTableau, order: int, symplectic: bool
) -> None:
    assert order_of(tableau, order).order == order
    assert symplecticity(tableau).holds is symplectic


def verdicts(tableau: ExactTableau, order: int, area: bool | None) -> list[Verdict]:
    integrator = ReleasedIntegrator("mine", "by hand", "nowhere", tableau, order, area)
    return [claim.verdict for claim in claims_of(integrator, "mine", "mine")]


def test_claims_that_are_wrong_are_refuted() -> None:
    assert verdicts(ExactTableau(GAUSS4), 4, True) == [Verdict.PROVED, Verdict.PROVED]
    assert verdicts(ExactTableau(GAUSS4), 5, True) == [Verdict.REFUTED, Verdict.PROVED]
    assert verdicts(ExactTableau(RK4), 4, True) == [Verdict.PROVED, Verdict.REFUTED]
    assert verdicts(ExactTableau(TRAPEZOIDAL), 2, True)[1] is Verdict.REFUTED, "a near miss"
    assert verdicts(ExactTableau(RK4), 4, None) == [Verdict.PROVED]


def test_a_coefficient_that_is_off_in_its_twelfth_digit_is_refuted() -> None:
    rows = [list(row) for row in GAUSS4.rows]
    rows[0][1] += Rational(1, 10**12)
    off = ImplicitTableau.from_numbers(rows, GAUSS4.weights)
    assert verdicts(ExactTableau(off), 4, True) == [Verdict.REFUTED, Verdict.REFUTED]


def test_floats_hold_up_to_their_rounding() -> None:
    rounded = ImplicitTableau.from_numbers(
        [[Rational(*float(x).as_integer_ratio()) for x in row] for row in LAWSON.rows],
        [Rational(*float(x).as_integer_ratio()) for x in LAWSON.weights],
    )
    assert verdicts(ExactTableau(rounded, rounded=True), 5, None) == [Verdict.MEASURED]
    assert verdicts(ExactTableau(rounded, rounded=True), 6, None) == [Verdict.REFUTED]
    assert verdicts(ExactTableau(rounded), 5, None) == [Verdict.REFUTED], "taken exactly"


def test_missing_digits_are_undecided_and_not_refuted() -> None:
    rows = [list(row) for row in RK4.rows]
    rows[1][0] += Rational(1, 10**10)
    few = ImplicitTableau.from_numbers(rows, RK4.weights)
    assert verdicts(ExactTableau(few, rounded=True), 4, None) == [Verdict.UNDECIDED]


def test_a_misprinted_row_is_repaired() -> None:
    assert repair(MISPRINTED, 5) == (
        "With a_31, a_32 = 3/16, 1/16 in place of 1/8, 1/8 its order is 5"
    )
    assert repair(RK4, 5) == "", "nothing to repair"
    assert repair(GAUSS4, 5) == "", "irrational numbers are not searched"


def test_irrational_coefficients_are_exact() -> None:
    gamma = (3 + sqrt(3)) / 6
    sdirk = ImplicitTableau.from_numbers([[gamma, 0], [1 - 2 * gamma, gamma]], [S.Half, S.Half])
    assert order_of(sdirk, 3).order == 3
    assert symplecticity(sdirk).holds is False
