"""Every smooth H(p, q, t) at once: H_ijk = ∂_pⁱ∂_q^j∂_t^k H as independent variables.

As in `verify.algebra.series.jets`, at a point they may take any values, so that what vanishes for
every H is the zero polynomial. The derivative along the flow is D = ∂_t + H_p ∂_q − H_q ∂_p, and
∂_t sends H_ijk to H_ij(k+1).
"""

from verify.algebra.series.jets import JetRing, Poly

_STEPS = {"p": (1, 0, 0), "q": (0, 1, 0), "t": (0, 0, 1)}


class TimedJets(JetRing):
    """The ring of p, q and H_ijk, i + j ≥ 1, i + j + k ≤ `order`; KeyError for one beyond."""

    def __init__(self, order: int) -> None:
        self.order = order
        self.indices = [
            (n - k - j, j, k)
            for n in range(1, order + 1)
            for k in range(n)
            for j in range(n - k + 1)
        ]
        super().__init__(
            ["p", "q", *("H_" + "p" * i + "q" * j + "t" * k for i, j, k in self.indices)]
        )
        self._at = {index: n + 2 for n, index in enumerate(self.indices)}

    def h(self, i: int, j: int, k: int = 0) -> Poly:
        """H_ijk."""
        return self.gens[self._at[i, j, k]]

    def diff(self, x: Poly, name: str) -> Poly:
        """∂x/∂p, ∂x/∂q or ∂x/∂t."""
        di, dj, dk = _STEPS[name]
        total = self.zero if name == "t" else x.derivative("pq".index(name))
        for at, degree in enumerate(x.degrees()[2:], 2):
            if degree > 0:  # −1 of zero
                i, j, k = self.indices[at - 2]
                total += x.derivative(at) * self.h(i + di, j + dj, k + dk)
        return total

    def derive(self, x: Poly) -> Poly:
        """D x, the derivative along the flow."""
        along = self.h(1, 0) * self.diff(x, "q") - self.h(0, 1) * self.diff(x, "p")
        return along + self.diff(x, "t")
