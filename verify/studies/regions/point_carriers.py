"""Points of outlines in one number system, and the maps that carry them.

A region lies in the plane of one pair (q_i, p_i), through a point in 2n dimensions. Its canonical
area is then the integral of ω over it, and ∮ p·dq along its outline; the other coordinates are the
same for all its points, until a map moves them. Points are q and p, or q1 … qn and p1 … pn, in the
order of their `RegionPlane`: a sequence of each.

To measure its rounding, a scheme's map in float64 is compared with the same steps with compensated
sums. These do not show the rounding of a clock: if H depends on time, the map is compared with one
of more digits, as it is in wider number systems. The exact flow comes with its own bound.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from typing import Any, Protocol

import numpy as np
from mpmath.ctx_mp import MPContext

from verify import arithmetic as number_systems
from verify.arithmetic.exact import of_mpf
from verify.arithmetic.float_context import FLOAT
from verify.arithmetic.number_system import bits_for
from verify.arithmetic.systems import float64
from verify.flows.points import exact_points
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.many_points import PointMap
from verify.scenes.shapes.outline import Outline
from verify.studies.regions.panels import Points

_FLOAT_GRID = 80  # bits after the point that are kept of a float64
_SIZE_BITS = 2000  # the precision in which the size of an outline is computed
_EXTRA_DIGITS = 19  # the digits that the finer arithmetic has more: one limb
_SAMPLED = 8  # panels of an outline that are carried in the finer arithmetic


@dataclass(frozen=True)
class RegionPlane:
    """The plane of one pair of coordinates through a point.

    `names`: q1 … qn, p1 … pn, the order of points' coordinates here; `point`: their values. Those
    of the pair `index`, from 0, are not read: the region's points have their own.
    """

    names: tuple[str, ...] = PLANE[::-1]
    point: tuple[Fraction, ...] = (Fraction(0),) * 2
    index: int = 0

    @classmethod
    def from_point(cls, point: Mapping[str, Fraction], plane: int) -> "RegionPlane":
        """Return the plane (q_i, p_i), i = `plane` ≥ 1, through this point.

        `point` has p and q, or p1 … qn, by their names.
        """
        names = tuple(sorted(point, key=lambda name: (name[0] != "q", int(name[1:] or 1))))
        return cls(names, tuple(point[name] for name in names), plane - 1)

    @property
    def degrees(self) -> int:
        """The number n of degrees of freedom."""
        return len(self.names) // 2

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """The pairs (q1, p1) … (qn, pn)."""
        n = self.degrees
        return tuple(zip(self.names[:n], self.names[n:], strict=True))

    def embed(self, x: Any, y: Any, constant: Callable[[Fraction], Any]) -> tuple[Any, ...]:
        """Return points of the plane in all coordinates; `constant` repeats one number."""
        plane_axes = {self.index: x, self.degrees + self.index: y}
        return tuple(
            plane_axes[k] if k in plane_axes else constant(v) for k, v in enumerate(self.point)
        )


QP_PLANE = RegionPlane()


def smaller_than_one(outline: Outline) -> int:
    """Return the bits by which the outline's size is below 1, 0 if it is not.

    An absolute arithmetic needs so many more after the point. The size is estimated by seven points
    of each arc.
    """
    mp = MPContext()
    mp.prec = _SIZE_BITS
    points = [arc(mp, mp.mpf(k) / 7) for arc in outline.arcs for k in range(7)]
    size = max(abs(z[i] - points[0][i]) for z in points for i in (0, 1))
    return max(0, -int(mp.mag(size))) if size else 0


class PointCarrier(Protocol):
    """A number system's points, and a map of them."""

    bits: int  # the number of bits after the point that are right, about
    grid: int  # `whole` multiplies by 2^grid
    sampled: int  # the number of panels that are carried in finer arithmetic
    radius: Fraction | None  # a bound of the images' error; None: finer arithmetic measures it

    def points(self, outline: Outline, arc: int, s: Sequence[Fraction]) -> Points:
        """Return an arc's points at the parameters `s`."""

    def images(self, *points: Any) -> Points:
        """Return their images."""

    def finer(self, *points: Any) -> Points:
        """Return their images in finer arithmetic."""

    def whole(self, x: Any) -> np.ndarray:
        """Return 2^grid x, rounded to whole numbers; an array of int."""


class _Floats:
    """Points in float64."""

    bits, grid, plane = 53, _FLOAT_GRID, QP_PLANE

    def points(self, outline: Outline, arc: int, s: Sequence[Fraction]) -> Points:
        positions = np.array([float(x) for x in s])
        x, y = (
            np.broadcast_to(z, positions.shape).copy() for z in outline.arcs[arc](FLOAT, positions)
        )
        return self.plane.embed(x, y, lambda value: np.full(positions.shape, float(value)))

    def floats(self, points: Points) -> tuple[np.ndarray, ...]:
        return points

    def whole(self, x: np.ndarray) -> np.ndarray:
        with np.errstate(over="ignore"):
            scaled = np.ldexp(x, self.grid)
        # Scaling by a power of 2 is exact unless it overflows; then Fractions, which are slower,
        # take over.
        if np.isfinite(scaled).all():
            return _object_array([int(v) for v in scaled])
        return _object_array([int(Fraction(v) * (1 << self.grid)) for v in x.tolist()])


class FloatCarrier(_Floats):
    """A scheme's steps in float64."""

    sampled = 1 << 30  # all
    radius: Fraction | None = None
    name, digits = float64.NAME, 17
    method = "float64; its rounding by the same steps with compensated sums"

    def __init__(
        self, hamiltonian: Hamiltonian, scheme: str, h: Fraction, steps: int, t0: Fraction,
        smaller: int = 0, plane: RegionPlane = QP_PLANE,
    ) -> None:  # fmt: skip
        self.grid += smaller
        self.plane = plane
        arithmetic = number_systems.get(self.name, self.digits)
        steps_of = partial(PointMap, hamiltonian, scheme, step_size=h, steps=steps, t0=t0)
        self._map = steps_of(arithmetic=arithmetic)
        # Compensated sums have the same clock, and would not show its rounding: a wider system
        # does.
        if hamiltonian.time_dependent:
            wide = number_systems.automatic()[-1].make(self.digits + _EXTRA_DIGITS)
            self._finer = steps_of(arithmetic=wide)
            self.sampled = _SAMPLED
            self.method = f"float64; its rounding by {_SAMPLED} panels in {wide.name}"
        else:
            self._finer = steps_of(arithmetic=arithmetic, compensated=True)

    def images(self, *points: Any) -> Points:
        return _apply_map(self._map, self.plane, points)

    def finer(self, *points: Any) -> Points:
        arithmetic = self._finer.arithmetic
        if arithmetic.name == self.name:
            return _apply_map(self._finer, self.plane, points)
        numbers = [[arithmetic.number(Fraction(v)) for v in z.tolist()] for z in points]
        images = _apply_map(self._finer, self.plane, numbers)
        return tuple(np.array([float(arithmetic.exact(v)) for v in z]) for z in images)


class ExactFlowCarrier(_Floats):
    """The exact flow for a time, in float64; `radius` bounds the error of all points so far."""

    sampled = 0
    name, digits = float64.NAME, 17

    def __init__(
        self, hamiltonian: Hamiltonian, time: Fraction, t0: Fraction, smaller: int = 0,
        plane: RegionPlane = QP_PLANE,
    ) -> None:  # fmt: skip
        self.grid += smaller
        self.plane = plane
        self._hamiltonian, self._time, self._t0 = hamiltonian, time, t0
        self.radius: Fraction | None = Fraction(0)
        self.method = ""

    def images(self, *points: Any) -> Points:
        starts = dict(zip(self.plane.names, points, strict=True))
        solution = exact_points(self._hamiltonian, starts, [self._time], self._t0)
        # A `Probe` requests images several times; one bound holds for all of them.
        self.radius = max(self.radius or Fraction(0), Fraction(solution.bound))
        self.method = solution.method
        return tuple(solution.points[name][0] for name in self.plane.names)

    def finer(self, *points: Any) -> Points:
        # Never called: `radius` is not None.
        raise NotImplementedError("the exact flow's error is known")


class WideCarrier:
    """A scheme's steps in a number system of so many digits."""

    sampled = _SAMPLED
    radius: Fraction | None = None

    def __init__(
        self, hamiltonian: Hamiltonian, scheme: str, h: Fraction, steps: int, t0: Fraction,
        name: str, digits: int, smaller: int = 0, plane: RegionPlane = QP_PLANE,
    ) -> None:  # fmt: skip
        """Take `digits` of the outline's size, `smaller` bits below 1. Raises UnsupportedError."""
        self._steps = partial(PointMap, hamiltonian, scheme, step_size=h, steps=steps, t0=t0)
        self.name, self.digits, self.plane = name, digits, plane
        # A bit is 0.301 digits: `smaller` bits below 1 need 3/10 as many digits more, rounded up.
        self._places = digits + -(-smaller * 3 // 10)
        self.method = (
            f"{name}; its rounding by {_SAMPLED} panels with {digits + _EXTRA_DIGITS} digits"
        )
        self.bits, self.grid = bits_for(digits), bits_for(self._places)
        self.arithmetic = number_systems.get(name, self._places)
        self._map = self._steps(arithmetic=self.arithmetic)

    @cached_property
    def _wider(self) -> PointMap:
        finer = number_systems.get(self.name, self._places + _EXTRA_DIGITS)
        return self._steps(arithmetic=finer)

    def points(self, outline: Outline, arc: int, s: Sequence[Fraction]) -> Points:
        mp = MPContext()
        mp.prec = self.grid + 20
        arc_points = [outline.arcs[arc](mp, mp.mpf(x.numerator) / x.denominator) for x in s]
        number = self.arithmetic.number
        x, y = ([number(of_mpf(mp.mpf(z[i]))) for z in arc_points] for i in (0, 1))
        return self.plane.embed(
            _object_array(x),
            _object_array(y),
            lambda value: _object_array([number(value)] * len(s)),
        )

    def floats(self, points: Points) -> tuple[np.ndarray, ...]:
        to_rational = self.arithmetic.exact
        return tuple(np.array([float(to_rational(v)) for v in z]) for z in points)

    def whole(self, x: Any) -> np.ndarray:
        to_rational, size = self.arithmetic.exact, 1 << self.grid
        return _object_array([round(to_rational(v) * size) for v in x])

    def images(self, *points: Any) -> Points:
        return tuple(map(_object_array, _apply_map(self._map, self.plane, points)))

    def finer(self, *points: Any) -> Points:
        arithmetic, wider = self.arithmetic, self._wider.arithmetic
        numbers = [[wider.number(arithmetic.exact(v)) for v in z] for z in points]
        images = _apply_map(self._wider, self.plane, numbers)
        return tuple(_object_array([arithmetic.number(wider.exact(v)) for v in z]) for z in images)


def _apply_map(point_map: PointMap, plane: RegionPlane, points: Sequence[Any]) -> Points:
    image = point_map(**dict(zip(plane.names, points, strict=True)))
    return tuple(image[name] for name in plane.names)


def _object_array(values: Sequence[Any]) -> np.ndarray:
    array = np.empty(len(values), dtype=object)
    array[:] = values
    return array


SchemeCarrier = FloatCarrier | WideCarrier
