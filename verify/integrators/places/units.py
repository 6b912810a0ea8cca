"""The units of a Hamiltonian's coordinates and of time, one set for each scale that it has.

A field has sizes of its own: where its forces turn from one power of the coordinates to another
(σ of a molecule, the length of a pendulum), and momenta whose kinetic energy is that of moving
through such a length. Where it has none, as Kepler's, any length will do, and 1 is taken.
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import gmpy2

from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.places.trial_places import round_to_simple

_DIGITS, _TIME = 20, 0.25
# Of lengths that are looked at: the far ones, as of atoms in SI units, at every fourth.
_OCTAVES = *range(-140, -44, 4), *range(-44, 45), *range(48, 141, 4)
_DEPARTS, _PLATEAU = 0.3, 0.1  # of a power of the coordinates
_ASIDE = (1.0, 0.61, 1.43)  # parts of a state, for others beside it
_APART = 30  # times another coordinate's length, or another scale, one counts for itself
_LONG, _MOST_SCALES = 6, 3  # slopes of a power that is seen beyond the first; and scales in all
_DIRECTION = (1.0, -1.27, 0.78, 1.13, -0.87, 0.69, -1.41, 0.93, 1.31, -0.74)
Vector = Sequence[float]


class FloatField:
    """f(z, t) of an H whose parameters have values, as floats; None where it is not defined."""

    def __init__(self, hamiltonian: Hamiltonian) -> None:
        self.degrees, self.names = hamiltonian.degrees, hamiltonian.coordinates
        self.timed = hamiltonian.time_dependent
        self._flow = NumericalFlow(canonical_field(hamiltonian)[0], _DIGITS)

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

    def octave(
        self, z: Vector, t: float, base: Vector | None = None, then: float = 0.0, half: int = -1
    ) -> float | None:
        """Return the binary logarithm of the size of f(z, t), or of its distance from f(base,
        then), in the half that is counted, or in both; no float overflows, or cancels."""
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

    def jacobian(self, z: Vector, t: float, reach: Vector) -> list[list[float]]:
        """Return ∂f/∂z by columns, by central differences of many digits. Raises NoFlowError."""
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


def units_of(field: FloatField, usual: float = 1.0) -> tuple[list[list[Fraction]], Fraction]:
    """Find units of the coordinates, p1 … qn, for each scale that H has, and one of t.

    `usual`: a length, where H has none.
    """
    n, scales = field.degrees, list[list[float]]()
    for lengths in _sizes(field, n, usual):
        scales.append([*_find_partners(field, lengths, n), *lengths])
    for momenta in [] if scales else _sizes(field, 0):  # as of a relativistic body on a spring
        scales.append([*momenta, *_find_partners(field, momenta, 0)])
    lengths = [usual] * n
    scales = scales or [[*_find_partners(field, lengths, n), *lengths]]
    return [[round_to_simple(x) for x in scale] for scale in scales], round_to_simple(
        _duration(field, scales[0])
    )


def _sizes(field: FloatField, first: int, usual: float = 1.0) -> list[list[float]]:
    """Find the sizes of each q, or p, from the `first` coordinate on, at which its forces turn from
    one power to another: one list for each scale, none where nothing turns."""
    n = field.degrees
    origin = [0.0] * (2 * n)
    at_rest = field(origin) is not None  # then a constant force is of no size

    def size(s: float) -> float | None:
        moved = _pad_with_zeros(first, [s * x for x in _direction(n)])
        if at_rest:
            return field.octave(moved, _TIME, origin, _TIME)
        return field.octave(moved, _TIME, half=0 if first else 1)

    turns = [*_find_turns(size), *_find_turns(lambda s: size(-s))]
    scales = turns[:1]
    for x in turns[1:]:
        if all(not 1 / _APART < x / y < _APART for y in scales):
            scales.append(x)
    nearest = scales[0] if scales else usual
    sizes = _size_near_scale(field, first, nearest)
    if not scales and all(x == usual for x in sizes):
        return []
    return [[x * (scale / nearest) for x in sizes] for scale in scales[:_MOST_SCALES] or [usual]]


def _size_near_scale(field: FloatField, first: int, scale: float) -> list[float]:
    """Return the size of each coordinate near that scale: the scale, or one of its own."""
    n = field.degrees
    base = _pad_with_zeros(first, [scale * x for x in _direction(n)])
    sizes = [scale] * n
    for k in range(n):
        # At several states, as a force may be still at one of them.
        turns_by_state = [
            _find_turns(_response(field, [x * y for x in base], first + k))[:1] for y in _ASIDE
        ]
        local_sizes = [x for turns in turns_by_state for x in turns]
        if local_sizes and not 1 / _APART < max(local_sizes) / scale < _APART:
            sizes[k] = max(local_sizes)
    return sizes


def _direction(n: int) -> list[float]:
    return [_DIRECTION[k % len(_DIRECTION)] * (1 + k // len(_DIRECTION)) for k in range(n)]


def _pad_with_zeros(first: int, half: Sequence[float]) -> list[float]:
    """Return a state whose other half is 0."""
    zeros = [0.0] * len(half)
    return [*zeros, *half] if first else [*half, *zeros]


def _slopes_of_other_half(slopes: Sequence[float], first: int) -> Sequence[float]:
    """Return the slopes of the other half, which the coordinates from `first` on produce."""
    return slopes[: len(slopes) // 2] if first else slopes[len(slopes) // 2 :]


def _response(field: FloatField, base: Vector, j: int) -> Callable[[float], float | None]:
    """Return a function that measures how far the forces change as one coordinate moves."""

    def size(s: float) -> float | None:
        moved = list(base)
        moved[j] += s
        return field.octave(moved, _TIME, base, _TIME)

    return size


def _find_turns(size: Callable[[float], float | None]) -> list[float]:
    """Find where a size, by its binary logarithm, turns from one power of s to another: the first
    such place, and those beyond at which a power of a long stretch ends or begins."""
    values = [size(2.0**k) for k in _OCTAVES]
    powers = [
        (b - a) / (_OCTAVES[k + 1] - _OCTAVES[k])
        if a is not None and b is not None and math.isfinite(b - a)
        else None
        for k, (a, b) in enumerate(pairwise(values))
    ]
    plateau: float | None = None
    turns = list[float]()
    first = next((k for k, x in enumerate(values) if x is not None), 0)
    if first:
        turns.append(math.ldexp(1.5, _OCTAVES[first]))  # it is not defined nearer to 0
    for k in range(2, len(powers)):
        # Beyond the first turn a power counts on a long stretch alone, as a short one may be a
        # ripple of waves.
        fewest = _LONG if turns else 3
        steady = [x for x in powers[max(0, k + 1 - fewest) : k + 1] if x is not None]
        if plateau is None:
            if len(steady) == fewest and max(steady) - min(steady) < _PLATEAU:
                plateau = steady[0]
                if turns:
                    turns.append(math.ldexp(1.0, _OCTAVES[k + 1 - fewest]))
        elif powers[k] is None:
            if not turns:  # it is not defined beyond; later numbers have come to their end
                turns.append(math.ldexp(1.0, _OCTAVES[k - 1]))
            plateau = None
        elif abs((powers[k] or 0.0) - plateau) > _DEPARTS:
            turns.append(math.ldexp(1.5, _OCTAVES[k]))
            plateau = None
    return turns


def _find_partners(field: FloatField, sizes: Vector, first: int) -> list[float]:
    """Return for each p the value whose kinetic energy is the work of its force over its length; or
    the same for q."""
    n = field.degrees
    base = _pad_with_zeros(first, [x * y for x, y in zip(sizes, _direction(n), strict=True)])
    works = zip(*_works(field, base, sizes, first), strict=True)
    work = [min(works_of_force, default=0.0) for works_of_force in works]
    mean = sum(work) / max(len(work), 1) or 1.0
    return [_partner(field, base, n - first + k, work[k] or mean) for k in range(n)]


def _works(field: FloatField, base: Vector, sizes: Vector, first: int) -> list[list[float]]:
    """Return the work of each force over its length, at states beside one another, as one may lie
    in a core."""
    states = [field([x * y for x in base]) for y in _ASIDE]
    works = [
        [
            abs(slope) * size
            for slope, size in zip(_slopes_of_other_half(z, first), sizes, strict=True)
        ]
        for z in states
        if z is not None
    ]
    return works or [[0.0] * len(sizes)]


def _partner(field: FloatField, base: Vector, j: int, work: float) -> float:
    n = field.degrees

    def energy(x: float) -> float:
        state = list(base)
        state[j] = x
        slopes = field(state)
        return math.inf if slopes is None else abs(x * slopes[(j + n) % (2 * n)])

    # Bisection in the binary logarithm, since units may lie many powers of ten apart.
    low, high = -200.0, 200.0  # of its binary logarithm
    if not energy(2.0**high) > work > energy(2.0**low):
        return 1.0
    while high - low > 0.25:
        middle = (low + high) / 2
        low, high = (middle, high) if energy(2.0**middle) < work else (low, middle)
    return math.pow(2.0, high)


def _duration(field: FloatField, units: Vector) -> float:
    """Find the time over which the field changes otherwise than by a power of t, from 0 on or where
    it is defined; 1 where it does not."""
    if not field.timed:
        return 1.0
    begin = 0.0 if field(units, 0.0) is not None else 0.125
    turns = _find_turns(lambda s: field.octave(units, begin + s, units, begin))
    return turns[0] if turns else 1.0
