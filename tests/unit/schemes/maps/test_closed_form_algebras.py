"""Compositions in closed form: in the ring as sympy substitutes, and refused where they grow."""

from fractions import Fraction
from itertools import pairwise

import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q
from verify import schemes
from verify.algebra.enclosure import enclose
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.maps.closed_form_algebras import (
    FormulaAlgebra,
    TooLongError,
    elements_of,
    expressions_of,
    is_polynomial,
)
from verify.schemes.maps.parts import parts_of
from verify.studies.stability.scheme_interval import linear_stability

DUFFING, PENDULUM = "p**2/2 + q**2/2 + q**4/4", "p**2/2 - cos(q)"


def made(name: str, text: str):
    return schemes.get(name).step_map(Hamiltonian.parse(text))


@pytest.mark.parametrize("name", ["symplectic-euler", "stormer-verlet", "explicit-midpoint"])
def test_polynomials_are_composed_as_sympy_substitutes(name: str) -> None:
    step_map = made(name, DUFFING)
    ring = step_map.ring
    ours = elements_of(step_map.field, step_map.step, 10**4)
    for x, y in zip(ours, expressions_of(step_map.field, step_map.step), strict=True):
        assert sympy.expand(ring.expression(x) - y) == 0
    most = max(map(len, ours))
    with pytest.raises(TooLongError):
        elements_of(step_map.field, step_map.step, most // 2)


def test_shears_in_turn_are_the_composition() -> None:
    step_map = made("mclachlan-atela2", "p**2/2 + q**2/2 + q**3/3")  # with √2
    p, q = P, Q
    for part in parts_of(step_map):
        put = {P: p, Q: q}
        p, q = (part.ring.expression(x).subs(put, simultaneous=True) for x in part.elements)
    for x, y in zip((p, q), expressions_of(step_map.field, step_map.step), strict=True):
        assert sympy.expand(x - y) == 0
    assert len(parts_of(step_map)) == 4


def test_a_shear_of_h_in_time_is_made_at_its_own_time() -> None:
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2*cos(t)/2")
    kick, drift, last = parts_of(schemes.get("stormer-verlet").step_map(hamiltonian))
    at = {"p": 1, "q": 2, "t": 3, "h": sympy.Rational(1, 5)}
    put = {sympy.Symbol(n, real=True): x for n, x in at.items()}
    moved = [
        kick.ring.expression(part.elements[0] - part.ring.variable("p")) for part in (kick, last)
    ]
    wanted = [
        -sympy.Rational(1, 5) * sympy.cos(3),
        -sympy.Rational(1, 5) * sympy.cos(sympy.Rational(16, 5)),
    ]
    for x, y in zip(moved, wanted, strict=True):
        assert abs(sympy.N(x.subs(put) - y, 30)) < 1e-25
    assert drift.elements[0] == drift.ring.variable("p")


def test_stages_have_no_parts() -> None:
    assert parts_of(made("rk4", DUFFING)) is None
    assert parts_of(made("gauss4", DUFFING)) is None
    assert len(parts_of(made("lie2", DUFFING))) == 1


def test_what_is_no_polynomial_is_seen() -> None:
    assert not is_polynomial(canonical_field(Hamiltonian.parse(PENDULUM))[0])
    assert is_polynomial(canonical_field(Hamiltonian.parse("p**2/2 + sqrt(2)*q**2"))[0])
    driven = Hamiltonian.parse("p**2/2 + q**2*cos(t)")
    assert not is_polynomial(canonical_field(driven)[0])


def test_how_long_a_composition_is_written_out_is_known_before() -> None:
    for text in (DUFFING, PENDULUM):
        lengths = []
        for name in ("stormer-verlet", "yoshida4"):
            step_map = made(name, text)
            counted = sum(1 + x.count for x in step_map.step(FormulaAlgebra(step_map.field, 10**7)))
            formulas = [list(sympy.preorder_traversal(x)) for x in step_map.composed]
            occurring = sum(f.count(y) for f in formulas for y in (P, Q))
            # sympy gathers some terms while it substitutes
            assert occurring <= counted <= 2 * occurring
            lengths.append(counted)
        assert all(2 * x < y for x, y in pairwise(lengths))


@pytest.mark.parametrize("text", [DUFFING, PENDULUM, "exp(p) + 1/(2 + cosh(q))"])
def test_a_closed_form_is_the_composition(text: str) -> None:
    step_map = made("stormer-verlet", text)
    at = {"p": Fraction(3, 7), "q": Fraction(5, 11), "h": Fraction(1, 9)}
    _, composed = canonical_field(step_map.hamiltonian, *step_map.composed)
    again, _ = canonical_field(step_map.hamiltonian, *step_map.composed)
    for x, y in zip(step_map.flat.elements, composed, strict=True):
        ours, theirs = enclose(step_map.flat.ring, x, at, 256), enclose(again.ring, y, at, 256)
        assert ours.overlaps(theirs)
        assert ours.rad() < 1e-60


def test_a_long_composition_is_not_written_but_its_area_is_proved() -> None:
    step_map = made("triple-jump6", "p**2/2 + p**3/9 + exp(q) - q")
    assert step_map.closed is None
    assert step_map.preserves_area


def test_linear_maps_of_many_shears_have_a_closed_form() -> None:
    assert abs(float(linear_stability("suzuki4").decimal()) - 2.72097453856) < 1e-11
    same = [linear_stability(name).interval for name in ("forest-ruth", "yoshida4")]
    assert same[0] == same[1], "kicks and drifts exchanged"
