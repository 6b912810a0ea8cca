"""Whether our numbers make of a user's map what his floats make of it."""

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from verify.integrators.places.place import Place
from verify.integrators.probes.duals import DualProbe
from verify.integrators.probes.rounding_noise import rounding_noise
from verify.integrators.tracing.dual import Dual, Duals
from verify.integrators.tracing.number import UntraceableError
from verify.integrators.tracing.trace import Node, in_order, replayed, through
from verify.integrators.user_code.user_map import State, UserMap
from verify.prose import read_prose

_PARTS = 8, 64  # of a place's largest step
_AGREES = 1e-12
_ROUNDED, _BEYOND = 2.0**-46, 8  # what is allowed at least, and times the bound to first order
_SCATTERED = 20  # further places around each, up to a quarter of a unit away
_ENDS_ELSEWHERE = 1e-6  # where values are compared, as a loop's tolerance may with duals
_LOOSEST = 0.1  # a bound that a loop may end at


def must_agree(probe: DualProbe, places: Sequence[Place]) -> None:
    """UntraceableError where dual numbers and the user's floats part at one of the places.

    So it is where the code keeps a state, or takes another branch with floats.
    """
    step, compared = probe.step, 0
    for place, h in _calls(places):
        rounded = place.rounded(lambda x: Fraction(float(x)))
        mine = _floats(step, rounded, h)
        if mine is None:
            continue
        theirs = probe.end(rounded, h)
        compared += 1
        near = _AGREES
        if probe.opaque:
            limits = [abs(float(x.limit)) for x in probe.comparisons if x.limit]
            near = max([_ENDS_ELSEWHERE, *(4 * x for x in limits if x < _LOOSEST)])
        sizes = [float(u) + abs(x) for u, x in zip(place.units, mine, strict=True)]
        gaps = zip(mine, theirs, sizes, strict=True)
        if any(abs(Fraction(x) - y) > near * size for x, y, size in gaps):
            raise _parting(step, rounded, h)
    if not compared:
        raise UntraceableError("it fails at every place that is tried")


def trace_must_agree(step: UserMap, roots: Sequence[Node], places: Sequence[Place]) -> None:
    """As `must_agree`, for a trace, at many places, and as near as rounding lets it be."""
    nodes, kind, compared = in_order(*roots), Duals(), 0
    wide = [*places, *(x for place in places[:6] for x in _around(place))]
    with kind.running():
        for place, h in _calls(wide):
            rounded = place.rounded(lambda x: Fraction(float(x)))
            mine = _floats(step, rounded, h)
            if mine is None:
                continue
            start = dict(zip(step.names, rounded.z, strict=True))
            start |= {"h": Fraction(float(h)), "t": Fraction(float(place.t))}
            theirs = _replayed(kind, nodes, roots, start)
            if theirs is None:
                continue
            compared += 1
            allowed = _allowed(nodes, roots, start, mine, place)
            if any(abs(x - y) > most for x, y, most in zip(mine, theirs, allowed, strict=True)):
                raise _parting(step, rounded, h)
    if not compared:
        raise UntraceableError("it fails at every place that is tried")


def _calls(places: Sequence[Place]) -> Iterator[tuple[Place, Fraction]]:
    for place in places:
        for part in _PARTS if place.step else _PARTS[:1]:
            yield place, place.step / part


def _around(place: Place) -> list[Place]:
    draw = random.Random(1)  # noqa: S311 - any places do
    return [
        replace(
            place,
            z=tuple(
                x + u * Fraction(draw.randrange(-256, 256), 1024)
                for x, u in zip(place.z, place.reach, strict=True)
            ),
        )
        for _ in range(_SCATTERED)
    ]


def _floats(step: UserMap, place: Place, h: Fraction) -> State | None:
    try:
        return step.at([float(x) for x in place.z], float(h), float(place.t))
    except Exception:  # it fails there; other places may do
        return None


def _replayed(
    kind: Duals, nodes: Sequence[Node], roots: Sequence[Node], start: dict[str, Fraction]
) -> list[Fraction] | None:
    numbers = {name: kind.rational(x) for name, x in start.items()}
    try:
        made = through(nodes, replayed(kind, numbers))
        ended: list[Dual] = [made[root.number] for root in roots]
        return [Fraction(*map(int, x.value.as_integer_ratio())) for x in ended]
    except (ArithmeticError, ValueError):
        return None


def _allowed(
    nodes: Sequence[Node], roots: Sequence[Node], start: dict[str, Fraction], mine: State,
    place: Place,
) -> list[float]:  # fmt: skip
    try:
        noise = rounding_noise(nodes, {name: float(x) for name, x in start.items()})
    except (ArithmeticError, ValueError):  # beyond what floats can do
        return [math.inf] * len(mine)
    return [
        _ROUNDED * (float(u) + abs(x)) + _BEYOND * noise[root.number]
        for u, x, root in zip(place.units, mine, roots, strict=True)
    ]


def _parting(step: UserMap, place: Place, h: Fraction) -> UntraceableError:
    where = ", ".join(f"{name} = `{x}`" for name, x in zip(step.names, place.z, strict=True))
    size = f", h = `{h}`" if step.stepped else ""
    return UntraceableError(read_prose(f"with floats it does something else, at {where}{size}"))
