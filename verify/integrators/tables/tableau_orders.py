"""Orders of Runge–Kutta tables: the conditions of trees, also for H that depend on t.

For such an H the trees have leaves of time. If the times are the row sums, c_i = Σ a_ij, a leaf of
time is like any other, and the conditions without time suffice. Otherwise the conditions of trees
with leaves of time decide.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from itertools import product

import sympy

from verify.arithmetic.number_system import E
from verify.errors import InputError
from verify.integrators.tables.tableau_table import TableauTable
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
from verify.schemes.printed.condition_set import (
    ConditionSet,
    NamedEquation,
    Residuals,
    prepend_conditions,
)
from verify.schemes.printed.judgement import Judgement, judge
from verify.schemes.printed.solutions import Misprint
from verify.verdict import Verdict

_MAX_TREES = 2500
_MAX_ORDER = 10
_MAX_PRODUCTS = 3 * 10**8  # they take some minutes
# A larger difference between a time and a row sum is no rounding of a digit.
_WRONG_TIME_GAP = Fraction(1, 10**9)
_MAX_TIME_CONDITIONS = 300  # on rounded numbers; they take some seconds
# With fewer conditions, a solution is looked for that satisfies the row sums, too.
MANY_CONDITIONS = 60


@cache
def most_order(grammar: Grammar) -> int:
    """Return the highest order whose conditions are judged."""
    trees = [len(all_trees(grammar, 1))]
    while len(trees) < _MAX_ORDER and sum(trees) <= _MAX_TREES:
        trees.append(len(all_trees(grammar, len(trees) + 1)))
    return len(trees) if sum(trees) <= _MAX_TREES else len(trees) - 1


def order_conditions(
    table: TableauTable, order: int, timed: bool = False, first: int = 1
) -> ConditionSet:
    """Return the conditions of orders `first` … `order`; `timed`: with leaves of time.

    Raises InputError if the order is higher than `most_order`.
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
    # The work is estimated before it is begun: each condition has a derivative by each rounded
    # number.
    work = len(trees) * len(table.entries) * (1 + len(table.printed.units))
    if work > _MAX_PRODUCTS:
        size = f"{len(trees)} conditions and {len(table.entries)} entries"
        raise InputError("order", order, f"is too much to look at, of {size}")
    equations = tuple(NamedEquation(condition_text(table, tree), vertices(tree)) for tree in trees)
    shares = tuple(Fraction(1, symmetry(tree)) for tree in trees)

    def part_of(rows: Sequence[int]) -> Residuals:
        return partial(_of_trees, table, [trees[k] for k in rows])

    whole = part_of(range(len(trees)))
    return ConditionSet(table.entries, equations, whole, 0, shares, table.labels, part_of)


def condition_text(table: TableauTable, tree: Tree) -> str:
    """Format the tree's condition in the table's own letters."""
    return nystrom_text(tree) if table.nystrom else equation_text(tree, table.names)


def _holds_by_form(table: TableauTable, tree: Tree) -> bool:
    """Return True for the first term of q' = q + h p + … of Nyström's kind, which no entry can
    change."""
    return table.nystrom and tree == (1, ())


def _of_trees(
    table: TableauTable, trees: Sequence[Tree], entries: Sequence[E], one: E, bound: bool = False
) -> list[E]:
    weights = table.weights(entries, one)
    return [(weights.bound if bound else weights.gap)(tree) for tree in trees]


# -- row sums -------------------------------------------------------------------------------------


def row_sum_conditions(table: TableauTable, crossed: tuple[bool, ...] = ()) -> ConditionSet:
    """Return the conditions c_i = Σ_j a_ij; of Nyström's kind c_i²/2 = Σ_j ā_ij. `crossed`: of
    which parts of two the other one's sums are meant."""
    return table.build_conditions(lambda blocks, one: _sums(table, blocks, one, crossed))


def judge_row_sums(table: TableauTable) -> Judgement:
    """Decide if the times are row sums: where there are two parts, of p' and of q', those of either
    one, since time may go with each (`verify.schemes.conditions.implicit_tableau`)."""
    either = list(product((False, True), repeat=2)) if "_p" in table.names else [()]
    judgements = [judge(table.printed, row_sum_conditions(table, crossed), 1) for crossed in either]
    return next((x for x in judgements if x.holds), judgements[0])


def wrong_time(table: TableauTable) -> Misprint | None:
    """Find the one time that is no row sum, and the sum; None where none is, or several are. The
    entries of a and b must be right."""
    mistakes, at_print = [], table.printed.at_print
    for name, *sides in _sums(table, table.exprs, sympy.S.One):
        sizes = list(map(at_print, sides))
        if all(x.is_Rational for x in sizes) and abs(sizes[0] - sizes[1]) > _WRONG_TIME_GAP:
            label = name.partition(" = ")[2].replace("_", "", 1) if len(table.names) == 1 else name
            mistakes.append(
                Misprint(label, str(sizes[1]), Fraction(int(sizes[0].p), int(sizes[0].q)))
            )
    return mistakes[0] if len(mistakes) == 1 else None


def _sums(
    table: TableauTable, blocks: Sequence[Block[E]], one: E, crossed: tuple[bool, ...] = ()
) -> Iterator[tuple[str, E, E]]:
    """Yield each row's name, its sum, and the value that it must have."""
    for colour, (block, name) in enumerate(zip(blocks, table.names, strict=True)):
        if block.times is None or (table.nystrom and colour == 0):
            continue
        summed = 1 - colour if crossed and crossed[colour] else colour
        for i, (row, time) in enumerate(zip(blocks[summed].matrix, block.times, strict=True)):
            present = [x for x in row if x is not None]
            total = sum(present[1:], present[0]) if present else one * 0
            c = zero_or(time, one)
            if table.nystrom:
                yield f"Σ a_{i + 1}j = c_{i + 1}^2/2", total, c * c / 2
            else:
                yield f"Σ a{table.names[summed]}_{i + 1}j = c{name}_{i + 1}", total, c


def zero_or(x: E | None, one: E) -> E:
    """Return the entry, or 0 where it is that by its form."""
    return one * 0 if x is None else x


# -- in time --------------------------------------------------------------------------------------


def judge_in_time(table: TableauTable, order: int) -> Judgement:
    """Decide if the table can have the order for z' = f(z, t), with its times as they are printed,
    which are not the row sums; or with both."""
    plain = order_conditions(table, order)
    if len(plain.equations) <= MANY_CONDITIONS:
        judgement = judge(
            table.printed, prepend_conditions(plain, row_sum_conditions(table)), order
        )
        if judgement.verdict is not Verdict.REFUTED:
            return judgement
    limit = most_order(replace(table.grammar, timed=True))
    for n in range(1, min(order, limit) + 1):  # of a wrong time it is mostly a low order that fails
        conditions = order_conditions(table, n, timed=True)
        if table.printed.units and len(conditions.equations) > _MAX_TIME_CONDITIONS:
            break
        timed = judge(table.printed, conditions, n)
        if timed.verdict is Verdict.REFUTED or n == order:
            return timed
    return replace(timed, verdict=Verdict.UNDECIDED)


# -- stage order ----------------------------------------------------------------------------------


def stage_order_conditions(table: TableauTable, order: int) -> ConditionSet:
    """Return B and C of Butcher's up to that order: b·c^(k−1) = 1/k and A(c^(k−1)) = c^k/k; of
    Nyström's kind ā(c^(k−2)) = c^k/(k (k−1)). Without printed times c is that of the row sums.

    (Hairer, Wanner, Solving Ordinary Differential Equations II, IV.15.)
    """
    return table.build_conditions(lambda blocks, one: _stages(table, blocks, order, one))


def _stages(
    table: TableauTable, blocks: Sequence[Block[E]], order: int, one: E
) -> Iterator[tuple[str, E, E]]:
    """Yield each condition's name and its sides."""
    parts = list(zip(blocks, table.names, strict=True))
    lowest = 2 if table.nystrom else 1
    for block, name in parts[1:] if table.nystrom else parts:
        powers = _powers(block, order, one)
        for k in range(lowest, order + 1):
            lower_powers, share = tuple(powers[k - lowest]), k * (k - 1) if table.nystrom else k
            for i, row in enumerate(block.matrix):
                label = f"stage {i + 1}{name}: A(c^{k - lowest}) = c^{k}/{share}"
                yield label, zero_or(dot(row, lower_powers), one), powers[k][i] / share
            if not table.nystrom:
                left = zero_or(dot(block.weights, lower_powers), one)
                yield f"b{name}·c^{k - 1} = 1/{k}", left, one / k


def _powers(block: Block[E], highest: int, one: E) -> list[list[E]]:
    """Return c^0 … c^most, by component."""
    times = block.times
    if times is None:
        times = tuple(dot(row, (one,) * len(row)) for row in block.matrix)
    c = [zero_or(x, one) for x in times]
    powers = [[one] * len(c)]
    for _ in range(highest):
        powers.append([x * y for x, y in zip(powers[-1], c, strict=True)])
    return powers
