"""Rooted trees and order conditions of drawn Runge–Kutta methods, by their definitions."""

import math
from collections.abc import Iterator
from fractions import Fraction
from itertools import product

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.lie_derivatives import lie_derivatives
from tests.helpers.sampled.formulas import plain, polynomials
from verify.algebra.jets import Jets
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.conditions.coloured_trees import (
    Tree,
    condition_text,
    density,
    symmetry,
    vertices,
)
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.tree_conditions import (
    MOST_ORDER,
    Differentials,
    TreeConditions,
    cancels,
    gaps_of,
    trees,
)
from verify.schemes.maps.kinds.implicit_runge_kutta import order_of

quick = drawn(25)


def monotone(tree: Tree) -> Fraction:
    """In how many ways its vertices are numbered upwards, n!/(σ γ), by counting."""
    count, left = 1, vertices(tree) - 1
    _, branches = tree
    for child in branches:
        count *= math.comb(left, vertices(child)) * monotone(child)
        left -= vertices(child)
    same = [branches.count(child) for child in dict.fromkeys(branches)]
    return Fraction(count, math.prod(map(math.factorial, same)))


@pytest.mark.parametrize("order", range(1, 9))
def test_rooted_trees_are_all_and_weighted_as_the_flow_weights_them(order: int) -> None:
    known = trees(order)
    assert len(set(known)) == len(known) == (1, 1, 2, 4, 9, 20, 48, 115)[order - 1]
    assert {vertices(t) for t in known} == {order}
    assert all(list(t) == sorted(t, key=place) for _, t in known)
    labelled = sum(Fraction(math.factorial(order), symmetry(t)) for t in known)
    assert labelled == order ** (order - 1), "Cayley"
    for tree in known:
        assert Fraction(math.factorial(order), symmetry(tree) * density(tree)) == monotone(tree)


def place(tree: Tree) -> tuple[int, int]:
    return -vertices(tree), trees(vertices(tree)).index(tree)


@pytest.mark.parametrize("order", range(1, 6))
@pytest.mark.parametrize("separable", [False, True])
def test_elementary_differentials_add_up_to_the_flow(order: int, separable: bool) -> None:
    """Xⁿ z = Σ n!/(σ γ) F(t) over the trees of n vertices."""
    jets = Jets(order + 1, separable=separable)
    own = Differentials(jets)
    for part, name in enumerate("pq"):
        terms = (own.differential(t)[part] * monotone(t).numerator for t in trees(order))
        assert sum(terms, jets.zero) == lie_derivatives(jets, name, order)[-1]


@quick
@given(st.integers(-3, 3), st.one_of(st.none(), st.sampled_from(trees(5))), st.booleans())
def test_only_what_cancels_for_every_h_is_taken_for_nothing(
    size: int, other: Tree | None, separable: bool
) -> None:
    """In the plane f''(f, f'f'f) = f'f'f''(f, f), and no other two trees of five are alike."""
    alike = [
        next(t for t in trees(5) if condition_text(t) == x)
        for x in ("b·(c A(A(c)))", "b·A(A(c^2))")
    ]
    numbers = getattr(get("gauss4").every_h, "tableau").numbers  # noqa: B009 - of several kinds
    one = numbers.a[0][1]  # 1/4 − √3/6
    gaps = {t: one * symmetry(t) * size * sign for t, sign in zip(alike, (1, -1), strict=True)}
    if other is not None:
        gaps[other] = gaps.get(other, one * 0) + one / 7
    own = Differentials(Jets(5, separable=separable))
    assert cancels(numbers.ring, gaps, own) is (other is None)


numbers = st.builds(Fraction, st.integers(-2, 3), st.integers(1, 3))


@st.composite
def tableaux(draw: st.DrawFn) -> tuple[list[list[Fraction]], list[Fraction]]:
    count = draw(st.integers(1, 3))
    row = st.lists(numbers, min_size=count, max_size=count)
    rows, weights = [draw(row) for _ in range(count)], draw(row)
    weights[-1] = 1 - sum(weights[:-1])  # order 1
    if draw(st.booleans()):  # b·c = 1/2, order 2
        rows[0] = [*rows[0][:-1], rows[0][-1]]
        gap = Fraction(1, 2) - sum(b * sum(r) for b, r in zip(weights, rows, strict=True))
        if weights[0]:
            rows[0][0] += gap / weights[0]
    return rows, weights


def tableau_of(rows: list[list[Fraction]], weights: list[Fraction]) -> ImplicitTableau:
    def exact(x: Fraction) -> sympy.Rational:
        return sympy.Rational(x.numerator, x.denominator)

    return ImplicitTableau.from_numbers(
        [[exact(x) for x in r] for r in rows], [exact(x) for x in weights]
    )


def weighted(rows: list[list[Fraction]], tree: Tree, at: int) -> Fraction:
    """Φ_i(t), by its definition."""
    return math.prod(
        (sum(rows[at][j] * weighted(rows, t, j) for j in range(len(rows))) for t in tree[1]),
        start=Fraction(1),
    )


def gap(rows: list[list[Fraction]], weights: list[Fraction], tree: Tree) -> Fraction:
    own = sum(b * weighted(rows, tree, i) for i, b in enumerate(weights))
    count = monotone(tree) * symmetry(tree) / math.factorial(vertices(tree))  # 1/γ
    return own - count


@quick
@given(tableaux())
def test_a_trees_condition_is_by_its_definition_and_its_name_says_which(
    drawn: tuple[list[list[Fraction]], list[Fraction]],
) -> None:
    rows, weights = drawn
    tableau = tableau_of(rows, weights)
    ring = tableau.numbers.ring
    for order in (1, 2, 3, 4):
        found = gaps_of(tableau, order)
        assert list(found) == list(trees(order))
        for tree, x in found.items():
            true = gap(rows, weights, tree)
            assert ring.expression(x) == sympy.Rational(true.numerator, true.denominator)
            assert read(condition_text(tree), rows, weights) - Fraction(1, density(tree)) == true
    own = TreeConditions(tableau)
    assert own.order_conditions(4)[0].name == "b·1 = 1"
    for condition in own.order_conditions(4):
        if condition.name.startswith("b·"):
            left, right = condition.name.split(" = ")
            residue = read(left, rows, weights) - Fraction(right)
            assert condition.holds is (residue == 0)
            assert (condition.residue == "0") == (residue == 0)
            assert abs(float(condition.residue) - float(residue)) <= 1e-4 * abs(float(residue))


def read(text: str, rows: list[list[Fraction]], weights: list[Fraction]) -> Fraction:
    """The left side of a condition by Python's own reader."""
    tokens = text.replace("·", "(", 1) + ")" if "(" not in text[:3] else text.replace("·", "", 1)
    tokens = tokens.replace("^", "**").replace(" ", "*")

    class Vector:
        def __init__(self, x: list[Fraction]) -> None:
            self.x = x

        def __mul__(self, other: "Vector") -> "Vector":
            return Vector([a * b for a, b in zip(self.x, other.x, strict=True)])

        def __pow__(self, n: int) -> "Vector":
            return Vector([a**n for a in self.x])

    def matrix(y: Vector) -> Vector:
        return Vector(
            [sum((a * b for a, b in zip(r, y.x, strict=True)), Fraction(0)) for r in rows]
        )

    def dot(y: Vector | int) -> Fraction:
        values = [Fraction(1)] * len(weights) if isinstance(y, int) else y.x
        return sum((a * b for a, b in zip(weights, values, strict=True)), Fraction(0))

    ones = Vector([Fraction(1)] * len(weights))
    found = eval(tokens, {"b": dot, "A": matrix, "c": matrix(ones)})  # noqa: S307 - our own text
    assert isinstance(found, Fraction | int)
    return Fraction(found)


# With a quadratic H more trees vanish than with others, and with a linear one most.
QUADRATIC = ("p**2/2 + q**2/2", "p*q + q**2", "p + q", "p**2/2 + q**2/2 + q**3/3")
BENT = "p**2/2 + p*q**2/3 + {}"


@drawn(15)
@given(
    tableaux(),
    st.sampled_from(QUADRATIC) | polynomials("pq", degree=4, most_terms=3).map(BENT.format),
)
def test_the_order_for_one_h_is_that_of_the_differences_of_elementary_differentials(
    drawn: tuple[list[list[Fraction]], list[Fraction]], text: str
) -> None:
    rows, weights = drawn
    field, _ = canonical_field(Hamiltonian.parse(text))
    found = order_of(tableau_of(rows, weights), field)
    for order, left in differences(rows, weights, plain(text)):
        if any(gap(rows, weights, t) for t in trees(order)):
            assert found == (order - 1 if left else None)
            break


def differences(
    rows: list[list[Fraction]], weights: list[Fraction], hamiltonian: sympy.Expr
) -> Iterator[tuple[int, bool]]:
    """Whether Σ gap F(t)/σ(t) is not zero, for 1, 2, … vertices, by sympy."""
    p, q = sympy.symbols("p q", real=True)

    def differential(tree: Tree) -> tuple[sympy.Expr, sympy.Expr]:
        inner = [differential(t) for t in tree[1]]
        total = [-hamiltonian.diff(q), hamiltonian.diff(p)]
        for k, y in enumerate(total):
            total[k] = sum(
                y.diff(p, parts.count(0), q, parts.count(1))
                * math.prod(v[x] for v, x in zip(inner, parts, strict=True))
                for parts in product((0, 1), repeat=len(inner))
            )
        return sympy.expand(total[0]), sympy.expand(total[1])

    for order in range(1, 5):
        whole = [sympy.S.Zero, sympy.S.Zero]
        for tree in trees(order):
            share = gap(rows, weights, tree) / symmetry(tree)
            x = differential(tree)
            exact = sympy.Rational(share.numerator, share.denominator)
            whole = [w + exact * y for w, y in zip(whole, x, strict=True)]
        yield order, any(sympy.expand(w) != 0 for w in whole)


def test_conditions_of_trees_end_with_order_10_and_count_as_the_trees() -> None:
    own = TreeConditions(tableau_of([[Fraction(1, 2)]], [Fraction(1)]))
    assert own.most_order == MOST_ORDER == 10
    assert [len(own.order_conditions(n)) for n in range(1, 6)] == [1, 2, 4, 8, 17]
    with pytest.raises(InputError):
        own.order_conditions(11)


@quick
@given(st.integers(1, 3), st.integers(1, 4))
def test_a_truncated_flow_agrees_with_it_up_to_its_order(eta: int, most: int) -> None:
    jets = Jets(most + 1)
    p, q = TaylorSeries(eta).taylor(jets, most)
    for name, own in zip("pq", (p, q), strict=True):
        flow = lie_derivatives(jets, name, most)
        assert len(own) == most + 1
        for n, x in enumerate(own):
            assert x * math.factorial(n) == (flow[n] if n <= eta else jets.zero)
