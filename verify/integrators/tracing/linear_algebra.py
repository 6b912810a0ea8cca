"""numpy's `solve`, `inv` and `det` for arrays of our numbers, which LAPACK does not take."""

from collections.abc import Callable
from functools import partial
from typing import Any

from verify.integrators.tracing.number import Kind, constant


def solve(kind: Kind, matrix: Any, right: Any) -> Any:
    """Solve matrix·x = right for x, one vector or the columns of a matrix."""
    import numpy as np

    right = np.asarray(right, dtype=object)
    rows, _ = _eliminate_numbers(kind, matrix, right.reshape(len(right), -1))
    size = len(rows)
    columns = [[x / row[k] for x in row[size:]] for k, row in enumerate(rows)]
    return np.array(columns, dtype=object).reshape(right.shape)


def inv(kind: Kind, matrix: Any) -> Any:
    """Return the inverse."""
    import numpy as np

    return solve(kind, matrix, np.identity(len(matrix), dtype=object))


def det(kind: Kind, matrix: Any) -> Any:
    """Return the determinant."""
    rows, determinant = _eliminate_numbers(kind, matrix, [()] * len(matrix))
    for k, row in enumerate(rows):
        determinant = determinant * row[k]
    return determinant


def _eliminate_numbers(kind: Kind, matrix: Any, right: Any) -> tuple[list[list[Any]], int]:
    """Apply `eliminate` to our numbers."""
    rows = [[constant(kind, x) for x in (*a, *b)] for a, b in zip(matrix, right, strict=True)]
    return rows, eliminate(rows, partial(_size, kind))


def eliminate(rows: list[list[Any]], size: Callable[[Any], Any]) -> int:
    """Make the left of the rows a diagonal matrix, by Gauss; return the sign of its determinant.

    Pivots are the largest of their columns, by that size.
    """
    sign = 1
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i: size(rows[i][k]))
        # An exchange of rows changes the determinant's sign.
        if pivot != k:
            rows[k], rows[pivot], sign = rows[pivot], rows[k], -sign
        for i, row in enumerate(rows):
            if i != k:
                factor = row[k] / rows[k][k]
                rows[i] = [x - factor * y for x, y in zip(row, rows[k], strict=True)]
    return sign


def _size(kind: Kind, x: Any) -> Any:
    """Return the size by which pivots are chosen: a symbol, of no size, comes first, and 0 last."""
    value = x.exact_value()
    return abs(x) if kind.ordered else 1 if value is None else bool(value) / 2
