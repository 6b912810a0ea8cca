"""Every number system at drawn precisions, on drawn numbers: what it rounds, encloses and refuses.

The checks are those of `tests.helpers.conformance`, which says how much each system may be off.
"""

import math
import struct
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers import conformance
from verify import arithmetic
from verify.arithmetic.number_system import ESCAPE_BITS, MAX_EXPONENT, Arithmetic
from verify.arithmetic.systems import fixed, float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run

FLOATING = ("mpfr", "mpmath", "ball")
quick = drawn(30)
get = cache(arithmetic.get)
systems = st.one_of(
    st.builds(get, st.sampled_from(FLOATING), st.integers(1, 120)),
    st.just(get("float64", 17)),
    st.sampled_from([20, 34]).map(lambda digits: get("fixed", digits)),
)
numbers = st.builds(
    lambda x, e: x * Fraction(10) ** e,
    st.fractions(min_value=-10, max_value=10, max_denominator=10**9),
    st.integers(-30, 30),
)


@quick
@given(systems, numbers, numbers.filter(bool))
def test_numbers_and_operations_are_rounded_once(
    made: Arithmetic, x: Fraction, y: Fraction
) -> None:
    conformance.check_number(made, conformance.fitting(made, x))
    if not made.absolute:  # it is compiled for each operation; tests/unit has it
        conformance.check_operations(made, x, y)
        conformance.check_extremes(made, x, y)


@quick
@given(st.sampled_from(FLOATING), st.integers(1, 400))
def test_a_system_has_the_digits_that_were_asked_for(name: str, digits: int) -> None:
    made = arithmetic.get(name, digits)
    assert made.name == name
    assert 10**digits <= 2**made.bits < 40 * 10**digits
    assert made.absolute is False
    conformance.check_pi(made)
    conformance.check_number(made, Fraction(1, 3))


def test_the_fixed_format_is_the_narrowest_for_all_digits() -> None:
    """Whole words of 64 bits, or three limbs of 52."""
    formats = sorted([140, *(64 * n - 16 for n in range(2, 40))])
    for digits in range(1, 500):
        made = next(bits for bits in formats if 2 ** (bits + 1) >= 10**digits)
        assert fixed.make(digits).bits == made


@quick
@given(st.integers(1, 400))
def test_a_fixed_format_rounds_to_its_last_place(digits: int) -> None:
    made = fixed.make(digits)
    assert made.chunk >= 1
    assert made.absolute
    third = made.number(Fraction(1, 3))
    assert abs(made.exact(third) - Fraction(1, 3)) <= Fraction(1, 2 ** (made.bits + 1))
    pi = made.exact(made.functions["pi"])
    with mpmath.workdps(digits + 30):
        apart = abs(mpmath.mpf(pi.numerator) / pi.denominator - mpmath.pi)
        assert apart <= mpmath.mpf(2) ** -(made.bits + 1)
    assert made.finite(third)
    assert made.finite(1.5)
    assert not any(made.finite(x) for x in (math.inf, -math.inf, math.nan))
    assert made.exact(0.75) == Fraction(3, 4)


@quick
@given(st.sampled_from([*FLOATING, "float64"]), st.integers(17, 60), st.data())
def test_a_function_is_as_accurate_as_its_system(
    name: str, digits: int, data: st.DataObject
) -> None:
    made = get(name, digits)
    kind = data.draw(st.sampled_from(sorted(conformance.POINTS)))
    conformance.check_function(made, kind, data.draw(st.sampled_from(conformance.POINTS[kind])))
    degree = data.draw(st.integers(2, 7))
    conformance.check_function(
        made, "root", data.draw(st.sampled_from(conformance.RADICANDS)), degree
    )
    undefined = ["log(-x)", "sqrt(-x)", "root(-x, 3)", "root(-x, 4)", "1 / (x - x)"]
    source = data.draw(st.sampled_from(undefined))
    conformance.check_undefined(made, f"x: {source}", Fraction(1, 3))
    for f in {"cos_sin", "sin_cos"} & set(made.functions):
        conformance.check_pair(made, f, data.draw(st.sampled_from(conformance.POINTS["sin"])))


@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("name", FLOATING)
def test_a_system_without_an_end_of_its_own_stops_where_it_should(name: str, sign: int) -> None:
    """An orbit at 2^4000 and beyond; what is carried beside it at exponents of a million."""
    made = get(name, 30)
    for beside in range(-4, 5):
        x = made.number(sign * Fraction(2) ** (ESCAPE_BITS + beside))
        if made.guard is None:
            assert made.finite(x) == (beside < 0)
            continue
        inside = eval(made.guard.format(x="x"), {"x": x, **made.functions})  # noqa: S307 - our own
        assert inside == (beside < 0)
        for exponent, ends in ((MAX_EXPONENT, beside < 0), (-MAX_EXPONENT, beside >= -1)):
            far = made.number(sign * Fraction(2) ** (exponent + beside))
            assert made.finite(far) == ends
    assert made.finite(made.number(Fraction(1, 3)))
    assert made.chunk >= 1


@pytest.mark.parametrize("name", [*FLOATING, "float64"])
def test_what_was_undefined_on_the_way_is_not_forgotten(name: str) -> None:
    """1/(1/0) is 0 again, and 0 log(−x) may be."""
    made = get(name, 20)
    for source in (
        "1 / (1 / (x - x))", "x + log(-x) * 0", "cosh(1 / (x - x))", "(x - x) / (x - x)",
    ):  # fmt: skip
        if name != "float64" or "1 / (1 /" not in source:
            conformance.check_undefined(made, f"x: {source}", Fraction(1, 3))
    if made.radius is None:  # Arb takes a root by the logarithm, and knows nothing of it at 0
        root = conformance.function(made, "x: root(x, 3)")
        assert made.exact(root(made.number(Fraction(0)))) == 0


# -- float64 as IEEE has it -----------------------------------------------------------------------

ENDS = (0.0, -0.0, 1.0, -1.0, 1e308, -1e308, 5e-324, 711.0, -711.0, math.inf, -math.inf, math.nan)
floats = st.one_of(st.sampled_from(ENDS), st.floats(-3, 3))
SOURCES = {
    "x / y": None,
    "(x + 1.0) / (y - 1.0)": None,
    "exp(x)": "exp",
    "cosh(x)": "cosh",
    "sinh(x)": "sinh",
    "log(x)": "log",
    "sqrt(x)": "sqrt",
    "sin(x)": "sin",
    "cos(x)": "cos",
    "x * y - x": None,
}


def bits(x: float) -> bytes:
    return b"nan" if x != x else struct.pack("d", x)


@cache
def kernels(source: str) -> tuple[Callable[..., float], Callable[..., float]]:
    """That number of times x ← source, in Python and as LLVM compiles it."""
    lines = ["def kernel(steps, x, y):", "    for k in range(steps):", f"        x = {source}"]
    text, functions = "\n".join([*lines, "    return x"]), float64.make(17).functions
    both = float64.make(17), float64.compiled_at_once()
    made = [one.compile(text, "kernel", functions) for one in both]
    return made[0], made[1]


SOME = ("x / y", "exp(x)", "log(x)")


@drawn(60)
@given(st.sampled_from(SOME), floats, floats)
@example("x / y", 0.0, 0.0)
@example("x / y", -1.0, 0.0)
@example("x / y", 1.0, -0.0)
@example("log(x)", 0.0, 0.0)
@example("log(x)", -1.0, 0.0)
@example("exp(x)", 711.0, 0.0)
def test_what_python_refuses_has_the_bits_of_the_compiled_kernel(
    source: str, x: float, y: float
) -> None:
    plain, compiled = kernels(source)
    assert bits(plain(1, x, y)) == bits(compiled(1, x, y))


@drawn(60)
@given(st.sampled_from(sorted(SOURCES)), floats, floats)
@example("sinh(x)", -711.0, 0.0)
@example("sinh(x)", 711.0, 0.0)
@example("cosh(x)", -711.0, 0.0)
@example("sqrt(x)", -1.0, 0.0)
@example("sin(x)", math.inf, 0.0)
@example("cos(x)", math.inf, 0.0)
@example("(x + 1.0) / (y - 1.0)", 2.0, 1.0)
@example("(x + 1.0) / (y - 1.0)", -1.0, 1.0)
def test_float64_goes_on_with_infinities_as_ieee_says(source: str, x: float, y: float) -> None:
    found = kernels(source)[0](1, x, y)
    with mpmath.workdps(30):
        if "/" in source:
            a, b = (x, y) if source == "x / y" else (x + 1.0, y - 1.0)
            if b:
                true = a / b
            elif a and a == a:
                true = math.copysign(math.inf, a) * math.copysign(1.0, b)
            else:
                true = math.nan
        elif SOURCES[source] is None:
            true = x * y - x
        else:
            true = of_ieee(str(SOURCES[source]), x)
    near = 4 * math.ulp(true) if math.isfinite(true) else -1.0  # ulp(∞) is ∞, beside which all is
    assert bits(found) == bits(true) or abs(found - true) <= near


def of_ieee(name: str, x: float) -> float:
    if x != x:
        return x
    if math.isinf(x):
        ends = {"exp": (math.inf, 0.0), "cosh": (math.inf, math.inf), "sinh": (x, x)}
        ends |= {"log": (math.inf, math.nan), "sqrt": (math.inf, math.nan)}
        return ends.get(name, (math.nan, math.nan))[x < 0]
    if name == "log" and x <= 0:
        return math.nan if x < 0 else -math.inf
    if name == "sqrt" and x <= 0:
        return math.nan if x < 0 else x
    value: Any = getattr(mpmath, name)(mpmath.mpf(x))
    if (value and name in ("sinh", "sin")) or name not in ("sinh", "sin"):
        return float(value)
    return x


@quick
@given(st.one_of(numbers, st.sampled_from([Fraction(10) ** 400, -(Fraction(10) ** 400)])))
def test_a_rational_beyond_float64_is_an_infinity_of_its_sign(x: Fraction) -> None:
    found = float64.make(3).number(x)
    if abs(x) > 10**308:
        assert found == (math.inf if x > 0 else -math.inf)
    else:
        assert abs(Fraction(found) - x) <= Fraction(math.ulp(found)) / 2


@drawn(3)
@given(st.integers(1, 3))
def test_a_kernel_is_compiled_once_it_repays_and_says_the_same(part: int) -> None:
    lines = [
        "def kernel(steps, x):",
        "    for k in range(steps):",
        "        x = x * share + more / 3",
    ]
    source = "\n".join([*lines, "    return x"])
    names = {"share": 0.75, "more": 1.0}
    kernel = float64.make(17).compile(source, "kernel", names)
    total, each = 1.0, 22_500
    for _ in range(part):
        total = kernel(each, total)
    once = float64.compiled_at_once().compile(source, "kernel", names)
    assert hasattr(once, "prepare"), "LLVM has made it"
    assert bits(total) == bits(once(part * each, 1.0))


@quick
@given(st.lists(st.integers(1, 15_000), min_size=1, max_size=9), st.booleans())
def test_a_kernel_is_compiled_where_its_steps_would_pass_what_repays(
    parts: list[int], solving: bool
) -> None:
    """50 000 steps, or 10 000 of a kernel with a loop in its loop."""
    inner = "for j in range(1): pass" if solving else "pass"
    source = f"def kernel(steps, x):\n    for k in (1,):\n        {inner}\n    return steps"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(float64, "_compile_now", lambda *_: lambda steps, _: -steps)
        kernel = float64.make(17).compile(source, "kernel", {})
        done, most, compiled = 0, 10_000 if solving else 50_000, False
        for steps in parts:
            compiled = compiled or done + steps > most
            done += steps
            assert kernel(steps, 1.0) == (-steps if compiled else steps)


# -- what runs make of them -----------------------------------------------------------------------


@drawn(8)
@given(st.sampled_from([*FLOATING, "float64"]), st.integers(3, 40), st.integers(1, 9))
def test_an_orbit_that_escapes_is_told_from_one_that_does_not(
    name: str, steps: int, start: int
) -> None:
    """q' = 8 q³ from 1: the exponents treble at each step."""
    free = Hamiltonian.parse("p**2/2")
    found = run(
        free,
        "p_next = p; q_next = 8*q**3",
        q=start,
        p=0,
        step_size=1,
        steps=steps,
        arithmetic=name,
        digits=20,
    )
    limit = 1024 if name == "float64" else ESCAPE_BITS
    size, last = math.log2(start), 0
    while last < steps and size < limit + (64 if name != "float64" else 0):
        size, last = 3 * size + 3, last + 1
    if found.status == "finished":
        assert size < 2 * limit
    else:
        assert found.status == "left range"
        assert abs((found.failed_step or 0) - last) <= 2


def test_the_systems_are_named_and_others_refused() -> None:
    assert set(arithmetic.names()) == {*FLOATING, "float64", "fixed"}
    with pytest.raises(ValueError, match="float63"):
        arithmetic.get("float63", 17)
