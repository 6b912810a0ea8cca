"""Runge–Kutta methods: one tableau, for every z' = f(z), and with its times for z' = f(z, t)."""

from collections.abc import Iterator

from verify.integrators.tables.entry import Block
from verify.integrators.tables.tableaux.claims import BlocksEntry, of_blocks
from verify.integrators.tables.told import TableClaim
from verify.schemes.conditions.coloured_trees import of_all


class Entry(Block, BlocksEntry):
    """`a`: rows of the full matrix, or of an explicit one up to the diagonal; or all as `tableau`,
    pasted, or in a `csv` file. `c` is judged where it is printed: as row sums, unless `row_sums` is
    false, and by the order for a force that depends on time."""

    @property
    def blocks(self) -> tuple[Block, ...]:
        return (self,)


def claims(entry: Entry) -> Iterator[TableClaim]:
    """Of the order, in time, of embedded weights, symplectic, symmetric, of stages."""
    yield from of_blocks(entry, ("",), of_all(1))
