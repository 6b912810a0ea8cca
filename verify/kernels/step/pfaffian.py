"""Pfaffians of antisymmetric matrices, in the operations of a program.

With B = JᵀΩJ, det J = Pf B/Pf Ω exactly. Of B = Ω + S it is a sum over the sets of degrees of
freedom, det J − 1 = Σ Pf(S of the pairs in I), I ≠ ∅, in which nothing cancels against 1: with one
pair it is S(p_i, q_i).
"""

from collections.abc import Callable, Sequence
from itertools import combinations

from verify.kernels.step.operations import Program

Entry = Callable[[int, int], int]  # the index of the entry ab, a < b


class Pfaffian:
    """The Pfaffians of the principal submatrices of one matrix, by expansion; each is computed
    once.

    `share`: the index of a factor of all entries but one of each product; None for 1.
    """

    def __init__(self, program: Program, entry: Entry, share: int | None = None) -> None:
        self.program, self.entry, self.share = program, entry, share
        self._cache: dict[tuple[int, ...], int] = {}

    def of_rows(self, rows: Sequence[int]) -> int:
        """Return the Pfaffian of the rows and columns in this order."""
        key = tuple(rows)
        if key not in self._cache:
            self._cache[key] = self._expand(key)
        return self._cache[key]

    def _expand(self, rows: tuple[int, ...]) -> int:
        # Expansion along the first row: Pf A = Σ_k (−1)^k a_1k Pf(A without rows 1 and k).
        program, (first, *rest) = self.program, rows
        if len(rest) == 1:
            return self._entry(first, rest[0])
        total = program.quotient(0, 1)
        for k, other in enumerate(rest):
            minor = self.of_rows([*rest[:k], *rest[k + 1 :]])
            if self.share is not None:
                minor = program.mul(self.share, minor)
            term = program.mul(self._entry(first, other), minor)
            total = program.add(total, program.neg(term) if k % 2 else term)
        return total

    def _entry(self, a: int, b: int) -> int:
        return self.entry(a, b) if a < b else self.program.neg(self.entry(b, a))


def change_of_volume(pfaffian: Pfaffian, degrees: int, first: int) -> int:
    """Return det J − 1 from S as the matrix; `first`: Σ S(p_i, q_i), which is summed elsewhere."""
    total = first
    for count in range(2, degrees + 1):
        for chosen in combinations(range(degrees), count):
            rows = [row for i in chosen for row in (i, degrees + i)]
            total = pfaffian.program.add(total, pfaffian.of_rows(rows))
    return total
