"""Elementary differentials of f = (−H_q, H_p), and the sums of them that vanish for every H.

F(τ) = f, and F([t_1 … t_m]) = f⁽ᵐ⁾(F(t_1), …, F(t_m)); a leaf of time differentiates by t. The
trees are those of `verify.schemes.conditions.coloured_trees`, of one colour for f, or of two for
its parts (−H_q, 0) and (0, H_p).
"""

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Generic, Protocol, TypeVar

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.number import E
from verify.schemes.conditions.coloured_trees import TIME, Tree, symmetry

E_co = TypeVar("E_co", covariant=True)


class Derivatives(Protocol[E_co]):
    """The derivatives H_ijk = ∂_pⁱ ∂_q^j ∂_t^k H, and 0, in some ring."""

    @property
    def zero(self) -> E_co: ...

    def h(self, i: int, j: int, k: int = 0) -> E_co: ...


class Differentials(Generic[E]):
    """The elementary differentials F(t) over the jets or their values; `parts`: 2 for trees of two
    colours."""

    def __init__(self, jets: Derivatives[E], parts: int = 1) -> None:
        self.jets, self.parts = jets, parts
        self._cache: dict[Tree, tuple[E, E]] = {}

    def differential(self, tree: Tree) -> tuple[E, E]:
        """Return F(t), its parts in p' and in q'."""
        if tree not in self._cache:
            root, branches = tree
            times = branches.count(TIME)
            inner = [self.differential(branch) for branch in branches if branch != TIME]
            # f = (−H_q, H_p); the leaves of time raise the derivative by t, the branches are its
            # directions.
            p, q = -self._derivative(0, 1, times, inner), self._derivative(1, 0, times, inner)
            if self.parts == 2:
                p, q = (p, self.jets.zero) if root == 0 else (self.jets.zero, q)
            self._cache[tree] = p, q
        return self._cache[tree]

    def _derivative(self, i: int, j: int, k: int, along: Sequence[tuple[E, E]]) -> E:
        """Return the derivative of H_ijk along these vectors."""
        total, zero = self.jets.zero, self.jets.zero
        # Each vector has a part in p and one in q, which pick ∂_p or ∂_q of H.
        for parts in product((0, 1), repeat=len(along)):
            term = self.jets.h(i + parts.count(0), j + parts.count(1), k)
            for vector, part in zip(along, parts, strict=True):
                if term == zero:
                    break
                term = term * vector[part]
            total += term
        return total


def cancels(
    ring: Ring, gaps: Mapping[Tree, Poly], differentials: Differentials[Poly]
) -> bool | None:
    """Return True if Σ gap F(t)/σ(t) is 0 for every H; None where it is not decided.

    The gaps are numbers, the differentials polynomials in the jets, of which the monomials are
    independent: each of them has to have the coefficient 0.
    """
    totals: dict[tuple[int, tuple[int, ...]], Poly] = {}
    for tree, gap in gaps.items():
        if gap.is_zero():
            continue
        share = gap / symmetry(tree)
        for part, x in enumerate(differentials.differential(tree)):
            for monomial, coefficient in terms_of(x):
                key = part, monomial
                totals[key] = totals.get(key, ring.zero) + share * coefficient
    zeros = {ring.decide(x).zero for x in totals.values()}
    return False if False in zeros else None if None in zeros else True
