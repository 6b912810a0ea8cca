"""Gauss–Legendre panels on a curve: nodes, the area that they sweep, and points between the nodes.

On a panel x and y are the polynomials of degree n − 1 through its n nodes, and ½ ∫ (x dy − y dx) is
Σ x_i S_ij y_j with S antisymmetric, exactly: the integrand is of degree 2n − 3, and the rule is
exact up to 2n − 1. Where the curve is analytic the error falls exponentially as panels are halved
and nodes added; corners belong at the ends of panels.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from math import lcm, prod
from typing import Any

import flint
import numpy as np

from verify.arithmetic.arb import Ball, midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision

NODES = 16
_GUARD_BITS = 40  # differences of nodes cancel a few of them
_DENSE_POINTS = 40_000  # points of a dense curve, within the limits per panel
_POINTS_PER_PANEL = 16, 128  # the least and the most between the 16 nodes of a panel
_SAGITTA_FACTOR = 1.5  # an arc may be farther from its chord elsewhere than in its middle
Points = tuple[Any, ...]  # q and p, or q1 … qn and p1 … pn: a sequence of each
PanelPart = tuple[int, int, Fraction, Fraction]  # outline, arc, and its s from and to


@dataclass(frozen=True)
class Rule:
    """The rule on 0 ≤ s ≤ 1: nodes and weights, and 2^bits S rounded to whole numbers."""

    bits: int
    nodes: tuple[Fraction, ...]
    weights: tuple[Fraction, ...]
    derivative: tuple[tuple[Fraction, ...], ...]  # y'(s_i) = Σ_j derivative[i][j] y_j
    area_matrix: np.ndarray  # (n, n), of int

    def areas(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return ½ ∫ (x dy − y dx) of each panel, times 2^(2k + bits), for x, y times 2^k.

        x and y are whole, of shape (panels, n): the sums round nothing.
        """
        totals: np.ndarray = ((x @ self.area_matrix) * y).sum(axis=1)
        return totals


@cache
def rule(bits: int) -> Rule:
    """Return the rule whose numbers are good to 2^−bits."""
    with working_precision(bits + _GUARD_BITS):
        roots = [_root(k) for k in range(NODES)]
        nodes, weights = [(1 - x) / 2 for x, _ in roots], [w / 2 for _, w in roots]
        d = _derivative(nodes)
        pairs = [
            [weights[i] * d[i][j] - weights[j] * d[j][i] for j in range(NODES)]
            for i in range(NODES)
        ]
    # S_ij is half of these differences, hence bits − 1.
    scaled = [[round(x * 2 ** (bits - 1)) for x in _midpoints(row)] for row in pairs]
    area_matrix = np.array(scaled, dtype=object)
    derivative = tuple(map(_midpoints, d))
    return Rule(bits, _midpoints(nodes), _midpoints(weights), derivative, area_matrix)


@lru_cache(maxsize=8192)
def nodes_between(bits: int, start: Fraction, end: Fraction) -> tuple[Fraction, ...]:
    """Return the nodes of that rule on start ≤ s ≤ end.

    The cache serves the first cuts, which are the same for every curve.
    """
    width, (shares, common) = end - start, _nodes_over_common_denominator(bits)
    first = start.numerator * width.denominator * common
    factor = width.numerator * start.denominator
    denominator = start.denominator * width.denominator * common
    return tuple(Fraction(first + factor * share, denominator) for share in shares)


@cache
def _nodes_over_common_denominator(bits: int) -> tuple[list[int], int]:
    """Return the nodes' numerators over one denominator, and that denominator.

    A node of a part then takes one reduction of a fraction, not three.
    """
    nodes = rule(bits).nodes
    common = lcm(*(s.denominator for s in nodes))
    return [int(s * common) for s in nodes], common


def _root(k: int) -> tuple[Ball, Ball]:
    """Return the k-th root of Legendre's polynomial, from the right, and its weight on −1 … 1."""
    return flint.arb.legendre_p_root(NODES, k, weight=True)


def _derivative(nodes: Sequence[Ball]) -> list[list[Ball]]:
    """Return the differentiation matrix of interpolation at these nodes, by barycentric weights."""
    others = [[x - y for y in nodes if y is not x] for x in nodes]
    weight = [1 / prod(apart, start=Ball(1)) for apart in others]
    d = [
        [Ball(0) if y is x else weight[j] / weight[i] / (x - y) for j, y in enumerate(nodes)]
        for i, x in enumerate(nodes)
    ]
    # The derivative of a constant is 0, so that each row sums to 0.
    for i in range(len(nodes)):
        d[i][i] = -sum(d[i], Ball(0))
    return d


def _midpoints(values: Sequence[Ball]) -> tuple[Fraction, ...]:
    return tuple(midpoint_and_radius(x)[0] for x in values)


@cache
def interpolation(count: int) -> np.ndarray:
    """Return the (count, n) matrix from values at a panel's nodes to those at s = 0, 1/count, …"""
    nodes = np.array([float(x) for x in rule(53).nodes])
    targets = np.arange(count) / count
    differences = nodes[:, None] - nodes[None, :] + np.eye(NODES)
    weight = 1 / differences.prod(axis=1)
    # s = k/count is no node: the roots of Legendre's polynomials, but 0, are irrational.
    terms = weight / (targets[:, None] - nodes[None, :])
    matrix: np.ndarray = terms / terms.sum(axis=1, keepdims=True)
    return matrix


@dataclass(frozen=True)
class Panel:
    """A part of an arc of an outline with its points, and the points' images."""

    outline: int
    arc: int
    left: Fraction
    right: Fraction
    start: Points
    image: Points
    before: int  # the area that the panel sweeps, in units of the carrier's grid and of the rule
    parts: tuple[int, ...]  # the areas that its image sweeps in each plane (q_k, p_k)

    @property
    def after(self) -> int:
        """The area swept by the image, in the same units as `before`."""
        return sum(self.parts)

    @property
    def change(self) -> int:
        """The change of the area by the map, in the same units."""
        return self.after - self.before

    @property
    def halves(self) -> list[PanelPart]:
        """The two halves of its arc, not yet carried."""
        middle = (self.left + self.right) / 2
        arc = self.outline, self.arc
        return [(*arc, self.left, middle), (*arc, middle, self.right)]


@dataclass(frozen=True)
class PanelFamily:
    """A panel in halves, with the difference of their areas from the whole panel's.

    `difference`: that of the areas before the map and that after it, added without signs; `unsure`:
    that before the map alone. `stuck`: halving no longer reduces the difference.
    """

    halves: tuple[Panel, Panel]
    difference: int
    unsure: int
    parts: tuple[int, ...]  # the difference after the map, in each plane (q_k, p_k)
    stuck: bool = False

    @property
    def change(self) -> int:
        """The change of the halves' area by the map."""
        return self.halves[0].change + self.halves[1].change

    @property
    def before(self) -> int:
        """The halves' area before the map."""
        return self.halves[0].before + self.halves[1].before


def split_by_panel(points: Points) -> list[Points]:
    """Split the points of many panels into those of each."""
    cut = [slice(i, i + NODES) for i in range(0, len(points[0]), NODES)]
    return [tuple(z[part] for z in points) for part in cut]


def densify(
    panels: Sequence[tuple[np.ndarray, ...]], points: int = _DENSE_POINTS
) -> tuple[np.ndarray, float]:
    """Return about `points` points (n, 2) of a closed curve, and its distance from their chords.

    Both are interpolated from the nodes of its panels. The distance is an estimate, by a point of
    the curve midway between each two.
    """
    least, most = _POINTS_PER_PANEL
    between = min(most, max(least, points // len(panels)))
    matrix = interpolation(2 * between)
    nodes = np.array([np.stack(z, axis=1) for z in panels], dtype=np.float64).reshape(-1, NODES, 2)
    fine = np.einsum("kn,pnd->pkd", matrix, nodes).reshape(-1, 2)
    vertices, middles = fine[::2], fine[1::2]
    sagittas = middles - (vertices + np.roll(vertices, -1, axis=0)) / 2
    return vertices, float(_SAGITTA_FACTOR * np.hypot(*sagittas.T).max())
