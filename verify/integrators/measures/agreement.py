"""Agreement of a user's map in our numbers with the same map in his floats."""

import math
import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

import gmpy2

from verify.arithmetic.exact import fraction
from verify.integrators.measures.probes import DualProbe
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.tracing.dual import DualNumber, Duals, slope_of
from verify.integrators.tracing.trace import Node, evaluate_nodes, in_order, replay_in
from verify.integrators.tracing.traced_number import UntraceableError
from verify.integrators.user_code.step import unless_it_fails
from verify.integrators.user_code.user_map import DOUBLE, State, UserMap
from verify.prose import read_prose

_STEP_DIVISORS = 8, 64  # the steps that are tried are such parts of a place's largest one
_RELATIVE_TOLERANCE = 1e-12
# A distance is allowed up to the tolerance, and up to so many times the first-order bound.
_LEAST_TOLERANCE, _BOUND_FACTOR = 2.0**-46, 8
_SCATTERED_PLACES = 20  # further places around each, up to a quarter of a unit away
# Where the code compares values, since a loop may then stop at another iteration.
_BRANCHING_TOLERANCE = 1e-6
_MAX_LOOP_TOLERANCE = 0.1  # the largest limit in a comparison that is taken for a loop's tolerance
_EPSILON = 2.0**-52
BoundedValue = tuple[float, float]  # a value, and a bound of its error to first order
BoundedEnd = tuple[list[Fraction], list[float]]  # z', and how far it may be from the floats' end


def must_agree(probe: DualProbe, places: Sequence[TrialPlace]) -> None:
    """Raise UntraceableError where dual numbers and the user's floats part at one of the places.

    So it is where the code keeps a state, or takes another branch with floats.
    """

    def end_of_ours(place: TrialPlace, h: Fraction, floats_end: State) -> BoundedEnd:
        end, bound = probe.end(place, h), _RELATIVE_TOLERANCE
        if probe.opaque:
            limits = [abs(float(x.limit)) for x in probe.comparisons if x.limit]
            # A loop may end elsewhere with 200 bits than with 53: both ends are then within a few
            # tolerances of each other.
            bound = max([_BRANCHING_TOLERANCE, *(4 * x for x in limits if x < _MAX_LOOP_TOLERANCE)])
        units = map(float, place.units)
        return end, [bound * (u + abs(x)) for u, x in zip(units, floats_end, strict=True)]

    _must_agree(probe.step, places, end_of_ours)


def trace_must_agree(step: UserMap, roots: Sequence[Node], places: Sequence[TrialPlace]) -> None:
    """Check a trace as `must_agree` does, at many places, and as closely as rounding lets it."""
    nodes, kind = in_order(*roots), Duals()

    def end_of_ours(place: TrialPlace, h: Fraction, floats_end: State) -> BoundedEnd | None:
        start = dict(zip(step.names, place.z, strict=True))
        start |= {"h": DOUBLE.round_number(h), "t": DOUBLE.round_number(place.t)}
        end = _replay_trace(kind, nodes, roots, start)
        return (
            None
            if end is None
            else (end, _bound_difference(nodes, roots, start, floats_end, place))
        )

    with kind.running():
        _must_agree(
            step,
            [*places, *(x for place in places[:6] for x in _scatter_places(place))],
            end_of_ours,
        )


def _must_agree(
    step: UserMap, places: Sequence[TrialPlace],
    end_of_ours: Callable[[TrialPlace, Fraction, State], BoundedEnd | None],
) -> None:  # fmt: skip
    """Compare the user's calls with floats with ours; raise UntraceableError where they differ.

    `end_of_ours` returns our end of such a call with its distance allowed from the floats' end, or
    None where that is not known.
    """
    compared = 0
    for place, h in _calls(places):
        rounded_place = place.with_rounded_state(DOUBLE.round_number)
        # Where the call fails the place is left out: others may do.
        floats_end = unless_it_fails(partial(step.at_place, rounded_place, h))
        bounded = None if floats_end is None else end_of_ours(rounded_place, h, floats_end)
        if floats_end is not None and bounded is not None:
            compared += 1
            if any(abs(Fraction(x) - y) > z for x, y, z in zip(floats_end, *bounded, strict=True)):
                raise _disagreement(step, rounded_place, h)
    if not compared:
        raise UntraceableError("it fails at every place that is tried")


def _calls(places: Sequence[TrialPlace]) -> Iterator[tuple[TrialPlace, Fraction]]:
    for place in places:
        for part in _STEP_DIVISORS if place.step else _STEP_DIVISORS[:1]:
            yield place, place.step / part


def _scatter_places(place: TrialPlace) -> list[TrialPlace]:
    draw = random.Random(1)  # noqa: S311 - any places do
    return [
        replace(
            place,
            z=tuple(
                x + u * Fraction(draw.randrange(-256, 256), 1024)
                for x, u in zip(place.z, place.reach, strict=True)
            ),
        )
        for _ in range(_SCATTERED_PLACES)
    ]


def _replay_trace(
    kind: Duals, nodes: Sequence[Node], roots: Sequence[Node], start: dict[str, Fraction]
) -> list[Fraction] | None:
    """Return the end of the trace from this start; None where it cannot be computed."""
    numbers = {name: kind.rational(x) for name, x in start.items()}
    try:
        values = evaluate_nodes(nodes, replay_in(kind, numbers))
        end: list[DualNumber] = [values[root.number] for root in roots]
        return [fraction(x.value) for x in end]
    except (ArithmeticError, ValueError):
        return None


def _bound_difference(
    nodes: Sequence[Node], roots: Sequence[Node], start: dict[str, Fraction], floats_end: State,
    place: TrialPlace,
) -> list[float]:  # fmt: skip
    """Bound, by component, the distance that rounding alone may leave between trace and floats."""
    try:
        noise = _rounding_noise(nodes, {name: float(x) for name, x in start.items()})
    except (ArithmeticError, ValueError):  # beyond what floats can do
        return [math.inf] * len(floats_end)
    return [
        _LEAST_TOLERANCE * (float(u) + abs(x)) + _BOUND_FACTOR * noise[root.number]
        for u, x, root in zip(place.units, floats_end, roots, strict=True)
    ]


def _disagreement(step: UserMap, place: TrialPlace, h: Fraction) -> UntraceableError:
    state = ", ".join(f"{name} = `{x}`" for name, x in zip(step.names, place.z, strict=True))
    size = f", h = `{h}`" if step.takes_step_size else ""
    return UntraceableError(read_prose(f"with floats it does something else, at {state}{size}"))


# -- what rounding alone may make ------------------------------------------------------------------


def _rounding_noise(nodes: Sequence[Node], start: dict[str, float]) -> dict[int, float]:
    """Bound each node's error where each operation is rounded, by the nodes' numbers.

    `start`: the coordinates, h and t by name. Raises ArithmeticError or ValueError where floats do
    not reach.
    """

    def round_node(node: Node, x: list[BoundedValue]) -> BoundedValue:
        value, inherited = _evaluate_node(node, x, start)
        if not math.isfinite(value):
            raise OverflowError
        rounding_error = 0.0 if node.operation == "symbol" else 4 * _EPSILON * abs(value)
        return value, inherited + rounding_error

    return {number: error for number, (_, error) in evaluate_nodes(nodes, round_node).items()}


def _evaluate_node(node: Node, x: list[BoundedValue], start: dict[str, float]) -> BoundedValue:
    """Return the node's value, and the error that its inputs' errors cause."""
    match node.operation:
        case "symbol":
            return start[node.value], 0.0
        case "number":
            return float(node.value), 0.0
        case "pi":
            return math.pi, 0.0
        case "power":
            (a, e), n = x[0], float(node.value)
            value = float(a**n)
            # x·x·…, by which whole powers may be made, is rounded n times.
            return value, abs(n * a ** (n - 1)) * e + abs(n * value) * _EPSILON
        case "add" | "subtract" as name:
            (a, e), (b, f) = x
            return a + b if name == "add" else a - b, e + f
        case "multiply":
            (a, e), (b, f) = x
            return a * b, abs(a) * f + abs(b) * e
        case "divide":
            (a, e), (b, f) = x
            return a / b, (e + abs(a / b) * f) / abs(b)
        case name:
            a, e = x[0]
            value = getattr(math, name)(a)
            slope = slope_of(name, gmpy2.mpfr(a), gmpy2.mpfr(value))
            return value, abs(float(slope)) * e
