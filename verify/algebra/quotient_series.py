"""The power series in h of elements that are quotients of polynomials in h.

So is a step of a scheme that solves linear equations. With D = d₀ + d₁ h + …, d₀ a number, the
series r₀ + r₁ h + … of 1/D is r₀ = 1/d₀, r_n = −(d₁ r_{n−1} + … + d_n r₀)/d₀: no derivative of a
quotient is made, which would have more terms with each order.
"""

from verify.algebra.ring import Poly, Ring

Series = list[Poly]


class QuotientSeries:
    """The first `length` coefficients at h = 0 of a ring's elements."""

    def __init__(self, ring: Ring, length: int) -> None:
        self.ring, self.length = ring, length
        self._by_index = {g.index: g for g in ring.generators}
        self._known: dict[int, Series | None] = {}

    def of(self, x: Poly) -> Series | None:
        """Those of x; None where h is in another function, or a divisor is no number at h = 0."""
        inner = self._with_h(x)
        if inner is None:
            return self._polynomial(x)
        own = self._inverse(inner)
        if own is None:
            return None
        total, power = [self.ring.zero] * self.length, 0
        factor = [self.ring.one, *total[1:]]
        for n, coefficient in sorted(self.ring.split(x, inner).items()):
            while power < n:
                factor, power = self._product(factor, own), power + 1
            part = self.of(coefficient)
            if part is None:
                return None
            total = [a + b for a, b in zip(total, self._product(part, factor), strict=True)]
        return total

    def _with_h(self, x: Poly) -> int | None:
        """The newest generator in x that has h in its argument."""
        degrees = x.degrees()
        for g in reversed(self.ring.generators):
            if degrees[g.index] and g.argument is not None and self.ring.depends(g.argument, "h"):
                return g.index
        return None

    def _inverse(self, index: int) -> Series | None:
        if index not in self._known:
            self._known[index] = self._of_inverse(index)
        return self._known[index]

    def _of_inverse(self, index: int) -> Series | None:
        g = self._by_index[index]
        divisor = self.of(g.inner) if g.kind == "inverse" else None
        if divisor is None or divisor[0].is_zero() or not divisor[0].is_constant():
            return None
        first = 1 / divisor[0].leading_coefficient()
        found = [self.ring.one * first]
        for n in range(1, self.length):
            terms = (divisor[k] * found[n - k] for k in range(1, n + 1))
            found.append(self.ring.reduce(sum(terms, self.ring.zero) * -first))
        return found

    def _polynomial(self, x: Poly) -> Series:
        powers = self.ring.powers(x, "h")
        return [powers.get(n, self.ring.zero) for n in range(self.length)]

    def _product(self, x: Series, y: Series) -> Series:
        zero = self.ring.zero
        return [
            self.ring.reduce(sum((x[k] * y[n - k] for k in range(n + 1)), zero))
            for n in range(self.length)
        ]
