"""Short runs against the same steps done with sympy and mpmath alone, for any H.

The map, its four derivatives and det J − 1 are derived by sympy, and evaluated at three times the
digits that the run is asked for.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import assume, example, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import (
    H,
    P,
    Q,
    lie_step,
    plain,
    plain_delta_j,
    polynomials,
    rationals,
    trigonometric,
)
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.observables import REPORTED
from verify.scenes.results.run import RunResult

DIGITS = 40
Map = tuple[sympy.Expr, sympy.Expr]


def expected(step: Map, at: Sequence[Fraction], steps: int) -> dict[str, Any]:
    """The values that `steps` steps give."""
    p_next, q_next, delta_j = (
        sympy.lambdify((P, Q, H), x, "mpmath") for x in (*step, plain_delta_j(*step))
    )
    with mpmath.workdps(3 * DIGITS):
        p, q, h = (mpmath.mpf(x.numerator) / x.denominator for x in at)
        lam = squares = top = mpmath.mpf(0)
        for _ in range(steps):
            dj = delta_j(p, q, h)
            lam, squares, top = lam + dj + lam * dj, squares + dj**2, max(top, abs(dj))
            p, q = p_next(p, q, h), q_next(p, q, h)
        return {"p": p, "q": q, "lambda": lam, "lambda_plain": lam, "mse": squares / steps,
                "delta_j_max": top}  # fmt: skip


def assert_found(found: RunResult, true: dict[str, Any]) -> None:
    assert found.status == "finished"
    assert set(found.values) == set(true)
    for name, x in true.items():
        value = found.values[name]
        with mpmath.workdps(3 * DIGITS):
            own, bound, size = mpmath.mpf(value.value), mpmath.mpf(value.bound), abs(x)
            assert abs(own - x) <= bound + mpmath.mpf(10) ** (-2 * DIGITS) * (1 + size), name
            scale = max(1, size) if name == "lambda_plain" else size
            known = mpmath.mpf(10) ** (5 - DIGITS) * scale
            assert found.arithmetic == "float64" or bound <= known, name


starts = st.tuples(rationals(5), rationals(5), st.sampled_from([Fraction(1, 7), Fraction(3, 100)]))


@drawn(30)
@given(text=polynomials(degree=4), eta=st.sampled_from([1, 2, 3]), at=starts)
def test_a_polynomial_h_is_stepped_as_mpmath_steps_it(
    text: str, eta: int, at: tuple[Fraction, Fraction, Fraction]
) -> None:
    p, q, h = at
    true = expected(lie_step(plain(text), eta), at, 2)
    assume(max(abs(true["p"]), abs(true["q"])) < 10**6)
    found = run(Hamiltonian.parse(text), f"lie{eta}", q=q, p=p, step_size=h, steps=2,
                arithmetic="mpmath", digits=DIGITS, observables=REPORTED)  # fmt: skip
    assert_found(found, true)


@drawn(20)
@example(  # ΔJ ≡ 0, and its product is 1 but for rounding
    text="(-1/3)*q**1 + (1)*cos((2)*p + (2)*q)", eta=2,
    at=(Fraction(-1), Fraction(-3, 2), Fraction(1, 7)),
)  # fmt: skip
@given(text=trigonometric(), eta=st.sampled_from([1, 2]), at=starts)
def test_a_trigonometric_h_is_stepped_as_mpmath_steps_it(
    text: str, eta: int, at: tuple[Fraction, Fraction, Fraction]
) -> None:
    p, q, h = at
    true = expected(lie_step(plain(text), eta), at, 2)
    assume(max(abs(true["p"]), abs(true["q"])) < 10**4)
    found = run(Hamiltonian.parse(text), f"lie{eta}", q=q, p=p, step_size=h, steps=2,
                arithmetic="mpmath", digits=DIGITS, observables=REPORTED)  # fmt: skip
    assert_found(found, true)


OTHERS = {
    "exp": "p**2/2 + exp(-q**2) + q*p/9",
    "hyperbolic": "cosh(p)/3 + sinh(q) + tanh(p*q)",
    "root": "sqrt(1 + p**2) + q**2*(q + 9)**(1/3)",
    "log": "p**2/2 + log(1 + q**2) + atan(p - q)",
    "tan": "p**2/2 + tan(q/3) + pi*q**2",
    "inverse": "p**2/(2 + q**2) + q**4/(1 + p**2)",
}
MAPS = {
    "h-inside": "p_next = p*cos(h) - q*sin(h) + h**3*p**2; q_next = q*cos(h) + p*sin(h)",
    "implicit-like": "p_next = (p - h*sin(q))/(1 + h**2*p**2); q_next = q + h*p_next",
    "decaying": "p_next = exp(-h**2)*p - h*q; q_next = q + h*p/sqrt(1 + h**2)",
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("arithmetic", ["float64", "mpmath"])
@pytest.mark.parametrize("text", OTHERS.values(), ids=OTHERS)
def test_every_function_is_stepped_as_mpmath_steps_it(text: str, arithmetic: str) -> None:
    at = Fraction(2, 7), Fraction(3, 5), Fraction(1, 9)
    true = expected(lie_step(plain(text), 2), at, 5)
    found = run(Hamiltonian.parse(text), "lie2", q=at[1], p=at[0], step_size=at[2], steps=5,
                arithmetic=arithmetic, digits=DIGITS, observables=REPORTED)  # fmt: skip
    assert_found(found, true)


@pytest.mark.parametrize("arithmetic", ["float64", "mpmath"])
@pytest.mark.parametrize("text", MAPS.values(), ids=MAPS)
def test_a_users_map_is_stepped_as_mpmath_steps_it(text: str, arithmetic: str) -> None:
    at = Fraction(2, 7), Fraction(3, 5), Fraction(1, 9)
    formulas = dict(part.strip().split(" = ") for part in text.split(";"))
    p_next = plain(formulas["p_next"])
    q_next = plain(formulas["q_next"]).subs(sympy.Symbol("p_next"), p_next)
    true = expected((p_next, q_next), at, 5)
    found = run(Hamiltonian.parse("p**2/2 + q**2/2"), text, q=at[1], p=at[0], step_size=at[2],
                steps=5, arithmetic=arithmetic, digits=DIGITS, observables=REPORTED)  # fmt: skip
    assert_found(found, true)


@pytest.mark.parametrize("scheme", ["p_next = p + h*p_next; q_next = q", "p_next = p; p_next = q"])
def test_a_map_that_is_not_explicit_is_an_input_error(scheme: str) -> None:
    with pytest.raises(InputError, match=r"p_next|scheme"):
        run(Hamiltonian.parse("p**2/2"), scheme, q=1, p=0, step_size="0.1", steps=1)


def test_a_product_that_rounds_to_1_is_not_said_to_be_exactly_1() -> None:
    """ΔJ = 3 h² is lost in 1 + ΔJ at 40 digits, and at 55."""
    h = Hamiltonian.parse("p**2/2 + q**4/4")
    found = run(h, "lie1", q="1", p="0", step_size="1e-40", steps=2, arithmetic="mpmath",
                digits=17, observables=["lambda_plain"])  # fmt: skip
    value = found.values["lambda_plain"]
    true = Fraction(6) / 10**80
    assert abs(Fraction(value.value) - true) <= Fraction(value.bound)
    assert Fraction(value.bound) < Fraction(1, 10**20)
