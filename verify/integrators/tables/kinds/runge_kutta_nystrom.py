"""Runge–Kutta–Nyström methods for q'' = f(q, t):

k_i = f(q + c_i h p + h² Σ a_ij k_j, t + c_i h),
q' = q + h p + h² Σ b_bar_i k_i, p' = p + h Σ b_i k_i.
"""

from collections.abc import Iterator

from verify.errors import NOT_GIVEN, InputError
from verify.integrators.tables.entry import Row
from verify.integrators.tables.table_claim import TableClaim
from verify.integrators.tables.tableau_claims import TableauEntry, judge_tableau
from verify.integrators.tables.tableau_table import TableauTable, square
from verify.schemes.conditions.coloured_trees import NYSTROM
from verify.schemes.conditions.tree_weights import Tableau
from verify.schemes.printed.naming import Naming


class NystromEntry(TableauEntry):
    """`embedded` and `embedded_bar` are the weights of an embedded method, as `b` and `b_bar`.
    `row_sums`: whether Σ_j a_ij = c_i²/2 is claimed, which need not be."""

    a: tuple[Row, ...]
    b: Row
    b_bar: Row
    c: Row
    embedded: Row | None = None
    embedded_bar: Row | None = None


ENTRY = NystromEntry


def claims(entry: NystromEntry) -> Iterator[TableClaim]:
    """Yield the claims of the order, of embedded weights, symplectic, symmetric, of stages."""
    naming, stages = Naming(entry.numbers), len(entry.b)
    rows = tuple(naming.entries(row, f"a{k + 1}_") for k, row in enumerate(square(entry.a, stages)))
    b, bar = naming.entries(entry.b, "b"), naming.entries(entry.b_bar, "b_bar")
    zeros = (("0",) * stages,) * stages
    blocks = Tableau(zeros, b), Tableau(rows, bar, naming.entries(entry.c, "c"))
    embedded = None
    if (entry.embedded is None) != (entry.embedded_bar is None):
        problem = "goes with the other: embedded is of p, as b, and embedded_bar of q, as b_bar"
        raise InputError("embedded, embedded_bar", NOT_GIVEN, problem)
    if entry.embedded is not None and entry.embedded_bar is not None:
        of_p, of_q = entry.embedded, entry.embedded_bar
        embedded = naming.entries(of_p, "embedded"), naming.entries(of_q, "embedded_bar")
    table = TableauTable(blocks, NYSTROM, naming.printed_numbers, ("", ""), nystrom=True)
    yield from judge_tableau(entry, table, embedded)
