"""Proofs for every H: orders, coefficients, telescoping; each beside what it must refuse.

The oracles: sympy's derivatives of one H put in for the jets, and coefficients from the literature.
"""

import math
from fractions import Fraction
from itertools import product

import pytest
import sympy

from tests.helpers.jets_of_one_h import along, at, at_place, value_at_place
from tests.helpers.sampled.formulas import P, Q, plain
from verify import schemes
from verify.algebra.jets import Jets, JetsInDegrees
from verify.errors import InputError, LimitError
from verify.exploration.properties.plane.order_by_jets import delta_j
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof import order_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes import get
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


CUBIC = plain("p**3*q/3 + p*q**2 - 2*q**4 + p**2*q**2/5")


# -- the Lie-derivative scheme --------------------------------------------------------------------


FORMULAS = {
    1: "-div(X^{eta} f)/{next}!, f = (-H_q, H_p)",
    2: "−1/{next}! Σ_i (d(X^{next} p_i)∧dq_i + dp_i∧d(X^{next} q_i))",
}
CHECKED = {
    1: ("are the zero polynomial", "X·G is that coefficient"),
    2: ("are zero polynomials", "the Lie derivative of β is that coefficient"),
}


@pytest.mark.parametrize(
    ("eta", "degrees"), [*((eta, 1) for eta in range(1, 11)), (4, 2), (3, 2), (2, 3)]
)
def test_lie_has_order_eta_plus_one_and_telescopes_for_even_eta(eta: int, degrees: int) -> None:
    proof, is_even = prove_for_every_h(f"lie{eta}", degrees=degrees), eta % 2 == 0
    assert (proof.verdict, proof.order, proof.convergence_order) == (
        Verdict.PROVED, eta + 1, eta,
    )  # fmt: skip
    assert proof.formula == FORMULAS[min(degrees, 2)].format(eta=eta, next=eta + 1)
    assert proof.telescopes is is_even
    assert (proof.potential is not None) is proof.telescopes
    (vanish, telescopes), said = CHECKED[min(degrees, 2)], " ".join(map(str, proof.checked))
    assert vanish in said
    assert (telescopes in said) is is_even
    assert proof.why


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


PAIR = "p1**2*q2 + (p2 + q1*p1)**3/3 + q1**2*q2**2*p2 + p1*p2*q1"
DRIVEN = "p1**2*q2*t + (p2 + q1*p1)**3/3 + q1**2*q2**2*t**2 + p1*p2*q1*t"
TRIPLE = "p1**2*q2*p3 + p2*q3**2 + q1*q2*p1*p3 + q3*p2**2"
CASES = [
    *((s, PAIR, False) for s in ("lie1", "lie2", "lie3", "rk4", "explicit-midpoint")),
    ("lie2", DRIVEN, True), ("explicit-midpoint", DRIVEN, True),
    ("lie1", TRIPLE, False), ("lie2", TRIPLE, False),
]  # fmt: skip


@pytest.mark.sample(2)
@pytest.mark.parametrize(("scheme", "formula", "timed"), CASES)
def test_the_leading_form_is_that_of_the_proof_for_one_hamiltonian(
    scheme: str, formula: str, timed: bool
) -> None:
    hamiltonian = Hamiltonian.parse(formula)
    every = prove_for_every_h(scheme, degrees=hamiltonian.degrees, timed=timed)
    one = prove(get(scheme).step_map(hamiltonian), get(scheme))
    assert (every.verdict, every.order, every.convergence_order) == (
        one.verdict, one.order, one.convergence_order)  # fmt: skip
    assert every.form is not None
    leading = one.first.form
    assert leading is not None
    jets, names = every.form.ring, [*hamiltonian.coordinates, *(["t"] if timed else [])]
    assert isinstance(jets, JetsInDegrees)
    for a, b in product(range(2), range(2, 4)):
        ours = at_place(jets, every.form.entry(a, b), hamiltonian.exact)
        theirs = value_at_place(leading.ring.expression(leading.entry(a, b)), names)
        assert ours == theirs


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


@pytest.mark.parametrize("degrees", [1, 4])
def test_a_splitting_that_claims_too_much_is_refuted(degrees: int) -> None:
    found = prove_for_every_h("kick 1/2; drift 1; kick 1/2; order 3", degrees=degrees)
    assert (found.verdict, found.convergence_order) == ("REFUTED", 2)


@pytest.mark.parametrize(
    ("scheme", "degrees", "words"),
    [
        ("lie100", 1, "order 14 at most"),
        ("p_next = p - h*q; q_next = q + h*p_next", 1, "one H"),
        ("p_next = p; q_next = q", 2, "in one degree of freedom only"),
        ("lie2", 0, "must be 1 … 64"),
        ("lie2", 65, "must be 1 … 64"),
        ("lie2", 20, "derivatives of H would be needed"),
        ("lie8", 3, "are too many for lie8"),
    ],
)
def test_what_cannot_be_proved_for_every_h_is_refused_at_once(
    scheme: str, degrees: int, words: str
) -> None:
    with pytest.raises((InputError, LimitError), match=words):
        prove_for_every_h(scheme, degrees=degrees)


@pytest.mark.sample(7)
@pytest.mark.parametrize("scheme", ["lie1", "lie2", "lie3", "lie4", "rk4", "gauss4", "ruth3",
                                    "implicit-midpoint", "blanes-moan4"])  # fmt: skip
def test_what_is_needed_in_the_plane_is_needed_in_more(scheme: str) -> None:
    plane, more = prove_for_every_h(scheme), prove_for_every_h(scheme, degrees=2)
    assert (more.verdict, more.order) == (plane.verdict, plane.order)
    assert more.symplectic == plane.area_preserving
    assert more.convergence_order == plane.convergence_order
    if scheme.startswith("lie"):
        assert more.telescopes == plane.telescopes


def test_all_named_schemes_hold_what_they_claim_for_every_hamiltonian() -> None:
    for name in schemes.names():
        if schemes.get(name).every_h is not None:
            assert prove_for_every_h(name).verdict is Verdict.PROVED, name
