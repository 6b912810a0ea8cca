"""Whether a polynomial is a linear combination of others, by linear algebra over the rationals."""

from collections.abc import Sequence

import flint

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly

_PRIME = 2_305_843_009_213_693_951  # 2⁶¹ − 1


def combination(columns: Sequence[Poly], wanted: Poly) -> tuple[dict[int, flint.fmpq] | None, int]:
    """({index: its coefficient} with Σ coefficient·column = wanted, the rank of the columns).

    None for the coefficients where there are none.
    """
    rows, entries = _entries((*columns, wanted))
    matrix = flint.fmpq_mat(rows, len(columns) + 1)
    for at, coefficient in entries:
        matrix[at] = coefficient
    reduced, rank = matrix.rref()
    last = len(columns)
    pivots = [next(c for c in range(last + 1) if reduced[r, c] != 0) for r in range(rank)]
    if last in pivots:
        return None, rank - 1
    return {c: reduced[r, last] for r, c in enumerate(pivots)}, rank


def may_combine(columns: Sequence[Poly], wanted: Poly) -> bool:
    """Whether `wanted` is a combination of the columns modulo a prime; far cheaper to know.

    Where it is not, it is none over the rationals either, unless the prime divides a denominator of
    every such combination: good enough to give up a search, not to refute.
    """
    rows, entries = _entries((*columns, wanted))
    matrix = flint.nmod_mat(rows, len(columns) + 1, _PRIME)
    for at, coefficient in entries:
        if coefficient.q % _PRIME == 0:
            return True
        matrix[at] = int(coefficient.p * pow(int(coefficient.q), -1, _PRIME))
    reduced, rank = matrix.rref()
    return rank == 0 or any(int(reduced[rank - 1, c]) for c in range(len(columns)))


def _entries(elements: Sequence[Poly]) -> tuple[int, list[tuple[tuple[int, int], flint.fmpq]]]:
    """How many monomials occur, and ((row, column), coefficient) of a matrix: a row for each
    monomial, a column for each element."""
    rows: dict[tuple[int, ...], int] = {}
    entries = []
    for column, x in enumerate(elements):
        for monomial, coefficient in terms_of(x):
            row = rows.setdefault(monomial, len(rows))
            entries.append(((row, column), coefficient))
    return len(rows), entries
