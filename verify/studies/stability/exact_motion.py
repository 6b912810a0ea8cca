"""The exact motion that a run is held to: in the plane until it closes (`verify.flows.orbit`), in n
degrees of freedom beside a neighbour, which tells how fast they part.

There the flow is followed with 24 digits from one time to the next, and so is a neighbour that
starts 10⁻¹² of the reach away: their distance, by the first one, is what the tangent map does to
one direction, as long as it is small. Lengths are measured by the reach: that of the momenta for
momenta, of the coordinates for coordinates, each the greatest of its kind.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import log, pi
from typing import ClassVar

from verify.arithmetic.systems import mpfr
from verify.flows.extrapolation import Flow, NoFlowError
from verify.flows.functions import functions_at
from verify.flows.orbit import exact_orbit
from verify.flows.orbit_search import ExactOrbit, Kind
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose, prose, read_prose
from verify.runs.tangent_growth import finite_time_lyapunov, is_exponential
from verify.studies.stability.trail import State

_DIGITS = 24
_TIMES = 96
_MOST_STEPS = 4000  # from one time to the next
_NEAR = Fraction(1, 10**12)  # of the reach
_APART = 0.1  # of the reach, beyond which a distance no longer grows
_FAR = 10**6  # an orbit that goes so many times farther than it was is leaving
_OMEGA_DIGITS = 20
_NOISE = 1e-6  # of the matrix's size: a double eigenvalue 0 is found so far from it, and more


@dataclass(frozen=True)
class Sensitivity:
    """`exponent`: (1/t) ln of how much a small distance has grown, over the `time` in which it was
    small; `exponential`: whether it grows so, None where the time does not tell."""

    exponent: float
    time: float
    exponential: bool | None

    @classmethod
    def of(cls, times: Sequence[float], distances: Sequence[float]) -> "Sensitivity":
        """By the distances at ascending times from 0 on, in parts of the reach; the first is not
        0."""
        count = next((k for k, x in enumerate(distances) if x > _APART), len(distances) - 1) + 1
        first = distances[0]
        logs = [log(max(x, first * 1e-6) / first) for x in distances[:count]]
        own = list(times[:count])
        rate = finite_time_lyapunov(logs[-1], 1, own[-1]) if count > 1 else 0.0
        return cls(rate, own[-1], is_exponential(own, logs))


@dataclass(frozen=True, kw_only=True)
class ExactMotion(ExactOrbit):
    """In n degrees of freedom. `reach`: of each coordinate, the greatest of its kind; `turns`: none
    is taken for an angle here; `period`: about the time in which the quickest coordinate turns
    round; `states`: where it was looked at, at these `times`."""

    has_neighbours: ClassVar[bool] = True
    hamiltonian: Hamiltonian
    states: tuple[State, ...]
    times: tuple[Fraction, ...]
    sensitivity: Sensitivity | None = None

    @property
    def is_sensitive(self) -> bool | None:
        """Whether it parts from its neighbours exponentially; None where that is not known."""
        return None if self.sensitivity is None else self.sensitivity.exponential

    @cached_property
    def frequency(self) -> Fraction:
        """The greatest ω, to some three digits: the greatest imaginary part of an eigenvalue of the
        field's Jacobian, in float64, at the states; 0 where nothing oscillates."""
        import numpy as np

        field, _ = canonical_field(self.hamiltonian)
        size, ring = len(field.names), field.ring
        names = (*field.names, "t") if field.timed else field.names
        entries = [(ring, ring.diff(slope, name)) for slope in field.slopes for name in field.names]
        arithmetic = mpfr.make(_OMEGA_DIGITS)
        at = functions_at(arithmetic, entries, names)
        greatest = 0.0
        for time, state in zip(self.times, self.states, strict=True):
            given = (*state, time) if field.timed else state
            with arithmetic.context():
                found = at(*map(arithmetic.number, given))
            jacobian = np.array([float(arithmetic.exact(x)) for x in found]).reshape(size, size)
            turning = float(np.abs(np.linalg.eigvals(jacobian).imag).max())
            if turning > _NOISE * float(np.abs(jacobian).max()):
                greatest = max(greatest, turning)
        return Fraction(greatest)


def moved(state: State, reach: State, part: Fraction) -> State:
    """A neighbour so far away, in a direction that no coordinate is left out of."""
    return tuple(
        x + part * r * Fraction((-1) ** k, 1 + k)
        for k, (x, r) in enumerate(zip(state, reach, strict=True))
    )


def distance(one: State, other: State, reach: State) -> float:
    """The greatest difference of a coordinate, in parts of its reach."""
    return max(float(abs(x - y) / r) for x, y, r in zip(one, other, reach, strict=True))


def exact_motion(
    hamiltonian: Hamiltonian, state: State, time: Fraction, t0: Fraction = Fraction(0)
) -> ExactOrbit:
    """The motion from a state for the length `time`."""
    if hamiltonian.planar:
        p, q = state
        return exact_orbit(hamiltonian, p, q, time, t0)
    return _beside_a_neighbour(hamiltonian, state, time, t0)


@lru_cache(maxsize=64)
def _beside_a_neighbour(
    hamiltonian: Hamiltonian, state: State, time: Fraction, t0: Fraction
) -> ExactMotion:
    search = _Search(hamiltonian, state, time, t0)
    try:
        points = search.followed(state)
    except NoFlowError as error:
        return search.found("not followed", error.said, [state])
    size = max(map(abs, state)) or max(map(abs, points[1]))
    if max(map(abs, points[-1])) > _FAR * size:
        at = float(t0 + time)
        said = f"is `{_FAR:.0e}` times as far out as z0 at t = `{at:.6g}`"
        return search.found("escapes", read_prose(said), points)
    kind: Kind = "driven" if hamiltonian.time_dependent else "bounded"
    found = search.found(kind, prose(), points)
    near = moved(state, found.reach, _NEAR)
    try:
        neighbour = search.followed(near)
    except NoFlowError:
        return search.found(kind, prose("is followed; a neighbour is not"), points)
    pairs = zip(points, neighbour, strict=True)
    seen = Sensitivity.of(search.times, [distance(a, b, found.reach) for a, b in pairs])
    return search.found(kind, _told(seen), points, seen)


def _told(seen: Sensitivity) -> Prose:
    says = {
        True: "parts from its neighbours exponentially",
        False: "parts from its neighbours no faster than a power of t",
        None: "is not followed long enough to tell how it parts from its neighbours",
    }
    rate = f"{seen.exponent:.2g} in a unit of time, over t = {seen.time:.4g}"
    return read_prose(f"{says[seen.exponential]} (`{rate}`)")


class _Search:
    def __init__(
        self, hamiltonian: Hamiltonian, state: State, time: Fraction, t0: Fraction
    ) -> None:
        field, _ = canonical_field(hamiltonian)
        self.hamiltonian = hamiltonian
        self.flow, self.t0, self.state = Flow(field, _DIGITS), t0, state
        self.part = time / _TIMES
        self.times = [float(k * self.part) for k in range(_TIMES + 1)]
        self.speeds: list[State] = []

    def followed(self, state: State) -> list[State]:
        """The states at the times. NoFlowError where the motion ends on the way."""
        flow, size = self.flow, len(state)
        begun = (*state, self.t0) if flow.timed else state
        z, points = tuple(map(flow.number, begun)), [state]
        for _ in range(_TIMES):
            z = flow.follow(z, self.part, _MOST_STEPS)
            points.append(tuple(map(flow.arithmetic.exact, z[:size])))
        return points

    def found(
        self, kind: Kind, summary: Prose, points: Sequence[State],
        sensitivity: Sensitivity | None = None,
    ) -> ExactMotion:  # fmt: skip
        columns = list(zip(*points, strict=True))
        centre = tuple((min(x) + max(x)) / 2 for x in columns)
        own = [(max(x) - min(x)) / 2 for x in columns]
        n = len(own) // 2
        greatest = [
            max(own[k:m]) or max(map(abs, self.state[k:m])) or Fraction(1)
            for k, m in ((0, n), (n, 2 * n))
        ]
        reach = tuple(greatest[k // n] for k in range(2 * n))
        fastest = self._fastest(points)
        # H_p = q' and H_q = −p': H changes by about so much across the orbit.
        products = (fastest[(k + n) % (2 * n)] * own[k] for k in range(2 * n))
        times = [r / v for r, v in zip(own, fastest, strict=True) if r and v]
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
        """The greatest |z'| of each coordinate at the points."""
        flow, exact = self.flow, self.flow.arithmetic.exact
        speeds = []
        for k, point in enumerate(points):
            begun = (*point, self.t0 + k * self.part) if flow.timed else point
            try:
                speeds.append([abs(exact(x)) for x in flow.slope(tuple(map(flow.number, begun)))])
            except NoFlowError:
                continue
        return [max(x) for x in zip(*speeds, strict=True)] or [Fraction(0)] * len(points[0])
