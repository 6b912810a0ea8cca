"""Drawn schemes for every H: what they claim is proved, or refuted with the reason."""

from dataclasses import replace
from fractions import Fraction

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.constructed.schemes import proof_of
from tests.helpers.sampled.formulas import H, P, Q, plain, rationals
from verify.algebra.jets import Jets
from verify.errors import InputError
from verify.exploration.properties.plane.order_by_jets import delta_j
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_conditions import prove_by_conditions
from verify.proof.order_for_every_h import counterexample, prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes import get, names
from verify.schemes.conditions.every_hamiltonian import (
    RungeKutta,
    Stage,
    StageEquations,
    TaylorSeries,
)
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.verdict import Verdict

SEPARABLE = "p**2/2 + p**3/3 + q**2/2 + q**4/4 + q**3/3"
few = drawn(12)


@few
@given(st.integers(1, 4), st.integers(1, 5), st.booleans(), st.booleans())
def test_a_truncated_flow_that_claims_another_order_is_refuted(
    eta: int, claimed: int, area: bool, separable: bool
) -> None:
    proof = proof_of(TaylorSeries(eta), claimed, area, separable)
    right = eta >= claimed and not area
    assert proof.verdict is (Verdict.PROVED if right else Verdict.REFUTED)
    assert (proof.order, proof.convergence_order) == (eta + 1, eta)
    if eta < claimed:
        assert f"claims order {claimed}" in proof.reason
        assert f"up to h^{eta} only" in proof.reason
    elif area:
        assert "claims det J ≡ 1" in proof.reason
        assert f"order {eta + 1}" in proof.reason


numbers = st.sampled_from([Fraction(x) for x in ("0", "1", "1/2", "1/3", "2/3", "-1")])


@few
@given(st.lists(numbers, min_size=3, max_size=3), numbers, numbers, st.booleans())
def test_an_explicit_runge_kutta_method_has_the_order_of_its_conditions(
    entries: list[Fraction], first: Fraction, second: Fraction, separable: bool
) -> None:
    """Two stages, or three: Σ b = 1, Σ b c = 1/2, Σ b c² = 1/3, Σ b a c = 1/6."""
    a21, a31, a32 = entries
    weights = (first, second, 1 - first - second)
    generic = RungeKutta(((), (a21,), (a31, a32)), weights)
    nodes = (Fraction(0), a21, a31 + a32)
    proof = proof_of(generic, 1, separable=separable)
    order = 1
    if sum(b * c for b, c in zip(weights, nodes, strict=True)) == Fraction(1, 2):
        squares = sum(b * c * c for b, c in zip(weights, nodes, strict=True))
        nested = weights[2] * a32 * a21
        order = 2 + (squares == Fraction(1, 3) and nested == Fraction(1, 6))
    assert proof.convergence_order == order
    assert proof.order is None or proof.order > order
    assert proof.formula == ""
    # Its ΔJ for one H begins no sooner.
    if proof.order is not None:
        jets = Jets(proof.order + 2, separable=separable)
        found = list(delta_j(jets, *generic.taylor(jets, proof.order)))
        assert [x == 0 for x in found] == [True] * (proof.order - 1) + [False]


shares = st.sampled_from([Fraction(x) for x in ("0", "1/2", "1", "1/3")])
stages = st.builds(Stage, st.just(Fraction(1)), st.just(Fraction(1)), shares, shares)


@few
@given(stages, st.integers(1, 2), st.booleans())
def test_a_stage_preserves_area_where_its_shares_add_up_to_1(
    stage: Stage, claimed: int, separable: bool
) -> None:
    proof = proof_of(StageEquations((stage,)), claimed, separable=separable)
    order = 2 if stage.at_p == stage.at_q == Fraction(1, 2) else 1
    assert proof.convergence_order == order
    if order < claimed:
        assert proof.verdict is Verdict.REFUTED
        assert f"up to h^{order} only" in proof.reason
        return
    preserved = stage.at_p + stage.at_q == 1
    assert proof.verdict is Verdict.PROVED
    assert proof.area_preserving == preserved
    assert (proof.order is None) == preserved
    if preserved:
        assert "A J = B with det A = det B" in proof.checked[0]


@few
@given(st.sampled_from(["gauss4", "gauss6"]), rationals(4), st.booleans())
def test_a_tableau_with_one_weight_changed_is_refuted_and_preserves_area_no_more(
    name: str, change: Fraction, separable: bool
) -> None:
    own = getattr(get(name).every_h, "tableau", None)
    assert own is not None
    weights = (own.weights[0] + sympy.Rational(str(change)), *own.weights[1:])
    wrong = TreeConditions(type(own)(own.rows, weights))
    proof = proof_of(wrong, get(name).order, area=True, separable=separable)
    assert proof.convergence_order == 0
    assert proof.area_preserving is None
    assert proof.verdict is not Verdict.PROVED
    assert prove_by_conditions(replace(get(name), every_h=wrong), wrong).verdict is Verdict.REFUTED


@few
@given(st.sampled_from(["lie1", "lie2", "lie3", "rk4", "explicit-midpoint"]), st.booleans())
def test_a_counterexample_is_an_h_for_which_area_is_changed(name: str, separable: bool) -> None:
    scheme = get(name)
    found = counterexample(scheme, separable)
    assert found is not None
    text, order = found
    proof = prove(scheme.step_map(Hamiltonian.parse(text)))
    assert (proof.order, proof.area_preserving) == (order, False)
    if separable:
        assert sympy.expand(plain(text).diff(P, Q)) == 0


@pytest.mark.parametrize("name", ["stormer-verlet", "ruth3", "implicit-midpoint", "gauss4"])
def test_what_preserves_area_has_no_counterexample(name: str) -> None:
    assert counterexample(get(name), False) is None


@few
@given(rationals(), rationals(), st.sampled_from(["q", "p", "h", "q**2", "sin(p)"]))
def test_a_users_formulas_are_the_map_that_they_write(a: Fraction, b: Fraction, inner: str) -> None:
    one, other = f"p - ({a})*h*{inner}", f"q + h*({b})*p_next"
    scheme = get(f" p_next ={one} ;q_next= {other};")
    assert scheme.name == f"p_next = {one}; q_next = {other}"
    assert (scheme.order, scheme.area_preserving, scheme.explicit, scheme.symmetric) == (
        1,
        False,
        True,
        False,
    )
    step_map = scheme.step_map(Hamiltonian.parse("p**2/2"))
    assert sympy.expand(step_map.p_next - plain(one)) == 0
    assert sympy.expand(step_map.q_next - Q - H * sympy.Rational(str(b)) * plain(one)) == 0
    for bad in (
        f"p_next = {one}",
        f"p_next = {one}; p_next = {one}; q_next = q",
        f"x = {one}; q_next = q",
    ):
        with pytest.raises(InputError, match="write it as"):
            get(bad)
    with pytest.raises(InputError, match="given for one H"):
        prove_for_every_h(scheme.name)


def test_the_schemes_are_named() -> None:
    known = names()
    assert len(set(known)) == len(known) >= 20
    assert all(get(n) is get(n) for n in known)
    with pytest.raises(InputError, match="lie1, lie2"):
        get("none")
    with pytest.raises(InputError, match="not a name"):
        get(3)  # type: ignore[arg-type]
