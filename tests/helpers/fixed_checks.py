"""What wide fixed-point numbers are held to: checks on a `Format`, at any width.

Operations are held against exact rationals, functions against flint's balls at twice the precision,
both within the error that `verify.kernels.rounding` states. test_fixed.py draws the operands, and
test_fixed_controls.py plants losses that these checks have to catch.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import flint

from verify.algebra.enclosure import BALLS
from verify.arithmetic.arb import bounds, midpoint_and_radius, rational_ball
from verify.arithmetic.compiled import engine
from verify.arithmetic.compiled.engine import Fixed
from verify.arithmetic.systems import fixed
from verify.arithmetic.wide.table_series import _STEPS_PER_OCTAVE, _STEPS_PER_TURN
from verify.functions import in_rings

WIDTHS = (128, 156, 192, 256, 320, 512)
WIDEST = 1024
FRACTION_OF = 16  # bits less than the width are after the point
RANGE = 2**15
OPERATORS = ("<", "<=", ">", ">=", "==", "!=")
CALLS = {
    **{name: f"{name}(x)" for name, f in in_rings().items() if f.fixed is not None},
    "root": "sqrt(x)",
    "inverse": "1 / x",
}
ONES = 2**64 - 1


class Format:
    """The numbers of one width; functions of them are compiled when they are first called."""

    def __init__(
        self, width: int, compiled: Callable[..., Callable[..., Any]] = engine.compile_source
    ) -> None:
        self.width, self.bits = width, width - FRACTION_OF
        self.made = fixed.at_bits(self.bits)
        self._compiled = compiled
        self._functions: dict[str, Callable[..., Any]] = {}
        self._least: dict[str, Fraction] = {}

    def call(self, source: str, *arguments: Any) -> Any:
        """What a source's function f gives."""
        if source not in self._functions:
            names = self.made.functions
            self._functions[source] = self._compiled(source, self.bits, names)
        return self._functions[source](*arguments)

    def number(self, raw: int) -> Fixed:
        return Fixed(raw, self.bits)

    def value(self, raw: int) -> Fraction:
        return Fraction(raw, 2**self.bits)

    def stated(self, kind: str, true: Fraction) -> Fraction:
        """The error that `verify.kernels.rounding` states of an operation with this result."""
        with flint.ctx.workprec(64):
            rounding = self.made.rounding
            assert rounding is not None
            own = rounding(kind, 2, abs(rational_ball(true)))
            return bounds(own)[1]

    def allows(self, error: Fraction, kind: str, true: Fraction) -> bool:
        """Whether an error is within what is stated.

        That does not fall with |true|: for most what is stated at 0, computed once, answers.
        """
        if kind not in self._least:
            self._least[kind] = self.stated(kind, Fraction(0))
        return error <= self._least[kind] or error <= self.stated(kind, true)


format_of = cache(Format)


# -- operands -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Shape:
    """An operand for any width: limbs from the highest, then `fill`, shifted down, plus `add`."""

    limbs: tuple[int, ...]
    fill: int
    shift: int = 0
    add: int = 0

    def raw(self, width: int) -> int:
        words = (*self.limbs, *[self.fill] * 16)[: -(-width // 64)]
        number = int.from_bytes(b"".join(w.to_bytes(8, "big") for w in words), "big", signed=True)
        number >>= -width % 64
        top = 1 << (width - 1)
        return max(-top, min(top - 1, (number >> self.shift % width) + self.add))


@dataclass(frozen=True)
class Near:
    """An operand near k·step: where a table's entry changes, or a function its sign."""

    step: str
    k: Fraction
    offset: Fraction
    add: int = 0

    def raw(self, width: int) -> int:
        top = 1 << (width - 1)
        at = round((self.k * step_of(self.step) + self.offset) * 2 ** (width - FRACTION_OF))
        return max(-top, min(top - 1, at + self.add))


@cache
def step_of(name: str) -> Fraction:
    """An arb constant as a rational, to more bits than any width here."""
    with flint.ctx.workprec(2 * WIDEST):
        exact = {
            "angle": 2 * flint.arb.pi() / _STEPS_PER_TURN,
            "octave": flint.arb(2).log() / _STEPS_PER_OCTAVE,
        }
        return midpoint_and_radius(exact[name])[0] if name in exact else Fraction(1)


LIMBS = (0, 1, 2**32, 2**63 - 1, 2**63, 2**64 - 2, ONES)
HARD = [
    *(Shape((high,), fill, 0, add) for high in LIMBS for fill in (0, ONES) for add in (-1, 0, 1)),
    *(Shape((high, low), fill, 13) for high in (1, 2**63, ONES) for low in LIMBS
      for fill in (0, 1, 2**63, ONES)),
    *(Shape((2**62,), 0, shift, add) for shift in (15, 47, 63, 64, 65, 111, 126, 127)
      for add in (-1, 0, 1)),
]  # fmt: skip


# -- operations -----------------------------------------------------------------------------------

_COMPARED = "".join(f"    c{i} = 0\n    if x {op} y: c{i} = 1\n" for i, op in enumerate(OPERATORS))
_FLAGS = ", ".join(f"c{i}" for i in range(len(OPERATORS)))
OPERATIONS = (
    f"def f(x, y):\n{_COMPARED}    return x + y, x - y, x * y, x * x, -x, abs(x), {_FLAGS}\n"
)
OF_SUMS = f"def f(x: 'sum', y):\n{_COMPARED}    return x + y, x - y, -x, abs(x), {_FLAGS}\n"


def check_operations(form: Format, x: int, y: int) -> None:
    """+ − and comparisons are exact, products within what is stated, where they are in range."""
    found = form.call(OPERATIONS, form.number(x), form.number(y))
    a, b = form.value(x), form.value(y)
    true = (a + b, a - b, a * b, a * a, -a, abs(a))
    for name, got, exact in zip(("+", "-", "*", "square", "neg", "abs"), found, true, strict=False):
        if not -RANGE <= exact < RANGE:
            continue  # the limits of a run see to it that it does not come to this
        error = abs(form.made.exact(got) - exact)
        rounded = name in ("*", "square")
        assert error == 0 or (rounded and form.allows(error, "mul", exact)), (
            f"{name} of {x:#x} and {y:#x} in {form.width} bits: {units(form, error)} units off"
        )
    check_comparisons(a, b, found[len(true) :])


def check_comparisons(a: Fraction, b: Fraction, found: tuple[int, ...]) -> None:
    true = (a < b, a <= b, a > b, a >= b, a == b, a != b)
    for operator, got, exact in zip(OPERATORS, found, true, strict=True):
        assert got == exact, f"{a} {operator} {b} is taken to be {bool(got)}"


def check_sums(form: Format, x: int, y: int) -> None:
    """Sums, with 64 bits more, take numbers exactly; x is such a sum."""
    found = form.call(OF_SUMS, form.number(x), form.number(y))
    raws = x + y, x - y, -x, abs(x)
    for got, exact in zip(found, raws, strict=False):
        if -RANGE << 64 <= form.value(exact) < RANGE << 64:
            assert got.raw == exact, f"sums of {x:#x} and {y:#x} in {form.width} bits"
    check_comparisons(form.value(x), form.value(y), found[len(raws) :])


def units(form: Format, error: Fraction) -> float:
    return float(error * 2**form.bits)


# -- float64 --------------------------------------------------------------------------------------


def check_wide(form: Format, x: float) -> None:
    """A float64 is taken but for bits below the last place, and refused beyond the range."""
    try:
        found = form.call("def f(x: 'float'): return wide(x)\n", x)
    except ValueError:
        assert not abs(x) < RANGE, f"{x!r} is refused"
        return
    assert abs(x) < RANGE, f"{x!r} is taken for {found}"
    assert found.raw == math.trunc(Fraction(x) * 2**form.bits), f"{x!r} in {form.width} bits"


def check_approx(form: Format, x: int) -> None:
    """Back in float64 it is as near as the tangent map's certificate takes it to be."""
    found = Fraction(form.call("def f(x): return approx(x)\n", form.number(x)))
    error, true = abs(found - form.value(x)), abs(form.value(x))
    assert error <= true / 2**52 + Fraction(1, 2**96), f"{x:#x} in {form.width} bits"


# -- functions ------------------------------------------------------------------------------------


def defined(form: Format, kind: str, x: Fraction) -> bool | None:
    """Whether the function is given there; None within a unit of the border.

    Its value has to be in the format, and its slope; sinh and cosh are given while e^|x| < 2^14.
    """
    unit, octave = form.value(1), _STEPS_PER_OCTAVE * step_of("octave")
    match kind:
        case "exp" | "sinh" | "cosh":
            inside = 15 * octave - x if kind == "exp" else 14 * octave - abs(x)
            return None if abs(inside) <= 8 * unit else inside > 0
        case "log":
            return x > unit / 2
        case "root":
            return x > Fraction(1, 2**26) - unit / 2
        case "inverse":
            return abs(x) > Fraction(1, 2**14) - unit / 2
        case "asinh":
            return x > -RANGE  # whose size is no number
    return True


def check_function(form: Format, kind: str, raw: int) -> None:
    """A function has a value exactly where it is said to, and that within what is stated."""
    x, what = form.value(raw), f"{kind} of {raw:#x} in {form.width} bits"
    given = defined(form, kind, x)
    try:
        found = form.made.exact(form.call(f"def f(x): return {CALLS[kind]}\n", form.number(raw)))
    except ValueError:
        assert given is not True, f"{what} is refused"
        return
    assert given is not False, f"{what} is taken for {float(found)}"
    with flint.ctx.workprec(2 * form.width + 64):
        true, slack = midpoint_and_radius(BALLS[kind](rational_ball(x), 2))
    error = abs(found - true)
    assert form.allows(error - slack, kind, true), f"{what}: {units(form, error)} units off"
