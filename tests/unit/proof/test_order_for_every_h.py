"""Proofs for every H: orders, coefficients, telescoping; each beside what it must refuse.

The oracles: sympy's derivatives of one H put in for the jets, and coefficients from the literature.
"""

import math
from fractions import Fraction

import pytest
import sympy

from tests.helpers.lie_derivatives import along_flow, lie_derivatives
from tests.helpers.sampled.formulas import P, Q, plain
from verify import schemes
from verify.algebra.jets import Jets
from verify.algebra.power_series import Derivatives, Series, expand_at
from verify.errors import InputError
from verify.exploration.properties.plane.order_by_jets import delta_j
from verify.hamiltonians.canonical_field import JetField
from verify.proof import order_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.proof_for_every_h import STEPS
from verify.proof.telescoping import potential_of_lie, telescopes
from verify.prose import read_prose
from verify.schemes.conditions.every_hamiltonian import (
    RungeKutta,
    Stage,
    StageEquations,
    TaylorSeries,
)
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

HALF, ONE, NONE = Fraction(1, 2), Fraction(1), Fraction(0)
RK4 = RungeKutta(
    ((), (HALF,), (NONE, HALF), (NONE, NONE, ONE)),
    (Fraction(1, 6), Fraction(1, 3), Fraction(1, 3), Fraction(1, 6)),
)
MIDPOINT = StageEquations((Stage(ONE, ONE, HALF, HALF),))
IMPLICIT_EULER = StageEquations((Stage(ONE, ONE, ONE, NONE),))
VERLET = StageEquations((Stage(HALF, NONE), Stage(NONE, ONE), Stage(HALF, NONE)), separable=True)


def made(generic: object, order: int, area_preserving: bool = False) -> Scheme:
    return Scheme(
        name="made", order=order, area_preserving=area_preserving, explicit=True, symmetric=False,
        source="this test", build=lambda _: None, every_h=generic,
    )  # fmt: skip


@pytest.fixture
def prove_made(monkeypatch: pytest.MonkeyPatch):
    def prove(generic: object, order: int, area_preserving: bool = False, separable: bool = False):
        monkeypatch.setattr(
            order_for_every_h, "get", lambda _: made(generic, order, area_preserving)
        )
        return prove_for_every_h("made", separable)

    return prove


def at(jets: Jets, x: object, hamiltonian: sympy.Expr) -> sympy.Expr:
    """A polynomial in the jets for one H, by sympy's derivatives."""
    put = {"p": P, "q": Q}
    put |= {
        jets.context.names()[k + 2]: sympy.diff(hamiltonian, P, i, Q, j)
        for k, (i, j) in enumerate(jets.indices)
    }
    terms = (
        sympy.Rational(str(c))
        * sympy.prod(put[jets.context.names()[k]] ** int(n) for k, n in enumerate(m))
        for m, c in x.to_dict().items()
    )
    return sympy.expand(sum(terms, sympy.S.Zero))


def along(y: sympy.Expr, hamiltonian: sympy.Expr) -> sympy.Expr:
    h_p, h_q = hamiltonian.diff(P), hamiltonian.diff(Q)
    return sympy.expand(h_p * y.diff(Q) - h_q * y.diff(P))


# -- jets -----------------------------------------------------------------------------------------

CUBIC = plain("p**3*q/3 + p*q**2 - 2*q**4 + p**2*q**2/5")
SEPARABLE = plain("p**3/3 + p**2/2 - 2*q**4 + q")


@pytest.mark.left_to_ci
def test_derivatives_along_the_flow_are_those_of_any_hamiltonian() -> None:
    jets = Jets(5)
    for name, y in (("p", P), ("q", Q)):
        for x in lie_derivatives(jets, name, 4):
            assert at(jets, x, CUBIC) == sympy.expand(y)
            y = along(y, CUBIC)


def test_a_separable_hamiltonian_has_no_mixed_derivatives() -> None:
    jets = Jets(4, separable=True)
    assert jets.h(1, 1) == 0
    for x, y in zip(lie_derivatives(jets, "p", 3), lie_derivatives(Jets(4), "p", 3), strict=True):
        assert at(jets, x, SEPARABLE) == at(Jets(4), y, SEPARABLE)


def test_a_derivative_beyond_those_there_are_is_refused() -> None:
    with pytest.raises(OverflowError):
        lie_derivatives(Jets(2), "p", 3)


def test_a_shifted_derivative_is_taylors_formula() -> None:
    jets = Jets(6)
    dp = [jets.zero, jets.one, 2 * jets.one, jets.zero]
    dq = [jets.zero, -3 * jets.one, jets.zero, jets.one]
    h = sympy.Symbol("h")
    moved = CUBIC.diff(P).subs({P: P + h + 2 * h**2, Q: Q - 3 * h + h**3}, simultaneous=True)
    expected = sympy.Poly(sympy.expand(moved), h).all_coeffs()[::-1]
    moves = [(name, Series.from_coefficients(jets, x, 3)) for name, x in (("p", dp), ("q", dq))]
    for n, x in enumerate(expand_at(Derivatives(jets, jets.h(1, 0)), moves, 3).coefficients):
        assert at(jets, x, CUBIC) == sympy.expand(expected[n])


# -- the Lie-derivative scheme --------------------------------------------------------------------


@pytest.mark.parametrize("eta", range(1, 11))
def test_lie_has_order_eta_plus_one_for_every_hamiltonian(eta: int) -> None:
    proof = prove_for_every_h(f"lie{eta}")
    assert (proof.verdict, proof.order, proof.convergence_order) == (
        Verdict.PROVED, eta + 1, eta,
    )  # fmt: skip
    assert proof.formula == f"-div(X^{eta} f)/{eta + 1}!, f = (-H_q, H_p)"
    assert proof.telescopes is (eta % 2 == 0)
    assert (proof.potential is not None) is proof.telescopes


def test_lie2_has_the_potential_of_half_the_hessian() -> None:
    assert prove_for_every_h("lie2").potential == "-1/2*H_pq**2 + 1/2*H_pp*H_qq"


@pytest.mark.sample(3)
@pytest.mark.parametrize("eta", [1, 2, 3, 4])
def test_the_leading_coefficient_is_that_of_one_hamiltonian(eta: int) -> None:
    """By sympy: the map of one H, its Jacobian, its determinant."""
    h = sympy.Symbol("h")
    p_next, q_next, p, q = P, Q, P, Q
    for n in range(1, eta + 1):
        p, q = along(p, CUBIC), along(q, CUBIC)
        p_next += h**n * p / math.factorial(n)
        q_next += h**n * q / math.factorial(n)
    det = p_next.diff(P) * q_next.diff(Q) - p_next.diff(Q) * q_next.diff(P)
    expected = sympy.expand(det).coeff(h, eta + 1)
    jets = Jets(eta + 3)
    leading = list(delta_j(jets, *TaylorSeries(eta).taylor(jets, eta + 1)))[-1]
    assert at(jets, leading, CUBIC) == expected


def test_claims_that_are_wrong_by_one_or_by_a_sign_are_refuted(prove_made) -> None:
    assert prove_made(TaylorSeries(3), 4).verdict is Verdict.REFUTED
    assert prove_made(TaylorSeries(3), 3, area_preserving=True).verdict is Verdict.REFUTED

    class Wrong(TaylorSeries):
        def taylor(self, jets, most):
            p, q = super().taylor(jets, most)
            return [*p[:2], -p[2], *p[3:]], q

    proof = prove_made(Wrong(3), 3)
    assert (proof.verdict, proof.convergence_order, proof.order) == (Verdict.REFUTED, 1, 2)
    assert proof.formula == ""


# -- telescoping ----------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", range(1, 8))
def test_linear_algebra_finds_what_the_formula_says(eta: int) -> None:
    jets = Jets(eta + 2)
    leading = list(delta_j(jets, *TaylorSeries(eta).taylor(jets, eta + 1)))[-1]
    found = telescopes(jets, leading)
    assert found.holds is (eta % 2 == 0)
    if found.holds:
        by_formula = potential_of_lie(JetField.from_jets(jets), eta).divergence
        assert along_flow(jets, found.potential) == leading == along_flow(jets, by_formula)


def test_one_coefficient_more_no_longer_telescopes() -> None:
    jets = Jets(5)
    leading = list(delta_j(jets, *TaylorSeries(2).taylor(jets, 3)))[-1]
    changed = leading + jets.h(1, 0) * jets.h(2, 0) * jets.h(0, 3)
    found = telescopes(jets, changed)
    assert not found.holds
    assert "dimension" in found.reason
    assert along_flow(jets, potential_of_lie(JetField.from_jets(jets), 2).divergence) != changed


def test_a_hidden_derivative_is_found() -> None:
    jets = Jets(6)
    hidden = jets.h(2, 0) * jets.h(1, 2) ** 2 - 3 * jets.h(0, 3) * jets.h(2, 1) * jets.h(2, 0)
    hidden += jets.h(1, 0) ** 2 * jets.h(0, 2)
    assert telescopes(jets, along_flow(jets, hidden)).holds


def test_odd_schemes_have_no_potential_formula() -> None:
    with pytest.raises(ValueError, match="odd"):
        potential_of_lie(JetField.from_jets(Jets(4)), 1)


# -- other schemes --------------------------------------------------------------------------------


@pytest.mark.parametrize(("generic", "order"), [(MIDPOINT, 2), (IMPLICIT_EULER, 1), (VERLET, 2)])
def test_symplectic_schemes_preserve_area_for_every_hamiltonian(prove_made, generic, order) -> None:
    proof = prove_made(generic, order, area_preserving=True)
    assert (proof.verdict, proof.order, proof.area_preserving, proof.convergence_order) == (
        Verdict.PROVED, None, True, order,
    )  # fmt: skip
    jets = Jets(order + 4, separable=generic.separable)
    assert all(x == 0 for x in delta_j(jets, *generic.taylor(jets, order + 2)))
    assert prove_made(generic, order + 1, area_preserving=True).verdict is Verdict.REFUTED


@pytest.mark.parametrize(
    "stage",
    [Stage(ONE, ONE, NONE, NONE), Stage(ONE, ONE, ONE, ONE), Stage(ONE, ONE, Fraction(1, 3), HALF),
     Stage(ONE, HALF, ONE, NONE)],
)  # fmt: skip
def test_a_stage_that_does_not_preserve_area_is_seen(prove_made, stage: Stage) -> None:
    left, right = StageEquations((stage,)).determinants()[0]
    assert left != right
    proof = prove_made(StageEquations((stage,)), 1, area_preserving=True)
    assert proof.verdict is Verdict.REFUTED
    assert proof.order is not None or proof.convergence_order < 1


def test_symplectic_euler_is_explicit_and_area_preserving_for_separable_h() -> None:
    proof = prove_for_every_h("symplectic-euler")
    assert (proof.verdict, proof.separable) == (Verdict.PROVED, True)
    assert "T(p)" in proof.quantifier


def test_the_runge_kutta_scheme_has_order_four_and_its_area_five(prove_made) -> None:
    proof = prove_made(RK4, 4)
    assert (proof.verdict, proof.convergence_order, proof.order) == (Verdict.PROVED, 4, 5)
    assert proof.telescopes is False
    first, second, *others = RK4.weights
    wrong = RungeKutta(RK4.rows, (second, first, *others))
    assert prove_made(wrong, 4).verdict is Verdict.REFUTED


def test_explicit_euler_is_lie1(prove_made) -> None:
    euler = prove_made(RungeKutta(((),), (ONE,)), 1)
    assert (euler.order, euler.leading) == (2, prove_for_every_h("lie1").leading)


def test_an_order_whose_polynomials_are_too_long_is_refused_at_once() -> None:
    with pytest.raises(InputError, match="order 14 at most"):
        prove_for_every_h("lie100")


def test_a_users_own_map_is_known_for_one_hamiltonian_only() -> None:
    with pytest.raises(InputError, match="one H"):
        prove_for_every_h("p_next = p - h*q; q_next = q + h*p_next")


def test_all_named_schemes_hold_what_they_claim_for_every_hamiltonian() -> None:
    for name in schemes.names():
        if schemes.get(name).every_h is not None:
            assert prove_for_every_h(name).verdict is Verdict.PROVED, name


def test_the_argument_for_every_eta_is_told_whole_and_of_taylors_schemes_in_the_plane_alone() -> (
    None
):
    told = str(prove_for_every_h("lie2").argument)
    assert told.startswith("The exact flow has det 1: the coefficients of h, h², … in the ")
    assert told.endswith(" there, η = 2j + 1. ∎")
    assert told.count("∎") == 1
    places = [told.find(str(read_prose(text))) for text, _ in STEPS]
    assert places == sorted(places)
    assert places[0] == 0
    others = (
        prove_for_every_h("rk4"),
        prove_for_every_h("lie2", timed=True),
        prove_for_every_h("lie2", degrees=2),
    )
    assert not any(str(proof.argument) for proof in others)
