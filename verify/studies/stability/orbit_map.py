"""What the orbits of a scheme do over two of their initial values, in float64.

All orbits are stepped at once, and with each a neighbour that starts 10⁻⁹ of the greatest start
away. After every so many steps it is seen which have left, and how far neighbours have parted:
where that grows exponentially the orbit is sensitive (`verify.runs.tangent_growth`). It is the
scheme's own map that is looked at, at this step size. Where that is not proved to be symplectic, W
of those that stay is measured too.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

import numpy as np

from verify import arithmetic as number_systems
from verify.arithmetic.exact import decimal, fraction, text
from verify.arithmetic.systems import float64
from verify.flows.functions import energies_at
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import Given, point_of, start_texts
from verify.kernels.many_points import PointMap
from verify.kernels.step.computation import step_map_of
from verify.scenes.observables import carries_defect
from verify.scenes.results.stability import OrbitKind, OrbitMapResult
from verify.studies.stability.exact_motion import Sensitivity

_SECTIONS = 64  # stretches after which orbits are looked at
_NEAR = 1e-9  # of the greatest start, a neighbour
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
        return -(-self.steps // _SECTIONS)

    @property
    def names(self) -> tuple[str, ...]:
        return self.hamiltonian.coordinates

    @property
    def _sizes(self) -> float:
        return float(np.abs(self.starts).max()) or 1.0

    def stretches(self) -> Iterator[tuple[int, int]]:
        """From which step on, and how many steps."""
        for first in range(0, self.steps, self.every):
            yield first, min(self.every, self.steps - first)

    def map_from(self, first: int, steps: int, *observables: str) -> PointMap:
        return PointMap(
            self.hamiltonian, self.scheme, step_size=self.step_size, steps=steps,
            arithmetic=number_systems.get(float64.NAME, 17),
            t0=self.t0 + first * self.step_size, observables=frozenset(observables),
        )  # fmt: skip

    def followed(self) -> tuple[np.ndarray, np.ndarray]:
        """After how many steps each was seen to have left, or 0; and how far its neighbour was at
        each time, in parts of the greatest start, nan from there on."""
        count = self.starts.shape[1]
        left = np.zeros(count, dtype=int)
        apart = np.full((_SECTIONS + 1, count), np.nan)
        size = len(self.names)
        direction = np.array([(-1) ** k / (1 + k) for k in range(size)])[:, None]
        z, near = self.starts, self.starts + _NEAR * self._sizes * direction
        apart[0] = _distance(z, near, self._sizes)
        staying = np.arange(count)
        for k, (first, steps) in enumerate(self.stretches(), start=1):
            both = self.map_from(first, steps).followed(np.hstack([z, near]))[:size]
            z, near = np.hsplit(both, 2)
            kept = (np.abs(z) <= self.beyond).all(axis=0)  # nan is not
            left[staying[~kept]] = first + steps
            staying, z, near = staying[kept], z[:, kept], near[:, kept]
            if not len(staying):
                break
            apart[k, staying] = _distance(z, near, self._sizes)
        return left, apart

    def defects(self, which: np.ndarray) -> np.ndarray:
        """max |W| of these orbits after all steps, in the plane |Λ|."""
        made = self.map_from(0, self.steps, self.hamiltonian.structure.of_run)
        rows = [k for k, n in enumerate(made.kernel.state_names) if n == "lam" or n[:2] == "w_"]
        entries = made.followed(self.starts[:, which])[rows]
        greatest: np.ndarray = np.abs(entries).max(axis=0)
        return greatest


def _distance(one: np.ndarray, other: np.ndarray, size: float) -> np.ndarray:
    found: np.ndarray = np.abs(one - other).max(axis=0) / size
    return np.where(np.isfinite(found), found, 1 / _NEAR)  # a neighbour that has left


def orbit_map(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    axes: tuple[str, str],
    across: Sequence[Fraction],
    upwards: Sequence[Fraction],
    q: Given,
    p: Given,
    step_size: Fraction,
    steps: int,
    beyond: Fraction,
    t0: Fraction | None = None,
) -> OrbitMapResult:
    """Orbits from the point (q, p) with these values of its two `axes`, a row for each of the
    second's.
    """
    point = point_of(hamiltonian, q, p)
    points = [point | {axes[0]: x, axes[1]: y} for y in upwards for x in across]
    starts = np.array([[float(at[name]) for at in points] for name in hamiltonian.coordinates])
    orbits = Orbits(hamiltonian, scheme, step_size, steps, t0 or Fraction(0), starts, float(beyond))
    energies = _energies(hamiltonian, points)
    left, apart = orbits.followed()
    times = [0.0] + [float((a + n) * step_size) for a, n in orbits.stretches()]
    known = [energy is not None or hamiltonian.time_dependent for energy in energies]
    kinds, rates, width = [], [], len(across)
    for k, went in enumerate(left):
        seen = Sensitivity.of(times, apart[: len(times), k].tolist())
        kinds.append(_kind(seen, went > 0, known[k]))
        rates.append(None if went else f"{seen.exponent:.2g}")
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
        left=_rows([int(n) or None for n in left], width),
        lyapunov=_rows(rates, width),
        defects=_rows(_defects(orbits, left == 0), width),
        energies=_rows(energies, width),
    )


def _kind(seen: Sensitivity, left: bool, defined: bool) -> OrbitKind:
    if not defined:
        return "undecided"
    return "leaves" if left else _KINDS[seen.exponential]


def _defects(orbits: Orbits, stays: np.ndarray) -> list[str | None]:
    """Of those that stay, to some digits; "0" of all where that is proved."""
    of, count = orbits.hamiltonian, len(stays)
    if step_map_of(of, orbits.scheme).preserves_area:
        return ["0" if x else None for x in stays]
    found: list[str | None] = [None] * count
    if carries_defect(of) and stays.any():
        which = np.flatnonzero(stays)
        for k, x in zip(which, orbits.defects(which), strict=True):
            found[k] = f"{x:.2e}" if np.isfinite(x) else None
    return found


def _energies(
    hamiltonian: Hamiltonian, points: Sequence[Mapping[str, Fraction]]
) -> list[str | None]:
    """H at the starts; None where it is not defined, or depends on time."""
    if hamiltonian.time_dependent:
        return [None] * len(points)
    columns = list(zip(*(point.values() for point in points), strict=True))
    found = energies_at(hamiltonian, 20, columns)
    return [None if x is None else decimal(fraction(x), 6) for x in found]


def _rows(values: Sequence[_T], width: int) -> tuple[tuple[_T, ...], ...]:
    return tuple(tuple(values[k : k + width]) for k in range(0, len(values), width))
