"""Additive Runge–Kutta methods: a tableau for each f_k, for every z' = f_1(z, t) + f_2(z, t) + …"""

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from verify.integrators.tables.tableaux.blocks import Block, blocks_of, embedded_of
from verify.integrators.tables.tableaux.claims import TableauEntry, of_tableau
from verify.integrators.tables.tableaux.table import TableauTable
from verify.integrators.tables.told import TableClaim
from verify.schemes.coloured_trees import of_all
from verify.schemes.printed.naming import Naming


class Entry(TableauEntry):
    """`parts`: of each f_k `a`, `b`, and `c` and `embedded` where they are printed."""

    parts: Annotated[tuple[Block, ...], Field(min_length=2, max_length=4)]


def claims(entry: Entry) -> Iterator[TableClaim]:
    """As of a Runge–Kutta method, with the conditions that couple the parts."""
    naming = Naming(entry.numbers)
    names = tuple(f"_{k + 1}" for k in range(len(entry.parts)))
    own = blocks_of(entry.parts, naming, names, entry.folder)
    table = TableauTable(tuple(x.printed for x in own), of_all(len(own)), naming.printed, names)
    yield from of_tableau(entry, table, embedded_of(own, entry.embedded_order))
