"""The places that are looked at: the user's first, then patterns in the units of H, or of the map.

Places at which H has no motion, or one that is faster by far than at the others, as where atoms lie
on top of each other, are left out. How fast the motion changes at a place decides on the largest
step size there.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial

from verify.arithmetic.exact import decimal
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.integrators.measures.probes import DualProbe
from verify.integrators.places.trial_places import (
    PATTERN,
    USER,
    TrialPlace,
    round_to_simple,
    select_spread,
    states,
)
from verify.integrators.places.units import FloatField, Vector, units_of
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import UserMap

_SHORT, _FARTHEST = 64, 8.0  # part of a step that is tried, and units that it may go in all
_FASTEST = 40.0  # times the median of the others' rates
_MOMENTS = tuple(map(Fraction, ("1/4", "5/7", "1/20", "13/5", "1003/7")))  # in units of t
_VARIANTS = 4  # of a pattern of signs
_MOST_PLACES = {1: 12, 2: 16}
_MOST_PLACES_OTHERWISE = 16  # places of more degrees of freedom
_PLACES_ELSEWHERE = 4  # places of another scale of H
_BENT = 0.1  # of the largest entry of J
_RIPPLE = 8  # times the slope over a length that at its middle is none of the same bend
_LARGEST = Fraction(1, 2)  # of the step size, in parts of the time in which the motion changes


@dataclass(frozen=True)
class Request:
    """The user's choice of where to look: a state, a step size, units by the coordinates' names,
    and how large a defect is allowed."""

    z: tuple[Fraction, ...] | None = None
    step_size: Fraction | None = None
    scale: Mapping[str, Fraction] = field(default_factory=dict)
    within: Fraction | None = None


NOWHERE = Request()
_LARGEST_NUMBER = Fraction(10) ** 150  # beyond it products overflow in doubles


def check_request(names: Sequence[str], request: Request) -> None:
    """Raise InputError where a number of the request is out of the range of floats."""
    numbers = {
        **dict(zip(names, request.z or (), strict=False)),
        **{f"scale of {name}": x for name, x in request.scale.items()},
        **({} if request.step_size is None else {"step size": request.step_size}),
    }
    for name, x in numbers.items():
        small = x != 0 and abs(x) * _LARGEST_NUMBER < 1
        if abs(x) > _LARGEST_NUMBER or (small and name not in names):
            raise InputError(name, decimal(x, 3), "is out of range, 1e-150 … 1e150, for floats")


def places_of_field(
    field_: FloatField, moving: bool, request: Request = NOWHERE
) -> list[TrialPlace]:
    """Choose the places for a step of that H; none where H has a motion from none of them.

    Most are in the first scale of H, a few in each that lies far from it.
    """
    q_max = max((float(abs(x)) for x in (request.z or ())[field_.degrees :]), default=0.0)
    scales, unit_of_time = units_of(field_, q_max or 1.0)
    pace = unit_of_time if moving else None

    def place(
        k: int, z: tuple[Fraction, ...], units: Sequence[Fraction], source: str = PATTERN
    ) -> TrialPlace | None:
        t = _MOMENTS[k % len(_MOMENTS)] * unit_of_time if moving else Fraction(0)
        return _place(field_, z, t, units, pace, source)

    places = list[TrialPlace | None]()
    for k, scale in enumerate(scales[:1] if request.scale else scales):
        units = [request.scale.get(name, x) for name, x in zip(field_.names, scale, strict=True)]
        if k == 0 and request.z is not None:
            places.append(place(0, request.z, units, USER))
        calm = _build_patterns(place, units)
        count = _MOST_PLACES.get(field_.degrees, _MOST_PLACES_OTHERWISE)
        places += select_spread(calm, _PLACES_ELSEWHERE) if k else calm[:count]
    return _set_step_size([x for x in places if x is not None], request.step_size)


def _build_patterns(
    make: Callable[..., TrialPlace | None], units: Sequence[Fraction]
) -> list[TrialPlace]:
    """Build the patterns in these units, none of them of a motion that is faster by far."""
    places = [make(k, z, units) for k, z in enumerate(states(units))]
    least_step = _least_step([x for x in places if x is not None])
    for variant in range(1, _VARIANTS):  # where H has no motion there, or too fast a one
        for k, z in enumerate(states(units, variant)):
            if not _is_calm(places[k], least_step):
                places[k] = make(k, z, units)
    return [x for x in places if x is not None and _is_calm(x, least_step)]


def _set_step_size(places: list[TrialPlace], size: Fraction | None) -> list[TrialPlace]:
    """Return the places with the user's step size: exactly at his place, or at all where he names
    none; where he names one it is the largest one elsewhere."""
    if size is None:
        return places
    has_users_place = any(x.source == USER for x in places)
    return [
        replace(x, step=min(x.step, size) if has_users_place and x.source != USER else size)
        for x in places
    ]


def _place(
    field_: FloatField, z: tuple[Fraction, ...], t: Fraction, units: Sequence[Fraction],
    unit_of_time: Fraction | None, source: str,
) -> TrialPlace | None:  # fmt: skip
    state, moment = [float(x) for x in z], float(t)
    # At the user's place a coordinate may be far from its unit: it is then moved by a quarter of
    # its size.
    local = [
        float(max(u, abs(x) / 4)) if source == USER else float(u)
        for u, x in zip(units, z, strict=True)
    ]
    try:
        reach = _reaches(field_, state, moment, local)
        speed = _rate(field_, state, moment, reach)
    except (NoFlowError, OverflowError, ZeroDivisionError):
        return None
    if unit_of_time is not None:
        # A force that depends on time changes by itself, however slowly the state moves.
        speed = max(speed, 0.5 / float(unit_of_time))
    step = _LARGEST / _power(speed) if speed > 0 and math.isfinite(speed) else _LARGEST
    return TrialPlace(z, t, tuple(units), tuple(_power(x) for x in reach), step, source)


def _power(x: float) -> Fraction:
    """Return the nearest power of 2, from below."""
    return Fraction(2) ** math.floor(math.log2(x))


def _reaches(field: FloatField, z: Vector, t: float, units: Vector) -> list[float]:
    """Return how far each coordinate may be moved before the field bends, at most its unit."""
    field_values = field(z, t)
    if field_values is None:
        raise NoFlowError("H is not defined there")
    steep = field.jacobian(z, t, units)
    return [_reach(field, z, t, j, field_values, units[j], steep[j]) for j in range(len(z))]


def _reach(
    field: FloatField, z: Vector, t: float, j: int, field_values: Vector, unit: float, steep: Vector
) -> float:
    length = unit
    for _ in range(20):
        ends = []
        for sign in (1, -1):
            state = list(z)
            state[j] += sign * length
            ends.append(field(state, t))
        if ends[0] is not None and ends[1] is not None:
            pairs = list(zip(ends[0], ends[1], field_values, strict=True))
            bend = max(
                abs(a - 2 * c + b) / (abs(a - b) + abs(c) * 1e-3 + 1e-300) for a, b, c in pairs
            )
            ripples = any(
                2 * length * abs(slope) > _RIPPLE * (abs(a - b) + 1e-12 * abs(c))
                for slope, (a, b, c) in zip(steep, pairs, strict=True)
            )
            calm = all(abs(a - 2 * c + b) <= 0.5 * abs(c) for a, b, c in pairs)
            if not ripples and (bend < 1 or calm):
                return length
        length /= 4
    return length


def _rate(field: FloatField, z: Vector, t: float, reach: Vector) -> float:
    """Measure how fast the motion changes: ‖∂f/∂z‖ with its coordinates balanced, and of its way.

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
                # A diagonal scaling that makes the sums of row and column equal leaves the
                # eigenvalues as they are.
                ratio = math.sqrt(column / row)
                for j in range(size):
                    if j != k:
                        entries[k][j] *= ratio
                        entries[j][k] /= ratio
    slopes = field(z, t) or []
    # Where f is large the state leaves its surroundings at once, however smooth f is there.
    moving = max((abs(x) / length for x, length in zip(slopes, reach, strict=True)), default=0.0)
    return max(map(sum, entries)) + moving / 2


def _least_step(places: Sequence[TrialPlace]) -> float:
    """Return the step size below which a place's motion is faster by far than that of the
    others."""
    steps = sorted(float(place.step) for place in places)
    return steps[len(steps) // 2] / _FASTEST if steps else 0.0


def _is_calm(place: TrialPlace | None, least_step: float) -> bool:
    return place is not None and float(place.step) >= least_step


def shorten_steps(step: UserMap, places: list[TrialPlace]) -> list[TrialPlace]:
    """Return the places with smaller steps where the user's steps move the state further than H
    does."""
    return [replace(x, step=x.step / _power(max(1.0, _strides(step, x)))) for x in places]


def _strides(step: UserMap, place: TrialPlace) -> float:
    """Return how many units a step goes, where H would go one at most; 1 where that is not
    known."""
    # A short step is tried, and what it moves is extrapolated to the whole one: a whole step may
    # end anywhere.
    end = unless_it_fails(partial(step.at_place, place, place.step / _SHORT))
    if end is None:
        return 1.0
    pairs = zip(end, map(float, place.z), place.units, strict=True)
    distance = max(abs(x - y) / float(u) for x, y, u in pairs)
    return min(distance * _SHORT / _FARTHEST, 1e30) if distance == distance else 1.0


def places_of_map(
    names: Sequence[str], unit: Fraction, request: Request = NOWHERE
) -> list[TrialPlace]:
    """Choose the places for a map without an H, in that unit of all its coordinates."""
    units = tuple(request.scale.get(name, unit) for name in names)
    reach = tuple(_power(float(u)) for u in units)
    places = [TrialPlace(z, Fraction(0), units, reach) for z in states(units)]
    if request.z is not None:
        users_place = TrialPlace(request.z, Fraction(0), units, reach, source=USER)
        places.insert(0, replace(users_place, reach=tuple(
            _power(float(max(abs(x) / 4, u))) for x, u in zip(request.z, units, strict=True)
        )))  # fmt: skip
    degrees = len(names) // 2
    return places[: _MOST_PLACES.get(degrees, _MOST_PLACES_OTHERWISE) + (request.z is not None)]


def unit_of_map(step: UserMap) -> Fraction:
    """Find the distance from 0 at which the map's Jacobian has changed, a length of its own; 1
    where it has none."""
    first_jacobian: list[list[float]] | None = None
    try:
        probe = DualProbe(step)
        for exponent in range(-20, 21):
            unit = Fraction(2) ** exponent
            jacobian = _jacobian(probe, step.names, unit)
            if (
                jacobian is not None
                and first_jacobian is not None
                and _has_changed(first_jacobian, jacobian)
            ):
                return round_to_simple(float(unit))
            first_jacobian = first_jacobian or jacobian
    except Exception:  # the user's code may raise anything
        return Fraction(1)
    return Fraction(1)


def _jacobian(probe: DualProbe, names: Sequence[str], unit: Fraction) -> list[list[float]] | None:
    units = (unit,) * len(names)
    place = TrialPlace(states(units)[0], Fraction(0), units, units)
    reading = unless_it_fails(partial(probe.reading, place, Fraction(0)))
    return None if reading is None else [list(row) for row in reading.jacobian]


def _has_changed(before: list[list[float]], after: list[list[float]]) -> bool:
    """Return True if an entry has moved by a tenth of the largest."""
    largest = max(abs(x) for row in before for x in row)
    pairs = zip(before, after, strict=True)
    return any(
        abs(x - y) > _BENT * largest for one, two in pairs for x, y in zip(one, two, strict=True)
    )
