"""What the digits of a printed table can say of conditions; see `verify.schemes.printed.nearby`.

- PROVED or REFUTED by exact algebra where no coefficient is rounded;
- REFUTED where no numbers within ten units of the last digits satisfy all conditions, and a residue
  is larger than 10⁻⁹;
- ENCLOSED where exact ones are shown to exist there, or nearby where residues are smaller: then it
  is digits that are wrong, which is judged apart;
- MEASURED where neither is shown: the residues are small.

One number alone that is misprinted: which it can be, and what it would have to be.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose
from verify.algebra.formula import symbol
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import Ball, in_reach, middle_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.schemes.printed.asked import BITS, Asked, Equation
from verify.schemes.printed.nearby import AnyNumbers, Nearby, small
from verify.schemes.printed.nearest import far, nearest
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict

_TURNS = 9
_FEW = 8  # failing conditions by which one number is looked for; then all are looked at
_HELD = flint.arb(2) ** -150  # a residue that is 0, where no number is rounded
_CLOSE, _LARGEST = Fraction(1, 10**40), 10**12  # to a quotient, and its denominator at most
_MOST = 200  # entries of which one is looked for


@dataclass(frozen=True)
class Misprint:
    """One number alone that, were it `value`, would make the conditions hold to the digits."""

    name: str
    printed: str
    value: Fraction


def misprints(near: Nearby, rows: Sequence[int], single: bool = False) -> tuple[Misprint, ...]:
    """The numbers of which the change of each alone would do; `single`: none where several would.

    Where only last digits are wrong, several seem to do: the digits of the others leave room.
    """
    failing = [i for i in rows if not _is_small(near, i, near.value[i])]
    few, every = failing[:_FEW] or list(rows[:_FEW]), range(len(near.names))
    each = tuple(m for k in every if (m := _single(near, k, rows, few)) is not None)
    return () if single and len(each) > 1 else each


def _single(near: Nearby, k: int, rows: Sequence[int], few: Sequence[int]) -> Misprint | None:
    """By Newton's method for one unknown, in the sense of least squares."""
    at, value = list(near.start), near.value
    largest = max(abs(value[i]) for i in few)
    slope = [near.slope[i][k].mid() for i in few]
    for turn in range(_TURNS):
        if turn:
            there = near.moved(at, k, few)
            slope = [((there[i] - value[i]) / small()).mid() for i in few]
        change = _least_squares(slope, [value[i] for i in few])
        if change is None:
            return None
        at[k] = (at[k] - change).mid()
        value = near.residues(at, few)
        if turn == 0 and not all(abs(value[i]) < largest for i in few):
            return None  # no change of this number alone brings them down
    if not all(_is_small(near, i, value[i]) for i in few):
        return None
    value = near.residues(at, rows)
    if not all(_is_small(near, i, value[i]) for i in rows):
        return None
    name = near.names[k]
    return Misprint(name, near.numbers.numbers[name], middle_and_radius(at[k])[0])


def _is_small(near: Nearby, i: int, value: Ball) -> bool:
    """Whether a residue is what the digits leave of it."""
    pairs = zip(near.slope[i], near.unit, strict=True)
    return bool(abs(value) < sum((abs(d) * u for d, u in pairs), _HELD))


def _least_squares(slope: Sequence[Ball], value: Sequence[Ball]) -> Ball | None:
    square = sum((d * d for d in slope), flint.arb(0))
    if square == 0:
        return None
    return sum((d * v for d, v in zip(slope, value, strict=True)), flint.arb(0)) / square


# -- of exact tables ------------------------------------------------------------------------------


def exact_misprints(asked: Asked, order: int) -> tuple[Misprint, ...]:
    """Of rational entries that are not 0: each that alone would do, with the quotient for it."""
    labels = asked.labels
    if not labels or len(labels) > _MOST or not all(x.is_Rational for x in asked.entries):
        return ()
    names = [f"x{k}" for k in range(len(labels))]
    values = {n: Fraction(int(x.p), int(x.q)) for n, x in zip(names, asked.entries, strict=True)}
    texts = dict(zip(names, map(str, asked.entries), strict=True))
    unknowns = AnyNumbers(texts, values, dict.fromkeys(names, _CLOSE**2))
    free = replace(asked, entries=tuple(map(symbol, names)))
    with working_precision(BITS):
        near = misprints(Nearby(unknowns, free), asked.up_to(order))
    each = (_by_quotient(asked, order, names.index(m.name), m.value) for m in near)
    return tuple(m for m in each if m is not None)


def _by_quotient(asked: Asked, order: int, k: int, near: Fraction) -> Misprint | None:
    """Entry k with the quotient near that value; None where the conditions do not hold with it."""
    value = near.limit_denominator(_LARGEST)
    if abs(value - near) > _CLOSE or value == asked.entries[k]:
        return None
    entries = [flint.fmpq(int(x.p), int(x.q)) for x in asked.entries]
    entries[k] = flint.fmpq(value.numerator, value.denominator)
    residues = asked.residues(entries, flint.fmpq(1))
    if any(residues[i] != 0 for i in asked.up_to(order)):
        return None
    return Misprint(asked.labels[k], str(asked.entries[k]), value)


WITHIN = 10  # units of the last digit, for the order
OF_DIGITS = Fraction(1, 10**9)  # a residue below it is of wrong digits, and not of a wrong method
AS_PRINTED = Fraction(1, 10**30)  # units, within which a solution is what is printed
_AT_LEAST = Verdict.PROVED, Verdict.ENCLOSED, Verdict.MEASURED


@dataclass(frozen=True)
class Judged:
    """What was found of conditions of orders up to a claimed one.

    `order`: the highest that is not excluded, of those looked at. `failing`: the first condition
    that excludes more, with its `residue` as printed; `lower`: one of a lower order, whose residue
    is of wrong digits. `largest`: the largest residue of the claimed
    order's conditions. `off`: how far the printed number that is farthest from a solution's is from
    it, in units of its last digit, and `nearest` the solution's numbers; None where none is known.
    `shown`: how many conditions are shown to hold there, of `checked`; the others do to 60 digits.
    `digits`: whether all digits are right to one unit of the last; None where it is not known.
    `misprints`: the numbers of which each alone explains it.
    `residues`: all of them as printed, with their orders. `read`: the numbers as they were read.
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
        """Whether nothing is known against the claim."""
        return self.verdict in _AT_LEAST


def judge(numbers: PrintedNumbers, asked: Asked, order: int) -> Judged:
    """Whether the conditions of orders 1 … `order` can hold; those beyond tell where it ends.

    Of the conditions of higher orders that are asked only the failing one counts.
    """
    if not asked.equations:  # they hold by the form of the table
        return Judged(Verdict.PROVED, order, asked.by_form, read=numbers)
    if not numbers.units:
        return replace(_exactly(asked, order, numbers.tentative), read=numbers)
    with working_precision(BITS):
        return replace(_of(Nearby(numbers, asked), order, numbers), read=numbers)


def _of(near: Nearby, order: int, numbers: PrintedNumbers) -> Judged:
    equations, own = near.asked.equations, near.asked.up_to(order)
    every = range(len(equations))
    checked = len(own) + near.asked.by_form
    wrong = near.excluded(every, WITHIN)
    plain = [k for k in wrong if abs(near.at_print[k]) > OF_DIGITS]
    # What ends the order, if any does.
    failing = min(plain or wrong, key=lambda k: equations[k].order, default=None)
    highest = max((e.order for e in equations), default=order)
    allowed = max(highest, order) if failing is None else equations[failing].order - 1
    largest = max((abs(near.at_print[k]) for k in own), default=Fraction(0))
    condition = None if failing is None else equations[failing]
    size = Fraction(0) if failing is None else near.at_print[failing]
    residues = tuple(zip(equations, near.at_print, strict=True))
    first = min(wrong, key=lambda k: equations[k].order, default=None)
    seen = Judged(Verdict.MEASURED, allowed, checked, condition, size, largest, residues=residues)
    if first is not None and condition is not None and equations[first].order < condition.order:
        seen = replace(seen, lower=residues[first])
    if allowed < order and largest > OF_DIGITS:
        seen = replace(seen, verdict=Verdict.REFUTED, digits=False)
        if numbers.tentative:
            return seen
        seen = replace(seen, misprints=misprints(near, own) if near.asked.labels else ())
        found = nearest(near, own) or (far(near, own) if seen.misprint is None else None)
        return seen if found is None else replace(seen, off=found.off, nearest=found.numbers)
    return _with_nearest(seen, near, own, order, numbers.slack)


def _with_nearest(seen: Judged, near: Nearby, own: Sequence[int], order: int, slack: int) -> Judged:
    allowed, largest = seen.order, seen.largest
    found = nearest(near, own)
    if found is None:  # some conditions alone may show wrong digits
        digits = False if near.excluded(own, slack) else None
        some = misprints(near, own, single=True) if allowed < order else ()
        return replace(seen, digits=digits, misprints=some)
    off = found.off
    wrong_digits = off > slack and (allowed < order or near.apart(own, slack))
    some = misprints(near, own, single=True) if wrong_digits and off > WITHIN else ()
    digits = True if off <= slack else False if wrong_digits else None
    if off < AS_PRINTED and found.shown < len(near.names):
        digits = None  # any others of those that are free would do as well
    known = allowed >= order and off <= WITHIN
    verdict = Verdict.ENCLOSED if known or largest <= OF_DIGITS else Verdict.MEASURED
    if off > WITHIN and largest > OF_DIGITS and near.apart(own, WITHIN):
        verdict = Verdict.REFUTED
    order_found = max(allowed, order) if verdict is Verdict.ENCLOSED else allowed
    if verdict is Verdict.ENCLOSED and found.shown < len(own):
        verdict = Verdict.MEASURED
    told = replace(seen, verdict=verdict, order=order_found, digits=digits, misprints=some)
    return replace(told, off=off, nearest=found.numbers, shown=found.shown + near.asked.by_form)


# -- exactly --------------------------------------------------------------------------------------


def _exactly(asked: Asked, order: int, tentative: bool) -> Judged:
    """Of exact coefficients; `tentative`: without a look for one that is misprinted."""
    equations, gaps = asked.equations, exact_residues(asked)
    checked = len(asked.up_to(order)) + asked.by_form
    wrong = [k for k, (zero, _) in enumerate(gaps) if zero is False]
    unknown = [k for k, (zero, _) in enumerate(gaps) if zero is None]
    failing = min(wrong, key=lambda k: equations[k].order, default=None)
    highest = max((e.order for e in equations), default=order)
    allowed = max(highest, order) if failing is None else equations[failing].order - 1
    verdict = Verdict.PROVED if allowed >= order else Verdict.REFUTED
    if verdict is Verdict.PROVED and any(equations[k].order <= order for k in unknown):
        verdict = Verdict.UNDECIDED
    sizes = tuple((e, x) for e, (_, x) in zip(equations, gaps, strict=True))
    largest = max((abs(x) for e, x in sizes if e.order <= order), default=Fraction(0))
    if failing is None:
        return Judged(verdict, allowed, checked, largest=largest, residues=sizes)
    looked = verdict is Verdict.REFUTED and not tentative
    some = exact_misprints(asked, order) if looked else ()
    seen = Judged(verdict, allowed, checked, equations[failing], gaps[failing][1], largest)
    return replace(seen, residues=sizes, misprints=some)


def exact_residues(asked: Asked) -> list[tuple[bool | None, Fraction]]:
    """Of each condition whether it is 0, None where that is not decided, and its size, nearly."""
    if all(x.is_Rational for x in asked.entries):
        entries = [flint.fmpq(int(x.p), int(x.q)) for x in asked.entries]
        found = asked.residues(entries, flint.fmpq(1))
        return [(x == 0, Fraction(int(x.p), int(x.q))) for x in found]
    ring, elements = embed(list(asked.entries), ())
    return [_in_ring(ring, x) for x in asked.residues(elements, ring.one)]


def _in_ring(ring: Ring, gap: Poly) -> tuple[bool | None, Fraction]:
    gap = ring.reduce(gap)
    zero = ring.decide(gap).zero
    if zero:
        return True, Fraction(0)
    value = enclose(ring, gap, {}, BITS)
    size = middle_and_radius(value)[0] if value is not None and in_reach(value) else Fraction(0)
    return zero, size
