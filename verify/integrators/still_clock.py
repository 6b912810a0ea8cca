"""Which mistake the clock of a measured step looks like: as `verify.integrators.tracing.clocks`.

Its distance is taken from the exact flow of H(p, q, s), with s one moment of the step, instead of
that of H(p, q, t): of another autonomous H for every step size.
"""

from fractions import Fraction

from verify.algebra.formula import symbol
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.fitted_order import fitted
from verify.integrators.mean_time import mean_time
from verify.integrators.probe import LADDERS, Trial, distance, flow_of
from verify.integrators.step_probes import PROBES, Point
from verify.integrators.tracing.clocks import MOMENTS, stands_still

_POINTS = 2
_SIZES = slice(3, 17)  # of a ladder: enough to see a lower power, as a flow is made for each


def measured_mistakes(trial: Trial, how: str, order: int | None) -> list[str]:
    """One sentence, where the step is seen to have a higher order than `order` with the force held
    still, or to read it too early or too late in the mean. Raises what the user's code raises."""
    if order is None or not trial.step.moving:
        return []
    for words, part in MOMENTS.items():
        found = _order(trial, how, part, order)
        if found is not None:
            return [stands_still(f"of order {found}", words)]
    return mean_time(trial, how) if order == 1 else []


def _order(trial: Trial, how: str, part: Fraction, beyond: int) -> int | None:
    """That of the distance from the flow of H at t + part·h; None where it is not beyond that, or
    not the same at two points, as where what shrinks slowly is small at one."""
    first, *others = trial.points[:_POINTS]
    found = _order_at(trial, how, first, part)
    if found is None or found <= beyond:
        return None
    return found if all(_order_at(trial, how, x, part) == found for x in others) else None


def _order_at(trial: Trial, how: str, point: Point, part: Fraction) -> int | None:
    probe, rows = PROBES[how](trial.step), []
    for h in LADDERS[how][_SIZES]:
        moment = trial.step.clock(*point) + part * h
        still = Hamiltonian(trial.hamiltonian.exact.subs(symbol("t"), moment))
        flow = flow_of(still, how, trial.step.numbers)
        rows.append((float(h), *distance(probe, flow, point, h)))
    found = fitted(rows, probe.opaque)
    return None if found.power is None or found.tail is not None else found.power - 1
