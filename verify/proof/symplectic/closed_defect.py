"""S of a map that is written out, by its powers of h."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from verify.algebra.ring import Poly
from verify.proof.symplectic.closed_form import defect, jacobian
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.degrees.defect import DefectSeries
from verify.schemes.degrees.two_form import Place

_MOST_TERMS = 40_000  # of products in all entries, beyond which S is not multiplied out


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
        if step.closed is None or _terms(step, step.closed) > _MOST_TERMS:
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
