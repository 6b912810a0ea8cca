"""Polynomials as linear combinations of others, by linear algebra over the rationals."""

from collections.abc import Sequence

import flint

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly

_PRIME = 2_305_843_009_213_693_951  # 2⁶¹ − 1


def solve_combination(
    columns: Sequence[Poly], target: Poly
) -> tuple[dict[int, flint.fmpq] | None, int]:
    """Solve Σ coefficient·column = target: return {index: coefficient} and the columns' rank.

    The coefficients are None where there is no solution.
    """
    rows, entries = _entries((*columns, target))
    matrix = flint.fmpq_mat(rows, len(columns) + 1)
    for place, coefficient in entries:
        matrix[place] = coefficient
    reduced, rank = matrix.rref()
    last = len(columns)
    pivots = [next(c for c in range(last + 1) if reduced[r, c] != 0) for r in range(rank)]
    # A pivot in the last column means that the target is independent of the columns.
    if last in pivots:
        return None, rank - 1
    return {c: reduced[r, last] for r, c in enumerate(pivots)}, rank


def may_combine(columns: Sequence[Poly], target: Poly) -> bool:
    """Return True if `target` is a combination of the columns modulo a prime, a cheap test.

    If it is not, then it is none over the rationals either, unless the prime divides a denominator
    of every such combination: good enough to give up a search, not to refute.
    """
    rows, entries = _entries((*columns, target))
    matrix = flint.nmod_mat(rows, len(columns) + 1, _PRIME)
    for place, coefficient in entries:
        if coefficient.q % _PRIME == 0:
            return True
        matrix[place] = int(coefficient.p * pow(int(coefficient.q), -1, _PRIME))
    reduced, rank = matrix.rref()
    return rank == 0 or any(int(reduced[rank - 1, c]) for c in range(len(columns)))


def _entries(elements: Sequence[Poly]) -> tuple[int, list[tuple[tuple[int, int], flint.fmpq]]]:
    """Return the entries of a matrix with a row for each monomial and a column for each element.

    They are the number of rows, and a list of ((row, column), coefficient).
    """
    rows: dict[tuple[int, ...], int] = {}
    entries = []
    for column, x in enumerate(elements):
        for monomial, coefficient in terms_of(x):
            row = rows.setdefault(monomial, len(rows))
            entries.append(((row, column), coefficient))
    return len(rows), entries
