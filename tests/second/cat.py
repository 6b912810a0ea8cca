"""The cat's outlines of the toolkit's scenes, written down again, and what maps make of them.

x is q, y is p; the face is one unit wide where `scale` is 0.5. Only numbers were taken over.
"""

import ctypes
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from tests.helpers.programs.compilers import library

Array = np.ndarray[Any, np.dtype[np.float64]]
Plane = tuple[Array, Array]  # q, p


def head(t: Array) -> Plane:
    """An ellipse with bumps e^(k (cos(t − at) − 1)): ears at tan = ±15/8, cheeks at ∓3/4 below."""
    x, y = 0.88 * np.cos(t), 0.72 * np.sin(t) - 0.13
    for side in (1, -1):
        ear, cheek = np.arctan2(15, side * 8), np.arctan2(-3, side * 4)
        away = np.cos(t - ear) - 1
        broad, tip = np.exp(10 * away), np.exp(40 * away)
        x = x + side * (0.05 * broad + 0.12 * tip + 0.10 * np.exp(6 * (np.cos(t - cheek) - 1)))
        y = y + 0.18 * broad + 0.36 * tip
    return x, y


def _ellipse(x: float, y: float, a: float, b: float) -> Callable[[Array], Plane]:
    return lambda t: (x + a * np.cos(t), y + b * np.sin(t))


def _almond(x: float, tilt: float) -> Callable[[Array], Plane]:
    return lambda t: (
        x + 0.19 * np.cos(t),
        0.02 + 0.17 * np.sin(t) * (1 - 0.3 * np.cos(t) ** 2) + tilt * np.cos(t),
    )


def _triangle(at: complex, up: complex, aside: complex) -> Callable[[Array], Plane]:
    def points(t: Array) -> Plane:
        corners = np.exp(1j * t) + np.exp(-2j * t) / 4
        z = at + up * corners.real + aside * corners.imag
        return np.array(z.real, dtype=np.float64), np.array(z.imag, dtype=np.float64)

    return points


def _mouth(t: Array) -> Plane:
    u = np.cos(t)
    wave = 0.035 * np.cos(2 * np.pi * u) + 0.05 * np.exp(-20 * u * u)
    return 0.22 * u, wave + 0.008 * np.sin(t) - 0.415


def _whisker(side: int, root: float, x: float, y: float) -> Callable[[Array], Plane]:
    def points(t: Array) -> Plane:
        u = np.cos(t)
        bent = (root + y + (y - root) * u) / 2 + 0.03 * (1 - u * u)
        return side * (0.42 + x + (x - 0.42) * u) / 2, bent + side * 0.007 * np.sin(t)

    return points


def outlines() -> Iterator[Callable[[Array], Plane]]:
    """The head first."""
    yield head
    yield _triangle(-0.23j, -0.06j, 0.075)
    yield _mouth
    for side in (1, -1):
        yield _triangle(side * 0.515 + 0.57j, side * 0.045 + 0.17j, -0.1 + side * 0.03j)
        yield _almond(side * 0.34, side * 0.03)
        yield _ellipse(side * 0.33, 0.02, 0.05, 0.13)
        for root, x, y in ((-0.26, 1.12, -0.10), (-0.33, 1.15, -0.35), (-0.40, 1.08, -0.60)):
            yield _whisker(side, root, x, y)


def around(count: int) -> Array:
    return np.array(np.arange(count) * (2 * np.pi / count), dtype=np.float64)


def placed(points: Plane, q: float, p: float, scale: float = 0.5) -> Plane:
    return q + scale * points[0], p + scale * points[1]


def area(points: Plane) -> float:
    """∮ (q dp − p dq)/2, the derivatives by FFT: it converges geometrically."""
    z = points[0] + 1j * points[1]
    turns = np.fft.fftfreq(len(z), 1 / len(z))
    slope = np.fft.ifft(1j * turns * np.fft.fft(z))
    return float(np.pi * np.mean((z.conj() * slope).imag))


def distance(one: Plane, other: Plane) -> float:
    """From the points of each to the segments of the other, the greatest: Hausdorff's."""
    return max(_farthest(one, other), _farthest(other, one))


def _farthest(one: Plane, other: Plane) -> float:
    z, start = one[0] + 1j * one[1], other[0] + 1j * other[1]
    along = np.roll(start, -1) - start
    squares, greatest = np.abs(along) ** 2, 0.0
    for part in np.array_split(z, max(1, len(z) // 64)):
        gap = part[:, None] - start
        at = np.clip((gap * along.conj()).real / squares, 0, 1)
        greatest = max(greatest, float(np.abs(gap - at * along).min(axis=1).max()))
    return greatest


@dataclass(frozen=True)
class Carrier:
    """Points carried by programs in C."""

    folder: Path

    @cached_property
    def _library(self) -> ctypes.CDLL:
        source = Path(__file__).with_name("outlines.c").read_text(encoding="utf-8")
        return ctypes.CDLL(library(self.folder, "outlines.c", source, "-O3"))

    def lie2(self, points: Plane, steps: int, h: float = 0.01) -> tuple[Plane, Array]:
        """And Π det J of each."""
        factors = np.ones(len(points[0]))
        q, p, factors = self._called("lie2", [*points, factors], steps, h)
        return (q, p), factors

    def symplectic_euler(self, points: Plane, steps: int, h: float = 0.01) -> Plane:
        q, p = self._called("symplectic_euler", list(points), steps, h)
        return q, p

    def exact(self, points: Plane, time: float) -> Plane:
        steps = round(time * 5)
        q, p = self._called("exact", list(points), steps, time / steps)
        return q, p

    def _called(self, name: str, arrays: list[Array], steps: int, h: float) -> list[Array]:
        copies = [np.array(each, dtype=np.float64, order="C") for each in arrays]
        pointers = [each.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for each in copies]
        counts = ctypes.c_long(len(copies[0])), ctypes.c_long(steps)
        getattr(self._library, name)(*pointers, *counts, ctypes.c_double(h))
        return copies
