"""Identities that a ring's relations do not show, their false twins, and traps of branches."""

from collections.abc import Sequence
from fractions import Fraction

import pytest

from tests.helpers.sampled.formulas import evaluate, is_real, outcome
from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.formula import parse
from verify.algebra.ring import Decision
from verify.algebra.zero_test import clear_inverses
from verify.errors import InputError


def decide(text: str) -> Decision:
    expression = parse(text)
    ring, (x,) = embed([expression], sorted(map(str, expression.free_symbols)))
    return ring.decide(x)


TRUE: dict[str, Sequence[str]] = {
    "phases": [
        "sin(q+pi/3)+sin(q-pi/3)-sin(q)",
        "sqrt(2)*sin(q+pi/4)-sin(q)-cos(q)",
        "sin(q+2*pi/5)-sin(q)*cos(2*pi/5)-cos(q)*sin(2*pi/5)",
        "4*sin(q)*sin(pi/3-q)*sin(pi/3+q)-sin(3*q)",
        "tan(q+pi/4)-(1+tan(q))/(1-tan(q))",
        "sin(q+pi/7)*sin(q-pi/7)-sin(q)**2+sin(pi/7)**2",
        "2*sin(3*p-q+9*pi/5)*cos(q-5*pi/3)-sin(3*p+2*pi/15)-sin(3*p-2*q+52*pi/15)",
        "sin(pi*q+pi/3)+sin(pi*q-pi/3)-sin(pi*q)",
        "atan(sin(q+pi/3)+sin(q-pi/3))-atan(sin(q))",
        "sin(q+pi/997)-sin(q)*cos(pi/997)-cos(q)*sin(pi/997)",
    ],
    "parts of a turn": [
        "cos(2*pi/7)+cos(4*pi/7)+cos(6*pi/7)+1/2",
        "cos(pi/9)*cos(2*pi/9)*cos(4*pi/9)-1/8",
        "sin(pi/7)*sin(2*pi/7)*sin(3*pi/7)-sqrt(7)/8",
        "tan(3*pi/11)+4*sin(2*pi/11)-sqrt(11)",
        "exp(q*cos(pi/7))*exp(-q*cos(2*pi/7))*exp(q*cos(3*pi/7))-exp(q/2)",
    ],
    "logarithms": [
        "log(8)-3*log(2)",
        "log(6)-log(2)-log(3)",
        "log(1+q**2)-2*log(sqrt(1+q**2))",
        "log(q**2)-2*log(q)",
        "log(q**2)-2*log(-q)",
        "log(p*q)-log(p)-log(q)",
        "log(p*q)-log(-p)-log(-q)",
        "log(delta**2*q**2)-2*log(delta)-2*log(q)",
        "log(exp(q)+1)-log(exp(-q)+1)-q",
        "log(3+2*sqrt(2))-2*log(1+sqrt(2))",
        "log(q+sqrt(1+q**2))+log(sqrt(1+q**2)-q)",
        "log(1/cos(q)+tan(q))-log(tan(q/2+pi/4))",
        "log(1+cos(q))-log(2)-2*log(cos(q/2))",
        "log(100)/log(10)-2",
    ],
    "functions of logarithms": [
        "tanh(log(2))-3/5",
        "cosh(log(3)/2)-2/sqrt(3)",
        "sinh(log(1+sqrt(2)))-1",
        "sinh(log(q+sqrt(1+q**2)))-q",
        "exp(q*log(4))-exp(2*q*log(2))",
        "exp(log(2)*pi)-exp(pi*log(8)/3)",
        "tanh(q+log(2))-(tanh(q)+3/5)/(1+3*tanh(q)/5)",
    ],
    "roots": [
        "sqrt(4*p**2+4)-2*sqrt(p**2+1)",
        "sqrt(3+2*sqrt(2))-1-sqrt(2)",
        "sqrt(3-2*sqrt(2))-sqrt(2)+1",
        "(7+5*sqrt(2))**(1/3)-1-sqrt(2)",
        "(2**(1/3)-1)**(1/3)-(1/9)**(1/3)+(2/9)**(1/3)-(4/9)**(1/3)",
        "sqrt(5)+sqrt(22+2*sqrt(5))-sqrt(11+2*sqrt(29))-sqrt(16-2*sqrt(29)+2*sqrt(55-10*sqrt(29)))",
        "sqrt(q)*sqrt(p)-sqrt(p*q)",
        "sqrt(-q)*sqrt(-p)-sqrt(p*q)",
        "sqrt(q**2-1)-sqrt(1-q)*sqrt(-1-q)",
        "sqrt(3+q**2+2*sqrt(2+2*q**2))-sqrt(2)-sqrt(1+q**2)",
    ],
    "roots of even powers": [
        "sqrt(1+sinh(q)**2)-cosh(q)",
        "sqrt(p**4+2*p**2+1)-p**2-1",
        "sqrt(exp(2*q)+2+exp(-2*q))-2*cosh(q)",
        "sqrt(4+4*sin(q)+sin(q)**2)-2-sin(q)",
        "(9+18*sinh(q)**2+9*sinh(q)**4)**(1/4)-sqrt(3)*cosh(q)",
    ],
    "arctangents": [
        "4*atan(1/5)-atan(1/239)-pi/4",
        "atan(1/2)+atan(1/3)-pi/4",
        "atan(2)+atan(3)-3*pi/4",
        "44*atan(1/57)+7*atan(1/239)-12*atan(1/682)+24*atan(1/12943)-pi/4",
        "atan(sqrt(2))+atan(1/sqrt(2))-pi/2",
        "atan(exp(q))+atan(exp(-q))-pi/2",
        "atan(1/(q**2+q+1))-atan(q+1)+atan(q)",
        "sqrt(q)*(atan(q)+atan(1/q)-pi/2)",
        "sqrt(-q)*(atan(q)+atan(1/q)+pi/2)",
        "(2*atan(q)-atan(2*q/(1-q**2)))*sqrt(1-q)*sqrt(1+q)",
        "atan(sinh(q))-2*atan(tanh(q/2))",
        "sin(2*atan(q))-2*q/(1+q**2)",
    ],
}
IDENTITIES = [pytest.param(t, id=f"{k}: {t}") for k, texts in TRUE.items() for t in texts]


@pytest.mark.parametrize("text", IDENTITIES)
def test_an_identity_is_decided_zero(text: str) -> None:
    assert decide(text).zero is True


@pytest.mark.sample(20)
@pytest.mark.parametrize("text", IDENTITIES)
@pytest.mark.parametrize("slip", ["{} + 1/10**40", "({})*exp(pi) - 3/10**25*exp(-100)"])
def test_its_twin_is_not(text: str, slip: str) -> None:
    assert decide(slip.format(text)).zero is False


# Each is true on another part of where it is defined, or of another branch.
FALSE = [
    "atan(2)+atan(3)+pi/4",
    "atan(q)+atan(1/q)-pi/2",
    "sqrt(-q)*(atan(q)+atan(1/q)-pi/2)",
    "(atan(q)+atan(1/q)-pi/2)*log(q+100)",
    "atan(q/p)+atan(p/q)-pi/2",
    "2*atan(q)-atan(2*q/(1-q**2))",
    "(2*atan(q)-atan(2*q/(1-q**2)))*log(1-q)",
    "atan(q)+atan(p)-atan((p+q)/(1-p*q))",
    "atan(tan(q))-q",
    "atan(1/(q-25/7-1/10**9))+atan(q-25/7-1/10**9)-pi/2",
    "sqrt(3-2*sqrt(2))-1+sqrt(2)",
    "sqrt(1+cos(q)**2-2*cos(q)+q**2)-1+cos(q)",
    "log(sin(q)**2)-2*log(cos(q))",
    "log(2)*(1+1/10**40)-log(4)/2",
    "sqrt(2)*sin(q+pi/4+1/10**40)-sin(q)-cos(q)",
    "exp(pi*sqrt(163))-262537412640768744",
]


@pytest.mark.parametrize("text", FALSE)
def test_what_is_true_elsewhere_is_decided_not_zero_with_a_witness(text: str) -> None:
    decision = decide(text)
    assert decision.zero is False
    value = evaluate(parse(text), decision.witness or {"q": Fraction(1)})
    assert is_real(value)
    assert value != 0


# Defined nowhere, or at single points; out of reach; not zero by less than any point shows.
NOT_TRUE = [
    "sqrt(p)*sqrt(q)+sqrt(-p)*sqrt(-q)",
    "log(p*q)-log(-p)-log(q)",
    "sqrt(1-q)*sqrt(q-2)-sqrt(1-q)*sqrt(q-2)*2",
    "sqrt(sin(q)-2)-2*sqrt(sin(q)-2)",
    "cos(2*pi/7)+cos(4*pi/7)+cos(6*pi/7)+1/2-1/10**64/10**64/10**64/10**64/10**64/10**64",
    "sqrt(3+2*sqrt(2))-1-sqrt(2)-1/10**64/10**64/10**64/10**64/10**64/10**64",
]


@pytest.mark.parametrize("text", NOT_TRUE)
def test_what_is_not_shown_is_undecided(text: str) -> None:
    assert decide(text).zero is None


@pytest.mark.parametrize(
    "text",
    ["sqrt(sin(q)**2*(1+p)**2)", "sqrt(q**4-2*q**2+1)", "sqrt(1-sin(q)**2)", "sqrt(4*sinh(q)**2)",
     "(q**3+3*q**2+3*q+1)**(1/3)", "sqrt(-1-2*q**2-q**4)"],
)  # fmt: skip
def test_the_root_of_a_power_of_what_may_have_either_sign_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        decide(text)


@pytest.mark.parametrize(
    "text",
    ["1/(sin(q+pi/3)+sin(q-pi/3)-sin(q))", "log(sqrt(3+2*sqrt(2))-1-sqrt(2))",
     "q/(log(8)-3*log(2))", "1/(atan(1/2)+atan(1/3)-pi/4)"],
)  # fmt: skip
def test_a_division_by_a_hidden_zero_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="zero"):
        decide(text)


HOSTILE = [
    "sin(q+pi/9973)-sin(q)*cos(pi/9973)-cos(q)*sin(pi/9973)+log(8)-3*log(2)",
    "log((1+q**2)**60*(1+p**2)**60)-60*log(1+q**2)-60*log(1+p**2)",
    "(1+sqrt(2))**(1/64)*(sqrt(2)-1)**(1/64)-1",
    "+".join(f"atan(q/{n})" for n in range(2, 20)) + "-atan(q)*(log(4)-2*log(2))",
    "*".join(f"sqrt(q**2+{n})" for n in range(1, 14)) + "*(log(8)-3*log(2))",
]


@pytest.mark.left_to_ci
@pytest.mark.parametrize("text", HOSTILE)
def test_what_is_out_of_reach_ends_soon(text: str) -> None:
    assert outcome(lambda: decide(text)) == "done"


INVERSES = ["1/(1+q**2) + q", "p/(1+q**2)**3 - q/(1+q**2)", "1/(2+sin(q)) - 1/(1+q**2)**2 + p",
            "1/(1+exp(q))**2 + 1/(1+q**2) + 1/(3+p**2)",
            "q/(1+1/(1+q**2))**2 - 1/(1+q**2)"]  # fmt: skip


@pytest.mark.parametrize("text", INVERSES)
def test_what_is_cleared_of_denominators_is_the_element_times_powers_of_them(text: str) -> None:
    """At points: the quotient of the two is a product of powers of what was divided by."""
    expression = parse(text)
    ring, (x,) = embed([expression], ["p", "q"])
    cleared = clear_inverses(ring, x)
    assert not cleared.is_zero()
    denominators = [g.inner for g in ring.generators if g.kind == "inverse"]
    for p, q in ((Fraction(1, 3), Fraction(2, 7)), (Fraction(-2), Fraction(5, 3))):
        point = {"p": p, "q": q}
        values = [enclose(ring, y, point, 128) for y in (cleared, x, *denominators)]
        assert all(value is not None for value in values)
        above, below, *factors = [float(value) for value in values if value is not None]
        # Each denominator is there as often as it was divided by: no more than six times.
        reached = {1.0}
        for factor in factors:
            reached = {y * factor**k for y in reached for k in range(7)}
        assert any(abs(above / below / y - 1) < 1e-9 for y in reached)
