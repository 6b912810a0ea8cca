"""Orders of Runge–Kutta tables: the conditions of trees, in time as well, and what implies them.

Where the times are the row sums, c_i = Σ a_ij, a leaf of time is as any other, and the conditions
without time do. Where they are not, those of trees with leaves of time tell.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from itertools import product

import sympy

from verify.arithmetic.number import E
from verify.errors import InputError
from verify.integrators.tables.tableaux.table import TableauTable
from verify.schemes.conditions.coloured_trees import (
    Grammar,
    Tree,
    all_trees,
    equation_text,
    nystrom_text,
    symmetry,
    vertices,
)
from verify.schemes.conditions.tree_weights import Block, dot
from verify.schemes.printed.asked import Asked, Named, Residues, both
from verify.schemes.printed.judged import Judged, Misprint, judge
from verify.verdict import Verdict

_MOST_TREES = 2500
_HIGHEST = 10
_MOST_WORK = 3 * 10**8  # products: some minutes
_WRONG = Fraction(1, 10**9)  # between a time and a row sum: more is no digit
_MANY_IN_TIME = 300  # conditions on rounded numbers: some seconds
MANY = 60  # conditions: of fewer a solution is looked for together with that of row sums


@cache
def most_order(grammar: Grammar) -> int:
    """The highest order whose trees are looked at."""
    trees = [len(all_trees(grammar, 1))]
    while len(trees) < _HIGHEST and sum(trees) <= _MOST_TREES:
        trees.append(len(all_trees(grammar, len(trees) + 1)))
    return len(trees) if sum(trees) <= _MOST_TREES else len(trees) - 1


def order_asked(table: TableauTable, order: int, timed: bool = False, first: int = 1) -> Asked:
    """The conditions of orders `first` … `order`; `timed`: with leaves of time.

    InputError beyond what is looked at.
    """
    grammar = replace(table.grammar, timed=timed)
    if not 1 <= order <= most_order(grammar):
        raise InputError(
            "order", order, f"of such a table is looked at up to {most_order(grammar)}"
        )
    trees = [
        tree
        for n in range(first, order + 1)
        for tree in all_trees(grammar, n)
        if not _holds_by_form(table, tree)
    ]
    work = len(trees) * len(table.entries) * (1 + len(table.printed.units))
    if work > _MOST_WORK:
        size = f"{len(trees)} conditions and {len(table.entries)} entries"
        raise InputError("order", order, f"is too much to look at, of {size}")
    equations = tuple(Named(condition_text(table, tree), vertices(tree)) for tree in trees)
    shares = tuple(Fraction(1, symmetry(tree)) for tree in trees)

    def some(rows: Sequence[int]) -> Residues:
        return partial(_of_trees, table, [trees[k] for k in rows])

    every = some(range(len(trees)))
    return Asked(table.entries, equations, every, 0, shares, table.labels, some)


def condition_text(table: TableauTable, tree: Tree) -> str:
    """The tree's condition in the table's own letters."""
    return nystrom_text(tree) if table.nystrom else equation_text(tree, table.names)


def _holds_by_form(table: TableauTable, tree: Tree) -> bool:
    """q' = q + h p + … of Nyström's kind has its first term."""
    return table.nystrom and tree == (1, ())


def _of_trees(
    table: TableauTable, trees: Sequence[Tree], entries: Sequence[E], one: E, bound: bool = False
) -> list[E]:
    weights = table.weights(entries, one)
    return [(weights.bound if bound else weights.gap)(tree) for tree in trees]


# -- row sums -------------------------------------------------------------------------------------


def row_sums_asked(table: TableauTable, crossed: tuple[bool, ...] = ()) -> Asked:
    """c_i = Σ_j a_ij; of Nyström's kind c_i²/2 = Σ_j ā_ij. `crossed`: of which parts of two the
    other one's sums are meant."""
    return table.asked(lambda blocks, one: _sums(table, blocks, one, crossed))


def judge_row_sums(table: TableauTable) -> Judged:
    """Whether the times are row sums: where there are two parts, of p' and of q', those of either
    one, since time may go with each (`verify.schemes.conditions.implicit_tableau`)."""
    either = list(product((False, True), repeat=2)) if "_p" in table.names else [()]
    found = [judge(table.printed, row_sums_asked(table, crossed), 1) for crossed in either]
    return next((x for x in found if x.holds), found[0])


def wrong_time(table: TableauTable) -> Misprint | None:
    """The one time that is no row sum, and the sum; None where none is, or several are. Of a and b
    that are right."""
    found, at_print = [], table.printed.at_print
    for name, *sides in _sums(table, table.exprs, sympy.S.One):
        sizes = list(map(at_print, sides))
        if all(x.is_Rational for x in sizes) and abs(sizes[0] - sizes[1]) > _WRONG:
            label = name.partition(" = ")[2].replace("_", "", 1) if len(table.names) == 1 else name
            found.append(Misprint(label, str(sizes[1]), Fraction(int(sizes[0].p), int(sizes[0].q))))
    return found[0] if len(found) == 1 else None


def _sums(
    table: TableauTable, blocks: Sequence[Block[E]], one: E, crossed: tuple[bool, ...] = ()
) -> Iterator[tuple[str, E, E]]:
    """Each row's name, its sum, and what that is to be."""
    for colour, (block, name) in enumerate(zip(blocks, table.names, strict=True)):
        if block.times is None or (table.nystrom and colour == 0):
            continue
        of = 1 - colour if crossed and crossed[colour] else colour
        for i, (row, time) in enumerate(zip(blocks[of].matrix, block.times, strict=True)):
            present = [x for x in row if x is not None]
            total = sum(present[1:], present[0]) if present else one * 0
            c = zero_or(time, one)
            if table.nystrom:
                yield f"Σ a_{i + 1}j = c_{i + 1}^2/2", total, c * c / 2
            else:
                yield f"Σ a{table.names[of]}_{i + 1}j = c{name}_{i + 1}", total, c


def zero_or(x: E | None, one: E) -> E:
    """An entry, 0 where it is that by its form."""
    return one * 0 if x is None else x


# -- in time --------------------------------------------------------------------------------------


def judge_in_time(table: TableauTable, order: int) -> Judged:
    """Whether it can have the order for z' = f(z, t), with its times as they are printed, which are
    not the row sums; or with both."""
    plain = order_asked(table, order)
    if len(plain.equations) <= MANY:
        found = judge(table.printed, both(plain, row_sums_asked(table)), order)
        if found.verdict is not Verdict.REFUTED:
            return found
    most = most_order(replace(table.grammar, timed=True))
    for n in range(1, min(order, most) + 1):  # of a wrong time it is mostly a low order that fails
        asked = order_asked(table, n, timed=True)
        if table.printed.units and len(asked.equations) > _MANY_IN_TIME:
            break
        timed = judge(table.printed, asked, n)
        if timed.verdict is Verdict.REFUTED or n == order:
            return timed
    return replace(timed, verdict=Verdict.UNDECIDED)


# -- stage order ----------------------------------------------------------------------------------


def stage_order_asked(table: TableauTable, order: int) -> Asked:
    """B and C of Butcher's up to that order: b·c^(k−1) = 1/k and A(c^(k−1)) = c^k/k; of Nyström's
    kind ā(c^(k−2)) = c^k/(k (k−1)). Without printed times c is that of the row sums.

    (Hairer, Wanner, Solving Ordinary Differential Equations II, IV.15.)
    """
    return table.asked(lambda blocks, one: _stages(table, blocks, order, one))


def _stages(
    table: TableauTable, blocks: Sequence[Block[E]], order: int, one: E
) -> Iterator[tuple[str, E, E]]:
    """Each condition's name and its sides."""
    own = list(zip(blocks, table.names, strict=True))
    least = 2 if table.nystrom else 1
    for block, name in own[1:] if table.nystrom else own:
        powers = _powers(block, order, one)
        for k in range(least, order + 1):
            before, share = tuple(powers[k - least]), k * (k - 1) if table.nystrom else k
            for i, row in enumerate(block.matrix):
                label = f"stage {i + 1}{name}: A(c^{k - least}) = c^{k}/{share}"
                yield label, zero_or(dot(row, before), one), powers[k][i] / share
            if not table.nystrom:
                left = zero_or(dot(block.weights, before), one)
                yield f"b{name}·c^{k - 1} = 1/{k}", left, one / k


def _powers(block: Block[E], most: int, one: E) -> list[list[E]]:
    """c^0 … c^most, by component."""
    times = block.times
    if times is None:
        times = tuple(dot(row, (one,) * len(row)) for row in block.matrix)
    c = [zero_or(x, one) for x in times]
    powers = [[one] * len(c)]
    for _ in range(most):
        powers.append([x * y for x, y in zip(powers[-1], c, strict=True)])
    return powers
