"""Runge–Kutta tables of all kinds: one tableau as a file has it, and the claims on it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from pydantic import StrictBool

from verify.errors import NOT_GIVEN, InputError
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.entry import Block, Order, TableEntry, block_of_csv, parse_tableau
from verify.integrators.tables.table_claim import (
    NO_HINTS,
    Hints,
    TableClaim,
    best_reading,
    condition_claims,
    order_claims,
)
from verify.integrators.tables.tableau_orders import (
    MANY_CONDITIONS,
    judge_in_time,
    judge_row_sums,
    order_conditions,
    stage_order_conditions,
    wrong_time,
)
from verify.integrators.tables.tableau_symmetry import judge_symmetric, judge_symplectic
from verify.integrators.tables.tableau_table import MOST_STAGES, TableauTable, Texts, square
from verify.prose import prose
from verify.schemes.conditions.coloured_trees import Grammar
from verify.schemes.conditions.tree_weights import Tableau
from verify.schemes.printed.condition_set import ConditionSet
from verify.schemes.printed.judgement import Judgement, judge
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.verdict import Verdict


@dataclass(frozen=True)
class NamedBlock:
    """One tableau whose decimals have names; `embedded`: its second line of weights, if any."""

    printed: Tableau[str]
    embedded: Texts | None


def block_of(block: Block, naming: Naming, name: str, folder: Path) -> NamedBlock:
    """Read one tableau; `name`: the end of its keys. Raises InputError for a key that is wrong."""
    block = _read_layout(block, name, folder)
    if block.a is None or block.b is None:
        missing_key = "a" if block.a is None else "b"
        raise InputError(f"{missing_key}{name}", NOT_GIVEN, "is missing; write a and b, or tableau")
    stages = len(block.b)
    if not 1 <= stages <= MOST_STAGES:
        raise InputError(f"b{name}", stages, f"has 1 to {MOST_STAGES} weights")
    # Rows of explicit methods may end at the diagonal: they are filled with zeros.
    rows = square(block.a, stages, f"a{name}")
    entries = tuple(
        naming.entries(row, f"a{name}{i + 1}_" if stages > 9 else f"a{name}{i + 1}")
        for i, row in enumerate(rows)
    )
    weights = naming.entries(block.b, f"b{name}")
    times = None if block.c is None else naming.entries(_fill_times(block.c, stages), f"c{name}")
    embedded = None
    if block.embedded is not None:
        if len(block.embedded) != stages:
            problem = f"has {stages} weights, as b; write 0 for one that it leaves out"
            raise InputError(f"embedded{name}", len(block.embedded), problem)
        embedded = naming.entries(block.embedded, f"embedded{name}")
    return NamedBlock(Tableau(entries, weights, times), embedded)


def _fill_times(times: Sequence[str], stages: int) -> Sequence[str]:
    """Return all times; a first one that is 0 need not be printed."""
    return ["0", *times] if len(times) == stages - 1 else times


def _read_layout(block: Block, name: str, folder: Path) -> Block:
    if block.tableau is None and block.csv is None:
        return block
    other_keys = [block.a, block.b, block.c, block.embedded]
    if any(x is not None for x in other_keys) or (block.tableau and block.csv):
        raise InputError(
            f"tableau{name}", NOT_GIVEN, "stands alone: leave out a, b, c and embedded"
        )
    if block.tableau is not None:
        return parse_tableau(block.tableau, f"tableau{name}")
    return block_of_csv(folder, block.csv or "")


def embedded_of(named_blocks: Sequence[NamedBlock], order: int | None) -> tuple[Texts, ...] | None:
    """Return the embedded weights, where every part has them. Raises InputError where some have, or
    where an order of them is claimed and there are none."""
    weights = tuple(x.embedded for x in named_blocks if x.embedded is not None)
    if len(weights) == len(named_blocks):
        return weights
    if weights or order is not None:
        problem = "is missing; embedded_order is that of its weights"
        raise InputError(
            "embedded", NOT_GIVEN, problem if len(named_blocks) == 1 else "is missing in a part"
        )
    return None


# -- claims ---------------------------------------------------------------------------------------


class TableauEntry(TableEntry):
    """The claims that tableaux of every kind may make. `row_sums`: without it claimed where there
    are times."""

    order: Order | None = None
    embedded_order: Order | None = None
    stage_order: Order | None = None
    row_sums: StrictBool | None = None


class BlocksEntry(TableauEntry):
    """A table of parts that have a tableau each."""

    @property
    def blocks(self) -> tuple[Block, ...]:
        """The tableaux as they are written."""
        raise NotImplementedError


def judge_blocks(
    entry: BlocksEntry, names: tuple[str, ...], grammar: Grammar, separable: bool = False
) -> Iterator[TableClaim]:
    """Judge each claim that the entry makes of its parts, of these names. Raises InputError as
    `judge_tableau`."""
    naming = Naming(entry.numbers)
    pairs = zip(entry.blocks, names, strict=True)
    named_blocks = [block_of(block, naming, name, entry.folder) for block, name in pairs]
    table = TableauTable(
        tuple(x.printed for x in named_blocks), grammar, naming.printed_numbers, names
    )
    yield from judge_tableau(
        entry, table, embedded_of(named_blocks, entry.embedded_order), separable
    )


def judge_tableau(
    entry: TableauEntry,
    table: TableauTable,
    embedded: Sequence[Texts] | None = None,
    separable: bool = False,
) -> Iterator[TableClaim]:
    """Judge each claim that the entry makes of its table; InputError where it makes none."""

    def judge_again(numbers: Mapping[str, str]) -> Iterator[TableClaim]:
        changed_table, weights = table, embedded
        for name, text in numbers.items():
            changed_table = changed_table.with_text(name, text)
            if weights is not None:
                with_embedded = table.with_weights(weights).with_text(name, text)
                # The embedded weights are texts of their own, in which a changed number has to be
                # changed as well.
                weights = [block.weights for block in with_embedded.blocks]
        if entry.order is None:
            judgement = _judge_order(changed_table, 1)
            yield from _of_order("consistent", "order 1", changed_table, judgement, 1)
        yield from _claims(entry, changed_table, weights, separable)

    claims = list(_claims(entry, table, embedded, separable, Hints(judge_again)))
    if not claims:
        raise InputError("order", NOT_GIVEN, "is missing; a table is judged by what it claims")
    yield from claims


def _claims(
    entry: TableauEntry,
    table: TableauTable,
    embedded: Sequence[Texts] | None,
    separable: bool,
    hints: Hints = NO_HINTS,
) -> Iterator[TableClaim]:
    sums, claimed = None, entry.row_sums if entry.row_sums is not None else table.has_times
    if table.has_times:
        sums = best_reading(table, judge_row_sums)
    if entry.order is not None:
        judgement = hints.keep_explaining(_judge_order(table, entry.order))
        yield from _of_order("order", f"order {entry.order}", table, judgement, entry.order)
        if sums is not None and not (claimed and hints is NO_HINTS):  # then the row sums tell
            yield _in_time(table, entry.order, judgement, sums, hints)
    if claimed:
        sums = sums or best_reading(table, judge_row_sums)
        # Where one time alone differs from its row sum it can be named exactly, which the general
        # search for misprints need not find.
        if sums.verdict is Verdict.REFUTED and not table.nystrom and (m := wrong_time(table)):
            other_misprints = (misprint for misprint in sums.misprints if misprint.name != m.name)
            sums = replace(sums, misprints=(*other_misprints, m))
        sums = hints.keep_explaining(sums)
        misprinted = [misprint.name for misprint in sums.misprints]
        of_time = not misprinted or any(name.startswith("c") for name in misprinted)
        severity = Severity.WRONG_CLOCK if of_time else Severity.WRONG_ORDER
        form = (
            "Σ_j a_ij = c_i^2/2" if table.nystrom else "the times are the row sums, c_i = Σ_j a_ij"
        )
        yield from condition_claims("row sums", form, "the row sums", sums, severity)
    if embedded is not None and entry.embedded_order is not None:
        order, embedded_table = entry.embedded_order, table.with_weights(embedded)
        statement = f"the embedded weights have order {order}"
        judgement = hints.keep_explaining(_judge_order(embedded_table, order))
        yield from _of_order(
            "embedded order", statement, embedded_table, judgement, order, Severity.WRONG_WEIGHTS
        )
    if entry.symplectic:
        judgement = hints.keep_explaining(
            best_reading(table, lambda x: judge_symplectic(x, separable))
        )
        yield from condition_claims(
            "symplectic", "symplectic", "symplectic", judgement, Severity.NOT_SYMPLECTIC
        )
    if entry.symmetric:
        judgement = hints.keep_explaining(best_reading(table, judge_symmetric))
        yield from condition_claims(
            "symmetric", "symmetric", "symmetric", judgement, Severity.OF_WORDS
        )
    if entry.stage_order is not None:
        order, severity = entry.stage_order, Severity.OF_WORDS
        raw_judgement = best_reading(
            table, lambda x: judge(x.printed, stage_order_conditions(x, order), 1)
        )
        statement = f"stage order {order}"
        judgement = hints.keep_explaining(raw_judgement)
        yield from condition_claims(
            "stage order", statement, f"of {statement}", judgement, severity
        )


def _judge_order(table: TableauTable, order: int) -> Judgement:
    return best_reading(table, lambda x: judge(x.printed, order_conditions(x, order), order))


def _of_order(
    kind: str,
    statement: str,
    table: TableauTable,
    judgement: Judgement,
    order: int,
    severity: Severity = Severity.WRONG_ORDER,
) -> Iterator[TableClaim]:
    yield from order_claims(kind, statement, judgement, order, _following(table, order), severity)


def _following(table: TableauTable, order: int) -> Callable[[PrintedNumbers], ConditionSet]:
    return lambda numbers: order_conditions(table.read(numbers), order + 1, first=order + 1)


def _in_time(
    table: TableauTable, order: int, without_time: Judgement, sums: Judgement, hints: Hints
) -> TableClaim:
    """Judge the order in time alone: the digits of a and b are judged without time, and c by the
    row sums."""
    kind, statement = "order in time", f"order {order}, too, where f depends on time"
    # With c_i = Σ_j a_ij time is one more component of z, and the conditions in time are those
    # without it.
    is_proved = without_time.verdict is sums.verdict is Verdict.PROVED
    if is_proved or (without_time.holds and sums.holds and without_time.checked > MANY_CONDITIONS):
        verdict = Verdict.PROVED if is_proved else Verdict.MEASURED
        reason = prose("the times are the row sums, so that the order is that without time")
        return TableClaim(kind, statement, verdict, reason)
    if without_time.verdict is Verdict.REFUTED:
        reason = prose("the order fails where f does not depend on time")
        return TableClaim(kind, statement, Verdict.REFUTED, reason, severity=Severity.WRONG_ORDER)
    judgement = hints.keep_explaining(best_reading(table, lambda x: judge_in_time(x, order)))
    return next(order_claims(kind, statement, judgement, order, severity=Severity.WRONG_CLOCK))
