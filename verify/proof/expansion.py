"""The Taylor coefficients in h of a ring element, and the first of them that does not vanish."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial
from typing import TypeAlias

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.identities.polynomials import split
from verify.algebra.limits import check_expression
from verify.algebra.power_series import QuotientSeries, Series
from verify.algebra.ring import Decision, Poly, Ring
from verify.errors import InputError, LimitError
from verify.hamiltonians.canonical_field import PlainField, field_of
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.proof.parameters import not_zero_for
from verify.schemes.maps.closed_form import ClosedForm, h_inside
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.defect import DefectSeries
from verify.schemes.steps.step_algebra import State
from verify.schemes.steps.two_form import Place, TwoForm

_SHORT = 6  # coefficients that are expanded at once
MOST_ORDERS = 12  # Taylor coefficients examined if a map is not a polynomial in h


@dataclass(frozen=True)
class Leading:
    """The leading coefficient: the first in h, of h^`power`, that is not shown to vanish.

    `decision.zero` is False if the leading term is proved, None if it is undecided, and True if all
    coefficients vanish; then `power` is None. False with `power` None: the expanded element is not
    zero, but its leading term lies beyond the examined orders; `element` is then the element
    itself.

    For S, `form` is the coefficient, a 2-form, and `element` its entry at `place`, which decides.
    """

    power: int | None
    decision: Decision
    element: tuple[Ring, Poly] | None = None
    form: TwoForm | None = field(default=None, repr=False)
    place: Place | None = None

    @classmethod
    def of_form(cls, power: int | None, form: TwoForm, ring: Ring) -> Leading:
        """Return the leading coefficient `form` of h^power in S; power None: `form` is S itself."""
        decision, place = form.decide()
        if place is None:
            return VANISHES
        return cls(power, decision, (ring, form.entries[place]), form, place)

    @cached_property
    def coefficient(self) -> sympy.Expr:
        """The coefficient as an expression; 0 if there is none."""
        if self.element is None or self.power is None:
            return sympy.S.Zero
        ring, x = self.element
        return ring.as_product(x)

    @property
    def entry(self) -> str:
        """The name of the entry of S that decides, such as dp1∧dq2; empty in the plane."""
        if self.form is None or self.place is None or self.form.names == PLANE:
            return ""
        return self.form.entry_name(self.place)

    @cached_property
    def domain(self) -> FormulaDomain:
        """The parameters for which the coefficient, if proved, is not the zero function of z."""
        if self.decision.zero is not False or self.element is None:
            return EVERYWHERE
        if self.power is None and not self.entry:
            return EVERYWHERE
        what = f"the coefficient of h^{self.power}"
        return not_zero_for(*self.element, f"the entry {self.entry} of S" if self.entry else what)

    def restrict_to(self, domain: FormulaDomain) -> Leading:
        """Return the coefficient decided in a domain: undecided if no witness is found there."""
        if self.decision.zero is None or not domain.requirements:
            return self
        ring, x = self.element or _ZERO_ELEMENT  # VANISHES has no element
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
        """The coefficient as a formula; in n degrees of freedom the whole 2-form."""
        if self.element is None or (self.power is None and not self.entry):
            return "0"
        if self.entry and self.form is not None:
            return self.form.text
        ring, x = self.element
        return ring.text(x)


_CONSTANTS = Ring((), 0, spare=0)
_ZERO_ELEMENT = _CONSTANTS, _CONSTANTS.zero
VANISHES = Leading(None, Decision(True))


class TaylorExpansion:
    """The Taylor coefficients in h, at h = 0, of a ring element.

    An element with 1/h in it is first multiplied by hᵐ; then the first m coefficients must vanish,
    or LimitError is raised.
    """

    def __init__(self, ring: Ring, x: Poly) -> None:
        self.ring = ring
        self.pole, x = _without_pole(ring, x)
        self.polynomial = not h_inside(ring, x)
        self._powers = ring.powers(x, "h") if self.polynomial else {}
        self._derivatives = [x]
        self._coefficients: dict[int, tuple[Ring, Poly]] = {}

    def coefficient(self, n: int) -> tuple[Ring, Poly]:
        """Return the coefficient of hⁿ, with its ring; it is computed once."""
        if not self._smooth:
            text = self.ring.text(self._derivatives[0])
            raise LimitError("map", f"({text})/h**{self.pole}", "is not smooth in h at h = 0")
        if n not in self._coefficients:
            self._coefficients[n] = self._without_pole(n + self.pole)
        return self._coefficients[n]

    @cached_property
    def _smooth(self) -> bool:
        parts = map(self._without_pole, range(self.pole))
        return all(ring.vanishes(x) is True for ring, x in parts)

    def _without_pole(self, n: int) -> tuple[Ring, Poly]:
        if self.polynomial:
            return self.ring, self._powers.get(n, self.ring.zero)
        quotient = self._short if n < _SHORT else self._long
        if quotient is not None:
            return self.ring, quotient.coefficients[n]
        while len(self._derivatives) <= n:
            self._derivatives.append(self.ring.diff(self._derivatives[-1], "h"))
        # Taylor's formula: the n-th derivative by h at h = 0, divided by n!.
        value = self.ring.expression_at(self._derivatives[n], {symbol("h"): sympy.S.Zero})
        try:
            check_expression(value, "map", "")
        except InputError:
            raise LimitError("map", str(value), "is not smooth in h at h = 0") from None
        ring, (x,) = embed([value / math.factorial(n)], self.ring.variables)
        return ring, x

    @cached_property
    def _short(self) -> Series | None:
        """The first coefficients in h, if they need no derivatives; see `QuotientSeries`."""
        return QuotientSeries(self.ring, _SHORT).expand(self._derivatives[0])

    @cached_property
    def _long(self) -> Series | None:
        length = MOST_ORDERS + 2 + self.pole
        return self._short and QuotientSeries(self.ring, length).expand(self._derivatives[0])


def _without_pole(ring: Ring, x: Poly) -> tuple[int, Poly]:
    """Return (m, hᵐ x) with the least m for which hᵐ x has no 1/h."""
    h, gens = ring.variable("h"), ring.context.gens()
    # 1/h is a generator w. With m the highest power of w, hᵐ Σ c_n wⁿ = Σ c_n h^(m−n).
    pole = ring.find("inverse", h)
    parts = {0: x} if pole is None else split(x, gens.index(pole))
    most = max(parts, default=0)
    return most, ring.reduce(sum((c * h ** (most - n) for n, c in parts.items()), ring.zero))


# -- maps ------------------------------------------------------------------------------------------


class ClosedSeries:
    """The series of z', S and det J − 1 of a map in closed form that is no polynomial in h.

    Each coefficient is computed when it is used, and may have its own ring.
    """

    def __init__(self, closed: ClosedForm) -> None:
        self.closed, self.flow = closed, closed.field
        self._parts = [TaylorExpansion(closed.ring, x) for x in closed.elements]

    @cached_property
    def _entries(self) -> dict[Place, TaylorExpansion]:
        entries = self.closed.defect.entries
        return {place: TaylorExpansion(self.closed.ring, x) for place, x in entries.items()}

    @cached_property
    def _volume(self) -> TaylorExpansion:
        return TaylorExpansion(self.closed.ring, self.closed.delta_j)

    @property
    def polynomial(self) -> bool:
        """True if each coordinate's new value is a polynomial in h."""
        return all(x.polynomial for x in self._parts)

    def agrees(
        self, n: int, nearly: Callable[[Poly, Poly], bool] | None = None
    ) -> tuple[bool | None, Ring, Poly]:
        """Compare the coefficients of hⁿ in z' with the exact flow's, as `DefectSeries.agrees`."""
        flow_ring = self.flow.ring
        for k, expansion in enumerate(self._parts):
            ring, residual = self._difference(k, n)
            if (
                nearly is not None
                and ring is flow_ring
                and nearly(residual, expansion.coefficient(n)[1])
            ):
                continue
            zero = ring.vanishes(residual)
            if zero is not True:
                return zero, ring, residual
        return True, flow_ring, flow_ring.zero

    def differences(self, n: int) -> tuple[Ring, list[Poly]]:
        """Return the coefficients of hⁿ in z' less those of the exact flow, in one ring."""
        parts = [self._difference(k, n) for k in range(len(self._parts))]
        return _in_one_ring(parts, self.flow.ring)

    def _difference(self, k: int, n: int) -> tuple[Ring, Poly]:
        flow_ring, term = self.flow.ring, self.flow.term(n)[k]
        ring, x = self._parts[k].coefficient(n)
        if ring is flow_ring:
            return ring, ring.reduce(x - term)
        ring, (residual,) = embed(
            [ring.expression(x) - flow_ring.expression(term)], flow_ring.variables
        )
        return ring, residual

    def in_one_field(
        self, hamiltonian: Hamiltonian, most: int, *extra: sympy.Expr
    ) -> tuple[PlainField, list[list[Poly]], list[Poly]]:
        """Return a field, and over its ring the coefficients in z' and the expressions `extra`.

        A row has the coefficients of h⁰ … h^most in one coordinate's new value.
        """
        parts = [x.coefficient(n) for x in self._parts for n in range(most + 1)]
        field, elements = self.flow, [x for _, x in parts]
        # Generators differ from ring to ring: coefficients are added only in a common ring.
        if extra or not all(ring is field.ring for ring, _ in parts):
            expressions = (ring.expression(x) for ring, x in parts)
            field, elements = field_of(hamiltonian, *expressions, *extra)
        size = len(parts)
        rows = [elements[start : start + most + 1] for start in range(0, size, most + 1)]
        return field, rows, elements[size:]

    def form(self, m: int) -> TwoForm:
        """Return the coefficient of hᵐ in S."""
        parts = [x.coefficient(m) for x in self._entries.values()]
        ring, elements = _in_one_ring(parts, self.closed.ring)
        entries = dict(zip(self._entries, elements, strict=True))
        return TwoForm.from_entries(
            ring, self.flow.names, lambda a, b: entries.get((a, b), ring.zero)
        )

    def volume(self, n: int) -> tuple[Ring, Poly]:
        """Return the coefficient of hⁿ in det J − 1."""
        return self._volume.coefficient(n)


def _in_one_ring(parts: Sequence[tuple[Ring, Poly]], otherwise: Ring) -> tuple[Ring, list[Poly]]:
    """Embed elements of several rings in one; `otherwise`: the ring if there are none."""
    if not parts:
        return otherwise, []
    ring, _ = parts[0]
    if all(part_ring is ring for part_ring, _ in parts):
        return ring, [x for _, x in parts]
    return embed([part_ring.expression(x) for part_ring, x in parts], otherwise.variables)


AnySeries: TypeAlias = "DefectSeries[PlainField] | ClosedSeries"


@lru_cache(maxsize=4)
def closed_series_of(step_map: StepMap) -> ClosedSeries:
    """Return the series of a map that is written out; LimitError for another map."""
    return ClosedSeries(step_map.flat)


@lru_cache(maxsize=4)
def series_of(step_map: StepMap, first: int) -> AnySeries:
    """Return the series of a map in h, computed only as far as it is used.

    `first`: the power up to which a map that is given by its step is expanded at once.
    """
    initial = step_map.series(first)
    if initial is None:
        return closed_series_of(step_map)

    def extend(most: int) -> tuple[PlainField, State]:
        longer = initial if most == first else step_map.series(most)
        assert longer is not None  # noqa: S101 - `initial` is one
        return longer

    return DefectSeries(extend, first, step_map.flow_up_to)
