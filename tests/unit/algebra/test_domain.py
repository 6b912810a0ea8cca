"""Where what is written is defined, against an evaluation of the text itself by mpmath."""

import ast
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
from hypothesis import assume, given

from tests.examples import drawn
from tests.helpers.sampled.formulas import formulas, points
from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.embedding import embed
from verify.algebra.formula import parse, read
from verify.errors import InputError


def domain(text: str) -> FormulaDomain:
    return FormulaDomain.from_requirements(read(text)[1])


@pytest.mark.parametrize(
    ("text", "asked"),
    [
        ("p**2/2 + a*q**4 - sin(p*q)", []),
        ("sqrt(q)**2*p", ["q >= 0"]),
        ("delta**2/delta*p", ["delta != 0"]),
        ("exp(log(q))", ["q > 0"]),
        ("0*log(p) + q/q", ["p > 0", "q != 0"]),
        ("1/(p*q)**2", ["p != 0", "q != 0"]),
        ("tan(q)", ["cos(q) != 0"]),
        ("(1 - q)**(-3/2)", ["1 - q > 0"]),
        ("log(-2*q)", ["q < 0"]),
        ("sqrt(-q**3)", ["q <= 0"]),
        ("log(q**2) + log(exp(p)*q**4)", ["q != 0"]),
        ("p/(3 - 3*q) + 1/(q - 1)", ["q - 1 != 0"]),
        ("sqrt(q)/q", ["q > 0"]),
        ("sqrt(p)*log(p)/p**(1/3)", ["p > 0"]),
        ("sqrt(q)*sqrt(-q)", ["q <= 0", "q >= 0"]),
        ("1/(1 + q**2) + sqrt(4*p**2 + 4)/exp(q) + log(1 + exp(q)) + 1/cosh(q)", []),
    ],
)
def test_what_is_written_asks_for_this(text: str, asked: list[str]) -> None:
    assert list(domain(text).texts) == asked


_STRICT: dict[str, Callable[[Any], Any]] = {
    name: getattr(mpmath, name) for name in ("sin", "cos", "tan", "exp", "sinh", "cosh", "tanh")
}


def _root(x: Any) -> Any:
    return mpmath.sqrt(x) if x >= 0 else _undefined()


def _log(x: Any) -> Any:
    return mpmath.log(x) if x > 0 else _undefined()


def _undefined() -> Any:
    raise ZeroDivisionError


def defined(text: str, point: dict[str, Fraction]) -> bool:
    """Whether every operation of the text is, one after another as it is written."""

    class Exact(ast.NodeTransformer):
        def visit_Constant(self, node: ast.Constant) -> ast.AST:
            return ast.Call(ast.Name("mpf", ast.Load()), [node], [])

    tree = ast.fix_missing_locations(Exact().visit(ast.parse(text, mode="eval")))
    names = {**_STRICT, "atan": mpmath.atan, "sqrt": _root, "log": _log, "mpf": mpmath.mpf}
    at = {name: mpmath.mpf(x.numerator) / x.denominator for name, x in point.items()}
    try:
        value = eval(compile(tree, "formula", "eval"), names, at)  # noqa: S307 - drawn text
    except (ZeroDivisionError, TypeError, ValueError, OverflowError):
        return False
    return mpmath.isfinite(value) and not isinstance(value, mpmath.mpc)


@given(text=formulas(), point=points("p", "q", "h", "a", "b", "delta", "omega"))
@drawn(300)
def test_a_formula_is_defined_exactly_in_its_domain(text: str, point: dict[str, Fraction]) -> None:
    assume("pi" not in text)  # tan(π) is not 0 in digits
    try:
        found = FormulaDomain.from_requirements(read(text, point)[1])
    except InputError:
        return
    inside = found.contains(point)
    with mpmath.workdps(30):
        assert inside is None or inside is defined(text, point)


def test_what_is_shown_outside_of_the_domain_refutes_nothing() -> None:
    ring, (zero, one, sign) = embed([parse(x) for x in ("0*q", "q - 3", "1 + 0*q")], ("q", "p"))
    right = domain("sqrt(q - 3)")
    assert right.decide(ring, zero).zero is True
    assert right.decide(ring, sign).zero is False
    found = right.decide(ring, one)
    assert found.zero is False
    assert found.witness["q"] > 3
    assert ring.decide(one).witness["q"] < 3  # the control: without the domain it is outside
    nowhere = domain("sqrt(q)*sqrt(-1 - q)")
    assert nowhere.decide(ring, zero).zero is None
    assert nowhere.decide(ring, sign).zero is None
    assert EVERYWHERE.decide(ring, zero).zero is True


def test_domains_meet_in_what_both_ask_for() -> None:
    both = domain("sqrt(q)") & domain("1/q + log(p)")
    assert both.texts == ("p > 0", "q > 0")
    assert both & EVERYWHERE is both
    assert EVERYWHERE & both == both
    assert not EVERYWHERE
    assert str(both.prose) == "p > 0, q > 0"
    assert (both & FormulaDomain.from_requirements((), "in words")).texts == (
        "p > 0",
        "q > 0",
        "in words",
    )


def test_a_value_that_is_put_in_lies_in_the_domain_or_is_refused() -> None:
    from verify.algebra.formula import symbol

    asked = domain("delta**2/delta*sqrt(q - delta)")
    assert asked.substitute({symbol("delta"): parse("2")}).texts == ("q - 2 >= 0",)
    with pytest.raises(InputError, match="delta = 0: is outside of delta != 0"):
        asked.substitute({symbol("delta"): parse("0")})
