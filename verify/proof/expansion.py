"""The Taylor coefficients in h of a ring element, and the first of them that does not vanish."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.limits import checked
from verify.algebra.ring import Decision, Poly, Ring
from verify.algebra.ring_text import as_expression_at_0
from verify.algebra.series.power_series import Series
from verify.algebra.series.quotient_series import QuotientSeries
from verify.errors import InputError, LimitError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.late import sympy
from verify.proof.parameters import not_zero_for
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.degrees.defect import DefectSeries
from verify.schemes.step_algebra import State
from verify.schemes.substep import h_inside

MOST_ORDERS = 12  # Taylor coefficients looked at where a map is not a polynomial in h


@dataclass(frozen=True)
class Leading:
    """The first coefficient in h that is not shown to vanish: of h^`power`, as a ring's element.

    `decision.zero` is False at a proved leading term, None at an undecided one, and True where
    every coefficient vanishes (`power` is None then). False with `power` None: ΔJ is not zero, but
    its leading term lies beyond the orders looked at; `element` is then ΔJ itself.
    """

    power: int | None
    decision: Decision
    element: tuple[Ring, Poly] | None = None

    @cached_property
    def coefficient(self) -> sympy.Expr:
        """As an expression; 0 where there is none."""
        if self.element is None or self.power is None:
            return sympy.S.Zero
        ring, x = self.element
        return ring.factored(x)

    @cached_property
    def domain(self) -> Domain:
        """The parameters for which the coefficient is not the zero function of p and q."""
        if self.decision.zero is not False or self.element is None or self.power is None:
            return EVERYWHERE
        return not_zero_for(*self.element, f"the coefficient of h^{self.power}")

    def within(self, domain: Domain) -> Leading:
        """As it is in the domain: the witness lies there, and without a point nothing is said."""
        if self.decision.zero is None or not domain.requirements:
            return self
        ring, x = self.element or _ZERO  # what vanishes has no element
        return replace(self, decision=domain.decide(ring, x))

    @property
    def text(self) -> str:
        """As a formula."""
        if self.element is None or self.power is None:
            return "0"
        ring, x = self.element
        return ring.text(x)


_NOWHERE = Ring((), 0, spare=0)
_ZERO = _NOWHERE, _NOWHERE.zero
VANISHES = Leading(None, Decision(True))


class Expansion:
    """The Taylor coefficients in h, at h = 0, of a ring element.

    `terms`: those that are not 0, where the element is known to be a polynomial in h. Of an element
    with 1/h in it they are those of hᵐ times it, whose first m must vanish.
    """

    def __init__(self, ring: Ring, x: Poly, terms: Mapping[int, Poly] | None = None) -> None:
        self.ring, self.pole = ring, 0
        if terms is None:
            self.pole, x = _without_pole(ring, x)
            terms = None if h_inside(ring, x) else ring.powers(x, "h")
        self.polynomial = terms is not None
        self._powers = terms or {}
        self._derivatives = [x]

    @property
    def length(self) -> int:
        """How many coefficients there are to look at."""
        last = max(self._powers, default=0) - self.pole if self.polynomial else MOST_ORDERS
        return max(last, 0) + 1

    def coefficient(self, n: int) -> tuple[Ring, Poly]:
        """The coefficient of hⁿ, with the ring that it is an element of."""
        if not self._smooth:
            text = self.ring.text(self._derivatives[0])
            raise LimitError("map", f"({text})/h**{self.pole}", "is not smooth in h at h = 0")
        return self._without_pole(n + self.pole)

    @cached_property
    def _smooth(self) -> bool:
        parts = map(self._without_pole, range(self.pole))
        return all(ring.vanishes(x) is True for ring, x in parts)

    def _without_pole(self, n: int) -> tuple[Ring, Poly]:
        if self.polynomial:
            return self.ring, self._powers.get(n, self.ring.zero)
        if self._quotient is not None:
            return self.ring, self._quotient.coefficients[n]
        while len(self._derivatives) <= n:
            self._derivatives.append(self.ring.diff(self._derivatives[-1], "h"))
        value = as_expression_at_0(self.ring, self._derivatives[n], symbol("h"))
        try:
            checked(value, "map", str(value))
        except InputError as error:
            raise LimitError("map", error.value, "is not smooth in h at h = 0") from None
        ring, (x,) = embed([value / math.factorial(n)], self.ring.variables)
        return ring, x

    @cached_property
    def _quotient(self) -> Series | None:
        """All coefficients that are looked at, where x is a quotient of polynomials in h."""
        length = self.length + 1 + self.pole
        return QuotientSeries(self.ring, length).of(self._derivatives[0])

    def leading(self) -> Leading:
        """The first coefficient that is not the zero function, as far as `length` goes."""
        found = first_nonzero(self.coefficient, self.length)
        if found is None and not self.polynomial:
            return Leading(self.length, Decision(None))
        return found or VANISHES


def _without_pole(ring: Ring, x: Poly) -> tuple[int, Poly]:
    """m and hᵐ x, which has no 1/h in it."""
    h, gens = ring.variable("h"), ring.context.gens()
    pole = ring.find("inverse", h)
    parts = {0: x} if pole is None else ring.split(x, gens.index(pole))
    most = max(parts, default=0)
    return most, ring.reduce(sum((c * h ** (most - n) for n, c in parts.items()), ring.zero))


def first_nonzero(coefficient: Callable[[int], tuple[Ring, Poly]], length: int) -> Leading | None:
    """The first of the coefficients that is not shown to vanish; None where all are."""
    for n in range(length):
        ring, x = coefficient(n)
        decision = ring.decide(x)
        if decision.zero is not True:
            return Leading(n, decision, (ring, x))
    return None


# -- of a map --------------------------------------------------------------------------------------


def series_of(step: CanonicalMap, first: int) -> DefectSeries[CanonicalField]:
    """The coefficients of h⁰, h¹, … of one map in n degrees of freedom, S and ΔJ among them."""
    return DefectSeries(partial(_state, step), first)


def _state(step: CanonicalMap, most: int) -> tuple[CanonicalField, State]:
    if step.expand is not None:
        return step.expand(most)
    series = step.series(most)
    if series is not None:
        return step.field, series
    assert step.closed is not None  # noqa: S101 - a map has one or the other
    count, ring = most + 1, step.ring
    expansions = [Expansion(ring, x) for x in step.closed]
    parts = [each.coefficient(n) for each in expansions for n in range(count)]
    flow, exact = canonical_field(step.hamiltonian, *(own.expression(x) for own, x in parts))
    rows = (exact[count * i : count * (i + 1)] for i in range(len(expansions)))
    return flow, tuple(Series.of(flow.ring, row, most) for row in rows)
