"""Matrices whose entries are indices of a program: products, linear systems, and S of a step.

S = JᵀΩJ − Ω for the Jacobian J of a step. With B = JᵀΩJ = Ω + S, det J = Pf B/Pf Ω exactly, where
Pf is the Pfaffian. It follows that det J − 1 = Σ Pf(S_I) over all sets I ≠ ∅ of degrees of freedom,
where S_I has the rows and columns p_i, q_i with i in I. In this sum nothing cancels against 1; for
I = {i} the Pfaffian is S(p_i, q_i).
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations

from verify.kernels.step.operations import StepProgram

Place = tuple[int, int]  # a row and a column
Matrix = list[list[int]]  # the indices of its entries
Entry = Callable[[int, int], int]  # (a, b) with a < b → the index of that entry


def multiply(program: StepProgram, x: Matrix, y: Matrix) -> Matrix:
    """Return the product of two matrices."""
    columns, rows = list(zip(*y, strict=True)), []
    for row in x:
        product_row = []
        for column in columns:
            total = program.constant(Fraction(0))
            for a, b in zip(row, column, strict=True):
                total = program.add(total, program.mul(a, b))
            product_row.append(total)
        rows.append(product_row)
    return rows


def one_minus(program: StepProgram, rows: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return 1 − the matrix of these rows."""
    matrix = [list(map(program.neg, row)) for row in rows]
    for k, row in enumerate(matrix):
        row[k] = program.add(program.quotient(1, 1), row[k])
    return matrix


def eliminate(
    program: StepProgram, matrix: Sequence[Sequence[int]], right: Sequence[Sequence[int]]
) -> tuple[list[list[int]], list[int]]:
    """Solve linear systems with the same matrix 1 + O(h), one for each column of the right side.

    Return the solutions row by row, and the pivots that are not 1 (or the constant 1 alone). No
    rows are exchanged, since at h = 0 the diagonal is 1.
    """
    add, mul, neg = program.add, program.mul, program.neg
    size, rows = len(matrix), [[*row, *more] for row, more in zip(matrix, right, strict=True)]
    width = len(rows[0])
    pivots, inverses = [], []
    for k in range(size):
        pivot = rows[k][k]
        one = program.is_constant(pivot, 1)
        pivots += [] if one else [pivot]
        inverses.append(pivot if one else program.inverse(pivot))
        for i in range(k + 1, size):
            factor = mul(rows[i][k], inverses[k])
            for j in range(k + 1, width):
                rows[i][j] = add(rows[i][j], neg(mul(factor, rows[k][j])))
    solutions: list[list[int]] = [[] for _ in range(size)]
    for k in reversed(range(size)):
        for column in range(width - size):
            total = rows[k][size + column]
            for j in range(k + 1, size):
                total = add(total, neg(mul(rows[k][j], solutions[j][column])))
            solutions[k].append(mul(total, inverses[k]))
    return solutions, pivots or [program.constant(Fraction(1))]


def defect_from_slopes(program: StepProgram, slopes: Matrix) -> dict[Place, int]:
    """Return the entries of S = KᵀΩ + ΩK + KᵀΩK above the diagonal, from K = J − 1."""
    n, entries = len(slopes) // 2, {}
    add, mul, neg = program.add, program.mul, program.neg
    for a, b in combinations(range(2 * n), 2):
        total = program.constant(Fraction(0))
        for i in range(n):
            u, v = slopes[i], slopes[n + i]
            # With u, v the increments of p, q: first the entry ab of du∧dq + dp∧dv, then du∧dv.
            if b == n + i:
                total = add(total, u[a])
            if a == n + i:
                total = add(total, neg(u[b]))
            if a == i:
                total = add(total, v[b])
            if b == i:
                total = add(total, neg(v[a]))
            # K is O(h), so S is evaluated from K and not as JᵀΩJ − Ω, where entries near 1 would
            # cancel.
            total = add(total, add(mul(u[a], v[b]), neg(mul(u[b], v[a]))))
        entries[a, b] = total
    return entries


def change_of_determinant(program: StepProgram, slopes: Matrix) -> int:
    """Return the index of det(1 + K) − 1, the sum of all principal minors of K: no 1 cancels."""
    size, minors = len(slopes), dict[tuple[tuple[int, ...], tuple[int, ...]], int]()

    def minor(rows: tuple[int, ...], columns: tuple[int, ...]) -> int:
        """Return the index of a minor, by expansion along its first row; each is written once."""
        if len(rows) == 1:
            return slopes[rows[0]][columns[0]]
        if (rows, columns) not in minors:
            total = program.constant(Fraction(0))
            for k, column in enumerate(columns):
                rest = minor(rows[1:], (*columns[:k], *columns[k + 1 :]))
                term = program.mul(slopes[rows[0]][column], rest)
                total = program.add(total, program.neg(term) if k % 2 else term)
            minors[rows, columns] = total
        return minors[rows, columns]

    change = program.constant(Fraction(0))
    for count in range(1, size + 1):
        for chosen in combinations(range(size), count):
            change = program.add(change, minor(chosen, chosen))
    return change


class Pfaffian:
    """The Pfaffians of principal submatrices of one matrix, by expansion; each is computed once.

    `share`: the index of a factor s: a product of k entries is multiplied by s^(k − 1). None means
    s = 1.
    """

    def __init__(self, program: StepProgram, entry: Entry, share: int | None = None) -> None:
        self.program, self.entry, self.share = program, entry, share
        self._cache: dict[tuple[int, ...], int] = {}

    def of_rows(self, rows: Sequence[int]) -> int:
        """Return the index of the Pfaffian of the submatrix of these rows and columns, in this
        order."""
        key = tuple(rows)
        if key not in self._cache:
            self._cache[key] = self._expand(key)
        return self._cache[key]

    def _expand(self, rows: tuple[int, ...]) -> int:
        # Expansion along the first row: Pf A = Σ_k (−1)^k a_1k Pf(A without rows 1 and k).
        program, (first_row, *others) = self.program, rows
        if len(others) == 1:
            return self._entry(first_row, others[0])
        total = program.quotient(0, 1)
        for k, other in enumerate(others):
            minor = self.of_rows([*others[:k], *others[k + 1 :]])
            if self.share is not None:
                minor = program.mul(self.share, minor)
            term = program.mul(self._entry(first_row, other), minor)
            total = program.add(total, program.neg(term) if k % 2 else term)
        return total

    def _entry(self, a: int, b: int) -> int:
        return self.entry(a, b) if a < b else self.program.neg(self.entry(b, a))


def change_of_volume(pfaffian: Pfaffian, degrees: int, pair_sum: int) -> int:
    """Return the index of det J − 1, for the Pfaffians of S and the index of Σ S(p_i, q_i)."""
    total = pair_sum
    for count in range(2, degrees + 1):
        for chosen in combinations(range(degrees), count):
            rows = [row for i in chosen for row in (i, degrees + i)]
            total = pfaffian.program.add(total, pfaffian.of_rows(rows))
    return total
