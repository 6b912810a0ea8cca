"""Mistakes in the times at which a step reads an H that depends on t, its clock.

- It stands still: the step reads H at a single time s in all stages. It is then a scheme for the
  autonomous H(p, q, s), of an order that it does not have for H(p, q, t).
- Stages read H at wrong times: with the times that are due, the step has a higher order.
- H is read too early or too late in the mean, so that the order is 1.

The trace of a step proves the first two. A measured step is compared with the exact flow of
H(p, q, s) instead of H(p, q, t), another autonomous H for every step size.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.algebra.ring import Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import PlainField
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.distances import LADDERS, end_of_flow, flow_of
from verify.integrators.measures.error_powers import Row, find_stretches
from verify.integrators.measures.probes import Probe
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.tracing.readings import NoReadingsError, Read, Readings
from verify.integrators.tracing.trace import Node, in_order, write_expressions
from verify.integrators.tracing.traced_map import traced_map
from verify.integrators.tracing.traced_number import UntraceableError
from verify.proof.order_for_one_h import convergence_of, size_of
from verify.schemes.conditions.scheme_clocks import ClockReading, mistake_of_clock
from verify.schemes.maps.formula_map import map_from_expressions
from verify.schemes.steps.step_algebra import State

_MAX_OPERATIONS = 3000  # of p' and q' written out as trees
# The times at which a clock may stand still: each is t plus this multiple of h.
MOMENTS = {"t": Fraction(0), "t + h": Fraction(1), "t + h/2": Fraction(1, 2)}
_STILL_TIME = symbol("still")
_MAX_NODES = 2000  # of a trace
_TIME_TOLERANCE = Fraction(
    1, 2**40
)  # times are sums in floats: nearer ones are equal; in units of h
_MAX_TIMES_LISTED = 4
_ROUNDING_SHARE = Fraction(1, 2**44)  # a residual below this part of its coefficients is rounding
_MAX_SHOWN_DENOMINATOR = 1000
# The following are for measured steps.
_PLACES_FOR_ORDER, _PLACES_FOR_MEAN = 2, 5
# A part of the ladder of step sizes suffices, since each of them needs a flow of its own.
_LADDER_PARTS = {"duals": slice(4, 12), "floats": slice(3, 17)}
_MEAN_STEP_SIZES = {"duals": Fraction(1, 2**20), "floats": Fraction(1, 2**9)}
# Mean times agree if they differ by less, in units of h.
_MEAN_TOLERANCES = {"duals": Fraction(1, 10**6), "floats": Fraction(1, 200)}
_MAX_MEAN_DENOMINATOR = 12  # a mean within the tolerance of such a fraction is shown as it
_MIN_MEANS = 2
# H_qt or H_pt shows a mean time if its size exceeds the first number; below the second it is 0.
_MIN_SLOPE, _ZERO_SLOPE = 0.01, 1e-6


def format_time(time: Fraction) -> str:
    """Format the time t + `time`·h.

    >>> [format_time(Fraction(x)) for x in ("0", "1", "-1/2", "3/4", "0.3512071919596578")]
    ['t', 't + h', 't - h/2', 't + 3h/4', 't + 0.35120719h']
    """
    simple = time.limit_denominator(_MAX_SHOWN_DENOMINATOR)
    if simple == 0:
        return "t"
    sign, size = ("-", -simple) if time < 0 else ("+", simple)
    if abs(simple - time) >= _TIME_TOLERANCE:
        return f"t {sign} {abs(float(time)):.8g}h"
    factor = "" if size.numerator == 1 else str(size.numerator)
    return f"t {sign} {factor}h" + (f"/{size.denominator}" if size.denominator > 1 else "")


def describe_still_clock(reached: str, words: str) -> str:
    """Describe a clock that stands still at the time `words`; the step is then `reached`."""
    reading = f"as if the force were read at {words} in every stage"
    return f"it is {reached} {reading}: its clock stands still"


# -- of a traced step -----------------------------------------------------------------------------


def clock_mistakes(hamiltonian: Hamiltonian, roots: Sequence[Node], order: int | None) -> list[str]:
    """Return one sentence if the traced step, by its nodes of p' and q', has a higher order than
    `order` with the force held still, or with H read at the times that are due."""
    if order is None or not hamiltonian.time_dependent or "still" in hamiltonian.parameters:
        return []
    p_next, q_next = roots
    still = _find_still_clock(hamiltonian, p_next, q_next, order)
    return still or find_misreadings(hamiltonian, p_next, q_next, order)


def _find_still_clock(
    hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int
) -> list[str]:
    t, h = symbol("t"), symbol("h")
    # t + part·h becomes the constant `still`, a parameter of an autonomous H; the order of the step
    # is then taken for this H.
    still_hamiltonian = Hamiltonian(hamiltonian.exact.subs(t, _STILL_TIME))
    for words, part in MOMENTS.items():
        clock = {"t": _STILL_TIME - part * h}
        formulas = write_expressions((p_next, q_next), _MAX_OPERATIONS, clock)
        if formulas is None:
            return []
        try:
            step = map_from_expressions(still_hamiltonian, formulas)
            still_order = convergence_of(step).order
        except InputError:  # too long, or not smooth
            continue
        if still_order is None or still_order > order:
            reached = "exact" if still_order is None else f"of order {still_order}"
            return [describe_still_clock(reached, words)]
    return []


# -- readings at wrong times, of a traced step ----------------------------------------------------


def find_misreadings(hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int) -> list[str]:
    """Return one sentence if the step is proved to have a higher order than `order` with each
    reading at the time that is due."""
    if len(in_order(p_next, q_next)) > _MAX_NODES:
        return []
    try:
        readings = Readings(hamiltonian, p_next, q_next)
        reads = _merge_reads(readings.reads)
        wrong_reads = [read for read in reads if abs(read.time - read.due) >= _TIME_TOLERANCE]
        right_times = readings.with_due_times() if wrong_reads else None
        due_order = _order_in_time(hamiltonian, *right_times) if right_times else order
    except (ArithmeticError, ValueError, NoReadingsError, UntraceableError, InputError):
        return []
    if due_order is not None and due_order <= order:
        return []
    reached = "exact" if due_order is None else f"of order {due_order}"
    pairs = list(dict.fromkeys((read.due, read.time) for read in wrong_reads))
    listed = pairs[:_MAX_TIMES_LISTED]
    times = ", ".join(f"{format_time(due)} in place of {format_time(time)}" for due, time in listed)
    ellipsis = ", …" * (len(pairs) > _MAX_TIMES_LISTED)
    name = _name_mistake(reads)
    return [f"{name}: " * bool(name) + f"it is {reached} with H read at {times}{ellipsis}"]


def _order_in_time(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> int | None:
    """Return the order of the map apart from the rounding of its coefficients; None if it is the
    exact flow."""
    traced = traced_map(hamiltonian, (p_next, q_next))
    order = convergence_of(traced.step_map).order
    if order is None or traced.series is None:
        return order
    rounded = _rounded_order(*traced.series)
    return order if rounded is None else max(order, rounded)


def _rounded_order(field: PlainField, step: State) -> int | None:
    """Return the power of h up to which the map agrees with the flow; None if all terms agree.

    Residuals below 2⁻⁴⁴ of the coefficients count as 0, as they come from rounded numbers:
    Yoshida's 1.3512071919596578 is not 1/(2 − 2^(1/3)): taken by its exact value it gives a map of
    order 0, whose first Taylor coefficients miss those of the flow by 10⁻¹⁶. Such residuals are
    distinguished from errors by their size beside the coefficients that they belong to.
    """
    scale = Fraction(0)
    for n in range(step[0].most + 1):
        gap = Fraction(0)
        for series, y in zip(step, field.term(n), strict=True):
            x = series.coefficients[n]
            gap = max(gap, size_of(field.ring.reduce(x - y)))
            scale = max(scale, size_of(x), size_of(y))
        if gap > _ROUNDING_SHARE * scale:
            return n - 1
    return None


def _merge_reads(reads: Sequence[Read]) -> list[Read]:
    """Merge readings of the same times into one, at the place of the first."""
    sizes: dict[tuple[Fraction, Fraction, bool], Fraction] = {}
    for read in reads:
        key = read.time, read.due, read.of_p
        sizes[key] = sizes.get(key, Fraction(0)) + read.size
    return [Read(time, due, size, of_p) for (time, due, of_p), size in sizes.items()]


def _name_mistake(reads: Sequence[Read]) -> str | None:
    """Return the name of the mistake in the times read for p', or for q'; None if it has none."""
    ring = Ring((), 0)
    for of_p, kind in ((True, "force"), (False, "velocity")):
        part = [read for read in reads if read.of_p is of_p and read.size]
        sums = [sum((x.size for x in part[:k]), Fraction(0)) for k in range(len(part))]
        columns = [x.time for x in part], [x.due for x in part], sums, [x.size for x in part]
        numbers = [[ring.constant(x) for x in column] for column in columns]
        reading = ClockReading(ring, kind, "stage", *numbers)
        mistake = mistake_of_clock(reading, _TIME_TOLERANCE) if part else None
        if mistake:
            return mistake
    return None


# -- of a measured step ---------------------------------------------------------------------------


def measure_clock_mistakes(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[TrialPlace], order: int | None
) -> list[str]:
    """Return one sentence if the step is measured to have a higher order than `order` with the
    force held still, or to read H too early or too late in the mean. Raises what its code raises.
    """
    if order is None or order < 1 or not probe.step.time_dependent:
        return []
    for words, part in MOMENTS.items():
        higher = _measure_order(probe, hamiltonian, places, part, order)
        if higher is not None:
            return [describe_still_clock(f"of order {higher}", words)]
    return _note_mean(probe, hamiltonian, places[:_PLACES_FOR_MEAN]) if order == 1 else []


def _measure_order(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[TrialPlace], part: Fraction,
    beyond: int,
) -> int | None:  # fmt: skip
    """Return the order of the distance from the flow of H at t + part·h; None if it is not above
    `beyond`, or not the same at two places: a term of lower order may be small at one."""
    orders = (_order_at(probe, hamiltonian, x, part) for x in places[:_PLACES_FOR_ORDER])
    order = next(orders)
    if order is None or order <= beyond or any(x != order for x in orders):
        return None
    return order


def _order_at(
    probe: Probe, hamiltonian: Hamiltonian, place: TrialPlace, part: Fraction
) -> int | None:
    rows: list[Row] = []
    for size in LADDERS[probe.how][_LADDER_PARTS[probe.how]]:
        h = place.step / size
        still_hamiltonian = Hamiltonian(hamiltonian.exact.subs(symbol("t"), place.t + part * h))
        flow = flow_of(still_hamiltonian, probe)
        end = probe.end(place, h)
        gaps = [abs(x - y) for x, y in zip(end, end_of_flow(flow, probe, place, h), strict=True)]
        noise = max(probe.noise(place, end))
        rows.append((float(h), float(max(gaps)), 4 * noise))
    runs = find_stretches(rows).runs
    return runs[-1].power - 1 if runs else None


# -- the mean of the times that are read, of a measured step --------------------------------------


def _note_mean(probe: Probe, hamiltonian: Hamiltonian, places: Sequence[TrialPlace]) -> list[str]:
    """Return one sentence on the mean time at which H is read, if it explains the order 1.

    A step that reads H(p, q, t) at t + c_i h with the weights b_i, and is right otherwise, has
    p' − p(t + h) = −(Σ b_i c_i − 1/2) H_qt h² + O(h³), and correspondingly q' with H_pt. If the
    value of Σ b_i c_i that follows is the same at every place, it is the mean time; if the step has
    another mistake, it is not the same.
    """
    means = [x for place in places for x in _mean_times(probe, hamiltonian, place)]
    bound = _MEAN_TOLERANCES[probe.how]
    if len(means) < _MIN_MEANS or max(means) - min(means) > bound:
        return []
    if abs(means[0] - Fraction(1, 2)) < bound:
        return []
    mean = sum(means, Fraction(0)) / len(means)
    simple_mean = mean.limit_denominator(_MAX_MEAN_DENOMINATOR)
    is_simple = abs(simple_mean - mean) <= bound
    time = format_time(simple_mean) if is_simple else f"about t {float(mean):+.3f} h"
    return [f"H is read at {time} in the mean: it can be of order 2 where that is t + h/2"]


def _mean_times(probe: Probe, hamiltonian: Hamiltonian, place: TrialPlace) -> Iterator[Fraction]:
    """Yield the mean times that p' and q' show, if the derivative of H is large enough."""
    h = _MEAN_STEP_SIZES[probe.how] * place.step
    gaps = [_errors(probe, hamiltonian, place, x) for x in (h, h / 2)]
    point = dict(zip("pqt", (*place.z, place.t), strict=True))
    values = {symbol(name): sympy.Rational(x.numerator, x.denominator) for name, x in point.items()}
    for k, (coordinate, sign) in enumerate((("q", -1), ("p", 1))):
        slope = sign * hamiltonian.exact.diff(symbol(coordinate), symbol("t")).subs(values)
        size = Fraction(float(slope))
        coarse, fine = gaps[0][k] / h**2, gaps[1][k] / (h / 2) ** 2
        if abs(size) > _MIN_SLOPE:
            # Richardson's extrapolation, 2 g(h/2) − g(h), removes the term of order h.
            yield Fraction(1, 2) + (2 * fine - coarse) / size
        elif abs(size) < _ZERO_SLOPE and abs(2 * fine - coarse) > _MIN_SLOPE:
            # H_qt or H_pt is 0: the error does not come from the times, and two different means say
            # so.
            yield from (Fraction(0), Fraction(1))


def _errors(
    probe: Probe, hamiltonian: Hamiltonian, place: TrialPlace, h: Fraction
) -> list[Fraction]:
    """Return p' and q' minus those of the flow."""
    flow = flow_of(hamiltonian, probe)
    ends = zip(probe.end(place, h), end_of_flow(flow, probe, place, h), strict=True)
    return [x - y for x, y in ends]
