"""Functions made of others, and arrays of our numbers: values and derivatives, by mpmath."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import gmpy2
import mpmath
import numpy as np
import pytest

from verify.integrators.trace_proof import domain_of
from verify.integrators.tracing.dual import Duals
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.tracing.trace import Tape, evaluate_nodes, in_order, replay_in
from verify.integrators.tracing.traced_number import Kind, UntraceableError

MP = mpmath.mp.clone()
MP.dps = 60
Case = tuple[Callable[[Any], Any], Callable[[Any], Any], str]


def matrix(x: Any) -> Any:
    return np.array([[x, 1], [0.5, 2 * x]])


def filled(make: Callable[..., Any], x: Any, **options: Any) -> Any:
    made = make(2, **options)
    made[0] = x
    return made[0]


# Where symbols go through: the user's function, the same of mpmath's, and at which x.
SMOOTH: dict[str, Case] = {
    "arcsin": (lambda x: math.asin(x) + np.arcsin(x), lambda x: 2 * MP.asin(x), "-0.3"),
    "arccos": (lambda x: math.acos(x) + np.arccos(x), lambda x: 2 * MP.acos(x), "0.7"),
    "arcsinh": (lambda x: math.asinh(x) + np.arcsinh(x), lambda x: 2 * MP.asinh(x), "-1.3"),
    "arccosh": (lambda x: math.acosh(x) + np.arccosh(x), lambda x: 2 * MP.acosh(x), "1.3"),
    "arctanh": (lambda x: math.atanh(x) + np.arctanh(x), lambda x: 2 * MP.atanh(x), "-0.6"),
    "cbrt": (lambda x: math.cbrt(x) + np.cbrt(x), lambda x: 2 * MP.cbrt(x), "1.7"),
    "degrees": (lambda x: math.degrees(x) + np.rad2deg(x), lambda x: 2 * MP.degrees(x), "1.1"),
    "radians": (lambda x: math.radians(x) + np.deg2rad(x), lambda x: 2 * MP.radians(x), "1.1"),
    "exp2": (lambda x: math.exp2(x) + np.exp2(x), lambda x: 2 * MP.mpf(2) ** x, "-0.4"),
    "expm1": (lambda x: math.expm1(x) + np.expm1(x), lambda x: 2 * MP.expm1(x), "0.4"),
    "log2": (lambda x: math.log2(x) + np.log2(x), lambda x: 2 * MP.log(x, 2), "0.4"),
    "log10": (lambda x: math.log10(x) + np.log10(x), lambda x: 2 * MP.log10(x), "0.4"),
    "log1p": (lambda x: math.log1p(x) + np.log1p(x), lambda x: 2 * MP.log1p(x), "0.4"),
    "sinc": (lambda x: np.sinc(x), lambda x: MP.sincpi(x), "0.4"),
    "hypot": (lambda x: math.hypot(x, 3, 4) + np.hypot(x, 2),
              lambda x: MP.sqrt(x * x + 25) + MP.hypot(x, 2), "0.4"),
    "dist": (lambda x: math.dist((x, 1), (2, 3)), lambda x: MP.hypot(x - 2, 2), "0.4"),
    "pow": (lambda x: math.pow(x, 0.5), lambda x: MP.sqrt(x), "0.4"),
    "logaddexp": (lambda x: np.logaddexp(x, 0), lambda x: MP.log(1 + MP.exp(x)), "0.4"),
    "of plain numbers": (lambda x: x * math.radians(30) * np.hypot(1, 2) + math.atan2(1, -2),
                         lambda x: x * MP.pi / 6 * MP.sqrt(5) + MP.atan2(1, -2), "0.4"),
    "pi by its name": (lambda x: x * PI, lambda x: x * MP.pi, "0.4"),
    "angle, first": (lambda x: math.atan2(x, 0.5), lambda x: MP.atan2(x, 0.5), "0.3"),
    "angle, second": (lambda x: np.arctan2(0.5, x), lambda x: MP.atan2(0.5, x), "-0.3"),
    "angle, near the axis": (lambda x: np.arctan2(x, -2), lambda x: MP.atan2(x, -2), "0.01"),
    "angle, third": (lambda x: np.arctan2(x, x - 2), lambda x: MP.atan2(x, x - 2), "-0.3"),
    "angle, below": (lambda x: math.atan2(-2, x), lambda x: MP.atan2(-2, x), "0.3"),
    "angles": (lambda x: np.arctan2(np.array([1.0, x]), np.array([x, 1.0])) @ [1, 2],
               lambda x: MP.atan2(1, x) + 2 * MP.atan2(x, 1), "0.3"),
    "arrays with plain numbers": (lambda x: np.sqrt(np.array([x, 2.0])).sum(),
                                  lambda x: MP.sqrt(x) + MP.sqrt(2), "0.3"),
    "sinc of an array": (lambda x: np.sinc(np.array([x, x]))[1], lambda x: MP.sincpi(x), "0.3"),
    "norm": (lambda x: np.linalg.norm(np.array([x, 3])), lambda x: MP.hypot(x, 3), "0.3"),
    "products": (lambda x: np.dot(matrix(x), [x, 1])[0] + np.einsum("ij,j->i", matrix(x), [1, x])[1]
                 + np.cross(np.array([x, 0, 1]), np.array([2.0, x, 0]))[2],
                 lambda x: x * x + 1 + MP.mpf(1) / 2 + 2 * x * x + x * x, "0.3"),
    "solve": (lambda x: np.linalg.solve(matrix(x), np.array([1.0, x])) @ [1, 2],
              lambda x: (3 * x + 2 * (x * x - MP.mpf(1) / 2) - 2 * x)
              / (2 * x * x - MP.mpf(1) / 2), "0.3"),
    "solve from a zero": (lambda x: np.linalg.solve(np.array([[0, x], [1, 3]]), [x * x, 1])[1],
                          lambda x: x, "0.3"),
    "inverse": (lambda x: np.linalg.inv(matrix(x))[0, 1],
                lambda x: -1 / (2 * x * x - MP.mpf(1) / 2), "0.3"),
    "determinant": (lambda x: np.linalg.det(matrix(x)) + np.linalg.det(matrix(x)[::-1]) / 2,
                    lambda x: x * x - MP.mpf(1) / 4, "0.3"),
    "filled arrays": (lambda x: filled(np.zeros, x) * filled(np.empty, x, dtype="d")
                      * filled(np.ones, x, dtype=np.float64), lambda x: x**3, "0.3"),
    "types without their name": (lambda x: filled(lambda n: np.zeros(n, float), x)
                                 + filled(lambda n: np.full(n, 1, float), x)
                                 + np.array([x, 1], float)[0], lambda x: 3 * x, "0.3"),
    "types by their names": (lambda x: np.array([x, 1], dtype="float64")[0], lambda x: x, "0.3"),
}  # fmt: skip
# Where values are compared.
BY_COMPARISONS: dict[str, Case] = {
    "absolute": (lambda x: abs(x) + np.abs(x) + math.fabs(x), lambda x: -3 * x, "-0.3"),
    "sign": (lambda x: np.sign(x) * x + (np.sign(np.array([x])) * x)[0], lambda x: -2 * x, "-0.3"),
    "copysign": (lambda x: math.copysign(x, -1.0) + np.copysign(np.array([x]), 1.0)[0] / 2,
                 lambda x: x + -x / 2, "-0.3"),
    "heaviside": (lambda x: np.heaviside(x, 0.5) * x + np.heaviside(-x, 0.5), lambda x: x, "0.3"),
    "heaviside at 0": (lambda x: np.heaviside(x - x, 0.25) * x, lambda x: x / 4, "0.3"),
    "maximum": (lambda x: np.maximum(x, 0.1) + np.fmin(np.array([x]), 0.1)[0],
                lambda x: x + MP.mpf(1) / 10, "0.3"),
    "largest": (lambda x: np.maximum.reduce(np.array([0.1, x, 0])), lambda x: x, "0.3"),
    "clip": (lambda x: np.clip(x, 0, 1) + np.clip(np.array([x]), 0, 0.25)[0],
             lambda x: x + MP.mpf(1) / 4, "0.3"),
    "where": (lambda x: np.where(np.array([x]) > 0, np.array([x * x]), 1)[0],
              lambda x: x * x, "0.3"),
    "finite": (lambda x: x if np.isfinite(np.array([x])).all() and not np.isnan(x) else 0,
               lambda x: x, "0.3"),
    "near": (lambda x: x if np.allclose(np.array([x]), np.array([x + 1e-12])) else 0,
             lambda x: x, "0.3"),
    "far": (lambda x: 0 * x if np.allclose([x, x], np.array([x, x + 1e-3])) else x,
            lambda x: x, "0.3"),
    "cbrt below 0": (lambda x: math.cbrt(x), lambda x: -MP.cbrt(-x), "-1.7"),
}  # fmt: skip
PI = math.pi


def digits(x: "gmpy2.mpfr") -> Any:
    return MP.mpf(str(x))


@pytest.mark.parametrize("name", [*SMOOTH, *BY_COMPARISONS])
def test_values_and_derivatives_are_those_of_mpmath(name: str) -> None:
    function, by_mpmath, at = {**SMOOTH, **BY_COMPARISONS}[name]
    kind, x = Duals(), MP.mpf(Fraction(at).numerator) / Fraction(at).denominator
    with kind.running():
        found = copy_function(function, kind)(kind.state(Fraction(at), Fraction(0))[0])
    assert abs(digits(found.value) - by_mpmath(x)) < 1e-50
    assert abs(digits(found.slopes[0]) - MP.diff(by_mpmath, x)) < 1e-20


@pytest.mark.parametrize("name", SMOOTH)
def test_a_trace_is_the_same_function(name: str) -> None:
    function, by_mpmath, at = SMOOTH[name]
    tape, kind = Tape(), Duals()
    node = copy_function(function, tape)(tape.symbol("x")).node
    tape.check()
    assert tape.surroundings.texts == []
    assert not tape.rounded
    x = MP.mpf(Fraction(at).numerator) / Fraction(at).denominator
    with kind.running():
        symbols = {"x": kind.rational(Fraction(at))}
        made = evaluate_nodes(in_order(node), replay_in(kind, symbols))
    assert abs(digits(made[node.number].value) - by_mpmath(x)) < 1e-50


@pytest.mark.parametrize("name", sorted(set(BY_COMPARISONS) - {"cbrt below 0"}))
def test_symbols_are_not_compared(name: str) -> None:
    tape = Tape()
    with pytest.raises(UntraceableError, match="compares"):
        copy_function(BY_COMPARISONS[name][0], tape)(tape.symbol("x"))


@pytest.mark.parametrize(
    ("function", "where"),
    [
        (lambda x: math.asin(x), "1 - x**2 > 0"),
        (lambda x: math.cbrt(x), "x > 0"),
        (lambda x: np.log2(x), "x > 0"),
        (lambda x: np.arctan2(1, x), "x + sqrt(x**2 + 1) != 0"),
        (lambda x: np.linalg.inv(np.array([[x]]))[0, 0], "x != 0"),
    ],
)
def test_a_domain_is_said_with_it(function: Callable[..., Any], where: str) -> None:
    tape = Tape()
    copy_function(function, tape)(tape.symbol("x"))
    assert domain_of(tape).texts == (where,)


@pytest.mark.parametrize("kind", [Duals(), Tape()])
def test_what_is_asked_of_plain_numbers_still_counts(kind: Kind) -> None:
    def stages(x: Any) -> Any:
        for _ in range(int(math.log2(8)) + int(np.maximum(1, 2))):
            x = x + 1
        return x

    with Duals().running():
        assert (copy_function(stages, kind)(kind.rational(Fraction(1)))).exact_value() == 6


@pytest.mark.parametrize("angle", range(-175, 180, 10))
def test_angles_of_all_quadrants_are_in_order(angle: int) -> None:
    kind = Duals()
    x, y = (Fraction(f(math.radians(angle))) for f in (math.cos, math.sin))
    with kind.running():
        found = kind.rational(y).arctan2(kind.rational(x))
        assert abs(found.value - math.atan2(y, x)) < 1e-15
    tape = Tape()
    node = (tape.symbol("y").arctan2(tape.symbol("x"))).node
    with kind.running():
        symbols = {"x": kind.rational(x), "y": kind.rational(y)}
        traced = evaluate_nodes(in_order(node), replay_in(kind, symbols))[node.number]
        assert abs(traced.value - found.value) < 1e-55
