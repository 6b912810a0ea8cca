"""The units of the coordinates and of time, of a Hamiltonian or of equations without one.

In equations no coordinate is a momentum: the scale of each is where the field turns from one power
of it to another.
"""

from fractions import Fraction

from verify.integrators.places.trial_places import round_to_simple
from verify.integrators.places.units import (
    TIME,
    FloatField,
    Units,
    direction,
    find_duration,
    find_turns,
    response,
    units_of,
)


def units_of_system(field: FloatField, usual: float | None = None) -> tuple[Units, Fraction]:
    """Return the units of the coordinates, for each scale that the system has, and the unit of t.

    `usual`: the length that is taken where the field has no scale; None for any.
    """
    if field.canonical:
        return units_of(field, usual)
    ways = direction(len(field.names))
    zeros = [0.0] * len(ways)
    origin = zeros if field(zeros) is not None else None

    def size(s: float) -> float | None:
        return field.octave([s * x for x in ways], TIME, origin, TIME)

    turns = [*find_turns(size), *find_turns(lambda s: size(-s))]
    scale = turns[0] if turns else usual or 1.0
    base = [scale * x for x in ways]
    own_turns = [find_turns(response(field, base, k)) for k in range(len(ways))]
    units = [x[0] if x else scale for x in own_turns]
    return [[round_to_simple(x) for x in units]], round_to_simple(find_duration(field, units))
