"""The distance of one step from the exact flow, component by component, as its step size falls.

The order is that of the worst component at the worst place, where its slope has settled. An error
is counted where it is beyond the noise of the numbers that the code computes in.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.flows.extrapolation import Flow, NoFlowError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.slopes import (
    ABOVE,
    ENOUGH,
    Row,
    Run,
    Slopes,
    clear_slopes,
    limit_of,
    on_their_way,
    slopes_of,
)
from verify.integrators.places.place import SIDE, USER, Place, spread
from verify.integrators.places.wrapped import Periods, find_wrapped_periods, unwrap
from verify.integrators.probes.duals import DualProbe
from verify.integrators.probes.floats import FloatProbe
from verify.integrators.user_code.step import StepError, limit_time, why
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
_DIGITS, _MORE = 50, 4  # of the exact flow for dual numbers; and more than a step's own have
_COEFFICIENTS = 2.0**-52  # of a step's length: what a rounded coefficient does to it
_OF_MANY = 2.0**9  # times that, what many of them may do
_PLACES = {1: 7}  # at which it is looked
_OTHERWISE = 4
_FEWEST_IN_TAIL = 5  # slopes of a lower power that floats alone show
_TOLERANCE = 1e-7  # in units: below it such a power may be what the tolerance of a loop leaves
_FEW_DIGITS = 5e-8, 0.5  # of a step's length: beyond eight digits, and no standstill
_QUIET = 3  # step sizes in the noise, after which none is looked at
Probe = DualProbe | FloatProbe


def probe_of(step: UserMap, how: str) -> Probe:
    """Build the probe called "duals", or else the one called "floats"."""
    return DualProbe(step) if how == "duals" else FloatProbe(step)


@dataclass(frozen=True)
class Tail:
    """A lower power, from `h` down, where the error is `error` in units of the place."""

    power: int | None
    h: float
    error: float


@dataclass(frozen=True)
class PlaceOrder:
    """The order at one place: `power` of h by which the worst component's error falls; None where
    that has not settled, or, `exact`, where none is seen. `slopes`: those that are seen below the
    last step size at which terms cancel."""

    place: Place
    power: int | None
    exact: bool
    component: str = ""
    run: Run | None = None
    tail: Tail | None = None
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
    places: Sequence[Place],
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
            problems.append(f"{why(error)}{step.place(place.z, place.step)}")
        if step.left <= 0:
            break
    if not orders:
        raise StepError(
            problems[0] if problems else "it has no exact solution from any of the places"
        )
    return Distances(probe.how, tuple(orders), step.periods)


def flow_of(hamiltonian: Hamiltonian, probe: Probe) -> Flow:
    """Build the exact flow, to as many digits as a probe needs."""
    digits = _DIGITS if probe.how == "duals" else probe.step.numbers.digits + _MORE
    return Flow(canonical_field(hamiltonian)[0], digits)


def _select_places(places: Sequence[Place], count: int) -> list[Place]:
    """Select the user's places, those on other sides of comparisons, and some of all amplitudes of
    each scale."""
    selected = [x for x in places if x.source in (USER, SIDE)]
    rest = [x for x in places if x not in selected]
    for units in dict.fromkeys(x.units for x in rest):
        selected += spread([x for x in rest if x.units == units], count)
    return selected


def _periods(
    step: UserMap, probe: Probe, flow: Flow, hamiltonian: Hamiltonian,
    places: Sequence[Place], part: Fraction,
) -> Periods:  # fmt: skip
    """Find by which periods the step reduces its coordinates, by a step of almost no length."""
    ends = []
    for place in places:
        try:
            h = place.step / part
            ends.append((probe.end(place, h), goal(flow, probe, place, h)))
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    smallest = min((place.step for place in places), default=Fraction(1)) / part
    return find_wrapped_periods(ends, hamiltonian, smallest) if ends else ()


def goal(flow: Flow, probe: Probe, place: Place, h: Fraction) -> list[Fraction]:
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
    step: UserMap, probe: Probe, flow: Flow, place: Place, parts: Sequence[Fraction]
) -> PlaceOrder:
    """Measure all components at one place."""
    size, start = len(place.z), place.with_rounded_state(probe.round_number).z
    rows: list[list[Row]] = [[] for _ in range(size)]
    below: list[list[bool]] = [[] for _ in range(size)]
    counts, ways, quiet, unseen, lost = list[int](), list[float](), 0, float("inf"), ""
    for part in parts:
        h = place.step / part
        try:
            end = probe.end(place, h)
            count = len(probe.comparisons)
            exact = goal(flow, probe, place, h)
        except Exception as error:  # a step size may be too large for it
            lost = str(why(error))
            continue
        errors, noise, distance = _row(step, probe, place, h, start, end, exact)
        for k in range(size):
            rows[k].append((float(h), abs(errors[k]), noise[k]))
            below[k].append(errors[k] < 0)
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
    place_order = _select_slowest(step, place, rows, below, counts, ways, probe.how, unseen)
    return replace(place_order, distance=max(ways))


def _row(
    step: UserMap, probe: Probe, place: Place, h: Fraction, start: Sequence[Fraction],
    end: Sequence[Fraction], exact: Sequence[Fraction],
) -> tuple[list[float], list[float], float]:  # fmt: skip
    """Return errors and noise of the components, and how far the flow goes in units of the
    place."""
    periods = step.periods or (Fraction(0),) * len(exact)
    unwrapped_end = list(map(unwrap, end, exact, periods))
    errors = [float(x - y) for x, y in zip(unwrapped_end, exact, strict=True)]
    ways = [float(abs(y - z)) for y, z in zip(exact, start, strict=True)]
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
    step: UserMap, place: Place, rows: list[list[Row]],
    below: list[list[bool]], counts: Sequence[int], ways: Sequence[float], how: str, unseen: float,
) -> PlaceOrder:  # fmt: skip
    """Select the component whose error falls most slowly."""
    by_component = [(k, slopes_of(r)) for k, r in enumerate(rows)]
    resolved = [(k, x) for k, x in by_component if x.seen]
    if not resolved:
        return PlaceOrder(place, None, True, unseen=unseen)
    candidates = []
    for k, slopes in resolved:
        unit = float(place.units[k])
        power, run, tail = _settle_power(slopes, rows[k], counts, ways, how, unit)
        clear = clear_slopes(rows[k], below[k], _OF_MANY if how == "duals" else ABOVE)
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


def _settle_power(
    slopes: Slopes, rows: Sequence[Row], counts: Sequence[int],
    ways: Sequence[float], how: str, unit: float,
) -> tuple[int | None, Run | None, Tail | None]:  # fmt: skip
    """Return the power that holds, its stretch, and what a loop leaves below it.

    Where the number of comparisons changes with h, a loop ends at a tolerance: a lower power below
    is then what it leaves, unless it goes on through such changes as no tolerance does, or is a
    part of the way itself, as of a wrong constant.
    """
    if not slopes.runs:
        return None, None, None
    best_run, tail = slopes.runs[0], None
    begin = next(k for k, row in enumerate(rows) if row[0] == best_run.first)
    if begin and counts[begin] < counts[begin - 1] and rows[begin][1] > rows[begin - 1][1]:
        # A loop does one turn less: what it leaves is all that has settled.
        return None, None, Tail(best_run.power, best_run.first, rows[begin][1] / unit)
    iterates = len(set(counts)) > 1
    for run in slopes.runs[1:]:
        if run.power > best_run.power and tail is None:
            best_run = run  # what is seen of larger steps has not settled
            continue
        if run.power >= best_run.power:
            continue
        indices = [k for k, row in enumerate(rows) if run.last <= row[0] <= run.first]
        error = rows[indices[0]][1] / unit
        if how == "duals" and rows[indices[0]][1] <= _OF_MANY * rows[indices[0]][2]:
            break
        if how == "duals":
            real = not iterates or len({counts[k] for k in indices}) > 1
        else:
            smallest, largest = (x * ways[indices[0]] for x in _FEW_DIGITS)
            constant = run.power == 1 and smallest < error < largest  # a loop has gone round once
            real = run.count >= _FEWEST_IN_TAIL and (error > _TOLERANCE or constant)
        if real:
            best_run, tail = run, None
        else:
            tail = tail or Tail(run.power, rows[indices[0]][0], error)
    if slopes.unsettled and best_run is slopes.runs[-1]:
        # Slopes that still rise towards another power are no tail that a loop leaves: nothing has
        # settled.
        if on_their_way(slopes.unsettled, best_run.power):
            return None, None, None
        end = next(k for k, row in enumerate(rows) if row[0] == best_run.last)
        next_row = rows[min(end + 1, len(rows) - 1)]
        error = next_row[1] / unit
        if how == "duals" and next_row[1] <= _OF_MANY * next_row[2]:
            return best_run.power, best_run, tail
        if (how == "duals" and not iterates) or (how == "floats" and error > _TOLERANCE):
            return None, None, None
        tail = tail or Tail(None, rows[end][0], error)
    return best_run.power, best_run, tail
