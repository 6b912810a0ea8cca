"""Rooted trees with coloured vertices, some of whose leaves may be leaves of time.

The differential equation is z' = Σ f_k(z, t), with t' = 1 as one more equation. A vertex of colour
k is f_k, differentiated once for each of its branches. A branch is a tree, or a leaf of time, which
stands for a derivative by t; the slope of time is 1, so that a leaf of time has no branches. A
grammar says which colours may grow upon which. For H = T(p) + V(q) the colours of p and of q take
turns (Hairer, Lubich, Wanner, Geometric Numerical Integration, III.2). For q'' = f(q) a vertex of
q' = p has at most one branch (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I,
II.14).
"""

import math
from collections import Counter
from dataclasses import dataclass
from functools import cache

Tree = tuple[int, tuple["Tree", ...]]  # the colour of its root, and the branches
TIME: Tree = (-1, ())


@dataclass(frozen=True)
class Grammar:
    """The rules for colours.

    `upon[k]`: the colours that may grow upon colour k. `single`: the colours with at most one
    branch. `timed`: True if leaves of time may grow upon every colour.
    """

    upon: tuple[tuple[int, ...], ...]
    single: tuple[int, ...] = ()
    timed: bool = False

    @property
    def colours(self) -> range:
        """All colours."""
        return range(len(self.upon))


def unrestricted_grammar(colours: int, timed: bool = False) -> Grammar:
    """Return the grammar in which every colour may grow upon every one."""
    return Grammar((tuple(range(colours)),) * colours, timed=timed)


def alternating(timed: bool = False) -> Grammar:
    """Return the grammar of two colours, each of which may grow only upon the other."""
    return Grammar(((1,), (0,)), timed=timed)


PLAIN = unrestricted_grammar(1)  # rooted trees, without colours and time
NYSTROM = Grammar(((1,), (0,)), single=(1,))  # colour 0 is p' = f(q), colour 1 is q' = p


@cache
def trees(grammar: Grammar, order: int, root: int) -> tuple[Tree, ...]:
    """Return all trees of `order` vertices, leaves of time included, with a root of that colour.

    >>> [len(trees(unrestricted_grammar(1), n, 0)) for n in range(1, 7)]
    [1, 1, 2, 4, 9, 20]
    >>> [len(trees(NYSTROM, n, 0)) for n in range(1, 8)]
    [1, 1, 2, 3, 6, 10, 20]
    """
    forests = _forests(grammar, root, order - 1, order - 1, 0)
    return tuple((root, forest) for forest in forests)


@cache
def all_trees(grammar: Grammar, order: int) -> tuple[Tree, ...]:
    """Return all trees of `order` vertices, with a root of any colour."""
    return tuple(tree for root in grammar.colours for tree in trees(grammar, order, root))


@cache
def _branches(grammar: Grammar, root: int, size: int) -> tuple[Tree, ...]:
    """Return the trees of `size` vertices that may grow upon the colour `root`."""
    leaf = (TIME,) if size == 1 and grammar.timed else ()
    return (
        *leaf,
        *(tree for colour in grammar.upon[root] for tree in trees(grammar, size, colour)),
    )


@cache
def _forests(
    grammar: Grammar, root: int, vertices: int, largest: int, first: int
) -> tuple[tuple[Tree, ...], ...]:
    """Return all multisets of branches with `vertices` vertices together, large branches first.

    No branch has more than `largest` vertices; those with as many begin at index `first` of their
    list.
    """
    if vertices == 0:
        return ((),)
    if root in grammar.single:
        return tuple((tree,) for tree in _branches(grammar, root, vertices))
    forests: list[tuple[Tree, ...]] = []
    for size in range(min(vertices, largest), 0, -1):
        # Branches are chosen in the order of their lists, so that each multiset occurs once.
        begin = first if size == largest else 0
        for k, tree in enumerate(_branches(grammar, root, size)[begin:], begin):
            rests = _forests(grammar, root, vertices - size, size, k)
            forests += [(tree, *others) for others in rests]
    return tuple(forests)


def has_time(tree: Tree) -> bool:
    """Return True if the tree has a leaf of time."""
    return tree == TIME or any(map(has_time, tree[1]))


@cache
def vertices(tree: Tree) -> int:
    """Return |t|, the number of vertices of t, leaves of time included."""
    return 1 + sum(map(vertices, tree[1]))


@cache
def density(tree: Tree) -> int:
    """Return γ(t), which does not depend on colours; that of a leaf of time is 1."""
    return vertices(tree) * math.prod(map(density, tree[1]))


def symmetry(tree: Tree) -> int:
    """Return σ(t), the number of symmetries of t."""
    counts = Counter(tree[1])
    return math.prod(math.factorial(n) * symmetry(child) ** n for child, n in counts.items())


def graft(tree: Tree, branch: Tree) -> Tree:
    """Return the tree with one more branch at its root."""
    root, branches = tree
    return root, (*branches, branch)


def equation_text(tree: Tree, names: tuple[str, ...] = ("",)) -> str:
    """Return the order condition of a tree as text.

    `names[k]` is appended to A, b and c of colour k; t is the vector of the stages' times.

    >>> equation_text((0, (TIME, (0, (TIME,)))))
    'b·(t A(t)) = 1/8'
    """
    right = f"1/{density(tree)}" if tree[1] else "1"
    return f"{condition_text(tree, names)} = {right}"


def condition_text(tree: Tree, names: tuple[str, ...] = ("",)) -> str:
    """Return the left side of the tree's condition."""
    root, branches = tree
    inner = product_text(branches, names)
    return f"b{names[root]}·({inner})" if " " in inner else f"b{names[root]}·{inner}"


def product_text(branches: tuple[Tree, ...], names: tuple[str, ...]) -> str:
    """Return the factor that the branches contribute to a stage, as a product of vectors."""

    def text(tree: Tree) -> str:
        root, inner = tree
        if tree == TIME:
            return "t"
        return f"A{names[root]}({product_text(inner, names)})" if inner else f"c{names[root]}"

    powers = sorted(((text(tree), n) for tree, n in Counter(branches).items()), reverse=True)
    return " ".join(x if n == 1 else f"{x}^{n}" for x, n in powers) or "1"


def nystrom_text(tree: Tree) -> str:
    """Return the order condition of a tree of `NYSTROM`, with A for ā and b_bar for b̄.

    >>> nystrom_text((0, ((1, ((0, ((1, ()),)),)), (1, ()))))
    'b·(c A(c)) = 1/30'
    """
    weights = "b"
    if tree[0] == 1 and tree[1]:
        weights, inner = "b_bar", nystrom_product(tree[1][0])
    else:
        inner = nystrom_product(tree)
    left_side = f"{weights}·({inner})" if " " in inner else f"{weights}·{inner}"
    right = density(tree)
    return f"{left_side} = 1/{right}" if right > 1 else f"{left_side} = 1"


def nystrom_product(tree: Tree) -> str:
    """Return the factor that the branches of a vertex of p' contribute to a stage, as text."""
    factors = [f"A({nystrom_product(inner[0])})" if inner else "c" for _, inner in tree[1]]
    powers = sorted(Counter(factors).items(), reverse=True)
    return " ".join(x if n == 1 else f"{x}^{n}" for x, n in powers) or "1"
