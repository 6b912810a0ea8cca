"""The sizes at which a quantity turns from one power of its argument to another."""

import math
from collections.abc import Callable
from itertools import pairwise

# The binary logarithms of the lengths that are tried: far from 1, as with atoms in SI units, every
# fourth alone.
OCTAVES = *range(-140, -44, 4), *range(-44, 45), *range(48, 141, 4)
# Slopes show one power if they differ by less than the second number; a slope that differs from it
# by more than the first number shows a turn.
_POWER_TOLERANCE, PLATEAU_WIDTH = 0.3, 0.1
_LATER_PLATEAU_SLOPES = 6  # slopes that have to show one power, beyond the first turn


def find_turns(size: Callable[[float], float | None]) -> list[float]:
    """Return the s at which a size turns from one power of s to another.

    `size` returns log₂ of the size. After the first turn, only powers on long stretches count: the
    values of s at which one ends or begins.
    """
    values = [size(2.0**k) for k in OCTAVES]
    powers = [
        (b - a) / (OCTAVES[k + 1] - OCTAVES[k])
        if a is not None and b is not None and math.isfinite(b - a)
        else None
        for k, (a, b) in enumerate(pairwise(values))
    ]
    plateau: float | None = None
    turns = list[float]()
    first = next((k for k, x in enumerate(values) if x is not None), 0)
    if first:
        turns.append(math.ldexp(1.5, OCTAVES[first]))  # the size is undefined nearer to 0
    for k in range(2, len(powers)):
        # After the first turn a short stretch may be a ripple of waves.
        fewest = _LATER_PLATEAU_SLOPES if turns else 3
        steady = [x for x in powers[max(0, k + 1 - fewest) : k + 1] if x is not None]
        if plateau is None:
            if len(steady) == fewest and max(steady) - min(steady) < PLATEAU_WIDTH:
                plateau = steady[0]
                if turns:
                    turns.append(math.ldexp(1.0, OCTAVES[k + 1 - fewest]))
        elif powers[k] is None:
            if not turns:  # the size is undefined from here on, or its numbers have overflowed
                turns.append(math.ldexp(1.0, OCTAVES[k - 1]))
            plateau = None
        elif abs((powers[k] or 0.0) - plateau) > _POWER_TOLERANCE:
            turns.append(math.ldexp(1.5, OCTAVES[k]))
            plateau = None
    return turns
