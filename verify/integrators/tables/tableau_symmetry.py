"""The judgement if a Runge–Kutta table is symplectic, or symmetric.

A sufficient set of conditions proves it; a necessary set refutes it.

Symplectic, sufficient: for all parts k and l of a sum of fields, b^k_i a^l_ij + b^l_j a^k_ji =
b^k_i b^l_j (Sanz-Serna 1988; Araújo, Murua, Sanz-Serna 1997). For p' and q' of a partitioned method
b_p = b_q is added, unless H is separable (Hairer, Lubich, Wanner, VI.4). For Nyström methods
b̄_i = b_i (1 − c_i) and b_i (b̄_j − ā_ij) = b_j (b̄_i − ā_ji) (Suris 1989).

Symplectic, necessary: b(u∘v) + b(v∘u) = b(u) b(v) for all pairs of trees, where u∘v is u with v as
one more branch of its root (Hairer, Lubich, Wanner, VI.7). For Nyström methods, with q' = p linear,
it is the difference of the two conditions that have the tree [u, v] of q' in common.

Symmetric, sufficient: a_(s+1−i, s+1−j) + a_ij = b_j (the same, V.2). Necessary: a step of −h after
one of h is the identity; the two are a Runge–Kutta method of 2 s stages, all of whose trees have
the weight 0.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import combinations, combinations_with_replacement, product

from verify.arithmetic.number_system import E
from verify.integrators.tables.tableau_orders import zero_or
from verify.integrators.tables.tableau_table import TableauTable
from verify.schemes.conditions.coloured_trees import (
    Grammar,
    Tree,
    all_trees,
    product_text,
    trees,
    vertices,
)
from verify.schemes.conditions.tree_weights import Block, Tableau, TreeWeights, Vector
from verify.schemes.printed.condition_set import ConditionSet, conditions_of_pairs
from verify.schemes.printed.judgement import Judgement, judge
from verify.verdict import Verdict

_MAX_VERTICES = 6  # of a pair of trees, and of a tree of the doubled method that is not tall
_MAX_TREES = 200  # pairs of trees, or trees of the doubled method


def judge_symplectic(table: TableauTable, separable: bool = False) -> Judgement:
    """Judge if the table is symplectic; `separable`: for H = T(p) + V(q) alone."""
    sufficient_conditions = (
        _nystrom_conditions(table) if table.nystrom else _symplectic(table, separable)
    )
    return _judge_by_both(table, sufficient_conditions, _pair_conditions(table, separable))


def judge_symmetric(table: TableauTable) -> Judgement:
    """Judge if a step of −h undoes a step of h."""
    return _judge_by_both(table, _reversal_conditions(table), _doubled_conditions(table))


def _judge_by_both(
    table: TableauTable, sufficient_conditions: ConditionSet, necessary_conditions: ConditionSet
) -> Judgement:
    """Return the judgement by both sets: REFUTED only if a necessary condition fails, and UNDECIDED
    if only a sufficient one does."""
    sufficient = judge(table.printed, sufficient_conditions, 1)
    if sufficient.verdict is not Verdict.REFUTED:
        return sufficient
    against = judge(table.printed, necessary_conditions, 1)
    if against.verdict is Verdict.REFUTED:
        return replace(against, misprints=sufficient.misprints)
    return replace(sufficient, verdict=Verdict.UNDECIDED)


def _dense(
    block: Block[E], one: E
) -> tuple[tuple[tuple[E, ...], ...], tuple[E, ...], tuple[E, ...]]:
    """Return a, b and c with all their zeros; an empty c if there are no times."""
    full = block.map_entries(lambda x, _: zero_or(x, one))
    return full.matrix, full.weights, full.times or ()


# -- symplectic -----------------------------------------------------------------------------------


def _symplectic(table: TableauTable, separable: bool) -> ConditionSet:
    stages, n = range(table.stages), table.names
    partitioned = len(table.blocks) == 2 and "_p" in n
    pairs = [(0, 1)] if partitioned else combinations_with_replacement(range(len(n)), 2)
    places = [
        (k, m, i, j) for k, m in pairs for i, j in product(stages, stages) if k != m or i <= j
    ]

    def conditions(blocks: Sequence[Block[E]], one: E) -> Iterator[tuple[str, E, E]]:
        a, b, _ = zip(*(_dense(block, one) for block in blocks), strict=True)
        for k, m, i, j in places:
            left = (
                f"b{n[k]}_{i + 1} a{n[m]}_{i + 1}{j + 1} + b{n[m]}_{j + 1} a{n[k]}_{j + 1}{i + 1}"
            )
            name = f"{left} = b{n[k]}_{i + 1} b{n[m]}_{j + 1}"
            yield name, b[k][i] * a[m][i][j] + b[m][j] * a[k][j][i], b[k][i] * b[m][j]
        for i in stages if partitioned and not separable else ():
            yield f"b_p{i + 1} = b_q{i + 1}", b[0][i], b[1][i]

    return table.build_conditions(conditions)


def _nystrom_conditions(table: TableauTable) -> ConditionSet:
    stages = range(table.stages)

    def conditions(blocks: Sequence[Block[E]], one: E) -> Iterator[tuple[str, E, E]]:
        (_, b, _), (a, bar, c) = (_dense(block, one) for block in blocks)
        for i in stages:
            name = f"b_bar_{i + 1} = b_{i + 1} (1 - c_{i + 1})"
            yield name, bar[i] + b[i] * c[i], b[i]
        for i, j in combinations(stages, 2):  # with plus signs on either side
            k, m = i + 1, j + 1
            name = f"b_{k} (b_bar_{m} - a_{k}{m}) = b_{m} (b_bar_{k} - a_{m}{k})"
            yield name, b[i] * bar[j] + b[j] * a[j][i], b[j] * bar[i] + b[i] * a[i][j]

    return table.build_conditions(conditions)


def _pair_conditions(table: TableauTable, separable: bool) -> ConditionSet:
    """Return the necessary conditions b(u∘v) + b(v∘u) = b(u) b(v)."""
    pairs = list(_pairs(table.grammar, table.nystrom, "_p" in table.names))
    texts = [_pair_text(u, v, table.names) for u, v in pairs]
    swapped = [] if table.nystrom or separable or "_p" not in table.names else [
        tree for n in (1, 2, 3) for tree in trees(table.grammar, n, 0)
    ]  # fmt: skip
    texts += [f"b_p·({product_text(t, table.names)}) = b_q·the same" for _, t in swapped]

    def sides(entries: Sequence[E], one: E, minus: int) -> Iterator[tuple[E, E]]:
        weights = table.weights(entries, one)
        weight_of = weights.weight
        for u, v in pairs:
            if not table.nystrom:
                yield weight_of(_graft(u, v)) + weight_of(_graft(v, u)), weight_of(u) * weight_of(v)
            elif v == (1, ()):
                yield weight_of(_graft(u, v)) + weight_of((1, (u,))), weight_of(u)
            else:
                w = v[1][0]
                left, right = weight_of(_graft(u, v)), weight_of(_graft(w, (1, (u,))))
                yield (
                    left + weight_of(w) * weight_of((1, (u,))),
                    right + weight_of(u) * weight_of(v),
                )
        for _, branches in swapped:
            yield weight_of((0, branches)), weight_of((1, branches))

    return conditions_of_pairs(table.entries, texts, sides)


@cache
def _pairs(grammar: Grammar, nystrom: bool, partitioned: bool) -> tuple[tuple[Tree, Tree], ...]:
    """List the pairs of trees: of Nyström's kind u is of p' and v of q', and so of a partitioned
    method; else they are of any two colours."""
    crossed = nystrom or partitioned
    pairs: list[tuple[Tree, Tree]] = []
    for n in range(2, _MAX_VERTICES + 1):
        of_n = []
        for k in range(1, n):
            firsts = trees(grammar, k, 0) if crossed else all_trees(grammar, k)
            seconds = trees(grammar, n - k, 1) if crossed else all_trees(grammar, n - k)
            # The condition is symmetric in u and v, so that each pair of the same forest is taken
            # once.
            of_n += [(u, v) for u in firsts for v in seconds if crossed or u <= v]
        if len(pairs) + len(of_n) > _MAX_TREES:
            break
        pairs += of_n
    return tuple(pairs)


def _graft(u: Tree, v: Tree) -> Tree:
    """Return u∘v: u with v as one more branch of its root."""
    root, branches = u
    return root, tuple(sorted((*branches, v), key=lambda t: (-vertices(t), t)))


def _pair_text(u: Tree, v: Tree, names: tuple[str, ...]) -> str:
    first_text, second_text = (f"[{product_text(t[1], names)}]{names[t[0]]}" for t in (u, v))
    return f"b(u∘v) + b(v∘u) = b(u) b(v) of u = {first_text}, v = {second_text}"


# -- symmetric ------------------------------------------------------------------------------------


def _reversal_conditions(table: TableauTable) -> ConditionSet:
    last, stages = table.stages - 1, range(table.stages)

    def conditions(blocks: Sequence[Block[E]], one: E) -> Iterator[tuple[str, E, E]]:
        if table.nystrom:
            yield from _reversed_nystrom(blocks, one)
            return
        for block, name in zip(blocks, table.names, strict=True):
            a, b, _ = _dense(block, one)
            for i, j in product(stages, stages):
                name_of_condition = f"{_reversed_entry(name, last, i, j)} = b{name}_{j + 1}"
                yield name_of_condition, a[i][j] + a[last - i][last - j], b[j]

    return table.build_conditions(conditions)


def _reversed_entry(name: str, last: int, i: int, j: int) -> str:
    return f"a{name}_{last - i + 1}{last - j + 1} + a{name}_{i + 1}{j + 1}"


def _reversed_nystrom(blocks: Sequence[Block[E]], one: E) -> Iterator[tuple[str, E, E]]:
    """Yield ā_(s+1−i, s+1−j) = b_j (1 − c_i) − b̄_j + ā_ij, and the weights of the step
    backwards."""
    (_, b, _), (a, bar, c) = (_dense(block, one) for block in blocks)
    last, stages = len(b) - 1, range(len(b))
    for i, j in product(stages, stages):
        name = f"{_reversed_entry('', last, i, j)} of the step backwards, b_{j + 1}"
        yield name, a[last - i][last - j] + b[j] * c[i] + bar[j], b[j] + a[i][j]
    for i in stages:
        yield f"c_{i + 1} + c_{last - i + 1} = 1", c[i] + c[last - i], one
    for i in stages:
        yield f"b_{i + 1} = b_{last - i + 1}", b[i], b[last - i]
    for i in stages:
        name = f"b_bar_{i + 1} + b_bar_{last - i + 1} = b_{i + 1}"
        yield name, bar[i] + bar[last - i], b[i]


def _doubled_conditions(table: TableauTable) -> ConditionSet:
    """Require that the weights of all trees of Φ_(−h) after Φ_h are 0."""
    stages = 2 * table.stages
    low_trees = list[Tree]()
    for n in range(1, _MAX_VERTICES + 1):
        of_n = all_trees(table.grammar, n)
        low_trees += of_n if len(low_trees) + len(of_n) <= _MAX_TREES else ()
    low_trees = [tree for tree in low_trees if not (table.nystrom and tree == (1, ()))]
    tall = [tree for root in table.grammar.colours for tree in _tall(table.grammar, root, stages)]
    doubled_trees = list(dict.fromkeys((*low_trees, *tall)))
    texts = [
        f"b{table.names[root]}·({product_text(branches, table.names)}) = 0 of the step of -h "
        "after that of h"
        for root, branches in doubled_trees
    ]

    def sides(entries: Sequence[E], one: E, minus: int) -> Iterator[tuple[E, E]]:
        blocks = table.fill_blocks(entries)
        doubled = [_tableau_of_double_step(block, minus) for block in blocks]
        if table.nystrom:
            doubled = _twice_nystrom(blocks, one, minus)
        weights, zero = TreeWeights(doubled, one, table.nystrom), one * 0
        for tree in doubled_trees:
            yield weights.weight(tree), zero

    return conditions_of_pairs(table.entries, texts, sides)


def _tall(grammar: Grammar, root: int, most: int) -> Iterator[Tree]:
    """Yield trees without branching, of up to so many vertices and two more."""
    for n in range(3, most + 3):
        colours = [root]
        while len(colours) < n:
            colours.append(grammar.upon[colours[-1]][0])
        tree: Tree = (colours[-1], ())
        for colour in colours[-2::-1]:
            tree = (colour, (tree,))
        yield tree


def _tableau_of_double_step(block: Block[E], minus: int) -> Block[E]:
    """Return the tableau of Φ_(−h) after Φ_h: [[A, 0], [1 bᵀ, −A]] and [b, −b]."""
    b, zeros = block.weights, (None,) * len(block.weights)
    upper = [(*row, *zeros) for row in block.matrix]
    lower = [(*b, *_times(minus, row)) for row in block.matrix]
    return Tableau((*upper, *lower), (*b, *_times(minus, b)))


def _twice_nystrom(blocks: Sequence[Block[E]], one: E, minus: int) -> list[Block[E]]:
    """Return the same of Nyström's kind; at its end q has no h p left, and b̄ is [b̄ − b, b̄]."""
    (_, b, _), (_, bar, c) = (_dense(block, one) for block in blocks)
    of_q, zeros = blocks[1], (None,) * len(b)
    upper = [(*row, *zeros) for row in of_q.matrix]
    lower = [
        (*(x + y * t * minus for x, y in zip(bar, b, strict=True)), *row)
        for t, row in zip(c, of_q.matrix, strict=True)
    ]
    clock = (*c, *(one + t * minus for t in c))
    end_weights = tuple(x + y * minus for x, y in zip(bar, b, strict=True))
    position = Tableau((*upper, *lower), (*end_weights, *bar), clock)
    return [Tableau(position.matrix, (*b, *_times(minus, tuple(b))), clock), position]


def _times(sign: int, x: Vector[E]) -> Vector[E]:
    return tuple(None if entry is None else entry * sign for entry in x)
