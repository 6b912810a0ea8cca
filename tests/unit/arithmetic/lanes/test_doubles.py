"""Many points in several vectors: the bits of one point, whatever a kernel of float64 says."""

import numpy as np
import pytest

from verify.arithmetic.compiled import doubles
from verify.arithmetic.lanes import libm_circle
from verify.arithmetic.lanes.doubles import DoublesInLanes

CARRIED = 2
LOOP = """def kernel(steps, h, a, x, y):
{before}    for k in range(steps):
{lines}    return steps, x, y
"""
KERNELS = {
    "sums and products": ("", ["z = x * y - h", "x = x + a * z", "y = -z / (x * x + a)"]),
    "what is the same for all points": ("b = sin(a) * h", ["x = x + b", "y = y + cos(a) * x"]),
    "a sine alone": ("", ["x = x + h * y", "y = y - h * sin(x)"]),
    "a cosine alone": ("", ["x = x + h * cos(y)", "y = y - h * x"]),
    "two angles": ("", ["z = sin(x) + cos(y)", "x = x + h * z", "y = y - sin(x) * h"]),
    "an angle again": ("", ["z = sin(x)", "y = y + h * z", "x = x + h * cos(x) + z * y"]),
    "roots and sizes": ("", ["x = sqrt(abs(x) + a)", "y = abs(y - x)"]),
    "the C library's": (
        "", ["x = x + h * exp(y) + atan(x)", "y = log(abs(y) + a) - sinh(x) / cosh(x)"],
    ),
    "a condition": ("", ["x = x + h * y", "if x > a: x = x - a", "if y < x: y = y + h"]),
    "conditions together": (
        "", ["x = x * a + h", "if x > a and not y > x or y == a: x = y - h"],
    ),
    "the same for all in a condition": ("", ["x = x + h", "if h < a: y = y + x * h"]),
    "the first step": ("", ["if k == 0: x = x + a", "y = y + h * x"]),
    "numbers": ("b = 2 * a", ["x = 1 / (x * x + 3) + b", "y = y * 2 - 1"]),
    "what is set before and in the loop": ("z = a", ["z = z * x + h", "x = z", "y = y + z * h"]),
    "an angle in the loop and after it": (
        "", ["for i in range(2):\n            x = x + h * sin(y)", "x = x + cos(y)"],
    ),
    "an integer for a number": ("x = 1", ["y = y + x * h", "if y > a: y = 2"]),
    "integers": ("", ["x = x + k * h", "y = y - 3 * h"]),
    "a loop in the loop": ("", ["for i in range(3):\n            x = x + h * sin(x)", "y = y - x"]),
    "an exchange": ("", ["z = x", "x = y", "y = z * a"]),
}  # fmt: skip


def source(before: str, lines: list[str]) -> str:
    return LOOP.format(
        before=f"    {before}\n" if before else "",
        lines="".join(f"        {line}\n" for line in lines),
    )


def differing(text: str, steps: int, seed: int) -> int:
    """How many numbers of a cloud are not those of its points one by one."""
    draw = np.random.default_rng(seed)
    inputs = draw.uniform(0.1, 0.9, 2)
    points = draw.uniform(-2, 2, (CARRIED, doubles.POINTS_PER_CALL))
    one = doubles.one_point(text, {})
    alone = [one(steps, *inputs, *point)[1:] for point in points.T.tolist()]
    doubles.on_points(text, {}, CARRIED)(steps, inputs, points)
    own, expected = points.view(np.int64), np.array(alone).T.copy().view(np.int64)
    return int((own != expected).sum())


@pytest.fixture(autouse=True)
def compiled_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("VERIFY_CACHE", "off")


@pytest.mark.parametrize("steps", [0, 1, 57])
@pytest.mark.parametrize(("before", "lines"), KERNELS.values(), ids=KERNELS)
def test_points_have_the_bits_of_one(before: str, lines: list[str], steps: int) -> None:
    assert differing(source(before, lines), steps, seed=steps) == 0


def test_a_set_of_lanes_that_took_anothers_numbers_would_be_caught(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    own = DoublesInLanes._address
    monkeypatch.setattr(
        DoublesInLanes, "_address", lambda self, b, at, k, _: own(self, b, at, k, 0)
    )
    assert differing(source(*KERNELS["a sine alone"]), 3, seed=1)


REFUSED = {
    "a point that ends before others": ["x = x + h", "if x > a: return k, x, y"],
    "a loop that points leave": ["for i in range(3):\n            if x > a: break"],
    "a limit of a number format": ["if inside(x, a): x = x + h"],
    "a function that there is not": ["x = erf(x)"],
    "a product of integers": ["x = x + 2 * k * h"],
    "a function of an integer": ["x = x + abs(k)"],
    "an integer that the loop changes": ["n = 1", "for i in range(3):\n            n = n + 1"],
    "a loop's own variable after it": ["for i in range(3):\n            z = x", "x = z"],
    "a variable that some points have": ["if x > a: z = x"],
}


@pytest.mark.parametrize("lines", REFUSED.values(), ids=REFUSED)
def test_what_it_cannot_do_is_refused(lines: list[str]) -> None:
    with pytest.raises(NotImplementedError):
        doubles.on_points(source("", lines), {}, CARRIED)


@pytest.mark.parametrize("there", [True, False])
def test_a_kernel_without_sines_asks_for_no_circle(
    there: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(libm_circle, "is_available", lambda: there)
    monkeypatch.setattr(libm_circle, "sin_and_cos", None)
    assert differing(source(*KERNELS["sums and products"]), 5, seed=2) == 0
