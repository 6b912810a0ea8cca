"""What Runge–Kutta tables of all kinds claim, each with its verdict."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from pydantic import StrictBool

from verify.errors import NOT_GIVEN, InputError
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.entry import Order, TableEntry
from verify.integrators.tables.tableaux.blocks import Block, block_of, embedded_of
from verify.integrators.tables.tableaux.order import (
    MANY,
    judge_in_time,
    judge_row_sums,
    order_asked,
    stage_order_asked,
    wrong_time,
)
from verify.integrators.tables.tableaux.symmetry import judge_symmetric, judge_symplectic
from verify.integrators.tables.tableaux.table import TableauTable, Texts
from verify.integrators.tables.told import (
    NO_HINTS,
    Hints,
    TableClaim,
    best_reading,
    condition_claims,
    order_claims,
)
from verify.prose import prose
from verify.schemes.coloured_trees import Grammar
from verify.schemes.printed.asked import Asked
from verify.schemes.printed.judged import Judged, judge
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict


class TableauEntry(TableEntry):
    """What tableaux of every kind may claim. `row_sums`: without it claimed where there are
    times."""

    order: Order | None = None
    embedded_order: Order | None = None
    stage_order: Order | None = None
    row_sums: StrictBool | None = None


class BlocksEntry(TableauEntry):
    """Of parts that have a tableau each."""

    @property
    def blocks(self) -> tuple[Block, ...]:
        """The tableaux as they are written."""
        raise NotImplementedError


def of_blocks(
    entry: BlocksEntry, names: tuple[str, ...], grammar: Grammar, separable: bool = False
) -> Iterator[TableClaim]:
    """Each claim that the entry makes of its parts, of these names. InputError as `of_tableau`."""
    naming = Naming(entry.numbers)
    pairs = zip(entry.blocks, names, strict=True)
    own = [block_of(block, naming, name, entry.folder) for block, name in pairs]
    table = TableauTable(tuple(x.printed for x in own), grammar, naming.printed, names)
    yield from of_tableau(entry, table, embedded_of(own, entry.embedded_order), separable)


def of_tableau(
    entry: TableauEntry,
    table: TableauTable,
    embedded: Sequence[Texts] | None = None,
    separable: bool = False,
) -> Iterator[TableClaim]:
    """Each claim that the entry makes of its table; InputError where it makes none."""

    def again(numbers: Mapping[str, str]) -> Iterator[TableClaim]:
        own, weights = table, embedded
        for name, text in numbers.items():
            own = own.mended(name, text)
            if weights is not None:
                other = table.with_weights(weights).mended(name, text)
                weights = [block.weights for block in other.blocks]
        if entry.order is None:
            found = _judged(own, 1)
            yield from _of_order("consistent", "order 1", own, found, 1)
        yield from _claims(entry, own, weights, separable)

    made = list(_claims(entry, table, embedded, separable, Hints(again)))
    if not made:
        raise InputError("order", NOT_GIVEN, "is missing; a table is judged by what it claims")
    yield from made


def _claims(
    entry: TableauEntry,
    table: TableauTable,
    embedded: Sequence[Texts] | None,
    separable: bool,
    hints: Hints = NO_HINTS,
) -> Iterator[TableClaim]:
    sums, claimed = None, entry.row_sums if entry.row_sums is not None else table.timed
    if table.timed:
        sums = best_reading(table, judge_row_sums)
    if entry.order is not None:
        known = hints.kept(_judged(table, entry.order))
        yield from _of_order("order", f"order {entry.order}", table, known, entry.order)
        if sums is not None and not (claimed and hints is NO_HINTS):  # then the row sums tell
            yield _in_time(table, entry.order, known, sums, hints)
    if claimed:
        sums = sums or best_reading(table, judge_row_sums)
        if sums.verdict is Verdict.REFUTED and not table.nystrom and sums.misprint is None:
            sums = replace(sums, misprint=wrong_time(table))
        sums = hints.kept(sums)
        of_time = sums.misprint is None or sums.misprint.name.startswith("c")
        severity = Severity.WRONG_CLOCK if of_time else Severity.WRONG_ORDER
        form = (
            "Σ_j a_ij = c_i^2/2" if table.nystrom else "the times are the row sums, c_i = Σ_j a_ij"
        )
        yield from condition_claims("row sums", form, "the row sums", sums, severity)
    if embedded is not None and entry.embedded_order is not None:
        order, other = entry.embedded_order, table.with_weights(embedded)
        said = f"the embedded weights have order {order}"
        found = hints.kept(_judged(other, order))
        yield from _of_order("embedded order", said, other, found, order, Severity.WRONG_WEIGHTS)
    if entry.symplectic:
        found = hints.kept(best_reading(table, lambda x: judge_symplectic(x, separable)))
        yield from condition_claims(
            "symplectic", "symplectic", "symplectic", found, Severity.NOT_SYMPLECTIC
        )
    if entry.symmetric:
        found = hints.kept(best_reading(table, judge_symmetric))
        yield from condition_claims("symmetric", "symmetric", "symmetric", found, Severity.OF_WORDS)
    if entry.stage_order is not None:
        yield from _stage_orders(table, entry.stage_order, hints)


def _judged(table: TableauTable, order: int) -> Judged:
    return best_reading(table, lambda x: judge(x.printed, order_asked(x, order), order))


def _of_order(
    kind: str,
    statement: str,
    table: TableauTable,
    found: Judged,
    order: int,
    severity: Severity = Severity.WRONG_ORDER,
) -> Iterator[TableClaim]:
    yield from order_claims(kind, statement, found, order, _following(table, order), severity)


def _following(table: TableauTable, order: int) -> Callable[[PrintedNumbers], Asked]:
    return lambda numbers: order_asked(table.read(numbers), order + 1, first=order + 1)


def _in_time(
    table: TableauTable, order: int, known: Judged, sums: Judged, hints: Hints
) -> TableClaim:
    """Of the order alone: the digits of a and b are judged without time, and c by the row sums."""
    kind, statement = "order in time", f"order {order}, too, where f depends on time"
    exact = known.verdict is sums.verdict is Verdict.PROVED
    if exact or (known.holds and sums.holds and known.checked > MANY):
        verdict = Verdict.PROVED if exact else Verdict.MEASURED
        said = prose("the times are the row sums, so that the order is that without time")
        return TableClaim(kind, statement, verdict, said)
    if known.verdict is Verdict.REFUTED:
        said = prose("the order fails where f does not depend on time")
        return TableClaim(kind, statement, Verdict.REFUTED, said, severity=Severity.WRONG_ORDER)
    found = hints.kept(best_reading(table, lambda x: judge_in_time(x, order)))
    return next(order_claims(kind, statement, found, order, severity=Severity.WRONG_CLOCK))


def _stage_orders(table: TableauTable, order: int, hints: Hints) -> Iterator[TableClaim]:
    found = best_reading(table, lambda x: judge(x.printed, stage_order_asked(x, order), 1))
    found = hints.kept(found)
    yield from condition_claims(
        "stage order", f"stage order {order}", f"of stage order {order}", found, Severity.OF_WORDS
    )
