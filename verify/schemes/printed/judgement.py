"""The judgement of conditions by the digits of a printed table; see
`verify.schemes.printed.neighbourhood`.

- PROVED or REFUTED by exact algebra if no coefficient is rounded; UNDECIDED if the algebra does not
  decide;
- REFUTED if no numbers within ten units of the last digits satisfy all conditions, and a residual
is
  larger than 10⁻⁹;
- ENCLOSED if exact solutions are shown to exist within ten units, or farther away if residuals are
  smaller: then digits are wrong, which is judged separately;
- MEASURED if neither is shown: the residuals are small.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

import flint

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.schemes.printed.condition_set import BITS, ConditionSet, Equation
from verify.schemes.printed.neighbourhood import Neighbourhood
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.schemes.printed.solutions import (
    Misprint,
    find_exact_misprints,
    find_far_solution,
    misprints,
    nearest,
)
from verify.verdict import Verdict

WITHIN = 10  # units of the last digit, within which exact numbers have the order
OF_DIGITS = Fraction(1, 10**9)  # a smaller residual is that of wrong digits, not a wrong method
AS_PRINTED = Fraction(1, 10**30)  # units; a nearer solution counts as the printed numbers
_HOLDING_VERDICTS = Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED


@dataclass(frozen=True)
class Judgement:
    """The judgement of conditions of orders up to a claimed one.

    - `order`: the highest tested order that is not excluded.
    - `checked`: the number of conditions up to the claimed order.
    - `failing`: the first condition that excludes a higher order, with its `residual` at the
    printed
      numbers; `lower_failure`: one of a lower order, whose residual is that of wrong digits.
    - `largest_residual`: the largest of the conditions up to the claimed order.
    - `nearest`: the numbers of a solution, None if none is known; `distance`: the largest distance
    of
      a printed number from it, in units of the last digit.
    - `shown_count`: how many of the `checked` conditions are shown to hold there; the others hold
    to
      60 digits.
    - `digits`: True if all digits are right to one unit of the last; None if not known.
    - `misprints`: the numbers each of which, changed alone, would explain the residuals.
    - `residuals`: those of all conditions at the printed numbers.
    - `numbers`: the printed numbers as they were read.
    """

    verdict: Verdict
    order: int
    checked: int
    failing: Equation | None = None
    residual: Fraction = Fraction(0)
    largest_residual: Fraction = Fraction(0)
    distance: Fraction | None = None
    nearest: Mapping[str, Fraction] | None = None
    shown_count: int | None = None
    digits: bool | None = None
    misprints: tuple[Misprint, ...] = ()
    residuals: tuple[tuple[Equation, Fraction], ...] = ()
    numbers: PrintedNumbers | None = None
    lower_failure: tuple[Equation, Fraction] | None = None

    @property
    def misprint(self) -> Misprint | None:
        """The one number that alone explains the residuals; None if none or several would."""
        return self.misprints[0] if len(self.misprints) == 1 else None

    @property
    def holds(self) -> bool:
        """True if the verdict is PROVED, ENCLOSED or MEASURED."""
        return self.verdict in _HOLDING_VERDICTS


def judge(numbers: PrintedNumbers, conditions: ConditionSet, order: int) -> Judgement:
    """Judge whether the conditions of orders 1 … `order` can hold.

    Conditions of higher orders tell where the order ends.
    """
    if not conditions.equations:  # they hold by the form of the table
        return Judgement(Verdict.PROVED, order, conditions.held_by_form, numbers=numbers)
    if not numbers.units:
        return replace(_judge_exact(conditions, order, numbers.tentative), numbers=numbers)
    with working_precision(BITS):
        judgement = _judge_rounded(Neighbourhood(numbers, conditions), order, numbers)
        return replace(judgement, numbers=numbers)


def _judge_rounded(near: Neighbourhood, order: int, numbers: PrintedNumbers) -> Judgement:
    """Judge a table with rounded numbers."""
    equations, rows = near.conditions.equations, near.conditions.up_to(order)
    checked = len(rows) + near.conditions.held_by_form
    wrong = near.find_excluded(range(len(equations)), WITHIN)
    # If some residual is too large for wrong digits, the small ones do not end the order.
    plain = [k for k in wrong if abs(near.printed_residuals[k]) > OF_DIGITS]
    # The condition that ends the order, if any does.
    failing = min(plain or wrong, key=lambda k: equations[k].order, default=None)
    highest = max((e.order for e in equations), default=order)
    order_allowed = max(highest, order) if failing is None else equations[failing].order - 1
    largest = max((abs(near.printed_residuals[k]) for k in rows), default=Fraction(0))
    condition = None if failing is None else equations[failing]
    size = Fraction(0) if failing is None else near.printed_residuals[failing]
    residuals = tuple(zip(equations, near.printed_residuals, strict=True))
    first = min(wrong, key=lambda k: equations[k].order, default=None)
    judgement = Judgement(
        Verdict.MEASURED, order_allowed, checked, condition, size, largest, residuals=residuals
    )
    if first is not None and condition is not None and equations[first].order < condition.order:
        judgement = replace(judgement, lower_failure=residuals[first])
    # A residual that is too large for wrong digits refutes the method itself.
    if order_allowed < order and largest > OF_DIGITS:
        judgement = replace(judgement, verdict=Verdict.REFUTED, digits=False)
        if numbers.tentative:
            return judgement
        suspects = misprints(near, rows) if near.conditions.entry_names else ()
        judgement = replace(judgement, misprints=suspects)
        solution = nearest(near, rows)
        if solution is None and judgement.misprint is None:
            solution = find_far_solution(near, rows)
        if solution is None:
            return judgement
        return replace(judgement, distance=solution.distance, nearest=solution.numbers)
    return _with_nearest(judgement, near, rows, order, numbers.slack)


def _with_nearest(
    judgement: Judgement, near: Neighbourhood, rows: Sequence[int], order: int, slack: int
) -> Judgement:
    """Add the nearest solution, if there is one, and its consequences for verdict and digits."""
    order_allowed, largest = judgement.order, judgement.largest_residual
    solution = nearest(near, rows)
    if solution is None:  # a single condition may still exclude the digits
        digits = False if near.find_excluded(rows, slack) else None
        suspects = misprints(near, rows, single=True) if order_allowed < order else ()
        return replace(judgement, digits=digits, misprints=suspects)
    distance = solution.distance
    wrong_digits = distance > slack and (order_allowed < order or near.has_no_solution(rows, slack))
    suspects = misprints(near, rows, single=True) if wrong_digits and distance > WITHIN else ()
    digits = True if distance <= slack else False if wrong_digits else None
    if distance < AS_PRINTED and solution.shown_count < len(near.names):
        digits = None  # the conditions leave some numbers free: they do not tell these digits
    is_close = order_allowed >= order and distance <= WITHIN
    verdict = Verdict.ENCLOSED if is_close or largest <= OF_DIGITS else Verdict.MEASURED
    if distance > WITHIN and largest > OF_DIGITS and near.has_no_solution(rows, WITHIN):
        verdict = Verdict.REFUTED
    final_order = max(order_allowed, order) if verdict is Verdict.ENCLOSED else order_allowed
    if verdict is Verdict.ENCLOSED and solution.shown_count < len(rows):
        verdict = Verdict.MEASURED
    shown_count = solution.shown_count + near.conditions.held_by_form
    judgement = replace(judgement, verdict=verdict, order=final_order, shown_count=shown_count)
    judgement = replace(judgement, distance=distance, nearest=solution.numbers)
    return replace(judgement, digits=digits, misprints=suspects)


# -- exact coefficients ---------------------------------------------------------------------------


def _judge_exact(conditions: ConditionSet, order: int, tentative: bool) -> Judgement:
    """Judge exact coefficients; `tentative`: True for no search of a misprint."""
    equations, residuals = conditions.equations, _exact_residuals(conditions)
    checked = len(conditions.up_to(order)) + conditions.held_by_form
    wrong = [k for k, x in enumerate(residuals) if x.is_zero is False]
    unknown = [k for k, x in enumerate(residuals) if x.is_zero is None]
    failing = min(wrong, key=lambda k: equations[k].order, default=None)
    highest = max((e.order for e in equations), default=order)
    order_allowed = max(highest, order) if failing is None else equations[failing].order - 1
    verdict = Verdict.PROVED if order_allowed >= order else Verdict.REFUTED
    if verdict is Verdict.PROVED and any(equations[k].order <= order for k in unknown):
        verdict = Verdict.UNDECIDED
    sizes = tuple((e, x.size) for e, x in zip(equations, residuals, strict=True))
    largest = max((abs(x) for e, x in sizes if e.order <= order), default=Fraction(0))
    if failing is None:
        return Judgement(verdict, order_allowed, checked, largest_residual=largest, residuals=sizes)
    look_for_misprints = verdict is Verdict.REFUTED and not tentative
    suspects = find_exact_misprints(conditions, order) if look_for_misprints else ()
    judgement = Judgement(
        verdict, order_allowed, checked, equations[failing], residuals[failing].size, largest
    )
    return replace(judgement, residuals=sizes, misprints=suspects)


class _ExactResidual(NamedTuple):
    """A residual: `is_zero` is None if that is not decided; `size` is an approximate value."""

    is_zero: bool | None
    size: Fraction


def _exact_residuals(conditions: ConditionSet) -> list[_ExactResidual]:
    """Return the residuals of all conditions."""
    if all(x.is_Rational for x in conditions.entries):
        entries = [flint.fmpq(int(x.p), int(x.q)) for x in conditions.entries]
        residuals = conditions.residuals(entries, flint.fmpq(1))
        return [_ExactResidual(x == 0, Fraction(int(x.p), int(x.q))) for x in residuals]
    ring, elements = embed(list(conditions.entries), ())
    return [_exact_residual(ring, x) for x in conditions.residuals(elements, ring.one)]


def _exact_residual(ring: Ring, gap: Poly) -> _ExactResidual:
    gap = ring.reduce(gap)
    zero = ring.decide(gap).zero
    if zero:
        return _ExactResidual(True, Fraction(0))
    value = enclose(ring, gap, {}, BITS)
    if value is None or not is_representable(value):
        return _ExactResidual(zero, Fraction(0))
    return _ExactResidual(zero, midpoint_and_radius(value)[0])
