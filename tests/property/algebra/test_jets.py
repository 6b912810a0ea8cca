"""The jets against plain derivatives, and what telescopes: drawn G, X·G, and what is none.

A polynomial in the derivatives H_ij is put in by a drawn polynomial H, with sympy's derivatives.
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations_with_replacement
from typing import Any

import flint
import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.lie_derivatives import along_flow, lie_derivatives
from tests.helpers.sampled.formulas import P, Q, plain, polynomials, rationals
from verify.algebra.jets import Jets
from verify.algebra.linear_algebra import solve_combination
from verify.algebra.power_series import Derivatives, Series, expand_at
from verify.exploration.properties.plane.order_by_jets import delta_j
from verify.hamiltonians.canonical_field import JetField
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.telescoping import potential_of_lie, telescopes
from verify.schemes.steps.two_form import wedge

ORDER = 3
T = sympy.Symbol("t")
quick = drawn(10)
Poly = Any


@st.composite
def in_jets(draw: st.DrawFn, jets: Jets, start: bool = True, degree: int = 3) -> Poly:
    """A polynomial in the jets (and p, q, for `start`)."""
    gens = jets.context.gens()[0 if start else 2 :]
    total = jets.zero
    for _ in range(draw(st.integers(1, 3))):
        factors = draw(st.lists(st.sampled_from(gens), min_size=1, max_size=degree))
        c = draw(rationals(4))
        total += math.prod(factors, start=jets.one) * flint.fmpq(c.numerator, c.denominator)
    return total


def put_in(jets: Jets, x: Poly, hamiltonian: sympy.Expr) -> sympy.Expr:
    values = [P, Q, *(hamiltonian.diff(P, i, Q, j) for i, j in jets.indices)]
    total = sympy.S.Zero
    for monomial, c in x.to_dict().items():
        powers = (v ** int(n) for v, n in zip(values, monomial, strict=True))
        total += sympy.Rational(int(c.numer()), int(c.denom())) * sympy.prod(powers)
    return total


def same(x: sympy.Expr, y: sympy.Expr) -> bool:
    return bool(sympy.expand(x - y) == 0)


JETS = {separable: Jets(ORDER + 1, separable=separable) for separable in (False, True)}
LOWER = {separable: Jets(ORDER, separable=separable) for separable in (False, True)}


def raised(x: Poly, separable: bool) -> Poly:
    """The same polynomial in the ring that has derivatives of one order more."""
    return x.compose(
        *JETS[separable].context.gens()[: len(LOWER[separable].context.names())],
        ctx=JETS[separable].context,
    )


elements = {
    True: st.tuples(polynomials("p", 3, 2), polynomials("q", 4, 2)).map(" + ".join),
    False: polynomials("pq", degree=4, most_terms=3),
}


@st.composite
def cases(draw: st.DrawFn) -> tuple[bool, Poly, Poly, sympy.Expr]:
    separable = draw(st.booleans())
    x, y = (raised(draw(in_jets(LOWER[separable])), separable) for _ in range(2))
    return separable, x, y, plain(draw(elements[separable]))


@quick
@given(cases())
def test_derivatives_of_jets_are_those_of_every_h(
    case: tuple[bool, Poly, Poly, sympy.Expr],
) -> None:
    separable, x, y, h = case
    jets = JETS[separable]
    a, b = (put_in(jets, z, h) for z in (x, y))
    assert same(put_in(jets, jets.diff(x, "p"), h), a.diff(P))
    assert same(put_in(jets, jets.diff(x, "q"), h), a.diff(Q))
    assert same(put_in(jets, along_flow(jets, x), h), h.diff(P) * a.diff(Q) - h.diff(Q) * a.diff(P))
    bracket = a.diff(P) * b.diff(Q) - a.diff(Q) * b.diff(P)
    flow = JetField.from_jets(jets)
    area = wedge(flow.gradient(x), flow.gradient(y), 0, 1)
    assert same(put_in(jets, area, h), bracket)


@drawn(8)
@given(cases(), cases(), st.integers(1, 3))
def test_the_series_of_delta_j_is_that_of_the_determinant(
    one: tuple[bool, Poly, Poly, sympy.Expr], two: tuple[bool, Poly, Poly, sympy.Expr], most: int
) -> None:
    separable, x, y, h = one
    jets = JETS[separable]
    series = ([jets.p, x, y, x][: most + 1], [jets.q, y, x, y][: most + 1])
    found = list(delta_j(jets, *series))
    p, q = (sum(put_in(jets, z, h) * T**n for n, z in enumerate(s)) for s in series)
    det = sympy.Poly(sympy.expand(p.diff(P) * q.diff(Q) - p.diff(Q) * q.diff(P)), T)
    assert len(found) == most
    for n, z in enumerate(found, start=1):
        assert same(put_in(jets, z, h), det.coeff_monomial(T**n))


@quick
@given(st.booleans(), st.data())
def test_a_derivative_at_a_moved_point_is_taylors(separable: bool, data: st.DataObject) -> None:
    jets, most = Jets(5, separable=separable), 3
    dp, dq = (
        [jets.zero, *(data.draw(in_jets(jets, degree=1)) for _ in range(most - 1))] for _ in "pq"
    )
    i, j = data.draw(st.sampled_from([(0, 1), (1, 0), (2, 0), (0, 2)]))
    moves = [
        (name, Series.from_coefficients(jets, x, most - 1)) for name, x in (("p", dp), ("q", dq))
    ]
    found = expand_at(Derivatives(jets, jets.h(i, j)), moves, most - 1).coefficients
    h = plain(data.draw(elements[separable]))
    u, v = (sum(put_in(jets, z, h) * T**n for n, z in enumerate(d)) for d in (dp, dq))
    true = sympy.Poly(
        sympy.expand(h.diff(P, i, Q, j).subs({P: P + u, Q: Q + v}, simultaneous=True)), T
    )
    assert len(found) == most
    for n, z in enumerate(found):
        assert same(put_in(jets, z, h), true.coeff_monomial(T**n))


@quick
@given(st.lists(rationals(), min_size=1, max_size=5), st.data())
def test_the_product_of_two_series_is_cut_off_where_they_end(
    x: list[Fraction], data: st.DataObject
) -> None:
    y = data.draw(st.lists(rationals(), min_size=len(x), max_size=len(x)))
    whole = sympy.Poly([sympy.Rational(str(a)) for a in x[::-1]], T)
    whole *= sympy.Poly([sympy.Rational(str(a)) for a in y[::-1]], T)
    jets = Jets(1)
    one, two = (
        Series.from_coefficients(jets, list(map(jets.constant, z)), len(x) - 1) for z in (x, y)
    )
    found = [sympy.Rational(str(z)) for z in (one * two).coefficients]
    assert found == whole.all_coeffs()[::-1][: len(x)]


@pytest.mark.parametrize("separable", [False, True])
@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_jets_are_all_derivatives_up_to_their_order(order: int, separable: bool) -> None:
    jets = Jets(order, separable=separable)
    wanted = {(i, j) for i in range(order + 1) for j in range(order + 1) if 0 < i + j <= order}
    kept = {(i, j) for i, j in wanted if not (separable and i and j)}
    assert set(jets.indices) == kept
    assert len(jets.indices) == len(kept)
    for i, j in wanted:
        name = "H_" + "p" * i + "q" * j if (i, j) in kept else "0"
        assert jets.text(jets.h(i, j)) == name
        assert jets.text(jets.h(i, j) ** 2) == (f"{name}**2" if name != "0" else "0")
    for i, j in ((order + 1, 0), (0, order + 1)):
        with pytest.raises(OverflowError):
            jets.h(i, j)
    assert [jets.text(x) for x in (jets.p, jets.q, jets.zero, jets.one)] == ["p", "q", "0", "1"]
    assert lie_derivatives(jets, "p", 1) == [jets.p, -jets.h(0, 1)]
    assert lie_derivatives(jets, "q", 1) == [jets.q, jets.h(1, 0)]


# -- what telescopes ------------------------------------------------------------------------------


@quick
@given(st.booleans(), st.data())
def test_whatever_is_x_g_telescopes_to_g(separable: bool, data: st.DataObject) -> None:
    jets = JETS[separable]
    g = raised(data.draw(in_jets(LOWER[separable], start=False)), separable)
    found = telescopes(jets, along_flow(jets, g))
    assert found.holds
    assert along_flow(jets, found.potential) == along_flow(jets, g)


def products(jets: Jets, factors: int, by_p: int, by_q: int, below: int) -> list[Poly]:
    """Of derivatives of orders below that, so many, with so many derivatives by p and by q."""
    indices = [ij for ij in jets.indices if sum(ij) < below]
    return [
        math.prod((jets.h(*ij) for ij in chosen), start=jets.one)
        for chosen in combinations_with_replacement(indices, factors)
        if sum(i for i, _ in chosen) == by_p and sum(j for _, j in chosen) == by_q
    ]


def rank(columns: Sequence[Poly]) -> int:
    monomials = sorted({m for x in columns for m in x.to_dict()})
    entries = [[str(x.to_dict().get(m, 0)) for m in monomials] for x in columns]
    return (
        int(sympy.Matrix([[sympy.Rational(e) for e in row] for row in entries]).rank())
        if monomials
        else 0
    )


@quick
@given(st.booleans(), st.data())
def test_one_product_of_derivatives_telescopes_where_the_ranks_say_so(
    separable: bool, data: st.DataObject
) -> None:
    jets = JETS[separable]
    chosen = data.draw(st.lists(st.sampled_from(jets.indices), min_size=1, max_size=4))
    x = math.prod((jets.h(*ij) for ij in chosen), start=jets.one)
    found = telescopes(jets, x)
    if not any(sum(ij) == 1 for ij in chosen):
        assert not found.holds
        assert f"there L is {jets.text(x)}" in found.reason
        return
    by_p, by_q = sum(i for i, _ in chosen), sum(j for _, j in chosen)
    candidates = products(jets, len(chosen) - 1, by_p - 1, by_q - 1, max(map(sum, chosen)))
    columns = [along_flow(jets, g) for g in candidates]
    own = rank(columns)
    assert found.holds == (rank([*columns, x]) == own)
    if found.holds:
        assert along_flow(jets, found.potential) == x
    else:
        assert f"the {len(candidates)} monomials" in found.reason
        assert f"dimension {own}; with L it has dimension {own + 1}" in found.reason


@pytest.mark.parametrize("eta", [1, 2, 3, 4])
def test_the_truncated_flow_telescopes_for_even_eta_alone(eta: int) -> None:
    jets = Jets(eta + 2)
    end = [along_flow(jets, lie_derivatives(jets, name, eta)[-1]) for name in "pq"]
    leading = -(jets.diff(end[0], "p") + jets.diff(end[1], "q")) / math.factorial(eta + 1)
    found = prove_for_every_h(f"lie{eta}")
    assert found.telescopes is (eta % 2 == 0)
    assert found.leading == jets.text(leading)
    if found.telescopes:
        potential = potential_of_lie(JetField.from_jets(jets), eta).divergence
        assert found.potential == jets.text(potential)
        assert along_flow(jets, potential) == leading
        assert f"G = −1/{eta + 1}!" in found.why
        assert f"X^({eta}−k)" in found.why
        twice = telescopes(jets, leading * 2)  # another L, and another G
        assert twice.holds
        assert along_flow(jets, twice.potential) == leading * 2
    else:
        with pytest.raises(ValueError, match="odd"):
            potential_of_lie(JetField.from_jets(jets), eta)


# -- linear algebra -------------------------------------------------------------------------------

RING = Jets(1)


@quick
@given(
    st.lists(in_jets(RING), max_size=4),
    in_jets(RING),
    st.lists(rationals(), min_size=4, max_size=4),
    st.booleans(),
)
def test_a_combination_is_found_where_there_is_one(
    columns: list[Poly], other: Poly, weights: list[Fraction], inside: bool
) -> None:
    whole = RING.zero
    for x, w in zip(columns, weights, strict=False):
        whole += x * flint.fmpq(w.numerator, w.denominator)
    wanted = whole if inside else other
    assume(wanted != 0)
    found, own = solve_combination(columns, wanted)
    assert own == rank(columns)
    assert (found is not None) == (rank([*columns, wanted]) == own)
    if found is not None:
        assert sum((c * columns[k] for k, c in found.items()), RING.zero) == wanted
