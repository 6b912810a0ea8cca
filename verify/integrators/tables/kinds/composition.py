"""Compositions of steps w h of any symmetric method of order 2."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from pydantic import StrictBool

from verify.errors import InputError
from verify.integrators.tables.cost import Severity
from verify.integrators.tables.entry import named_columns
from verify.integrators.tables.splitting_claims import (
    SizesEntry,
    judge_table,
    judge_with_numbers,
    mirror,
    sizes_of,
)
from verify.integrators.tables.table_claim import Hints, TableClaim
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.splitting_table import PrintedTable


class CompositionEntry(SizesEntry):
    """`sizes` are the w; a `csv` file has them in a column size. `of_parts`: they divide the steps
    of a part of a method, such as a thermostat's, so that a mistake is one of step weights."""

    of_parts: StrictBool = False


ENTRY = CompositionEntry


def weights_of(entry: CompositionEntry, naming: Naming) -> tuple[str, ...]:
    """Return the w of all steps, in names for their decimals."""
    if entry.csv is not None:
        if entry.sizes is not None or entry.half is not None:
            raise InputError("csv", entry.csv, "stands alone: leave out sizes and half")
        sizes, half = tuple(named_columns(entry.folder, entry.csv, ("size",))["size"]), False
    else:
        sizes, half = sizes_of(entry)
    names = naming.entries(sizes, "w")
    return mirror(names) if half else names


def claims(entry: CompositionEntry) -> Iterator[TableClaim]:
    """Yield the claims of the order, of digits, of being symplectic and of being symmetric."""
    naming = Naming(entry.numbers)
    parts = tuple(("step", size) for size in weights_of(entry, naming))
    table = PrintedTable(entry.kind, parts, naming.printed_numbers)
    for claim in judge_table(
        entry, table, hints=Hints(partial(judge_with_numbers, entry, table, None))
    ):
        of_weights = entry.of_parts and claim.severity == Severity.WRONG_ORDER
        yield replace(claim, severity=Severity.WRONG_WEIGHTS) if of_weights else claim
