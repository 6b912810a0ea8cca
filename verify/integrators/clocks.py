"""The mistake that the clock of a step looks like: of a traced step, or of a measured one.

With t held still at a moment s of the step, H(p, q, s) is autonomous. A step that reads its force
at one moment is a scheme for that H of an order that it may not have for the motion in time. A
trace tells that by proof; of a measured step the distance is taken from the exact flow of
H(p, q, s), instead of that of H(p, q, t): of another autonomous H for every step size.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.algebra.ring import Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.distances import LADDERS, end_of_flow, flow_of
from verify.integrators.measures.error_powers import Row, slopes_of
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

_MOST_WRITTEN = 3000  # operations of p' and q' as trees
MOMENTS = {"t": Fraction(0), "t + h": Fraction(1), "t + h/2": Fraction(1, 2)}  # as parts of h
_STILL = symbol("still")
_MOST_NODES = 2000
_SAME_TIME = Fraction(1, 2**40)  # two times whose parts are added in floats
_MOST_TOLD = 4
_ROUNDING = Fraction(1, 2**44)
_SIMPLE = 1000  # the largest denominator that is shown
# Of a measured step:
_PLACES, _MEANS = 2, 5
_SIZES = {"duals": slice(4, 12), "floats": slice(3, 17)}  # of a ladder, as a flow is made for each
_MEAN_SIZES = {"duals": Fraction(1, 2**20), "floats": Fraction(1, 2**9)}
_TOLERANCES = {
    "duals": Fraction(1, 10**6),
    "floats": Fraction(1, 200),
}  # of each other, in parts of h
_LARGEST_PART = 12  # the denominator of a mean that is read off what is so near
_FEWEST, _LEAST_SLOPE, _NO_SLOPE = 2, 0.01, 1e-6  # points, and the size of H_qt or H_pt


def moment(time: Fraction) -> str:
    """Format a time in parts of h after t.

    >>> [moment(Fraction(x)) for x in ("0", "1", "-1/2", "3/4", "0.3512071919596578")]
    ['t', 't + h', 't - h/2', 't + 3h/4', 't + 0.35120719h']
    """
    simple = time.limit_denominator(_SIMPLE)
    if simple == 0:
        return "t"
    sign, size = ("-", -simple) if time < 0 else ("+", simple)
    if abs(simple - time) >= _SAME_TIME:
        return f"t {sign} {abs(float(time)):.8g}h"
    factor = "" if size.numerator == 1 else str(size.numerator)
    return f"t {sign} {factor}h" + (f"/{size.denominator}" if size.denominator > 1 else "")


def stands_still(reached: str, words: str) -> str:
    """Describe a clock that stands still: `reached` is the order that the step then has, `words`
    the moment."""
    return (
        f"it is {reached} as if the force were read at {words} in every stage: its clock stands "
        "still"
    )


# -- of a traced step -----------------------------------------------------------------------------


def clock_mistakes(hamiltonian: Hamiltonian, roots: Sequence[Node], order: int | None) -> list[str]:
    """Return one sentence, where the step of these p' and q' has a higher order than `order` with
    the force held still, or with H read at other times."""
    if order is None or not hamiltonian.time_dependent or "still" in hamiltonian.parameters:
        return []
    p_next, q_next = roots
    still = _find_still_clock(hamiltonian, p_next, q_next, order)
    return still or misread(hamiltonian, p_next, q_next, order)


def _find_still_clock(
    hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int
) -> list[str]:
    t, h = symbol("t"), symbol("h")
    # t + part·h becomes the constant `still`, a parameter of an autonomous H, for which the step is
    # then a scheme of an order of its own.
    still_hamiltonian = Hamiltonian(hamiltonian.exact.subs(t, _STILL))
    for words, part in MOMENTS.items():
        formulas = write_expressions((p_next, q_next), _MOST_WRITTEN, {"t": _STILL - part * h})
        if formulas is None:
            return []
        try:
            step = map_from_expressions(still_hamiltonian, formulas)
            reached = convergence_of(step).order
        except InputError:  # too long, or not smooth
            continue
        if reached is None or reached > order:
            return [stands_still("exact" if reached is None else f"of order {reached}", words)]
    return []


# -- readings at wrong times, of a traced step ----------------------------------------------------


def misread(hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int) -> list[str]:
    """Return one sentence, where the step is proved to have a higher order than `order` with each
    reading at the time when it is due."""
    if len(in_order(p_next, q_next)) > _MOST_NODES:
        return []
    try:
        readings = Readings(hamiltonian, p_next, q_next)
        reads = _alike(readings.reads)
        wrong_reads = [read for read in reads if abs(read.time - read.due) >= _SAME_TIME]
        mended = _order_in_time(hamiltonian, *readings.with_due_times()) if wrong_reads else order
    except (ArithmeticError, ValueError, NoReadingsError, UntraceableError, InputError):
        return []
    if mended is not None and mended <= order:
        return []
    reached = "exact" if mended is None else f"of order {mended}"
    pairs = list(dict.fromkeys((read.due, read.time) for read in wrong_reads))
    moments = ", ".join(
        f"{moment(due)} in place of {moment(time)}" for due, time in pairs[:_MOST_TOLD]
    )
    ellipsis = ", …" * (len(pairs) > _MOST_TOLD)
    name = _name(reads)
    return [f"{name}: " * bool(name) + f"it is {reached} with H read at {moments}{ellipsis}"]


def _order_in_time(hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> int | None:
    """Return the order of that map but for the rounding of its coefficients; None where it is
    exact."""
    traced = traced_map(hamiltonian, (p_next, q_next))
    order = convergence_of(traced.step_map).order
    if order is None or traced.series is None:
        return order
    rounded = _rounded_order(*traced.series)
    return order if rounded is None else max(order, rounded)


def _rounded_order(field: CanonicalField, step: State) -> int | None:
    """Return the power of h up to which the map agrees with the flow, with residuals below 2⁻⁴⁴ of
    the coefficients taken for 0; None where it does in all that are looked at.

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
        if gap > _ROUNDING * scale:
            return n - 1
    return None


def _alike(reads: Sequence[Read]) -> list[Read]:
    """Merge readings of the same times into one, at the place of the first."""
    sizes: dict[tuple[Fraction, Fraction, bool], Fraction] = {}
    for read in reads:
        key = read.time, read.due, read.of_p
        sizes[key] = sizes.get(key, Fraction(0)) + read.size
    return [Read(time, due, size, of_p) for (time, due, of_p), size in sizes.items()]


def _name(reads: Sequence[Read]) -> str | None:
    """Name the mistake in what is read for p', or for q', where it has a name."""
    ring = Ring((), 0)
    for of_p, kind in ((True, "force"), (False, "velocity")):
        own_reads = [read for read in reads if read.of_p is of_p and read.size]
        sizes_before = [
            sum((x.size for x in own_reads[:k]), Fraction(0)) for k in range(len(own_reads))
        ]
        numbers = [
            [ring.constant(x) for x in column]
            for column in ([x.time for x in own_reads], [x.due for x in own_reads], sizes_before,
                           [x.size for x in own_reads])
        ]  # fmt: skip
        mistake = (
            mistake_of_clock(ClockReading(ring, kind, "stage", *numbers), _SAME_TIME)
            if own_reads
            else None
        )
        if mistake:
            return mistake
    return None


# -- of a measured step ---------------------------------------------------------------------------


def measure_clock_mistakes(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[TrialPlace], order: int | None
) -> list[str]:
    """Return one sentence, where the step is seen to have a higher order than `order` with the
    force held still, or to read it too early or too late in the mean. Raises what the user's code
    raises."""
    if order is None or order < 1 or not probe.step.moving:
        return []
    for words, part in MOMENTS.items():
        higher = _measure_order(probe, hamiltonian, places, part, order)
        if higher is not None:
            return [stands_still(f"of order {higher}", words)]
    return _mean_time(probe, hamiltonian, places[:_MEANS]) if order == 1 else []


def _measure_order(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[TrialPlace], part: Fraction,
    beyond: int,
) -> int | None:  # fmt: skip
    """Return the order of the distance from the flow of H at t + part·h; None where it is not above
    `beyond`, or not the same at two places, as where what shrinks slowly is small at one."""
    orders = (_order_at(probe, hamiltonian, x, part) for x in places[:_PLACES])
    order = next(orders)
    if order is None or order <= beyond or any(x != order for x in orders):
        return None
    return order


def _order_at(
    probe: Probe, hamiltonian: Hamiltonian, place: TrialPlace, part: Fraction
) -> int | None:
    rows: list[Row] = []
    for size in LADDERS[probe.how][_SIZES[probe.how]]:
        h = place.step / size
        still_hamiltonian = Hamiltonian(hamiltonian.exact.subs(symbol("t"), place.t + part * h))
        flow = flow_of(still_hamiltonian, probe)
        end = probe.end(place, h)
        gaps = [abs(x - y) for x, y in zip(end, end_of_flow(flow, probe, place, h), strict=True)]
        noise = max(probe.noise(place, end))
        rows.append((float(h), float(max(gaps)), 4 * noise))
    runs = slopes_of(rows).runs
    return runs[-1].power - 1 if runs else None


# -- the mean of the times that are read, of a measured step --------------------------------------


def _mean_time(probe: Probe, hamiltonian: Hamiltonian, places: Sequence[TrialPlace]) -> list[str]:
    """Name the mean time at which H is read, where that is seen and is why the order is 1.

    A step that reads H(p, q, t) at t + c_i h, in parts b_i of it, has p' − p(t + h) = −(Σ b_i c_i −
    1/2) H_qt h² + O(h³) where nothing else is wrong, and so for q with H_pt. Where that quotient is
    the same at every point, Σ b_i c_i is the mean; where something else is wrong it is not.
    """
    means = [x for place in places for x in _means(probe, hamiltonian, place)]
    bound = _TOLERANCES[probe.how]
    if (
        len(means) < _FEWEST
        or max(means) - min(means) > bound
        or abs(means[0] - Fraction(1, 2)) < bound
    ):
        return []
    mean = sum(means, Fraction(0)) / len(means)
    simple_mean = mean.limit_denominator(_LARGEST_PART)
    moment_text = (
        moment(simple_mean) if abs(simple_mean - mean) <= bound else f"about t {float(mean):+.3f} h"
    )
    return [f"H is read at {moment_text} in the mean: it can be of order 2 where that is t + h/2"]


def _means(probe: Probe, hamiltonian: Hamiltonian, place: TrialPlace) -> Iterator[Fraction]:
    """Yield the mean times that p' and q' show, where H's derivative is large enough."""
    h = _MEAN_SIZES[probe.how] * place.step
    gaps = [_gap(probe, hamiltonian, place, x) for x in (h, h / 2)]
    point = dict(zip("pqt", (*place.z, place.t), strict=True))
    values = {symbol(name): sympy.Rational(x.numerator, x.denominator) for name, x in point.items()}
    for k, (coordinate, sign) in enumerate((("q", -1), ("p", 1))):
        slope = sign * hamiltonian.exact.diff(symbol(coordinate), symbol("t")).subs(values)
        size = Fraction(float(slope))
        coarse, fine = gaps[0][k] / h**2, gaps[1][k] / (h / 2) ** 2
        if abs(size) > _LEAST_SLOPE:
            # Richardson's extrapolation, 2 g(h/2) − g(h), removes the term of order h from the
            # quotient.
            yield Fraction(1, 2) + (2 * fine - coarse) / size
        elif abs(size) < _NO_SLOPE and abs(2 * fine - coarse) > _LEAST_SLOPE:
            # It is wrong where time has no part in it.
            yield from (Fraction(0), Fraction(1))


def _gap(probe: Probe, hamiltonian: Hamiltonian, place: TrialPlace, h: Fraction) -> list[Fraction]:
    """Return p' and q' less the exact flow's."""
    flow = flow_of(hamiltonian, probe)
    ends = zip(probe.end(place, h), end_of_flow(flow, probe, place, h), strict=True)
    return [x - y for x, y in ends]
