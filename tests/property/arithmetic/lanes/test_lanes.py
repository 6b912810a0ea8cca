"""Numbers in lanes have the bits of one orbit's, whatever stands in the other lanes."""

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest
from llvmlite import ir

from tests.helpers.fixed_checks import HARD, Near
from tests.helpers.lanes import IN_LANES, Both, number, same
from verify.arithmetic.lanes import circle, exponential, multiply_add
from verify.arithmetic.lanes.functions import LaneFunctions
from verify.arithmetic.lanes.numbers import Numbers
from verify.arithmetic.lanes.vectors import CONDITIONS
from verify.arithmetic.processor import LANES

WIDTHS = (128, 192, 256, 320, 384, 448, 512)
OPERATIONS = """\
def f(x, y, s: 'sum', by: 'int', g: 'float'):
    n = 0
    if x < y: n = 1
    m = 0
    if x >= y: m = 1
    e = 0
    if x == y: e = 1
    i = 0
    if inside(x, limit): i = 1
    z = y
    if x > y: z = x
    total = s + x
    r = x * y
    return r, x * x, (r + r) * x, -x, abs(x), x - y, z, total, abs(total), shifted(x, by), \
shifted(y, by), approx(x), approx(total), wide(g), g * g - g, n, m, e, i
"""
# A sum that only holds its carries where they are moved on the way, from a product that is small.
LONG_SUM = "\n    ".join(
    ("def f(x, c):", "z = x * x", *["z = z + z"] * 18, "return c - z, z - c, c - z - z")
)
FUNCTIONS = {
    "circle": "def f(x):\n    c, s = cos_sin(x)\n    return c, s\n",
    **{f: f"def f(x): return {f}(x)\n" for f in ("sin", "cos", "exp", "log", "sqrt", "sinh")},
    "inverse": "def f(x): return 1 / x\n",
}


@cache
def both(text: str, width: int, way: str) -> Both:
    return Both(text, width, way, {"limit": number(3 << (width - 19), width)})


class Draws:
    """Numbers at random, the same ones each time."""

    def __init__(self, seed: int) -> None:
        self.generator = np.random.default_rng(seed)

    def bits(self, count: int) -> int:
        return int.from_bytes(self.generator.bytes(-(-count // 8)), "big") >> (-count % 8)

    def below(self, limit: int) -> int:
        return int(self.generator.integers(limit))

    def either(self) -> int:
        return 2 * self.below(2) - 1

    def unit(self) -> float:
        return float(self.generator.random())


def differing(pair: Both, rows: Sequence[Sequence[Any]]) -> Iterator[Sequence[Any]]:
    """Rows whose values are not those of one orbit."""
    for first in range(0, len(rows), LANES):
        part = rows[first : first + LANES]
        for row, found in zip(part, pair.in_lanes(part), strict=True):
            if not same(pair.of_one(row), found):
                yield row


def first_differing(pair: Both, rows: Sequence[Sequence[Any]]) -> Sequence[Any] | None:
    return next(differing(pair, rows), None)


def operands(width: int, seed: int, count: int) -> list[Any]:
    """Rows for OPERATIONS whose products stay in range."""
    draws = Draws(seed)

    def small(raw: int) -> int:
        top = 1 << (width - 9)  # |x| < 2^7
        return max(-top, min(top - 1, raw))

    hard = [small(shape.raw(width)) for shape in HARD]
    hard += [small(raw >> draws.below(width)) for raw in hard]
    both_hard = list(product(hard, hard))
    pairs = [both_hard[draws.below(len(both_hard))] for _ in range(count)]
    pairs += [
        (draws.bits(width - 9) - (1 << (width - 10)), hard[draws.below(len(hard))])
        for _ in range(count)
    ]
    return [
        (
            number(x, width),
            number(y, width),
            number(draws.bits(width + 40) - (1 << (width + 39)), width),
            draws.below(64),
            draws.either() * draws.unit() * 2.0 ** (draws.below(217) - 200),
        )
        for x, y in pairs
    ]


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("way", IN_LANES)
@pytest.mark.parametrize("width", WIDTHS)
def test_operations_have_the_bits_of_one_orbit(width: int, way: str) -> None:
    rows = operands(width, seed=width, count=400)
    assert not first_differing(both(OPERATIONS, width, way), rows)


def at_a_half(width: int, seed: int) -> list[Any]:
    """Rows for OPERATIONS whose products lie next to where rounding changes, on both sides and
    there: what is left out of them at first matters."""
    draws, bits = Draws(seed), width - 16
    half, pairs = 1 << bits - 1, []
    for k in range(100):
        x = (draws.bits(bits + 5) | 1) * draws.either()
        rest = half + draws.below(7) - 3
        pairs.append((x, rest * pow(x, -1, 1 << bits) % (1 << bits)))
        pairs.append((odd_root(half + 8 * k - 399, bits) * draws.either(), x))
    return [row_of(x, y, width) for x, y in pairs]


def odd_root(square: int, bits: int) -> int:
    """x with x² ≡ square modulo 2^bits, the square 1 modulo 8."""
    x = 1
    for k in range(3, bits):
        x += ((x * x - square) >> k & 1) << k - 1
    return x


def row_of(x: int, y: int, width: int) -> Any:
    """For OPERATIONS."""
    return number(x, width), number(y, width), number(0, width), 1, 0.5


@pytest.mark.parametrize("way", IN_LANES)
def test_products_are_rounded_rightly_at_a_half(way: str) -> None:
    assert not first_differing(both(OPERATIONS, 192, way), at_a_half(192, seed=1))


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize("way", IN_LANES)
@pytest.mark.parametrize("width", WIDTHS)
def test_products_of_all_widths_are_rounded_rightly_at_a_half(width: int, way: str) -> None:
    assert not first_differing(both(OPERATIONS, width, way), at_a_half(width, seed=width))


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("way", IN_LANES)
@pytest.mark.parametrize("width", WIDTHS)
def test_products_next_to_the_end_of_the_range_too(width: int, way: str) -> None:
    top = 1 << (width - 1)
    pairs = [(-top + k, 1 << width - 16) for k in range(6)] + [(-top // 2, 1 << width - 15)]
    pairs += [(top - 1 - k, 1 << width - 16) for k in range(6)]
    pairs += [(y, x) for x, y in pairs]
    product = "def f(x, y):\n    r = x * y\n    return r, -r, shifted(r, 1), abs(r)\n"
    rows = [tuple(number(v, width) for v in pair) for pair in pairs]
    assert not first_differing(both(product, width, way), rows)


def small_squares(width: int) -> list[Any]:
    draws = Draws(width)
    x = (draws.bits(width // 2 - 30) for _ in range(40))
    return [(number(v, width), number(draws.bits(width - 12), width)) for v in x]


@pytest.mark.parametrize("way", IN_LANES)
def test_carries_of_long_sums_are_moved_in_time(way: str) -> None:
    assert not first_differing(both(LONG_SUM, 192, way), small_squares(192))


def arguments(name: str, width: int) -> list[Any]:
    """Where a table's entry changes, over all sizes, and at random."""
    draws, bits = Draws(width), width - 16
    angles, octaves = (0, 1, -1, 511, 512, 1024, 2048, 3071, 4096, 2**20), (0, 1, -255, 256, 2560)
    raws = [
        Near(step, Fraction(k), Fraction(0), add).raw(width)
        for step, ks in (("angle", angles), ("octave", octaves))
        for k in ks
        for add in (-1, 0, 1)
    ]
    sizes = (2 ** (bits + k % 30 - 16) for k in range(1000))
    raws += [round(Fraction(draws.unit()) * size) * draws.either() for size in sizes]
    raws += [0, 1, -1, 1 << bits, (1 << (width - 1)) - 1, -(1 << (width - 1))]
    return [(number(raw, width),) for raw in raws]


# What a vector unit does is tried at all widths; the code for every processor, which takes twice as
# long to compile, at the least and the greatest.
WAYS = [(width, way) for width in WIDTHS[:4] for way in IN_LANES]
WAYS = [x for x in WAYS if x[1] == IN_LANES[0] or x[0] in (WIDTHS[0], WIDTHS[3])]


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize(("width", "way"), WAYS)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_have_the_bits_of_one_orbit(name: str, width: int, way: str) -> None:
    assert not first_differing(both(FUNCTIONS[name], width, way), arguments(name, width))


# -- controls -------------------------------------------------------------------------------------


@pytest.mark.left_to_ci
def test_lanes_that_never_ask_for_the_last_bit_are_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where all are taken to be sure, one in a thousand arguments or so is rounded otherwise."""
    monkeypatch.setattr(circle, "lost_by_one", lambda width: 0)
    monkeypatch.setattr(circle, "_lost", lambda count: 0)
    pair = Both(FUNCTIONS["circle"], 128, IN_LANES[0])
    draws = Draws(5)
    assert first_differing(pair, [(number(draws.bits(116), 128),) for _ in range(20_000)])


def test_what_one_orbit_loses_is_less_than_lanes_allow_for() -> None:
    """By values to twice the digits: the nearest number, and how far it is from another one."""
    draws, width = Draws(11), 128
    pair = both(FUNCTIONS["circle"], width, IN_LANES[0])
    finer = both(FUNCTIONS["circle"], 2 * width, IN_LANES[0])
    most = Fraction(0)
    for _ in range(3000):
        raw = draws.bits(width - 2) - (1 << (width - 3))
        found = pair.of_one((number(raw, width),))
        true = finer.of_one((number(raw << width, 2 * width),))
        for x, y in zip(found, true, strict=True):
            exact = Fraction(y.raw, 2 ** (2 * width - 16)) * 2 ** (width - 16)
            most = max(most, abs(x.raw - exact) - Fraction(1, 2))
    # An ulp is 2^14 of the units in which it is counted.
    assert most * 2**14 <= circle.lost_by_one(width)


def test_what_one_orbits_exp_loses_is_less_than_lanes_allow_for() -> None:
    """It cuts what is below a unit, and what it loses before is a part of a unit for e^x < 2^14."""
    draws, width = Draws(13), 128
    pair = both(FUNCTIONS["exp"], width, IN_LANES[0])
    finer = both(FUNCTIONS["exp"], 2 * width, IN_LANES[0])
    for _ in range(3000):
        raw = draws.bits(width - 12) - (1 << (width - 13))  # |x| < 8
        x = pair.of_one((number(raw, width),))
        y = finer.of_one((number(raw << width, 2 * width),))
        exact = Fraction(y.raw, 2 ** (2 * width - 16)) * 2 ** (width - 16)
        lost = Fraction(circle.lost_by_one(width), 2**14) * max(1, exact / 2 ** (width - 16))
        assert exact - 1 - lost <= x.raw <= exact + lost


def test_exp_that_never_asks_for_the_last_bit_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exponential, "lost_by_one", lambda width: 0)
    monkeypatch.setattr(exponential, "_lost", lambda count: 0)
    pair = Both(FUNCTIONS["exp"], 128, IN_LANES[0])
    draws = Draws(7)
    assert first_differing(pair, [(number(draws.bits(116), 128),) for _ in range(20_000)])


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["circle", "exp", "sinh", "sqrt", "inverse"])
def test_most_lanes_do_not_ask_one_orbit(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where what one orbit's function gives is thrown away, few values are wrong, or none."""

    def zeros(self: LaneFunctions, b: ir.IRBuilder, *_: Any) -> tuple[Any, list[Any]]:
        nothing = self.numbers.constant(0, self.width)
        return ir.Constant(CONDITIONS, [1] * LANES), [nothing] * (2 if name == "circle" else 1)

    monkeypatch.setattr(LaneFunctions, "_one_by_one", zeros)
    pair = Both(FUNCTIONS[name], 128, IN_LANES[0])
    draws = Draws(17)
    rows = [(number(draws.bits(111) + (1 << 111), 128),) for _ in range(2000)]  # ½ … 1
    wrong = len(list(differing(pair, rows)))
    assert wrong <= (0 if name in ("sqrt", "inverse") else 100)


@pytest.mark.parametrize("planted", ["_take_signs", "carry", "from_words"])
def test_a_step_left_out_of_a_product_is_caught(
    monkeypatch: pytest.MonkeyPatch, planted: str
) -> None:
    wrong: dict[str, Any] = {
        "_take_signs": lambda self, b, columns, x, y: None,
        "carry": lambda self, b, x: x.limbs,
        "from_words": lambda self, b, words: self.known([words[0], *words], 64 * len(words)),
    }
    monkeypatch.setattr(Numbers, planted, wrong[planted])
    way = "portable" if planted == "_take_signs" else IN_LANES[0]
    pair = Both(OPERATIONS, 128, way, {"limit": number(3 << 109, 128)})
    assert first_differing(pair, operands(128, seed=1, count=40))


def test_sums_whose_carries_are_never_moved_are_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Numbers, "light", lambda self, b, x: x)
    assert first_differing(Both(LONG_SUM, 192, IN_LANES[0]), small_squares(192))


OTHER_COUNT = """\
import sys
import pytest
from verify.arithmetic import processor

processor.LANES = 12 - processor.LANES
sys.exit(pytest.main(sys.argv[1:]))
"""


@pytest.mark.left_to_ci
def test_four_lanes_and_eight_have_the_same_bits() -> None:
    """Those that this processor's registers do not have, LLVM makes of others."""
    chosen = "at_a_half and not widths or never_asks or long_sums"
    command = [sys.executable, "-c", OTHER_COUNT, "-q", "-n", "0", "-k", chosen, __file__]
    environment = os.environ | {"VERIFY_CACHE": "off"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout


AVX2 = pytest.mark.skipif("avx2" not in IN_LANES, reason="this processor has no AVX2")


@AVX2
def test_a_product_that_never_asks_for_all_columns_is_caught(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Numbers, "_lost", staticmethod(lambda first: 0))
    pair = Both(OPERATIONS, 192, "avx2", {"limit": number(3 << 173, 192)})
    assert first_differing(pair, at_a_half(192, seed=1))


@AVX2
@pytest.mark.parametrize("planted", ["_ABOUT_0", "_HIGH", "_HIGH_ABOUT_0"])
def test_a_product_that_is_split_elsewhere_is_caught(
    planted: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A constant next to the right one splits it into other parts than are added up."""
    right = getattr(multiply_add, planted)
    monkeypatch.setattr(multiply_add, planted, right * 2)
    pair = Both(OPERATIONS, 128, "avx2", {"limit": number(3 << 109, 128)})
    assert first_differing(pair, operands(128, seed=1, count=40))
