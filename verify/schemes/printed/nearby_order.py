"""The order of a splitting whose sizes are printed with eight digits and more: that of exact ones
near them, as `verify.schemes.printed.judged` says.

Taken exactly, Yoshida's 1.3512071919596578 makes a map of order 0.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from verify.arithmetic.arb import middle_and_radius, rational_ball
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

_DIGITS = 12  # of a residue


def nearby_of(parts: Sequence[tuple[str, str]]) -> "PrintedSizes | None":
    """What finds the order of kicks and drifts with these sizes, as they are written; None where
    they stand for nothing but themselves."""
    naming = Naming({})
    try:
        sizes = naming.entries((size for _, size in parts), "size")
        named = tuple((kind, size) for (kind, _), size in zip(parts, sizes, strict=True))
        plain = PrintedTable("splitting", named, naming.printed)
        tables = [plain.read(numbers) for numbers in naming.printed.of_a_method()]
        rounded = tuple(table for table in tables if table.units)
        for table in rounded:
            parts_at(table, table.values)
    except InputError:  # sizes beyond all coefficients, or no polynomials in the decimals
        return None
    return PrintedSizes(rounded) if rounded else None


@dataclass(frozen=True)
class PrintedSizes:
    """`tables`: one for each way in which the sizes may be read, that taken first before others."""

    tables: tuple[PrintedTable, ...]

    def __call__(self, most: int) -> NearbyOrder | None:
        """The highest order up to `most` that exact sizes near these have."""
        if most not in self._known:
            self._known[most] = _highest(self.tables, most)
        return self._known[most]

    @cached_property
    def _known(self) -> dict[int, NearbyOrder | None]:
        return {}


def _highest(tables: Sequence[PrintedTable], most: int) -> NearbyOrder | None:
    best: tuple[int, PrintedTable, Judged] | None = None
    wrong = None
    for order in range(1, min(most, tables[0].most_order) + 1):
        judged = [(table, judge_order(table, order)) for table in tables]
        near = next((pair for pair in judged if _is_near(pair[1])), None)
        if near is None:
            wrong = _wrong(judged[-1][1], order)
            break
        best = order, *near
    if best is None:
        return None
    order, table, found = best
    verdict, said, _ = of_printed(found, order)
    parts = () if found.nearest is None else parts_at(table, found.nearest)
    return NearbyOrder(order, verdict, said, wrong, parts)


def _is_near(found: Judged) -> bool:
    """Whether it is the digits that leave what residues there are."""
    return found.holds and (
        found.digits is not False or (found.off is not None and found.off <= WITHIN)
    )


def _wrong(found: Judged, order: int) -> Condition | None:
    failing = found.failing
    if failing is None or failing.order > order:
        return None
    return Condition(failing.name, failing.order, decimal(found.residue, _DIGITS), False)


def parts_at(
    table: PrintedTable, numbers: Mapping[str, Fraction]
) -> tuple[tuple[str, Fraction], ...]:
    """The parts with these numbers, to some 90 digits."""
    with working_precision(BITS):
        at = {name: rational_ball(numbers[name]) for name in table.units}
        sizes = [middle_and_radius(x)[0] for x in entries_at(table.sizes, at, ball_of)]
    return tuple((kind, size) for (kind, _), size in zip(table.parts, sizes, strict=True))
