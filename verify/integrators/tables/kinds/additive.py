"""Additive Runge–Kutta methods: a tableau for each f_k, for every z' = f_1(z, t) + f_2(z, t) + …"""

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from verify.integrators.tables.entry import Block
from verify.integrators.tables.table_claim import TableClaim
from verify.integrators.tables.tableau_claims import BlocksEntry, judge_blocks
from verify.schemes.conditions.coloured_trees import unrestricted_grammar


class AdditiveEntry(BlocksEntry):
    """`parts`: of each f_k `a`, `b`, and `c` and `embedded` where they are printed."""

    parts: Annotated[tuple[Block, ...], Field(min_length=2, max_length=4)]

    @property
    def blocks(self) -> tuple[Block, ...]:
        return self.parts


ENTRY = AdditiveEntry


def claims(entry: AdditiveEntry) -> Iterator[TableClaim]:
    """Yield the claims of a Runge–Kutta method, with the conditions that couple the parts."""
    count = len(entry.parts)
    yield from judge_blocks(
        entry, tuple(f"_{k + 1}" for k in range(count)), unrestricted_grammar(count)
    )
