"""The exact motion that a run is compared with.

In the plane it is followed until it closes (`verify.flows.exact_orbit`), in n degrees of freedom
beside a neighbour, which shows how fast the two part.

In n degrees of freedom the flow is followed with 24 digits from one time to the next, and so is a
neighbour that starts 10⁻¹² of the reach away. As long as their distance is small, its growth is
that of one vector under the tangent map. Distances are relative to the reach: half the greatest
range of a momentum for momenta, and of a displacement for displacements.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import log, pi
from typing import ClassVar

from verify.arithmetic.systems import mpfr
from verify.flows.compiled_functions import functions_at
from verify.flows.exact_orbit import exact_orbit
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.flows.orbit_search import ExactOrbit, Kind
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose, prose, read_prose
from verify.runs.tangent_growth import finite_time_lyapunov, is_exponential
from verify.studies.stability.trail import State

_DIGITS = 24
_TIMES = 96
_MAX_STEPS = 4000  # from one time to the next
_INITIAL_DISTANCE = Fraction(1, 10**12)  # the neighbour's, relative to the reach
_LARGE_DISTANCE = 0.1  # relative to the reach; beyond it a distance no longer grows
_ESCAPE_FACTOR = 10**6  # an orbit escapes if its end is this many times as far out as its start
_OMEGA_DIGITS = 20
# Relative to the matrix's greatest entry: rounding moves a double eigenvalue 0 at least as far.
_EIGENVALUE_NOISE = 1e-6


@dataclass(frozen=True)
class Sensitivity:
    """The growth of a small distance between neighbours.

    `exponent`: (1/t) ln of the factor by which it has grown, over the `time` in which it was small.
    `exponential`: True if it grows exponentially; None if the time is too short to decide.
    """

    exponent: float
    time: float
    exponential: bool | None

    @classmethod
    def from_distances(cls, times: Sequence[float], distances: Sequence[float]) -> "Sensitivity":
        """Return the sensitivity by distances at ascending times from 0 on, relative to the reach.

        The first distance must not be 0.
        """
        # Once neighbours are far apart their distance is bounded by the orbit's size and grows no
        # more.
        count = (
            next((k for k, x in enumerate(distances) if x > _LARGE_DISTANCE), len(distances) - 1)
            + 1
        )
        first = distances[0]
        # A distance may pass 0 by chance; its logarithm is kept finite.
        logs = [log(max(x, first * 1e-6) / first) for x in distances[:count]]
        small_times = list(times[:count])
        rate = finite_time_lyapunov(logs[-1], 1, small_times[-1]) if count > 1 else 0.0
        return cls(rate, small_times[-1], is_exponential(small_times, logs))


@dataclass(frozen=True, kw_only=True)
class ExactMotion(ExactOrbit):
    """An exact motion in n degrees of freedom.

    `reach`: half the greatest range of a momentum, or of a displacement, for each coordinate;
    `turns`: all False, since no coordinate is taken for an angle; `period`: about that of the
    quickest coordinate; `states`: those at `times`.
    """

    has_neighbours: ClassVar[bool] = True
    hamiltonian: Hamiltonian
    states: tuple[State, ...]
    times: tuple[Fraction, ...]
    sensitivity: Sensitivity | None = None

    @property
    def is_sensitive(self) -> bool | None:
        """True if the motion parts from its neighbours exponentially; None if undecided."""
        return None if self.sensitivity is None else self.sensitivity.exponential

    @cached_property
    def frequency(self) -> Fraction:
        """The greatest ω, to some three digits: the greatest imaginary part of an eigenvalue of the
        field's Jacobian, in float64, at the states; 0 if nothing oscillates."""
        import numpy as np

        field, _ = canonical_field(self.hamiltonian)
        size, ring = len(field.names), field.ring
        names = (*field.names, "t") if field.timed else field.names
        entries = [(ring, ring.diff(slope, name)) for slope in field.slopes for name in field.names]
        arithmetic = mpfr.make(_OMEGA_DIGITS)
        jacobian_at = functions_at(arithmetic, entries, names)
        greatest = 0.0
        for time, state in zip(self.times, self.states, strict=True):
            arguments = (*state, time) if field.timed else state
            with arithmetic.context():
                values = jacobian_at(*map(arithmetic.number, arguments))
            jacobian = np.array([float(arithmetic.exact(x)) for x in values]).reshape(size, size)
            turning = float(np.abs(np.linalg.eigvals(jacobian).imag).max())
            if turning > _EIGENVALUE_NOISE * float(np.abs(jacobian).max()):
                greatest = max(greatest, turning)
        return Fraction(greatest)


def displace(state: State, reach: State, part: Fraction) -> State:
    """Return a neighbour at so many parts of the reach, displaced in every coordinate."""
    return tuple(
        x + part * r * Fraction((-1) ** k, 1 + k)
        for k, (x, r) in enumerate(zip(state, reach, strict=True))
    )


def distance(state: State, neighbour: State, reach: State) -> float:
    """Return the greatest difference of a coordinate, in parts of its reach."""
    return max(float(abs(x - y) / r) for x, y, r in zip(state, neighbour, reach, strict=True))


def exact_motion(
    hamiltonian: Hamiltonian, state: State, time: Fraction, t0: Fraction = Fraction(0)
) -> ExactOrbit:
    """Return the motion from a state for the length `time`."""
    if hamiltonian.planar:
        p, q = state
        return exact_orbit(hamiltonian, p, q, time, t0)
    return _follow_with_neighbour(hamiltonian, state, time, t0)


@lru_cache(maxsize=64)
def _follow_with_neighbour(
    hamiltonian: Hamiltonian, state: State, time: Fraction, t0: Fraction
) -> ExactMotion:
    search = _FlowAtTimes(hamiltonian, state, time, t0)
    try:
        points = search.follow(state)
    except NoFlowError as error:
        return search.build_motion("not followed", error.reason, [state])
    size = max(map(abs, state)) or max(map(abs, points[1]))
    if max(map(abs, points[-1])) > _ESCAPE_FACTOR * size:
        time_reached = float(t0 + time)
        summary = f"is `{_ESCAPE_FACTOR:.0e}` times as far out as z0 at t = `{time_reached:.6g}`"
        return search.build_motion("escapes", read_prose(summary), points)
    kind: Kind = "driven" if hamiltonian.time_dependent else "bounded"
    motion = search.build_motion(kind, prose(), points)
    displaced = displace(state, motion.reach, _INITIAL_DISTANCE)
    try:
        neighbour = search.follow(displaced)
    except NoFlowError:
        return search.build_motion(kind, prose("is followed; a neighbour is not"), points)
    pairs = zip(points, neighbour, strict=True)
    sensitivity = Sensitivity.from_distances(
        search.times, [distance(a, b, motion.reach) for a, b in pairs]
    )
    return search.build_motion(kind, _describe_sensitivity(sensitivity), points, sensitivity)


def _describe_sensitivity(sensitivity: Sensitivity) -> Prose:
    says = {
        True: "parts from its neighbours exponentially",
        False: "parts from its neighbours no faster than a power of t",
        None: "is not followed long enough to tell how it parts from its neighbours",
    }
    rate = f"{sensitivity.exponent:.2g} in a unit of time, over t = {sensitivity.time:.4g}"
    return read_prose(f"{says[sensitivity.exponential]} (`{rate}`)")


class _FlowAtTimes:
    """The exact flow from one time to the next, from a state and from its neighbours."""

    def __init__(
        self, hamiltonian: Hamiltonian, state: State, time: Fraction, t0: Fraction
    ) -> None:
        field, _ = canonical_field(hamiltonian)
        self.hamiltonian = hamiltonian
        self.flow, self.t0, self.state = NumericalFlow(field, _DIGITS), t0, state
        self.part = time / _TIMES
        self.times = [float(k * self.part) for k in range(_TIMES + 1)]
        self.speeds: list[State] = []

    def follow(self, state: State) -> list[State]:
        """Return the states at the times. Raises NoFlowError if the motion ends on the way."""
        flow, size = self.flow, len(state)
        start = (*state, self.t0) if flow.timed else state
        z, points = tuple(map(flow.number, start)), [state]
        for _ in range(_TIMES):
            z = flow.follow(z, self.part, _MAX_STEPS)
            points.append(tuple(map(flow.arithmetic.exact, z[:size])))
        return points

    def build_motion(
        self, kind: Kind, summary: Prose, points: Sequence[State],
        sensitivity: Sensitivity | None = None,
    ) -> ExactMotion:  # fmt: skip
        columns = list(zip(*points, strict=True))
        centre = tuple((min(x) + max(x)) / 2 for x in columns)
        half_widths = [(max(x) - min(x)) / 2 for x in columns]
        n = len(half_widths) // 2
        greatest = [
            max(half_widths[k:m]) or max(map(abs, self.state[k:m])) or Fraction(1)
            for k, m in ((0, n), (n, 2 * n))
        ]
        # Momenta are measured by the greatest half width of all momenta, coordinates likewise: one
        # that hardly moves has no scale of its own.
        reach = tuple(greatest[k // n] for k in range(2 * n))
        fastest = self._fastest(points)
        # H_p = q' and H_q = −p': H changes by about the sum of these across the orbit.
        products = (fastest[(k + n) % (2 * n)] * half_widths[k] for k in range(2 * n))
        times = [r / v for r, v in zip(half_widths, fastest, strict=True) if r and v]
        period = Fraction(2 * pi) * min(times) if times else None
        return ExactMotion(
            kind=kind,
            summary=summary,
            centre=centre,
            reach=reach,
            turns=(False,) * len(reach),
            scale=sum(products, Fraction(0)) / 2 or Fraction(1),
            period=period,
            hamiltonian=self.hamiltonian,
            states=tuple(points),
            times=tuple(self.t0 + k * self.part for k in range(len(points))),
            sensitivity=sensitivity,
        )

    def _fastest(self, points: Sequence[State]) -> list[Fraction]:
        """Return the greatest |z'| of each coordinate at the points."""
        flow, to_rational = self.flow, self.flow.arithmetic.exact
        speeds = []
        for k, point in enumerate(points):
            start = (*point, self.t0 + k * self.part) if flow.timed else point
            try:
                slope = flow.slope(tuple(map(flow.number, start)))
                speeds.append([abs(to_rational(x)) for x in slope])
            except NoFlowError:
                continue
        return [max(x) for x in zip(*speeds, strict=True)] or [Fraction(0)] * len(points[0])
