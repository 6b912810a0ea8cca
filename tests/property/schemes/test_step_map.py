"""Drawn one-step maps, right and wrong, against sympy's own expansion in h.

A drawn map is the flow's series, cut off, with something planted at a drawn power of h.
"""

from dataclasses import replace
from fractions import Fraction

import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.maps import by_expressions, by_formulas
from tests.helpers.sampled.formulas import H, P, Q, plain, polynomials, rationals
from tests.helpers.sampled.maps import coefficients, determinant, order_of_flow, planted
from verify.algebra.formula import parse
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order_for_one_h import convergence_of, prove
from verify.schemes import get
from verify.schemes.maps.closed_form import group_by_powers
from verify.schemes.maps.parts import parts_of
from verify.verdict import Verdict

quick = drawn(14)
few = drawn(8)


@quick
@given(planted(), st.integers(1, 3))
def test_a_map_has_the_orders_that_its_expansion_has_and_the_verdict_says_which(
    drawn: tuple[str, str, str, int], claimed: int
) -> None:
    text, *formulas, _ = drawn
    hamiltonian, step = Hamiltonian.parse(text), [plain(f) for f in formulas]
    step_map = by_formulas(hamiltonian, *formulas)
    delta_j = determinant(step)
    known = coefficients(delta_j)
    order = order_of_flow(plain(text), step, MOST_ORDERS)
    scheme = replace(get("euler"), name="drawn", order=claimed)
    for proof, needed in ((prove(step_map), 1), (prove(step_map, scheme), claimed)):
        assert proof.convergence_order == order
        assert proof.consistent == (order is None or order >= 1)
        assert proof.area_preserving is (not known)
        assert proof.order == min(known, default=None)
        assert sympy.expand(proof.leading - known.get(min(known, default=0), 0)) == 0
        assert sympy.expand(proof.delta_j - delta_j) == 0
        right = order is None or order >= needed
        assert proof.verdict is (Verdict.PROVED if right else Verdict.REFUTED)
        if right and known:
            assert f"below h^{proof.order} vanish" in proof.reason
            assert f"that of h^{proof.order} does not" in proof.reason
        elif right:
            assert "det J ≡ 1" in proof.reason
        elif order == -1:
            assert "not even at h = 0" in proof.reason
        else:
            assert f"up to h^{order} only" in proof.reason
            claims = f"claims order {claimed}" in proof.reason
            assert claims or proof.reason.startswith("not a scheme for this H")
        if known and proof.witness:
            at = {
                sympy.Symbol(n, real=True): sympy.Rational(str(x)) for n, x in proof.witness.items()
            }
            assert proof.leading.subs(at) != 0
    area = replace(scheme, area_preserving=True, order=1)
    if order is None or order >= 1:
        wanted = Verdict.REFUTED if known else Verdict.PROVED
        assert prove(step_map, area).verdict is wanted


@quick
@given(planted())
def test_the_parts_of_a_map_are_its_derivatives_and_its_powers_of_h(
    drawn: tuple[str, str, str, int],
) -> None:
    text, *formulas, _ = drawn
    step = [plain(f) for f in formulas]
    step_map = by_formulas(Hamiltonian.parse(text), *formulas)
    part = step_map.flat
    ring, delta_j = part.ring, determinant(step)
    own = [ring.expression(x) for x in part.elements]
    assert all(sympy.expand(x - y) == 0 for x, y in zip(own, step, strict=True))
    entries = [x.diff(v) for x in step for v in (P, Q)]
    assert all(
        sympy.expand(ring.expression(x) - y) == 0
        for x, y in zip((x for row in part.jacobian for x in row), entries, strict=True)
    )
    assert sympy.expand(step_map.jacobian - sympy.Matrix(2, 2, entries)) == sympy.zeros(2)
    moved = [ring.expression(x) for x in part.increments]
    assert [sympy.expand(x - y + z) for x, y, z in zip(moved, step, (P, Q), strict=True)] == [0, 0]
    assert sympy.expand(ring.expression(part.delta_j) - delta_j) == 0
    known = coefficients(delta_j)
    assert part.degree is not None
    assert 2 * part.degree >= max(known, default=0)
    assert part.degree == max(max(coefficients(x), default=0) for x in step)
    assert part.forms is not None
    assert set(part.forms) == set(known)
    for n in range(2 * part.degree + 2):
        coefficient = part.form(n).entry(0, 1)
        assert sympy.expand(ring.expression(coefficient) - known.get(n, 0)) == 0
    whole = part.series(part.degree)
    assert whole is not None
    for terms, x in zip(whole, step, strict=True):
        true = coefficients(x)
        assert {n for n, c in enumerate(terms.coefficients) if c != 0} == set(true)
        assert all(
            sympy.expand(ring.expression(terms.coefficients[n]) - c) == 0 for n, c in true.items()
        )
    written = step_map.delta_j_text
    assert written is not None
    assert sympy.expand(parse(written, ("p", "q", "h")) - delta_j) == 0
    assert part.symplectic == step_map.preserves_area == (delta_j == 0)
    assert part.length == sum(len(sympy.Add.make_args(sympy.expand(x))) for x in step)
    count = len(sympy.Add.make_args(delta_j)) if delta_j != 0 else 0
    assert part.products >= count
    long, other = (len(sympy.Add.make_args(sympy.expand(x))) for x in step)
    assert part.products <= long + other + 2 * long * other
    assert (step_map.implicit, step_map.in_stages) == (False, False)
    assert step_map.has_closed_form
    assert step_map.closed is step_map.flat is step_map.written_defect is part
    shown = group_by_powers(ring, part.elements[0])
    assert sympy.expand(shown - step[0]) == 0
    series = step_map.series(5)
    assert series is not None
    for x, y in zip(series[1], step, strict=True):
        true = coefficients(y)
        for n, c in enumerate(x.coefficients):
            assert sympy.expand(ring.expression(c) - true.get(n, 0)) == 0
        assert len(x.coefficients) == 6


# -- compositions ---------------------------------------------------------------------------------

kinds = st.sampled_from(["kick", "drift"])
compositions = st.lists(st.tuples(kinds, rationals(3)), min_size=2, max_size=4)


@few
@given(polynomials("p", 3, 2), polynomials("q", 4, 2), compositions)
def test_a_composition_is_its_parts_one_after_the_other(
    kinetic: str, potential: str, parts: list[tuple[str, Fraction]]
) -> None:
    text = f"{kinetic} + {potential}"
    scheme = get("; ".join(f"{kind} {size}" for kind, size in parts))
    step_map, whole = scheme.step_map(Hamiltonian.parse(text)), plain(text)
    p, q = P, Q
    for kind, size in parts:
        part = sympy.Rational(str(size)) * H
        if kind == "kick":
            p = p - part * whole.diff(Q).subs({P: p, Q: q}, simultaneous=True)
        else:
            q = q + part * whole.diff(P).subs({P: p, Q: q}, simultaneous=True)
    assert sympy.expand(step_map.p_next - p) == 0
    assert sympy.expand(step_map.q_next - q) == 0
    shears = parts_of(step_map)
    assert shears is not None
    assert len(shears) == len(parts)
    assert all(shear.symplectic for shear in shears)
    assert step_map.in_stages
    assert step_map.preserves_area
    assert (step_map.delta_j, step_map.delta_j_text, step_map.has_closed_form) == (0, "0", True)
    series = step_map.series(3)
    assert series is not None
    field, own = series
    true = [coefficients(x) for x in (p, q)]
    for x, y in zip(own, true, strict=True):
        for n, c in enumerate(x.coefficients):
            assert sympy.expand(field.ring.expression(c) - y.get(n, 0)) == 0
    order = order_of_flow(whole, [p, q], MOST_ORDERS)
    assert convergence_of(step_map).order == order
    closed = step_map.closed
    if closed is not None:
        assert sympy.expand(closed.ring.expression(closed.elements[1]) - q) == 0
        assert closed.symplectic


@few
@given(polynomials("pq", 3, 2), polynomials("pq", 2, 2), rationals(3))
def test_two_maps_that_change_area_are_composed_in_their_order(
    one: str, other: str, size: Fraction
) -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2")
    first = by_formulas(hamiltonian, f"p + h*({one})", f"q + h*p*({size})")
    second = by_formulas(hamiltonian, "p", f"q + h**2*({other})")
    put = {P: first.p_next, Q: first.q_next}
    both = by_expressions(hamiltonian, *(x.xreplace(put) for x in second.composed))
    x = [plain(f"p + h*({one})"), plain(f"q + h*p*({size})")]
    y = [x[0], x[1] + H**2 * plain(other).subs({P: x[0], Q: x[1]}, simultaneous=True)]
    delta_j = determinant(y)
    assert sympy.expand(both.q_next - y[1]) == 0
    assert sympy.expand(both.delta_j - delta_j) == 0
    assert both.preserves_area == (delta_j == 0)
    assert sympy.expand(both.flat.ring.expression(both.flat.delta_j) - delta_j) == 0
    proof = prove(both)
    assert proof.order == min(coefficients(delta_j), default=None)
