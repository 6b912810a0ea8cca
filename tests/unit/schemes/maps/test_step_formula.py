"""Formulas of a step: steps in between, any order of lines, and derivatives of H at a point."""

import pytest
import sympy

from verify import schemes
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
GENERAL = Hamiltonian.parse("p**2*(1 + q**2)/2 + q**4")
SEVERAL = Hamiltonian.parse("(p1**2 + p2**2)/2 + q1**2*q2 - q2**3/3")
DRIVEN = Hamiltonian.parse("p**2/2 - (1 + cos(2*t)/2)*cos(q)")

VERLET = "p_half = p - h/2*H_q(q); q_next = q + h*p_half; p_next = p_half - h/2*H_q(q_next)"
KICKED_TWICE = "; ".join(
    [
        *(f"p{k}_half = p{k} - h/2*H_q{k}(q1, q2)" for k in (1, 2)),
        *(f"q{k}_next = q{k} + h*H_p{k}(p{k}_half)" for k in (1, 2)),
        *(f"p{k}_next = p{k}_half - h/2*H_q{k}(q2_next, q1_next)" for k in (1, 2)),
    ]
)
RIGHT = {
    "a step in between": (PENDULUM, VERLET, "stormer-verlet"),
    "in another order": (PENDULUM, "; ".join(reversed(VERLET.split("; "))), "stormer-verlet"),
    "two degrees": (SEVERAL, KICKED_TWICE, "stormer-verlet"),
    "named by coordinates": (
        GENERAL,
        "p_half = p - h/2*H_q(p, q); q_half = q + h/2*H_p(q, p);"
        "p_next = p - h*H_q(q_half, p_half); q_next = q + h*H_p(p_half, q_half)",
        "explicit-midpoint",
    ),
    "with keywords": (GENERAL, "p_next = p - h*H_q(q=q, p=p); q_next = q + h*H_p(p, q)", "euler"),
    "one in another": (
        GENERAL,
        "p_next = p - h*H_q(p - h/2*H_q(p, q), q=q + h/2*H_p(p, q));"
        "q_next = q + h*H_p(p=p - h/2*H_q(p, q), q=q + h/2*H_p(p, q))",
        "explicit-midpoint",
    ),
    "in time": (
        DRIVEN,
        "p_half = p - h/2*H_q(q, t); q_next = q + h*p_half;"
        "p_next = p_half - h/2*H_q(q_next, t + h)",
        "stormer-verlet",
    ),
    "higher derivatives": (
        PENDULUM,
        "p_next = p - h*H_q(q) - h^2/2*p*H_qq(q); q_next = q + h*p - h**2/2*H_q(q)",
        "lie2",
    ),
}


def differs(hamiltonian: Hamiltonian, formulas: str, scheme: str) -> bool:
    """Compare the maps at a point, to 40 digits."""
    ours, theirs = (schemes.get(x).step_map(hamiltonian).composed for x in (formulas, scheme))
    pairs = list(zip(ours, theirs, strict=True))
    names = sorted({x for pair in pairs for e in pair for x in e.free_symbols}, key=str)
    point = {x: sympy.Rational(k + 3, 17) for k, x in enumerate(names)}
    return any(abs(sympy.N((a - b).subs(point), 40)) > 1e-35 for a, b in pairs)


@pytest.mark.parametrize("name", RIGHT)
def test_a_step_in_formulas_is_the_scheme_that_it_is_of(name: str) -> None:
    hamiltonian, formulas, scheme = RIGHT[name]
    assert not differs(hamiltonian, formulas, scheme)
    planted = formulas.replace("/2", "/3").replace("h*H_q(q=q", "h/2*H_q(q=q")
    assert differs(hamiltonian, planted, scheme)


def test_no_digit_of_a_decimal_in_an_argument_is_lost() -> None:
    decimal = "0.1000000000000000000000000000001"
    formulas = f"p_next = p - h*H_q(q*{decimal}); q_next = q + h*p"
    p_next, _ = schemes.get(formulas).step_map(Hamiltonian.parse("p**2/2 + q**2/2")).composed
    assert p_next.coeff(sympy.Symbol("q", real=True)).coeff(sympy.Symbol("h", real=True)) == (
        -sympy.Rational(decimal)
    )


def test_where_an_argument_is_defined_the_map_is() -> None:
    step_map = schemes.get("p_next = p - h*H_q(log(q)); q_next = q + h*p").step_map(PENDULUM)
    assert str(step_map.domain.prose) == "q > 0"


WRONG = {
    "p_next = p - h*H_x(q); q_next = q": "H_x is no derivative of H; allowed: H_p, H_q",
    "p_next = p - h*H_q; q_next = q": r"H_q depends on p, q; write H_q\(p=…, q=…\)",
    "p_next = p - h*H_q(q + h, p*2); q_next = q": "H_q depends on p, q; write H_q",
    "p_next = p - h*H_q(q, q); q_next = q": "q stands twice, or is no coordinate",
    "p_next = p - h*H_q(p, q, x=1); q_next = q": "x stands twice, or is no coordinate",
    "p_next = p - h*H_q(p, q + ); q_next = q": "not a formula at column 16",
    "p_next = p - h*q_next; q_next = q + h*p_next": "p_next, q_next need one another",
    "p_next = p - h*p_next; q_next = q": "p_next need one another, or themselves",
    "p = p - h*q; p_next = p; q_next = q": "p is the value before the step; write p_half = …",
    "p_half = p; p_next = p_half": "write it as 'p_next = …; q_next = …'",
    "p_half = p; p_half = q; p_next = p; q_next = q": "write it as",
    "sin = p; p_next = p; q_next = q": "not a parameter name",
}


@pytest.mark.parametrize("formulas", WRONG)
def test_what_is_wrong_is_said_in_a_line(formulas: str) -> None:
    with pytest.raises(InputError, match=WRONG[formulas]):
        schemes.get(formulas).step_map(GENERAL)


def test_a_step_in_between_may_not_be_a_parameter_of_h() -> None:
    with pytest.raises(InputError, match="stands for a value of the step"):
        schemes.get("half = p; p_next = half; q_next = q").step_map(
            Hamiltonian.parse("p**2/2 + half*q**2")
        )


def test_time_has_to_be_said() -> None:
    with pytest.raises(InputError, match=r"H_q depends on q, t; write H_q\(q=…, t=…\)"):
        schemes.get("p_next = p - h*H_q(q); q_next = q + h*p").step_map(DRIVEN)


HOSTILE = {
    "a sum a thousand levels deep": ("H_q(q)" + " + 0*p" * 800, ""),
    "too long": ("H_q(q)" + " + 0*p" * 900, "longer than 5000 characters"),
    "nested too deeply": ("H_q(" * 30 + "q" + ")" * 30, "nested deeper than 20"),
    "of too many terms": ("H_q(q + h*" * 19 + "q" + ")" * 19, "takes too long"),
    "a letter that is not ASCII": ("H_q(θ)", r"H_q\(θ\).*write theta"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_formula_is_read_or_refused_in_a_line(name: str) -> None:
    formula, problem = HOSTILE[name]
    scheme = schemes.get(f"p_next = p - h*{formula}; q_next = q + h*p")
    hamiltonian = Hamiltonian.parse("p**2/2 + sin(q)*exp(q**2)")
    if not problem:
        assert scheme.step_map(hamiltonian).composed
        return
    with pytest.raises(InputError, match=problem):
        scheme.step_map(hamiltonian)
