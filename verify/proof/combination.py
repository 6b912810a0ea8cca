"""Whether a polynomial is a linear combination of others, by linear algebra over the rationals."""

from collections.abc import Sequence
from typing import Any

import flint

from verify.ring import Poly


def combination(columns: Sequence[Poly], wanted: Poly) -> tuple[dict[int, Any] | None, int]:
    """({index: its coefficient} with Σ coefficient·column = wanted, the rank of the columns).

    None for the coefficients where there are none.
    """
    terms = [x.to_dict() for x in (*columns, wanted)]
    rows = {m: k for k, m in enumerate({m for column in terms for m in column})}
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
