"""The units of a map's coordinates, by its Jacobian alone: there is no H that has a scale."""

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import partial

from verify.integrators.measures.probes import Probe, probe_of
from verify.integrators.measures.survey import ALIKE
from verify.integrators.places.trial_places import TrialPlace, round_to_simple, states
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import UserMap

_CHANGE_SHARE = 0.1  # J has changed if an entry differs by this part of the largest entry
_WEAK = 1e-6  # coordinates that J joins less, there and back, tell nothing of each other
_STRONG = 100.0  # at a place where J has larger entries, in its units, a map is not looked at


def find_map_units(step: UserMap) -> list[Fraction]:
    """Return the unit of each coordinate of a map: the distance from 0 at which its Jacobian has
    changed, 1 if it does not; and shares of it where J joins coordinates of far other sizes."""
    for how in step.probe_kinds:
        units = unless_it_fails(partial(_find_units, step, how))
        if units:
            return units
    return [Fraction(1)] * len(step.names)


def _find_units(step: UserMap, how: str) -> list[Fraction] | None:
    """Return the units by one probe; None if that finds J at no place."""
    probe, shares = probe_of(step, how), [1.0] * len(step.names)
    first_jacobian, units = list[list[float]](), list[Fraction]()
    for exponent in range(-20, 21):
        jacobian = None
        for _ in range(2):  # where the shares move the place, they are found again
            units = [Fraction(2.0**exponent * x) for x in shares]
            jacobian = _jacobian_at(probe, units)
            shares = _balance(jacobian, units, shares) if jacobian else shares
        scaled = [[x * float(units[j] / units[i]) for j, x in enumerate(row)]
                  for i, row in enumerate(jacobian or ())]  # fmt: skip
        if not scaled or max(abs(x) for row in scaled for x in row) > _STRONG:
            continue
        # Differences of floats across a jump of the map look like a change.
        if how == "duals" and first_jacobian and _has_changed(first_jacobian, scaled):
            return [round_to_simple(float(x)) for x in units]
        first_jacobian = first_jacobian or scaled
    return [round_to_simple(x) for x in shares] if first_jacobian else None


def _jacobian_at(probe: Probe, units: Sequence[Fraction]) -> list[list[float]] | None:
    place = TrialPlace(states(units)[0], Fraction(0), tuple(units), tuple(units))
    measured = unless_it_fails(partial(probe.jacobian, place, Fraction(0)))
    return None if measured is None else [[float(x) for x in row] for row in measured[0]]


def _balance(
    jacobian: list[list[float]], units: Sequence[Fraction], shares: list[float]
) -> list[float]:
    """Return the shares of the coordinates such that J − 1 has rows and columns of one size; those
    that differ little from 1 stay 1."""
    size = range(len(units))
    entries = [[abs(x) * float(units[j] / units[i]) for j, x in enumerate(row)]
               for i, row in enumerate(jacobian)]  # fmt: skip
    result = list(shares)
    for _ in range(10):
        for k in size:
            row = sum(entries[k][j] for j in size if j != k)
            column = sum(entries[i][k] for i in size if i != k)
            if row * column > _WEAK**2:
                ratio = math.sqrt(row / column)
                result[k] *= ratio
                for j in size:
                    if j != k:
                        entries[k][j] /= ratio
                        entries[j][k] *= ratio
    mean = math.exp(sum(map(math.log, result)) / len(result))
    return [1.0 if 1 / ALIKE < x / mean < ALIKE else x / mean for x in result]


def _has_changed(one_jacobian: list[list[float]], other_jacobian: list[list[float]]) -> bool:
    """Return True if an entry differs by more than a tenth of the largest entry of the first."""
    largest = max(abs(x) for row in one_jacobian for x in row)
    pairs = zip(one_jacobian, other_jacobian, strict=True)
    return any(
        abs(x - y) > _CHANGE_SHARE * largest
        for one, two in pairs
        for x, y in zip(one, two, strict=True)
    )
