"""The power series in h of elements that are quotients of polynomials in h.

The step of a scheme that solves linear equations is such a quotient. With D = d₀ + d₁ h + …, d₀ a
number, the series r₀ + r₁ h + … of 1/D is r₀ = 1/d₀, r_n = −(d₁ r_{n−1} + … + d_n r₀)/d₀: no
derivative of a quotient is needed, which would have more terms with each order.
"""

from verify.algebra.identities.polynomials import split
from verify.algebra.ring import Poly, Ring
from verify.algebra.series.power_series import Series


class QuotientSeries:
    """An expander of a ring's elements to their first `length` coefficients at h = 0."""

    def __init__(self, ring: Ring, length: int) -> None:
        self.ring, self.most = ring, length - 1
        self._by_index = {g.index: g for g in ring.generators}
        self._cache: dict[int, Series | None] = {}

    def expand(self, x: Poly) -> Series | None:
        """Expand x; None where h is in another function, or a divisor is no number at h = 0."""
        inner = self._with_h(x)
        if inner is None:
            powers = self.ring.powers(x, "h")
            return self._series([powers.get(n, self.ring.zero) for n in range(self.most + 1)])
        inverse = self._inverse(inner)
        if inverse is None:
            return None
        total, factor, power = self._series([]), self._series([self.ring.one]), 0
        for n, coefficient in sorted(split(x, inner).items()):
            while power < n:
                factor, power = factor * inverse, power + 1
            part = self.expand(coefficient)
            if part is None:
                return None
            total += part * factor
        return total

    def _series(self, coefficients: list[Poly]) -> Series:
        return Series.from_coefficients(self.ring, coefficients, self.most)

    def _with_h(self, x: Poly) -> int | None:
        """Return the newest generator in x that has h in its argument; None without one."""
        degrees = x.degrees()
        for g in reversed(self.ring.generators):
            if degrees[g.index] and g.argument is not None and self.ring.depends(g.argument, "h"):
                return g.index
        return None

    def _inverse(self, index: int) -> Series | None:
        if index not in self._cache:
            g = self._by_index[index]
            divisor = self.expand(g.inner) if g.kind == "inverse" else None
            self._cache[index] = None if divisor is None else self._one_over(divisor)
        return self._cache[index]

    def _one_over(self, divisor: Series) -> Series | None:
        begin = divisor.coefficients[0]
        # The recursion divides by d₀ in every order, which must be a number other than 0.
        if begin.is_zero() or not begin.is_constant():
            return None
        first = 1 / begin.leading_coefficient()
        return self._series([self.ring.one]).divide_by(divisor, self.ring.one * first)
