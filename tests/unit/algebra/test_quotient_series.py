"""The series of quotients of polynomials in h, and of functions of h times something, against
sympy's; and what has no such series."""

import pytest
import sympy

from verify import schemes
from verify.algebra.embedding import embed
from verify.algebra.formula import parse
from verify.algebra.power_series import QuotientSeries
from verify.algebra.symbols import H_STEP
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import TaylorExpansion

VARIABLES = ("p", "q", "h")


def series(formula: str, length: int) -> list[sympy.Expr] | None:
    ring, (x,) = embed([parse(formula, VARIABLES)], VARIABLES)
    found = QuotientSeries(ring, length).expand(x)
    return None if found is None else [ring.expression(c) for c in found.coefficients]


@pytest.mark.parametrize(
    "formula",
    [
        "p/(1 - h*q)",
        "(1 + h*p)/(2 + h**2*q)**2",
        "p/(1 + h*sin(q)) + q*h**3/(3 - h)",
        "1/(1 + h/(1 + h*p))",
        "h**5",
        "exp(h*p)",
        "sin(h*p)*cos(h*q) - sinh(h*q*p)",
        "q*sin(h*p + h**2*cos(h*q))/(1 + h*atan(h*p))",
        "sqrt(4 + h*p + h**2) - (8 + h*q)**(1/3)",
        "p/(1 + sqrt(1 + h*q*sqrt(9 + h*p)))",
        "tan(h*p) + tanh(h*q) + asinh(h)",
    ],
)
def test_the_series_is_the_one_that_sympy_finds(formula: str) -> None:
    found = series(formula, 6)
    assert found is not None
    h = sympy.Symbol("h")
    wanted = sympy.series(sympy.sympify(formula), h, 0, 6).removeO()
    for n, x in enumerate(found):
        again = sympy.sympify(str(x))
        assert sympy.simplify(again - sympy.expand(wanted).coeff(h, n)) == 0


@pytest.mark.parametrize(
    "formula",
    [
        "log(1 + h*p)",
        "cos(q + h*p)",
        "sqrt(2 + h)",
        "sqrt(q + h)",
        "sqrt(-4 + h)",
        "1/(h + p)",
        "1/(1 + h*p) + atan(q + h)",
    ],
)
def test_what_is_no_such_quotient_has_none(formula: str) -> None:
    assert series(formula, 4) is None


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("n", range(6))
def test_a_gauss_step_of_a_quadratic_h_has_the_coefficients_that_derivatives_give(n: int) -> None:
    step_map = schemes.get("gauss4").step_map(Hamiltonian.parse("2*p**2 - p*q + 3*q**2"))
    step = step_map.flat
    by_series = TaylorExpansion(step.ring, step.elements[0])
    ring, x = by_series.coefficient(n)
    assert ring is step.ring
    by_derivatives = sympy.diff(ring.expression(step.elements[0]), H_STEP, n) / sympy.factorial(n)
    assert sympy.simplify(by_derivatives.subs(H_STEP, 0) - ring.expression(x)) == 0
