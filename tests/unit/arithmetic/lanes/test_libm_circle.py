"""sin and cos of float64 in lanes: glibc's bits, by an argument that mpmath checks step by step."""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from llvmlite import ir

from verify.arithmetic.compiled import doubles, native
from verify.arithmetic.lanes import libm_circle
from verify.arithmetic.lanes.libm_circle import DoubleDouble
from verify.arithmetic.lanes.vectors import CONDITIONS, DOUBLES, LANES, splat_double
from verify.arithmetic.wide.limbs import Value, constant

BOTH = "def kernel(steps, x, s, c):\n    for k in range(steps):\n{}    return steps, x, s, c\n"
LINES = {"sin": "        s = sin(x)\n", "cos": "        c = cos(x)\n"}
QUARTER = 1.5707963267948966
WITHIN = 0.012  # units in the last place, as is promised
pytestmark = pytest.mark.skipif(
    not libm_circle.is_available(),
    reason="glibc and fused multiply-add, of which either is missing",
)


@pytest.fixture(autouse=True)
def compiled_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VERIFY_CACHE", "off")


def arguments(count: int, seed: int) -> np.ndarray:
    """Of all sizes, most of them such as orbits have; beside quarter turns, too."""
    draw = np.random.default_rng(seed)
    usual = draw.uniform(-7, 7, count // 2)
    wide = draw.choice([-1, 1], count // 4) * 2.0 ** draw.uniform(-30, 20, count // 4)
    turns = draw.integers(-40, 40, count // 8) * QUARTER
    beside = turns + draw.choice([-1, 1], count // 8) * 2.0 ** draw.uniform(-50, -1, count // 8)
    return np.concatenate([usual, wide, beside, draw.uniform(0.78, 0.86, count // 8)])


def hard(count: int, seed: int) -> np.ndarray:
    """Far away and close beside quarter turns, as close as is looked at and closer."""
    draw = np.random.default_rng(seed)
    turns = draw.integers(1, 166_886, count) * QUARTER
    return draw.choice([-1, 1], count) * (turns + 2.0 ** draw.uniform(-16, -9, count))


def in_lanes(x: np.ndarray, *wanted: str) -> np.ndarray:
    """sin and cos as `wanted`, a row each, by kernels of many points."""
    source = BOTH.format("".join(LINES[name] for name in wanted))
    run = doubles.on_points(source, {}, 3)
    found = []
    for part in x.reshape(-1, doubles.POINTS_PER_CALL):
        points = np.array([part, np.zeros_like(part), np.zeros_like(part)])
        run(1, np.empty(0), points)
        found.append(points[1:])
    return np.concatenate(found, axis=1)


def by_libm(x: np.ndarray) -> np.ndarray:
    """The same by kernels of one point, which call the C library."""
    one = doubles.one_point(BOTH.format("".join(LINES.values())), {})
    return np.array([one(1, each, 0.0, 0.0)[2:] for each in x.tolist()]).T


def same_bits(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Where they are; one NaN is as good as another."""
    return (x.view(np.int64) == y.view(np.int64)) | (np.isnan(x) & np.isnan(y))


def nearest(name: str, x: float) -> float:
    with mpmath.workprec(200):
        return float(getattr(mpmath, name)(x))


@pytest.mark.parametrize("wanted", [("sin", "cos"), ("sin",), ("cos",)])
def test_lanes_have_the_bits_of_the_c_library(wanted: tuple[str, ...]) -> None:
    x = arguments(32_768, seed=1)
    own, libm = in_lanes(x, *wanted), by_libm(x)
    for name, row, expected in zip(LINES, own, libm, strict=True):
        assert same_bits(row, expected if name in wanted else np.zeros_like(row)).all()


EXTREMES = [0.0, -0.0, 5e-324, -5e-324, 1e-310, 2.0**-26, 2.0**-12, 1.0, 2.0**18, 2.0**18 + 1,
            105414350.0, 1e22, 1.7e308, 0.85546875, float("inf"), float("-inf"), float("nan"),
            *(k * QUARTER for k in range(-8, 9))]  # fmt: skip


# Of glibc's `sincos` the sine is another float64 there than that of its `sin`.
APART = float.fromhex("0x1.ad1fb54442d18p+0")


@pytest.mark.parametrize("wanted", [("sin", "cos"), ("sin",)])
def test_a_sine_beside_a_cosine_is_that_of_the_sine_alone(wanted: tuple[str, ...]) -> None:
    x = np.resize([APART, -APART], doubles.POINTS_PER_CALL)
    assert in_lanes(x, *wanted)[0].tolist() == by_libm(x)[0].tolist() == [*map(math.sin, x)]


def test_extremes_have_the_bits_of_the_c_library() -> None:
    x = np.resize(EXTREMES, 2 * doubles.POINTS_PER_CALL)
    assert same_bits(in_lanes(x, "sin", "cos"), by_libm(x)).all()


def test_without_that_library_lanes_ask_the_one_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(libm_circle, "is_available", lambda: False)
    monkeypatch.setattr(libm_circle, "sin_and_cos", None)  # nothing may ask for it
    x = arguments(1024, seed=2)
    assert same_bits(in_lanes(x, "sin", "cos"), by_libm(x)).all()


def test_with_less_room_lanes_are_right_where_the_library_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With room for their own error alone they give the nearest number, which it does not always
    give: its error must have room, too."""
    monkeypatch.setattr(libm_circle, "SURE_DISTANCE", 0.5 - WITHIN)
    monkeypatch.setattr(libm_circle, "SURE_DISTANCE_NEAR_0", 0.5 - WITHIN)
    x = arguments(1 << 18, seed=3)
    own, libm = in_lanes(x, "sin", "cos"), by_libm(x)
    differ = ~same_bits(own, libm)
    for name, where, values in zip(LINES, differ, own, strict=True):
        assert [nearest(name, each) for each in x[where].tolist()] == values[where].tolist()
    if not differ.any():
        pytest.skip("this glibc rounds correctly: too little room does not show")


# -- the two bounds, and what is left between them -------------------------------------------------


def test_what_both_are_off_leaves_one_float64_alone() -> None:
    assert 1 - libm_circle.SURE_DISTANCE - WITHIN >= 0.518
    assert 1 - libm_circle.SURE_DISTANCE_NEAR_0 - WITHIN >= 0.548


def units(value: Fraction, true: Fraction) -> Fraction:
    """|value − true| in units in the last place of the latter."""
    exponent = int(np.frexp(float(abs(true)))[1])
    return abs(value - true) * Fraction(2) ** (53 - exponent)


def exact(name: str, x: float) -> Fraction:
    with mpmath.workprec(300):
        sign, mantissa, power, _ = getattr(mpmath, name)(mpmath.mpf(x))._mpf_
        return (-1) ** sign * int(mantissa) * Fraction(2) ** power


def test_the_library_is_as_close_as_its_source_says() -> None:
    """Of some: more are no proof either."""
    x = arguments(8_192, seed=4)
    for name, row in zip(LINES, by_libm(x), strict=True):
        for at, y in zip(x.tolist(), row.tolist(), strict=True):
            near_0 = name == "sin" and abs(at) < 0.8555
            assert units(Fraction(y), exact(name, at)) < (0.548 if near_0 else 0.518)


Written = Callable[[ir.IRBuilder, Value], Sequence[Value]]


def called(write: Written) -> Callable[[np.ndarray], list[np.ndarray]]:
    """What is written of a vector, as a function of one; of conditions 1 and 0."""
    module, pointer = ir.Module(), DOUBLES.as_pointer()
    kind = ir.FunctionType(ir.VoidType(), [pointer, pointer])
    b = ir.IRBuilder(ir.Function(module, kind, "main").append_basic_block())
    given, out = b.function.args
    values = write(b, b.load(given, align=8))
    for k, value in enumerate(values):
        word = b.uitofp(value, DOUBLES) if value.type == CONDITIONS else b.bitcast(value, DOUBLES)
        b.store(word, b.gep(out, [constant(k, 64)]), align=8)
    b.ret_void()
    linked, count = native.link(native.machine_code(module)), len(values)

    def call(x: np.ndarray) -> list[np.ndarray]:
        found = np.empty((count, x.size))
        for at in range(0, x.size, LANES):
            given, out = np.ascontiguousarray(x[at : at + LANES]), np.empty((count, LANES))
            linked(given.ctypes.data, out.ctypes.data)
            found[:, at : at + LANES] = out
        return list(found)

    return call


def reduced(b: ir.IRBuilder, x: Value) -> list[Value]:
    found = libm_circle.reduce(b, x)
    return [*found.sine, *found.cosine, found.quarter, found.within]


def farthest(x: np.ndarray) -> tuple[float, int]:
    """By how many units what is not yet rounded is off at most, and of how many arguments."""
    *parts, quarter, within = called(reduced)(x)
    most, where = Fraction(0), np.flatnonzero(within)
    for k in where:
        high, low, cosine, rest = (Fraction(part[k]) for part in parts)
        sine, cosine = high + low, cosine + rest
        turned = [(sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine)]
        own = turned[int(quarter.view(np.int64)[k]) % 4]
        for name, value in zip(LINES, own, strict=True):
            most = max(most, units(value, exact(name, x[k])))
    return float(most), len(where)


def test_before_rounding_they_are_as_close_as_is_promised() -> None:
    x = np.concatenate([arguments(4_096, seed=5), hard(1_024, seed=5)])
    x = np.append(x, [-0.785487354834509] * LANES)  # where most is lost of those that were tried
    most, count = farthest(x)
    assert count > 3_600
    assert 0.008 < most < WITHIN


@pytest.mark.parametrize("part", [1, 2])
def test_a_quarter_turn_with_a_part_less_is_caught(
    part: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    parts = list(libm_circle._quarter_turn())
    parts[part] = 0.0
    monkeypatch.setattr(libm_circle, "_quarter_turn", lambda: tuple(parts))
    most, _ = farthest(arguments(1_024, seed=6))
    assert most > WITHIN


@pytest.mark.parametrize("series", ["_SINE", "_COSINE"])
def test_a_series_without_its_last_term_is_caught(
    series: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(libm_circle, series, getattr(libm_circle, series)[:-1])
    most, _ = farthest(arguments(1_024, seed=7))
    assert most > WITHIN


# -- when the library is asked --------------------------------------------------------------------


def asked(x: np.ndarray) -> dict[str, np.ndarray]:
    """Where it is asked for each function."""

    def unsure(b: ir.IRBuilder, x: Value) -> list[Value]:
        return [each.unsure for each in libm_circle.sin_and_cos(b, x).values()]

    return {name: row != 0 for name, row in zip(LINES, called(unsure)(x), strict=True)}


def test_it_is_asked_for_few() -> None:
    x = np.random.default_rng(8).uniform(-7, 7, 8_192)
    assert all(0.03 < row.mean() < 0.09 for row in asked(x).values())


def test_a_sine_near_0_has_its_own_room(monkeypatch: pytest.MonkeyPatch) -> None:
    """From π/4 on it is the cosine of r."""
    monkeypatch.setattr(libm_circle, "SURE_DISTANCE_NEAR_0", 1e-9)
    for low, high, all_are in ((0.1, 0.78, True), (0.79, 0.855, True), (0.856, 2, False)):
        x = np.random.default_rng(9).uniform(low, high, 1_024)
        assert asked(x)["sin"].all() == all_are == asked(-x)["sin"].all()


@pytest.mark.parametrize("high", [0.5, 0.25, 1.0 - 2.0**-54, 0.5 - 2.0**-55])
def test_beside_a_power_of_two_nothing_is_sure(high: float) -> None:
    def sure(b: ir.IRBuilder, x: Value) -> list[Value]:
        low = b.fmul(x, splat_double(2.0**-60))
        return [libm_circle._round(b, DoubleDouble(x, low), splat_double(1.0))[1]]

    beside, other = called(sure)(np.array([high, high * 0.99] * (LANES // 2)))[0][:2]
    assert (beside, other) == (0, 1)
