"""What conditions on coefficients leave open: an H refutes it, or it stays open; no series lies."""

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from typing import ClassVar

import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.constructed.schemes import Made, conditions, made_of, proof_of
from tests.helpers.maps import by_expressions
from tests.helpers.sampled.formulas import H, P, Q, plain, rationals
from verify.algebra.jets import Jets, Series
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_conditions import prove_by_conditions
from verify.proof.order_for_every_h import counterexample
from verify.proof.order_for_one_h import prove
from verify.schemes import get
from verify.schemes.conditions.every_hamiltonian import StageEquations, TaylorSeries
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict

few = drawn(12)
bases = st.sampled_from(["euler", "explicit-midpoint", "lie2", "stormer-verlet"])


@cache
def changed(base: str, separable: bool) -> tuple[str, int] | None:
    """An H for which the scheme does not preserve area, if there is one, and the order of ΔJ."""
    found = counterexample(get(base), separable)
    if found is not None:
        proof = prove(get(base).step_map(Hamiltonian.parse(found[0])))
        assert (proof.order, proof.area_preserving) == (found[1], False)
    return found


@drawn(80)
@given(conditions, st.integers(1, 4), st.booleans(), bases)
def test_where_area_alone_is_open_an_h_refutes_it_or_it_stays_open(
    generic: Made, claimed: int, separable: bool, base: str
) -> None:
    proof = proof_of(generic, claimed, separable=separable, base=base)
    own = prove_by_conditions(made_of(generic, claimed, base=base), generic)
    assert (proof.conditions, proof.convergence_order) == (own.conditions, own.convergence_order)
    assert proof.separable == (separable or generic.separable)
    asked = [holds for n, holds in generic.of_order if n <= claimed]
    open_area = not all(generic.of_area) and all(asked)
    found = changed(base, separable or generic.separable)
    if own.verdict is Verdict.REFUTED and separable and not generic.separable:
        # What fails for some H may hold for every T(p) + V(q).
        assert proof.verdict is Verdict.UNDECIDED
        assert own.reason in proof.reason
        assert "of H = T(p) + V(q) alone nothing is said" in proof.reason
    elif open_area and found is not None:
        text, order = found
        assert (proof.verdict, proof.area_preserving) == (Verdict.REFUTED, False)
        assert f"of order {claimed}, but not det J ≡ 1" in proof.reason
        assert f"ΔJ has order {order} for H = {text}" in proof.reason
    else:
        assert (proof.verdict, proof.reason) == (own.verdict, own.reason)
        assert proof.area_preserving is own.area_preserving


@few
@given(conditions, st.integers(1, 4), st.integers(1, 2), st.booleans())
def test_where_no_h_refutes_it_the_series_is_asked(
    generic: Made, claimed: int, eta: int, area: bool
) -> None:
    """A truncated flow's series beside a step that preserves area, so that the series is seen."""

    @dataclass(frozen=True)
    class WithSeries(Made):
        kind: ClassVar[str] = "taylor-series"

        def taylor(self, jets: Jets, most: int) -> tuple[Series, Series]:
            return TaylorSeries(eta).taylor(jets, most)

    both = WithSeries(generic.of_order, generic.of_area, generic.most_order, generic.separable)
    own = prove_by_conditions(made_of(both, claimed), both)
    proof = proof_of(both, claimed, area, base="stormer-verlet")
    assert proof.conditions == own.conditions
    if own.verdict is not Verdict.UNDECIDED:
        assert (proof.verdict, proof.reason, proof.order) == (own.verdict, own.reason, None)
    else:
        right = eta >= claimed and not area
        assert proof.verdict is (Verdict.PROVED if right else Verdict.REFUTED)
        assert (proof.order, proof.convergence_order) == (eta + 1, eta)


@few
@given(st.booleans(), rationals(3))
def test_an_h_that_the_scheme_is_not_asked_about_refutes_nothing(
    separable: bool, size: Fraction
) -> None:
    """p' = p − h c H_q(p, q), q' = q + h H_p(p', q) preserves area for T(p) + V(q) alone."""

    def build(hamiltonian: Hamiltonian) -> StepMap:
        h = hamiltonian.exact
        p_next = P - H * sympy.Rational(str(size)) * h.diff(Q)
        return by_expressions(hamiltonian, p_next, Q + H * h.diff(P).subs(P, p_next))

    found = counterexample(replace(get("euler"), build=build), separable)
    assert (found is None) == separable
    assert found is None or sympy.expand(plain(found[0]).diff(P, Q)) != 0


sizes = st.sampled_from([Fraction(x) for x in ("1", "1/2", "-1", "1/3", "2", "3/2")])


@dataclass(frozen=True)
class SeriesAlone:
    """Stages of which the series alone is shown."""

    stages: StageEquations
    separable: bool = True
    kind: ClassVar[str] = "taylor-series"

    def taylor(self, jets: Jets, most: int) -> tuple[Series, Series]:
        return self.stages.taylor(jets, most)


@drawn(6)
@given(sizes, st.booleans(), st.integers(1, 2))
def test_a_delta_j_that_vanishes_as_far_as_it_is_looked_at_is_left_open(
    size: Fraction, area: bool, claimed: int
) -> None:
    """Kicks and drifts preserve area, but Taylor coefficients do not show that all vanish."""
    parts = [("kick", size), ("drift", Fraction(1)), ("kick", 1 - size)]
    shears = [(kind, sympy.Rational(x.numerator, x.denominator)) for kind, x in parts]
    proof = proof_of(SeriesAlone(StageEquations.from_shears(shears)), claimed, area)
    order = 2 if size == Fraction(1, 2) else 1
    assert (proof.order, proof.area_preserving, proof.convergence_order) == (None, None, order)
    assert proof.verdict is (Verdict.REFUTED if order < claimed else Verdict.UNDECIDED)
    if order < claimed:
        assert f"claims order {claimed}" in proof.reason
    else:
        assert f"up to h^{claimed + 5 - 1} vanish" in proof.reason
