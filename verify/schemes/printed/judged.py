"""The judgement of conditions by the digits of a printed table; see
`verify.schemes.printed.nearby`.

- PROVED or REFUTED by exact algebra where no coefficient is rounded;
- REFUTED where no numbers within ten units of the last digits satisfy all conditions, and a
  residual is larger than 10⁻⁹;
- ENCLOSED where exact ones are shown to exist there, or nearby where residuals are smaller: then
  digits are wrong, which is judged separately;
- MEASURED where neither is shown: the residuals are small.

A single misprinted number is looked for too: which it can be, and the value it would have to have.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.formula import symbol
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import Ball, is_representable, midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.schemes.printed.condition_set import BITS, ConditionSet, Equation
from verify.schemes.printed.nearby import AnyNumbers, Nearby, difference_step
from verify.schemes.printed.nearest import find_far_solution, nearest
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict

_TURNS = 9
_FEW = 8  # failing conditions used in the search for one number; then all are checked
_HELD = flint.arb(2) ** -150  # a residue that is 0, where no number is rounded
_CLOSE, _LARGEST = Fraction(1, 10**40), 10**12  # to a quotient, and its denominator at most
_MOST = 200  # entries among which one misprint is searched


@dataclass(frozen=True)
class Misprint:
    """A number that alone, with the value `value`, would make the conditions hold to the digits."""

    name: str
    printed: str
    value: Fraction


def misprints(near: Nearby, rows: Sequence[int], single: bool = False) -> tuple[Misprint, ...]:
    """Return the numbers of which the change of each alone would do; `single`: none where several
    would.

    Where only last digits are wrong, several seem to do: the digits of the others leave room.
    """
    failing = [i for i in rows if not _is_small(near, i, near.value[i])]
    few, every = failing[:_FEW] or list(rows[:_FEW]), range(len(near.names))
    each = tuple(m for k in every if (m := _single(near, k, rows, few)) is not None)
    return () if single and len(each) > 1 else each


def _single(near: Nearby, k: int, rows: Sequence[int], few: Sequence[int]) -> Misprint | None:
    """Solve for one number by Newton's method, in the sense of least squares."""
    numbers, value = list(near.start), near.value
    largest = max(abs(value[i]) for i in few)
    slope = [near.slope[i][k].mid() for i in few]
    for turn in range(_TURNS):
        if turn:
            shifted = near.shifted_residues(numbers, k, few)
            slope = [((shifted[i] - value[i]) / difference_step()).mid() for i in few]
        change = _least_squares(slope, [value[i] for i in few])
        if change is None:
            return None
        numbers[k] = (numbers[k] - change).mid()
        value = near.residues(numbers, few)
        # Most numbers fail here, after one step: only promising ones are iterated.
        if turn == 0 and not all(abs(value[i]) < largest for i in few):
            return None  # no change of this number alone brings them down
    if not all(_is_small(near, i, value[i]) for i in few):
        return None
    value = near.residues(numbers, rows)
    if not all(_is_small(near, i, value[i]) for i in rows):
        return None
    name = near.names[k]
    return Misprint(name, near.numbers.numbers[name], midpoint_and_radius(numbers[k])[0])


def _is_small(near: Nearby, i: int, value: Ball) -> bool:
    """Return True if a residual is as small as the digits allow."""
    pairs = zip(near.slope[i], near.unit, strict=True)
    return bool(abs(value) < sum((abs(d) * u for d, u in pairs), _HELD))


def _least_squares(slope: Sequence[Ball], value: Sequence[Ball]) -> Ball | None:
    square = sum((d * d for d in slope), flint.arb(0))
    if square == 0:
        return None
    return sum((d * v for d, v in zip(slope, value, strict=True)), flint.arb(0)) / square


# -- of exact tables ------------------------------------------------------------------------------


def find_exact_misprints(conditions: ConditionSet, order: int) -> tuple[Misprint, ...]:
    """Return the rational entries, not 0, each of which alone would do, with the quotient for
    it."""
    labels = conditions.labels
    if not labels or len(labels) > _MOST or not all(x.is_Rational for x in conditions.entries):
        return ()
    names = [f"x{k}" for k in range(len(labels))]
    values = {
        n: Fraction(int(x.p), int(x.q)) for n, x in zip(names, conditions.entries, strict=True)
    }
    texts = dict(zip(names, map(str, conditions.entries), strict=True))
    unknowns = AnyNumbers(texts, values, dict.fromkeys(names, _CLOSE**2))
    free = replace(conditions, entries=tuple(map(symbol, names)))
    with working_precision(BITS):
        near = misprints(Nearby(unknowns, free), conditions.up_to(order))
    each = (_by_quotient(conditions, order, names.index(m.name), m.value) for m in near)
    return tuple(m for m in each if m is not None)


def _by_quotient(conditions: ConditionSet, order: int, k: int, near: Fraction) -> Misprint | None:
    """Return entry k with the quotient near that value; None where the conditions do not hold with
    it."""
    value = near.limit_denominator(_LARGEST)
    if abs(value - near) > _CLOSE or value == conditions.entries[k]:
        return None
    entries = [flint.fmpq(int(x.p), int(x.q)) for x in conditions.entries]
    entries[k] = flint.fmpq(value.numerator, value.denominator)
    residues = conditions.residues(entries, flint.fmpq(1))
    if any(residues[i] != 0 for i in conditions.up_to(order)):
        return None
    return Misprint(conditions.labels[k], str(conditions.entries[k]), value)


WITHIN = 10  # units of the last digit, for the order
OF_DIGITS = Fraction(1, 10**9)  # a residue below it is of wrong digits, and not of a wrong method
AS_PRINTED = Fraction(1, 10**30)  # units within which a solution counts as the printed numbers
_AT_LEAST = Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED


@dataclass(frozen=True)
class Judged:
    """The judgement of conditions of orders up to a claimed one.

    `order`: the highest that is not excluded, of those tested. `failing`: the first condition that
    excludes more, with its `residue` as printed; `lower`: one of a lower order, whose residual is
    caused by wrong digits. `largest`: the largest residual of the claimed order's conditions.
    `off`: how far the printed number that is farthest from a solution's is from it, in units of its
    last digit, and `nearest` the solution's numbers; None where none is known. `shown`: the number
    of conditions shown to hold there, of `checked`; the others do to 60 digits. `digits`: whether
    all digits are right to one unit of the last; None where it is not known. `misprints`: the
    numbers of which each alone explains it. `residues`: all of them as printed, with their orders.
    `read`: the numbers as they were read.
    """

    verdict: Verdict
    order: int
    checked: int
    failing: Equation | None = None
    residue: Fraction = Fraction(0)
    largest: Fraction = Fraction(0)
    off: Fraction | None = None
    nearest: Mapping[str, Fraction] | None = None
    shown: int | None = None
    digits: bool | None = None
    misprints: tuple[Misprint, ...] = ()
    residues: tuple[tuple[Equation, Fraction], ...] = ()
    read: PrintedNumbers | None = None
    lower: tuple[Equation, Fraction] | None = None

    @property
    def misprint(self) -> Misprint | None:
        """The one number that alone explains it; None where none does, or each of several."""
        return self.misprints[0] if len(self.misprints) == 1 else None

    @property
    def holds(self) -> bool:
        """True if nothing speaks against the claim."""
        return self.verdict in _AT_LEAST


def judge(numbers: PrintedNumbers, conditions: ConditionSet, order: int) -> Judged:
    """Judge whether the conditions of orders 1 … `order` can hold; those beyond tell where it ends.

    Of the conditions of higher orders only the failing one counts.
    """
    if not conditions.equations:  # they hold by the form of the table
        return Judged(Verdict.PROVED, order, conditions.by_form, read=numbers)
    if not numbers.units:
        return replace(_judge_exact(conditions, order, numbers.tentative), read=numbers)
    with working_precision(BITS):
        return replace(_judge_rounded(Nearby(numbers, conditions), order, numbers), read=numbers)


def _judge_rounded(near: Nearby, order: int, numbers: PrintedNumbers) -> Judged:
    """Judge a table with rounded numbers."""
    equations, rows = near.conditions.equations, near.conditions.up_to(order)
    every = range(len(equations))
    checked = len(rows) + near.conditions.by_form
    wrong = near.find_excluded(every, WITHIN)
    # A residual that wrong last digits can cause does not end the order while a larger one does.
    plain = [k for k in wrong if abs(near.at_print[k]) > OF_DIGITS]
    # The condition that ends the order, if any does.
    failing = min(plain or wrong, key=lambda k: equations[k].order, default=None)
    highest = max((e.order for e in equations), default=order)
    order_allowed = max(highest, order) if failing is None else equations[failing].order - 1
    largest = max((abs(near.at_print[k]) for k in rows), default=Fraction(0))
    condition = None if failing is None else equations[failing]
    size = Fraction(0) if failing is None else near.at_print[failing]
    residues = tuple(zip(equations, near.at_print, strict=True))
    first = min(wrong, key=lambda k: equations[k].order, default=None)
    judgement = Judged(
        Verdict.MEASURED, order_allowed, checked, condition, size, largest, residues=residues
    )
    if first is not None and condition is not None and equations[first].order < condition.order:
        judgement = replace(judgement, lower=residues[first])
    # A residual that is too large for wrong digits refutes the method itself.
    if order_allowed < order and largest > OF_DIGITS:
        judgement = replace(judgement, verdict=Verdict.REFUTED, digits=False)
        if numbers.tentative:
            return judgement
        judgement = replace(
            judgement, misprints=misprints(near, rows) if near.conditions.labels else ()
        )
        solution = nearest(near, rows) or (
            find_far_solution(near, rows) if judgement.misprint is None else None
        )
        return (
            judgement
            if solution is None
            else replace(judgement, off=solution.off, nearest=solution.numbers)
        )
    return _with_nearest(judgement, near, rows, order, numbers.slack)


def _with_nearest(
    judgement: Judged, near: Nearby, rows: Sequence[int], order: int, slack: int
) -> Judged:
    """Add the nearest solution, if there is one, and its consequences for verdict and digits."""
    order_allowed, largest = judgement.order, judgement.largest
    solution = nearest(near, rows)
    if solution is None:  # some conditions alone may show wrong digits
        digits = False if near.find_excluded(rows, slack) else None
        some = misprints(near, rows, single=True) if order_allowed < order else ()
        return replace(judgement, digits=digits, misprints=some)
    off = solution.off
    wrong_digits = off > slack and (order_allowed < order or near.has_no_solution(rows, slack))
    some = misprints(near, rows, single=True) if wrong_digits and off > WITHIN else ()
    digits = True if off <= slack else False if wrong_digits else None
    if off < AS_PRINTED and solution.shown < len(near.names):
        digits = None  # any others of those that are free would do as well
    is_close = order_allowed >= order and off <= WITHIN
    verdict = Verdict.ENCLOSED if is_close or largest <= OF_DIGITS else Verdict.MEASURED
    if off > WITHIN and largest > OF_DIGITS and near.has_no_solution(rows, WITHIN):
        verdict = Verdict.REFUTED
    final_order = max(order_allowed, order) if verdict is Verdict.ENCLOSED else order_allowed
    if verdict is Verdict.ENCLOSED and solution.shown < len(rows):
        verdict = Verdict.MEASURED
    result = replace(judgement, verdict=verdict, order=final_order, digits=digits, misprints=some)
    return replace(
        result, off=off, nearest=solution.numbers, shown=solution.shown + near.conditions.by_form
    )


# -- exactly --------------------------------------------------------------------------------------


def _judge_exact(conditions: ConditionSet, order: int, tentative: bool) -> Judged:
    """Judge exact coefficients; `tentative`: without a search for a misprinted one."""
    equations, gaps = conditions.equations, exact_residues(conditions)
    checked = len(conditions.up_to(order)) + conditions.by_form
    wrong = [k for k, (zero, _) in enumerate(gaps) if zero is False]
    unknown = [k for k, (zero, _) in enumerate(gaps) if zero is None]
    failing = min(wrong, key=lambda k: equations[k].order, default=None)
    highest = max((e.order for e in equations), default=order)
    order_allowed = max(highest, order) if failing is None else equations[failing].order - 1
    verdict = Verdict.PROVED if order_allowed >= order else Verdict.REFUTED
    if verdict is Verdict.PROVED and any(equations[k].order <= order for k in unknown):
        verdict = Verdict.UNDECIDED
    sizes = tuple((e, x) for e, (_, x) in zip(equations, gaps, strict=True))
    largest = max((abs(x) for e, x in sizes if e.order <= order), default=Fraction(0))
    if failing is None:
        return Judged(verdict, order_allowed, checked, largest=largest, residues=sizes)
    look_for_misprints = verdict is Verdict.REFUTED and not tentative
    some = find_exact_misprints(conditions, order) if look_for_misprints else ()
    judgement = Judged(
        verdict, order_allowed, checked, equations[failing], gaps[failing][1], largest
    )
    return replace(judgement, residues=sizes, misprints=some)


def exact_residues(conditions: ConditionSet) -> list[tuple[bool | None, Fraction]]:
    """Return for each condition whether it is 0, None where that is not decided, and its size,
    nearly."""
    if all(x.is_Rational for x in conditions.entries):
        entries = [flint.fmpq(int(x.p), int(x.q)) for x in conditions.entries]
        residues = conditions.residues(entries, flint.fmpq(1))
        return [(x == 0, Fraction(int(x.p), int(x.q))) for x in residues]
    ring, elements = embed(list(conditions.entries), ())
    return [_in_ring(ring, x) for x in conditions.residues(elements, ring.one)]


def _in_ring(ring: Ring, gap: Poly) -> tuple[bool | None, Fraction]:
    gap = ring.reduce(gap)
    zero = ring.decide(gap).zero
    if zero:
        return True, Fraction(0)
    value = enclose(ring, gap, {}, BITS)
    size = (
        midpoint_and_radius(value)[0]
        if value is not None and is_representable(value)
        else Fraction(0)
    )
    return zero, size
