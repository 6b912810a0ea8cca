"""The order in h of ΔJ for one Hamiltonian, and the order of the map itself.

A map that does nothing preserves area, so area alone proves no scheme: the Taylor coefficients of
p' and q' in h are held against those of the exact flow, Xⁿp/n! and Xⁿq/n!.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

import sympy

from verify.conditions import Condition
from verify.errors import InputError
from verify.formula import checked
from verify.generators import embed
from verify.hamiltonian import VectorField
from verify.ring import Decision, Poly, Ring
from verify.scheme import Scheme
from verify.series import Series, delta_j
from verify.step_map import H_STEP, StepMap, h_inside
from verify.verdict import Verdict

MOST_ORDERS = 12  # Taylor coefficients looked at where a map is not a polynomial in h
_FIRST_ORDERS = 6  # of them, those that are made at once


@dataclass(frozen=True)
class Proof:
    """What is proved of one step map.

    `order`: ΔJ = `leading`·h^order + O(h^(order+1)) with `leading` not the zero function; None
    where ΔJ ≡ 0 (`area_preserving` True) or where it is not decided (`area_preserving` None).
    `witness`: a point (p, q, parameters) at which `leading` is not zero; `enclosure`: its value.
    `convergence_order`: p', q' agree with the exact flow up to h to this power; None where all
    coefficients looked at agree. `verdict` is REFUTED for a map that is not a scheme for H at all,
    or misses the order its scheme claims; `reason` says what was found in one line.
    """

    verdict: Verdict
    reason: str
    order: int | None
    first: "Leading"
    area_preserving: bool | None
    convergence_order: int | None
    step_map: StepMap = field(repr=False, compare=False)
    witness: dict[str, Fraction] = field(default_factory=dict)
    enclosure: str = ""

    @property
    def leading(self) -> sympy.Expr:
        return self.first.coefficient

    @property
    def delta_j(self) -> sympy.Expr | None:
        """ΔJ in closed form, written out when it is asked for; None where it is too large."""
        return self.step_map.delta_j if self.step_map.written else None

    @property
    def consistent(self) -> bool:
        return self.convergence_order is None or self.convergence_order >= 1

    def _repr_html_(self) -> str:
        from verify.notebook import proof_html

        return proof_html(self)

    def _repr_latex_(self) -> str:
        from verify.notebook import proof_latex

        return proof_latex(self)


@dataclass(frozen=True)
class Leading:
    """The first coefficient in h that is not shown to vanish: of h^`power`, as a ring's element.

    `decision.zero` is False at a proved leading term, None at an undecided one, and True where
    every coefficient vanishes (`power` is None then). False with `power` None: ΔJ is not zero, but
    its leading term lies beyond the orders looked at.
    """

    power: int | None
    decision: Decision
    element: tuple[Ring, Poly] | None = None

    @cached_property
    def coefficient(self) -> sympy.Expr:
        """As an expression; 0 where there is none."""
        if self.element is None:
            return sympy.S.Zero
        ring, x = self.element
        return ring.factored(x)

    @property
    def text(self) -> str:
        """As a formula."""
        if self.element is None:
            return "0"
        ring, x = self.element
        return ring.text(x)


_VANISHES = Leading(None, Decision(True))


class Expansion:
    """The Taylor coefficients in h, at h = 0, of a ring element."""

    def __init__(self, ring: Ring, x: Poly) -> None:
        self.ring = ring
        self.polynomial = not h_inside(ring, x)
        self._powers = ring.powers(x, "h") if self.polynomial else {}
        self._derivatives = [x]

    @property
    def length(self) -> int:
        """How many coefficients there are to look at."""
        return max(self._powers, default=0) + 1 if self.polynomial else MOST_ORDERS + 1

    def coefficient(self, n: int) -> tuple[Ring, Poly]:
        """The coefficient of hⁿ, with the ring that it is an element of."""
        if self.polynomial:
            return self.ring, self._powers.get(n, self.ring.zero)
        while len(self._derivatives) <= n:
            self._derivatives.append(self.ring.diff(self._derivatives[-1], "h"))
        value = self.ring.expression(self._derivatives[n]).subs(H_STEP, 0)
        try:
            checked(value, "map", str(value))
        except InputError as error:
            raise InputError("map", error.value, "is not smooth in h at h = 0") from None
        ring, (x,) = embed([value / math.factorial(n)], self.ring.variables)
        return ring, x

    def leading(self) -> Leading:
        found = _first(self.coefficient, self.length)
        if found is None and not self.polynomial:
            return Leading(self.length, Decision(None))
        return found or _VANISHES


def _first(coefficient: Callable[[int], tuple[Ring, Poly]], length: int) -> Leading | None:
    """The first of the coefficients that is not shown to vanish; None where all are."""
    for n in range(length):
        ring, x = coefficient(n)
        decision = ring.decide(x)
        if decision.zero is not True:
            return Leading(n, decision, (ring, x))
    return None


def prove(step_map: StepMap, scheme: Scheme | None = None) -> Proof:
    """The order of ΔJ and of the map by exact algebra, and whether `scheme`'s claims hold."""
    convergence = convergence_of(step_map)
    leading = leading_of(step_map)
    verdict, reason = _verdict(convergence, leading, scheme)
    if leading.decision.zero is True and step_map.conditions:
        reason = f"{reason}, {_by_conditions(step_map.conditions)}"
    return Proof(
        verdict=verdict,
        reason=reason,
        order=leading.power if leading.decision.zero is False else None,
        first=leading,
        area_preserving=leading.decision.zero,
        convergence_order=convergence.order,
        step_map=step_map,
        witness=leading.decision.witness,
        enclosure=leading.decision.enclosure,
    )


def _by_conditions(conditions: Sequence[Condition]) -> str:
    first = conditions[0].name
    if len(conditions) == 1:
        return f"as {first} holds exactly, for every H"
    return f"as {len(conditions)} conditions on its coefficients hold exactly ({first}, …)"


class _BySeries:
    """The Taylor coefficients of p', q' and ΔJ of a map of several parts, without its closed form.

    They are made as far as they are looked at.
    """

    def __init__(self, step_map: StepMap) -> None:
        self.map = step_map
        self.made: tuple[VectorField, Series, Series] | None = None
        self.usable = step_map.of_parts and self.reach(_FIRST_ORDERS)

    def reach(self, n: int) -> bool:
        """Makes the coefficients up to hⁿ, and a few more; False where the map has none."""
        if self.made is None or self.made[1].most < n:
            most = max(_FIRST_ORDERS, min(n + 1, MOST_ORDERS))  # terms multiply with every order
            self.made = self.map.taylor(most)
        return self.made is not None

    def coefficients(self, n: int) -> tuple[VectorField, tuple[Poly, Poly]]:
        """Those of hⁿ in p' and q', and the vector field in their ring."""
        self.reach(n)
        assert self.made is not None  # noqa: S101 - the caller looks at `usable`
        field, p, q = self.made
        return field, (p.coefficients[n], q.coefficients[n])

    def of_delta_j(self, n: int) -> tuple[Ring, Poly]:
        self.reach(n)
        assert self.made is not None  # noqa: S101 - as above
        field, p, q = self.made
        return field.ring, delta_j(p, q).coefficients[n]


def leading_of(step_map: StepMap) -> Leading:
    """The first coefficient in h of ΔJ that is not shown to vanish."""
    if step_map.preserves_area:
        return _VANISHES
    series = _BySeries(step_map)
    if series.usable:
        return _leading_by(series, step_map)
    step = step_map.flat
    if step.preserves_area:
        return _VANISHES
    if step.degree is None:
        leading = Expansion(step.ring, step.delta_j).leading()
        if leading.decision.zero is None and leading.power == MOST_ORDERS + 1:
            # All coefficients looked at vanish; ΔJ itself may still be shown not to.
            return Leading(None, step.ring.decide(step.delta_j))
        return leading
    found = _first(lambda n: (step.ring, step.coefficient(n)), step.degree + 1)
    return found or _VANISHES


def _leading_by(series: _BySeries, step_map: StepMap) -> Leading:
    found = _first(series.of_delta_j, MOST_ORDERS + 1)
    if found is not None:
        return found
    whole = step_map.whole
    if whole.preserves_area:
        return _VANISHES
    if step_map.solved:
        return Leading(MOST_ORDERS + 1, Decision(None))
    decision = whole.ring.decide(whole.delta_j)
    return Leading(MOST_ORDERS + 1 if decision.zero is None else None, decision)


@dataclass(frozen=True)
class Convergence:
    """p', q' agree with the exact flow up to h^order, shown by algebra; None: in all looked at.

    `decided`: the next coefficient is shown to differ (or there is none). −1: they differ at h⁰.
    """

    order: int | None
    decided: bool

    def misses(self, claimed: int) -> bool:
        return self.order is not None and self.order < claimed


def convergence_of(step_map: StepMap) -> Convergence:
    """The order to which the map agrees with the exact flow."""
    known = step_map.known_order()
    if known is not None:
        return Convergence(known, decided=True)
    series = _BySeries(step_map)
    if series.usable:
        return _convergence_by(series)
    step = step_map.flat
    ring = step.ring
    pairs = [(step.p_next, ring.variable("p")), (step.q_next, ring.variable("q"))]
    expansions = [(Expansion(ring, x), [y]) for x, y in pairs]
    most = max(MOST_ORDERS, *(e.length for e, _ in expansions))
    for n in range(most + 1):
        for expansion, flow in expansions:
            if n == len(flow):
                flow.append(step.field.derive(flow[-1]))
            agrees = _agrees(expansion, n, ring, flow[n])
            if agrees is not True:
                return Convergence(n - 1, agrees is False)
    return Convergence(None, True)


def _convergence_by(series: _BySeries) -> Convergence:
    flow: tuple[Poly, Poly] | None = None
    for n in range(MOST_ORDERS + 1):
        field, own = series.coefficients(n)
        flow = own if flow is None else (field.derive(flow[0]), field.derive(flow[1]))
        for x, y in zip(own, flow, strict=True):
            agrees = field.ring.decide(x - y / math.factorial(n)).zero
            if agrees is not True:
                return Convergence(n - 1, agrees is False)
    return Convergence(None, True)


def _agrees(expansion: Expansion, n: int, ring: Ring, flow: Poly) -> bool | None:
    """Whether the coefficient of hⁿ is `flow`/n!; None where that is not decided."""
    own, x = expansion.coefficient(n)
    if own is ring:
        return ring.decide(x - flow / math.factorial(n)).zero
    gap = own.expression(x) - ring.expression(flow) / math.factorial(n)
    common, (difference,) = embed([gap], ring.variables)
    return common.decide(difference).zero


def _verdict(
    convergence: Convergence, leading: Leading, scheme: Scheme | None
) -> tuple[Verdict, str]:
    claimed = scheme.order if scheme else 1
    if convergence.misses(claimed):
        known = f"agrees with the exact flow up to h^{convergence.order}"
        if convergence.order == -1:
            known = "agrees with the exact flow not even at h = 0"
        if not convergence.decided:
            return Verdict.UNDECIDED, f"the map {known}; whether further is not decided"
        if scheme:
            return Verdict.REFUTED, f"{scheme.name} claims order {claimed}; the map {known} only"
        return Verdict.REFUTED, f"not a scheme for this H: the map {known} only"
    match leading.decision.zero:
        case True:
            return Verdict.PROVED, "ΔJ is the zero function: det J ≡ 1"
        case False if leading.power is None and not (scheme and scheme.area_preserving):
            return Verdict.PROVED, (
                f"ΔJ is not the zero function, and its coefficients up to h^{MOST_ORDERS} vanish"
            )
        case None:
            return Verdict.UNDECIDED, (
                f"the coefficient of h^{leading.power} in ΔJ is neither shown to vanish nor not to"
            )
    if scheme is not None and scheme.area_preserving:
        return Verdict.REFUTED, f"{scheme.name} claims det J ≡ 1; ΔJ has order {leading.power}"
    return Verdict.PROVED, (
        f"the coefficients of ΔJ below h^{leading.power} vanish identically, that of "
        f"h^{leading.power} does not"
    )
