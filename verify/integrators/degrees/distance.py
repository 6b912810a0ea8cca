"""How far one step of arrays is from the exact flow, as its step size falls: its order."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

from verify.flows.degrees.extrapolation import FlowInDegrees
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.degrees.called import StepOfArrays
from verify.integrators.fitted_order import Fitted, fitted
from verify.integrators.maps.probes import DualProbe, FloatProbe
from verify.integrators.tracing.dual import BITS
from verify.integrators.wrapped import Ends, Periods, unwrapped, wrapped

_POINTS = 3  # at which it is looked
_DIGITS, _MORE = 50, 3  # of the exact flow for dual numbers; and more than a step's own have
_DUAL_NOISE = 2.0 ** -(BITS - 30)  # of z', in parts of its size
_ENOUGH = 3  # rows in the noise, after which none is looked at
Point = tuple[Fraction, ...]


@dataclass(frozen=True)
class Distance:
    """`fit`: of the power of h by which the distance falls. `exact`: none was seen beyond noise.
    `periods`: modulo which the coordinates were compared."""

    fit: Fitted
    exact: bool
    periods: Periods = ()

    @property
    def order(self) -> int | None:
        """Of the map; None where the distance follows no power of h."""
        return None if self.fit.power is None else self.fit.power - 1


def distance_of(
    own: StepOfArrays,
    hamiltonian: Hamiltonian,
    how: str,
    points: Sequence[Point],
    t: Fraction,
    ladder: Sequence[Fraction],
) -> Distance:
    """With "duals" or "floats", for the step sizes of `ladder`, falling. Raises StepError,
    NoFlowError, and what the user's code raises."""
    duals, numbers = how == "duals", own.step.numbers
    digits = _DIGITS if duals else numbers.digits + _MORE
    flow = FlowInDegrees(canonical_field(hamiltonian)[0], digits)
    own_noise = _DUAL_NOISE if duals else 4 * numbers.epsilon
    rows: list[tuple[float, float, float]] = []
    quiet, compared = 0, how == "floats"

    @cache  # periods are looked for at the smallest step, which is one of the ladder's
    def ended(h: Fraction) -> tuple[DualProbe | FloatProbe, list[Ends[Fraction]]]:
        here = own.at(h, t)
        probe = DualProbe(here) if duals else FloatProbe(here)
        each = [_at(flow, probe, own.names, point, h, t) for point in points[:_POINTS]]
        return probe, [x for x in each if x is not None]

    periods = wrapped(ended(ladder[-1])[1], hamiltonian, ladder[-1])
    for h in ladder:
        probe, known = ended(h)
        if not known:
            continue
        error, noise = max(_apart(ends, periods, own_noise) for ends in known)
        rows.append((float(h), error, noise))
        compared |= isinstance(probe, DualProbe) and bool(probe.kind.compared)
        quiet = quiet + 1 if error <= 10 * noise else 0
        if quiet >= _ENOUGH:
            break
    if not rows:
        raise NoFlowError("no exact solution is found from any of the points")
    exact = all(error <= 10 * noise for _, error, noise in rows)
    return Distance(fitted(rows, compared), exact, periods)


def _at(
    flow: FlowInDegrees,
    probe: DualProbe | FloatProbe,
    names: Sequence[str],
    point: Point,
    h: Fraction,
    t: Fraction,
) -> Ends[Fraction] | None:
    """Where the step ends and where the flow does; None where the flow does not reach so far."""
    start, there = probe.exact(point)
    try:
        z = flow.state({**dict(zip(names, start, strict=True)), "t": t})
        after = flow.advance(z, flow.number(h))
    except NoFlowError:
        return None
    return there, [flow.arithmetic.exact(x) for x in after[: len(names)]]


def _apart(ends: Ends[Fraction], periods: Periods, noise: float) -> tuple[float, float]:
    """The distance after one step, and its noise."""
    there, exact = ends
    moved = map(unwrapped, there, exact, periods or (Fraction(0),) * len(exact))
    apart = max(abs(x - y) for x, y in zip(moved, exact, strict=True))
    return float(apart), noise * float(1 + max(map(abs, there)))
