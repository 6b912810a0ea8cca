"""Curves and maps whose areas are known exactly, and planes that carry points by them."""

from collections.abc import Callable
from fractions import Fraction
from math import comb
from typing import Any

import mpmath
import numpy as np

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.shapes import named as shapes
from verify.scenes.shapes.outline import Outline, Point, bezier
from verify.studies.regions.point_carriers import FloatCarrier, WideCarrier
from verify.studies.regions.region_area import Goal, MeasuredArea, Probe

FINE = Goal(change=Fraction(0), area=Fraction(1, 10**13))
WIDE_GOAL = Goal(change=Fraction(0), area=Fraction(1, 10**27))
CHANGED = Goal(change=Fraction(1, 10**4), area=Fraction(1, 10**14))
OSCILLATOR = Hamiltonian.parse("p**2/2 + q**2/2")
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4")
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
CIRCLE, SQUARE, CAT = (shapes.get(name).outlines[0] for name in ("circle", "square", "cat"))


class MadePlane(FloatCarrier):
    """Points in float64, carried by a given map (x, y) ↦ (x, y) instead of a scheme's."""

    def __init__(self, made: Callable[[Any, Any], tuple[Any, Any]]) -> None:
        self._made = made

    def images(self, x: Any, y: Any) -> tuple[Any, Any]:
        return self._made(x, y)

    def finer(self, x: Any, y: Any) -> tuple[Any, Any]:
        return tuple(np.float64(v) for v in self._made(np.longdouble(x), np.longdouble(y)))


def still(hamiltonian: Hamiltonian = OSCILLATOR) -> MadePlane:
    return MadePlane(lambda x, y: (x + 0, y + 0))


def measured(outline: Outline, plane: Any, goal: Goal = FINE) -> MeasuredArea:
    return Probe([outline], plane, [goal]).measure()[0]


def wide(scheme: str, h: Any, steps: int, of: Hamiltonian = OSCILLATOR, digits: int = 33) -> Any:
    return WideCarrier(of, scheme, Fraction(h), steps, Fraction(0), "fixed", digits)


def floats(scheme: str, h: Any, steps: int, of: Hamiltonian = OSCILLATOR) -> FloatCarrier:
    return FloatCarrier(of, scheme, Fraction(h), steps, Fraction(0))


def polygon(*corners: tuple[Any, Any]) -> Outline:
    points = [(Fraction(x), Fraction(y)) for x, y in corners]
    sides = zip(points, [*points[1:], points[0]], strict=True)
    return Outline("polygon", tuple(bezier(*side) for side in sides))


def shoelace(*corners: tuple[Any, Any]) -> Fraction:
    points = [(Fraction(x), Fraction(y)) for x, y in corners]
    following = [*points[1:], points[0]]
    return sum((x * v - u * y for (x, y), (u, v) in zip(points, following, strict=True)),
               Fraction(0)) / 2  # fmt: skip


def bezier_area(*arcs: tuple[Point, ...]) -> Fraction:
    """½ ∮ (x dy − y dx) in whole numbers: Bernstein polynomials multiplied and integrated."""
    total = Fraction(0)
    for control in arcs:
        n = len(control) - 1
        for i, (x, y) in enumerate(control):
            for j in range(n):
                dx, dy = (control[j + 1][k] - control[j][k] for k in (0, 1))
                # ∫ B_i^n B_j^(n−1) = C(n,i) C(n−1,j) / (C(2n−1,i+j) 2n); the derivative has n.
                weight = Fraction(comb(n, i) * comb(n - 1, j), 2 * comb(2 * n - 1, i + j))
                total += weight * (x * dy - y * dx)
    return total / 2


def linear_determinant(scheme: str, h: Fraction, steps: int) -> Fraction:
    """det J^N − 1 of lieη on the harmonic oscillator: J is the truncated exponential of h K."""
    eta = int(scheme.removeprefix("lie"))
    even = odd = Fraction(0)
    term = Fraction(1)
    for n in range(eta + 1):
        sign = -1 if n % 4 in (2, 3) else 1
        if n % 2:
            odd += sign * term
        else:
            even += sign * term
        term *= h / (n + 1)
    return (even**2 + odd**2) ** steps - 1


def pi(times: Fraction) -> Fraction:
    with mpmath.workdps(60):
        return Fraction(mpmath.nstr(mpmath.pi, 55)) * times


def placed(outline: Outline, q: Any, p: Any, scale: Any) -> Outline:
    return outline.place_at(Fraction(q), Fraction(p), Fraction(scale))


def bent(x: Any, y: Any) -> tuple[Any, Any]:
    """(x, y + x²y), whose determinant is 1 + x²: the square's area grows by a third of itself."""
    return x, y + x * x * y
