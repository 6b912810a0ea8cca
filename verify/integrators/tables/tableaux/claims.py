"""Runge–Kutta tables of all kinds: one tableau as a file has it, and what is claimed of them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import StrictBool

from verify.errors import NOT_GIVEN, InputError
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.entry import Block, Order, TableEntry
from verify.integrators.tables.layout import block_of_csv, pasted
from verify.integrators.tables.tableaux.order import (
    MANY,
    judge_in_time,
    judge_row_sums,
    order_asked,
    stage_order_asked,
    wrong_time,
)
from verify.integrators.tables.tableaux.symmetry import judge_symmetric, judge_symplectic
from verify.integrators.tables.tableaux.table import MOST_STAGES, TableauTable, Texts, square
from verify.integrators.tables.told import (
    NO_HINTS,
    Hints,
    TableClaim,
    best_reading,
    condition_claims,
    order_claims,
)
from verify.prose import prose
from verify.schemes.conditions.coloured_trees import Grammar
from verify.schemes.conditions.tree_weights import Tableau
from verify.schemes.printed.asked import Asked
from verify.schemes.printed.judged import Judged, judge
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict


@dataclass(frozen=True)
class NamedBlock:
    """With names for its decimals."""

    printed: Tableau[str]
    embedded: Texts | None


def block_of(given: Block, naming: Naming, name: str, folder: Path) -> NamedBlock:
    """InputError, of the key that is wrong, where it is no tableau."""
    given = _laid_out(given, name, folder)
    if given.a is None or given.b is None:
        what = "a" if given.a is None else "b"
        raise InputError(f"{what}{name}", NOT_GIVEN, "is missing; write a and b, or tableau")
    stages = len(given.b)
    if not 1 <= stages <= MOST_STAGES:
        raise InputError(f"b{name}", stages, f"has 1 to {MOST_STAGES} weights")
    rows = square(given.a, stages, f"a{name}")
    named = tuple(
        naming.entries(row, f"a{name}{i + 1}_" if stages > 9 else f"a{name}{i + 1}")
        for i, row in enumerate(rows)
    )
    weights = naming.entries(given.b, f"b{name}")
    times = None if given.c is None else naming.entries(_filled(given.c, stages), f"c{name}")
    embedded = None
    if given.embedded is not None:
        if len(given.embedded) != stages:
            problem = f"has {stages} weights, as b; write 0 for one that it leaves out"
            raise InputError(f"embedded{name}", len(given.embedded), problem)
        embedded = naming.entries(given.embedded, f"embedded{name}")
    return NamedBlock(Tableau(named, weights, times), embedded)


def _filled(times: Sequence[str], stages: int) -> Sequence[str]:
    """The times, of which the first, 0, need not be printed."""
    return ["0", *times] if len(times) == stages - 1 else times


def _laid_out(given: Block, name: str, folder: Path) -> Block:
    if given.tableau is None and given.csv is None:
        return given
    others = [given.a, given.b, given.c, given.embedded]
    if any(x is not None for x in others) or (given.tableau and given.csv):
        raise InputError(
            f"tableau{name}", NOT_GIVEN, "stands alone: leave out a, b, c and embedded"
        )
    if given.tableau is not None:
        return pasted(given.tableau, f"tableau{name}")
    return block_of_csv(folder, given.csv or "")


def embedded_of(own: Sequence[NamedBlock], order: int | None) -> tuple[Texts, ...] | None:
    """The embedded weights, where every part has them. InputError where some have, or where an
    order of them is claimed and there are none."""
    known = tuple(x.embedded for x in own if x.embedded is not None)
    if len(known) == len(own):
        return known
    if known or order is not None:
        alone = "is missing; embedded_order is that of its weights"
        raise InputError("embedded", NOT_GIVEN, alone if len(own) == 1 else "is missing in a part")
    return None


# -- claims ---------------------------------------------------------------------------------------


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
        if sums.verdict is Verdict.REFUTED and not table.nystrom and (m := wrong_time(table)):
            others = (each for each in sums.misprints if each.name != m.name)
            sums = replace(sums, misprints=(*others, m))
        sums = hints.kept(sums)
        named = [each.name for each in sums.misprints]
        of_time = not named or any(name.startswith("c") for name in named)
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
        order, wrong = entry.stage_order, Severity.OF_WORDS
        judged = best_reading(table, lambda x: judge(x.printed, stage_order_asked(x, order), 1))
        said = f"stage order {order}"
        found = hints.kept(judged)
        yield from condition_claims("stage order", said, f"of {said}", found, wrong)


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
