"""The claims of tables of splittings and compositions, each with its verdict."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import cycle, islice
from typing import Annotated, Literal

import sympy
from pydantic import BeforeValidator

from verify.arithmetic.number_system import E
from verify.errors import NOT_GIVEN, InputError
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.entry import Order, Row, TableEntry, named_columns, one_column
from verify.integrators.tables.table_claim import (
    NO_HINTS,
    Hints,
    TableClaim,
    best_reading,
    condition_claims,
    order_claims,
)
from verify.prose import prose
from verify.schemes.printed.condition_set import ConditionSet, NamedEquation, conditions_of_pairs
from verify.schemes.printed.judgement import Judgement, judge
from verify.schemes.printed.naming import MOST_ENTRIES, Naming
from verify.schemes.printed.splitting_table import PrintedTable, judge_clocks, judge_order
from verify.verdict import Verdict

_EXCHANGED = {"kick": "drift", "drift": "kick"}
_SYMPLECTIC_SPLITTING = "every kick and every drift is symplectic, whatever their coefficients are"
_SYMPLECTIC_COMPOSITION = (
    "a composition of symplectic steps is symplectic, whatever their sizes are"
)


def _split_numbers(value: object) -> object:
    """Return the numbers in one text as a tuple; any other value as it is."""
    return tuple(one_column(value)) if isinstance(value, str) else value


Numbers = Annotated[Row, BeforeValidator(_split_numbers)]


class SizesEntry(TableEntry):
    """An entry with the `sizes` of all parts, as a list or in one text; or `half` of them, which
    are read forth and back again, the last one once."""

    order: Order | None = None
    sizes: Numbers | None = None
    half: Numbers | None = None


class AlternatingEntry(SizesEntry):
    """A splitting. `first`: "kick", "drift", or "both" for both orders. `times`: one for each size,
    in units of h, `-` for a part that reads none; judged for kicks, and with `time_dependent =
    "T and V"` for drifts too. A `csv` file has columns kind, size and time, or size alone."""

    first: Literal["kick", "drift", "both"] | None = None
    times: Numbers | None = None
    time_dependent: Literal["V", "T and V"] | None = None


def sizes_of(entry: SizesEntry) -> tuple[tuple[str, ...], bool]:
    """Return the sizes as they are written, and True if they are the first half of all sizes."""
    if (entry.sizes is None) == (entry.half is None):
        problem = "is missing; write sizes, or half" if entry.sizes is None else "goes without half"
        raise InputError("sizes", NOT_GIVEN, problem)
    sizes = entry.sizes if entry.sizes is not None else entry.half or ()
    if not 1 <= len(sizes) <= MOST_ENTRIES // 10:
        raise InputError("sizes", len(sizes), f"are 1 to {MOST_ENTRIES // 10}")
    return sizes, entry.half is not None


def mirror(half: Sequence[str]) -> tuple[str, ...]:
    """Read the sizes forth and back again, the last one standing once."""
    return (*half, *half[-2::-1])


def judge_alternating(entry: AlternatingEntry) -> Iterator[TableClaim]:
    """Judge kicks and drifts: order, in time, digits, symplectic, symmetric."""
    naming = Naming(entry.numbers)
    kinds, sizes, times = parts_of(entry, naming)
    # With "both" the method is claimed for kicks and drifts exchanged as well: both are judged.
    either_first = entry.first == "both"
    for first in ("kick", "drift") if either_first else (kinds[0],):
        own_kinds = kinds if first == kinds[0] else tuple(_EXCHANGED[kind] for kind in kinds)
        table = PrintedTable(
            entry.kind, tuple(zip(own_kinds, sizes, strict=True)), naming.printed_numbers
        )
        judge_again = partial(judge_with_numbers, entry, table, times)
        for claim in judge_table(entry, table, times, Hints(judge_again)):
            yield _label_claim(claim, f", {first} first") if either_first else claim


def timed_parts(entry: TableEntry) -> list[tuple[str, float, float]]:
    """Return kind, size and time of each part, as floats; an empty list without times."""
    if not isinstance(entry, AlternatingEntry):
        return []
    naming = Naming(entry.numbers)
    kinds, sizes, times = parts_of(entry, naming)
    if times is None:
        return []
    printed = naming.printed_numbers

    def number(text: str) -> float:
        return float(sympy.N(printed.at_print(printed.entry(text)), 17))

    pairs = zip(kinds, sizes, times, strict=True)
    return [(kind, number(size), number(time or "0")) for kind, size, time in pairs]


def _label_claim(claim: TableClaim, more: str) -> TableClaim:
    return replace(claim, kind=claim.kind + more, statement=claim.statement + more)


def parts_of(
    entry: AlternatingEntry, naming: Naming
) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str | None, ...] | None]:
    """Return the kinds, sizes and times of the parts, as formulas in the names of their numbers."""
    kinds: tuple[str, ...]
    times: Sequence[str] | None = None
    if entry.csv is not None:
        if entry.sizes is not None or entry.half is not None or entry.times is not None:
            raise InputError("csv", entry.csv, "stands alone: leave out sizes, half and times")
        by_header = named_columns(entry.folder, entry.csv, ("kind", "size", "time"))
        if "size" not in by_header:
            raise InputError("csv", entry.csv, "has no column size")
        sizes, half, times = tuple(by_header["size"]), False, by_header.get("time")
        kinds = tuple(by_header.get("kind", ())) or _kinds(entry, len(sizes))
        unknown_kinds = [kind for kind in kinds if kind not in _EXCHANGED]
        if unknown_kinds:
            raise InputError("kind", unknown_kinds[0], "is kick or drift")
    else:
        sizes, half = sizes_of(entry)
        times = entry.times
        kinds = _kinds(entry, 2 * len(sizes) - 1 if half else len(sizes))
    names = naming.entries(sizes, "size")
    names = mirror(names) if half else names
    if times is not None and len(times) != len(names):
        raise InputError("times", len(times), f"are {len(names)}, one for each size")
    moments = None if times is None else tuple(
        None if x in ("", "-", "–", "—") else naming.entry(x, f"time{k + 1}")
        for k, x in enumerate(times)
    )  # fmt: skip
    return kinds, names, moments


def _kinds(entry: AlternatingEntry, count: int) -> tuple[str, ...]:
    if entry.first is None:
        raise InputError("first", NOT_GIVEN, 'is missing; write first = "kick", "drift" or "both"')
    return alternating("drift" if entry.first == "drift" else "kick", count)


def alternating(first: str, count: int) -> tuple[str, ...]:
    """Return `count` kicks and drifts in turn."""
    return tuple(islice(cycle((first, _EXCHANGED[first])), count))


def judge_with_numbers(
    entry: SizesEntry,
    table: PrintedTable,
    times: tuple[str | None, ...] | None,
    numbers: Mapping[str, str],
) -> Iterator[TableClaim]:
    """Judge the claims with these numbers in place of printed ones, parts or times; and that it is
    a scheme at all, too, which a table claims that claims no order."""
    for name, text in numbers.items():
        table = table.with_entry(name, text)
        times = times and tuple(
            text if name == f"time of {table.parts[k][0]} {k + 1}" else time
            for k, time in enumerate(times)
        )
    if entry.order is None:
        judgement = best_reading(table, lambda x: judge_order(x, 1))
        yield from order_claims("consistent", "order 1", judgement, 1)
    yield from judge_table(entry, table, times)


def judge_table(
    entry: SizesEntry,
    table: PrintedTable,
    times: tuple[str | None, ...] | None = None,
    hints: Hints = NO_HINTS,
) -> Iterator[TableClaim]:
    """Judge each claim that the entry makes of its parts."""
    depends = entry.time_dependent if isinstance(entry, AlternatingEntry) else None
    if times is None and depends is not None:
        raise InputError("times", NOT_GIVEN, "is missing; time_dependent is judged by them")
    order = None
    for order_claim in _of_order(entry, table, hints):
        order = order or order_claim.verdict
        yield order_claim
    if times is not None and entry.order is not None:
        timed = replace(table, times=times, kinetic_in_time=depends == "T and V")
        yield from _in_time(timed, entry.order, order is Verdict.REFUTED, hints)
    if entry.symplectic:
        evidence = (
            _SYMPLECTIC_SPLITTING
            if isinstance(entry, AlternatingEntry)
            else _SYMPLECTIC_COMPOSITION
        )
        yield TableClaim("symplectic", "symplectic", Verdict.PROVED, prose(evidence))
    if entry.symmetric:
        judgement = hints.keep_explaining(best_reading(table, _judge_symmetric))
        yield from condition_claims(
            "symmetric", "symmetric", "symmetric", judgement, Severity.OF_WORDS
        )


def _of_order(entry: SizesEntry, table: PrintedTable, hints: Hints) -> Iterator[TableClaim]:
    """Judge the claim of the order, and of the digits; InputError where none is made."""
    order = entry.order
    if order is None:
        if entry.symmetric or entry.symplectic:
            return
        raise InputError("order", NOT_GIVEN, "is missing; a table is judged by what it claims")
    judgement = hints.keep_explaining(best_reading(table, lambda x: judge_order(x, order)))
    yield from order_claims(
        "order", f"order {order}", judgement, order, lambda x: _following(table.read(x), order)
    )


def _following(table: PrintedTable, order: int) -> ConditionSet:
    """Return the conditions of the next order alone."""
    if order >= table.most_order:
        raise InputError("order", order + 1, f"is looked at up to {table.most_order}")
    whole = table.condition_set(order)
    places = [k for k, e in enumerate(whole.equations) if e.order == order + 1]

    assert whole.select_residuals is not None  # noqa: S101 - a splitting's conditions are made apart
    return ConditionSet(
        whole.entries, tuple(whole.equations[k] for k in places), whole.select_residuals(places)
    )


def _in_time(timed: PrintedTable, order: int, refuted: bool, hints: Hints) -> Iterator[TableClaim]:
    """Judge the order in time. `refuted`: whether the order is without time."""
    dependence = "T and V depend" if timed.kinetic_in_time else "V depends"
    statement = f"order {order}, too, where {dependence} on time"
    right = hints.keep_explaining(best_reading(timed, judge_clocks))
    judgement = hints.keep_explaining(best_reading(timed, lambda x: judge_order(x, order)))
    # Where the order fails without time already, and the clock is right, the mistake is in the
    # sizes.
    wrong_clock = right.verdict is Verdict.REFUTED or not refuted
    severity = Severity.WRONG_CLOCK if wrong_clock else Severity.WRONG_ORDER
    claim = next(order_claims("order in time", statement, judgement, order, severity=severity))
    if claim.verdict is right.verdict is Verdict.REFUTED:
        right = replace(right, misprints=())  # they are reported with the order
        clocks = next(condition_claims("clock", "", "the right clock", right, severity))
        evidence = prose(claim.evidence, "; ", clocks.evidence)
        claim = replace(claim, evidence=evidence, nearest=claim.nearest or clocks.nearest)
    yield claim
    if right.holds and right.digits is False:
        _, digits = condition_claims("clock", "the right clock", "", right, severity)
        yield digits


def _judge_symmetric(table: PrintedTable) -> Judgement:
    """Decide if the table is the same read backwards, neighbours of one kind being one part, and
    none 0."""
    kinds, groups = _merge_parts(table)
    count = len(groups)
    if kinds != kinds[::-1]:
        name = f"the first part is a {kinds[0]}, and the last one a {kinds[-1]}"
        return Judgement(Verdict.REFUTED, 0, 0, NamedEquation(name, 1), numbers=table.printed)
    mirrored = [(k, count - 1 - k) for k in range(count // 2)]
    pairs = [
        (i, j)
        for i, j in mirrored
        if sympy.expand(sum(table.sizes[k] for k in groups[i]))
        != sympy.expand(sum(table.sizes[k] for k in groups[j]))
    ]
    names = (f"part {i + 1} = part {j + 1}" for i, j in pairs)

    def sides(entries: Sequence[E], one: E, minus: int) -> Iterator[tuple[E, E]]:
        sums = [sum((entries[k] for k in group[1:]), entries[group[0]]) for group in groups]
        return ((sums[i], sums[j]) for i, j in pairs)

    conditions = conditions_of_pairs(
        table.sizes, names, sides, held_by_form=len(mirrored) - len(pairs)
    )
    return judge(table.printed, conditions, 1)


def _merge_parts(table: PrintedTable) -> tuple[list[str], list[list[int]]]:
    """Return the kinds in turn, and the places of the parts that are one."""
    kinds, groups = list[str](), list[list[int]]()
    for k, ((kind, _), size) in enumerate(zip(table.parts, table.sizes, strict=True)):
        if size == 0:
            continue
        # Two kicks in a row are one kick by the sum of their sizes, and so are drifts; steps of a
        # method are not.
        if kinds and kinds[-1] == kind and kind != "step":
            groups[-1].append(k)
        else:
            kinds.append(kind)
            groups.append([k])
    return kinds, groups
