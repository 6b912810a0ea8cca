"""The distance of one step from the exact flow, component by component, as the step size falls.

At each place, the power of h is that of the component whose distance falls most slowly, if its
slope settles. A distance counts only if it exceeds the noise of the numbers in which the code
computes.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians.canonical_field import field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.error_powers import (
    CLEAR_FACTOR,
    ENOUGH_SLOPES,
    MANY_COEFFICIENTS_FACTOR,
    ErrorTail,
    PowerStretch,
    Row,
    clear_slopes,
    estimate_limit,
    find_stretches,
    settle_power,
)
from verify.integrators.measures.probes import COEFFICIENT_ROUNDING, DualProbe, Probe
from verify.integrators.places.trial_places import SIDE, USER, TrialPlace, select_spread
from verify.integrators.places.wrap_periods import Periods, find_wrapped_periods, unwrap
from verify.integrators.user_code.step import StepError, describe_error, limit_time
from verify.integrators.user_code.user_map import UserMap

# A place's largest step size is divided by each of these to follow the defect S.
STEP_DIVISORS = tuple(Fraction(2) ** k for k in range(9))
# The divisors of the step size for distances. Dual numbers have 200 bits, so that steps may be as
# small as 2⁻⁵⁰ of the largest; the first ones are closer to one another, since most slopes settle
# there.
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
_FLOW_DIGITS_FOR_DUALS = 50  # decimal digits of the exact flow
_MORE_FLOW_DIGITS = 4  # for floats: beyond the digits of the step's own numbers
_MAX_PLACES = {1: 7}  # for each scale of H, by the degrees of freedom
_MAX_PLACES_OTHERWISE = 4
_MAX_QUIET_STEPS = 3  # after this number of step sizes in the noise no smaller ones are tried
_NOISE_FACTOR = 10  # an error shows if it exceeds its noise by this factor


@dataclass(frozen=True)
class PlaceOrder:
    """The order at one place.

    `power`: that of h by which the error of the worst component falls; None if it has not settled,
    or if no error is seen (`exact`). `run`: the stretch of step sizes on which it is seen; `tail`:
    the error that a loop leaves below it. `slopes`: those below the last step size at which terms
    cancel; `limit`: the power to which they tend. `rows`: of the component, as measured. `unseen`:
    the size below which an error of a step does not show, relative to the distance that the flow
    moves. `distance`: the distance that it moves with the largest step, in units of the place.
    """

    place: TrialPlace
    power: int | None
    exact: bool
    component: str = ""
    run: PowerStretch | None = None
    tail: ErrorTail | None = None
    slopes: tuple[float, ...] = ()
    rows: tuple[Row, ...] = ()
    unseen: float = 0.0
    limit: float = 0.0
    distance: float = 0.0

    def may_fall_below(self, power: int) -> bool:
        """Return True if its unsettled slopes may tend to less than that power, as they neither
        stay above it nor rise to it; too few slopes tell nothing."""
        if len(self.slopes) < ENOUGH_SLOPES:
            return False
        before, last = self.slopes[-2:]
        # Slopes that still rise may settle higher than the estimated limit.
        return self.limit < power - (0.5 if last >= before else 0.2)


@dataclass(frozen=True)
class Distances:
    """Distances of one step from the exact flow, modulo `periods` of the coordinates."""

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
    """Measure the distances; `ladder`: divisors of the step size in place of the usual ones. Raises
    StepError if at every place the exact flow cannot be computed, or the step fails."""
    flow = flow_of(hamiltonian, probe)
    selected = _select_places(places, _MAX_PLACES.get(step.degrees, _MAX_PLACES_OTHERWISE))
    divisors = tuple(ladder) or LADDERS[probe.how]
    step.periods = find_periods(step, probe, flow, hamiltonian, selected, divisors[-1])
    orders, problems = list[PlaceOrder](), list[str]()
    for place in selected:
        try:
            # The exact flow is computed within the user's time limit: near a singularity it might
            # not end.
            with limit_time(max(step.seconds_left, 0.1), "the exact flow takes too long"):
                orders.append(_measure_at(step, probe, flow, place, divisors))
        except Exception as error:  # the user's code may raise anything
            problems.append(f"{describe_error(error)}{step.describe_call(place.z, place.step)}")
        if step.seconds_left <= 0:
            break
    if not orders:
        raise StepError(
            problems[0] if problems else "it has no exact solution from any of the places"
        )
    return Distances(probe.how, tuple(orders), step.periods)


def flow_of(hamiltonian: Hamiltonian, probe: Probe) -> NumericalFlow:
    """Build the exact flow, with as many digits as the probe needs."""
    digits = (
        _FLOW_DIGITS_FOR_DUALS
        if probe.how == "duals"
        else probe.step.numbers.digits + _MORE_FLOW_DIGITS
    )
    return NumericalFlow(field_of(hamiltonian)[0], digits)


def _select_places(places: Sequence[TrialPlace], count: int) -> list[TrialPlace]:
    """Select the user's places, those on other sides of comparisons, and some of all amplitudes of
    each scale."""
    selected = [x for x in places if x.source in (USER, SIDE)]
    unselected = [x for x in places if x not in selected]
    for units in dict.fromkeys(x.units for x in unselected):
        selected += select_spread([x for x in unselected if x.units == units], count)
    return selected


def find_periods(
    step: UserMap, probe: Probe, flow: NumericalFlow, hamiltonian: Hamiltonian,
    places: Sequence[TrialPlace], divisor: Fraction,
) -> Periods:  # fmt: skip
    """Find the periods by which a step of the smallest size, which hardly moves, reduces z."""
    ends = []
    for place in places:
        try:
            h = place.step / divisor
            ends.append((probe.end(place, h), end_of_flow(flow, probe, place, h)))
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    smallest = min((place.step for place in places), default=Fraction(1)) / divisor
    of_energy = hamiltonian.energy is not None  # periods of equations are not looked for
    return find_wrapped_periods(ends, hamiltonian, smallest) if ends and of_energy else ()


def end_of_flow(
    flow: NumericalFlow, probe: Probe, place: TrialPlace, h: Fraction
) -> list[Fraction]:
    """Return the end of the exact flow, from the state and over the time that the probe uses;
    raises StepError if the flow has no end."""
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
    step: UserMap, probe: Probe, flow: NumericalFlow, place: TrialPlace,
    divisors: Sequence[Fraction],
) -> PlaceOrder:  # fmt: skip
    """Measure all components at one place."""
    size, start = len(place.z), place.with_rounded_state(probe.round_number).z
    rows: list[list[Row]] = [[] for _ in range(size)]
    negative: list[list[bool]] = [[] for _ in range(size)]
    counts, distances_moved = list[int](), list[float]()
    quiet_steps, unseen, last_problem = 0, float("inf"), ""
    for divisor in divisors:
        h = place.step / divisor
        try:
            end = probe.end(place, h)
            count = len(probe.comparisons)
            flow_end = end_of_flow(flow, probe, place, h)
        except Exception as error:  # the user's code may raise anything, as at too large a step
            last_problem = str(describe_error(error))
            continue
        errors, noise, distance = _errors_and_noise(step, probe, place, h, start, end, flow_end)
        for k in range(size):
            rows[k].append((float(h), abs(errors[k]), noise[k]))
            negative[k].append(errors[k] < 0)
        counts.append(count)
        distances_moved.append(distance)
        if distance:
            scaled = zip(errors, noise, place.units, strict=True)
            # A smaller error, relative to the distance moved, would not show at any step size.
            hidden = max((abs(e) + _NOISE_FACTOR * n) / float(u) for e, n, u in scaled)
            unseen = min(unseen, hidden / distance)
        # Once the errors of all components are in their noise at several step sizes, smaller ones
        # show nothing more.
        is_quiet = all(abs(e) <= _NOISE_FACTOR * n for e, n in zip(errors, noise, strict=True))
        quiet_steps = quiet_steps + 1 if is_quiet else 0
        if quiet_steps >= _MAX_QUIET_STEPS or step.seconds_left <= 0:
            break
    if len(rows[0]) < _MAX_QUIET_STEPS:
        raise StepError(last_problem or "it fails for most step sizes")
    slowest = _select_slowest(
        step, place, rows, negative, counts, distances_moved, probe.how, unseen
    )
    return replace(slowest, distance=max(distances_moved))


def _errors_and_noise(
    step: UserMap, probe: Probe, place: TrialPlace, h: Fraction, start: Sequence[Fraction],
    end: Sequence[Fraction], flow_end: Sequence[Fraction],
) -> tuple[list[float], list[float], float]:  # fmt: skip
    """Return the errors and the noise of the components, and the distance that the flow moves, in
    units of the place."""
    periods = step.periods or (Fraction(0),) * len(flow_end)
    unwrapped_end = list(map(unwrap, end, flow_end, periods))
    errors = [float(x - y) for x, y in zip(unwrapped_end, flow_end, strict=True)]
    distances_moved = [float(abs(y - z)) for y, z in zip(flow_end, start, strict=True)]
    units = [float(u) for u in place.units]
    distance = max(moved / unit for moved, unit in zip(distances_moved, units, strict=True))
    noise = probe.noise(place, end)
    if isinstance(probe, DualProbe):
        noise = [
            # With 200 bits, only the coefficients are rounded, since users write them as doubles:
            # each of them changes the end by such a part of the distance moved.
            n + COEFFICIENT_ROUNDING * (moved + unit * distance / 8)
            for n, moved, unit in zip(noise, distances_moved, units, strict=True)
        ]
    else:
        scatter = probe.scatter(place, place.step / 8)
        noise = [max(pair) for pair in zip(noise, scatter, strict=True)]
    return errors, noise, distance


def _select_slowest(
    step: UserMap, place: TrialPlace, rows: list[list[Row]],
    negative: list[list[bool]], counts: Sequence[int], distances_moved: Sequence[float], how: str,
    unseen: float,
) -> PlaceOrder:  # fmt: skip
    """Select the component whose error falls most slowly."""
    by_component = [(k, find_stretches(r)) for k, r in enumerate(rows)]
    resolved = [(k, x) for k, x in by_component if x.is_seen]
    if not resolved:
        return PlaceOrder(place, None, True, unseen=unseen)
    candidates = []
    for k, slopes in resolved:
        unit = float(place.units[k])
        power, run, tail = settle_power(slopes, rows[k], counts, distances_moved, how, unit)
        clear = clear_slopes(
            rows[k], negative[k], MANY_COEFFICIENTS_FACTOR if how == "duals" else CLEAR_FACTOR
        )
        candidates.append(
            PlaceOrder(place, power, False, step.names[k], run, tail,
                       tuple(x for _, x in clear), tuple(rows[k]), unseen, estimate_limit(clear))
        )  # fmt: skip
    settled = [x for x in candidates if x.power is not None]
    loose = [x for x in candidates if x.power is None]
    if settled:
        lowest = min(settled, key=lambda x: x.power or 0)
        # A component that has not settled may have a lower power, unless its error is smaller.
        return lowest if not _hides(step, loose, lowest) else loose[0]
    return max(loose, key=lambda x: len(x.slopes))


def _hides(step: UserMap, loose: Sequence[PlaceOrder], lowest: PlaceOrder) -> bool:
    """Return True if a component that has not settled may have a lower power; one with few slopes
    does not if its errors are smaller on the stretch of the settled one."""
    power, run = lowest.power or 0, lowest.run

    def sizes(x: PlaceOrder) -> list[float]:
        unit = float(x.place.units[step.names.index(x.component)])
        return [e / unit for h, e, _ in x.rows if run is None or run.last <= h <= run.first]

    def may_be(x: PlaceOrder) -> bool:
        if len(x.slopes) >= ENOUGH_SLOPES:
            return x.may_fall_below(power)
        return any(a > b for a, b in zip(sizes(x), sizes(lowest), strict=True))

    return power > 1 and any(map(may_be, loose))
