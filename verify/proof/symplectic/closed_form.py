"""S and det J of a map that is written in closed form, h being one more variable of its ring."""

from collections.abc import Sequence

from verify.algebra.ring import Poly, Ring
from verify.proof.symplectic.two_form import TwoForm, wedge
from verify.schemes.degrees.canonical_map import CanonicalMap

_MOST_TERMS = 300  # of J's entries together, beyond which det J is not multiplied out


def defect(step: CanonicalMap) -> TwoForm:
    """S of a map in closed form."""
    ring, n, rows = step.ring, step.field.degrees, jacobian(step)

    def entry(a: int, b: int) -> Poly:
        total = -ring.one if b == a + n else ring.zero
        for i in range(n):
            total += wedge(rows[i], rows[n + i], a, b)
        return total

    return TwoForm.of(ring, step.field.names, entry)


def jacobian(step: CanonicalMap) -> list[tuple[Poly, ...]]:
    """∂z'/∂z by rows, of a map in closed form."""
    assert step.closed is not None  # noqa: S101 - the caller's condition
    return [step.field.gradient(x) for x in step.closed]


def preserves_volume(step: CanonicalMap) -> bool | None:
    """Whether det J ≡ 1; None where that is not decided, or there is too much to multiply."""
    if step.closed is None:
        return None
    rows = jacobian(step)
    if sum(len(x) for row in rows for x in row) > _MOST_TERMS:
        return None
    return step.ring.vanishes(determinant(step.ring, rows) - 1)


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
