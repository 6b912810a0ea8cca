"""Maps with h in their functions, first coefficients, and potentials of drawn ones."""

import math
from dataclasses import replace
from fractions import Fraction

import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.maps import by_formulas
from tests.helpers.planted.steps import with_term
from tests.helpers.sampled.formulas import (
    H,
    P,
    Q,
    lie_step,
    plain,
    polynomials,
    rationals,
    zero_there,
)
from tests.helpers.sampled.maps import determinant, order_of_flow
from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import parse
from verify.algebra.ring import Decision
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS, Leading, TaylorExpansion
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import potential_of
from verify.proof.proof_for_one_h import Proof
from verify.schemes import get
from verify.schemes.maps.closed_form import h_inside
from verify.verdict import Verdict

quick = drawn(14)
few = drawn(8)


# -- maps that are no polynomials in h ------------------------------------------------------------

FREE = Hamiltonian.parse("p**2/2")
INSIDE = ("1/(1 + ({})*h)", "exp(({})*h)", "1/(1 + ({})*h**2*q**2)", "cos(({})*h)", "exp(({})*h*q)")


def coefficients(x: sympy.Expr, count: int) -> list[sympy.Expr]:
    """Those of h⁰, h¹, … of its Taylor series, by derivatives."""
    found = []
    for n in range(count):
        found.append(x.subs(H, 0) / math.factorial(n))
        x = x.diff(H)
    return found


@pytest.mark.left_to_ci
@drawn(5)
@given(st.sampled_from(INSIDE), rationals(3), st.integers(0, 3), polynomials("pq", 2, 1))
def test_a_map_with_h_in_its_functions_has_the_taylor_series_of_its_derivatives(
    inside: str, size: Fraction, power: int, factor: str
) -> None:
    text = "p**2/2 + q**2/2 + q**3/3"
    eta = max(power, 1)
    p, q = (str(x) for x in lie_step(plain(text), eta))
    bent = f"h**{power}*({inside.format(size)})*({factor})"
    hamiltonian = Hamiltonian.parse(text)
    step_map = by_formulas(hamiltonian, f"{p} + {bent}", q)
    step = [plain(f"{p} + {bent}"), plain(q)]
    taylor = [coefficients(x, 7) for x in step]
    series = [sum((c * H**n for n, c in enumerate(each)), sympy.S.Zero) for each in taylor]
    part = step_map.flat
    assert part.degree is part.series(3) is step_map.series(3) is None
    assert h_inside(part.ring, part.elements[0])
    assert not h_inside(part.ring, part.elements[1])
    proof = prove(step_map)
    assert proof.convergence_order == order_of_flow(plain(text), series, 4)
    delta_j = determinant(step)
    found = coefficients(delta_j, 5)
    first = next((n for n, c in enumerate(found) if not zero_there(c)), None)
    if first is not None:
        assert proof.order == first
        assert zero_there(proof.leading - found[first])
    expansion = TaylorExpansion(part.ring, part.elements[0])
    assert not expansion.polynomial
    for n in (3, 0, 1, 5):
        ring, x = expansion.coefficient(n)
        assert zero_there(ring.expression(x) - taylor[0][n])
    assert step_map.delta_j_text is not None
    assert zero_there(parse(step_map.delta_j_text, ("p", "q", "h")) - delta_j)


@drawn(3)
@given(st.integers(MOST_ORDERS + 2, MOST_ORDERS + 9))
def test_what_begins_beyond_the_orders_looked_at_is_not_said_to_vanish(power: int) -> None:
    p_next = f"p*(1 + h**{power})/(1 + 2*h**{power})"
    proof = prove(by_formulas(Hamiltonian.parse("p**2/2"), p_next, "q + h*p"))
    assert (proof.order, proof.area_preserving) == (None, False)
    assert "is not the zero function" in proof.reason
    assert proof.verdict is Verdict.PROVED
    moved = with_term(get("rk4").step_map(FREE), 1, power, lambda ring: ring.variable("q"))
    staged = prove(moved)
    assert (staged.order, staged.area_preserving) == (None, False), "of stages as well"
    kicked = with_term(moved, 0, 2, lambda ring: -ring.variable("p"))
    assert prove(kicked).order == 2
    polynomial = by_formulas(FREE, "p", f"q + h*p + h**{power}*q")
    assert prove(polynomial).order == power, "a polynomial is looked at to its end"


@few
@given(st.lists(polynomials("pq", 2, 1) | st.just("0"), min_size=1, max_size=5))
def test_the_coefficients_of_a_polynomial_are_those_that_are_given(given_: list[str]) -> None:
    whole = sum((parse(x) * H**n for n, x in enumerate(given_)), sympy.S.Zero)
    ring, (x,) = embed([whole], ("p", "q", "h"))
    expansion = TaylorExpansion(ring, x)
    assert expansion.polynomial
    assert expansion.coefficient(len(given_))[1].is_zero()
    for n, text in enumerate(given_):
        own, found = expansion.coefficient(n)
        leading = Leading(n, own.decide(found), (own, found))
        assert leading.decision.zero is (parse(text) == 0)
        assert sympy.expand(leading.coefficient - parse(text)) == 0
        assert sympy.expand(parse(leading.text) - parse(text)) == 0


# -- potentials -----------------------------------------------------------------------------------

FIELDS = (
    "p**2/2 + q**2/2 + q**3/3",
    "p**2/2 - cos(q)",
    "p**2/2 + p*q**2 + q**4/4",
    "p**2/2 + exp(q)",
)


def proof_with(text: str, leading: str | sympy.Expr) -> Proof:
    """A proof whose leading coefficient is this one."""
    hamiltonian = Hamiltonian.parse(text)
    own, (x,) = canonical_field(
        hamiltonian, parse(leading) if isinstance(leading, str) else leading
    )
    first = Leading(5, Decision(False), (own.ring, x))
    true = prove(get("lie1").step_map(hamiltonian), get("lie1"))
    return replace(true, first=first, step_map=get("rk4").step_map(hamiltonian))


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
    ("p**2/2 + q**2/2", "0", "0"),
    ("p**2/2 - cos(q)", "0", "0"),
    ("p**2/2 + (q - 1)**2", "0", "1"),
    ("(p + 1)**2/2 + q**2", "-1", "0"),
    ("p**2/2 - sin(q/2)", "0", "pi"),
    ("p**2/2 + (q + 1)**2*q**0", "0", "-1"),
]


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
