"""The distance of one step from the exact flow, component by component, as its step size falls.

The order is that of the worst component at the worst place, where its slope has settled. An error
is counted where it is beyond the noise of the numbers that the code computes in.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.error_powers import (
    CLEAR_FACTOR,
    ENOUGH,
    OF_MANY,
    ErrorTail,
    PowerStretch,
    Row,
    clear_slopes,
    limit_of,
    settle_power,
    slopes_of,
)
from verify.integrators.measures.probes import DualProbe, Probe
from verify.integrators.places.trial_places import SIDE, USER, TrialPlace, select_spread
from verify.integrators.places.wrap_periods import Periods, find_wrapped_periods, unwrap
from verify.integrators.user_code.step import StepError, describe_error, limit_time
from verify.integrators.user_code.user_map import UserMap

SPACED = tuple(Fraction(2) ** k for k in range(9))  # parts of a place's largest step
# Dual numbers have 200 bits, so that steps may be as small as 2⁻⁵⁰ of the largest; the first ones
# are closer to one another, since most slopes settle there.
_FINE = tuple(
    2**k for k in (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 18, 22, 26, 30, 34, 38, 42, 46, 50)
)
# Floats lose the error in their rounding after few halvings: the step sizes are closer, with the
# ratios 4/3 and 3/2 in turn.
_COARSE = (
    *(Fraction(2**k, x) for k in range(2, 11) for x in (4, 3)),
    *(2**k for k in range(9, 27)),
)
LADDERS = {"duals": tuple(map(Fraction, _FINE)), "floats": tuple(map(Fraction, _COARSE))}
_DIGITS, _MORE_DIGITS = 50, 4  # of the exact flow for dual numbers; and more than a step's own have
_COEFFICIENTS = 2.0**-52  # of a step's length: what a rounded coefficient does to it
_PLACES = {1: 7}  # at which it is looked
_OTHERWISE = 4
_QUIET = 3  # step sizes in the noise, after which none is looked at


@dataclass(frozen=True)
class PlaceOrder:
    """The order at one place: `power` of h by which the worst component's error falls; None where
    that has not settled, or, `exact`, where none is seen. `slopes`: those that are seen below the
    last step size at which terms cancel."""

    place: TrialPlace
    power: int | None
    exact: bool
    component: str = ""
    run: PowerStretch | None = None
    tail: ErrorTail | None = None
    slopes: tuple[float, ...] = ()
    rows: tuple[Row, ...] = ()  # of that component, as they stand
    unseen: float = 0.0  # an error of the step, in parts of it, that would not show
    limit: float = 0.0  # to which the slopes tend
    distance: float = 0.0  # how far the flow goes with the largest step, in units

    def may_fall_below(self, power: int) -> bool:
        """Return True if its slopes, which have not settled, may come to less than that power: not
        where they stay above it, or rise to it. A few do not tell."""
        if len(self.slopes) < ENOUGH:
            return False
        before, last = self.slopes[-2:]
        return self.limit < power - (0.5 if last >= before else 0.2)


@dataclass(frozen=True)
class Distances:
    """Distances of one step from the exact flow, at places; `periods`: modulo which they were
    compared."""

    how: str
    places: tuple[PlaceOrder, ...]
    periods: Periods = ()


def distances_of(
    step: UserMap,
    probe: Probe,
    hamiltonian: Hamiltonian,
    places: Sequence[TrialPlace],
    ladder: Sequence[Fraction] = (),
) -> Distances:
    """Measure the distances. Raises StepError where no exact flow is known, or the step fails, at
    all of the places."""
    flow = flow_of(hamiltonian, probe)
    selected = _select_places(places, _PLACES.get(step.degrees, _OTHERWISE))
    parts = tuple(ladder) or LADDERS[probe.how]
    step.periods = _periods(step, probe, flow, hamiltonian, selected, parts[-1])
    orders, problems = list[PlaceOrder](), list[str]()
    for place in selected:
        try:
            # The exact flow is computed within the user's time: near a singularity it might not
            # come back.
            with limit_time(max(step.left, 0.1), "the exact flow takes too long"):
                orders.append(_measure_at(step, probe, flow, place, parts))
        except Exception as error:  # the user's code may raise anything
            problems.append(f"{describe_error(error)}{step.place(place.z, place.step)}")
        if step.left <= 0:
            break
    if not orders:
        raise StepError(
            problems[0] if problems else "it has no exact solution from any of the places"
        )
    return Distances(probe.how, tuple(orders), step.periods)


def flow_of(hamiltonian: Hamiltonian, probe: Probe) -> NumericalFlow:
    """Build the exact flow, to as many digits as a probe needs."""
    digits = _DIGITS if probe.how == "duals" else probe.step.numbers.digits + _MORE_DIGITS
    return NumericalFlow(canonical_field(hamiltonian)[0], digits)


def _select_places(places: Sequence[TrialPlace], count: int) -> list[TrialPlace]:
    """Select the user's places, those on other sides of comparisons, and some of all amplitudes of
    each scale."""
    selected = [x for x in places if x.source in (USER, SIDE)]
    unselected = [x for x in places if x not in selected]
    for units in dict.fromkeys(x.units for x in unselected):
        selected += select_spread([x for x in unselected if x.units == units], count)
    return selected


def _periods(
    step: UserMap, probe: Probe, flow: NumericalFlow, hamiltonian: Hamiltonian,
    places: Sequence[TrialPlace], part: Fraction,
) -> Periods:  # fmt: skip
    """Find by which periods the step reduces its coordinates, by a step of almost no length."""
    ends = []
    for place in places:
        try:
            h = place.step / part
            ends.append((probe.end(place, h), end_of_flow(flow, probe, place, h)))
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    smallest = min((place.step for place in places), default=Fraction(1)) / part
    return find_wrapped_periods(ends, hamiltonian, smallest) if ends else ()


def end_of_flow(
    flow: NumericalFlow, probe: Probe, place: TrialPlace, h: Fraction
) -> list[Fraction]:
    """Return the end of the exact flow, from the state and over the time that the probe calls with.

    Raises StepError.
    """
    # The flow starts from the rounded state that the step gets, else the rounding of the input
    # would count as an error of the step.
    z = place.with_rounded_state(probe.round_number).z
    start = dict(zip(probe.step.names, z, strict=True))
    state = flow.state({**start, "t": probe.round_number(place.t)})
    try:
        end = flow.advance(state, flow.number(probe.round_number(h)))
    except NoFlowError as error:
        raise StepError(error.reason) from None
    return [flow.arithmetic.exact(x) for x in end[: len(z)]]


def _measure_at(
    step: UserMap, probe: Probe, flow: NumericalFlow, place: TrialPlace, parts: Sequence[Fraction]
) -> PlaceOrder:
    """Measure all components at one place."""
    size, start = len(place.z), place.with_rounded_state(probe.round_number).z
    rows: list[list[Row]] = [[] for _ in range(size)]
    negative: list[list[bool]] = [[] for _ in range(size)]
    counts, ways, quiet, unseen, lost = list[int](), list[float](), 0, float("inf"), ""
    for part in parts:
        h = place.step / part
        try:
            end = probe.end(place, h)
            count = len(probe.comparisons)
            flow_end = end_of_flow(flow, probe, place, h)
        except Exception as error:  # a step size may be too large for it
            lost = str(describe_error(error))
            continue
        errors, noise, distance = _row(step, probe, place, h, start, end, flow_end)
        for k in range(size):
            rows[k].append((float(h), abs(errors[k]), noise[k]))
            negative[k].append(errors[k] < 0)
        counts.append(count)
        ways.append(distance)
        if distance:
            scaled = zip(errors, noise, place.units, strict=True)
            # An error of the step below this part of its way would not show at any of the step
            # sizes.
            unseen = min(unseen, max((abs(e) + 10 * n) / float(u) for e, n, u in scaled) / distance)
        # Once the errors of all components are in their noise at several step sizes, smaller ones
        # show nothing more.
        is_quiet = all(abs(e) <= 10 * n for e, n in zip(errors, noise, strict=True))
        quiet = quiet + 1 if is_quiet else 0
        if quiet >= _QUIET or step.left <= 0:
            break
    if len(rows[0]) < _QUIET:
        raise StepError(lost or "it fails for most step sizes")
    place_order = _select_slowest(step, place, rows, negative, counts, ways, probe.how, unseen)
    return replace(place_order, distance=max(ways))


def _row(
    step: UserMap, probe: Probe, place: TrialPlace, h: Fraction, start: Sequence[Fraction],
    end: Sequence[Fraction], flow_end: Sequence[Fraction],
) -> tuple[list[float], list[float], float]:  # fmt: skip
    """Return errors and noise of the components, and how far the flow goes in units of the
    place."""
    periods = step.periods or (Fraction(0),) * len(flow_end)
    unwrapped_end = list(map(unwrap, end, flow_end, periods))
    errors = [float(x - y) for x, y in zip(unwrapped_end, flow_end, strict=True)]
    ways = [float(abs(y - z)) for y, z in zip(flow_end, start, strict=True)]
    units = [float(u) for u in place.units]
    distance = max(way / unit for way, unit in zip(ways, units, strict=True))
    noise = probe.noise(place, end)
    if isinstance(probe, DualProbe):
        noise = [
            # With 200 bits the coefficients are what is rounded, as users write them as doubles:
            # each of them moves the end by such a part of the way.
            n + _COEFFICIENTS * (way + unit * distance / 8)
            for n, way, unit in zip(noise, ways, units, strict=True)
        ]
    else:
        scatter = probe.scatter(place, place.step / 8)
        noise = [max(pair) for pair in zip(noise, scatter, strict=True)]
    return errors, noise, distance


def _select_slowest(
    step: UserMap, place: TrialPlace, rows: list[list[Row]],
    negative: list[list[bool]], counts: Sequence[int], ways: Sequence[float], how: str,
    unseen: float,
) -> PlaceOrder:  # fmt: skip
    """Select the component whose error falls most slowly."""
    by_component = [(k, slopes_of(r)) for k, r in enumerate(rows)]
    resolved = [(k, x) for k, x in by_component if x.is_seen]
    if not resolved:
        return PlaceOrder(place, None, True, unseen=unseen)
    candidates = []
    for k, slopes in resolved:
        unit = float(place.units[k])
        power, run, tail = settle_power(slopes, rows[k], counts, ways, how, unit)
        clear = clear_slopes(rows[k], negative[k], OF_MANY if how == "duals" else CLEAR_FACTOR)
        candidates.append(
            PlaceOrder(place, power, False, step.names[k], run, tail,
                       tuple(x for _, x in clear), tuple(rows[k]), unseen, limit_of(clear))
        )  # fmt: skip
    settled = [x for x in candidates if x.power is not None]
    loose = [x for x in candidates if x.power is None]
    if settled:
        lowest = min(settled, key=lambda x: x.power or 0)
        # What has not settled may be lower, unless it is small beside what has.
        return lowest if not _hides(step, loose, lowest) else loose[0]
    return max(loose, key=lambda x: len(x.slopes))


def _hides(step: UserMap, loose: Sequence[PlaceOrder], lowest: PlaceOrder) -> bool:
    """Return True if a component that has not settled may be of a lower power.

    One whose slopes are few is not where its errors are smaller on the stretch that has settled.
    """
    power, run = lowest.power or 0, lowest.run

    def sizes(x: PlaceOrder) -> list[float]:
        unit = float(x.place.units[step.names.index(x.component)])
        return [e / unit for h, e, _ in x.rows if run is None or run.last <= h <= run.first]

    def may_be(x: PlaceOrder) -> bool:
        if len(x.slopes) >= ENOUGH:
            return x.may_fall_below(power)
        return any(a > b for a, b in zip(sizes(x), sizes(lowest), strict=True))

    return power > 1 and any(map(may_be, loose))
