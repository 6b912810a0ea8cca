"""The units of the coordinates and of time, of a Hamiltonian or of equations without one.

In equations no coordinate is a momentum: the scale of each is where a component of the field turns
from one power of it to another. The others have the largest units in which the motion is slow.
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cache

from verify.integrators.places.trial_places import round_to_simple
from verify.integrators.places.turns import OCTAVES, find_turns
from verify.integrators.places.units import (
    FloatField,
    Units,
    Vector,
    direction,
    find_duration,
    units_of,
)

_MOST_BALANCINGS = 40  # each halves the exponents by which rates differ, or so
_SLOW = 1.5  # a motion is slow whose rate of change is at most this multiple of the least


def units_of_system(field: FloatField, usual: float | None = None) -> tuple[Units, Fraction]:
    """Return the units of the coordinates, for each scale that the system has, and the unit of t.

    `usual`: the length that is taken where the field has no scale; None for any.
    """
    if field.canonical:
        return units_of(field, usual)
    ways = direction(len(field.names))
    zeros = [0.0] * len(ways)
    axes = [[float(i == k) for i in range(len(ways))] for k in range(len(ways))]
    rest = zeros if field(zeros) is not None else None
    # Beside others that are 0, as these may hide its scale; else beside others of their own size.
    turns = [_find_turn(field, zeros, axis, rest) if rest else None for axis in axes]
    together = (_find_turn(field, zeros, ways, rest)
                or _find_turn(field, zeros, [-x for x in ways], rest) or usual or 1.0)  # fmt: skip
    base = [(x or together) * y for x, y in zip(turns, ways, strict=True)]
    turns = [x or _find_turn(field, base, y, base) for x, y in zip(turns, axes, strict=True)]
    units = [x or together for x in turns]
    free = [k for k, x in enumerate(turns) if x is None]
    units = _balance(field, units, ways, free)
    for k in free:
        units[k] = _slow_unit(field, units, ways, k)
    return [[round_to_simple(x) for x in units]], round_to_simple(find_duration(field, units))


def _find_turn(field: FloatField, start: Vector, way: Vector, base: Vector | None) -> float | None:
    """Return the least s at which a component of f(start + s way) − f(base) turns; None if there is
    none. Without a base, f itself is looked at."""

    @cache
    def octaves(s: float) -> list[float] | None:
        return field.octaves([x + s * y for x, y in zip(start, way, strict=True)], base)

    def find(j: int) -> list[float]:
        return find_turns(lambda s: None if (sizes := octaves(s)) is None else sizes[j])

    return min((x for j in range(len(start)) for x in find(j)[:1]), default=None)


def _rates(field: FloatField, units: Vector, ways: Vector) -> list[float]:
    """Return how fast each coordinate changes, in its unit; no number where that is undefined."""
    slopes = field([u * x for u, x in zip(units, ways, strict=True)])
    return [] if slopes is None else [abs(x) / u for x, u in zip(slopes, units, strict=True)]


def _balance(
    field: FloatField, units: list[float], ways: Vector, free: Sequence[int]
) -> list[float]:
    """Return the units with those of the `free` coordinates such that all change equally fast."""
    rates = _rates(field, units, ways)
    for _ in range(_MOST_BALANCINGS if free else 0):
        if not rates or not all(0 < x < math.inf for x in rates):
            break
        mean = math.exp(sum(map(math.log, rates)) / len(rates))
        nearer = [u * math.sqrt(x / mean) if k in free else u
                  for k, (u, x) in enumerate(zip(units, rates, strict=True))]  # fmt: skip
        after = _rates(field, nearer, ways)
        if not after or max(after) * min(rates) >= max(rates) * min(after):
            break
        units, rates = nearer, after
    return units


def _slow_unit(field: FloatField, units: Vector, ways: Vector, k: int) -> float:
    """Return the largest unit of a coordinate in which the motion is slow; the present one if it is
    so in every unit."""
    fastest = dict[int, float]()
    for octave in OCTAVES:
        rates = _rates(field, [*units[:k], 2.0**octave, *units[k + 1 :]], ways)
        if rates:
            fastest[octave] = max(rates)
    slow = [n for n, x in fastest.items() if x <= _SLOW * min(fastest.values())]
    is_bounded = slow and max(slow) < max(fastest)
    return 2.0 ** max(slow) if is_bounded else units[k]
