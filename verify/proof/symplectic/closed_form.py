"""S and det J of a map that is written in closed form, h being one more variable of its ring."""

from collections.abc import Sequence

from verify.algebra.ring import Poly, Ring
from verify.schemes.degrees.two_form import TwoForm, wedge

_MOST_TERMS = 300  # of J's entries together, beyond which det J is not multiplied out


def defect(ring: Ring, names: tuple[str, ...], closed: Sequence[Poly]) -> TwoForm:
    """S of z ↦ `closed`, z being the variables of these names."""
    n, rows = len(names) // 2, jacobian(ring, names, closed)

    def entry(a: int, b: int) -> Poly:
        total = -ring.one if b == a + n else ring.zero
        for i in range(n):
            total += wedge(rows[i], rows[n + i], a, b)
        return total

    return TwoForm.of(ring, names, entry)


def jacobian(ring: Ring, names: tuple[str, ...], closed: Sequence[Poly]) -> list[tuple[Poly, ...]]:
    """∂z'/∂z by rows."""
    return [tuple(ring.diff(x, name) for name in names) for x in closed]


def preserves_volume(
    ring: Ring, names: tuple[str, ...], closed: Sequence[Poly] | None
) -> bool | None:
    """Whether det J ≡ 1; None where that is not decided, or there is too much to multiply."""
    if closed is None:
        return None
    rows = jacobian(ring, names, closed)
    if sum(len(x) for row in rows for x in row) > _MOST_TERMS:
        return None
    return ring.vanishes(determinant(ring, rows) - 1)


def determinant(ring: Ring, matrix: Sequence[Sequence[Poly]]) -> Poly:
    """Of a square matrix, without division.

    R. S. Bird, A simple division-free algorithm for computing determinants, Inf. Process. Lett. 111
    (2011).
    """
    size, own = len(matrix), [list(row) for row in matrix]
    found = own
    for _ in range(size - 1):
        below = ring.zero
        upper = [[ring.zero] * size for _ in range(size)]
        for i in reversed(range(size)):
            upper[i][i + 1 :] = found[i][i + 1 :]
            upper[i][i] = -below
            below = below + found[i][i]
        found = [[_product(ring, row, own, j) for j in range(size)] for row in upper]
    return found[0][0] if size % 2 else -found[0][0]


def _product(ring: Ring, row: Sequence[Poly], matrix: Sequence[Sequence[Poly]], j: int) -> Poly:
    terms = (x * other[j] for x, other in zip(row, matrix, strict=True) if not x.is_zero())
    return ring.reduce(sum(terms, ring.zero))
