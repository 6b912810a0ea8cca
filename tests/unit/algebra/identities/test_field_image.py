"""What an element is translated to has its value, at points; else a zero of one were no zero."""

from fractions import Fraction

import pytest

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.formula import parse
from verify.algebra.identities.field import Point
from verify.algebra.identities.field_image import translate_element
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision

TEXTS = [
    "sin(q)", "cos(q)", "sin(-q) + cos(-3*q)", "sin(q) + sin(2*q)*cos(3*q)", "cos(q + p)*sin(3*q)",
    "sin(q - 2*p)*cos(p - q)", "sin(q/2)*cos(q/3) - sin(5*q/6)", "sin(q + pi/7)*sin(3*q - 2*pi/5)",
    "cos(2*pi/7)*q + sin(pi/9)", "sin(q)/cos(2*q)", "sinh(q) + cosh(2*q)*sinh(-3*q)",
    "exp(q)*sinh(2*q) - exp(-3*q/2)", "log(2 + q**2)*sin(q)", "log(6*q**2)", "log(q)*log(p*q)",
    "sqrt(1 + sin(q)**2)*cos(3*q)", "sqrt(2*q)*sqrt(3*p)*(p*q)**(1/3)", "sqrt(3 + 2*sqrt(2))*q",
    "atan(q)*sin(atan(q)) + cos(2*atan(q))", "sin(3*atan(p) - q)", "exp(q*log(3)) + exp(log(2)/3)",
    "1/(1 + exp(q)) - p/(2 + sin(q))**2", "atan(1/(2 + q)) + pi*q",
]  # fmt: skip
PLACES = [(Fraction(3, 7), Fraction(5, 4)), (Fraction(9, 4), Fraction(1, 6))]


@pytest.mark.parametrize("tangents", [False, True])
@pytest.mark.parametrize("text", TEXTS)
def test_a_translated_element_has_the_same_value(text: str, tangents: bool) -> None:
    ring, (x,) = embed([parse(text)], ["p", "q"])
    made = translate_element(ring.generators_in(x), x, tangents=tangents)
    for p, q in PLACES:
        value = enclose(ring, x, {"p": p, "q": q}, 300)
        assert value is not None
        with working_precision(300):
            names = {"p": rational_ball(p), "q": rational_ball(q)}
            found = Point(made.field, names).quotient(made.element)
            apart = abs(found - value)
            assert found.is_finite()
            assert apart < 1e-60 * (1 + abs(value)), f"{found.str(20)} is not {value.str(20)}"
