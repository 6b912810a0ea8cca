"""The jets of every smooth H: the derivatives H_ij = ∂_pⁱ∂_q^j H as independent variables.

At a point the derivatives of a smooth H up to any order may take any values (those of polynomials H
do already). So a polynomial in the H_ij vanishes for every H at every point if and only if it is
the zero polynomial: this is easy to decide. ∂/∂p maps H_ij to H_(i+1)j, ∂/∂q maps it to H_i(j+1);
X = H_p ∂_q − H_q ∂_p is the derivative along the flow. For separable H = T(p) + V(q) the mixed
derivatives are 0. If H depends on t, D = ∂_t + X takes the place of X.

A scheme for every H is a pair of series in h over these polynomials: lists of the coefficients of
h⁰, h¹, …, up to the same power.

In n degrees of freedom the partial derivatives of a smooth H(p1 … pn, q1 … qn) are independent
variables for the same reason.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations_with_replacement

import flint

from verify.algebra.identities.polynomials import Polynomials
from verify.algebra.zero_test import Decision
from verify.errors import LimitError

_MAX_JETS = 4000
Poly = flint.fmpq_mpoly
Series = list[Poly]
Index = tuple[int, ...]  # the number of derivatives by each variable


class JetsInDegrees(Polynomials):
    """The ring of the variables and of H's derivatives of orders 1 … `order`.

    `separable`: H = T(p) + V(q), whose mixed derivatives are 0. `timed`: t is one more variable.
    Its construction raises LimitError if there are so many derivatives that polynomials in them
    would not fit in memory. It is a `verify.algebra.power_series.CoefficientRing`.
    """

    def __init__(
        self, names: Sequence[str], order: int, *, separable: bool = False, timed: bool = False
    ) -> None:
        self.variables = (*names, "t") if timed else tuple(names)
        self.order, self._half, self.separable = order, len(names) // 2, separable
        kinds, by = (2, self._half + timed) if separable else (1, len(self.variables))
        count = kinds * math.comb(by + order, order)
        if count > _MAX_JETS:
            problem = f"about {count} derivatives of H would be needed; allowed: {_MAX_JETS}"
            raise LimitError("degrees", self._half, problem)
        self.indices = [x for n in range(1, order + 1) for x in self._of_order(n)]
        names_of_derivatives = [self._name_of(index) for index in self.indices]
        super().__init__(
            [*self.variables, *names_of_derivatives], ordering=flint.Ordering.degrevlex
        )
        self._at = {index: len(self.variables) + k for k, index in enumerate(self.indices)}

    def _of_order(self, n: int) -> Iterator[Index]:
        places = range(len(self.variables))
        for chosen in combinations_with_replacement(places, n):
            index = tuple(map(chosen.count, places))
            if not self._vanishes(index):
                yield index

    def _vanishes(self, index: Index) -> bool:
        half = self._half
        # ∂_p∂_q (T(p) + V(q)) = 0; with t both T and V may depend on it.
        return self.separable and any(index[:half]) and any(index[half : 2 * half])

    def _name_of(self, index: Index) -> str:
        return "H_" + "".join(name * n for name, n in zip(self.variables, index, strict=True))

    def derivative(self, index: Index) -> Poly:
        """Return the derivative of H with this index. Raises OverflowError beyond the ring's
        order."""
        if self._vanishes(index):
            return self.zero
        if sum(index) > self.order:
            raise OverflowError(f"a derivative of order {sum(index)} of H; there are {self.order}")
        return self.gens[self._at[index]]

    def first(self, name: str) -> Poly:
        """Return ∂H/∂name."""
        return self.derivative(tuple(int(other == name) for other in self.variables))

    # -- as a ring ----------------------------------------------------------------------------

    def diff(self, x: Poly, name: str) -> Poly:
        """Return the partial derivative by a variable, which maps H_ij to the next derivatives."""
        by, count = self.places[name], len(self.variables)
        total = x.derivative(by)
        for place, degree in enumerate(x.degrees()[count:], count):
            if degree > 0:  # flint's degrees of the polynomial 0 are −1
                index = list(self.indices[place - count])
                index[by] += 1
                total += x.derivative(place) * self.derivative(tuple(index))
        return total

    def decide(self, x: Poly) -> Decision:
        """Decide whether x is 0 for every H: if and only if it is the zero polynomial."""
        return Decision(bool(x.is_zero()))

    def vanishes(self, x: Poly) -> bool:
        """Return True if x is the zero polynomial."""
        return bool(x.is_zero())

    def text(self, x: Poly) -> str:
        """Format x as a formula."""
        return str(x).replace("^", "**")


class Jets(JetsInDegrees):
    """The jets of H(p, q): p, q and H_ij for 1 ≤ i + j ≤ `order`.

    `timed`: those of H(p, q, t), with t and H_ijk = ∂_pⁱ∂_q^j∂_t^k H, i + j ≥ 1. A derivative
    beyond the order raises OverflowError.

    >>> jets = Jets(2)
    >>> jets.text(jets.diff(jets.h(1, 0) ** 2, "q"))
    '2*H_p*H_pq'
    """

    def __init__(self, order: int, *, separable: bool = False, timed: bool = False) -> None:
        self.timed = timed
        super().__init__(("p", "q"), order, separable=separable, timed=timed)
        self.p, self.q = self.gens[:2]

    def _of_order(self, n: int) -> Iterator[Index]:
        """Return an iterator over the indices of order n, without derivatives by t alone, which
        occur in no derivative along the flow."""
        if not self.timed:
            return super()._of_order(n)
        return ((n - k - j, j, k) for k in range(n) for j in range(n - k + 1))

    def h(self, i: int, j: int, k: int = 0) -> Poly:
        """Return ∂_pⁱ ∂_q^j ∂_t^k H, which is 0 for k > 0 if H does not depend on time."""
        if self.timed:
            return self.derivative((i, j, k))
        return self.zero if k else self.derivative((i, j))

    def product(self, indices: Iterable[Index]) -> Poly:
        """Return the product of these derivatives."""
        return math.prod(map(self.derivative, indices), start=self.one)
