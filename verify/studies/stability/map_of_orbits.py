"""The map of a scheme's orbits over two of their initial values, in float64.

All orbits are stepped at once, and with each of them a neighbour at a distance of 10⁻⁹ of the
greatest initial coordinate. After each of 64 stretches the orbits that have left are noted, and the
distances of neighbours are measured: if a distance grows exponentially the orbit is sensitive
(`verify.runs.tangent_growth`). The map examined is the scheme's own at this step size. Unless it is
proved to be symplectic, W = MᵀΩM − Ω of the orbits that stay is measured too.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

import numpy as np

from verify import arithmetic as number_systems
from verify.arithmetic.exact import NumberOrList, decimal, fraction, text
from verify.arithmetic.systems import float64
from verify.flows.compiled_functions import energies_at
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of, start_texts
from verify.kernels.many_points import PointMap
from verify.kernels.step.computation import step_map_of
from verify.scenes.observables import carries_defect
from verify.scenes.results.stability import OrbitKind, OrbitMapResult
from verify.studies.stability.exact_motion import Sensitivity

_STRETCHES = 64  # the orbits are examined after each of them
_NEIGHBOUR_DISTANCE = 1e-9  # relative to the greatest initial |coordinate|
_KINDS: Mapping[bool | None, OrbitKind] = {True: "sensitive", False: "regular", None: "undecided"}
_T = TypeVar("_T")


@dataclass(frozen=True)
class Orbits:
    """The scheme's map and where its orbits start, an array (coordinates, orbits)."""

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    steps: int
    t0: Fraction
    starts: np.ndarray
    beyond: float

    @property
    def every(self) -> int:
        """The number of steps of a stretch; the last one may be shorter."""
        return -(-self.steps // _STRETCHES)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the coordinates, p1 … qn, in the order of the rows of `starts`."""
        return self.hamiltonian.coordinates

    @property
    def _sizes(self) -> float:
        return float(np.abs(self.starts).max()) or 1.0

    def stretches(self) -> Iterator[tuple[int, int]]:
        """Yield the first step of each stretch and its number of steps."""
        for first in range(0, self.steps, self.every):
            yield first, min(self.every, self.steps - first)

    def map_from(self, first: int, steps: int, *observables: str) -> PointMap:
        """Return the map of `steps` steps after the first `first` ones, with these observables."""
        return PointMap(
            self.hamiltonian, self.scheme, step_size=self.step_size, steps=steps,
            arithmetic=number_systems.get(float64.NAME, 17),
            t0=self.t0 + first * self.step_size, observables=frozenset(observables),
        )  # fmt: skip

    def follow(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the steps after which each orbit had left, or 0, and neighbours' distances.

        Distances are at each time, relative to the greatest initial |coordinate|; nan once the
        orbit has left.
        """
        count = self.starts.shape[1]
        steps_to_leave = np.zeros(count, dtype=int)
        distances = np.full((_STRETCHES + 1, count), np.nan)
        size = len(self.names)
        # All components of the direction differ from 0, so that no symmetry of H keeps the
        # neighbour on a special plane.
        direction = np.array([(-1) ** k / (1 + k) for k in range(size)])[:, None]
        z, neighbours = self.starts, self.starts + _NEIGHBOUR_DISTANCE * self._sizes * direction
        distances[0] = _distance(z, neighbours, self._sizes)
        staying = np.arange(count)
        for k, (first, steps) in enumerate(self.stretches(), start=1):
            pairs = self.map_from(first, steps).carried_after(np.hstack([z, neighbours]))[:size]
            z, neighbours = np.hsplit(pairs, 2)
            # Orbits that have left are dropped, so that overflow cannot slow or spoil the others.
            stays = (np.abs(z) <= self.beyond).all(axis=0)  # False for nan
            steps_to_leave[staying[~stays]] = first + steps
            staying, z, neighbours = staying[stays], z[:, stays], neighbours[:, stays]
            if not len(staying):
                break
            distances[k, staying] = _distance(z, neighbours, self._sizes)
        return steps_to_leave, distances

    def defects(self, indices: np.ndarray) -> np.ndarray:
        """Return max |W| of these orbits after all steps, in the plane |Λ|."""
        point_map = self.map_from(0, self.steps, self.hamiltonian.structure.of_run)
        rows = [
            k for k, n in enumerate(point_map.kernel.state_names) if n == "lam" or n[:2] == "w_"
        ]
        entries = point_map.carried_after(self.starts[:, indices])[rows]
        greatest: np.ndarray = np.abs(entries).max(axis=0)
        return greatest


def _distance(states: np.ndarray, neighbours: np.ndarray, size: float) -> np.ndarray:
    distances: np.ndarray = np.abs(states - neighbours).max(axis=0) / size
    # A distance that is not finite is that of a neighbour that has left.
    return np.where(np.isfinite(distances), distances, 1 / _NEIGHBOUR_DISTANCE)


def orbit_map(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    axes: tuple[str, str],
    across: Sequence[Fraction],
    upwards: Sequence[Fraction],
    q: NumberOrList,
    p: NumberOrList,
    step_size: Fraction,
    steps: int,
    beyond: Fraction,
    t0: Fraction | None = None,
) -> OrbitMapResult:
    """Classify the orbits from the point (q, p) with these values of two of its coordinates.

    `axes` names the two, `across` and `upwards` have their values: there is a row for each value of
    the second one. Each orbit takes `steps` steps; it leaves once a coordinate is farther from 0
    than `beyond`. Where H depends on time the orbits start at t0.
    """
    point = point_of(hamiltonian, q, p)
    points = [point | {axes[0]: x, axes[1]: y} for y in upwards for x in across]
    starts = np.array(
        [[float(start[name]) for start in points] for name in hamiltonian.coordinates]
    )
    orbits = Orbits(hamiltonian, scheme, step_size, steps, t0 or Fraction(0), starts, float(beyond))
    energies = _energies(hamiltonian, points)
    steps_to_leave, distances = orbits.follow()
    # Time 0 has the initial distance, with which all later ones are compared.
    times = [0.0] + [float((a + n) * step_size) for a, n in orbits.stretches()]
    is_defined = [energy is not None or hamiltonian.time_dependent for energy in energies]
    kinds, rates, width = [], [], len(across)
    for k, went in enumerate(steps_to_leave):
        sensitivity = Sensitivity.from_distances(times, distances[: len(times), k].tolist())
        kinds.append(_kind(sensitivity, went > 0, is_defined[k]))
        rates.append(None if went else f"{sensitivity.exponent:.2g}")
    return OrbitMapResult(
        **hamiltonian.texts,
        scheme=scheme,
        axes=axes,
        across=tuple(map(text, across)),
        upwards=tuple(map(text, upwards)),
        **start_texts(hamiltonian, point, t0),
        step_size=text(step_size),
        steps=steps,
        beyond=text(beyond),
        every=orbits.every,
        kinds=_rows(kinds, width),
        left=_rows([int(n) or None for n in steps_to_leave], width),
        lyapunov=_rows(rates, width),
        defects=_rows(_defects(orbits, steps_to_leave == 0), width),
        energies=_rows(energies, width),
    )


def _kind(sensitivity: Sensitivity, has_left: bool, is_defined: bool) -> OrbitKind:
    if not is_defined:
        return "undecided"
    return "leaves" if has_left else _KINDS[sensitivity.exponential]


def _defects(orbits: Orbits, stays: np.ndarray) -> list[str | None]:
    """Return the defects of the orbits that stay, to some digits; "0" if that is proved."""
    hamiltonian, count = orbits.hamiltonian, len(stays)
    if step_map_of(hamiltonian, orbits.scheme).preserves_area:
        return ["0" if x else None for x in stays]
    texts: list[str | None] = [None] * count
    if carries_defect(hamiltonian) and stays.any():
        indices = np.flatnonzero(stays)
        for k, x in zip(indices, orbits.defects(indices), strict=True):
            texts[k] = f"{x:.2e}" if np.isfinite(x) else None
    return texts


def _energies(
    hamiltonian: Hamiltonian, points: Sequence[Mapping[str, Fraction]]
) -> list[str | None]:
    """Return H at the starts; None if it is not defined, or depends on time."""
    if hamiltonian.time_dependent:
        return [None] * len(points)
    columns = list(zip(*(point.values() for point in points), strict=True))
    energies = energies_at(hamiltonian, 20, columns)
    return [None if x is None else decimal(fraction(x), 6) for x in energies]


def _rows(values: Sequence[_T], width: int) -> tuple[tuple[_T, ...], ...]:
    return tuple(tuple(values[k : k + width]) for k in range(0, len(values), width))
