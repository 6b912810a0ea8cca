"""Partitioned Runge–Kutta methods: one tableau for p' = −H_q, and another for q' = H_p."""

from collections.abc import Iterator

from pydantic import StrictBool

from verify.integrators.tables.entry import Block
from verify.integrators.tables.table_claim import TableClaim
from verify.integrators.tables.tableau_claims import BlocksEntry, judge_blocks
from verify.schemes.conditions.coloured_trees import alternating, unrestricted_grammar


class PartitionedEntry(BlocksEntry):
    """`p`, `q`: of each `a`, `b`, and `c` and `embedded` where they are printed. `separable`:
    whether it is claimed for H = T(p) + V(q) alone, of which fewer conditions are asked."""

    p: Block
    q: Block
    separable: StrictBool = False

    @property
    def blocks(self) -> tuple[Block, ...]:
        return self.p, self.q


ENTRY = PartitionedEntry


def claims(entry: PartitionedEntry) -> Iterator[TableClaim]:
    """Yield the claims of a Runge–Kutta method, with the conditions that couple p and q."""
    grammar = alternating() if entry.separable else unrestricted_grammar(2)
    yield from judge_blocks(entry, ("_p", "_q"), grammar, entry.separable)
