"""Numbers in lanes have the bits of one orbit's, whatever stands in the other lanes."""

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.helpers.lanes import IN_LANES, number
from tests.property.arithmetic.lanes.cases import (
    FUNCTIONS,
    LONG_SUM,
    OPERATIONS,
    WIDTHS,
    arguments,
    at_a_half,
    both,
    first_differing,
    operands,
    small_squares,
)


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("way", IN_LANES)
@pytest.mark.parametrize("width", WIDTHS)
def test_operations_have_the_bits_of_one_orbit(width: int, way: str) -> None:
    rows = operands(width, seed=width, count=400)
    assert not first_differing(both(OPERATIONS, width, way), rows)


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


@pytest.mark.parametrize("way", IN_LANES)
def test_a_range_ends_where_it_does_of_one_orbit(way: str) -> None:
    """The leading 64 bits are looked at: at the limit and beside it, on both sides of 0."""
    width, limit = 192, 3 << 45  # of these bits, as `both` has it
    pair = both("def f(x):\n    i = 0\n    if inside(x, limit): i = 1\n    return i\n", width, way)
    raws = [
        ((sign * limit + k) << (width - 64)) + beneath
        for sign in (-1, 0, 1)
        for k in (-2, -1, 0, 1, 2)
        for beneath in (-1, 0, 1)
    ]
    rows = [(number(raw, width),) for raw in raws]
    assert not first_differing(pair, rows)
    assert [pair.of_one(row) for row in rows] == [abs(x >> (width - 64)) < limit for x in raws]


@pytest.mark.parametrize("way", IN_LANES)
def test_carries_of_long_sums_are_moved_in_time(way: str) -> None:
    assert not first_differing(both(LONG_SUM, 192, way), small_squares(192))


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


BESIDE = """\
def f(x, g: 'float'):
    s = f_sin(g)
    c = f_cos(g)
    d = f_cos(g + s)
    return x + x, s, c, d, f_sin(d), f_sin(g)
"""


@pytest.mark.parametrize("way", IN_LANES)
def test_sines_of_float64_beside_fixed_numbers_have_the_bits_of_one_orbit(way: str) -> None:
    draw = np.random.default_rng(5)
    sizes = draw.choice([7.0, 0.9, 1e-9, 2.0**18, 1e18, 2.0**1000], 4000)
    given = (draw.uniform(-1, 1, 4000) * sizes).tolist()
    given += [0.0, -0.0, math.inf, math.nan, 5e-324, math.pi / 2, 1.6762015014439702]
    rows = [(number(k, 128), x) for k, x in enumerate(given)]
    assert not first_differing(both(BESIDE, 128, way), rows)


OTHER_COUNT = """\
import sys
import pytest
from llvmlite import binding

features = binding.get_host_cpu_features()  # as they are read for the number of lanes
text = features.flatten()
features.flatten = lambda: text
features["avx512f"] = not features.get("avx512f", False)
if not features["avx512f"]:  # the instructions of AVX-512 take eight
    features["avx512ifma"] = False
binding.get_host_cpu_features = lambda: features
sys.exit(pytest.main(sys.argv[1:]))
"""


@pytest.mark.left_to_ci
def test_four_lanes_and_eight_have_the_same_bits() -> None:
    """Those that this processor's registers do not have, LLVM makes of others."""
    chosen = "at_a_half and not widths or never_asks or long_sums or sines"
    command = [
        sys.executable,
        "-c",
        OTHER_COUNT,
        "-q",
        "-n",
        "0",
        "-k",
        chosen,
        str(Path(__file__).parent),
    ]
    environment = os.environ | {"VERIFY_CACHE": "off"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout
