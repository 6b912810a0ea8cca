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
    terms, rows = _by_monomial((*columns, wanted))
    matrix = flint.fmpq_mat(len(rows), len(terms))
    for at, column in enumerate(terms):
        for monomial, coefficient in column.items():
            matrix[rows[monomial], at] = coefficient
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
    terms, rows = _by_monomial((*columns, wanted))
    matrix = flint.nmod_mat(len(rows), len(terms), _PRIME)
    for at, column in enumerate(terms):
        for monomial, coefficient in column.items():
            if coefficient.q % _PRIME == 0:
                return True
            matrix[rows[monomial], at] = int(coefficient.p * pow(int(coefficient.q), -1, _PRIME))
    reduced, rank = matrix.rref()
    last = len(columns)
    return rank == 0 or any(int(reduced[rank - 1, c]) for c in range(last))


def _by_monomial(
    elements: Sequence[Poly],
) -> tuple[list[dict[tuple[int, ...], flint.fmpq]], dict[tuple[int, ...], int]]:
    """Each one's coefficients by their monomials, and a row for each monomial that occurs."""
    terms = [dict(terms_of(x)) for x in elements]
    return terms, {m: k for k, m in enumerate({m for each in terms for m in each})}
