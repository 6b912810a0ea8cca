"""Runge–Kutta methods: one tableau, for every z' = f(z), and with its times for z' = f(z, t)."""

from collections.abc import Iterator

from verify.errors import NOT_GIVEN, InputError
from verify.integrators.tables.entry import Row
from verify.integrators.tables.tableaux.blocks import Block, block_of
from verify.integrators.tables.tableaux.claims import TableauEntry, of_tableau
from verify.integrators.tables.tableaux.table import TableauTable
from verify.integrators.tables.told import TableClaim
from verify.schemes.coloured_trees import of_all
from verify.schemes.printed.naming import Naming


class Entry(TableauEntry):
    """`a`: rows of the full matrix, or of an explicit one up to the diagonal; or all as `tableau`,
    pasted, or in a `csv` file. `c` is judged where it is printed: as row sums, unless `row_sums` is
    false, and by the order for a force that depends on time."""

    a: tuple[Row, ...] | None = None
    b: Row | None = None
    c: Row | None = None
    embedded: Row | None = None
    tableau: str | None = None


def claims(entry: Entry) -> Iterator[TableClaim]:
    """Of the order, in time, of embedded weights, symplectic, symmetric, of stages."""
    naming = Naming(entry.numbers)
    given = Block(a=entry.a, b=entry.b, c=entry.c, embedded=entry.embedded,
                  tableau=entry.tableau, csv=entry.csv)  # fmt: skip
    own = block_of(given, naming, "", entry.folder)
    table = TableauTable((own.printed,), of_all(1), naming.printed)
    if entry.embedded_order is not None and own.embedded is None:
        raise InputError("embedded", NOT_GIVEN, "is missing; embedded_order is that of its weights")
    yield from of_tableau(entry, table, None if own.embedded is None else (own.embedded,))
