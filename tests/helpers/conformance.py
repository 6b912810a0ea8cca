"""What every number system is held to, as checks on an `Arithmetic`, whichever it is.

Numbers and operations are held against exact rationals, functions against flint's balls at twice
the precision. The comparison goes by type: a number that is rounded may be off by so many units in
the last place (½ where it is rounded correctly), an enclosure has to contain the true value and to
be no wider than some units. The last place is that of the true value, or that of the format where
that has so many places after the point; such a format refuses what is beyond its range.
test_conformance_controls.py shows that the checks catch small lies.
"""

import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import flint

from verify.algebra.enclosure import BALLS
from verify.arithmetic.arb import bounds, midpoint_and_radius, rational_ball
from verify.arithmetic.number_system import Arithmetic
from verify.functions import in_rings

ZERO, HALF = Fraction(0), Fraction(1, 2)
# Units in the last place that a function may be off: libm keeps within 2, mpmath within 1, MPFR
# rounds correctly. What is not listed has what a good library keeps to.
FUNCTION_ULPS = {"mpfr": HALF}
GOOD_LIBRARY = Fraction(4)
# Units in the last place that an enclosure's radius may have. Arb rounds a midpoint towards zero,
# and a radius, of 30 bits, upwards; it takes roots by the logarithm, at the cost of the exponent's
# bits.
WIDTH, FUNCTION_WIDTH, ROOT_WIDTH = 1 + Fraction(1, 2**20), Fraction(4), Fraction(64)
RANGE = 2**15  # numbers with so many places after the point are below it
LEAST_RADICAND = Fraction(1, 2**26)  # of them, the least that has a square root there
HYPERBOLIC_RANGE = 2**13  # sinh and cosh are given below it

OPERATIONS = "x + y", "x - y", "x * y", "x / y", "-x", "abs(x)"
MODERATE = [Fraction(n, 37) for n in (-401, -100, -58, -37, -5, -1, 1, 3, 29, 58, 117, 777)]
POSITIVE = [Fraction(1, 10**30), *(x for x in MODERATE if x > 0), Fraction(7 * 10**40, 3)]
HUGE = [Fraction(10**9, 7), Fraction(10**20, 7), Fraction(10**22)]
POINTS = {
    **{name: [*MODERATE, *HUGE, Fraction(1, 10**30)] for name in in_rings()},
    "exp": MODERATE, "sinh": MODERATE, "cosh": MODERATE, "log": POSITIVE,
}  # fmt: skip
RADICANDS = [*POSITIVE, Fraction(8), Fraction(10**200), Fraction(1, 10**200)]

_COMPILED: dict[tuple[int, str], tuple[Arithmetic, Callable[..., Any]]] = {}


def function(made: Arithmetic, source: str) -> Callable[..., Any]:
    """`arguments: value` as a function, compiled and called the way that a kernel is."""
    # By identity: what is equal to this arithmetic may be the same with a lie in it.
    _, compiled = _COMPILED.get((id(made), source), (None, None))
    if compiled is None:
        arguments, _, value = source.partition(":")
        compiled = made.compile(f"def f({arguments}): return {value}\n", "f", made.functions)
        _COMPILED[id(made), source] = made, compiled

    def called(*numbers: Any) -> Any:
        with made.context():
            return compiled(*numbers)

    return called


def rounded(made: Arithmetic, x: Fraction) -> tuple[Any, Fraction]:
    """A number of the arithmetic near x that is exact, and the rational that it is."""
    value = made.exact(made.number(x))
    return made.number(value), value


def unit(made: Arithmetic, x: Fraction) -> Fraction:
    """The unit in the last place of a number with the size of x."""
    if made.absolute:
        return Fraction(1, 2**made.bits)
    if x == 0:
        return Fraction(0)
    size = abs(x)
    exponent = size.numerator.bit_length() - size.denominator.bit_length()
    exponent -= size < Fraction(2) ** exponent
    return Fraction(2) ** (exponent - made.bits + 1)


def in_range(made: Arithmetic, *values: Fraction) -> bool:
    """Whether the arithmetic has a range that holds the values, or has none to speak of."""
    return not made.absolute or all(abs(x) < RANGE for x in values)


def lacks(made: Arithmetic, source: str) -> bool:
    """Whether it has not all functions of the source; a kernel that needs them is refused."""
    called = set(re.findall(r"(\w+)\(", source)) - {"abs"}
    return made.absolute and not called <= set(made.functions)


def stated_ulps(made: Arithmetic, kind: str, value: Fraction) -> Fraction:
    """The units in the last place that an operation with this value may be off."""
    if not made.absolute:
        return FUNCTION_ULPS.get(made.name, GOOD_LIBRARY)
    with flint.ctx.workprec(64):
        assert made.rounding is not None
        own = made.rounding(kind, 2, abs(rational_ball(value)))
        return bounds(own)[1] * 2**made.bits


def assert_right(
    made: Arithmetic,
    found: Any,
    true: Fraction,
    what: str,
    *,
    ulps: Fraction = HALF,
    width: Fraction = WIDTH,
    slack: Fraction = ZERO,
) -> None:
    """`found`, got from exact numbers, is `true` as well as the arithmetic promises.

    `slack`: how far `true` itself may be off.
    """
    error, ulp = abs(made.exact(found) - true), unit(made, true)
    off = f"{what} is {float(error / ulp) if ulp else error} ulp off"
    if made.radius is None:
        assert error <= ulps * ulp + slack, off
        return
    radius = made.radius(found)
    assert error <= radius + slack, f"{off} and does not say so"
    assert radius <= width * ulp, f"{what} is {float(radius / ulp)} ulp wide"


def assert_encloses(
    made: Arithmetic, found: Any, true: Fraction, what: str, slack: Fraction = ZERO
) -> None:
    """An enclosure, got from enclosures of the arguments, contains the value at them."""
    if made.radius is not None:
        error = abs(made.exact(found) - true)
        assert error <= made.radius(found) + slack, f"{what} does not contain the true value"


# -- numbers and operations -----------------------------------------------------------------------


def check_number(made: Arithmetic, x: Fraction) -> None:
    """x is rounded once, to the nearest or to a ball that holds it, and is read back exactly."""
    number = made.number(x)
    assert isinstance(made.exact(number), Fraction)
    assert made.finite(number)
    assert_right(made, number, x, f"the number {x}")
    again, value = rounded(made, x)
    assert made.exact(again) == value
    assert made.radius is None or made.radius(again) == 0
    with made.context():
        assert made.exact(-number) == made.exact(made.number(-x))


def check_operations(made: Arithmetic, x: Fraction, y: Fraction) -> None:
    """Each operation is rounded once; in a format of fixed places a quotient is so twice."""
    x, y = fitting(made, x), fitting(made, y)
    a, exact_a = rounded(made, x)
    b, exact_b = rounded(made, y)
    for operation in OPERATIONS:
        apply = function(made, f"x, y: {operation}")
        what = f"{operation} at {x}, {y}"
        true = value_of(operation, exact_a, exact_b)
        assert_right(made, apply(a, b), true, what, ulps=operation_ulps(made, operation, a, b))
        wide = apply(made.number(x), made.number(y))
        assert_encloses(made, wide, value_of(operation, x, y), what)


def fitting(made: Arithmetic, x: Fraction) -> Fraction:
    """x, or x times a power of ten such that sums, products and quotients are in range."""
    while not in_range(made, x * 1000):
        x /= 1000
    while made.absolute and abs(x) < Fraction(1, 100):
        x = x * 1000 or HALF
    return x


def operation_ulps(made: Arithmetic, operation: str, a: Any, b: Any) -> Fraction:
    """The units in the last place that an operation may be off."""
    if not made.absolute:
        return HALF
    product = stated_ulps(made, "mul", ZERO)
    if operation == "x / y":
        inverse = 1 / made.exact(b)
        return abs(made.exact(a)) * stated_ulps(made, "inverse", inverse) + product
    return product if operation == "x * y" else ZERO


def value_of(operation: str, x: Fraction, y: Fraction) -> Fraction:
    return Fraction(eval(operation, {}, {"x": x, "y": y}))  # noqa: S307 - this file's own text


# -- functions ------------------------------------------------------------------------------------


def true_value(kind: str, x: Fraction, bits: int, degree: int = 1) -> tuple[Fraction, Fraction]:
    """The function's value and the radius of its enclosure, by flint at twice the precision."""
    with flint.ctx.workprec(2 * bits + 200):
        return midpoint_and_radius(
            BALLS[kind](flint.arb(flint.fmpq(x.numerator, x.denominator)), degree)
        )


def check_function(made: Arithmetic, kind: str, point: Fraction, degree: int = 1) -> None:
    """A function of one argument is as accurate as its arithmetic, or encloses."""
    call = {1: f"{kind}(x)", 2: "sqrt(x)"}.get(degree, f"root(x, {degree})")
    check_values(made, f"x: ({call},)", (kind,), point, degree)


def check_pair(made: Arithmetic, name: str, point: Fraction) -> None:
    """`cos_sin` or `sin_cos`, which give both in one call, in the order of their names."""
    check_values(made, f"x: {name}(x)", tuple(name.split("_")), point)


def check_values(
    made: Arithmetic, source: str, kinds: tuple[str, ...], point: Fraction, degree: int = 1
) -> None:
    if lacks(made, source):
        return
    apply, (x, exact_x) = function(made, source), rounded(made, point)
    values = [true_value(kind, exact_x, made.bits, degree) for kind in kinds]
    if beyond(made, exact_x, *(true for true, _ in values), kinds=kinds):
        check_undefined(made, source, point)
        return
    width = FUNCTION_WIDTH if degree == 1 else ROOT_WIDTH
    near, wide = apply(x), apply(made.number(point))
    for kind, (true, slack), found, around in zip(kinds, values, near, wide, strict=True):
        what = f"{kind}({point})"
        ulps = stated_ulps(made, kind, true)
        assert_right(made, found, true, what, ulps=ulps, width=width, slack=slack)
        true, slack = true_value(kind, point, made.bits, degree)
        assert_encloses(made, around, true, what, slack)


def beyond(made: Arithmetic, x: Fraction, *values: Fraction, kinds: tuple[str, ...]) -> bool:
    """Whether a format with a range refuses the argument or has no number for a value.

    Then that is what is checked, and not that it is accurate.
    """
    refused = x < LEAST_RADICAND if "root" in kinds else max(map(abs, values)) >= HYPERBOLIC_RANGE
    partial = made.absolute and not {"root", "sinh", "cosh"}.isdisjoint(kinds)
    return (partial and refused) or not in_range(made, x, *values)


def check_pi(made: Arithmetic) -> None:
    with flint.ctx.workprec(2 * made.bits + 200):
        true, slack = midpoint_and_radius(flint.arb.pi())
    assert_right(made, made.functions["pi"], true, "π", slack=slack)


def check_undefined(made: Arithmetic, source: str, x: Fraction) -> None:
    """What is not a number is raised, or is no finite number: a run finds it either way."""
    if lacks(made, source):
        return
    try:
        value = function(made, source)(made.number(x))
    except (ArithmeticError, ValueError):
        return
    assert not made.finite(value), f"{source} at {x} is taken for a number"


def check_extremes(made: Arithmetic, x: Fraction, y: Fraction) -> None:
    """Where the arithmetic chooses extremes itself: they enclose those of the true values."""
    for name, choose in (("minimum", min), ("maximum", max)):
        if name in made.functions:
            for around in (Fraction(0), abs(x) / 2**made.bits, abs(x) / 2 ** (made.bits // 2)):
                found = function(made, f"x, y: {name}(x, y)")(
                    made.number(x + around), made.number(y)
                )
                assert_encloses(made, found, choose(x + around, y), name)
