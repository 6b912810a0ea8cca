"""The curves of SVG's paths by complex arithmetic, as its specification writes them."""

import cmath
import math
from itertools import pairwise
from typing import Any

import numpy as np

from verify.arithmetic.float_context import FLOAT
from verify.scenes.shapes.outline import Arc

PLACES = np.linspace(0, 1, 9)


def drawn(arc: Arc) -> Any:
    """Points of an arc as x + iy, in SVG's own direction of y."""
    x, y = arc(FLOAT, PLACES)
    return x - 1j * y


def by_de_casteljau(*control: complex) -> Any:
    points = [np.full(len(PLACES), c, dtype=complex) for c in control]
    while len(points) > 1:
        points = [a + PLACES * (b - a) for a, b in pairwise(points)]
    return points[0]


def by_the_centre(
    z1: complex, rx: float, ry: float, degrees: float, large: int, sweep: int, z2: complex
) -> Any:
    """The arc by SVG 1.1, appendix F.6.5 and F.6.6, as it stands there."""
    turn = cmath.exp(1j * math.radians(degrees))
    rx, ry = abs(rx), abs(ry)
    prime = (z1 - z2) / 2 / turn
    x, y = prime.real, prime.imag
    over = (x / rx) ** 2 + (y / ry) ** 2
    if over > 1:
        rx, ry = rx * math.sqrt(over), ry * math.sqrt(over)
    top = max(0.0, (rx * ry) ** 2 - (rx * y) ** 2 - (ry * x) ** 2)
    root = math.sqrt(top / ((rx * y) ** 2 + (ry * x) ** 2)) * (-1 if large == sweep else 1)
    cx, cy = root * rx * y / ry, -root * ry * x / rx
    centre = complex(cx, cy) * turn + (z1 + z2) / 2
    first = cmath.phase(complex((x - cx) / rx, (y - cy) / ry))
    change = cmath.phase(complex((-x - cx) / rx, (-y - cy) / ry)) - first
    change %= 2 * math.pi
    if not sweep:
        change -= 2 * math.pi
    angles = first + change * PLACES
    return (rx * np.cos(angles) + 1j * ry * np.sin(angles)) * turn + centre
