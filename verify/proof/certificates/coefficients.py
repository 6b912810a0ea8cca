"""Schemes for every H given by coefficients, and the conditions that make them symplectic.

A coefficient is a rational number, or a polynomial in the certificate's `numbers`. Such a
polynomial is shown to be 0 by reducing it by the numbers' own polynomials.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement

from verify.proof.certificates.named_numbers import AlgebraicNumber, QuotientRing, read_numbers
from verify.proof.certificates.readers import (
    CoordinateLayout,
    Poly,
    UnreadEntries,
    array_of,
    need,
    number_of,
    object_of,
    poly_of,
)

ONE: Poly = {(): Fraction(1)}
_MOST_ROWS = 1000  # limit of the rows of `stages`
_MOST_STAGES = 32  # limit of the stages of a tableau


@dataclass(frozen=True)
class Stages:
    """Rows (kick, drift, share of p', share of q') of a scheme for every H.

    `times`: the time of each row, in parts of h from the step's start; None if H has no time.
    Coefficients are reduced by the polynomials of `numbers`.
    """

    separable: bool
    rows: tuple[tuple[Poly, Poly, Poly, Poly], ...]
    times: tuple[Poly, ...] | None
    layout: CoordinateLayout
    numbers: tuple[AlgebraicNumber, ...]


@dataclass(frozen=True)
class ButcherTableau:
    """A Runge–Kutta method for every H: `rows` are a_ij, `weights` b_i; see also `Stages`."""

    separable: bool
    rows: tuple[tuple[Poly, ...], ...]
    weights: tuple[Poly, ...]
    times: tuple[Poly, ...] | None
    layout: CoordinateLayout
    numbers: tuple[AlgebraicNumber, ...]


def read_coefficients(entries: UnreadEntries, kind: str) -> Stages | ButcherTableau:
    """Read the scheme under the key `kind`, "stages" or "tableau"."""
    need(entries.take("hamiltonian") == "every", f"{kind}: are those of every hamiltonian")
    reader = _CoefficientReader(entries, kind)
    scheme = reader.stages() if kind == "stages" else reader.tableau()
    unused = min(reader.unused, default=None)
    need(unused is None, f"numbers: nothing asks for {unused}")
    return scheme


class _CoefficientReader:
    def __init__(self, entries: UnreadEntries, kind: str) -> None:
        self.entries, self.kind = entries, kind
        self.separable = entries.flag("separable")
        self.numbers = read_numbers(entries.take("numbers")) if "numbers" in entries.unread else ()
        self.ring = QuotientRing(self.numbers)
        self.unused = {number.name for number in self.numbers}

    def stages(self) -> Stages:
        rows = array_of(self.entries.take("stages"), "stages")
        need(0 < len(rows) <= _MOST_ROWS, f"stages: has 1 to {_MOST_ROWS} rows")
        coefficients, times = [], []
        for row in rows:
            kick, drift, at_p, at_q, *time = self.row(row, 4 + self.entries.timed)
            coefficients.append((kick, drift, at_p, at_q))
            times += time
        clock = tuple(times) if self.entries.timed else None
        return Stages(self.separable, tuple(coefficients), clock, self.entries.layout, self.numbers)

    def tableau(self) -> ButcherTableau:
        entries = dict(object_of(self.entries.take("tableau"), "tableau"))
        keys = ("a", "b", *("c",) * self.entries.timed)
        need(set(entries) == set(keys), f"tableau: has {', '.join(keys)}")
        rows = array_of(entries["a"], "tableau")
        need(0 < len(rows) <= _MOST_STAGES, f"tableau: has 1 to {_MOST_STAGES} rows")
        coefficients = tuple(self.row(row, len(rows)) for row in rows)
        weights = self.row(entries["b"], len(rows))
        times = self.row(entries["c"], len(rows)) if self.entries.timed else None
        return ButcherTableau(
            self.separable, coefficients, weights, times, self.entries.layout, self.numbers
        )

    def row(self, data: object, length: int) -> tuple[Poly, ...]:
        numbers = array_of(data, self.kind)
        need(len(numbers) == length, f"{self.kind}: a row has {length} numbers")
        return tuple(map(self.coefficient, numbers))

    def coefficient(self, data: object) -> Poly:
        if not isinstance(data, list):
            number = number_of(data, self.kind)
            return {(): number} if number else {}
        return self.ring.reduce(poly_of(data, self.kind, self.use_name))

    def use_name(self, name: str) -> bool:
        # Every number of the certificate must be used in a coefficient; see `read_coefficients`.
        self.unused.discard(name)
        return any(name == number.name for number in self.numbers)


# -- conditions of symplecticity ------------------------------------------------------------------


def check_coefficients(entries: Stages | ButcherTableau) -> None:
    """Check the conditions of symplecticity; ValueError names one that does not hold."""
    ring = QuotientRing(entries.numbers)
    if isinstance(entries, ButcherTableau):
        for name, residual in residuals_of_tableau(entries, ring):
            need(not residual, f"tableau: {name} is not zero")
        return
    need(not any(residuals_of_stages(entries, ring)), "det A is not det B")


def residuals_of_stages(entries: Stages, ring: QuotientRing) -> Iterator[Poly]:
    """Yield k d (1 − s − u) and, unless H is separable, k − d; if all are 0, det J = 1 and S = 0.

    By implicit differentiation A J = B with det A = 1 + h b (k s − d u) + h² k d s u (a c − b²),
    a, b, c = H_pp, H_pq, H_qq at the stage's point, and det B the same with s − 1 and u − 1.

    In n degrees of freedom: with K = k V + d T for H = T + V, or K = k H for k = d, the stage is
    that of K with k = d = 1; if k d = 0, what moves does so by a gradient in the other variables.
    With P, Q the point and δ = d(z' − z), dP∧dK_P + dQ∧dK_Q = −d(dK) = 0 leaves
    dp'∧dq' − dp∧dq = (1 − s − u) δp∧δq.
    """
    for k, d, s, u in entries.rows:
        share = ring.sum((1, ONE), (-1, s), (-1, u))
        yield ring.product(ring.product(k, d), share)
        yield {} if entries.separable else ring.sum((1, k), (-1, d))


def residuals_of_tableau(entries: ButcherTableau, ring: QuotientRing) -> Iterator[tuple[str, Poly]]:
    """Yield M_ij = b_i a_ij + b_j a_ji − b_i b_j with its name, i ≤ j; if all are 0, S = 0.

    With F = −H_q and G = H_p at each stage's point (P, Q) and time, P_i = p + h Σ a_ij F_j and
    p' = p + h Σ b_i F_i, likewise with Q, q and G:

        dp'∧dq' − dp∧dq = h Σ b_i (dP_i∧dG_i + dF_i∧dQ_i) − h² Σ M_ij dF_i∧dG_j,

    and dP∧dH_p + dQ∧dH_q = −d(dH) = 0 at each stage, as its time does not depend on (p, q).
    """
    a, b = entries.rows, entries.weights
    for i, j in combinations_with_replacement(range(len(b)), 2):
        first, second = ring.product(b[i], a[i][j]), ring.product(b[j], a[j][i])
        residual = ring.sum((1, first), (1, second), (-1, ring.product(b[i], b[j])))
        m, n = i + 1, j + 1
        yield f"b_{m} a_{m}{n} + b_{n} a_{n}{m} - b_{m} b_{n}", residual
