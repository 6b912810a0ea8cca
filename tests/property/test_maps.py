"""Drawn one-step maps, right and wrong, against sympy's own expansion in h.

A drawn map is the flow's series, cut off, with something planted at a drawn power of h.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.property.strategies import (
    H,
    P,
    Q,
    lie_step,
    plain,
    polynomials,
    rationals,
    zero_there,
)
from verify.formula import parse, to_text
from verify.generators import embed
from verify.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS, Expansion, Leading, first_left
from verify.proof.order import Proof, convergence_of, prove
from verify.proof.potential import potential_of
from verify.ring import Decision
from verify.schemes import get
from verify.step_map import StepMap, grouped
from verify.substep import h_inside
from verify.verdict import Verdict

quick = settings(deadline=None, max_examples=14)
few = settings(deadline=None, max_examples=8)


@st.composite
def planted(draw: st.DrawFn) -> tuple[str, str, str, int]:
    """H, p', q' and the order that the map would have without what is planted in it."""
    text = f"p**2/2 + {draw(polynomials('pq', degree=3, most_terms=2))}"
    eta = draw(st.integers(0, 3))
    step = [str(x) for x in lie_step(plain(text), eta)]
    for _ in range(draw(st.integers(0, 2))):
        at, power = draw(st.integers(0, 1)), draw(st.integers(0, 4))
        term = draw(polynomials("pq", degree=2, most_terms=1) | st.just("1"))
        step[at] += f" + ({draw(rationals(3))})*h**{power}*{term}"
    return text, step[0], step[1], eta


def coefficients(x: sympy.Expr) -> dict[int, sympy.Expr]:
    found = sympy.Poly(sympy.expand(x), H)
    return {int(n): c for (n,), c in found.terms()} if found.as_expr() != 0 else {}


def order_of_flow(hamiltonian: sympy.Expr, step: Sequence[sympy.Expr], most: int) -> int | None:
    """Up to which power of h the map agrees with the flow."""
    own, flow = [coefficients(x) for x in step], [P, Q]
    for n in range(most + 1):
        pairs = zip(own, flow, strict=True)
        if any(sympy.expand(c.get(n, 0) - y / math.factorial(n)) != 0 for c, y in pairs):
            return n - 1
        flow = [
            sympy.expand(hamiltonian.diff(P) * y.diff(Q) - hamiltonian.diff(Q) * y.diff(P))
            for y in flow
        ]
    return None


def determinant(step: Sequence[sympy.Expr]) -> sympy.Expr:
    p, q = step
    return sympy.expand(p.diff(P) * q.diff(Q) - p.diff(Q) * q.diff(P) - 1)


@quick
@given(planted(), st.integers(1, 3))
def test_a_map_has_the_orders_that_its_expansion_has_and_the_verdict_says_which(
    drawn: tuple[str, str, str, int], claimed: int
) -> None:
    text, *formulas, _ = drawn
    hamiltonian, step = Hamiltonian.parse(text), [plain(f) for f in formulas]
    step_map = StepMap.from_formulas(hamiltonian, *formulas)
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
            at = {sympy.Symbol(n, real=True): sympy.Rational(str(x)) for n, x in proof.witness.items()}
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
    step_map = StepMap.from_formulas(Hamiltonian.parse(text), *formulas)
    (part,) = step_map.substeps
    ring, delta_j = part.ring, determinant(step)
    own = [ring.expression(x) for x in (part.p_next, part.q_next)]
    assert all(sympy.expand(x - y) == 0 for x, y in zip(own, step, strict=True))
    entries = [x.diff(v) for x in step for v in (P, Q)]
    assert all(sympy.expand(ring.expression(x) - y) == 0 for x, y in zip(part.jacobian, entries, strict=True))  # fmt: skip
    assert sympy.expand(step_map.jacobian - sympy.Matrix(2, 2, entries)) == sympy.zeros(2)
    moved = [ring.expression(x) for x in part.increments]
    assert [sympy.expand(x - y + z) for x, y, z in zip(moved, step, (P, Q), strict=True)] == [0, 0]
    assert sympy.expand(ring.expression(part.delta_j) - delta_j) == 0
    known = coefficients(delta_j)
    assert part.degree is not None
    assert part.degree >= max(known, default=0)
    assert part.degree == 2 * max(max(coefficients(x), default=0) for x in step)
    for n in range(part.degree + 2):
        assert sympy.expand(ring.expression(part.coefficient(n)) - known.get(n, 0)) == 0
    assert part.terms is not None
    for terms, x in zip(part.terms, step, strict=True):
        true = coefficients(x)
        assert {n for n, c in terms.items() if c != 0} == set(true)
        assert all(sympy.expand(ring.expression(terms[n]) - c) == 0 for n, c in true.items())
    written = step_map.delta_j_text
    assert written is not None
    assert sympy.expand(parse(written, ("p", "q", "h")) - delta_j) == 0
    assert part.preserves_area == step_map.preserves_area == (delta_j == 0)
    assert part.length == sum(len(sympy.Add.make_args(sympy.expand(x))) for x in step)
    count = len(sympy.Add.make_args(delta_j)) if delta_j != 0 else 0
    assert part.terms_of_delta_j >= count
    long, other = (len(sympy.Add.make_args(sympy.expand(x))) for x in step)
    assert part.terms_of_delta_j <= long + other + 2 * long * other
    assert (part.staged, part.solved, step_map.solved, step_map.of_parts) == (False,) * 4
    assert step_map.written
    assert step_map.whole is step_map.closed is step_map.flat is part
    shown = grouped(ring, part.p_next)
    assert sympy.expand(shown - step[0]) == 0
    starts = coefficients(step[0]).get(0) == P and coefficients(step[1]).get(0) == Q
    series = step_map.taylor(5)
    assert (series is not None) == starts
    if series is not None:
        for x, y in zip(series[1:], step, strict=True):
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
    assert len(step_map.substeps) == len(parts)
    assert step_map.of_parts
    assert step_map.preserves_area
    assert (step_map.delta_j, step_map.delta_j_text, step_map.written) == (0, "0", True)
    series = step_map.taylor(3)
    assert series is not None
    field, *own = series
    true = [coefficients(x) for x in (p, q)]
    for x, y in zip(own, true, strict=True):
        for n, c in enumerate(x.coefficients):
            assert sympy.expand(field.ring.expression(c) - y.get(n, 0)) == 0
    order = order_of_flow(whole, [p, q], MOST_ORDERS)
    assert convergence_of(step_map).order == order
    closed = step_map.closed
    if closed is not None:
        assert sympy.expand(closed.ring.expression(closed.q_next) - q) == 0
        assert closed.preserves_area


@few
@given(polynomials("pq", 3, 2), polynomials("pq", 2, 2), rationals(3))
def test_two_substeps_that_change_area_are_composed_in_their_order(
    one: str, other: str, size: Fraction
) -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2")
    first = StepMap.from_formulas(hamiltonian, f"p + h*({one})", f"q + h*p*({size})")
    second = StepMap.from_formulas(hamiltonian, "p", f"q + h**2*({other})")
    (a,), (b,) = first.substeps, second.substeps
    both = StepMap(hamiltonian, (replace(a, field=b.field), b) if a.ring is b.ring else (a, b))
    x = [plain(f"p + h*({one})"), plain(f"q + h*p*({size})")]
    y = [x[0], x[1] + H**2 * plain(other).subs({P: x[0], Q: x[1]}, simultaneous=True)]
    delta_j = determinant(y)
    assert sympy.expand(both.q_next - y[1]) == 0
    assert sympy.expand(both.delta_j - delta_j) == 0
    assert both.preserves_area == (a.preserves_area and b.preserves_area)
    assert sympy.expand(both.whole.ring.expression(both.whole.delta_j) - delta_j) == 0
    proof = prove(both)
    assert proof.order == min(coefficients(delta_j), default=None)


# -- maps that are no polynomials in h ------------------------------------------------------------

INSIDE = ("1/(1 + ({})*h)", "exp(({})*h)", "1/(1 + ({})*h**2*q**2)", "cos(({})*h)", "exp(({})*h*q)")


@settings(deadline=None, max_examples=5)
@given(st.sampled_from(INSIDE), rationals(3), st.integers(0, 3), polynomials("pq", 2, 1))
def test_a_map_with_h_in_its_functions_has_the_taylor_series_of_its_derivatives(
    inside: str, size: Fraction, power: int, factor: str
) -> None:
    text = "p**2/2 + q**2/2 + q**3/3"
    eta = max(power, 1)
    p, q = (str(x) for x in lie_step(plain(text), eta))
    bent = f"h**{power}*({inside.format(size)})*({factor})"
    hamiltonian = Hamiltonian.parse(text)
    step_map = StepMap.from_formulas(hamiltonian, f"{p} + {bent}", q)
    step = [plain(f"{p} + {bent}"), plain(q)]
    series = [
        sum((x.diff(H, n).subs(H, 0) / math.factorial(n) * H**n for n in range(7)), sympy.S.Zero)
        for x in step
    ]
    (part,) = step_map.substeps
    assert part.degree is part.terms is step_map.taylor(3) is None
    assert h_inside(part.ring, part.p_next)
    assert not h_inside(part.ring, part.q_next)
    proof = prove(step_map)
    assert proof.convergence_order == order_of_flow(plain(text), series, 4)
    delta_j = determinant(step)
    found = [delta_j.diff(H, n).subs(H, 0) / math.factorial(n) for n in range(5)]
    first = next((n for n, c in enumerate(found) if not zero_there(c)), None)
    if first is not None:
        assert proof.order == first
        assert zero_there(proof.leading - found[first])
    expansion = Expansion(part.ring, part.p_next)
    assert expansion.length == MOST_ORDERS + 1
    for n in (3, 0, 1, 5):
        ring, x = expansion.coefficient(n)
        true = step[0].diff(H, n).subs(H, 0) / math.factorial(n)
        assert zero_there(ring.expression(x) - true)
    assert step_map.delta_j_text is not None
    assert zero_there(parse(step_map.delta_j_text, ("p", "q", "h")) - delta_j)


@settings(deadline=None, max_examples=3)
@given(st.integers(MOST_ORDERS + 2, MOST_ORDERS + 9))
def test_what_begins_beyond_the_orders_looked_at_is_not_said_to_vanish(power: int) -> None:
    p_next = f"p*(1 + h**{power})/(1 + 2*h**{power})"
    proof = prove(StepMap.from_formulas(Hamiltonian.parse("p**2/2"), p_next, "q + h*p"))
    assert (proof.order, proof.area_preserving) == (None, False)
    assert "is not the zero function" in proof.reason
    assert proof.verdict is Verdict.PROVED


@few
@given(st.lists(polynomials("pq", 2, 1) | st.just("0"), min_size=1, max_size=5))
def test_the_first_coefficient_left_is_the_first_that_is_not_0(given_: list[str]) -> None:
    ring, found = embed([parse(x) for x in given_], ("p", "q"))
    first = next((n for n, x in enumerate(found) if x != 0), None)
    left = first_left(lambda n: (ring, found[n]), len(found))
    assert (left.power if left else None) == first
    whole = sum((parse(x) * H**n for n, x in enumerate(given_)), sympy.S.Zero)
    ring, (x,) = embed([whole], ("p", "q", "h"))
    expansion = Expansion(ring, x)
    assert expansion.length == 1 + max((n for n, c in enumerate(found) if c != 0), default=0)
    leading = expansion.leading()
    assert (leading.power, leading.decision.zero) == (first, first is None)
    true = parse(given_[first]) if first is not None else 0
    assert sympy.expand(leading.coefficient - true) == 0
    assert sympy.expand(parse(leading.text) - true) == 0


# -- potentials -----------------------------------------------------------------------------------

FIELDS = ("p**2/2 + q**2/2 + q**3/3", "p**2/2 - cos(q)", "p**2/2 + p*q**2 + q**4/4", "p**2/2 + exp(q)")


def proof_with(text: str, leading: str | sympy.Expr) -> Proof:
    """A proof whose leading coefficient is this one."""
    step_map = get("rk4").step_map(Hamiltonian.parse(text))
    field = step_map.substeps[0].field
    own, (x,) = Hamiltonian.parse(text).field(parse(leading) if isinstance(leading, str) else leading)
    first = Leading(5, Decision(False), (own.ring, x))
    true = prove(get("lie1").step_map(Hamiltonian.parse(text)), get("lie1"))
    assert field is not None
    return replace(true, order=5, first=first, step_map=step_map)


@few
@given(st.sampled_from(FIELDS), polynomials("pq", 3, 2))
def test_a_leading_coefficient_that_is_x_g_has_a_potential(text: str, g: str) -> None:
    exact, inner = plain(text), plain(g)
    along = sympy.expand(exact.diff(P) * inner.diff(Q) - exact.diff(Q) * inner.diff(P))
    assume(along != 0)
    proof = proof_with(text, parse(to_text(along)))
    found = potential_of(proof, get("rk4"))
    assert found.holds is True
    assert "linear algebra" in found.reason
    assert found.potential is not None
    gap = exact.diff(P) * found.potential.diff(Q) - exact.diff(Q) * found.potential.diff(P) - along
    assert sympy.simplify(gap) == 0
    assert found.text is not None
    assert sympy.simplify(parse(found.text) - found.potential) == 0


EQUILIBRIA = [
    ("p**2/2 + q**2/2", "0", "0"), ("p**2/2 - cos(q)", "0", "0"), ("p**2/2 + (q - 1)**2", "0", "1"),
    ("(p + 1)**2/2 + q**2", "-1", "0"), ("p**2/2 - sin(q/2)", "0", "pi"),
    ("p**2/2 + (q + 1)**2*q**0", "0", "-1"),
]  # fmt: skip


@few
@given(st.sampled_from(EQUILIBRIA), polynomials("pq", 2, 2))
def test_at_an_equilibrium_where_l_is_not_zero_no_potential_is_believed(
    case: tuple[str, str, str], leading: str
) -> None:
    text, p, q = case
    found = potential_of(proof_with(text, leading), get("rk4"))
    there = plain(leading).subs({P: sympy.sympify(p), Q: sympy.sympify(q)})
    if there != 0:
        assert (found.holds, found.potential, found.text) == (False, None, None)
        assert "equilibrium" in found.reason
    if found.holds is False:
        assert f"p = {p}, q = {q}" in found.reason or text == "p**2/2 - cos(q)" or "sin" in text
    if found.holds:
        exact = plain(text)
        g = found.potential
        assert g is not None
        along = exact.diff(P) * g.diff(Q) - exact.diff(Q) * g.diff(P)
        assert sympy.simplify(along - plain(leading)) == 0
