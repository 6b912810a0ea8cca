"""The mistake that the clock of a measured step looks like, as in
`verify.integrators.tracing.clocks`.

The distance is taken from the exact flow of H(p, q, s), with s one moment of the step, instead of
that of H(p, q, t): of another autonomous H for every step size.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.order import LADDERS, Probe, flow_of, goal
from verify.integrators.measures.slopes import Row, slopes_of
from verify.integrators.places.place import Place
from verify.integrators.tracing.clocks import MOMENTS, moment, stands_still

_PLACES, _MEANS = 2, 5
_SIZES = {"duals": slice(4, 12), "floats": slice(3, 17)}  # of a ladder, as a flow is made for each
_MEAN_SIZES = {"duals": Fraction(1, 2**20), "floats": Fraction(1, 2**9)}
_NEAR = {"duals": Fraction(1, 10**6), "floats": Fraction(1, 200)}  # of each other, in parts of h
_LARGEST_PART = 12  # the denominator of a mean that is read off what is so near
_FEWEST, _LEAST, _NOTHING = 2, 0.01, 1e-6  # points, and the size of H_qt or H_pt


def measure_clock_mistakes(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[Place], order: int | None
) -> list[str]:
    """Return one sentence, where the step is seen to have a higher order than `order` with the
    force held still, or to read it too early or too late in the mean. Raises what the user's code
    raises."""
    if order is None or order < 1 or not probe.step.moving:
        return []
    for words, part in MOMENTS.items():
        higher = _order(probe, hamiltonian, places, part, order)
        if higher is not None:
            return [stands_still(f"of order {higher}", words)]
    return _mean_time(probe, hamiltonian, places[:_MEANS]) if order == 1 else []


def _order(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[Place], part: Fraction, beyond: int
) -> int | None:
    """Return the order of the distance from the flow of H at t + part·h; None where it is not above
    `beyond`, or not the same at two places, as where what shrinks slowly is small at one."""
    first, *others = places[:_PLACES]
    order = _order_at(probe, hamiltonian, first, part)
    if order is None or order <= beyond:
        return None
    return order if all(_order_at(probe, hamiltonian, x, part) == order for x in others) else None


def _order_at(probe: Probe, hamiltonian: Hamiltonian, place: Place, part: Fraction) -> int | None:
    rows: list[Row] = []
    for size in LADDERS[probe.how][_SIZES[probe.how]]:
        h = place.step / size
        still_hamiltonian = Hamiltonian(hamiltonian.exact.subs(symbol("t"), place.t + part * h))
        flow = flow_of(still_hamiltonian, probe)
        end = probe.end(place, h)
        gaps = [abs(x - y) for x, y in zip(end, goal(flow, probe, place, h), strict=True)]
        noise = max(probe.noise(place, end))
        rows.append((float(h), float(max(gaps)), 4 * noise))
    runs = slopes_of(rows).runs
    return runs[-1].power - 1 if runs else None


# -- the mean of the times that are read ----------------------------------------------------------


def _mean_time(probe: Probe, hamiltonian: Hamiltonian, places: Sequence[Place]) -> list[str]:
    """Name the mean time at which H is read, where that is seen and is why the order is 1.

    A step that reads H(p, q, t) at t + c_i h, in parts b_i of it, has p' − p(t + h) = −(Σ b_i c_i −
    1/2) H_qt h² + O(h³) where nothing else is wrong, and so for q with H_pt. Where that quotient is
    the same at every point, Σ b_i c_i is the mean; where something else is wrong it is not.
    """
    means = [x for place in places for x in _means(probe, hamiltonian, place)]
    near = _NEAR[probe.how]
    if (
        len(means) < _FEWEST
        or max(means) - min(means) > near
        or abs(means[0] - Fraction(1, 2)) < near
    ):
        return []
    mean = sum(means, Fraction(0)) / len(means)
    simple_mean = mean.limit_denominator(_LARGEST_PART)
    moment_text = (
        moment(simple_mean) if abs(simple_mean - mean) <= near else f"about t {float(mean):+.3f} h"
    )
    return [f"H is read at {moment_text} in the mean: it can be of order 2 where that is t + h/2"]


def _means(probe: Probe, hamiltonian: Hamiltonian, place: Place) -> Iterator[Fraction]:
    """Yield the mean times that p' and q' show, where H's derivative is large enough."""
    h = _MEAN_SIZES[probe.how] * place.step
    gaps = [_gap(probe, hamiltonian, place, x) for x in (h, h / 2)]
    point = dict(zip("pqt", (*place.z, place.t), strict=True))
    values = {symbol(name): sympy.Rational(x.numerator, x.denominator) for name, x in point.items()}
    for k, (by, sign) in enumerate((("q", -1), ("p", 1))):
        slope = sign * hamiltonian.exact.diff(symbol(by), symbol("t")).subs(values)
        size = Fraction(float(slope))
        one, two = gaps[0][k] / h**2, gaps[1][k] / (h / 2) ** 2
        if abs(size) > _LEAST:
            # Richardson's extrapolation, 2 g(h/2) − g(h), removes the term of order h from the
            # quotient.
            yield Fraction(1, 2) + (2 * two - one) / size
        elif (
            abs(size) < _NOTHING and abs(2 * two - one) > _LEAST
        ):  # it is wrong where time has no part in it
            yield from (Fraction(0), Fraction(1))


def _gap(probe: Probe, hamiltonian: Hamiltonian, place: Place, h: Fraction) -> list[Fraction]:
    """Return p' and q' less the exact flow's."""
    flow = flow_of(hamiltonian, probe)
    ends = zip(probe.end(place, h), goal(flow, probe, place, h), strict=True)
    return [x - y for x, y in ends]
