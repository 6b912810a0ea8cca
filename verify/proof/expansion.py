"""The Taylor coefficients in h of a ring element, and the first of them that does not vanish."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial
from typing import TypeAlias

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.identities.polynomials import split
from verify.algebra.limits import checked
from verify.algebra.ring import Decision, Poly, Ring
from verify.algebra.ring_text import as_expression_at_0
from verify.algebra.series.power_series import Series
from verify.algebra.series.quotient_series import QuotientSeries
from verify.errors import InputError, LimitError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.late import sympy
from verify.proof.parameters import not_zero_for
from verify.schemes.maps.closed_form import ClosedForm, h_inside
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.defect import DefectSeries
from verify.schemes.steps.step_algebra import State
from verify.schemes.steps.two_form import Place, TwoForm

MOST_ORDERS = 12  # Taylor coefficients looked at where a map is not a polynomial in h


@dataclass(frozen=True)
class Leading:
    """The first coefficient in h that is not shown to vanish: of h^`power`, as a ring's element.

    `decision.zero` is False at a proved leading term, None at an undecided one, and True where
    every coefficient vanishes (`power` is None then). False with `power` None: what is expanded is
    not zero, but its leading term lies beyond the orders looked at; `element` is then itself.

    Of S it is a `form`, and `element` the entry at `place`, which decides.
    """

    power: int | None
    decision: Decision
    element: tuple[Ring, Poly] | None = None
    form: TwoForm | None = field(default=None, repr=False)
    place: Place | None = None

    @classmethod
    def of_form(cls, power: int | None, form: TwoForm, ring: Ring) -> Leading:
        """The coefficient of h^power in S; or S itself, with None."""
        decision, place = form.decide()
        if place is None:
            return VANISHES
        return cls(power, decision, (ring, form.entries[place]), form, place)

    @cached_property
    def coefficient(self) -> sympy.Expr:
        """As an expression; 0 where there is none."""
        if self.element is None or self.power is None:
            return sympy.S.Zero
        ring, x = self.element
        return ring.factored(x)

    @property
    def entry(self) -> str:
        """The name of the entry of S that decides, such as dp1∧dq2; empty in the plane."""
        if self.form is None or self.place is None or self.form.names == PLANE:
            return ""
        return self.form.called(self.place)

    @cached_property
    def domain(self) -> Domain:
        """The parameters for which the coefficient is not the zero function of the coordinates."""
        if self.decision.zero is not False or self.element is None:
            return EVERYWHERE
        if self.power is None and not self.entry:
            return EVERYWHERE
        what = f"the coefficient of h^{self.power}"
        return not_zero_for(*self.element, f"the entry {self.entry} of S" if self.entry else what)

    def within(self, domain: Domain) -> Leading:
        """As it is in the domain: the witness lies there, and without a point nothing is said."""
        if self.decision.zero is None or not domain.requirements:
            return self
        ring, x = self.element or _ZERO  # what vanishes has no element
        if self.form is None:
            return replace(self, decision=domain.decide(ring, x))
        decision, place = self.form.decide(partial(domain.decide, ring))
        if place is None:
            return replace(self, decision=decision)
        return replace(
            self, decision=decision, place=place, element=(ring, self.form.entries[place])
        )

    @property
    def text(self) -> str:
        """As a formula; of S as a form, beyond the plane."""
        if self.element is None or (self.power is None and not self.entry):
            return "0"
        if self.entry and self.form is not None:
            return self.form.text
        ring, x = self.element
        return ring.text(x)


_NOWHERE = Ring((), 0, spare=0)
_ZERO = _NOWHERE, _NOWHERE.zero
VANISHES = Leading(None, Decision(True))


class Expansion:
    """The Taylor coefficients in h, at h = 0, of a ring element.

    Of an element with 1/h in it they are those of hᵐ times it, whose first m must vanish.
    """

    def __init__(self, ring: Ring, x: Poly) -> None:
        self.ring = ring
        self.pole, x = _without_pole(ring, x)
        self.polynomial = not h_inside(ring, x)
        self._powers = ring.powers(x, "h") if self.polynomial else {}
        self._derivatives = [x]

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
        return QuotientSeries(self.ring, MOST_ORDERS + 2 + self.pole).of(self._derivatives[0])


def _without_pole(ring: Ring, x: Poly) -> tuple[int, Poly]:
    """m and hᵐ x, which has no 1/h in it."""
    h, gens = ring.variable("h"), ring.context.gens()
    pole = ring.find("inverse", h)
    parts = {0: x} if pole is None else split(x, gens.index(pole))
    most = max(parts, default=0)
    return most, ring.reduce(sum((c * h ** (most - n) for n, c in parts.items()), ring.zero))


# -- of a map --------------------------------------------------------------------------------------


class ClosedSeries:
    """The coefficients of z', S and det J − 1 of a map that is written out and no polynomial in h.

    Each is made when it is looked at, and has a ring of its own.
    """

    def __init__(self, closed: ClosedForm) -> None:
        self.closed, self.flow = closed, closed.field
        self._parts = [Expansion(closed.ring, x) for x in closed.elements]

    @cached_property
    def _entries(self) -> dict[Place, Expansion]:
        entries = self.closed.defect.entries
        return {at: Expansion(self.closed.ring, x) for at, x in entries.items()}

    @cached_property
    def _volume(self) -> Expansion:
        return Expansion(self.closed.ring, self.closed.delta_j)

    @property
    def polynomial(self) -> bool:
        """Whether each coordinate's new value is a polynomial in h."""
        return all(x.polynomial for x in self._parts)

    def agrees(
        self, n: int, nearly: Callable[[Poly, Poly], bool] | None = None
    ) -> tuple[bool | None, Ring, Poly]:
        """As of `DefectSeries`."""
        own = self.flow.ring
        for k, expansion in enumerate(self._parts):
            ring, gap = self._difference(k, n)
            if nearly is not None and ring is own and nearly(gap, expansion.coefficient(n)[1]):
                continue
            zero = ring.vanishes(gap)
            if zero is not True:
                return zero, ring, gap
        return True, own, own.zero

    def differences(self, n: int) -> tuple[Ring, list[Poly]]:
        """As of `DefectSeries`."""
        parts = [self._difference(k, n) for k in range(len(self._parts))]
        return _in_one_ring(parts, self.flow.ring)

    def _difference(self, k: int, n: int) -> tuple[Ring, Poly]:
        own, term = self.flow.ring, self.flow.term(n)[k]
        ring, x = self._parts[k].coefficient(n)
        if ring is own:
            return ring, ring.reduce(x - term)
        ring, (gap,) = embed([ring.expression(x) - own.expression(term)], own.variables)
        return ring, gap

    def in_one_field(
        self, hamiltonian: Hamiltonian, most: int, *others: sympy.Expr
    ) -> tuple[CanonicalField, list[list[Poly]], list[Poly]]:
        """The coefficients of h⁰ … h^most in each coordinate's new value, and other expressions,
        as elements of one ring."""
        parts = [x.coefficient(n) for x in self._parts for n in range(most + 1)]
        field, elements = self.flow, [x for _, x in parts]
        if others or not all(ring is field.ring for ring, _ in parts):
            own = (ring.expression(x) for ring, x in parts)
            field, elements = canonical_field(hamiltonian, *own, *others)
        size = len(parts)
        rows = [elements[at : at + most + 1] for at in range(0, size, most + 1)]
        return field, rows, elements[size:]

    def form(self, m: int) -> TwoForm:
        """The coefficient of hᵐ in S."""
        parts = [x.coefficient(m) for x in self._entries.values()]
        ring, elements = _in_one_ring(parts, self.closed.ring)
        made = dict(zip(self._entries, elements, strict=True))
        return TwoForm.of(ring, self.flow.names, lambda a, b: made.get((a, b), ring.zero))

    def volume(self, n: int) -> tuple[Ring, Poly]:
        """The coefficient of hⁿ in det J − 1."""
        return self._volume.coefficient(n)


def _in_one_ring(parts: Sequence[tuple[Ring, Poly]], otherwise: Ring) -> tuple[Ring, list[Poly]]:
    """Elements of several rings as elements of one."""
    if not parts:
        return otherwise, []
    ring, _ = parts[0]
    if all(other is ring for other, _ in parts):
        return ring, [x for _, x in parts]
    return embed([other.expression(x) for other, x in parts], otherwise.variables)


AnySeries: TypeAlias = "DefectSeries[CanonicalField] | ClosedSeries"


@lru_cache(maxsize=4)
def series_of(step_map: StepMap, first: int) -> AnySeries:
    """The coefficients of h⁰, h¹, … of one map, made as far as they are looked at; `first`: those
    that are made at once, of one that is known by its step."""
    begun = step_map.series(first)
    if begun is None:
        return ClosedSeries(step_map.flat)

    def made(most: int) -> tuple[CanonicalField, State]:
        more = begun if most == first else step_map.series(most)
        assert more is not None  # noqa: S101 - it has had fewer terms
        return more

    return DefectSeries(made, first, step_map.flow_up_to)
