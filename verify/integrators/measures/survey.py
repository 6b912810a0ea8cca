"""The places at which a step or map is tried: the user's first, then patterns in natural units.

A place is a state with a time, units of the coordinates and a largest step size, which depends on
how fast the motion changes there. Places are left out at which Hamilton's equations are undefined,
or the motion is faster by far than at the others, as where atoms lie on top of each other.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial

from verify.arithmetic.exact import decimal
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.integrators.places.equation_units import units_of_system
from verify.integrators.places.trial_places import (
    PATTERN,
    USER,
    TrialPlace,
    select_spread,
    states,
)
from verify.integrators.places.units import FloatField, Vector
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import UserMap

_SHORT_STEP_DIVISOR = 64  # a step is first tried with the largest step size divided by this number
_MAX_STRIDE = 8.0  # units of a coordinate that a whole step may move
_MAX_SPEED_RATIO = 40.0  # a motion is too fast with this multiple of the median rate of change
_TIMES = tuple(map(Fraction, ("1/4", "5/7", "1/20", "13/5", "1003/7")))  # in H's unit of time
_MAX_VARIANTS = 4  # states that are tried for one pattern of signs
_MOST_PLACES = {1: 12, 2: 16}  # by the degrees of freedom
_MOST_PLACES_OTHERWISE = 16
_PLACES_IN_OTHER_SCALES = 4  # in each scale of H but the first
_RIPPLE_FACTOR = 8  # a field ripples if its slope at a point is this multiple of that over a length
ALIKE = 30  # sizes of a coordinate that differ less are one
_LARGEST_STEP = Fraction(1, 2)  # in units of the time in which the motion changes


@dataclass(frozen=True)
class Request:
    """The user's choice of a state, a step size, units by the coordinates' names, and the largest
    defect that is allowed."""

    z: tuple[Fraction, ...] | None = None
    step_size: Fraction | None = None
    scale: Mapping[str, Fraction] = field(default_factory=dict)
    within: Fraction | None = None


NO_REQUEST = Request()
_LARGEST_NUMBER = Fraction(10) ** 150  # products of larger numbers overflow in doubles


def check_request(names: Sequence[str], request: Request) -> None:
    """Raise InputError if a number of the request is out of the range of floats."""
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
    field_: FloatField, time_dependent: bool, request: Request = NO_REQUEST
) -> list[TrialPlace]:
    """Choose the places for a step of that system, most of them in its first scale, a few in each
    other one; none if its equations are defined at none of them."""
    q_max = max((float(abs(x)) for x in (request.z or ())[field_.degrees :]), default=0.0)
    scales, unit_of_time = units_of_system(field_, q_max or None)
    unit_of_force = unit_of_time if time_dependent else None

    def place(
        k: int, z: tuple[Fraction, ...], units: Sequence[Fraction], source: str = PATTERN
    ) -> TrialPlace | None:
        t = _TIMES[k % len(_TIMES)] * unit_of_time if time_dependent else Fraction(0)
        return _build_place(field_, z, t, units, unit_of_force, source)

    places = list[TrialPlace | None]()
    for k, scale in enumerate(scales[:1] if request.scale else scales):
        units = [request.scale.get(name, x) for name, x in zip(field_.names, scale, strict=True)]
        if k == 0 and request.z is not None:
            places.append(place(0, request.z, units, USER))
        calm = _build_patterns(place, units)
        count = _MOST_PLACES.get(field_.degrees, _MOST_PLACES_OTHERWISE)
        places += select_spread(calm, _PLACES_IN_OTHER_SCALES) if k else calm[:count]
    return _set_step_size([x for x in places if x is not None], request.step_size)


def _build_patterns(
    build: Callable[..., TrialPlace | None], units: Sequence[Fraction]
) -> list[TrialPlace]:
    """Build the patterns in these units, without places of too fast a motion."""
    places = [build(k, z, units) for k, z in enumerate(states(units))]
    least_step = _least_step([x for x in places if x is not None])
    # A place at which H is undefined, or the motion too fast, is replaced by another variant.
    for variant in range(1, _MAX_VARIANTS):
        for k, z in enumerate(states(units, variant)):
            if not _is_calm(places[k], least_step):
                places[k] = build(k, z, units)
    return [x for x in places if x is not None and _is_calm(x, least_step)]


def _set_step_size(places: list[TrialPlace], size: Fraction | None) -> list[TrialPlace]:
    """Return the places with the user's step size: that of the user's place, and a limit at the
    others; without a place of the user's it is that of all places."""
    if size is None:
        return places
    has_users_place = any(x.source == USER for x in places)
    return [
        replace(x, step=min(x.step, size) if has_users_place and x.source != USER else size)
        for x in places
    ]


def _build_place(
    field_: FloatField, z: tuple[Fraction, ...], t: Fraction, units: Sequence[Fraction],
    unit_of_time: Fraction | None, source: str,
) -> TrialPlace | None:  # fmt: skip
    state, moment = [float(x) for x in z], float(t)
    # At the user's place a coordinate may be far larger than its unit: its reach is then at most a
    # quarter of its size.
    local = [
        float(max(u, abs(x) / 4)) if source == USER else float(u)
        for u, x in zip(units, z, strict=True)
    ]
    try:
        reach = _find_reaches(field_, state, moment, local)
        speed = _measure_rate(field_, state, moment, reach)
    except (NoFlowError, OverflowError, ZeroDivisionError):
        return None
    if unit_of_time is not None:
        # A force that depends on time changes by itself, however slowly the state moves.
        speed = max(speed, 0.5 / float(unit_of_time))
    step = (
        _LARGEST_STEP / _power_of_two(speed)
        if speed > 0 and math.isfinite(speed)
        else _LARGEST_STEP
    )
    return TrialPlace(z, t, tuple(units), tuple(_power_of_two(x) for x in reach), step, source)


def _power_of_two(x: float) -> Fraction:
    """Return the largest power of 2 that is at most x."""
    return Fraction(2) ** math.floor(math.log2(x))


def _find_reaches(field: FloatField, z: Vector, t: float, units: Vector) -> list[float]:
    """Return the distance that each coordinate may be moved before the field bends, at most its
    unit. Raises NoFlowError if the field is undefined at z."""
    if (field_values := field(z, t)) is None:
        raise NoFlowError("the field is not defined there")
    steep = field.jacobian(z, t, units)
    return [_find_reach(field, z, t, j, field_values, units[j], steep[j]) for j in range(len(z))]


def _find_reach(
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
                2 * length * abs(slope) > _RIPPLE_FACTOR * (abs(a - b) + 1e-12 * abs(c))
                for slope, (a, b, c) in zip(steep, pairs, strict=True)
            )
            calm = all(abs(a - 2 * c + b) <= 0.5 * abs(c) for a, b, c in pairs)
            if not ripples and (bend < 1 or calm):
                return length
        length /= 4
    return length


def _measure_rate(field: FloatField, z: Vector, t: float, reach: Vector) -> float:
    """Measure how fast the motion changes: ‖∂f/∂z‖ in balanced coordinates, plus a part of |f|.

    Balancing (Osborne, J. ACM 7 (1960)) removes the units: the norm is then near the largest
    frequency. Raises NoFlowError if the field is undefined nearby.
    """
    columns = field.jacobian(z, t, reach)
    size = len(columns)
    entries = [[abs(columns[j][i]) * reach[j] / reach[i] for j in range(size)] for i in range(size)]
    for _ in range(20):
        for k in range(size):
            row = sum(entries[k][j] for j in range(size) if j != k)
            column = sum(entries[i][k] for i in range(size) if i != k)
            if row > 0 and column > 0:
                # A diagonal scaling, here one that makes the sums of row and column equal, does not
                # change the eigenvalues.
                ratio = math.sqrt(column / row)
                for j in range(size):
                    if j != k:
                        entries[k][j] *= ratio
                        entries[j][k] /= ratio
    slopes = field(z, t) or []
    # If f is large, the state leaves its surroundings at once, however smooth f is there.
    speed = max((abs(x) / length for x, length in zip(slopes, reach, strict=True)), default=0.0)
    return max(map(sum, entries)) + speed / 2


def _least_step(places: Sequence[TrialPlace]) -> float:
    """Return the step size below which the motion at a place is too fast beside the others."""
    steps = sorted(float(place.step) for place in places)
    return steps[len(steps) // 2] / _MAX_SPEED_RATIO if steps else 0.0


def _is_calm(place: TrialPlace | None, least_step: float) -> bool:
    return place is not None and float(place.step) >= least_step


def shorten_steps(step: UserMap, places: list[TrialPlace]) -> list[TrialPlace]:
    """Return the places, with a smaller step where the user's step moves the state too far."""
    return [
        replace(x, step=x.step / _power_of_two(max(1.0, _measure_stride(step, x)))) for x in places
    ]


def _measure_stride(step: UserMap, place: TrialPlace) -> float:
    """Return the distance that a whole step moves, in parts of the largest that is allowed; 1 if
    the step fails or returns no number."""
    # A short step is tried, and its distance extrapolated: a whole step may end anywhere.
    end = unless_it_fails(partial(step.at_place, place, place.step / _SHORT_STEP_DIVISOR))
    if end is None:
        return 1.0
    pairs = zip(end, map(float, place.z), place.units, strict=True)
    distance = max(abs(x - y) / float(u) for x, y, u in pairs)
    return min(distance * _SHORT_STEP_DIVISOR / _MAX_STRIDE, 1e30) if distance == distance else 1.0


def places_of_map(
    names: tuple[str, ...], sizes: Sequence[Fraction], request: Request = NO_REQUEST
) -> list[TrialPlace]:
    """Choose the places for a map without an H, in these units of the coordinates, or in those of
    the user's place where that is far from them."""
    point = request.z or (Fraction(0),) * len(names)
    units = tuple(
        request.scale.get(name, u if not x or 1 / ALIKE < abs(x) / u < ALIKE else abs(x))
        for name, u, x in zip(names, sizes, point, strict=True)
    )
    reach = tuple(_power_of_two(float(u)) for u in units)
    places = [TrialPlace(z, Fraction(0), units, reach) for z in states(units)]
    if request.z is not None:
        users_place = TrialPlace(request.z, Fraction(0), units, reach, source=USER)
        places.insert(0, replace(users_place, reach=tuple(
            _power_of_two(float(max(abs(x) / 4, u))) for x, u in zip(request.z, units, strict=True)
        )))  # fmt: skip
    count = _MOST_PLACES.get(len(names) // 2, _MOST_PLACES_OTHERWISE)
    return places[: count + (request.z is not None)]
