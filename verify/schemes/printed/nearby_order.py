"""The order of a splitting with printed decimals of eight digits and more for sizes or times.

It is the order of exact numbers near them, as `verify.schemes.printed.judgement` judges it. Taken
exactly, Yoshida's 1.3512071919596578 makes a map of order 0.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Generic, NamedTuple, TypeAlias, TypeVar

import sympy

from verify.arithmetic.arb import midpoint_and_radius, rational_ball
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.printed.condition_set import BITS, ball_of
from verify.schemes.printed.judgement import WITHIN, Judgement
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.printed_numbers import entries_at
from verify.schemes.printed.sentences import ruling_on_order
from verify.schemes.printed.splitting_table import PrintedTable, judge_order

T = TypeVar("T")
WrittenPart: TypeAlias = tuple[str, str, str | None]  # "kick" or "drift", its size, and its time
_RESIDUAL_DIGITS = 12


def nearby_of(parts: Sequence[WrittenPart]) -> "PrintedParts | None":
    """Return the function that finds the order of exact parts near these; None if they are exact.

    A time of None is the right one.
    """
    naming = Naming({})
    try:
        sizes = naming.entries((size for _, size, _ in parts), "size")
        texts = enumerate(time for _, _, time in parts)
        times = tuple(None if x is None else naming.entry(x, f"time_{k + 1}") for k, x in texts)
        named_parts = tuple((kind, size) for (kind, *_), size in zip(parts, sizes, strict=True))
        table = PrintedTable(
            "splitting", named_parts, naming.printed_numbers, times, kinetic_in_time=True
        )
        tables = [table.read(numbers) for numbers in naming.printed_numbers.of_a_method()]
        rounded_tables = tuple(table for table in tables if table.printed.units)
        for table in rounded_tables:
            parts_at(table, table.printed.values)
            times_at(table, table.printed.values)
    except InputError:  # numbers that are too large, or entries that are no polynomials in them
        return None
    return PrintedParts(rounded_tables) if rounded_tables else None


@dataclass(frozen=True)
class PrintedParts:
    """The parts of a printed splitting; `tables`: a table for each reading of its numbers.

    Earlier readings are preferred.
    """

    tables: tuple[PrintedTable, ...]

    def __call__(self, most: int) -> NearbyOrder | None:
        """Return the highest order up to `most` of exact numbers near these; None if none."""
        if most not in self._by_limit:
            self._by_limit[most] = _highest(self.tables, most)
        return self._by_limit[most]

    @cached_property
    def _by_limit(self) -> dict[int, NearbyOrder | None]:
        return {}


def _highest(tables: Sequence[PrintedTable], most: int) -> NearbyOrder | None:
    highest, failing = find_highest_order(tables, min(most, tables[0].most_order), judge_order)
    if highest is None:
        return None
    order, table, judgement = highest
    verdict, explanation, _ = ruling_on_order(judgement, order)
    wrong = None if failing is None else _failing_condition(failing, order + 1)
    if judgement.nearest is None:
        return NearbyOrder(order, verdict, explanation, wrong, ())
    parts, times = parts_at(table, judgement.nearest), times_at(table, judgement.nearest)
    return NearbyOrder(order, verdict, explanation, wrong, parts, times)


class HighestOrder(NamedTuple, Generic[T]):
    """The highest order of exact numbers near the printed ones, in one reading of these."""

    order: int
    reading: T
    judgement: Judgement


def find_highest_order(
    readings: Sequence[T], most: int, judge: Callable[[T, int], Judgement]
) -> tuple[HighestOrder[T] | None, Judgement | None]:
    """Return the highest order up to `most`, or None, and the judgement of the next order.

    That judgement is None if the next order is beyond `most`.
    """
    highest: HighestOrder[T] | None = None
    for order in range(1, most + 1):
        candidates = [HighestOrder(order, reading, judge(reading, order)) for reading in readings]
        # One reading that fits is enough, as the table does not say which decimals are exact.
        near = next((x for x in candidates if is_near(x.judgement)), None)
        if near is None:
            return highest, candidates[-1].judgement
        highest = near
    return highest, None


def is_near(judgement: Judgement) -> bool:
    """Return True if the residuals are no larger than the digits explain."""
    distance = judgement.distance
    is_close = distance is not None and distance <= WITHIN
    return judgement.holds and (judgement.digits is not False or is_close)


def _failing_condition(judgement: Judgement, order: int) -> Condition | None:
    """Return the failing condition; None if there is none up to that order."""
    failing = judgement.failing
    if failing is None or failing.order > order:
        return None
    return Condition(
        failing.name, failing.order, decimal(judgement.residual, _RESIDUAL_DIGITS), False
    )


def parts_at(
    table: PrintedTable, numbers: Mapping[str, Fraction]
) -> tuple[tuple[str, Fraction], ...]:
    """Return the parts of a table at these numbers, to some 90 digits."""
    sizes = _values(table.sizes, table.printed.units, numbers)
    return tuple((kind, size) for (kind, _), size in zip(table.parts, sizes, strict=True))


def times_at(table: PrintedTable, numbers: Mapping[str, Fraction]) -> tuple[Fraction | None, ...]:
    """Return the times of the parts at these numbers, None for the right time."""
    values = _values(table.entries[len(table.sizes) :], table.printed.units, numbers)
    times = dict(zip(table.judged_parts, values, strict=True))
    return tuple(times.get(k) for k in range(len(table.parts)))


def _values(
    entries: Sequence[sympy.Expr], names: Iterable[str], numbers: Mapping[str, Fraction]
) -> list[Fraction]:
    with working_precision(BITS):
        balls = {name: rational_ball(numbers[name]) for name in names}
        return [midpoint_and_radius(x)[0] for x in entries_at(entries, balls, ball_of)]
