"""“The value of the determinant cannot always be equal to 1”: for which H it is."""

import math
from collections.abc import Sequence

import sympy

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.symbols import H_STEP, P, Q
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import Argument, ArgumentTexts, Check, same
from verify.papers.elementary_identities import derivative_at_rest, derivative_of_the_field
from verify.papers.lie_derivative_scheme import families
from verify.papers.lie_derivative_scheme.examples import SYSTEMS, with_symbols
from verify.proof.order_for_one_h import convergence_of, prove
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

ETAS = range(1, 6)
# det J = 1 exactly, and the scheme is not the flow.
PRESERVED = ("p**3/6 + q", "(p**2 + q**2)**(3/4)", "(p*q)**(3/4)")
SINGULAR = "q**2/p"  # det Hess H = 0 everywhere, and still ΔJ ≠ 0


def determinant_of_the_examples(names: Sequence[str] = SYSTEMS) -> Argument:
    """Prove det J ≠ 1 for the paper's systems at equilibrium, for every η and almost every h."""
    at_rest = [_check_at_rest(name, eta) for name in names for eta in ETAS]
    return _TEXTS.proof(
        "determinant_of_the_examples",
        derivative_at_rest=derivative_at_rest(),
        derivative_of_the_field=derivative_of_the_field(),
        last_coefficients=_last_coefficients(),
        equilibrium=families.equilibrium(),
        at_rest=at_rest,
    )


def _last_coefficients(sign: int = -1) -> Check:
    """Check that the last coefficient of R(hμ) R(−hμ) is D^η/(η!)², μ² = −D, or `sign` D."""
    mu, h, d = sympy.symbols("mu h D")
    gaps = []
    for eta in ETAS:
        factors = [
            sum((s * h * mu) ** n / sympy.factorial(n) for n in range(eta + 1)) for s in (1, -1)
        ]
        top = sympy.expand(factors[0] * factors[1]).coeff(h, 2 * eta)
        # μ^(2η) is replaced as one power, by (−D)^η, or with another sign as a control.
        substituted = top.subs(mu, sympy.Symbol("x")).subs(
            sympy.Symbol("x") ** (2 * eta), (sign * d) ** eta
        )
        gaps.append(substituted - d**eta / sympy.factorial(eta) ** 2)
    statement = "the coefficient of `h^(2η)` in R(hμ) R(−hμ) less `D^η`/(η!)², η = 1 … 5"
    return same(statement, gaps, ("D",))


def _check_at_rest(name: str, eta: int) -> Check:
    """Check that ΔJ at (0, 0) is R(ih) R(−ih) − 1, all parameters symbols."""
    delta_j = sympy.expand(lie_map(with_symbols(name), eta).delta_j.subs({P: 0, Q: 0}))
    # R(z) R(−z) at z² = −h²
    z = sympy.Symbol("z")
    terms = [z**n / sympy.factorial(n) for n in range(eta + 1)]
    # R(z) R(−z) is a polynomial in z² alone, so that its value at z = ih is real.
    product = sympy.expand(sum(terms) * sum(t.subs(z, -z) for t in terms))
    expected = sympy.expand(product.subs(z, sympy.I * H_STEP)) - 1
    top = sympy.Poly(delta_j, H_STEP).coeff_monomial(H_STEP ** (2 * eta)) if delta_j != 0 else 0
    return Check(
        f"{name}, lie{eta}: ΔJ at (0, 0) is R(ih) R(−ih) − 1, its last coefficient 1/({eta}!)²",
        delta_j == expected and top == sympy.Rational(1, math.factorial(eta) ** 2),
        f"`{to_text(delta_j)}`",
    )


def determinant_of_every_h(formulas: Sequence[str] = PRESERVED) -> Argument:
    """Refute det J ≠ 1 for every H, by H with det J ≡ 1 and a truncation error."""
    triangular, *powers_of_forms = map(area_is_preserved, formulas)
    return _TEXTS.refutation(
        "determinant_of_every_h",
        triangular=triangular,
        spirals=_spirals(),
        powers_of_forms=powers_of_forms,
        coefficients=families.coefficients(),
        singular=_singular(),
        linear=families.linear(),
    )


def _spirals(power: int = 4) -> Check:
    """Check that a step of lie2 turning with Ω takes I to I (1 + (hΩ)^`power`/4)."""
    x, amount, h, k = sympy.symbols("x I h k")  # x = hΩ
    growth_gap = (1 - x**2 / 2) ** 2 + x**2 - (1 + x**power / 4)
    next_amount = amount * (1 + h**4 * (k / amount) / 4)  # Ω⁴ = k/I
    statement = "(1 − x²/2)² + x² − (1 + x⁴/4), x = hΩ; and d/dI [I (1 + h⁴Ω⁴/4)] − 1 for Ω⁴ = k/I"
    return same(
        statement,
        [growth_gap, sympy.diff(sympy.expand(next_amount), amount) - 1],
        ("x", "I", "h", "k"),
    )


def area_is_preserved(formula: str) -> Check:
    """Check ΔJ ≡ 0 in the ring, and that the map agrees with the flow exactly up to h²."""
    step_map = lie_map(Hamiltonian.parse(formula), 2)
    area_proof, agreement = prove(step_map), convergence_of(step_map)
    return Check(
        f"H = `{formula}`: det J ≡ 1, and the local error of lie2 is of order h³ exactly",
        area_proof.area_preserving is True and agreement.decided and agreement.order == 2,
        f"ΔJ = `{to_text(step_map.delta_j)}`, agrees with the flow up to `h^{agreement.order}`",
    )


def _singular() -> Check:
    hamiltonian = Hamiltonian.parse(SINGULAR)
    hessian = sympy.hessian(hamiltonian.expression, (P, Q)).det()
    area_proof = prove(lie_map(hamiltonian, 2))
    expected = -(H_STEP**4) * Q**4 / P**8
    return Check(
        f"H = `{SINGULAR}`: det Hess H = 0 and ΔJ is not 0",
        sympy.simplify(hessian) == 0 and area_proof.order == 4 and area_proof.delta_j == expected,
        f"ΔJ = `{to_text(area_proof.delta_j)}`",
    )
