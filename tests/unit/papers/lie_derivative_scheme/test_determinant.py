"""The Hamiltonians that lie2 preserves area for: planted errors, and the proofs for single H."""

import pytest
import sympy

from tests.helpers.planted.theorem_controls import refused
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.lie_derivative_scheme import classification, determinant, developables, families
from verify.proof.order_for_one_h import prove
from verify.schemes import get


def test_an_oscillator_whose_hessian_determinant_is_not_one_is_noticed() -> None:
    assert refused(determinant.determinant_of_the_examples(["harmonic"]))  # ω is a symbol: D = ω²


@pytest.mark.parametrize("formula", ["p**2/2 + q**3", "q**2/p", "(p**2 + q**2)**(2/3)", "p*q**2"])
def test_an_h_that_is_not_preserved_does_not_refute_the_sentence(formula: str) -> None:
    assert refused(determinant.determinant_of_every_h([formula]))


def test_an_h_whose_flow_the_scheme_is_does_not_refute_a_sentence_on_truncation_errors() -> None:
    assert refused(determinant.determinant_of_every_h(["p**2/2 + q"]))


@pytest.mark.parametrize(
    ("u", "rest"),
    [("a*p + b*q", "c*p**2"), ("a*p + b*q**3", "0"), ("p*q", "0"), ("p + q**2", "q")],
)
def test_families_that_are_none_are_not_taken_for_such(u: str, rest: str) -> None:
    assert not families.family("H", u, rest).holds


def test_the_classification_notices_a_flaw_in_its_equations() -> None:
    assert refused(classification.determinant_classification(flaw=1))
    assert not developables.Conic(1).exists().holds
    assert not developables.Conic(1).preserves_area().holds


@pytest.mark.parametrize(
    ("formula", "preserved"),
    [
        ("(2*p + 3*q)**3 + p", True),
        ("(p - q + (2*p + q)**2)**3", True),
        ("exp(p + q**2)", True),
        ("(2*p**2 + p*q + 3*q**2)**(3/4)", True),
        ("sin(p) + 5*q", True),
        ("(p**2 + q**2)**2", False),
        ("p**2*q**2", False),
        ("(p + q**2)**2 + q", False),
        ("(p + q**3)**2", False),
        ("exp(p)*exp(q**2)*exp(p*q)", False),
        ("exp(p) + exp(q)", False),
        ("p**2/2 + q**3/3 + p*q", False),
    ],
)
def test_the_classification_agrees_with_the_proof_for_one_h(formula: str, preserved: bool) -> None:
    found = prove(get("lie2").step_map(Hamiltonian.parse(formula)))
    assert found.area_preserving is preserved


def test_the_third_family_holds_at_a_point_with_k2_zero_too() -> None:
    """H = (q + x²/2)²/2 with x³ + 6qx = 6p: no power of a quadratic form, k₁ = 1, k₀ = k₂ = 0."""
    x, y, h = sympy.symbols("x y h")
    z = (x**3 * sympy.Rational(2, 3) + x * y, x**2 / 2 + y)  # ∇L, L = x⁴/6 + x²y/2 + y²/2
    jacobian = sympy.Matrix(z).jacobian([x, y])
    energy = (y + x**2) ** 2 / 2
    assert sympy.simplify(
        sympy.Matrix([[energy.diff(x), energy.diff(y)]]) * jacobian.inv()
    ) == sympy.Matrix([[x, y]])
    hessian = jacobian.inv()
    velocity = sympy.Matrix([-y, x])
    acceleration = velocity.jacobian([x, y]) * hessian * velocity
    after = sympy.Matrix(z) + h * velocity + h**2 / 2 * acceleration
    change = sympy.simplify(after.jacobian([x, y]).det() - jacobian.det())
    assert change == 0
    assert sympy.simplify(acceleration) == sympy.Matrix([-2 * x, -1])
