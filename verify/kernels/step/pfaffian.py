"""Pfaffians of antisymmetric matrices, in the operations of whoever asks.

With B = JᵀΩJ, det J = Pf B/Pf Ω exactly. Of B = Ω + S it is a sum over the sets of degrees of
freedom, det J − 1 = Σ Pf(S of the pairs in I), I ≠ ∅, in which nothing cancels against 1: with one
pair it is S(p_i, q_i).
"""

from collections.abc import Callable, Sequence
from itertools import combinations

from verify.kernels.step.operations import Program

Entry = Callable[[int, int], int]  # the index of the entry ab, a < b


class Pfaffian:
    """Of the principal submatrices of one matrix, by expansion; none twice.

    `share`: the index of a factor of all entries but one of each product; None for 1.
    """

    def __init__(self, program: Program, entry: Entry, share: int | None = None) -> None:
        self.program, self.entry, self.share = program, entry, share
        self._found: dict[tuple[int, ...], int] = {}

    def of(self, rows: Sequence[int]) -> int:
        """That of the rows and columns in this order."""
        key = tuple(rows)
        if key not in self._found:
            self._found[key] = self._expanded(key)
        return self._found[key]

    def _expanded(self, rows: tuple[int, ...]) -> int:
        program, (first, *rest) = self.program, rows
        if len(rest) == 1:
            return self._at(first, rest[0])
        total = program.quotient(0, 1)
        for k, other in enumerate(rest):
            minor = self.of([*rest[:k], *rest[k + 1 :]])
            if self.share is not None:
                minor = program.mul(self.share, minor)
            term = program.mul(self._at(first, other), minor)
            total = program.add(total, program.neg(term) if k % 2 else term)
        return total

    def _at(self, a: int, b: int) -> int:
        return self.entry(a, b) if a < b else self.program.neg(self.entry(b, a))


def change_of_volume(made: Pfaffian, degrees: int, first: int) -> int:
    """det J − 1, of S as the matrix; `first`: Σ S(p_i, q_i), which is summed elsewhere."""
    total = first
    for count in range(2, degrees + 1):
        for chosen in combinations(range(degrees), count):
            rows = [row for i in chosen for row in (i, degrees + i)]
            total = made.program.add(total, made.of(rows))
    return total
