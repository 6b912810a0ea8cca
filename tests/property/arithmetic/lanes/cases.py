"""Functions in lanes and rows of arguments for them, hard ones and at random."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from tests.helpers.fixed_checks import HARD, Near
from tests.helpers.lanes import Both, number, same
from verify.arithmetic.lanes.vectors import LANES
from verify.arithmetic.systems.fixed import functions

WIDTHS = (128, 156, 192, 256, 320, 384, 448, 512)
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
# A sum that only holds its carries where they are moved on the way.
LONG_SUM = "\n    ".join(
    ("def f(x, c):", "z = x * x", *["z = z + z"] * 18, "return c - z, z - c, c - z - z")
)
FUNCTIONS = {
    "circle": "def f(x):\n    c, s = cos_sin(x)\n    return c, s\n",
    **{f: f"def f(x): return {f}(x)\n" for f in functions() if f not in ("cosh", "cos_sin")},
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


def small_squares(width: int) -> list[Any]:
    """Rows for LONG_SUM: squares below a unit, which some paths have with carries all the same,
    and others that are 2^18 times as large within the range."""
    draws = Draws(width)
    x = (draws.bits(size) for size in (width // 2 - 30, width - 30) for _ in range(40))
    return [(number(v, width), number(draws.bits(width - 12), width)) for v in x]


def arguments(name: str, width: int) -> list[Any]:
    """Where a table's entry changes, over all sizes, and at random."""
    draws, bits = Draws(width), width - 16
    angles = (0, 1, -1, 2047, 2048, 4096, 8192, 12287, 16384, 2**22)
    octaves = (0, 1, -4095, 4096, 40960)
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
