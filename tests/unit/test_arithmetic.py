"""One conformance suite for every number system that `verify.arithmetic` finds.

Numbers are held against exact rationals, functions against flint's balls at twice the precision.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import flint
import gmpy2
import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from verify import arithmetic
from verify.enclosure import BALLS
from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.number_system import Arithmetic
from verify.runs import ASKED, run


def _systems() -> list[Any]:
    """Each number system at several precisions, but once where `digits` changes nothing."""
    found: list[Arithmetic] = []
    params = []
    for name in arithmetic.names():
        for digits in (17, 50, 200):
            made = arithmetic.get(name, digits)
            if made not in found:
                found.append(made)
                params.append(pytest.param(name, digits, id=f"{name}-{digits}"))
    return params


SYSTEMS = _systems()
conformance = pytest.mark.parametrize(("name", "digits"), SYSTEMS)
numbers = st.builds(
    lambda x, e: x * Fraction(10) ** e,
    st.fractions(min_value=-10, max_value=10, max_denominator=10**9),
    st.integers(-250, 250),
)
ULPS = 4  # what a good library of functions keeps to: libm within 2, mpmath within 1


def function(made: Arithmetic, source: str) -> Callable[..., Any]:
    """A function of the arithmetic, compiled and called the way that its kernels are."""
    arguments, _, value = source.partition(":")
    compiled = made.compile(f"def f({arguments}): return {value}\n", "f", made.functions)

    def called(*numbers: Any) -> Any:
        with made.context():
            return compiled(*numbers)

    return called


def test_float64_and_mpmath_are_found() -> None:
    assert {"float64", "mpmath"} <= set(arithmetic.names())


@conformance
def test_an_arithmetic_knows_its_name_and_has_the_digits_asked_for(name: str, digits: int) -> None:
    made = arithmetic.get(name, digits)
    assert made.name == name
    assert made.bits == 53 or 2**made.bits >= 10**digits
    assert made == arithmetic.get(name, digits)
    assert made.chunk >= 1


@conformance
@settings(max_examples=60, deadline=None)
@given(x=numbers)
def test_a_rational_is_rounded_once_and_read_back_exactly(
    name: str, digits: int, x: Fraction
) -> None:
    made = arithmetic.get(name, digits)
    number = made.number(x)
    value = made.exact(number)
    assert isinstance(value, Fraction)
    assert abs(value - x) <= abs(x) / 2**made.bits, "not the nearest number"
    assert made.exact(made.number(value)) == value
    assert made.finite(number)
    with made.context():
        assert made.number(-x) == -number


@conformance
@settings(max_examples=60, deadline=None)
@given(m=st.integers(-(2**53), 2**53), e=st.integers(-300, 300))
def test_what_the_working_precision_holds_is_kept_exactly(
    name: str, digits: int, m: int, e: int
) -> None:
    made, x = arithmetic.get(name, digits), m * Fraction(2) ** e
    assert made.exact(made.number(x)) == x


@conformance
@pytest.mark.parametrize("source", ["x: log(x - x)", "x: 1 / (x - x)"], ids=["log-0", "1-over-0"])
def test_what_is_not_a_number_is_raised_or_not_finite(name: str, digits: int, source: str) -> None:
    made = arithmetic.get(name, digits)
    try:
        value = function(made, source)(made.number(Fraction(1, 3)))
    except (ArithmeticError, ValueError):
        return
    assert not made.finite(value)


@conformance
@settings(max_examples=60, deadline=None)
@given(x=numbers, y=numbers.filter(bool))
def test_the_four_operations_are_each_rounded_once(
    name: str, digits: int, x: Fraction, y: Fraction
) -> None:
    made = arithmetic.get(name, digits)
    a, b = made.number(x), made.number(y)
    exact_a, exact_b = made.exact(a), made.exact(b)
    if not 10**-40 < abs(exact_a) < 10**40 or not 10**-40 < abs(exact_b) < 10**40:
        return  # products and quotients stay in every arithmetic's range
    with made.context():
        results = a + b, a - b, a * b, a / b
    for found, true in zip(
        results,
        (exact_a + exact_b, exact_a - exact_b, exact_a * exact_b, exact_a / exact_b),
        strict=True,
    ):
        assert abs(made.exact(found) - true) <= abs(true) / 2**made.bits


# -- functions ------------------------------------------------------------------------------------

MODERATE = [Fraction(n, 37) for n in (-401, -100, -58, -37, -5, -1, 1, 3, 29, 58, 117, 777)]
POSITIVE = [Fraction(1, 10**30), *(x for x in MODERATE if x > 0), Fraction(7 * 10**40, 3)]
HUGE = [Fraction(10**9, 7), Fraction(10**20, 7), Fraction(10**22)]
POINTS = {
    "sin": [*MODERATE, *HUGE], "cos": [*MODERATE, *HUGE], "exp": MODERATE, "sinh": MODERATE,
    "cosh": MODERATE, "atan": [*MODERATE, *HUGE, Fraction(1, 10**30)], "log": POSITIVE,
}  # fmt: skip


def true_value(kind: str, x: Fraction, bits: int, degree: int = 1) -> tuple[Fraction, Fraction]:
    """The function's value and the radius of its enclosure, by flint at twice the precision."""
    with flint.ctx.workprec(2 * bits + 200):
        ball = BALLS[kind](flint.arb(flint.fmpq(x.numerator, x.denominator)), degree)
        parts = [flint.arb(x).man_exp() for x in (ball.mid(), ball.rad())]
    middle, radius = (Fraction(int(m)) * Fraction(2) ** int(e) for m, e in parts)
    return middle, radius


def assert_accurate(made: Arithmetic, found: Any, kind: str, x: Any, degree: int = 1) -> None:
    true, radius = true_value(kind, made.exact(x), made.bits, degree)
    error = abs(made.exact(found) - true)
    unit = abs(true) / 2 ** (made.bits - 1)
    assert error <= ULPS * unit + radius, f"{kind}({x}) is {float(error / unit):.1f} ulp off"


def test_the_points_cover_every_function_that_a_hamiltonian_can_need() -> None:
    assert set(POINTS) | {"root", "inverse"} == set(BALLS)


@conformance
@pytest.mark.parametrize("kind", POINTS)
def test_a_function_is_as_accurate_as_its_arithmetic(name: str, digits: int, kind: str) -> None:
    made = arithmetic.get(name, digits)
    compiled = function(made, f"x: {kind}(x)")
    for point in POINTS[kind]:
        x = made.number(point)
        assert_accurate(made, compiled(x), kind, x)


@conformance
@pytest.mark.parametrize("degree", [2, 3, 5, 7])
def test_a_root_is_as_accurate_as_its_arithmetic(name: str, digits: int, degree: int) -> None:
    made = arithmetic.get(name, digits)
    compiled = function(made, "x: sqrt(x)" if degree == 2 else f"x: root(x, {degree})")
    for point in [*POSITIVE, Fraction(8), Fraction(10**200), Fraction(1, 10**200)]:
        x = made.number(point)
        assert_accurate(made, compiled(x), "root", x, degree)


@conformance
def test_cos_sin_in_one_call_is_cos_and_sin(name: str, digits: int) -> None:
    made = arithmetic.get(name, digits)
    both = [f for f in ("cos_sin", "sin_cos") if f in made.functions]
    if not both:
        pytest.skip("this arithmetic has no cos_sin")
    for f in both:
        compiled = function(made, f"x: {f}(x)")
        for point in MODERATE:
            x = made.number(point)
            for found, kind in zip(compiled(x), f.split("_"), strict=True):
                assert_accurate(made, found, kind, x)


@conformance
def test_pi_is_pi(name: str, digits: int) -> None:
    made = arithmetic.get(name, digits)
    with flint.ctx.workprec(2 * made.bits):
        mantissa, exponent = flint.arb.pi().mid().man_exp()
    true = Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
    assert abs(made.exact(made.functions["pi"]) - true) <= true / 2**made.bits


# -- runs -----------------------------------------------------------------------------------------

SMALL = [
    pytest.param(Hamiltonian.parse("p**2/2 + q**2/2 + 7*q**4/12"), "lie3", id="duffing"),
    pytest.param(Hamiltonian.parse("p**2/2 - cos(q)"), "lie2", id="pendulum"),
    pytest.param(Hamiltonian.parse("p**2/2 + exp(q) + sqrt(q + 3) + atan(p)/9"), "lie2", id="all"),
]


def small_run(h: Hamiltonian, scheme: str, name: str, digits: int) -> dict[str, Any]:
    made = run(h, scheme, q="0.5", p="1/3", step_size="1/70", steps=40, arithmetic=name,
               digits=digits, observables=ASKED, points=7)  # fmt: skip
    return made.model_dump(exclude={"seconds"})


@conformance
@pytest.mark.parametrize(("h", "scheme"), SMALL)
def test_repeated_runs_are_identical_to_the_last_bit(
    name: str, digits: int, h: Hamiltonian, scheme: str
) -> None:
    first = small_run(h, scheme, name, digits)
    assert first["status"] == "finished"
    assert small_run(h, scheme, name, digits) == first


@conformance
@pytest.mark.parametrize(("h", "scheme"), SMALL)
def test_a_run_neither_uses_nor_changes_a_global_precision(
    name: str, digits: int, h: Hamiltonian, scheme: str
) -> None:
    def state() -> tuple[Any, ...]:
        return mpmath.mp.prec, mpmath.iv.prec, flint.ctx.prec, gmpy2.get_context().precision

    before = state()
    expected = small_run(h, scheme, name, digits)
    assert state() == before
    try:
        mpmath.mp.prec, mpmath.iv.prec, flint.ctx.prec = 20, 22, 24
        gmpy2.get_context().precision = 26
        changed = state()
        assert small_run(h, scheme, name, digits) == expected
        assert state() == changed
    finally:
        mpmath.mp.prec, mpmath.iv.prec, flint.ctx.prec = before[:3]
        gmpy2.get_context().precision = before[3]


@pytest.mark.parametrize("name", ["", "float32", "mpmath ", "../float64", "__init__"])
def test_an_unknown_arithmetic_is_an_input_error_that_names_the_known(name: str) -> None:
    with pytest.raises(InputError, match=r"^arithmetic=.*float64.*mpmath"):
        arithmetic.get(name, 17)
