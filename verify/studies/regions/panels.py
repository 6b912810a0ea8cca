"""Gauss–Legendre panels on a curve: nodes, and the area that the interpolating polynomials sweep.

On a panel x and y are the polynomials of degree n − 1 through its n nodes, and ½ ∫ (x dy − y dx) is
Σ x_i S_ij y_j with S antisymmetric, exactly: the integrand is of degree 2n − 3, and the rule is
exact up to 2n − 1. Where the curve is analytic the error falls exponentially as panels are halved
and nodes added; corners belong at the ends of panels.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from math import prod
from typing import Any

import numpy as np
from mpmath.ctx_mp import MPContext

from verify.arithmetic.exact import of_mpf

Number = Any  # of an mpmath context
NODES = 16
_GUARD = 40  # bits, of which Newton's method and differences of nodes take a few


@dataclass(frozen=True)
class Rule:
    """On 0 ≤ s ≤ 1: nodes and weights, and 2^bits S rounded to whole numbers."""

    bits: int
    nodes: tuple[Fraction, ...]
    weights: tuple[Fraction, ...]
    derivative: tuple[tuple[Fraction, ...], ...]  # y'(s_i) = Σ_j derivative[i][j] y_j
    swept: np.ndarray  # (n, n), of int

    def areas(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """½ ∫ (x dy − y dx) of each panel, times 2^(2k + bits), for whole x, y: (panels, n), 2^k.

        Sums of whole numbers: nothing is rounded.
        """
        summed: np.ndarray = ((x @ self.swept) * y).sum(axis=1)
        return summed


@cache
def rule(bits: int) -> Rule:
    """The rule whose numbers are good to 2^−bits."""
    mp = MPContext()
    mp.prec = bits + _GUARD
    points = [_node(mp, k) for k in range(NODES)]
    nodes = [(1 - x) / 2 for x, _ in points]
    weights = [1 / ((1 - x * x) * slope * slope) for x, slope in points]
    d = _derivative(nodes)
    swept = np.array(
        [
            [
                int(mp.nint(mp.ldexp(weights[i] * d[i][j] - weights[j] * d[j][i], bits - 1)))
                for j in range(NODES)
            ]
            for i in range(NODES)
        ],
        dtype=object,
    )
    return Rule(bits, _exact(nodes), _exact(weights), tuple(map(_exact, d)), swept)


def _node(mp: MPContext, k: int) -> tuple[Number, Number]:
    """The k-th root of Legendre's polynomial, from the right, and the derivative there."""
    x = mp.cos(mp.pi * (4 * k + 3) / (4 * NODES + 2))
    for _ in range(mp.prec.bit_length() + 3):
        before, value = mp.mpf(1), x
        for n in range(1, NODES):
            before, value = value, ((2 * n + 1) * x * value - n * before) / (n + 1)
        slope = NODES * (before - x * value) / (1 - x * x)
        x = x - value / slope
    return x, slope


def _derivative(nodes: Sequence[Number]) -> list[list[Number]]:
    """The differentiation matrix of interpolation at these nodes, by barycentric weights."""
    n = len(nodes)
    weight = [1 / prod(nodes[i] - nodes[j] for j in range(n) if j != i) for i in range(n)]
    d = [
        [0 if i == j else weight[j] / weight[i] / (nodes[i] - nodes[j]) for j in range(n)]
        for i in range(n)
    ]
    for i in range(n):
        d[i][i] = -sum(d[i])
    return d


def _exact(values: Sequence[Number]) -> tuple[Fraction, ...]:
    return tuple(map(of_mpf, values))


@cache
def interpolation(count: int) -> np.ndarray:
    """(count, n) matrix in float64: values at s = 0, 1/count, … from those at a panel's nodes."""
    nodes = np.array([float(x) for x in rule(53).nodes])
    targets = np.arange(count) / count
    apart = nodes[:, None] - nodes[None, :] + np.eye(NODES)
    weight = 1 / apart.prod(axis=1)
    # s = k/count is no node: the roots of Legendre's polynomials, but 0, are irrational.
    terms = weight / (targets[:, None] - nodes[None, :])
    matrix: np.ndarray = terms / terms.sum(axis=1, keepdims=True)
    return matrix
