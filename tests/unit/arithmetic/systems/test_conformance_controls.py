"""The conformance suite's own checks, held against number systems with a small lie in them.

Each lie is caught, and without it the same check passes: a check that cannot fail shows nothing.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from typing import Any

import flint
import gmpy2
import pytest

from tests.helpers import conformance
from verify import arithmetic
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import ball, mpfr, mpmath

AT_BITS = {"mpmath": mpmath.at_bits, "mpfr": mpfr.at_bits, "ball": ball.at_bits}
AT: list[tuple[Fraction, Fraction]] = [
    (Fraction(n * n + 1, 37), Fraction(-100, 3 * n + 1)) for n in range(1, 25)
]
every = pytest.mark.parametrize("name", AT_BITS)


def all_numbers(made: Arithmetic) -> None:
    for x, y in AT:
        conformance.check_number(made, x)
        conformance.check_number(made, y)


def all_operations(made: Arithmetic) -> None:
    for x, y in AT:
        conformance.check_operations(made, x, y)


def all_functions(made: Arithmetic) -> None:
    for kind, points in conformance.POINTS.items():
        for point in points:
            conformance.check_function(made, kind, point)
    for degree in (2, 3, 5):
        for point in conformance.RADICANDS:
            conformance.check_function(made, "root", point, degree)


def all_pairs(made: Arithmetic) -> None:
    for f in {"cos_sin", "sin_cos"} & set(made.functions):
        for point in conformance.POINTS["sin"]:
            conformance.check_pair(made, f, point)


def all_extremes(made: Arithmetic) -> None:
    for x, y in AT:
        conformance.check_extremes(made, x, y)
        conformance.check_extremes(made, x, x)


CHECKS: list[Callable[[Arithmetic], None]] = [
    all_numbers, all_operations, all_functions, all_pairs, all_extremes, conformance.check_pi,
]  # fmt: skip


def assert_caught(lie: Arithmetic, *checks: Callable[[Arithmetic], None]) -> None:
    for check in checks:
        with pytest.raises(AssertionError):
            check(lie)


@pytest.mark.parametrize("name", arithmetic.names())
def test_without_a_lie_every_check_passes(name: str) -> None:
    for check in CHECKS:
        check(arithmetic.get(name, 34))


@every
def test_one_bit_less_than_promised_is_caught(name: str) -> None:
    lie = replace(AT_BITS[name](112), bits=113)
    assert_caught(lie, all_numbers, all_operations)
    if name == "mpfr":  # of the others, functions may be some units off
        assert_caught(lie, all_functions, all_pairs)


@every
def test_numbers_or_operations_alone_with_a_bit_less_are_caught(name: str) -> None:
    made, coarse = AT_BITS[name](113), AT_BITS[name](112)
    assert_caught(replace(made, number=coarse.number), all_numbers)
    if name != "mpmath":  # its operators round as their operands' own context does
        assert_caught(replace(made, context=coarse.context), all_operations)


@every
def test_a_pi_that_is_one_unit_off_is_caught(name: str) -> None:
    made = AT_BITS[name](113)
    one_off = made.number(made.exact(made.functions["pi"]) + Fraction(2) ** -111)
    assert_caught(with_function(made, "pi", one_off), conformance.check_pi)


def test_float64_with_numbers_of_52_bits_is_caught() -> None:
    made = arithmetic.get("float64", 17)
    lie = replace(made, number=lambda x: float(mpfr.at_bits(52).exact(mpfr.at_bits(52).number(x))))
    assert_caught(lie, all_numbers)


@pytest.mark.parametrize("loss", [Fraction(1, 2), Fraction(9, 10), Fraction(0)])
def test_a_radius_that_is_too_small_is_caught(loss: Fraction) -> None:
    made = ball.at_bits(113)
    assert made.radius is not None
    true_radius = made.radius
    lie = replace(made, radius=lambda x: loss * true_radius(x))
    assert_caught(lie, all_numbers, all_operations, all_functions, all_extremes)


def test_a_radius_that_is_needlessly_large_is_caught() -> None:
    made = ball.at_bits(113)
    assert made.radius is not None
    true_radius = made.radius
    lie = replace(made, radius=lambda x: 128 * true_radius(x))
    assert_caught(lie, all_operations, all_functions, all_pairs, conformance.check_pi)


def with_function(made: Arithmetic, name: str, function: Any) -> Arithmetic:
    return replace(made, functions={**made.functions, name: function})


@pytest.mark.parametrize("kind", [*conformance.POINTS, "sqrt", "root"])
def test_a_function_that_is_rounded_down_is_not_correctly_rounded(kind: str) -> None:
    made = mpfr.at_bits(113)
    true = made.functions[kind]

    def downwards(*arguments: Any) -> Any:
        with gmpy2.context(gmpy2.get_context(), round=gmpy2.RoundDown):
            return true(*arguments)

    assert_caught(with_function(made, kind, downwards), all_functions)


@pytest.mark.parametrize("kind", [*conformance.POINTS, "sqrt", "root"])
@every
def test_a_function_that_is_five_units_off_is_caught(name: str, kind: str) -> None:
    made = AT_BITS[name](113)
    true = made.functions[kind]
    factor = made.number(1 + Fraction(10, 2**113) * (20 if name == "ball" else 1))
    lie = with_function(made, kind, lambda *arguments: true(*arguments) * factor)
    assert_caught(lie, all_functions)


def test_cos_and_sin_in_the_wrong_order_are_caught() -> None:
    for made in (mpmath.at_bits(113), mpfr.at_bits(113), ball.at_bits(113)):
        (both,) = {"cos_sin", "sin_cos"} & set(made.functions)
        true = made.functions[both]
        assert_caught(
            with_function(made, both, lambda x, true=true: tuple(reversed(true(x)))), all_pairs
        )


def test_the_wider_of_two_balls_is_not_their_maximum() -> None:
    made = ball.at_bits(113)
    first = with_function(made, "maximum", lambda x, y: y)
    by_middle = with_function(made, "maximum", lambda x, y: x if x.mid() > y.mid() else y)
    least = with_function(made, "maximum", flint.arb.min)
    for lie in (first, by_middle, least):
        assert_caught(lie, all_extremes)


def test_what_is_not_a_number_and_taken_for_one_is_caught() -> None:
    for made in (mpfr.at_bits(113), ball.at_bits(113), arithmetic.get("float64", 17)):
        careless = replace(made, finite=lambda x: True, context=nothing)
        source = "x: log(-x)"
        conformance.check_undefined(made, source, Fraction(1, 3))
        with pytest.raises(AssertionError):
            conformance.check_undefined(careless, source, Fraction(1, 3))


@contextmanager
def nothing() -> Iterator[None]:
    yield
