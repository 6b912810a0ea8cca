"""A Hamiltonian with exact parameters, its vector field, and the named systems."""

from dataclasses import replace
from fractions import Fraction

import pytest
import sympy
from hypothesis import given

from tests.examples import drawn
from tests.helpers.sampled.formulas import (
    P,
    Q,
    formulas,
    outcome,
    plain,
    polynomials,
    trigonometric,
)
from tests.helpers.sampled.identities.drawn import HIDDEN
from verify.algebra.domain import EVERYWHERE
from verify.algebra.formula import parse, symbol
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

DUFFING = "p**2/2 + q**2/2 + delta*q**4/4"
FORMULAS = [
    DUFFING,
    "p**2/2 - cos(q)",
    "p**3*q**2 - a*p*q + 7/3*q",
    "exp(p*q)/(1 + q**2)",
    "sqrt(1 + p**2) + tanh(b*q)",
    "log(p/q)*atan(p)",
]


@pytest.mark.parametrize("text", FORMULAS)
def test_the_field_is_minus_h_q_and_h_p(text: str) -> None:
    field, _ = canonical_field(Hamiltonian.parse(text))
    expression = plain(text)
    force, speed = field.slopes
    gaps = (
        field.ring.expression(speed) - expression.diff(P),
        field.ring.expression(force) + expression.diff(Q),
    )
    assert [sympy.simplify(gap) for gap in gaps] == [0, 0]


GIANT = ["p**2/2 + 1e-1000*q**3", "p**2/2 + 1e1000*q**2", "(p**2 + q**4/3e700)/7e400"]


@pytest.mark.parametrize("text", [*FORMULAS, *GIANT, "(p**7 + 1/10)/((q**2 + 2)*(a - 1)*7/3)"])
def test_h_written_out_is_read_as_the_same_h(text: str) -> None:
    made = Hamiltonian.parse(text)
    assert Hamiltonian.parse(made.formula) == made
    assert sympy.simplify(made.expression - plain(text)) == 0


@given(text=formulas())
@drawn(200)
def test_so_is_any(text: str) -> None:
    try:
        made = Hamiltonian.parse(text)
    except InputError:
        return
    # What was written may ask for more: p/p is 1 where p is not 0.
    assert Hamiltonian.parse(made.formula) == replace(made, text_domain=EVERYWHERE)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("p**2/2 + 7e-1000*(q + q**2*pi + q**3 + q**4/3 + q**5/9)", "longer than 5000"),
        ("p**2/2 + 1e-1000/(1e300 + q**2)", "more than 4000 bits"),
    ],
)
def test_what_grows_too_long_when_it_is_written_out_is_refused(text: str, said: str) -> None:
    """It would be read by plan, and not by the worker that report gives it to."""
    parse(text)
    with pytest.raises(InputError, match=f"^hamiltonian, written out=.*{said}"):
        Hamiltonian.parse(text)


@pytest.mark.parametrize("text", FORMULAS)
def test_the_lie_derivative_of_p_and_q_is_the_field(text: str) -> None:
    field, _ = canonical_field(Hamiltonian.parse(text))
    ring = field.ring
    h_p, h_q = field.gradient(field.energy)
    assert ring.decide(field.derive(ring.variable("q")) - h_p).zero is True
    assert ring.decide(field.derive(ring.variable("p")) + h_q).zero is True


@pytest.mark.parametrize("text", FORMULAS)
def test_energy_is_constant_along_the_flow_and_a_coordinate_is_not(text: str) -> None:
    hamiltonian = Hamiltonian.parse(text)
    field, (energy,) = canonical_field(hamiltonian, hamiltonian.exact)
    assert field.ring.decide(field.derive(energy)).zero is True
    assert field.ring.decide(field.derive(energy + field.ring.variable("q"))).zero is False


def test_powers_of_the_lie_derivative_start_with_the_function_itself() -> None:
    field, _ = canonical_field(Hamiltonian.parse("p**2/2 + q**2/2"))
    p, q = field.ring.variable("p"), field.ring.variable("q")
    assert [field.power(n) for n in range(5)] == [(p, q), (-q, p), (-p, -q), (q, -p), (p, q)]


SEPARABLE = {
    "p**2/2 - cos(q)": True,
    "p": True,
    "7": True,
    "(p + q)**2 - 2*p*q": True,
    "sin(p + q) - sin(p)*cos(q) - cos(p)*sin(q) + p": True,
    "log(exp(p)*exp(q))": True,
    "p*q": False,
    "p**2*(1 + q)": False,
    "(p + q)**2 - 2*p*q + p*q/10**40": False,
    "exp(p + q)": False,
    "sqrt(p**2 + q**2)": False,
    "p*q*(log(q**2) - 2*log(q))": True,
    f"p*({HIDDEN})": False,  # undecided is not separable
}


@pytest.mark.parametrize(("text", "expected"), SEPARABLE.items(), ids=SEPARABLE.keys())
def test_separable_is_decided_by_the_mixed_derivative(text: str, expected: bool) -> None:
    assert canonical_field(Hamiltonian.parse(text))[0].separable is expected


@given(polynomials("p"), polynomials("q"), trigonometric("q"))
@drawn(25)
def test_a_sum_of_one_function_each_is_separable_and_a_product_is_not(
    t: str, v: str, w: str
) -> None:
    assert canonical_field(Hamiltonian.parse(f"{t} + {v} + {w}"))[0].separable
    assert not canonical_field(Hamiltonian.parse(f"({t})*({v})"))[0].separable


# -- parameters -------------------------------------------------------------------------------


def test_a_parameter_without_a_value_stays_a_symbol() -> None:
    hamiltonian = Hamiltonian.parse("a*p**2 + b*q**2", {"a": "1/3", "b": None})
    assert hamiltonian.parameters == ("a", "b")
    assert hamiltonian.symbols == ("b",)
    assert hamiltonian.exact == P**2 / 3 + symbol("b") * Q**2
    assert hamiltonian.expression == symbol("a") * P**2 + symbol("b") * Q**2


def test_values_replace_the_present_ones() -> None:
    first = Hamiltonian.parse("a*p**2 + b*q**2", {"a": 1, "b": 2})
    assert first.with_values({"b": "0.1"}).values == (("b", Fraction(1, 10)),)


def test_a_float_value_is_the_decimal_that_it_prints_as() -> None:
    assert Hamiltonian.parse("a*p", {"a": 0.1}) == Hamiltonian.parse("a*p", {"a": "0.1"})


def test_generic_keeps_symbols_but_drops_the_terms_that_vanish() -> None:
    hamiltonian = Hamiltonian.parse("a*p**2 + b*q**4 + q", {"a": 3, "b": 0})
    assert hamiltonian.with_symbols() == Hamiltonian.parse("a*p**2 + q")


@pytest.mark.parametrize("name", ["pq", "qp", "pp", "g0_", "g1_", "H", "E", "x_1", "lambda_"])
def test_a_parameter_may_have_any_plain_name(name: str) -> None:
    hamiltonian = Hamiltonian.parse(f"p**2/2 + {name}*sin(q)")
    assert hamiltonian.parameters == (name,)
    field, _ = canonical_field(hamiltonian)
    assert field.ring.expression(field.slopes[0]) == -symbol(name) * sympy.cos(Q)


BAD_PARAMETERS = {
    "unknown": ("a*q", {"b": 1}, "no such parameter"),
    "unknown beside none": ("q", {"b": 1}, "it has: none"),
    "coordinate": ("a*q", {"q": 1}, "parameter name"),
    "step": ("a*q", {"h": 1}, "parameter name"),
    "function": ("a*q", {"sin": 1}, "parameter name"),
    "no name": ("a*q", {"": 1}, "parameter name"),
    "not a number": ("a*q", {"a": "nan"}, "parameter a=nan"),
    "formula as value": ("a*q", {"a": "pi"}, "parameter a=pi"),
    "boolean": ("a*q", {"a": True}, "parameter a=True"),
    "division by zero": ("q/a", {"a": 0}, "not defined"),
    "division by a difference": ("q/(a - b)", {"a": 2, "b": "2.0"}, "not defined"),
    "zero over zero": ("sin(a*q)/a", {"a": 0}, "not defined"),
    "logarithm": ("q*log(a)", {"a": "-1"}, "not defined"),
    "logarithm of zero": ("q*log(a)", {"a": "0"}, "not defined"),
    "square root": ("q*sqrt(a - 1)", {"a": "0"}, "not defined"),
    "cube root": ("q*a**(1/3)", {"a": "-1"}, ""),
    "root of less than pi": ("q*sqrt(a - pi)", {"a": "3"}, ""),
    "hidden modulus": ("p + sqrt(q**2 + a)", {"a": "0"}, ""),
    "hidden modulus, cubed": ("p + (q**2 + a)**(3/2)", {"a": "0"}, ""),
    "pole of the tangent": ("q*tan(a*pi)", {"a": "1/2"}, "not defined"),
}


@pytest.mark.parametrize(
    ("text", "values", "fragment"), BAD_PARAMETERS.values(), ids=BAD_PARAMETERS.keys()
)
def test_a_bad_parameter_is_refused_at_once(
    text: str, values: dict[str, object], fragment: str
) -> None:
    with pytest.raises(InputError) as info:
        Hamiltonian.parse(text, values)  # type: ignore[arg-type]
    assert str(info.value).startswith("parameter")
    assert fragment in str(info.value)


LARGE = [
    "p*exp(a*log(q))",
    "p*exp(a*log(2))",
    "p*cos(a*q)*cos(q)",
    "q*atan(tan(a))",
    "q*log(sin(exp(exp(a))))",
]


@pytest.mark.sample(6)
@pytest.mark.parametrize("value", ["1e300", "-1e9", "1e-300", "100"])
@pytest.mark.parametrize("text", LARGE)
def test_a_large_parameter_is_taken_or_refused_in_bounded_time(text: str, value: str) -> None:
    work = outcome(lambda: canonical_field(Hamiltonian.parse(text, {"a": value})))
    assert work in ("done", "InputError", "LimitError")


@pytest.mark.parametrize("text", ["(p + q + a + b + c)**64", "(exp(p) + exp(q) + a + b)**64"])
def test_growth_beyond_bounds_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="terms"):
        canonical_field(Hamiltonian.parse(text))


# -- what must end ---------------------------------------------------------------------------


ENDS = {
    "logarithm times a googol": "exp(log(3)*1e999)",
    "logarithm of 2, often": "exp(1e9*log(2))",
    "logarithm of q, often": "exp(1e9*log(q))",
    "coefficient in steps": "((((1e999*q)**64)**64)**64)**64",
    "power in steps": "(((q**64)**64)**64)**64",
    "binomial in steps": "((1 + q)**64)**64",
    "trinomial in steps": "((1 + p + q)**64)**64",
    "multiple angle": "sin(q) + sin(16*q)**64",
    "large multiple angle": "sin(64*q)**64",
    "four functions": "(exp(q) + exp(p) + sin(q) + cos(p))**64",
    "tangents": "tan(16*q)**64 + tan(15*q)",
    "many factors": "1/(q**60 - 1) + 1/(p**60 - 1)",
    "nested functions": "sin(" * 55 + "q" + ")" * 55,
    "nested quotients": "1/(1+" * 40 + "q" + ")" * 40,
    "fine angle": "q*tan(pi/30030)",
    "large root": "q*(1e999 + 7)**(63/64)",
    "angle beyond evaluation": "q*atan(tan(1e300))",
    "difference beyond evaluation": "q*sqrt(exp(exp(exp(100))) - exp(exp(100)))",
    "sign beyond evaluation": "q*log(sin(exp(exp(100))))",
    "root beyond evaluation": "q*cos(exp(exp(30)))**(1/3)",
    "the longest name": "p**2 + q*" + "a" * 32,
    "a name inside pq": "p**2/2 + pq*q**2/2",
    "a name like a generator's": "g0_*q + g1_*sin(q)",
}


@pytest.mark.sample(13)
@pytest.mark.parametrize("text", ENDS.values(), ids=ENDS.keys())
def test_a_hamiltonian_is_taken_or_refused_in_bounded_time(text: str) -> None:
    assert outcome(lambda: canonical_field(Hamiltonian.parse(text))) in (
        "done",
        "InputError",
        "LimitError",
    )


@pytest.mark.parametrize("text", ["q*tan(q + pi/2)", "exp(pi*log(q))", "q*exp(sqrt(2)*log(p))"])
def test_what_the_parser_takes_the_ring_takes(text: str) -> None:
    canonical_field(Hamiltonian.parse(text))


# -- named systems ----------------------------------------------------------------------------

SYSTEMS = systems.names()


def test_there_are_the_systems_of_the_paper_and_the_linear_one() -> None:
    assert {"duffing", "pendulum", "harmonic"} <= set(SYSTEMS)


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_system_explains_each_of_its_parameters_and_its_source(name: str) -> None:
    system = systems.get(name)
    own = {*system.hamiltonian().parameters, *(["n"] if system.family else [])}
    assert sorted(system.parameters) == sorted(own)
    assert all(system.parameters.values())
    assert system.title
    assert system.source


EQUATIONS = {
    "duffing": ("q + delta*q**3", "p"),  # Eq. 17
    "pendulum": ("sin(q)", "p"),  # Eq. 25
    "harmonic": ("omega**2*q", "p"),
}


@pytest.mark.parametrize("name", sorted(EQUATIONS))
def test_a_system_has_the_equation_of_motion_it_is_named_for(name: str) -> None:
    expression = systems.get(name).hamiltonian().expression
    force, velocity = (plain(text) for text in EQUATIONS[name])
    assert sympy.expand(expression.diff(Q) - force) == 0
    assert sympy.expand(expression.diff(P) - velocity) == 0


@pytest.mark.parametrize("name", ["", "duffin", "duffing2", "__init__", "lie2", "p**2"])
def test_an_unknown_system_is_refused_with_the_known_ones(name: str) -> None:
    with pytest.raises(InputError, match=r"^system=.*allowed: .*duffing"):
        systems.get(name)


@pytest.mark.parametrize("text", FORMULAS)
def test_the_gradient_in_floats_is_that_of_sympy(text: str) -> None:
    h = Hamiltonian.parse(text)
    h = h.with_values(dict.fromkeys(h.parameters, "3/7"))
    values = {sympy.Symbol(name, real=True): sympy.Rational(3, 7) for name in h.parameters}
    by_sympy = plain(text).subs(values)
    at = {P: sympy.Rational(5, 16), Q: sympy.Rational(3, 8)}  # floats, both
    found = h.gradient()(0.3125, 0.375)
    for slope, name in zip(found, (P, Q), strict=True):
        assert type(slope) in (float, int)
        assert slope == pytest.approx(float(by_sympy.diff(name).subs(at)), rel=1e-13, abs=1e-14)


def test_the_gradient_in_several_degrees_of_freedom_takes_lists() -> None:
    heiles = Hamiltonian.parse("(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3")
    h_p, h_q = heiles.gradient()([0.25, -0.5], [0.5, 0.75])
    assert (h_p, h_q) == ([0.25, -0.5], [0.5 + 0.75, 0.75 + 0.25 - 0.5625])
    driven = Hamiltonian.parse("p1**2/2 + p2*q1 + t*q1*q2")
    assert driven.gradient()((1.0, 2.0), (3.0, 4.0), 0.5) == ([1.0, 3.0], [2.0 + 2.0, 1.5])
    assert Hamiltonian.parse("p1**2/2 + q2").gradient()([2.0, 0.0], [0.0, 0.0]) == (
        [2.0, 0],
        [0, 1],
    )


def test_a_gradient_wants_values() -> None:
    with pytest.raises(InputError, match="parameter=delta: has no value"):
        Hamiltonian.parse(DUFFING).gradient()
    with pytest.raises(InputError, match="parameter=mu: has no value"):
        systems.get("kepler").hamiltonian().gradient()
