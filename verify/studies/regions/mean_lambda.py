"""The mean of Λ over the region inside a closed curve, which is its relative change of area.

In n degrees of freedom it is that of W's entry at (p_i, q_i), where the region lies in the plane
(q_i, p_i): ω after N steps on the region is 1 + W_ii times ω before. In one of them W is Λ.

A region is swept by rays from a centre c to its curve γ: the integral of f over it is that of
f(c + r (γ − c)) r (γ − c) × γ' over 0 ≤ r ≤ 1 and the curve, for every closed curve, as what is
swept twice counts with its sign; only the map must be defined along the rays. Both integrals are by
Gauss–Legendre panels. Each cell of these is compared with its four quarters, and the differences
count without their signs: two sums may agree by chance where neither is right. Where a difference
matters, the quarters are quartered again.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from verify import arithmetic as number_systems
from verify.arithmetic.float_context import FLOAT
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.many_points import PointMap
from verify.kernels.step.computation import step_map_of
from verify.scenes.shapes.outline import Outline
from verify.studies.regions.panels import NODES, rule
from verify.studies.regions.point_carriers import QP_PLANE, RegionPlane

_FROM_START = Fraction(0)
_FIRST = 8  # cells along the curve, at least
_AMID = 16  # points of an arc that tell where the middle is
_MOST_POINTS = 60_000
_AGREED = 3e-3  # of the mean: an error of the cells that is good enough; the quarters' is far less
_ROUNDING = 1e-12  # of |Λ|, in float64 and ΔJ's closed form, whose errors mostly cancel in a mean
_DEFECT = 2.0**-48  # of one step's S, where that is made from J's rounded entries
_Density = Callable[[np.ndarray, np.ndarray], np.ndarray]  # of points (q, p) of the region's plane
_Cell = tuple[int, float, float, float, float]  # an arc, from where to where on it, and on the rays


@dataclass(frozen=True)
class RegionMean:
    """The mean with its error, the sum of the differences of cells and their quarters."""

    value: float
    error: float


def mean_over(
    outline: Outline,
    centre: tuple[float, float],
    hamiltonian: Hamiltonian,
    scheme: str,
    step_size: Fraction,
    steps: int,
    t0: Fraction = _FROM_START,
    plane: RegionPlane = QP_PLANE,
) -> RegionMean:
    """Return the mean of Λ after N steps of a scheme over the outline's region, in float64.

    If H depends on time the steps start at t0. In n degrees of freedom it is the mean of W, in
    `plane`. The rays start at the centre (q, p). Raises LeftRangeError.
    """
    observables = frozenset({hamiltonian.structure.of_run})
    point_map = PointMap(
        hamiltonian, scheme, step_size=step_size, steps=steps, t0=t0,
        arithmetic=number_systems.get(float64.NAME, 17), observables=observables,
    )  # fmt: skip
    entry = f"w_{plane.index}_{plane.degrees + plane.index}"
    name = entry if entry in point_map.kernel.state_names else "lam"

    def density(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        points = plane.embed(x, y, lambda value: np.full(len(x), float(value)))
        values: np.ndarray = point_map(**dict(zip(plane.names, points, strict=True)))[name]
        return values

    mean = _compute_mean(density, outline, centre)
    # Without a closed form S comes from rounded entries of J, whose rounding adds up over the
    # steps.
    has_written_defect = (
        name == "lam" or step_map_of(hamiltonian, scheme).written_defect is not None
    )
    return mean if has_written_defect else RegionMean(mean.value, mean.error + steps * _DEFECT)


def find_middle(outline: Outline) -> tuple[float, float]:
    """Return the mean of the outline's points.

    Rays from elsewhere may leave the region, where the map may not be defined.
    """
    s = (np.arange(_AMID) + 0.5) / _AMID
    points = [np.broadcast_arrays(s, *arc(FLOAT, s))[1:] for arc in outline.arcs]
    x, y = np.mean(points, axis=(0, 2))
    return float(x), float(y)


def _compute_mean(density: _Density, outline: Outline, centre: tuple[float, float]) -> RegionMean:
    region = _Region(outline, centre, density)
    count = -(-_FIRST // len(outline.arcs))
    first = [
        (arc, k / count, (k + 1) / count, 0.0, 1.0)
        for arc in range(len(outline.arcs))
        for k in range(count)
    ]
    families = region.families(first, region.sums(first))
    points = 5 * NODES**2 * len(first)  # of each cell, and of its quarters
    while True:
        area = sum(f.quarters[0].sum() for f in families)
        mean = sum(f.quarters[1].sum() for f in families) / area
        noise = _ROUNDING * sum(f.quarters[2].sum() for f in families) / abs(area)
        error = sum(f.difference(mean) for f in families) / abs(area) + noise
        share = _AGREED * abs(mean * area) / (2 * len(families))
        # Cells with more than their share of the error are cut; the share is half of what an even
        # spread allows.
        cut = [f for f in families if f.difference(mean) > share]
        points += 16 * NODES**2 * len(cut)
        if error <= _AGREED * abs(mean) or not cut or points > _MOST_POINTS:
            return RegionMean(float(mean), float(error))
        sharp = [f for f in families if f.difference(mean) <= share]
        cells = [cell for f in cut for cell in _quarters(f.cell)]
        sums = np.concatenate([f.quarters for f in cut], axis=1)
        families = sharp + region.families(cells, sums)


@dataclass(frozen=True)
class _Region:
    """The region inside an outline, swept by rays from a centre, with a density in it."""

    outline: Outline
    centre: tuple[float, float]
    density: _Density

    def families(self, cells: list[_Cell], sums: np.ndarray) -> "list[_CellFamily]":
        """Cut the cells, whose sums are known, into quarters."""
        parts = [part for cell in cells for part in _quarters(cell)]
        quarters = self.sums(parts).reshape(3, len(cells), 4)
        # Summed without signs later: two wrong totals may agree by chance, not all cells at once.
        differences = quarters.sum(axis=2) - sums
        return [
            _CellFamily(cell, quarters[:, k], differences[:, k]) for k, cell in enumerate(cells)
        ]

    def sums(self, cells: list[_Cell]) -> np.ndarray:
        """Return each cell's area and the integrals of the density and of its size: (3, cells)."""
        x, y, weights = _sample_cells(self.outline, self.centre, cells)
        lam = self.density(x, y)
        parts = np.array([weights, weights * lam, np.abs(weights * lam)])
        totals: np.ndarray = parts.reshape(3, len(cells), -1).sum(axis=2)
        return totals


@dataclass(frozen=True)
class _CellFamily:
    """A cell, the sums of its quarters (3, 4), and their differences from the cell's."""

    cell: _Cell
    quarters: np.ndarray
    differences: np.ndarray

    def difference(self, mean: float) -> float:
        """Return the difference of the integral of Λ − mean.

        Where Λ, or W, is constant no area's error matters.
        """
        return abs(float(self.differences[1] - mean * self.differences[0]))


def _quarters(cell: _Cell) -> list[_Cell]:
    arc, a, b, r, t = cell
    s, u = (a + b) / 2, (r + t) / 2
    return [(arc, a, s, r, u), (arc, a, s, u, t), (arc, s, b, r, u), (arc, s, b, u, t)]


def _sample_cells(
    outline: Outline, centre: tuple[float, float], cells: Sequence[_Cell]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points of the region and the area that each stands for, cell by cell."""
    gauss_rule = rule(53)
    nodes, weights = (
        np.array([float(v) for v in x]) for x in (gauss_rule.nodes, gauss_rule.weights)
    )
    derivative = np.array([[float(v) for v in row] for row in gauss_rule.derivative])
    xs, ys, areas = [], [], []
    for arc, a, b, inner, outer in cells:
        s, radius = a + (b - a) * nodes, inner + (outer - inner) * nodes
        curve_points = outline.arcs[arc](FLOAT, s)
        x, y = (np.broadcast_to(v, (NODES,)) - c for v, c in zip(curve_points, centre, strict=True))
        # The area swept by a ray from the centre, (γ − c) × γ' ds, by the panel's derivative
        # matrix.
        sweep = (x * (derivative @ y) - y * (derivative @ x)) * weights
        xs.append(np.outer(radius, x).ravel())
        ys.append(np.outer(radius, y).ravel())
        areas.append(np.outer((outer - inner) * weights * radius, sweep).ravel())
    return np.concatenate(xs) + centre[0], np.concatenate(ys) + centre[1], np.concatenate(areas)
