"""The tape's derivatives and Taylor coefficients, against sympy's own."""

from fractions import Fraction

import flint
import pytest
import sympy

from verify.reference.check.tape import FormulaTape, NotReadError
from verify.reference.check.taylor import TapeExpansion

P, Q, T = sympy.symbols("p q t")
FORMULAS = [
    "p**2/2 + q**2/2 + a*q**4/4",
    "p**2/2 - cos(q)",
    "4*(1/q**12 - 1/q**6) - 3",
    "(1 - exp(-a*q))**2 + sqrt(1 + p**2)",
    "sin(p*q)*cosh(q) + log(1 + q**2)",
    "tanh(q) + tan(p/3) + atan(p*q) + sinh(p)",
    "asinh(q*p)**2 + asinh(-p)",
    "(1 + q**2)**(2/3) - -p**3 + pi*q",
    "p**5*q**3/(1 + p**2)",
]
A = Fraction(7, 3)
AT = Fraction(1, 3), Fraction(5, 4)


def theirs(formula: str) -> sympy.Expr:
    return sympy.sympify(formula, rational=True).subs("a", sympy.Rational(7, 3))


def rational(x: Fraction) -> sympy.Rational:
    return sympy.Rational(x.numerator, x.denominator)


@pytest.mark.parametrize("formula", FORMULAS)
def test_values_and_derivatives_are_those_of_sympy(formula: str) -> None:
    tape, expression = FormulaTape({"a": A}), theirs(formula)
    h = tape.read(formula)
    nodes = {(): h, ("p",): tape.diff(h, "p"), ("q",): tape.diff(h, "q")}
    nodes["p", "q"] = tape.diff(nodes["p",], "q")
    nodes["q", "q"] = tape.diff(nodes["q",], "q")
    known = TapeExpansion(tape, list(nodes.values()))
    with flint.ctx.workprec(200):
        known.begin([*(flint.arb(flint.fmpq(x.numerator, x.denominator)) for x in AT), 0])
        for names, node in nodes.items():
            derivative = sympy.diff(expression, *names) if names else expression
            exact = derivative.subs({P: rational(AT[0]), Q: rational(AT[1])}).evalf(60)
            assert known.value(node).overlaps(flint.arb(f"{exact} +/- 1e-50")), names


@pytest.mark.sample(5)
@pytest.mark.parametrize("formula", FORMULAS)
def test_taylor_coefficients_are_those_of_sympy(formula: str) -> None:
    tape = FormulaTape({"a": A})
    h = tape.read(formula)
    known = TapeExpansion(tape, [h])
    p, q = (rational(AT[0]) + 2 * T - T**2), (rational(AT[1]) - T / 3 + T**3)
    along = theirs(formula).subs({P: p, Q: q}, simultaneous=True)
    with flint.ctx.workprec(200):
        ps = [flint.arb(x) for x in (flint.fmpq(1, 3), 2, -1, 0)]
        qs = [flint.arb(x) for x in (flint.fmpq(5, 4), flint.fmpq(-1, 3), 0, 1)]
        known.begin([ps[0], qs[0], 0])
        for k in range(1, 4):
            known.extend([ps[k], qs[k]])
        for k in range(4):
            exact = (sympy.diff(along, T, k) / sympy.factorial(k)).subs(T, 0).evalf(60)
            assert known.c[h][k].overlaps(flint.arb(f"{exact} +/- 1e-45")), k


@pytest.mark.parametrize("formula", ["p +", "__import__('os')", "b*q", "p.real", "q**p", "f(q)"])
def test_what_is_not_known_is_named(formula: str) -> None:
    with pytest.raises(NotReadError):
        FormulaTape({"a": A}).read(formula)
