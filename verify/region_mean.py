"""The mean of Λ over the region inside a closed curve, which is its relative change of area.

A region is swept by rays from a centre c to its curve γ: the integral of f over it is that of
f(c + r (γ − c)) r (γ − c) × γ' over 0 ≤ r ≤ 1 and the curve, for every closed curve, as what is
swept twice counts with its sign; only the map must be defined along the rays. Both integrals are by
Gauss–Legendre panels, and these are doubled until two means agree.
"""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from verify import arithmetic as number_systems
from verify.arithmetic import float64
from verify.float_context import FLOAT
from verify.hamiltonian import Hamiltonian
from verify.many_points import PointMap
from verify.outline import Outline
from verify.panels import NODES, rule

_FIRST = 8  # panels along a smooth curve
_MOST_POINTS = 70_000
_AGREED = 1e-3  # of the mean: an error that is good enough
_SAFETY = 4  # the later of two means is nearer to the truth than they are to each other
_ROUNDING = 1e-12  # of |Λ|, in float64 and ΔJ's closed form, whose errors mostly cancel in a mean


@dataclass(frozen=True)
class Mean:
    """The mean of Λ with an estimate of its error, by how much the last two means differ."""

    value: float
    error: float
    points: int


class RegionMean:
    """The mean of Λ after N steps of a scheme, over the region inside an outline, in float64."""

    def __init__(
        self, hamiltonian: Hamiltonian, scheme: str, step_size: Fraction, steps: int
    ) -> None:
        self._map = PointMap(
            hamiltonian,
            scheme,
            step_size=step_size,
            steps=steps,
            arithmetic=number_systems.get(float64.NAME, 17),
            observables=frozenset({"lambda"}),
        )

    def of(self, outline: Outline, centre: tuple[float, float]) -> Mean:
        """The mean over the region, by rays from the centre (q, p). Raises LeftError."""
        count = max(1, _FIRST // len(outline.arcs))
        rays, before = 1, None
        while True:
            x, y, weights = _cone(outline, centre, count, rays)
            lam = self._map(p=y, q=x)["lam"]
            mean = float(weights @ lam / weights.sum())
            noise = _ROUNDING * float(np.abs(weights) @ np.abs(lam) / abs(weights.sum()))
            if before is not None:
                error = _SAFETY * abs(mean - before) + noise
                if error <= _AGREED * abs(mean) or 4 * len(x) > _MOST_POINTS:
                    return Mean(mean, error, len(x))
            before, count, rays = mean, 2 * count, 2 * rays


def _cone(
    outline: Outline, centre: tuple[float, float], count: int, rays: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of the region and the area that each stands for."""
    made = rule(53)
    nodes, weights = (np.array([float(v) for v in x]) for x in (made.nodes, made.weights))
    derivative = np.array([[float(v) for v in row] for row in made.derivative])
    radius = ((np.arange(rays)[:, None] + nodes) / rays).ravel()
    along = np.tile(weights / rays, rays) * radius
    xs, ys, areas = [], [], []
    for arc in outline.arcs:
        for k in range(count):
            s = (k + nodes) / count
            x, y = (np.broadcast_to(v, (NODES,)) - c
                    for v, c in zip(arc(FLOAT, s), centre, strict=True))  # fmt: skip
            swept = (x * (derivative @ y) - y * (derivative @ x)) * weights
            xs.append(np.outer(radius, x).ravel())
            ys.append(np.outer(radius, y).ravel())
            areas.append(np.outer(along, swept).ravel())
    return np.concatenate(xs) + centre[0], np.concatenate(ys) + centre[1], np.concatenate(areas)
