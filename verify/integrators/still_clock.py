"""Which mistake the clock of a measured step looks like: as `verify.integrators.tracing.clocks`.

Its distance is taken from the exact flow of H(p, q, s), with s one moment of the step, instead of
that of H(p, q, t): of another autonomous H for every step size.
"""

from fractions import Fraction

from verify.algebra.formula import symbol
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.fitted_order import Fitted, fitted
from verify.integrators.probe import LADDERS, PROBES, Point, Trial, flow_of, reading
from verify.integrators.tracing.clocks import MOMENTS, stands_still

_SIZES = slice(3, 11)  # of a ladder: enough to see a power, as a flow is made for each


def measured_mistakes(trial: Trial, how: str, order: int | None) -> list[str]:
    """One sentence, where the step is seen to have a higher order than `order` with the force held
    still. Raises what the user's code raises."""
    if order is None or not trial.step.moving:
        return []
    for words, part in MOMENTS.items():
        found = _order(trial, how, trial.points[0], part)
        if found.power is not None and found.tail is None and found.power - 1 > order:
            return [stands_still(f"of order {found.power - 1}", words)]
    return []


def _order(trial: Trial, how: str, point: Point, part: Fraction) -> Fitted:
    """The power by which the distance from the flow of H at t + part·h shrinks."""
    probe, rows = PROBES[how](trial.step), []
    for h in LADDERS[how][_SIZES]:
        moment = trial.step.clock(*point) + part * h
        still = Hamiltonian(trial.hamiltonian.exact.subs(symbol("t"), moment))
        told = reading(probe, flow_of(still, how), point, h)
        rows.append((float(h), told.error, told.error_noise))
    return fitted(rows, probe.opaque)
