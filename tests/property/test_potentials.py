"""Whether a leading coefficient is a derivative along the flow, at equilibria of drawn H."""

from fractions import Fraction

import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.property.strategies import P, Q, plain, rationals
from verify.hamiltonian import Hamiltonian
from verify.proof.order import prove
from verify.proof.potential import Potential, potential_of
from verify.schemes import get

few = settings(deadline=None, max_examples=12)
places = st.sampled_from(["0", "1", "-1", "pi", "-pi"])


def potential(text: str, name: str) -> Potential:
    scheme = get(name)
    return potential_of(prove(scheme.step_map(Hamiltonian.parse(text)), scheme), scheme)


@settings(deadline=None, max_examples=24)
@given(places, places, rationals(4), rationals(4), rationals(3))
def test_an_equilibrium_at_which_the_hessian_is_regular_rules_a_potential_out_for_lie1(
    p: str, q: str, a: Fraction, b: Fraction, c: Fraction
) -> None:
    """X·G = 0 there for every smooth G, and L = det Hess H."""
    u, v = f"(p - ({p}))", f"(q - ({q}))"
    text = f"({a})*{u}**2/2 + ({b})*{v}**2/2 + ({c})*{v}**3"
    found = potential(text, "lie1")
    assert (found.holds, found.potential, found.text) == (False, None, None)
    said = found.reason.partition("equilibrium p = ")[2].partition(", for")[0]
    at = {P: plain(said.split(", q = ")[0]), Q: plain(said.split(", q = ")[1])}
    h = plain(text)
    assert [sympy.expand(h.diff(x).subs(at)) for x in (P, Q)] == [0, 0]
    hessian = h.diff(P, 2) * h.diff(Q, 2) - h.diff(P, Q) ** 2
    assert sympy.expand(hessian.subs(at)) != 0


@few
@given(places, rationals(4), rationals(3))
def test_no_equilibrium_rules_out_what_has_a_potential(q: str, a: Fraction, c: Fraction) -> None:
    """L is X·G by the formula for even η, though equilibria are there."""
    text = f"p**2/2 + ({a})*(q - ({q}))**2/2 + ({c})*(q - ({q}))**3"
    found, h = potential(text, "lie2"), plain(text)
    assert (found.holds, found.reason) == (True, "by the formula for every H")
    assert found.potential is not None
    along = h.diff(P) * found.potential.diff(Q) - h.diff(Q) * found.potential.diff(P)
    # −div(X² f)/3!, by plain sympy
    p, q_ = -h.diff(Q), h.diff(P)
    for _ in range(2):
        p, q_ = (h.diff(P) * x.diff(Q) - h.diff(Q) * x.diff(P) for x in (p, q_))
    assert sympy.expand(along + (p.diff(P) + q_.diff(Q)) / 6) == 0


# V' is 0 at the equilibrium, and V'' is infinite or has no value there as it is written.
NOT_SMOOTH = [
    "q**(3/2)",
    "q**(4/3)",
    "(1 + cos(q))**(3/2)",
    "(1 + cos(q))**(5/4)",
    "(1 - cos(2*q))**(3/2)",
    "(1 - q**2)**(3/2)",
]


@few
@given(st.sampled_from(NOT_SMOOTH), rationals(4), st.sampled_from(["lie1", "lie3"]))
def test_an_equilibrium_at_which_l_is_not_defined_rules_nothing_out(
    text: str, size: Fraction, name: str
) -> None:
    found = potential(f"p**2/2 + ({size})*{text}", name)
    assert found.holds is not False or "equilibrium p = 0" in found.reason
    if found.holds is False:
        at = plain(found.reason.partition("q = ")[2].partition(", for")[0])
        assert (plain(text).diff(Q, 2)).subs(Q, at).is_finite
