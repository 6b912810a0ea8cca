"""Zero decisions and derivatives in the differential ring."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint
import mpmath
import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import (
    ENTIRE,
    close,
    evaluate,
    formulas,
    is_real,
    outcome,
    points,
    polynomials,
)
from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.formula import parse
from verify.algebra.ring import Decision, Ring
from verify.errors import InputError

VARIABLES = ("p", "q", "h", "a", "b")


def element(text: str) -> tuple[Ring, Any]:
    ring, (x,) = embed([parse(text)], VARIABLES)
    return ring, x


def decide(text: str) -> Decision:
    ring, x = element(text)
    return ring.decide(x)


ZERO: dict[str, Sequence[str]] = {
    "polynomial": [
        "(p + q)**3 - p**3 - 3*p**2*q - 3*p*q**2 - q**3",
        "(q + 1)*(q - 1) - q**2 + 1",
        "(p + a)**2 - (p - a)**2 - 4*a*p",
    ],
    "rational": [
        "1/(q - 1) - 1/(q + 1) - 2/(q**2 - 1)",
        "(q**3 - 1)/(q - 1) - q**2 - q - 1",
        "1/(1 + 1/(1 + 1/q)) - (q + 1)/(2*q + 1)",
        "(a/p + p/a)*a*p - a**2 - p**2",
    ],
    "trigonometric": [
        "sin(q)**2 + cos(q)**2 - 1",
        "sin(p + q) - sin(p)*cos(q) - cos(p)*sin(q)",
        "cos(p - q) - cos(p)*cos(q) - sin(p)*sin(q)",
        "sin(3*q) - 3*sin(q) + 4*sin(q)**3",
        "sin(q/2)**2 - (1 - cos(q))/2",
        "sin(16*q) - 2*sin(8*q)*cos(8*q)",
        "tan(2*q)*(1 - tan(q)**2) - 2*tan(q)",
        "1 + tan(q)**2 - 1/cos(q)**2",
        "sin(a*q + p) - sin(a*q)*cos(p) - cos(a*q)*sin(p)",
        "tan(q)*tan(pi/2 - q) - 1",
        "sin(q + 1) - sin(q)*cos(1) - cos(q)*sin(1)",
    ],
    "hyperbolic": [
        "cosh(q)**2 - sinh(q)**2 - 1",
        "sinh(q) - (exp(q) - exp(-q))/2",
        "tanh(q) - (exp(2*q) - 1)/(exp(2*q) + 1)",
        "cosh(p + q) - cosh(p)*cosh(q) - sinh(p)*sinh(q)",
        "exp(q) - cosh(q) - sinh(q)",
        "1/(cosh(q) + sinh(q)) - exp(-q)",
    ],
    "exponential": [
        "exp(p + q) - exp(p)*exp(q)",
        "(exp(q) + 1)**2 - exp(2*q) - 2*exp(q) - 1",
        "(exp(q/2) + 1)*(exp(q/2) - 1) - exp(q) + 1",
        "1/(1 + exp(-q)) - exp(q)/(1 + exp(q))",
        "exp(q*log(2))*exp(-q*log(2)) - 1",
    ],
    "root": [
        "1/(sqrt(q) - 1) - (sqrt(q) + 1)/(q - 1)",
        "(sqrt(p + 1) + sqrt(q + 1))*(sqrt(p + 1) - sqrt(q + 1)) - p + q",
        "1/(sqrt(3) + sqrt(2)) - sqrt(3) + sqrt(2)",
        "sqrt((p + 1)*(q + 1)) - sqrt(p*q + p + q + 1)",
        "(1 + 2**(1/3))**3 - 3 - 3*2**(1/3) - 3*2**(2/3)",
        "((q + 1)**(1/4) + 1)**2 - sqrt(q + 1) - 2*(q + 1)**(1/4) - 1",
        "(q**(1/3) + q**(1/2))**2 - q**(2/3) - q - 2*q**(5/6)",
    ],
    "constant": [
        "sin(2) - 2*sin(1)*cos(1)",
        "cosh(1) + sinh(1) - exp(1)",
        "(pi + 1)**2 - pi**2 - 2*pi - 1",
        "4*cos(pi/5) - 1 - sqrt(5)",
    ],
    "nested": [
        "sin(sin(p + q)) - sin(sin(p)*cos(q) + cos(p)*sin(q))",
        "sinh(sinh(q))**2 - cosh(sinh(q))**2 + 1",
        "cos(sqrt(q))**2 + sin(sqrt(q))**2 - 1",
        "sin(cos(q)**2) - sin(1 - sin(q)**2)",
        "exp(1/q + p) - exp(1/q)*exp(p)",
        "log((q + 1)**2) - log(q**2 + 2*q + 1)",
        "atan((q + 1)**2) - atan(q**2 + 2*q + 1)",
        "sin(q + sin(q)) - sin(q)*cos(sin(q)) - cos(q)*sin(sin(q))",
        "exp(q + exp(q)) - exp(q)*exp(exp(q))",
    ],
}
IDENTITIES = [pytest.param(t, id=f"{k}: {t}") for k, texts in ZERO.items() for t in texts]


@pytest.mark.parametrize("text", IDENTITIES)
def test_an_identity_is_decided_zero(text: str) -> None:
    assert decide(text).zero is True


@pytest.mark.sample(60)
@pytest.mark.parametrize("text", IDENTITIES)
@pytest.mark.parametrize("slip", ["{} + q/10**30", "({}) + 1", "sin({}) + exp(-100)"])
def test_a_slip_in_an_identity_is_never_decided_zero(text: str, slip: str) -> None:
    assert decide(slip.format(text)).zero is False


NOT_ZERO = [
    "sin(q)**2 - cos(q)**2 - 1",  # a sign
    "sin(p + q) - sin(p)*cos(q) + cos(p)*sin(q)",
    "cosh(q)**2 + sinh(q)**2 - 1",
    "cos(p - q) - cos(p)*cos(q) + sin(p)*sin(q)",
    "sin(3*q) - 3*sin(q) + 3*sin(q)**3",  # a coefficient
    "tanh(q) - (exp(2*q) - 1)/(exp(2*q) + 2)",
    "(p + q)**3 - p**3 - 3*p**2*q - 2*p*q**2 - q**3",
    "1/(q - 1) - 1/(q + 1) - 3/(q**2 - 1)",
    "sin(q)**3 + cos(q)**2 - 1",  # an exponent
    "exp(2*q) - exp(q)**3",
    "(1 + 2**(1/3))**3 - 3 - 3*2**(1/3) - 3*2**(1/3)",
    "sqrt(q + 1)**3 - (q + 1)**2",
    "sin(q) - q + q**3/6 - q**5/120",  # close to zero, and not zero
    "exp(pi*sqrt(163)) - 262537412640768744",
    "exp(-1e6)*q",
    "cos(1e40)*q",
    "log(2) - 0.6931471805599453",
    "sin(log(p*q) - log(p) - log(q)) + exp(-100)",  # a generator that is zero itself
    "p*sqrt(q - 5)",  # defined far from the origin only
    "log(q - 100)",
    "sqrt(-p - 30)",
    "sqrt(q - 5)*sqrt(7 - q)",
    "log(log(q))",
    "sin(17*16*4*pi*q)",  # zero at many rational points
    "(17*q - 7)*(17*q + 7)*(272*q - 7)*(272*q + 7)*(68*q - 63)*(68*q + 63)",
]


@pytest.mark.parametrize("text", NOT_ZERO)
def test_what_is_no_identity_is_decided_not_zero_with_a_witness(text: str) -> None:
    decision = decide(text)
    assert decision.zero is False
    # The witness is for a reader: it must hold for the text itself, computed by other means.
    with mpmath.workdps(60):
        value = evaluate(parse(text), decision.witness or {"q": Fraction(1)})
        assert is_real(value)
        assert value != 0
        claimed = float(mpmath.mpf(decision.enclosure.strip("[] ").split(" ")[0]))
    assert float(value) == pytest.approx(claimed, rel=1e-9)


@pytest.mark.parametrize(
    "text",
    ["exp(q*sqrt(3 + 2*sqrt(2))) - exp(q)*exp(q*sqrt(2))",
     "sqrt(p*q)*(atan(p/q) + atan(q/p) - pi/2)"],
)  # fmt: skip
def test_an_identity_that_generators_hide_is_undecided(text: str) -> None:
    assert decide(text) == Decision(None)


@pytest.mark.parametrize("text", ["1/(1 + sqrt(q - 5))", "1/log(log(q))", "1/log(q - 100)"])
def test_a_denominator_defined_far_away_is_not_taken_for_zero(text: str) -> None:
    element(text)


@pytest.mark.parametrize(
    "text",
    [
        "1/(sin(q)**2 + cos(q)**2 - 1)",
        "p/((q + 1)**2 - q**2 - 2*q - 1)",
        "1/sqrt((q + 1)**2 - q**2 - 2*q - 1)",
        "log(cosh(q)**2 - sinh(q)**2 - 1)",
        "tan(q)/(tan(q) - sin(q)/cos(q))",
    ],
)
def test_a_hidden_division_by_zero_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="zero"):
        element(text)


HEAVY = "q*atan(p + q + cos(q))*(atan(q) - tan(p))"


def test_a_large_element_that_is_not_zero_is_decided_soon() -> None:
    def work() -> None:
        ring, x = element(f"({HEAVY})/atan(q)")
        for name in ("p", "q", "p", "q"):
            x = ring.diff(x, name)
        assert ring.decide(x).zero is False

    assert outcome(work) == "done"


quick = drawn(60)


def embedded(text: str) -> tuple[sympy.Expr, Ring, Any]:
    """Of drawn text, which may divide by zero: such a draw is thrown away."""
    try:
        expression = parse(text)
        ring, (x,) = embed([expression], VARIABLES)
    except InputError:
        assume(False)
    return expression, ring, x


@quick
@given(formulas(), points("p", "q", "a"), st.sampled_from(["p", "q"]))
def test_a_derivative_is_the_one_of_sympy_to_30_digits(
    text: str, point: dict[str, Fraction], name: str
) -> None:
    expression, ring, x = embedded(text)
    assume(is_real(evaluate(expression, point)))
    expected = evaluate(expression.diff(sympy.Symbol(name, real=True)), point)
    ours = evaluate(ring.expression(ring.diff(x, name)), point)
    assume(is_real(expected) and is_real(ours))
    assert close(ours, expected, 30)


@quick
@given(formulas(), points("p", "q", "a"))
def test_an_enclosure_contains_the_value(text: str, point: dict[str, Fraction]) -> None:
    expression, ring, x = embedded(text)
    value = evaluate(expression, point)
    ball = enclose(ring, x, {**point, "h": Fraction(1), "b": Fraction(1)}, 128)
    assume(is_real(value) and ball is not None)
    # What mpmath rounds, at 60 digits, is far below the ball's own radius or this margin.
    margin = flint.arb(0, 1e-35) * (1 + abs(ball))
    with mpmath.workdps(60), flint.ctx.workprec(256):
        assert (ball + margin).contains(flint.arb(mpmath.nstr(value, 60)))


def test_an_enclosure_around_zero_stays_tiny() -> None:
    ring, x = element("sin(log(2*q) - log(2) - log(q))")
    ball = enclose(ring, x, {"q": Fraction(1)}, 128)
    assert ball.contains(0)
    assert ball.rad() < 1e-30


IDENTICAL = {
    "square": "(({f}) + ({g}))**2 - ({f})**2 - 2*({f})*({g}) - ({g})**2",
    "distribution": "({f})*(({g}) + q) - ({f})*({g}) - q*({f})",
    "difference": "({f}) - ({g}) + (({g}) - ({f}))",
    "circle": "sin({f})**2 + cos({f})**2 - 1 + 0*({g})",
    "hyperbola": "cosh({f})**2 - sinh({f})**2 - 1 + 0*({g})",
}
shapes = st.sampled_from(sorted(IDENTICAL))


@quick
@given(shapes, formulas(leaves=3), formulas(leaves=3))
def test_a_drawn_identity_is_never_decided_not_zero(shape: str, f: str, g: str) -> None:
    _, ring, x = embedded(IDENTICAL[shape].format(f=f, g=g))
    assert ring.decide(x).zero is not False


@quick
@given(shapes, formulas(ENTIRE, 3, division=False), formulas(ENTIRE, 3, division=False))
def test_a_drawn_identity_of_entire_functions_is_decided_zero(shape: str, f: str, g: str) -> None:
    _, ring, x = embedded(IDENTICAL[shape].format(f=f, g=g))
    assert ring.decide(x).zero is True


@quick
@given(shapes, formulas(leaves=3), formulas(leaves=3), polynomials(degree=3, most_terms=2))
def test_a_drawn_identity_with_a_slip_is_never_decided_zero(
    shape: str, f: str, g: str, slip: str
) -> None:
    _, ring, x = embedded(f"{IDENTICAL[shape].format(f=f, g=g)} + ({slip})/10**40")
    assert ring.decide(x).zero is not True


@given(formulas(ENTIRE, 4, division=False))
@drawn(20)
def test_deciding_leaves_every_global_precision_as_it_was(text: str) -> None:
    before = flint.ctx.prec, mpmath.mp.prec
    _, ring, x = embedded(text)
    ring.decide(ring.diff(x, "q"))
    assert (flint.ctx.prec, mpmath.mp.prec) == before


POWERS = ["(p + 2*q - b)**3 + b", "a*b**2*sin(q)/(1 + q**2) + b - p", "0*b", "3"]
VANISHING_OR_NOT = ["q - q", "sin(q)**2 + cos(q)**2 - 1", "p*q/10**30", "sin(q) - q", "3"]


@pytest.mark.parametrize("text", POWERS)
def test_an_element_is_the_sum_of_its_powers_of_a_variable(text: str) -> None:
    ring, x = element(text)
    powers = ring.powers(x, "b")
    assert sum((ring.variable("b") ** n * part for n, part in powers.items()), ring.zero) == x
    assert all(part != 0 and not ring.depends(part, "b") for part in powers.values())


@pytest.mark.parametrize("text", VANISHING_OR_NOT)
def test_what_vanishes_is_decided_as_with_a_witness(text: str) -> None:
    ring, x = element(text)
    assert ring.vanishes(x) is ring.decide(x).zero
    assert ring.vanishes(x + ring.variable("q") / 10**30) is False


def test_a_polynomial_is_evaluated_exactly() -> None:
    ring, x = element("p**2*q/3 - a")
    ball = enclose(ring, x, {"p": Fraction(1, 2), "q": Fraction(3), "a": Fraction(1, 8)}, 64)
    assert ball == flint.arb(1) / 8
    assert ball.rad() == 0
    with pytest.raises(KeyError):
        enclose(ring, x, {"p": Fraction(1), "q": Fraction(1)}, 64)
