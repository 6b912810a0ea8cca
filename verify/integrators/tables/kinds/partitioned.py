"""Partitioned Runge–Kutta methods: one tableau for p' = −H_q, and another for q' = H_p."""

from collections.abc import Iterator

from pydantic import StrictBool

from verify.integrators.tables.tableaux.blocks import Block, blocks_of, embedded_of
from verify.integrators.tables.tableaux.claims import TableauEntry, of_tableau
from verify.integrators.tables.tableaux.table import TableauTable
from verify.integrators.tables.told import TableClaim
from verify.schemes.coloured_trees import alternating, of_all
from verify.schemes.printed.naming import Naming


class Entry(TableauEntry):
    """`p`, `q`: of each `a`, `b`, and `c` and `embedded` where they are printed. `separable`:
    whether it is claimed for H = T(p) + V(q) alone, of which fewer conditions are asked."""

    p: Block
    q: Block
    separable: StrictBool = False


def claims(entry: Entry) -> Iterator[TableClaim]:
    """As of a Runge–Kutta method, with the conditions that couple p and q."""
    naming, names = Naming(entry.numbers), ("_p", "_q")
    own = blocks_of((entry.p, entry.q), naming, names, entry.folder)
    grammar = alternating() if entry.separable else of_all(2)
    table = TableauTable(tuple(x.printed for x in own), grammar, naming.printed, names)
    yield from of_tableau(entry, table, embedded_of(own, entry.embedded_order), entry.separable)
