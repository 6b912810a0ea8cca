"""The units of a Hamiltonian's coordinates, and how fast its motion is at a place.

A field has sizes of its own: where its forces turn from one power of the coordinates to another
(σ of a molecule, the length of a pendulum), and momenta whose kinetic energy is that of moving
through such a length. Where it has none, as Kepler's, any length will do, and 1 is taken.
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from verify.flows.degrees.extrapolation import FlowInDegrees
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.places.place import simple

_DIGITS, _TIME = 20, 0.25
_OCTAVES = range(-44, 45)  # of lengths that are looked at
_DEPARTS, _PLATEAU = 0.3, 0.1  # of a power of the coordinates
_ASIDE = (1.0, 0.61, 1.43)  # parts of a state, for others beside it
_APART = 30  # times another coordinate's length, one counts for itself
_DIRECTION = (1.0, -1.27, 0.78, 1.13, -0.87, 0.69, -1.41, 0.93, 1.31, -0.74)
Vector = Sequence[float]


class Field:
    """f(z, t) of an H whose parameters have values, as floats; None where it is not defined."""

    def __init__(self, hamiltonian: Hamiltonian) -> None:
        self.degrees, self.names = hamiltonian.degrees, hamiltonian.coordinates
        self.timed = hamiltonian.time_dependent
        self._flow = FlowInDegrees(canonical_field(hamiltonian)[0], _DIGITS)

    def _slopes(self, z: Vector, t: float) -> list[Any] | None:
        try:
            state = [self._flow.number(Fraction(x)) for x in (*z, *((t,) if self.timed else ()))]
            return list(self._flow.slope(tuple(state)))
        except (NoFlowError, ValueError, OverflowError):
            return None

    def __call__(self, z: Vector, t: float = _TIME) -> list[float] | None:
        slopes = self._slopes(z, t)
        if slopes is None or not all(map(math.isfinite, map(float, slopes))):
            return None
        return [float(x) for x in slopes]

    def change(self, base: Vector, t: float, moved: Vector, later: float) -> float | None:
        """How far f(moved, later) is from f(base, t), where floats would cancel."""
        one, two = self._slopes(base, t), self._slopes(moved, later)
        if one is None or two is None:
            return None
        with self._flow.arithmetic.context():
            apart = [float(x - y) for x, y in zip(two, one, strict=True)]
        return math.hypot(*apart) if all(map(math.isfinite, apart)) else None

    def jacobian(self, z: Vector, t: float, reach: Vector) -> list[list[float]]:
        """∂f/∂z by columns, by central differences of many digits. Raises NoFlowError."""
        flow, columns = self._flow, []
        for j, length in enumerate(reach):
            width = Fraction(length) / 2**24
            ends = []
            for sign in (1, -1):
                moved = [Fraction(x) + sign * width * (k == j) for k, x in enumerate(z)]
                clock = [Fraction(t)] if self.timed else []
                ends.append(flow.slope(tuple(flow.number(x) for x in (*moved, *clock))))
            with flow.arithmetic.context():
                columns.append(
                    [float((a - b) / flow.number(2 * width)) for a, b in zip(*ends, strict=True)]
                )
        return columns


def units_of(field: Field, usual: float = 1.0) -> tuple[list[Fraction], Fraction]:
    """A unit of each coordinate, p1 … qn, and of t; `usual`: a length, where H has none."""
    n = field.degrees
    lengths, momenta = _sizes(field, n, usual), None
    if lengths is None:
        momenta = _sizes(field, 0)
    if momenta is None:
        lengths = lengths or [usual] * n
        momenta = _partners(field, lengths, n)
    else:  # as of a relativistic body on a spring
        lengths = _partners(field, momenta, 0)
    return [simple(x) for x in (*momenta, *lengths)], simple(_duration(field, [*momenta, *lengths]))


def _sizes(field: Field, first: int, usual: float = 1.0) -> list[float] | None:
    """Of each q, or p, from the `first` coordinate on: where what it makes turns from one power to
    another; None where nothing does."""
    n = field.degrees
    direction = _direction(n)
    still = [0.0] * (2 * n)
    at_rest = field(still) is not None  # then a constant force is of no size

    def change(s: float) -> float | None:
        moved = _put(first, [s * x for x in direction])
        if at_rest:
            return field.change(still, _TIME, moved, _TIME)
        slopes = field(moved)
        return None if slopes is None else math.hypot(*_others(slopes, first))

    common = _crossover(change)
    scale = common or usual
    base = _put(first, [scale * x for x in direction])
    sizes, seen = [scale] * n, common is not None
    for k in range(n):
        # At several states, as a force may be still at one of them.
        each = [_crossover(_response(field, [x * y for x in base], first + k)) for y in _ASIDE]
        alone = [x for x in each if x is not None]
        seen = seen or bool(alone)
        if alone and not 1 / _APART < max(alone) / scale < _APART:
            sizes[k] = max(alone)
    return sizes if seen else None


def _direction(n: int) -> list[float]:
    return [_DIRECTION[k % len(_DIRECTION)] * (1 + k // len(_DIRECTION)) for k in range(n)]


def _put(first: int, half: Sequence[float]) -> list[float]:
    """A state whose other half is 0."""
    zeros = [0.0] * len(half)
    return [*zeros, *half] if first else [*half, *zeros]


def _others(slopes: Sequence[float], first: int) -> Sequence[float]:
    """What the coordinates from `first` on make of the other half."""
    return slopes[: len(slopes) // 2] if first else slopes[len(slopes) // 2 :]


def _response(field: Field, base: Vector, j: int) -> Callable[[float], float | None]:
    """How far the forces change as one coordinate moves."""

    def change(s: float) -> float | None:
        moved = list(base)
        moved[j] += s
        return field.change(base, _TIME, moved, _TIME)

    return change


def _crossover(size: Callable[[float], float | None]) -> float | None:
    """Where a size first turns from one power of s to another; None where it does not."""
    values = [size(2.0**k) for k in _OCTAVES]
    powers = [
        math.log2(b / a) if a and b and math.isfinite(a) and math.isfinite(b) else None
        for a, b in pairwise(values)
    ]
    begun: float | None = None
    first = next((k for k, x in enumerate(values) if x is not None), 0)
    if first:
        return math.ldexp(1.5, _OCTAVES[first])  # it is not defined nearer to 0
    for k in range(2, len(powers)):
        three = powers[k - 2 : k + 1]
        steady = [x for x in three if x is not None]
        if len(steady) == 3 and max(steady) - min(steady) < _PLATEAU and begun is None:
            begun = steady[0]
        elif begun is not None and powers[k] is None:
            return math.ldexp(1.0, _OCTAVES[k - 1])  # it is not defined beyond
        elif begun is not None and abs((powers[k] or 0.0) - begun) > _DEPARTS:
            return math.ldexp(1.5, _OCTAVES[k])
    return None


def _partners(field: Field, sizes: Vector, first: int) -> list[float]:
    """Of each p, that whose kinetic energy is the work of its force over its length; or so of q."""
    n = field.degrees
    base = _put(first, [x * y for x, y in zip(sizes, _direction(n), strict=True)])
    work = [min(each, default=0.0) for each in zip(*_works(field, base, sizes, first), strict=True)]
    mean = sum(work) / max(len(work), 1) or 1.0
    return [_partner(field, base, n - first + k, work[k] or mean) for k in range(n)]


def _works(field: Field, base: Vector, sizes: Vector, first: int) -> list[list[float]]:
    """Of each force over its length, at states beside one another, as one may lie in a core."""
    states = [field([x * y for x in base]) for y in _ASIDE]
    works = [
        [abs(slope) * size for slope, size in zip(_others(z, first), sizes, strict=True)]
        for z in states
        if z is not None
    ]
    return works or [[0.0] * len(sizes)]


def _partner(field: Field, base: Vector, j: int, work: float) -> float:
    n = field.degrees

    def energy(x: float) -> float:
        moved = list(base)
        moved[j] = x
        slopes = field(moved)
        return math.inf if slopes is None else abs(x * slopes[(j + n) % (2 * n)])

    low, high = -200.0, 200.0  # of its binary logarithm
    if not energy(2.0**high) > work > energy(2.0**low):
        return 1.0
    while high - low > 0.25:
        middle = (low + high) / 2
        low, high = (middle, high) if energy(2.0**middle) < work else (low, middle)
    return math.pow(2.0, high)


def _duration(field: Field, units: Vector) -> float:
    """Over which the field changes otherwise than by a line in t; 1 where it does not."""
    if not field.timed:
        return 1.0
    return _crossover(lambda s: field.change(units, 0.125, units, 0.125 + s)) or 1.0


# -- at one place ---------------------------------------------------------------------------------


def reaches(field: Field, z: Vector, t: float, units: Vector) -> list[float]:
    """How far each coordinate may be moved before the field bends, at most its unit."""
    still = field(z, t)
    if still is None:
        raise NoFlowError("H is not defined there")
    return [_reach(field, z, t, j, still, units[j]) for j in range(len(z))]


def _reach(field: Field, z: Vector, t: float, j: int, still: Vector, unit: float) -> float:
    length = unit
    for _ in range(20):
        ends = []
        for sign in (1, -1):
            moved = list(z)
            moved[j] += sign * length
            ends.append(field(moved, t))
        if ends[0] is not None and ends[1] is not None:
            pairs = list(zip(ends[0], ends[1], still, strict=True))
            bend = max(
                abs(a - 2 * c + b) / (abs(a - b) + abs(c) * 1e-3 + 1e-300) for a, b, c in pairs
            )
            if bend < 1 or all(abs(a - 2 * c + b) <= 0.5 * abs(c) for a, b, c in pairs):
                return length
        length /= 4
    return length


def rate(field: Field, z: Vector, t: float, reach: Vector) -> float:
    """How fast the motion changes: ‖∂f/∂z‖ with its coordinates balanced, and of its way.

    Balancing (Osborne, J. ACM 7 (1960)) takes units out: the norm is then near the largest
    frequency. Raises NoFlowError.
    """
    columns = field.jacobian(z, t, reach)
    size = len(columns)
    entries = [[abs(columns[j][i]) * reach[j] / reach[i] for j in range(size)] for i in range(size)]
    for _ in range(20):
        for k in range(size):
            row = sum(entries[k][j] for j in range(size) if j != k)
            column = sum(entries[i][k] for i in range(size) if i != k)
            if row > 0 and column > 0:
                ratio = math.sqrt(column / row)
                for j in range(size):
                    if j != k:
                        entries[k][j] *= ratio
                        entries[j][k] /= ratio
    slopes = field(z, t) or []
    moving = max((abs(x) / length for x, length in zip(slopes, reach, strict=True)), default=0.0)
    return max(map(sum, entries)) + moving / 2
