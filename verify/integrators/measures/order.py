"""How far one step is from the exact flow, component by component, as its step size falls.

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
from verify.integrators.places.wrapped import Periods, unwrapped, wrapped
from verify.integrators.probes.duals import DualProbe
from verify.integrators.probes.floats import FloatProbe
from verify.integrators.user_code.step import StepError, why, within
from verify.integrators.user_code.user_map import UserMap

SPACED = tuple(Fraction(2) ** k for k in range(9))  # parts of a place's largest step
_FINE = tuple(
    2**k for k in (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 18, 22, 26, 30, 34, 38, 42, 46, 50)
)
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
    """The one of "duals", or of "floats"."""
    return DualProbe(step) if how == "duals" else FloatProbe(step)


@dataclass(frozen=True)
class Tail:
    """A lower power, from `h` down, where the error is `error` in units of the place."""

    power: int | None
    h: float
    error: float


@dataclass(frozen=True)
class PlaceOrder:
    """At one place: `power` of h by which the worst component's error falls; None where that has
    not settled, or, `exact`, where none is seen. `slopes`: those that are seen below the last
    step size at which terms cancel."""

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
    moved: float = 0.0  # how far the flow goes with the largest step, in units

    def may_fall_below(self, power: int) -> bool:
        """Whether its slopes, which have not settled, may come to less than that power: not where
        they stay above it, or rise to it. A few do not tell."""
        if len(self.slopes) < ENOUGH:
            return False
        before, last = self.slopes[-2:]
        return self.limit < power - (0.5 if last >= before else 0.2)


@dataclass(frozen=True)
class Distances:
    """Of one step from the exact flow, at places; `periods`: modulo which they were compared."""

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
    """Raises StepError where no exact flow is known, or the step fails, at all of the places."""
    flow = flow_of(hamiltonian, probe)
    chosen = _chosen(places, _PLACES.get(step.degrees, _OTHERWISE))
    parts = tuple(ladder) or LADDERS[probe.how]
    step.periods = _periods(step, probe, flow, hamiltonian, chosen, parts[-1])
    made, lost = list[PlaceOrder](), list[str]()
    for place in chosen:
        try:
            with within(max(step.left, 0.1), "the exact flow takes too long"):
                made.append(_at(step, probe, flow, place, parts))
        except Exception as error:  # the user's code may raise anything
            lost.append(f"{why(error)}{step.place(place.z, place.step)}")
        if step.left <= 0:
            break
    if not made:
        raise StepError(lost[0] if lost else "it has no exact solution from any of the places")
    return Distances(probe.how, tuple(made), step.periods)


def flow_of(hamiltonian: Hamiltonian, probe: Probe) -> Flow:
    """The exact flow, to the digits that a probe asks for."""
    digits = _DIGITS if probe.how == "duals" else probe.step.numbers.digits + _MORE
    return Flow(canonical_field(hamiltonian)[0], digits)


def _chosen(places: Sequence[Place], most: int) -> list[Place]:
    """The user's, those on sides of their own, and others from all amplitudes of each scale."""
    chosen = [x for x in places if x.source in (USER, SIDE)]
    others = [x for x in places if x not in chosen]
    for units in dict.fromkeys(x.units for x in others):
        chosen += spread([x for x in others if x.units == units], most)
    return chosen


def _periods(
    step: UserMap, probe: Probe, flow: Flow, hamiltonian: Hamiltonian,
    places: Sequence[Place], part: Fraction,
) -> Periods:  # fmt: skip
    """By which it reduces its coordinates, as a step of almost no length shows."""
    ends = []
    for place in places:
        try:
            h = place.step / part
            ends.append((probe.end(place, h), goal(flow, probe, place, h)))
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    smallest = min((place.step for place in places), default=Fraction(1)) / part
    return wrapped(ends, hamiltonian, smallest) if ends else ()


def goal(flow: Flow, probe: Probe, place: Place, h: Fraction) -> list[Fraction]:
    """Where the exact flow ends, from the state and over the time that the probe calls with.

    Raises StepError.
    """
    z = place.rounded(probe.rounded).z
    begun = dict(zip(probe.step.names, z, strict=True))
    state = flow.state({**begun, "t": probe.rounded(place.t)})
    try:
        ended = flow.advance(state, flow.number(probe.rounded(h)))
    except NoFlowError as error:
        raise StepError(error.said) from None
    return [flow.arithmetic.exact(x) for x in ended[: len(z)]]


def _at(
    step: UserMap, probe: Probe, flow: Flow, place: Place, parts: Sequence[Fraction]
) -> PlaceOrder:
    """All components at one place."""
    size, begun = len(place.z), place.rounded(probe.rounded).z
    rows: list[list[Row]] = [[] for _ in range(size)]
    below: list[list[bool]] = [[] for _ in range(size)]
    counts, ways, quiet, unseen, lost = list[int](), list[float](), 0, float("inf"), ""
    for part in parts:
        h = place.step / part
        try:
            ended = probe.end(place, h)
            count = len(probe.comparisons)
            exact = goal(flow, probe, place, h)
        except Exception as error:  # a step size may be too large for it
            lost = str(why(error))
            continue
        errors, noise, moved = _row(step, probe, place, h, begun, ended, exact)
        for k in range(size):
            rows[k].append((float(h), abs(errors[k]), noise[k]))
            below[k].append(errors[k] < 0)
        counts.append(count)
        ways.append(moved)
        if moved:
            scaled = zip(errors, noise, place.units, strict=True)
            unseen = min(unseen, max((abs(e) + 10 * n) / float(u) for e, n, u in scaled) / moved)
        still = all(abs(e) <= 10 * n for e, n in zip(errors, noise, strict=True))
        quiet = quiet + 1 if still else 0
        if quiet >= _QUIET or step.left <= 0:
            break
    if len(rows[0]) < _QUIET:
        raise StepError(lost or "it fails for most step sizes")
    judged = _judged(step, place, rows, below, counts, ways, probe.how, unseen)
    return replace(judged, moved=max(ways))


def _row(
    step: UserMap, probe: Probe, place: Place, h: Fraction, begun: Sequence[Fraction],
    ended: Sequence[Fraction], exact: Sequence[Fraction],
) -> tuple[list[float], list[float], float]:  # fmt: skip
    """Errors and noise of the components, and how far the flow goes in units of the place."""
    periods = step.periods or (Fraction(0),) * len(exact)
    here = list(map(unwrapped, ended, exact, periods))
    errors = [float(x - y) for x, y in zip(here, exact, strict=True)]
    ways = [float(abs(y - z)) for y, z in zip(exact, begun, strict=True)]
    units = [float(u) for u in place.units]
    moved = max(way / unit for way, unit in zip(ways, units, strict=True))
    noise = probe.noise(place, ended)
    if isinstance(probe, DualProbe):
        noise = [
            n + _COEFFICIENTS * (way + unit * moved / 8)
            for n, way, unit in zip(noise, ways, units, strict=True)
        ]
    else:
        scatter = probe.scatter(place, place.step / 8)
        noise = [max(pair) for pair in zip(noise, scatter, strict=True)]
    return errors, noise, moved


def _judged(
    step: UserMap, place: Place, rows: list[list[Row]],
    below: list[list[bool]], counts: Sequence[int], ways: Sequence[float], how: str, unseen: float,
) -> PlaceOrder:  # fmt: skip
    """By the component whose error falls most slowly."""
    each = [(k, slopes_of(r)) for k, r in enumerate(rows)]
    seen = [(k, x) for k, x in each if x.seen]
    if not seen:
        return PlaceOrder(place, None, True, unseen=unseen)
    judged = []
    for k, slopes in seen:
        unit = float(place.units[k])
        power, run, tail = _settled(slopes, rows[k], counts, ways, how, unit)
        shown = clear_slopes(rows[k], below[k], _OF_MANY if how == "duals" else ABOVE)
        judged.append(
            PlaceOrder(place, power, False, step.names[k], run, tail,
                       tuple(x for _, x in shown), tuple(rows[k]), unseen, limit_of(shown))
        )  # fmt: skip
    settled = [x for x in judged if x.power is not None]
    loose = [x for x in judged if x.power is None]
    if settled:
        lowest = min(settled, key=lambda x: x.power or 0)
        # What has not settled may be lower, unless it is small beside what has.
        return lowest if not _hides(step, loose, lowest) else loose[0]
    return max(loose, key=lambda x: len(x.slopes))


def _hides(step: UserMap, loose: Sequence[PlaceOrder], lowest: PlaceOrder) -> bool:
    """Whether a component that has not settled may be of a lower power.

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


def _settled(
    slopes: Slopes, rows: Sequence[Row], counts: Sequence[int],
    ways: Sequence[float], how: str, unit: float,
) -> tuple[int | None, Run | None, Tail | None]:  # fmt: skip
    """The power that holds, its stretch, and what a loop leaves below it.

    Where the number of comparisons changes with h, a loop ends at a tolerance: a lower power below
    is then what it leaves, unless it goes on through such changes as no tolerance does, or is a
    part of the way itself, as of a wrong constant.
    """
    if not slopes.runs:
        return None, None, None
    chosen, tail = slopes.runs[0], None
    begin = next(k for k, row in enumerate(rows) if row[0] == chosen.first)
    if begin and counts[begin] < counts[begin - 1] and rows[begin][1] > rows[begin - 1][1]:
        # A loop does one turn less: what it leaves is all that has settled.
        return None, None, Tail(chosen.power, chosen.first, rows[begin][1] / unit)
    iterates = len(set(counts)) > 1
    for run in slopes.runs[1:]:
        if run.power > chosen.power and tail is None:
            chosen = run  # what is seen of larger steps has not settled
            continue
        if run.power >= chosen.power:
            continue
        at = [k for k, row in enumerate(rows) if run.last <= row[0] <= run.first]
        error = rows[at[0]][1] / unit
        if how == "duals" and rows[at[0]][1] <= _OF_MANY * rows[at[0]][2]:
            break
        if how == "duals":
            real = not iterates or len({counts[k] for k in at}) > 1
        else:
            least, most = (x * ways[at[0]] for x in _FEW_DIGITS)
            constant = run.power == 1 and least < error < most  # a loop has gone round once
            real = run.count >= _FEWEST_IN_TAIL and (error > _TOLERANCE or constant)
        if real:
            chosen, tail = run, None
        else:
            tail = tail or Tail(run.power, rows[at[0]][0], error)
    if slopes.unsettled and chosen is slopes.runs[-1]:
        if on_their_way(slopes.unsettled, chosen.power):
            return None, None, None
        end = next(k for k, row in enumerate(rows) if row[0] == chosen.last)
        after = rows[min(end + 1, len(rows) - 1)]
        error = after[1] / unit
        if how == "duals" and after[1] <= _OF_MANY * after[2]:
            return chosen.power, chosen, tail
        if (how == "duals" and not iterates) or (how == "floats" and error > _TOLERANCE):
            return None, None, None
        tail = tail or Tail(None, rows[end][0], error)
    return chosen.power, chosen, tail
