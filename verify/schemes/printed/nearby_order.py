"""The order of a splitting whose sizes are printed with eight digits and more: that of exact ones
near them, as `verify.schemes.printed.judged` says.

Taken exactly, Yoshida's 1.3512071919596578 makes a map of order 0.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import cache

import flint

from verify.arithmetic.arb import middle_and_radius
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.schemes.conditions import Condition, NearbyOrder
from verify.schemes.printed.asked import BITS, ball_of
from verify.schemes.printed.judged import WITHIN, Judged
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.printed_numbers import entries_at
from verify.schemes.printed.sentences import of_printed
from verify.schemes.printed.splitting_table import PrintedTable, judge_order
from verify.schemes.splitting_conditions import Nearby

_DIGITS = 12  # of a residue


def nearby_of(parts: Sequence[tuple[str, str]]) -> Nearby | None:
    """What finds the order of kicks and drifts with these sizes, as they are written; None where
    they stand for nothing but themselves."""
    tables = readings_of(parts)
    return cache(lambda most: _highest(tables, most)) if tables else None


def readings_of(parts: Sequence[tuple[str, str]]) -> list[PrintedTable]:
    """The table as it may be read, those without a rounded number left out."""
    naming = Naming({})
    try:
        sizes = naming.entries((size for _, size in parts), "size")
        named = tuple((kind, size) for (kind, _), size in zip(parts, sizes, strict=True))
        plain = PrintedTable("splitting", named, naming.numbers)
        tables = [plain.read(numbers) for numbers in naming.printed.of_a_method()]
        return [table for table in tables if table.units]
    except InputError:  # no table: sizes that are beyond all coefficients
        return []


def _highest(tables: Sequence[PrintedTable], most: int) -> NearbyOrder | None:
    best: tuple[int, PrintedTable, Judged] | None = None
    wrong = None
    for order in range(1, most + 1):
        judged = [(table, _judged(table, order)) for table in tables]
        near = next((pair for pair in judged if pair[1] and _is_near(pair[1])), None)
        if near is None or near[1] is None:
            wrong = _wrong(judged[-1][1], order)
            break
        best = order, near[0], near[1]
    if best is None:
        return None
    order, table, found = best
    verdict, said, _ = of_printed(found, order)
    return NearbyOrder(order, verdict, said, wrong, _nearest_parts(table, found))


def _judged(table: PrintedTable, order: int) -> Judged | None:
    try:
        return judge_order(table, order)
    except InputError:  # sizes that are no polynomials in the decimals
        return None


def _is_near(found: Judged) -> bool:
    """Whether it is the digits that leave what residues there are."""
    return found.holds and (
        found.digits is not False or (found.off is not None and found.off <= WITHIN)
    )


def _wrong(found: Judged | None, order: int) -> Condition | None:
    failing = None if found is None else found.failing
    if found is None or failing is None or failing.order > order:
        return None
    return Condition(failing.name, failing.order, decimal(found.residue, _DIGITS), False)


def _nearest_parts(table: PrintedTable, found: Judged) -> tuple[tuple[str, Fraction], ...]:
    if found.nearest is None:
        return ()
    with working_precision(BITS):
        numbers = found.nearest.items()
        at = {name: flint.arb(flint.fmpq(x.numerator, x.denominator)) for name, x in numbers}
        sizes = [middle_and_radius(x)[0] for x in entries_at(table.sizes, at, ball_of)]
    return tuple((kind, size) for (kind, _), size in zip(table.parts, sizes, strict=True))
