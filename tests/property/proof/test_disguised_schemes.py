"""Methods that are another than they look: of equal stages, or for an H of which much vanishes.

What a tableau's conditions do not show of them is not told as proved, nor as refuted.
"""

from fractions import Fraction

import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import rationals
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order_for_one_h import prove
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.maps.kinds.implicit_runge_kutta import implicit_map, order_of
from verify.verdict import Verdict

few = drawn(12)
entries = st.sampled_from([Fraction(x) for x in ("0", "1/3", "1/2", "-1", "2", "1/4", "3/2")])


def tableau(rows: list[list[Fraction]], weights: list[Fraction]) -> ImplicitTableau:
    def exact(x: Fraction) -> sympy.Rational:
        return sympy.Rational(x.numerator, x.denominator)

    return ImplicitTableau.from_numbers(
        [[exact(x) for x in r] for r in rows], [exact(x) for x in weights]
    )


@drawn(3)
@given(entries, entries, entries, st.sampled_from(["p**2/2 + 2*q", "q**2/2 - p/3"]), rationals(3))
def test_a_delta_j_of_which_all_that_is_looked_at_vanishes_has_no_order(
    a: Fraction, b: Fraction, weight: Fraction, text: str, size: Fraction
) -> None:
    """Both stages are that of the implicit midpoint rule: the rows' sums are 1/2, the weights' 1.

    It preserves area, which the conditions on the tableau say of one such pair of rows only.
    """
    half = Fraction(1, 2)
    rows, weights = [[a, half - a], [b, half - b]], [weight, 1 - weight]
    cubic = f"{text} + ({size})*{'q' if text[0] == 'p' else 'p'}**3"
    proof = prove(implicit_map(Hamiltonian.parse(cubic), tableau(rows, weights)))
    shown = [
        weights[i] * rows[i][j] + weights[j] * rows[j][i] == weights[i] * weights[j]
        for i in range(2)
        for j in range(2)
    ]
    assert proof.order is None
    assert (proof.convergence_order, proof.convergence_decided) == (2, True)
    if all(shown):
        assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    else:
        assert (proof.verdict, proof.area_preserving) == (Verdict.UNDECIDED, None)
        assert f"the coefficient of h^{MOST_ORDERS + 1} in ΔJ" in proof.reason


@few
@given(
    st.lists(st.lists(entries, min_size=2, max_size=2), min_size=2, max_size=2),
    entries,
    rationals(),
    rationals(),
)
def test_no_order_is_told_where_every_consistent_method_is_exact(
    rows: list[list[Fraction]], weight: Fraction, a: Fraction, b: Fraction
) -> None:
    """H = a p + b q moves all points alike; without Σ b_i = 1 none by as much."""
    field, _ = canonical_field(Hamiltonian.parse(f"({a})*p + ({b})*q"))
    assert order_of(tableau(rows, [weight, 1 - weight]), field) is None
    assert order_of(tableau(rows, [weight, 2 - weight]), field) == 0


@few
@given(entries, rationals(4), rationals(4), rationals(3))
def test_the_order_for_a_quadratic_h_is_that_of_the_stability_function(
    theta: Fraction, a: Fraction, b: Fraction, c: Fraction
) -> None:
    """z' = z + h f(z + θ (z' − z)): R = (1 + (1 − θ) μ)/(1 − θ μ), of order 2 for θ = 1/2 alone."""
    method = tableau([[theta]], [Fraction(1)])
    text = f"({a})*p**2/2 + ({b})*q**2/2"
    quadratic, cubic, falling = (
        canonical_field(Hamiltonian.parse(x))[0]
        for x in (text, f"{text} + ({c})*q**3", f"({a})*p**2/2 + ({b})*q")
    )
    order = 2 if theta == Fraction(1, 2) else 1
    assert order_of(method, quadratic) == order_of(method, cubic) == order
    # A free fall is followed exactly by the midpoint rule, and p by all.
    assert order_of(method, falling) == (None if order == 2 else 1)


@drawn(20)
@given(st.integers(1, 3), entries, entries, rationals(4), rationals(3))
def test_what_cancels_for_one_h_is_no_difference_for_it(
    k: int, x: Fraction, y: Fraction, weight: Fraction, change: Fraction
) -> None:
    """H = (p q)^(k+1): f''(f, f) = −2k z⃛ and f'f'f = (1 + 2k) z⃛.

    By the two trees of three vertices an explicit method of order 2 is off at h³ by
    (b·c² − 1/3) f''(f, f)/2 + (b·A c − 1/6) f'f'f.
    """
    assume(x)
    second = (Fraction(1, 2) - weight * y) / x  # b·c = 1/2
    weights = [1 - second - weight, second, weight]
    gap = second * x**2 + weight * y**2 - Fraction(1, 3)
    assume(gap)
    inner = (Fraction(1, 6) + k * gap / (1 + 2 * k)) / (weight * x)
    field, _ = canonical_field(Hamiltonian.parse(f"(p*q)**{k + 1}"))

    def order(a32: Fraction) -> int | None:
        none = Fraction(0)
        rows = [[none] * 3, [x, none, none], [y - a32, a32, none]]
        return order_of(tableau(rows, weights), field)

    assert order(inner) is None
    assert order(inner + change) == 2
