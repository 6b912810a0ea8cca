"""Whether a leading coefficient is a derivative along the flow, at equilibria of drawn H."""

from dataclasses import replace
from fractions import Fraction

import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import P, Q, plain, polynomials, rationals
from verify.algebra.ring import Decision
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import Leading
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import Potential, potential_of
from verify.schemes import get

few = drawn(12)
places = st.sampled_from(["0", "1", "-1", "pi", "-pi"])
factors = st.sampled_from(["1", "1", "1", "a", "1/a", "1/a"])


def potential(text: str, name: str) -> Potential:
    scheme = get(name)
    return potential_of(prove(scheme.step_map(Hamiltonian.parse(text)), scheme), scheme)


@drawn(24)
@given(places, places, rationals(4), rationals(4), rationals(3), factors)
def test_an_equilibrium_at_which_the_hessian_is_regular_rules_a_potential_out_for_lie1(
    p: str, q: str, a: Fraction, b: Fraction, c: Fraction, factor: str
) -> None:
    """X·G = 0 there for every smooth G, and L = det Hess H, not zero for most values of a."""
    u, v = f"(p - ({p}))", f"(q - ({q}))"
    text = f"({a})*{factor}*{u}**2/2 + ({b})*{v}**2/2 + ({c})*{v}**3"
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
    assert found.text is not None
    assert sympy.expand(plain(found.text) - found.potential) == 0
    along = h.diff(P) * found.potential.diff(Q) - h.diff(Q) * found.potential.diff(P)
    # −div(X² f)/3!, by plain sympy
    p, q_ = -h.diff(Q), h.diff(P)
    for _ in range(2):
        p, q_ = (h.diff(P) * x.diff(Q) - h.diff(Q) * x.diff(P) for x in (p, q_))
    assert sympy.expand(along + (p.diff(P) + q_.diff(Q)) / 6) == 0


powers = st.sampled_from(["3/2", "4/3", "5/4", "2", "3", "5/2"])


@drawn(24)
@given(places, powers, rationals(4), st.sampled_from(["lie1", "lie3"]))
def test_an_equilibrium_rules_nothing_out_where_l_is_zero_or_is_not_defined(
    place: str, power: str, size: Fraction, name: str
) -> None:
    """V = c (q − q₀)^r has V' = 0 at q₀; V'' there is infinite for r < 2 and 0 for r > 2."""
    found = potential(f"p**2/2 + ({size})*(q - ({place}))**({power})", name)
    assert (found.holds is False) == (power == "2")
    if power == "2":
        assert f"equilibrium p = 0, q = {place}," in found.reason
    else:
        assert found.holds is True or found.element is None


@few
@given(polynomials("p", 3, 2), polynomials("q", 4, 2), st.sampled_from(["lie1", "lie2", "lie4"]))
def test_what_has_no_leading_coefficient_has_the_potential_0_or_none_is_known(
    kinetic: str, force: str, name: str
) -> None:
    """ΔJ ≡ 0 is the derivative of 0; of a ΔJ whose order is not decided nothing is said."""
    hamiltonian = Hamiltonian.parse(f"{kinetic} + {force}")
    found = potential(f"{kinetic} + {force}", "symplectic-euler")
    assert (found.holds, found.potential, found.text) == (True, 0, "0")
    scheme = get(name)
    proof = prove(scheme.step_map(hamiltonian), scheme)
    open_ = Leading(None, Decision(None))
    left = potential_of(replace(proof, first=open_, volume=open_), scheme)
    assert (left.holds, left.potential, left.text) == (None, None, None)
    assert "not known" in left.reason
