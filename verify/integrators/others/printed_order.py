"""What the digits of a printed table can say of a claimed order; see
`verify.integrators.others.printed_table`.

- PROVED or REFUTED by exact algebra where no coefficient is rounded;
- REFUTED where no numbers within ten units of the last digits satisfy all conditions, and a residue
  is larger than 10⁻⁹;
- ENCLOSED where exact ones are shown to exist there, or nearby where residues are smaller: then it
  is digits that are wrong, which is judged apart;
- MEASURED where neither is shown: the residues are small.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.integrators.others.nearby_coefficients import Misprint, NearbyCoefficients
from verify.integrators.others.printed_table import PrintedTable
from verify.schemes.free_lie_words import MOST_ORDER, LogCondition, conditions, residue, step
from verify.verdict import Verdict

_BITS = 320
WITHIN = 10  # units of the last digit, for the order
OF_DIGITS = Fraction(1, 10**9)  # a residue below it is of wrong digits, and not of a wrong method


@dataclass(frozen=True)
class OrderVerdict:
    """What was found of one claimed order.

    `order`: the highest that is not excluded, of those looked at. `failing`: the first condition
    that excludes more, with its `residue` as printed. `largest`: the largest residue of the claimed
    order's conditions. `off`: how far the printed number that is farthest from a solution's is from
    it, in units of its last digit, and `nearest` the solution's numbers; None where none is known.
    `digits`: whether all digits are right to one unit of the last; None where it is not known.
    """

    verdict: Verdict
    order: int
    checked: int
    failing: LogCondition | None = None
    residue: Fraction = Fraction(0)
    largest: Fraction = Fraction(0)
    off: Fraction | None = None
    nearest: Mapping[str, Fraction] | None = None
    digits: bool | None = None
    misprint: Misprint | None = None


def judge_order(table: PrintedTable, order: int) -> OrderVerdict:
    """Whether the table can have that order. InputError where it cannot be looked at so far."""
    most = MOST_ORDER[table.kind]
    if not 1 <= order <= most:
        raise InputError("order", order, f"of a {table.kind} is looked at up to {most}")
    if not table.units:
        return _exactly(table, order)
    with working_precision(_BITS):
        highest = min(order + 1, most)
        return _of(NearbyCoefficients(table, table.conditions(highest)), order, highest)


def _of(near: NearbyCoefficients, order: int, highest: int) -> OrderVerdict:
    own = [k for k, c in enumerate(near.asked) if c.order <= order]
    checked = len(conditions(near.table.kind, order))
    wrong = near.excluded(range(len(near.asked)), WITHIN)
    plain = [
        k for k in wrong if abs(near.at_print[k]) > OF_DIGITS
    ]  # what ends the order, if any does
    failing = min(plain or wrong, key=lambda k: near.asked[k].order, default=None)
    allowed = highest if failing is None else near.asked[failing].order - 1
    largest = max((abs(near.at_print[k]) for k in own), default=Fraction(0))
    condition = None if failing is None else near.asked[failing]
    size = Fraction(0) if failing is None else near.at_print[failing]
    seen = OrderVerdict(Verdict.MEASURED, allowed, checked, condition, size, largest)
    if allowed < order and largest > OF_DIGITS:
        one = near.misprint(own)
        return replace(seen, verdict=Verdict.REFUTED, digits=False, misprint=one)
    found = near.nearest(own)
    if found is None:  # more conditions than numbers, of which some alone may show wrong digits
        digits = False if near.excluded(own, 1) else None
        one = near.misprint(own) if allowed < order else None
        return replace(seen, digits=digits, misprint=one)
    off, numbers = found
    wrong_digits = off > 1 and (allowed < order or near.apart(own, 1))
    one = near.misprint(own) if wrong_digits and off > WITHIN else None
    digits = True if off <= 1 else False if wrong_digits else None
    known = allowed >= order and off <= WITHIN
    verdict = Verdict.ENCLOSED if known or largest <= OF_DIGITS else Verdict.MEASURED
    if off > WITHIN and largest > OF_DIGITS and near.apart(own, WITHIN):
        verdict = Verdict.REFUTED
    order_found = max(allowed, order) if verdict is Verdict.ENCLOSED else allowed
    told = replace(seen, verdict=verdict, order=order_found, digits=digits, misprint=one)
    return replace(told, off=off, nearest=numbers)


def _exactly(table: PrintedTable, order: int) -> OrderVerdict:
    """Of rational coefficients."""
    if not all(size.is_Rational for size in table.sizes):
        raise InputError("table", table.numbers, "has irrational coefficients and no decimals")
    sizes = [flint.fmpq(int(x.p), int(x.q)) for x in table.sizes]
    most = min(order + 2, MOST_ORDER[table.kind])
    series = step(table.kind, table.letters(sizes), most, flint.fmpq(1))
    checked = len(conditions(table.kind, order))
    for c in conditions(table.kind, most):
        gap = residue(series, c)
        if gap != 0:
            verdict = Verdict.PROVED if c.order > order else Verdict.REFUTED
            size = Fraction(int(gap.p), int(gap.q))
            return OrderVerdict(verdict, c.order - 1, checked, c, size)
    return OrderVerdict(Verdict.PROVED, most, checked)
