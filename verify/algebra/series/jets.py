"""Every smooth H at once: its partial derivatives H_ij = ∂_pⁱ∂_q^j H as independent variables.

At a point the derivatives of a smooth H up to any order may take any values (those of a polynomial
are free already). So a polynomial in the H_ij vanishes for every H at every point exactly where it
is the zero polynomial, and zero needs no decision. ∂/∂p sends H_ij to H_(i+1)j, ∂/∂q to H_i(j+1),
and X = H_p ∂_q − H_q ∂_p is the derivative along the flow. For separable H = T(p) + V(q) the mixed
derivatives are 0. Of an H that depends on t, D = ∂_t + X takes the place of X.

A scheme for every H is a pair of series in h over these polynomials: lists of the coefficients of
h⁰, h¹, …, cut off at the same power.
"""

from collections.abc import Iterator, Sequence

import flint

from verify.algebra.series.jets_in_degrees import Index, JetsInDegrees

Poly = flint.fmpq_mpoly
Series = list[Poly]


class JetRing(JetsInDegrees):
    """The ring of p, q and derivatives of H in the plane; `timed`: H depends on t."""

    def __init__(self, order: int, *, separable: bool = False, timed: bool = False) -> None:
        super().__init__(("p", "q"), order, separable=separable, timed=timed)
        self.timed, self.names = timed, self.context.names()
        self.p, self.q = self.gens[:2]

    def h(self, i: int, j: int, k: int = 0) -> Poly:
        """∂_pⁱ ∂_q^j ∂_t^k H, which is 0 for k > 0 where H does not depend on time."""
        if self.timed:
            return self.of((i, j, k))
        return self.zero if k else self.of((i, j))

    def derive(self, x: Poly) -> Poly:
        """The derivative along the flow: X x, or D x where H depends on time."""
        along = self.h(1, 0) * self.diff(x, "q") - self.h(0, 1) * self.diff(x, "p")
        return along + self.diff(x, "t") if self.timed else along

    def delta_j(self, p_next: Sequence[Poly], q_next: Sequence[Poly]) -> Iterator[Poly]:
        """The coefficients of h¹, h², … in det ∂(p', q')/∂(p, q), as far as the series reach."""
        gradients = [[(self.diff(x, "p"), self.diff(x, "q")) for x in s] for s in (p_next, q_next)]
        for n in range(1, len(p_next)):
            pairs = [(gradients[0][k], gradients[1][n - k]) for k in range(n + 1)]
            yield sum((a * d - b * c for (a, b), (c, d) in pairs), self.zero)


class Jets(JetRing):
    """Those of H(p, q): the ring of p, q and H_ij for 1 ≤ i + j ≤ `order`; OverflowError for a
    derivative beyond."""

    def __init__(self, order: int, *, separable: bool = False) -> None:
        super().__init__(order, separable=separable)


class TimedJets(JetRing):
    """Those of H(p, q, t): the ring of p, q, t and H_ijk = ∂_pⁱ∂_q^j∂_t^k H, i + j ≥ 1, i + j + k ≤
    `order`; KeyError for another one."""

    def __init__(self, order: int) -> None:
        super().__init__(order, timed=True)

    def _of_order(self, n: int) -> Iterator[Index]:
        """Those by t alone occur in no derivative along the flow."""
        return ((n - k - j, j, k) for k in range(n) for j in range(n - k + 1))


def shown(x: Poly) -> str:
    """A polynomial in the jets as a formula, 0 for zero.

    >>> jets = Jets(2)
    >>> shown(jets.derive(jets.h(1, 0)))
    '-H_q*H_pp + H_p*H_pq'
    """
    return str(x).replace("^", "**")
