"""Partitioned Runge–Kutta methods: one tableau for p' = −H_q, and another for q' = H_p."""

from collections.abc import Iterator

from pydantic import StrictBool

from verify.integrators.tables.entry import Block
from verify.integrators.tables.tableaux.claims import BlocksEntry, of_blocks
from verify.integrators.tables.told import TableClaim
from verify.schemes.conditions.coloured_trees import alternating, of_all


class Entry(BlocksEntry):
    """`p`, `q`: of each `a`, `b`, and `c` and `embedded` where they are printed. `separable`:
    whether it is claimed for H = T(p) + V(q) alone, of which fewer conditions are asked."""

    p: Block
    q: Block
    separable: StrictBool = False

    @property
    def blocks(self) -> tuple[Block, ...]:
        return self.p, self.q


def claims(entry: Entry) -> Iterator[TableClaim]:
    """As of a Runge–Kutta method, with the conditions that couple p and q."""
    grammar = alternating() if entry.separable else of_all(2)
    yield from of_blocks(entry, ("_p", "_q"), grammar, entry.separable)
