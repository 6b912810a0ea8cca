"""Runge–Kutta methods: one tableau, for every z' = f(z), and with its times for z' = f(z, t)."""

from collections.abc import Iterator

from verify.integrators.tables.entry import Block
from verify.integrators.tables.table_claim import TableClaim
from verify.integrators.tables.tableau_claims import BlocksEntry, judge_blocks
from verify.schemes.conditions.coloured_trees import unrestricted_grammar


class RungeKuttaEntry(Block, BlocksEntry):
    """`a`: rows of the full matrix, or of an explicit one up to the diagonal; or all as `tableau`,
    pasted, or in a `csv` file. `c` is judged where it is printed: as row sums, unless `row_sums` is
    false, and by the order for a force that depends on time."""

    @property
    def blocks(self) -> tuple[Block, ...]:
        return (self,)


ENTRY = RungeKuttaEntry


def claims(entry: RungeKuttaEntry) -> Iterator[TableClaim]:
    """Yield the claims of the order, in time, of embedded weights, symplectic, symmetric, of
    stages."""
    yield from judge_blocks(entry, ("",), unrestricted_grammar(1))
