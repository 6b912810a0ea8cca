"""The order of a step in floats by its own convergence: two halves against a whole, many times."""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.others.methods.integrator import Map

_SIZES = tuple(1 / 2**k for k in range(1, 9))
_PARTS = 32
_NOISE = 2.0**-44
_WITHIN = 0.3  # of a whole power
_TIME = 0.6875


def order_of_step(
    step: Map, hamiltonian: Hamiltonian, points: Sequence[tuple[Fraction, ...]]
) -> int | None:
    """From errors of one step against 32 steps of a 32nd, for h = 1/2 … 1/256; None where no whole
    power is seen above rounding. Raises what the step raises."""
    degrees, timed = hamiltonian.degrees, hamiltonian.time_dependent
    rows = []
    for h in _SIZES:
        error = max(_error(step, z, h, timed, degrees) for z in _starts(points, degrees))
        if error > _NOISE * 100:
            rows.append((h, error))
    powers = [math.log2(x / y) for (_, x), (_, y) in pairwise(rows)]
    for one, other in reversed([*pairwise(powers)]):
        power = round(other)
        if abs(one - power) <= _WITHIN and abs(other - power) <= _WITHIN:
            return power - 1
    return None


def _starts(points: Sequence[tuple[Fraction, ...]], degrees: int) -> list[tuple[Any, Any]]:
    if degrees == 1:
        own = points or ((Fraction(1, 3), Fraction(3, 5)),)
        return [(float(p), float(q)) for p, q in own]
    import numpy as np

    return [(np.linspace(0.2, 0.35, degrees), np.linspace(0.3, -0.15, degrees))]


def _error(step: Map, z: tuple[Any, Any], h: float, timed: bool, degrees: int) -> float:
    """Of a step of size h against the same in parts, which are far smaller."""

    def made(z: tuple[Any, Any], t: float, size: float) -> tuple[Any, Any]:
        p, q = step(*z, t, size) if timed else step(*z, size)
        return p, q

    one, many = made(z, _TIME, h), z
    for k in range(_PARTS):
        many = made(many, _TIME + k * h / _PARTS, h / _PARTS)
    if degrees == 1:
        return max(abs(float(x) - float(y)) for x, y in zip(one, many, strict=True))
    return max(float(abs(x - y).max()) for x, y in zip(one, many, strict=True))
