"""The mean of Λ over the region inside a closed curve, which is its relative change of area.

Λ is det M − 1, M the product of the steps' Jacobians. In n degrees of freedom it is the mean of
the entry of W = MᵀΩM − Ω at (p_i, q_i), if the region lies in the plane (q_i, p_i): the form ω
after N steps is, on the region, 1 + W_ii times ω before. In one degree of freedom W_11 is Λ.

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
_LEAST_FIRST_CELLS = 8  # cells along the curve
_CENTRE_POINTS = 16  # points of each arc whose mean is the centre
_MAX_POINTS = 60_000
# Relative to the mean: the cells' difference from their quarters; the quarters' error is far less.
_TOLERANCE = 3e-3
# Relative to |Λ| by ΔJ's closed form in float64: such errors mostly cancel in a mean.
_ROUNDING = 1e-12
_DEFECT_ROUNDING = 2.0**-48  # S of one step from J's rounded entries
_Density = Callable[[np.ndarray, np.ndarray], np.ndarray]  # a function of (q, p) in the plane
_Cell = tuple[int, float, float, float, float]  # arc, its s from and to, the ray's r from and to


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

    If H depends on time the steps start at t0. In n degrees of freedom it is the mean of W's entry
    of `plane`. The rays start at the centre (q, p). Raises LeftRangeError.
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
    return (
        mean
        if has_written_defect
        else RegionMean(mean.value, mean.error + steps * _DEFECT_ROUNDING)
    )


def find_middle(outline: Outline) -> tuple[float, float]:
    """Return the mean of the outline's points.

    Rays from elsewhere may leave the region, where the map may not be defined.
    """
    s = (np.arange(_CENTRE_POINTS) + 0.5) / _CENTRE_POINTS
    points = [np.broadcast_arrays(s, *arc(FLOAT, s))[1:] for arc in outline.arcs]
    x, y = np.mean(points, axis=(0, 2))
    return float(x), float(y)


def _compute_mean(density: _Density, outline: Outline, centre: tuple[float, float]) -> RegionMean:
    region = _Region(outline, centre, density)
    count = -(-_LEAST_FIRST_CELLS // len(outline.arcs))
    first = [
        (arc, k / count, (k + 1) / count, 0.0, 1.0)
        for arc in range(len(outline.arcs))
        for k in range(count)
    ]
    families = region.families(first, region.sums(first))
    points = 5 * NODES**2 * len(first)  # a cell and its four quarters, each a square of nodes
    while True:
        area = sum(f.quarters[0].sum() for f in families)
        mean = sum(f.quarters[1].sum() for f in families) / area
        noise = _ROUNDING * sum(f.quarters[2].sum() for f in families) / abs(area)
        error = sum(f.difference(mean) for f in families) / abs(area) + noise
        share = _TOLERANCE * abs(mean * area) / (2 * len(families))
        # Cells with more than their share of the error are cut; the share is half of what an even
        # spread allows.
        cut = [f for f in families if f.difference(mean) > share]
        points += 16 * NODES**2 * len(cut)
        if error <= _TOLERANCE * abs(mean) or not cut or points > _MAX_POINTS:
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
        """Cut the cells, whose `sums` are computed, into quarters."""
        parts = [part for cell in cells for part in _quarters(cell)]
        quarters = self.sums(parts).reshape(3, len(cells), 4)
        # Summed without signs later: two wrong totals may agree by chance, not all cells at once.
        differences = quarters.sum(axis=2) - sums
        return [
            _CellFamily(cell, quarters[:, k], differences[:, k]) for k, cell in enumerate(cells)
        ]

    def sums(self, cells: list[_Cell]) -> np.ndarray:
        """Return each cell's area, and its integrals of Λ and of |Λ|: (3, cells)."""
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
        """Return by how much the quarters change the cell's integral of Λ − mean.

        If Λ, or W, is constant, an error of the cell's area does not count in it.
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
