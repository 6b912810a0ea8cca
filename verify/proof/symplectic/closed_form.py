"""S and det J of a map that is written in closed form, h being one more variable of its ring; and S
by its powers of h."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from verify.algebra.ring import Poly, Ring
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.degrees.defect import DefectSeries
from verify.schemes.degrees.two_form import Place, TwoForm, wedge

_MOST_PRODUCTS = 40_000  # in all entries of S, beyond which it is not multiplied out
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


# -- by its powers of h ---------------------------------------------------------------------------


@dataclass(frozen=True)
class ClosedDefect:
    """`forms`: the coefficients of S by the power of h, by their places, in the map's ring; None
    where it is not written out, or too long. `vanishes`: S ≡ 0 is shown.
    """

    forms: Mapping[int, Mapping[Place, Poly]] | None
    vanishes: bool

    @classmethod
    @lru_cache(maxsize=32)
    def of(cls, step: CanonicalMap) -> "ClosedDefect":
        """That of a map."""
        if step.symplectic_by_conditions:
            return cls({}, vanishes=True)
        if step.closed is None or _terms(step, step.closed) > _MOST_PRODUCTS:
            return cls(None, vanishes=False)
        forms = _by_powers(step) if step.degree is not None else _whole(step)
        ring = step.ring
        nothing = all(ring.vanishes(x) is True for form in forms.values() for x in form.values())
        return cls({} if nothing else forms, nothing)


def _by_powers(step: CanonicalMap) -> dict[int, Mapping[Place, Poly]]:
    """Of a polynomial in h. Up to `flow_up_to` the map is the flow, which is symplectic."""
    degree = step.degree or 0
    field, made = step.field, step.series(2 * degree)
    assert made is not None  # noqa: S101 - a closed form that is a polynomial in h has a series
    series = DefectSeries(lambda _: (field, made), 2 * degree)
    first = step.flow_up_to + 1
    each = ((m, series.form(m).entries) for m in range(first, 2 * degree + 1))
    return {m: entries for m, entries in each if entries}


def _whole(step: CanonicalMap) -> dict[int, Mapping[Place, Poly]]:
    assert step.closed is not None  # noqa: S101 - the caller's condition
    return {0: defect(step.ring, step.field.names, step.closed).entries}


def _terms(step: CanonicalMap, closed: tuple[Poly, ...]) -> int:
    """About how many products there are in S."""
    rows = [sum(map(len, row)) for row in jacobian(step.ring, step.field.names, closed)]
    n = len(rows) // 2
    return sum(rows[i] * rows[n + i] for i in range(n))
