"""sin and cos of float64 in lanes: glibc's bits, by an argument that mpmath checks step by step."""

from collections.abc import Callable
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from llvmlite import ir

from verify.arithmetic.compiled import doubles, native
from verify.arithmetic.lanes import libm_circle
from verify.arithmetic.lanes.vectors import DOUBLES
from verify.arithmetic.processor import LANES
from verify.arithmetic.wide.limbs import I64, constant

BOTH = "def kernel(steps, x, s, c):\n    for k in range(steps):\n{}    return steps, x, s, c\n"
LINES = {"sin": "        s = sin(x)\n", "cos": "        c = cos(x)\n"}
QUARTER = 1.5707963267948966
PARTS = ("sine", "sine's rest", "cosine", "cosine's rest", "quarter")
WITHIN = 0.012  # units in the last place, as is promised
pytestmark = pytest.mark.skipif(
    not libm_circle.there(), reason="glibc and fused multiply-add, of which either is missing"
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
    return np.concatenate([usual, wide, beside, np.nextafter(0.8555, [0, 1] * (count // 16))])


def in_lanes(x: np.ndarray, *wanted: str) -> np.ndarray:
    """sin and cos as `wanted`, a row each, by kernels of many points."""
    source = BOTH.format("".join(LINES[name] for name in wanted))
    run = doubles.on_points(source, {}, 3)
    found = []
    for part in x.reshape(-1, doubles.POINTS):
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
            105414350.0, 1e22, 1.7e308, float("inf"), float("-inf"), float("nan"),
            *(k * QUARTER for k in range(-8, 8))]  # fmt: skip


def test_extremes_are_left_to_the_c_library() -> None:
    x = np.array(EXTREMES)
    assert same_bits(in_lanes(x, "sin", "cos"), by_libm(x)).all()


def test_without_that_library_lanes_ask_the_one_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(libm_circle, "there", lambda: False)
    monkeypatch.setattr(libm_circle, "rounded", None)  # nothing may ask for it
    x = arguments(1024, seed=2)
    assert same_bits(in_lanes(x, "sin", "cos"), by_libm(x)).all()


def test_with_less_room_lanes_are_right_where_the_library_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With room for their own error alone they give the nearest number, which it does not always
    give: its error must have room, too."""
    monkeypatch.setattr(libm_circle, "SURE", 0.5 - WITHIN)
    monkeypatch.setattr(libm_circle, "SURE_NEAR_0", 0.5 - WITHIN)
    x = arguments(1 << 18, seed=3)
    own, libm = in_lanes(x, "sin", "cos"), by_libm(x)
    differ = ~same_bits(own, libm)
    for name, where, values in zip(LINES, differ, own, strict=True):
        assert [nearest(name, each) for each in x[where].tolist()] == values[where].tolist()
    if not differ.any():
        pytest.skip("this glibc rounds correctly: too little room does not show")


# -- the two bounds ------------------------------------------------------------------------------


def units(value: Fraction, true: Fraction) -> Fraction:
    """|value − true| in units in the last place of the latter."""
    exponent = int(np.frexp(float(abs(true)))[1])
    return abs(value - true) * Fraction(2) ** (53 - exponent)


def exact(name: str, x: float | Fraction) -> Fraction:
    with mpmath.workprec(300):
        x = Fraction(x)
        found = getattr(mpmath, name)(mpmath.mpf(x.numerator) / x.denominator)
        sign, mantissa, power, _ = found._mpf_
        return (-1) ** sign * int(mantissa) * Fraction(2) ** power


def test_the_library_is_as_close_as_its_source_says() -> None:
    x = arguments(8_192, seed=4)
    for name, row in zip(LINES, by_libm(x), strict=True):
        for at, y in zip(x.tolist(), row.tolist(), strict=True):
            near_0 = name == "sin" and abs(at) < 0.8555
            assert units(Fraction(y), exact(name, at)) < (0.548 if near_0 else 0.518)


def reduction() -> Callable[[np.ndarray], dict[str, np.ndarray]]:
    """`libm_circle.reduced` as a function of vectors."""
    pointer = DOUBLES.as_pointer()
    module = ir.Module()
    kind = ir.FunctionType(ir.VoidType(), [pointer, pointer])
    b = ir.IRBuilder(ir.Function(module, kind, "main").append_basic_block())
    given, out = b.function.args
    found = libm_circle.reduced(b, b.load(given, align=8))
    quarter = b.bitcast(found.quarter, DOUBLES)
    for k, value in enumerate((*found.sine, *found.cosine, quarter)):
        b.store(value, b.gep(out, [constant(k, 64)]), align=8)
    unsure = b.bitcast(b.not_(found.within), ir.IntType(LANES))
    b.store(b.zext(unsure, I64), b.bitcast(b.gep(out, [constant(5, 64)]), I64.as_pointer()))
    b.ret_void()
    linked = native.linked(native.machine_code(module))

    def call(x: np.ndarray) -> dict[str, np.ndarray]:
        given, out = np.ascontiguousarray(x), np.empty((6, LANES))
        linked(given.ctypes.data, out.ctypes.data)
        own = dict(zip(PARTS, out, strict=False))
        within = ~int(out.view(np.int64)[5, 0])
        return own | {"within": np.array([within >> k & 1 for k in range(LANES)])}

    return call


def farthest(x: np.ndarray) -> tuple[float, int]:
    """By how many units what is not yet rounded is off at most, and of how many arguments."""
    most, count, call = Fraction(0), 0, reduction()
    for part in x.reshape(-1, LANES):
        found = call(part)
        quarter = found["quarter"].view(np.int64) % 4
        for k in np.flatnonzero(found["within"]):
            count += 1
            sine, cosine = (
                Fraction(found[name][k]) + Fraction(found[f"{name}'s rest"][k])
                for name in ("sine", "cosine")
            )
            turned = [(sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine)]
            for name, value in zip(LINES, turned[quarter[k]], strict=True):
                most = max(most, units(value, exact(name, part[k])))
    return float(most), count


def test_before_rounding_they_are_as_close_as_is_promised() -> None:
    most, count = farthest(arguments(4_096, seed=5))
    assert count > 3_000
    assert 0 < most < WITHIN


def test_a_quarter_turn_without_its_last_part_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second, _ = libm_circle._quarter_turn()
    monkeypatch.setattr(libm_circle, "_quarter_turn", lambda: (first, second, 0.0))
    most, _ = farthest(arguments(1_024, seed=6))
    assert most > WITHIN


@pytest.mark.parametrize("series", ["_SINE", "_COSINE"])
def test_a_series_without_its_last_term_is_caught(
    series: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(libm_circle, series, getattr(libm_circle, series)[:-1])
    most, _ = farthest(arguments(1_024, seed=7))
    assert most > WITHIN
