"""Every smooth H at once: its partial derivatives H_ij = ∂_pⁱ∂_q^j H as independent variables.

At a point the derivatives of a smooth H up to any order may take any values (those of a polynomial
are free already). So a polynomial in the H_ij vanishes for every H at every point exactly where it
is the zero polynomial, and zero needs no decision. ∂/∂p sends H_ij to H_(i+1)j, ∂/∂q to H_i(j+1),
and X = H_p ∂_q − H_q ∂_p is the derivative along the flow. For separable H = T(p) + V(q) the mixed
derivatives are 0. Of an H that depends on t, D = ∂_t + X takes the place of X.

A scheme for every H is a pair of series in h over these polynomials: lists of the coefficients of
h⁰, h¹, …, cut off at the same power.

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

_MOST_JETS = 4000
Poly = flint.fmpq_mpoly
Series = list[Poly]
Index = tuple[int, ...]  # how often by each variable


class JetsInDegrees(Polynomials):
    """The ring of the variables and of H's derivatives of orders 1 … `order`.

    `separable`: H = T(p) + V(q), whose mixed derivatives are 0. `timed`: t is one more variable.
    Raises LimitError for more derivatives than a computer can hold polynomials in. It is a
    `verify.algebra.series.power_series.CoefficientRing`.
    """

    def __init__(
        self, names: Sequence[str], order: int, *, separable: bool = False, timed: bool = False
    ) -> None:
        self.variables = (*names, "t") if timed else tuple(names)
        self.order, self._half, self.separable = order, len(names) // 2, separable
        kinds, by = (2, self._half + timed) if separable else (1, len(self.variables))
        count = kinds * math.comb(by + order, order)
        if count > _MOST_JETS:
            problem = f"about {count} derivatives of H would be needed; allowed: {_MOST_JETS}"
            raise LimitError("degrees", self._half, problem)
        self.indices = [x for n in range(1, order + 1) for x in self._of_order(n)]
        written = [self._called(index) for index in self.indices]
        super().__init__([*self.variables, *written], ordering=flint.Ordering.degrevlex)
        self._at = {index: len(self.variables) + k for k, index in enumerate(self.indices)}

    def _of_order(self, n: int) -> Iterator[Index]:
        places = range(len(self.variables))
        for chosen in combinations_with_replacement(places, n):
            index = tuple(map(chosen.count, places))
            if not self._vanishes(index):
                yield index

    def _vanishes(self, index: Index) -> bool:
        half = self._half
        return self.separable and any(index[:half]) and any(index[half : 2 * half])

    def _called(self, index: Index) -> str:
        return "H_" + "".join(name * n for name, n in zip(self.variables, index, strict=True))

    def of(self, index: Index) -> Poly:
        """That derivative of H."""
        if self._vanishes(index):
            return self.zero
        if sum(index) > self.order:
            raise OverflowError(f"a derivative of order {sum(index)} of H; there are {self.order}")
        return self.gens[self._at[index]]

    def first(self, name: str) -> Poly:
        """∂H/∂name."""
        return self.of(tuple(int(other == name) for other in self.variables))

    # -- as a ring ----------------------------------------------------------------------------

    def diff(self, x: Poly, name: str) -> Poly:
        """The partial derivative by a variable, which sends H's derivatives to the next."""
        by, count = self.places[name], len(self.variables)
        total = x.derivative(by)
        for at, degree in enumerate(x.degrees()[count:], count):
            if degree > 0:  # −1 of zero
                index = list(self.indices[at - count])
                index[by] += 1
                total += x.derivative(at) * self.of(tuple(index))
        return total

    def decide(self, x: Poly) -> Decision:
        """Zero where x is the zero polynomial; else some polynomial H gives it another value."""
        return Decision(bool(x.is_zero()))

    def vanishes(self, x: Poly) -> bool:
        """Whether x is the zero polynomial."""
        return bool(x.is_zero())

    def text(self, x: Poly) -> str:
        """x as a formula."""
        return str(x).replace("^", "**")


class Jets(JetsInDegrees):
    """Those of H(p, q): p, q and H_ij for 1 ≤ i + j ≤ `order`; OverflowError for a derivative
    beyond. `timed`: of H(p, q, t), with t and H_ijk = ∂_pⁱ∂_q^j∂_t^k H, i + j ≥ 1.

    >>> jets = Jets(2)
    >>> jets.text(jets.diff(jets.h(1, 0) ** 2, "q"))
    '2*H_p*H_pq'
    """

    def __init__(self, order: int, *, separable: bool = False, timed: bool = False) -> None:
        self.timed = timed
        super().__init__(("p", "q"), order, separable=separable, timed=timed)
        self.p, self.q = self.gens[:2]

    def _of_order(self, n: int) -> Iterator[Index]:
        """Those by t alone occur in no derivative along the flow."""
        if not self.timed:
            return super()._of_order(n)
        return ((n - k - j, j, k) for k in range(n) for j in range(n - k + 1))

    def h(self, i: int, j: int, k: int = 0) -> Poly:
        """∂_pⁱ ∂_q^j ∂_t^k H, which is 0 for k > 0 where H does not depend on time."""
        if self.timed:
            return self.of((i, j, k))
        return self.zero if k else self.of((i, j))

    def product(self, indices: Iterable[Index]) -> Poly:
        """The product of these derivatives."""
        return math.prod(map(self.of, indices), start=self.one)
