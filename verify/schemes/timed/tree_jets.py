"""The derivatives of H(p, q, t) in the plane that differentials of trees are made of.

See `verify.schemes.elementary_differentials`.
"""

from itertools import product

import flint

from verify.schemes.words.kinetic import Kinetic


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

    def h(self, i: int, j: int, k: int = 0) -> flint.fmpq_mpoly:
        """H_ijk."""
        return self._known.get((i, j, k), self.zero)


def _occurs(kinetic: Kinetic | None, i: int, j: int, k: int) -> bool:
    if kinetic is None or i == 0:
        return True
    of_time = k == 0 or "D" in kinetic.timed
    return j == 0 and of_time and (i <= 2 or not kinetic.quadratic)
