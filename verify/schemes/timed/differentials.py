"""What trees with leaves of time are for H(p, q, t) in the plane: polynomials in its derivatives.

The trees are those of `verify.schemes.coloured_trees`, of one colour for f = (−H_q, H_p), or of two
for its parts (−H_q, 0) and (0, H_p).
"""

from collections.abc import Sequence
from itertools import product

import flint

from verify.schemes.coloured_trees import TIME, Tree
from verify.schemes.timed.kinetic import Kinetic

Vector = tuple[flint.fmpq_mpoly, flint.fmpq_mpoly]


class TreeJets:
    """∂_pⁱ ∂_q^j ∂_t^k H, i + j + k at most `order` + 1, free but for those of a quadratic T.

    `kinetic`: of H = T + V(q, t) with T of that class; None for every H(p, q, t). `timed`: whether
    there are derivatives by t at all.
    """

    def __init__(self, order: int, kinetic: Kinetic | None, timed: bool = True) -> None:
        indices = [
            (i, j, k)
            for i, j, k in product(range(order + 1), repeat=3)
            if 1 <= i + j <= order + 1 - k and (timed or k == 0) and _occurs(kinetic, i, j, k)
        ]
        names = ["p", *(f"H_{'p' * i}{'q' * j}{'t' * k}" for i, j, k in indices)]
        self.context = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.degrevlex)
        self.zero = self.context.constant(0)
        p, *functions = self.context.gens()
        self._known = dict(zip(indices, functions, strict=True))
        if kinetic is not None and kinetic.quadratic:
            # Of p² m(t)/2 the derivative by p is p times the second one, at every t.
            second = {k: x for (i, _, k), x in self._known.items() if i == 2}
            self._known |= {(1, 0, k): p * x for k, x in second.items()}

    def h(self, i: int, j: int, k: int) -> flint.fmpq_mpoly:
        """H_ijk."""
        return self._known.get((i, j, k), self.zero)


def _occurs(kinetic: Kinetic | None, i: int, j: int, k: int) -> bool:
    if kinetic is None or i == 0:
        return True
    of_time = k == 0 or "D" in kinetic.timed
    return j == 0 and of_time and (i <= 2 or not kinetic.quadratic)


class Differentials:
    """F(t) of f = (−H_q, H_p), or of its two parts (−H_q, 0) and (0, H_p), over the jets."""

    def __init__(self, jets: TreeJets, parts: int) -> None:
        self.jets, self.parts = jets, parts
        self._known: dict[Tree, Vector] = {}

    def of(self, tree: Tree) -> Vector:
        """F(t), what it is in p' and in q'."""
        if tree not in self._known:
            root, branches = tree
            times = branches.count(TIME)
            inner = [self.of(branch) for branch in branches if branch != TIME]
            p, q = -self._derived(0, 1, times, inner), self._derived(1, 0, times, inner)
            if self.parts == 2:
                p, q = (p, self.jets.zero) if root == 0 else (self.jets.zero, q)
            self._known[tree] = p, q
        return self._known[tree]

    def _derived(self, i: int, j: int, k: int, along: Sequence[Vector]) -> flint.fmpq_mpoly:
        """The derivative of H_ijk along these vectors."""
        total = self.jets.zero
        for parts in product((0, 1), repeat=len(along)):
            term = self.jets.h(i + parts.count(0), j + parts.count(1), k)
            for vector, part in zip(along, parts, strict=True):
                if term.is_zero():
                    break
                term = term * vector[part]
            total += term
        return total
