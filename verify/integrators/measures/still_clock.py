"""Which mistake the clock of a measured step looks like: as `verify.integrators.tracing.clocks`.

Its distance is taken from the exact flow of H(p, q, s), with s one moment of the step, instead of
that of H(p, q, t): of another autonomous H for every step size.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.algebra.formula import symbol
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.mean_time import mean_time
from verify.integrators.measures.order import LADDERS, Probe, flow_of, goal
from verify.integrators.measures.slopes import Row, slopes_of
from verify.integrators.places.place import Place
from verify.integrators.tracing.clocks import MOMENTS, stands_still

_PLACES, _MEANS = 2, 5
_SIZES = {"duals": slice(4, 12), "floats": slice(3, 17)}  # of a ladder, as a flow is made for each


def measured_mistakes(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[Place], order: int | None
) -> list[str]:
    """One sentence, where the step is seen to have a higher order than `order` with the force held
    still, or to read it too early or too late in the mean. Raises what the user's code raises."""
    if order is None or order < 1 or not probe.step.moving:
        return []
    for words, part in MOMENTS.items():
        higher = _order(probe, hamiltonian, places, part, order)
        if higher is not None:
            return [stands_still(f"of order {higher}", words)]
    return mean_time(probe, hamiltonian, places[:_MEANS]) if order == 1 else []


def _order(
    probe: Probe, hamiltonian: Hamiltonian, places: Sequence[Place], part: Fraction, beyond: int
) -> int | None:
    """That of the distance from the flow of H at t + part·h; None where it is not beyond that, or
    not the same at two places, as where what shrinks slowly is small at one."""
    first, *others = places[:_PLACES]
    order = _order_at(probe, hamiltonian, first, part)
    if order is None or order <= beyond:
        return None
    return order if all(_order_at(probe, hamiltonian, x, part) == order for x in others) else None


def _order_at(probe: Probe, hamiltonian: Hamiltonian, place: Place, part: Fraction) -> int | None:
    rows: list[Row] = []
    for size in LADDERS[probe.how][_SIZES[probe.how]]:
        h = place.step / size
        still = Hamiltonian(hamiltonian.exact.subs(symbol("t"), place.t + part * h))
        flow = flow_of(still, probe)
        ended = probe.end(place, h)
        gaps = [abs(x - y) for x, y in zip(ended, goal(flow, probe, place, h), strict=True)]
        noise = max(probe.noise(place, ended))
        rows.append((float(h), float(max(gaps)), 4 * noise))
    runs = slopes_of(rows).runs
    return runs[-1].power - 1 if runs else None
