"""The units of a Hamiltonian's coordinates and of time, one set for each scale that it has.

A scale is a length at which the forces turn from one power of the coordinates to another (σ of a
molecule, the length of a pendulum). Its momenta are those whose kinetic energy is the work of the
forces over this length. If H has no scale, as Kepler's, any length will do: 1 is taken, and that
at which the motion takes a unit of time, since the numbers of a code are made for either.
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import gmpy2

from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians.canonical_field import field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.places.trial_places import round_to_simple
from verify.integrators.places.turns import OCTAVES, PLATEAU_WIDTH, find_turns

_FIELD_DIGITS, TIME = 20, 0.25
_STATE_FACTORS = (1.0, 0.61, 1.43)  # multiples of a state, as a force may vanish at one of them
_SCALE_RATIO = 30  # lengths with a larger ratio are different scales
_MAX_SCALES = 3
_DIRECTION = (1.0, -1.27, 0.78, 1.13, -0.87, 0.69, -1.41, 0.93, 1.31, -0.74)
Vector = Sequence[float]
Units = list[list[Fraction]]  # of the coordinates, for each scale


class FloatField:
    """f(z, t), the right-hand side of a system's equations, as floats; None where it is undefined.

    The parameters of the system must have values.
    """

    def __init__(self, hamiltonian: Hamiltonian) -> None:
        self.degrees, self.names = hamiltonian.degrees, hamiltonian.coordinates
        self.timed, self.canonical = hamiltonian.time_dependent, hamiltonian.energy is not None
        self._flow = NumericalFlow(field_of(hamiltonian)[0], _FIELD_DIGITS)

    def _slopes(self, z: Vector, t: float) -> list[Any] | None:
        try:
            state = [self._flow.number(Fraction(x)) for x in (*z, *((t,) if self.timed else ()))]
            return list(self._flow.slope(tuple(state)))
        except (NoFlowError, ValueError, OverflowError):
            return None

    def __call__(self, z: Vector, t: float = TIME) -> list[float] | None:
        slopes = self._slopes(z, t)
        if slopes is None or not all(map(math.isfinite, map(float, slopes))):
            return None
        return [float(x) for x in slopes]

    def octave(
        self, z: Vector, t: float, base: Vector | None = None, then: float = 0.0, half: int = -1
    ) -> float | None:
        """Return log₂ of the size of f(z, t), or of its distance from f(base, then).

        `half`: 0 for p' alone, 1 for q' alone, −1 for both. It is computed with 20 digits, so that
        nothing overflows or cancels as it would in floats. None if a field value is undefined.
        """
        slopes = self._slopes(z, t)
        subtracted = [0] * len(z) if base is None else self._slopes(base, then)
        if slopes is None or subtracted is None:
            return None
        n = self.degrees
        part = slice(None) if half < 0 else slice(half * n, half * n + n)
        try:
            with self._flow.arithmetic.context():
                total = sum((x - y) ** 2 for x, y in [*zip(slopes, subtracted, strict=True)][part])
                return float(gmpy2.log2(total)) / 2 if total else -math.inf
        except ArithmeticError:
            return None

    def octaves(self, z: Vector, base: Vector | None = None) -> list[float] | None:
        """Return log₂ of |f_j(z) − f_j(base)| for each component, of |f_j(z)| without a base."""
        slopes = self._slopes(z, TIME)
        subtracted = [0] * len(z) if base is None else self._slopes(base, TIME)
        if slopes is None or subtracted is None:
            return None
        try:
            with self._flow.arithmetic.context():
                gaps = [abs(x - y) for x, y in zip(slopes, subtracted, strict=True)]
                return [float(gmpy2.log2(x)) if x else -math.inf for x in gaps]
        except ArithmeticError:
            return None

    def jacobian(self, z: Vector, t: float, reach: Vector) -> list[list[float]]:
        """Return ∂f/∂z by columns, by central differences with 20 digits.

        Raises NoFlowError if the field is undefined near z.
        """
        flow, columns = self._flow, []
        for j, length in enumerate(reach):
            # The truncation error of a central difference is of relative size 2⁻⁴⁸ or so, and 20
            # digits leave a rounding error of about 2⁻⁴² in its quotient: both are negligible here.
            width = Fraction(length) / 2**24
            ends = []
            for sign in (1, -1):
                state = [Fraction(x) + sign * width * (k == j) for k, x in enumerate(z)]
                clock = [Fraction(t)] if self.timed else []
                ends.append(flow.slope(tuple(flow.number(x) for x in (*state, *clock))))
            with flow.arithmetic.context():
                columns.append(
                    [float((a - b) / flow.number(2 * width)) for a, b in zip(*ends, strict=True)]
                )
        return columns


def units_of(field: FloatField, usual: float | None = None) -> tuple[Units, Fraction]:
    """Return the units of the coordinates, p1 … qn, for each scale that H has, and the unit of t.

    `usual`: the length that is taken if H has no scale; None for any.
    """
    n, scales = field.degrees, list[list[float]]()
    for lengths in _find_scales(field, n, usual or 1.0):
        scales.append([*_find_partners(field, lengths, n), *lengths])
    # If the q have no scale, the p may have one, as those of a relativistic body on a spring.
    for momenta in [] if scales else _find_scales(field, 0):
        scales.append([*momenta, *_find_partners(field, momenta, 0)])
    for length in [] if scales else [usual] if usual else _free_lengths(field):
        lengths = [length] * n
        scales.append([*_find_partners(field, lengths, n), *lengths])
    return [[round_to_simple(x) for x in scale] for scale in scales], round_to_simple(
        find_duration(field, scales[0])
    )


def _free_lengths(field: FloatField) -> list[float]:
    """Return 1, and the length at which the motion takes a unit of time where that is another."""
    n, rates = field.degrees, list[float]()
    for length in (1.0, float(_SCALE_RATIO)):
        units = [*_find_partners(field, [length] * n, n), *[length] * n]
        slopes = field([x * y for x, y in zip(units, 2 * direction(n), strict=True)])
        rates.append(max(abs(x) / u for x, u in zip(slopes, units, strict=True)) if slopes else 0)
    # Without a scale the rate is a power of the length.
    is_moving = all(0 < x < math.inf for x in rates)
    power = math.log(rates[1] / rates[0], _SCALE_RATIO) if is_moving else 0.0
    octaves = -math.log2(rates[0]) / power if abs(power) > PLATEAU_WIDTH else 0.0
    is_other = math.log2(_SCALE_RATIO) < abs(octaves) < OCTAVES[-1]
    return [1.0, 2.0**octaves] if is_other else [1.0]


def _find_scales(field: FloatField, first: int, usual: float = 1.0) -> list[list[float]]:
    """Find the scales of the coordinates from index `first` on: the q, or the p with `first` = 0.

    Returns one list for each scale, with a length for each coordinate; none if the forces turn
    nowhere from one power to another.
    """
    n = field.degrees
    origin = [0.0] * (2 * n)
    is_defined = field(origin) is not None  # then the constant part of the force is subtracted

    def size(s: float) -> float | None:
        moved = _pad_with_zeros(first, [s * x for x in direction(n)])
        if is_defined:
            return field.octave(moved, TIME, origin, TIME)
        return field.octave(moved, TIME, half=0 if first else 1)

    turns = [*find_turns(size), *find_turns(lambda s: size(-s))]
    scales = turns[:1]
    for x in turns[1:]:
        if all(not 1 / _SCALE_RATIO < x / y < _SCALE_RATIO for y in scales):
            scales.append(x)
    nearest = scales[0] if scales else usual
    sizes = _sizes_near_scale(field, first, nearest)
    if not scales and all(x == usual for x in sizes):
        return []
    return [[x * (scale / nearest) for x in sizes] for scale in scales[:_MAX_SCALES] or [usual]]


def _sizes_near_scale(field: FloatField, first: int, scale: float) -> list[float]:
    """Return the size of each coordinate near that scale: the scale, or one that differs by more
    than `_SCALE_RATIO`."""
    n = field.degrees
    base = _pad_with_zeros(first, [scale * x for x in direction(n)])
    sizes = [scale] * n
    for k in range(n):
        turns_by_state = [
            find_turns(response(field, [x * y for x in base], first + k))[:1]
            for y in _STATE_FACTORS
        ]
        local_sizes = [x for turns in turns_by_state for x in turns]
        if local_sizes and not 1 / _SCALE_RATIO < max(local_sizes) / scale < _SCALE_RATIO:
            sizes[k] = max(local_sizes)
    return sizes


def direction(n: int) -> list[float]:
    return [_DIRECTION[k % len(_DIRECTION)] * (1 + k // len(_DIRECTION)) for k in range(n)]


def _pad_with_zeros(first: int, half: Sequence[float]) -> list[float]:
    """Return a state whose other half is 0."""
    zeros = [0.0] * len(half)
    return [*zeros, *half] if first else [*half, *zeros]


def _slopes_of_other_half(slopes: Sequence[float], first: int) -> Sequence[float]:
    """Return the slopes of the other half, which the coordinates from `first` on produce."""
    return slopes[: len(slopes) // 2] if first else slopes[len(slopes) // 2 :]


def response(field: FloatField, base: Vector, j: int) -> Callable[[float], float | None]:
    """Return a function that measures how far the forces change as one coordinate moves."""

    def size(s: float) -> float | None:
        moved = list(base)
        moved[j] += s
        return field.octave(moved, TIME, base, TIME)

    return size


def _find_partners(field: FloatField, sizes: Vector, first: int) -> list[float]:
    """Return for each p the value whose kinetic energy is the work of the force over the length of
    its q; with `first` = 0, for each q the same from its p."""
    n = field.degrees
    base = _pad_with_zeros(first, [x * y for x, y in zip(sizes, direction(n), strict=True)])
    works = zip(*_works_of_forces(field, base, sizes, first), strict=True)
    work = [min(works_of_force, default=0.0) for works_of_force in works]
    mean = sum(work) / max(len(work), 1) or 1.0
    return [_find_partner(field, base, n - first + k, work[k] or mean) for k in range(n)]


def _works_of_forces(
    field: FloatField, base: Vector, sizes: Vector, first: int
) -> list[list[float]]:
    """Return the work of each force over its length, at several states: one may lie in a core."""
    states = [field([x * y for x in base]) for y in _STATE_FACTORS]
    works = [
        [
            abs(slope) * size
            for slope, size in zip(_slopes_of_other_half(z, first), sizes, strict=True)
        ]
        for z in states
        if z is not None
    ]
    return works or [[0.0] * len(sizes)]


def _find_partner(field: FloatField, base: Vector, j: int, work: float) -> float:
    n = field.degrees

    def energy(x: float) -> float:
        state = list(base)
        state[j] = x
        slopes = field(state)
        return math.inf if slopes is None else abs(x * slopes[(j + n) % (2 * n)])

    # Bisection in the binary logarithm, since units may lie many powers of ten apart.
    low, high = -200.0, 200.0
    if not energy(2.0**high) > work > energy(2.0**low):
        return 1.0
    while high - low > 0.25:
        middle = (low + high) / 2
        low, high = (middle, high) if energy(2.0**middle) < work else (low, middle)
    return math.pow(2.0, high)


def find_duration(field: FloatField, units: Vector) -> float:
    """Return the time, from t = 0 on, over which the field turns from one power of t to another; 1
    if it does not. If the field is undefined at 0, the start is 1/8."""
    if not field.timed:
        return 1.0
    begin = 0.0 if field(units, 0.0) is not None else 0.125
    turns = find_turns(lambda s: field.octave(units, begin + s, units, begin))
    return turns[0] if turns else 1.0
