"""Compositions in closed form: in the ring as sympy substitutes, and refused where they grow."""

from itertools import pairwise

import sympy

from tests.helpers.sampled.formulas import P, Q
from verify import schemes
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.composition import composed_polynomials, occurrences, polynomial
from verify.studies.stability.nearby_linear import linear_stability

DUFFING, PENDULUM = "p**2/2 + q**2/2 + q**4/4", "p**2/2 - cos(q)"


def parts_of(name: str, text: str):
    step_map = schemes.get(name).step_map(Hamiltonian.parse(text))
    ring = step_map.substeps[0].ring
    return ring, [(step.p_next, step.q_next) for step in step_map.substeps], step_map


def test_polynomials_are_composed_as_sympy_substitutes() -> None:
    for name in ("ruth3", "mclachlan-atela2"):  # rational coefficients, and √2
        ring, parts, _ = parts_of(name, DUFFING)
        assert polynomial(ring, parts)
        found = composed_polynomials(ring, parts[:3], 10**4)
        p, q = P, Q
        for pair in parts[:3]:
            put = {P: p, Q: q}
            p, q = (ring.expression(x).subs(put, simultaneous=True) for x in pair)
        for ours, theirs in zip(found, (p, q), strict=True):
            assert sympy.expand(ring.expression(ours) - theirs) == 0
        assert composed_polynomials(ring, parts[:3][::-1], 10**4) != found
        assert composed_polynomials(ring, parts[:3], 5) is None


def test_what_is_no_polynomial_is_seen() -> None:
    assert not polynomial(*parts_of("ruth3", PENDULUM)[:2])
    assert polynomial(*parts_of("yoshida4", "p**2/2 + q**2/2")[:2])


def test_how_long_a_composition_is_written_out_is_known_before() -> None:
    for text in (DUFFING, PENDULUM):
        ring, parts, step_map = parts_of("stormer-verlet", text)
        formulas = [list(sympy.preorder_traversal(x)) for x in step_map.composed]
        occurring = sum(f.count(y) for f in formulas for y in (P, Q))
        # sympy gathers some terms while it substitutes
        assert occurring <= occurrences(ring, parts) <= 2 * occurring
        longer = [occurrences(ring, parts * n) for n in (1, 2, 4, 8)]
        assert all(2 * x < y for x, y in pairwise(longer))


def test_a_long_composition_is_not_written_but_its_area_is_proved() -> None:
    _, _, step_map = parts_of("triple-jump6", "p**2/2 + p**3/9 + exp(q) - q")
    assert step_map.closed is None
    assert step_map.preserves_area


def test_linear_maps_of_many_shears_have_a_closed_form() -> None:
    assert abs(float(linear_stability("suzuki4").decimal()) - 2.72097453856) < 1e-11
    same = [linear_stability(name).interval for name in ("forest-ruth", "yoshida4")]
    assert same[0] == same[1], "kicks and drifts exchanged"
