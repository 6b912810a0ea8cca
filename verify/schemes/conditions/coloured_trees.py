"""Rooted trees whose vertices have colours, some of their leaves being of time.

For z' = Σ f_k(z, t), with t' = 1 beside it, a vertex of colour k is f_k, differentiated as often as
it has branches; a branch is a tree, or a leaf of time, which differentiates by t. Time is 1 as a
slope and has no derivatives, so that nothing grows upon its leaves. Which colours may grow upon
which is a grammar: of H = T(p) + V(q) those of p and of q take turns (Hairer, Lubich, Wanner,
Geometric Numerical Integration, III.2); of q'' = f(q) a vertex of q' = p has one branch at most
(Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.14).
"""

import math
from collections import Counter
from dataclasses import dataclass
from functools import cache

Tree = tuple[int, tuple["Tree", ...]]  # the colour of its root, and the branches
TIME: Tree = (-1, ())


@dataclass(frozen=True)
class Grammar:
    """`upon[k]`: the colours that may grow upon colour k; `single`: those that have one branch at
    most; `timed`: whether leaves of time grow upon all."""

    upon: tuple[tuple[int, ...], ...]
    single: tuple[int, ...] = ()
    timed: bool = False

    @property
    def colours(self) -> range:
        """All of them."""
        return range(len(self.upon))


def of_all(colours: int, timed: bool = False) -> Grammar:
    """Any colour upon any."""
    return Grammar((tuple(range(colours)),) * colours, timed=timed)


def alternating(timed: bool = False) -> Grammar:
    """Two colours, each upon the other alone."""
    return Grammar(((1,), (0,)), timed=timed)


PLAIN = of_all(1)  # rooted trees as they are known, which need neither colours nor time
NYSTROM = Grammar(((1,), (0,)), single=(1,))  # 0 of p' = f(q), 1 of q' = p


@cache
def trees(grammar: Grammar, order: int, root: int) -> tuple[Tree, ...]:
    """All of so many vertices, leaves of time counted, whose root has that colour.

    >>> [len(trees(of_all(1), n, 0)) for n in range(1, 7)]
    [1, 1, 2, 4, 9, 20]
    >>> [len(trees(NYSTROM, n, 0)) for n in range(1, 8)]
    [1, 1, 2, 3, 6, 10, 20]
    """
    forests = _forests(grammar, root, order - 1, order - 1, 0)
    return tuple((root, forest) for forest in forests)


@cache
def all_trees(grammar: Grammar, order: int) -> tuple[Tree, ...]:
    """Those of every root."""
    return tuple(tree for root in grammar.colours for tree in trees(grammar, order, root))


@cache
def _branches(grammar: Grammar, root: int, size: int) -> tuple[Tree, ...]:
    """What of so many vertices may grow upon that colour."""
    leaf = (TIME,) if size == 1 and grammar.timed else ()
    return (
        *leaf,
        *(tree for colour in grammar.upon[root] for tree in trees(grammar, size, colour)),
    )


@cache
def _forests(
    grammar: Grammar, root: int, vertices: int, largest: int, first: int
) -> tuple[tuple[Tree, ...], ...]:
    """Branches of so many vertices together, large ones first; those of the largest size from the
    `first` on."""
    if vertices == 0:
        return ((),)
    if root in grammar.single:
        return tuple((tree,) for tree in _branches(grammar, root, vertices))
    found: list[tuple[Tree, ...]] = []
    for size in range(min(vertices, largest), 0, -1):
        begin = first if size == largest else 0
        for k, tree in enumerate(_branches(grammar, root, size)[begin:], begin):
            rests = _forests(grammar, root, vertices - size, size, k)
            found += [(tree, *rest) for rest in rests]
    return tuple(found)


def has_time(tree: Tree) -> bool:
    """Whether it has a leaf of time."""
    return tree == TIME or any(map(has_time, tree[1]))


@cache
def vertices(tree: Tree) -> int:
    """|t|, leaves of time counted."""
    return 1 + sum(map(vertices, tree[1]))


@cache
def density(tree: Tree) -> int:
    """γ(t): as of a tree without colours. Time's own is 1, as that of any leaf."""
    return vertices(tree) * math.prod(map(density, tree[1]))


def symmetry(tree: Tree) -> int:
    """σ(t)."""
    counts = Counter(tree[1])
    return math.prod(math.factorial(n) * symmetry(child) ** n for child, n in counts.items())


def grafted(tree: Tree, branch: Tree) -> Tree:
    """The tree with one more branch at its root."""
    root, branches = tree
    return root, (*branches, branch)


def equation_text(tree: Tree, names: tuple[str, ...] = ("",)) -> str:
    """The tree's condition; `names` stand after A, b and c of each colour, t is the vector of the
    stages' times.

    >>> equation_text((0, (TIME, (0, (TIME,)))))
    'b·(t A(t)) = 1/8'
    """
    right = f"1/{density(tree)}" if tree[1] else "1"
    return f"{condition_text(tree, names)} = {right}"


def condition_text(tree: Tree, names: tuple[str, ...] = ("",)) -> str:
    """The left side of the tree's condition."""
    root, branches = tree
    inner = product_text(branches, names)
    return f"b{names[root]}·({inner})" if " " in inner else f"b{names[root]}·{inner}"


def product_text(branches: tuple[Tree, ...], names: tuple[str, ...]) -> str:
    """What the branches put into a stage, as a product of vectors."""

    def text(tree: Tree) -> str:
        root, inner = tree
        if tree == TIME:
            return "t"
        return f"A{names[root]}({product_text(inner, names)})" if inner else f"c{names[root]}"

    powers = sorted(((text(tree), n) for tree, n in Counter(branches).items()), reverse=True)
    return " ".join(x if n == 1 else f"{x}^{n}" for x, n in powers) or "1"


def nystrom_text(tree: Tree) -> str:
    """The condition of a tree of `NYSTROM`, with A for ā and b_bar for b̄.

    >>> nystrom_text((0, ((1, ((0, ((1, ()),)),)), (1, ()))))
    'b·(c A(c)) = 1/30'
    """
    weights = "b"
    if tree[0] == 1 and tree[1]:
        weights, inner = "b_bar", nystrom_product(tree[1][0])
    else:
        inner = nystrom_product(tree)
    left = f"{weights}·({inner})" if " " in inner else f"{weights}·{inner}"
    right = density(tree)
    return f"{left} = 1/{right}" if right > 1 else f"{left} = 1"


def nystrom_product(tree: Tree) -> str:
    """What its branches put into a stage."""
    told = [f"A({nystrom_product(inner[0])})" if inner else "c" for _, inner in tree[1]]
    powers = sorted(Counter(told).items(), reverse=True)
    return " ".join(x if n == 1 else f"{x}^{n}" for x, n in powers) or "1"
