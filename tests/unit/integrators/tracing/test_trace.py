"""Traced steps: what the series and the shears are, against sympy and against the trace itself."""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import pytest
import sympy

from tests.helpers.programs import user_steps as own_steps
from verify.algebra.formula import symbol
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.tracing.trace import Tape, expressions, in_order
from verify.integrators.tracing.traced_map import _Peeler, shears_of, traced_map
from verify.integrators.tracing.traced_number import UntraceableError, constant, read_float
from verify.integrators.tracing.traced_series import TracedSeries

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
P, Q, H = symbol("p"), symbol("q"), symbol("h")


def traced(function: Callable[..., Any]) -> tuple[Any, Any, Tape]:
    tape = Tape()
    p, q = copy_function(function, tape)(*(tape.symbol(name) for name in "pqh"))
    return (p * 1).node, (q * 1).node, tape


FUNCTIONS: list[Callable[..., Any]] = [
    lambda p, q, h: (math.sin(q + h * p), np.cos(p - h)),
    lambda p, q, h: (math.tan(q + h), math.tanh(p * h + q)),
    lambda p, q, h: (math.exp(h * q), math.log(2 + q * q + h)),
    lambda p, q, h: (math.sqrt(1 + p * p + h), math.atan(q - h * p)),
    lambda p, q, h: (math.asinh(p * h - q), np.arcsinh(q * q + h)),
    lambda p, q, h: (math.sinh(h + p), np.cosh(h * q)),
    lambda p, q, h: ((q + h) ** -2, (1 + q * q + h) ** 1.5),
    lambda p, q, h: (p / (1 + h * q), math.pow(q + h, 3)),
    lambda p, q, h: (math.expm1(h * p), math.log1p(h * h + q * q)),
    lambda p, q, h: (math.hypot(1, p + h), math.pi * h + p + math.e),
]


@pytest.mark.parametrize("function", FUNCTIONS)
def test_the_series_is_that_which_sympy_derives(function: Callable[..., Any]) -> None:
    p, q, _ = traced(function)
    field, series = TracedSeries((p, q), partial(canonical_field, PENDULUM))(4)
    written = expressions(in_order(p, q), {})
    at = {P: sympy.Rational(3, 7), Q: sympy.Rational(5, 11)}
    for node, found in zip((p, q), series, strict=True):
        for n, coefficient in enumerate(found.coefficients):
            known = written[node.number].diff(H, n).subs(H, 0) / math.factorial(n)
            gap = (field.ring.expression(coefficient) - known).subs(at)
            assert abs(sympy.N(gap, 30)) < 1e-25


@pytest.mark.parametrize(
    ("name", "count"),
    [("euler_a", 2), ("verlet", 3), ("yoshida", 7), ("rk4", 0), ("lie2", 0), ("explicit", 0)],
)
def test_shears_compose_to_the_trace(name: str, count: int) -> None:
    p, q, _ = traced(getattr(own_steps, name))
    assert (shears_of(PENDULUM, p, q) or 0) == count
    shears = _Peeler(in_order(p, q)).shears(p, q) or []
    assert len(shears) == count
    written = expressions(in_order(p, q), {})
    x, y = P, Q
    for shear in shears:
        put = {P: x, Q: y}
        moved = shear.increment.subs(put, simultaneous=True)
        assert not shear.increment.has({"p": P, "q": Q}[shear.name])
        x, y = (x + moved, y) if shear.name == "p" else (x, y + moved)
    at = {P: sympy.Rational(3, 7), Q: sympy.Rational(5, 11), H: sympy.Rational(1, 3)}
    for mine, node in ((x, p), (y, q)):
        gap = abs(sympy.N((mine - written[node.number]).subs(at), 30))
        assert bool(gap < 1e-25) is bool(shears)


def test_a_step_that_is_nearly_shears_is_none() -> None:
    p, q, _ = traced(own_steps.nearly_verlet)
    assert shears_of(PENDULUM, p, q) is None
    assert not traced_map(PENDULUM, (p, q)).step_map.preserves_area


@pytest.mark.parametrize(
    ("value", "read"),
    [
        (0.1, Fraction(1, 10)),
        (1 / 6, Fraction(1, 6)),
        (-2 / 3, Fraction(-2, 3)),
        (0.675603595979, Fraction("0.675603595979")),
        (1e-30, Fraction(1, 10**30)),
        (1.3512071919596578, None),
        (math.pi, None),
        (math.nextafter(1 / 6, 1), None),
    ],
)
def test_a_float_is_read_as_what_it_is_written_for(value: float, read: Fraction | None) -> None:
    assert read_float(value) == read


@pytest.mark.parametrize(
    ("value", "rounded"),
    [
        (3776010000000.25, False),
        (75674920197265.0, False),
        (0.375, False),
        (75674920197265.2, True),  # G·m·M, whose exact value is …265.203125
        (-3.77601e21 * 6.7895e-05 * 0.000295176, True),
    ],
)
def test_a_product_that_is_rounded_counts_as_rounded(value: float, rounded: bool) -> None:
    tape = Tape()
    constant(tape, value)
    assert bool(tape.rounded) is rounded
    assert not tape.readings


def test_the_users_module_is_not_changed() -> None:
    before = dict(vars(own_steps))
    traced(own_steps.verlet)
    assert dict(vars(own_steps)) == before
    assert own_steps.verlet(0.5, 0.5, 0.1)[0] < 0.5


def test_closures_defaults_and_helpers_are_replaced_too() -> None:
    def made(function: Callable[[Any], Any]) -> Callable[..., Any]:
        def step(p: Any, q: Any, h: Any, *, scale: Any = own_steps.force) -> Any:
            return p + h * scale(q), q + h * function(p)

        return step

    p, q, _ = traced(made(math.sin))
    written = expressions(in_order(p, q), {})
    assert written[p.number] == P - H * sympy.sin(Q)
    assert written[q.number] == Q + H * sympy.sin(P)


@pytest.mark.parametrize(
    "function",
    [
        lambda p, q, h: (p if q > 0 else q, q),
        lambda p, q, h: (math.floor(p), q),
        lambda p, q, h: (np.array([p, q], dtype=np.float32)[0], q),
        lambda p, q, h: (p * 1j, q),
        lambda p, q, h: (abs(p), q),
    ],
)
def test_what_is_no_smooth_function_of_symbols_is_not_traced(function: Callable[..., Any]) -> None:
    with pytest.raises((UntraceableError, TypeError)):
        traced(function)


def test_roots_of_numbers_stay_exact() -> None:
    p, _, tape = traced(lambda p, q, h: (p * math.sqrt(3) ** 2, q + h))
    assert expressions(in_order(p), {})[p.number] == 3 * P
    assert not tape.rounded
