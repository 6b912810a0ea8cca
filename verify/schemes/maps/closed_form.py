"""A map z → z' that is written out: its Jacobian, S = JᵀΩJ − Ω and det J − 1 in closed form.

If the map is a polynomial in h, S is computed one power of h after the other, so that nothing
cancels between powers; in the plane S is ΔJ dp∧dq.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

from verify.algebra.formula import symbol
from verify.algebra.power_series import Series
from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.canonical_field import PlainField
from verify.lazy_sympy import sympy
from verify.schemes.steps.defect import DefectSeries
from verify.schemes.steps.step_algebra import State
from verify.schemes.steps.two_form import TwoForm, wedge

_MOST_PRODUCTS = 40_000  # limit of the terms of S that are multiplied out, in several degrees
_MOST_JACOBIAN_TERMS = 300  # limit of the terms of J, all entries, for multiplying out det J


@dataclass(frozen=True, eq=False)
class ClosedForm:
    """The map z' as `elements` of the ring of H's `field`, one for each coordinate."""

    field: PlainField
    elements: tuple[Poly, ...]

    @property
    def ring(self) -> Ring:
        """The ring of z' and the field."""
        return self.field.ring

    @property
    def increments(self) -> tuple[Poly, ...]:
        """The increments z' − z."""
        return tuple(x - z for x, z in zip(self.elements, self.field.start, strict=True))

    @cached_property
    def jacobian(self) -> tuple[tuple[Poly, ...], ...]:
        """The Jacobian ∂z'/∂z by rows."""
        return tuple(map(self.field.gradient, self.elements))

    @cached_property
    def degree(self) -> int | None:
        """The degree in h if the map is a polynomial in h; else None."""
        if h_inside(self.ring, *self.elements):
            return None
        return max((max(powers, default=0) for powers in self._powers), default=0)

    @cached_property
    def _powers(self) -> list[dict[int, Poly]]:
        return [self.ring.powers(x, "h") for x in self.elements]

    @cached_property
    def flow_up_to(self) -> int:
        """The power of h up to which the terms are literally those of the exact flow.

        −1 if the elements are no polynomials in h.
        """
        for n in range((-1 if self.degree is None else self.degree) + 1):
            coefficients = (powers.get(n, self.ring.zero) for powers in self._powers)
            if any(x != y for x, y in zip(coefficients, self.field.term(n), strict=True)):
                return n - 1
        return -1 if self.degree is None else self.degree

    def series(self, most: int) -> State | None:
        """Return z' up to h^most; None if it is no polynomial in h."""
        if self.degree is None:
            return None
        ring = self.ring
        rows = ([powers.get(n, ring.zero) for n in range(most + 1)] for powers in self._powers)
        return tuple(Series.from_coefficients(ring, coefficients, most) for coefficients in rows)

    @property
    def length(self) -> int:
        """The number of terms in all elements."""
        return terms_of(self.ring, self.elements)

    @property
    def products(self) -> int:
        """A bound of the number of terms of S when it is multiplied out."""
        bound, names = self.ring.terms_of_diff, self.field.names
        rows = [[bound(x, name) for name in names] for x in self.increments]
        n = len(rows) // 2
        pairs = [(rows[i], rows[n + i]) for i in range(n)]
        linear = sum(u[i] + v[n + i] for i, (u, v) in enumerate(pairs))
        places = list(combinations(range(2 * n), 2))
        return linear + sum(u[a] * v[b] + u[b] * v[a] for u, v in pairs for a, b in places)

    # -- S ----------------------------------------------------------------------------------------

    @cached_property
    def forms(self) -> Mapping[int, TwoForm] | None:
        """The coefficients of S that are not 0, by their power of h; None if S is too long.

        If the map is no polynomial in h, S itself stands under the power 0.
        """
        if self.field.degrees > 1 and self.products > _MOST_PRODUCTS:
            return None
        if self.degree is None:
            return {0: self.defect} if self.defect.entries else {}
        highest = 2 * self.degree
        state = self.series(highest)
        assert state is not None  # noqa: S101 - it is a polynomial in h
        series = DefectSeries(lambda _: (self.field, state), highest, self.flow_up_to)
        # Up to `flow_up_to` the map is the flow, which is symplectic.
        forms = {m: series.form(m) for m in range(self.flow_up_to + 1, highest + 1)}
        return {m: form for m, form in forms.items() if form.entries}

    @cached_property
    def defect(self) -> TwoForm:
        """The form S, with h as one more variable of its ring."""
        return defect_of(self.ring, self.field.names, self.elements)

    @cached_property
    def symplectic(self) -> bool:
        """True if S is shown to be the zero form."""
        if self.forms is None:
            return False
        entries = [x for form in self.forms.values() for x in form.entries.values()]
        return all(self.ring.vanishes(x) is True for x in entries)

    def form(self, power: int) -> TwoForm:
        """Return the coefficient of h^power in S, for a map that is a polynomial in h."""
        empty = TwoForm(self.ring, self.field.names)
        return (self.forms or {}).get(power, empty)

    @cached_property
    def delta_j(self) -> Poly:
        """The element det J − 1."""
        if self.field.degrees > 1 or self.forms is None:
            return determinant(self.ring, self.jacobian) - 1
        h = self.ring.variable("h")
        parts = (h**m * form.entry(0, 1) for m, form in self.forms.items())
        return sum(parts, self.ring.zero)

    def preserves_volume(self) -> bool | None:
        """Return True if det J ≡ 1; None if that is not decided or det J is too long."""
        return preserves_volume(self.ring, self.jacobian)


def h_inside(ring: Ring, *elements: Poly) -> bool:
    """Return True if h occurs inside a generator, so that an element is not a polynomial in h."""
    return any(ring.depends(a, "h") for a in arguments(ring, *elements))


def arguments(ring: Ring, *elements: Poly) -> list[Poly]:
    """Return the arguments of the generators that occur in the elements."""
    return [g.argument for g in ring.generators_in(*elements) if g.argument is not None]


def terms_of(ring: Ring, elements: Sequence[Poly]) -> int:
    """Return the number of terms in elements and in the arguments of their generators."""
    return sum(map(len, [*elements, *arguments(ring, *elements)]))


# -- as expressions, by powers of h ----------------------------------------------------------------


def unfactored_text(ring: Ring, coefficients: Mapping[int, Poly]) -> str:
    """Return Σ hⁿ cₙ as it stands, for coefficients that are too long to be factored."""
    parts = (f"h**{n}*({ring.text(c)})" for n, c in sorted(coefficients.items()) if not c.is_zero())
    return " + ".join(parts)


def group_by_powers(ring: Ring, x: Poly) -> sympy.Expr:
    """Return x as an expression, by powers of h with factored coefficients.

    If h stands inside a generator, x is factored as a whole.
    """
    if h_inside(ring, x):
        return ring.as_product(x)
    return factored_by_powers(ring, ring.powers(x, "h"))


def factored_by_powers(ring: Ring, coefficients: Mapping[int, Poly]) -> sympy.Expr:
    """Return Σ hⁿ cₙ, each coefficient factored."""
    h = symbol("h")
    return sympy.Add(*(h**n * ring.as_product(c) for n, c in sorted(coefficients.items())))


# -- for any map, with an H or without -------------------------------------------------------------


def defect_of(ring: Ring, names: tuple[str, ...], elements: Sequence[Poly]) -> TwoForm:
    """Return S of z ↦ `elements`, where z are the variables `names`."""
    n, rows = len(names) // 2, [[ring.diff(x, name) for name in names] for x in elements]

    def entry(a: int, b: int) -> Poly:
        total = -ring.one if b == a + n else ring.zero
        for i in range(n):
            total += wedge(rows[i], rows[n + i], a, b)
        return total

    return TwoForm.from_entries(ring, names, entry)


def preserves_volume(ring: Ring, jacobian: Sequence[Sequence[Poly]]) -> bool | None:
    """Return True if the determinant is 1; None if that is not decided or it is too long."""
    if sum(len(x) for row in jacobian for x in row) > _MOST_JACOBIAN_TERMS:
        return None
    return ring.vanishes(determinant(ring, jacobian) - 1)


def determinant(ring: Ring, matrix: Sequence[Sequence[Poly]]) -> Poly:
    """Return the determinant of a square matrix, without division.

    R. S. Bird, A simple division-free algorithm for computing determinants, Inf. Process. Lett. 111
    (2011).
    """
    size, entries = len(matrix), [list(row) for row in matrix]
    product = entries
    # Bird's algorithm: F_(k+1) = μ(F_k) A. μ keeps the part above the diagonal; in place of the
    # diagonal it puts the negative sums of the diagonal entries below.
    for _ in range(size - 1):
        below = ring.zero
        upper = [[ring.zero] * size for _ in range(size)]
        for i in reversed(range(size)):
            upper[i][i + 1 :] = product[i][i + 1 :]
            upper[i][i] = -below
            below = below + product[i][i]
        product = [[_product(ring, row, entries, j) for j in range(size)] for row in upper]
    return product[0][0] if size % 2 else -product[0][0]


def _product(ring: Ring, row: Sequence[Poly], matrix: Sequence[Sequence[Poly]], j: int) -> Poly:
    terms = (x * other[j] for x, other in zip(row, matrix, strict=True) if not x.is_zero())
    return ring.reduce(sum(terms, ring.zero))
