"""Rooted trees with leaves of time, and their differentials for H(p, q, t) in the plane.

For z' = f(z, t), with t' = 1 beside it, a vertex is f, differentiated as often as there are
branches; a branch is a tree, or a leaf of time, which differentiates by t. Time is 1 as a slope and
has no derivatives, so that nothing grows upon its leaves. Where f has two parts, for p' and q', the
vertices have so many colours (Hairer, Lubich, Wanner, Geometric Numerical Integration, III.2).
"""

import math
from collections import Counter
from collections.abc import Sequence
from functools import cache
from itertools import product

import flint

from verify.schemes.timed.kinetic import Kinetic

Tree = tuple[int, tuple["Tree", ...]]  # the part that its root is, and the branches
Vector = tuple[flint.fmpq_mpoly, flint.fmpq_mpoly]
TIME: Tree = (-1, ())


@cache
def trees(parts: int, order: int) -> tuple[Tree, ...]:
    """All of so many vertices, leaves of time counted.

    >>> [len(trees(1, n)) for n in range(1, 7)]
    [1, 2, 5, 13, 37, 108]
    """
    forests = _forests(parts, order - 1, order - 1)
    return tuple((root, forest) for root in range(parts) for forest in forests)


def _branches(parts: int, size: int) -> tuple[Tree, ...]:
    return (TIME, *trees(parts, 1)) if size == 1 else trees(parts, size)


@cache
def _forests(
    parts: int, vertices: int, largest: int, first: int = 0
) -> tuple[tuple[Tree, ...], ...]:
    """Branches of so many vertices together, large ones first; those of the largest size from the
    `first` on."""
    if vertices == 0:
        return ((),)
    found: list[tuple[Tree, ...]] = []
    for size in range(min(vertices, largest), 0, -1):
        begin = first if size == largest else 0
        for k, tree in enumerate(_branches(parts, size)[begin:], begin):
            found += [(tree, *rest) for rest in _forests(parts, vertices - size, size, k)]
    return tuple(found)


def has_time(tree: Tree) -> bool:
    """Whether it has a leaf of time."""
    return tree == TIME or any(map(has_time, tree[1]))


def vertices(tree: Tree) -> int:
    """|t|, leaves of time counted."""
    return 1 + sum(map(vertices, tree[1]))


def density(tree: Tree) -> int:
    """γ(t): as of a tree without colours. Time's own is 1, as that of any leaf."""
    return vertices(tree) * math.prod(map(density, tree[1]))


def symmetry(tree: Tree) -> int:
    """σ(t)."""
    counts = Counter(tree[1])
    return math.prod(math.factorial(n) * symmetry(child) ** n for child, n in counts.items())


def equation_text(tree: Tree, parts: int) -> str:
    """The tree's condition; t is the vector of the stages' times.

    >>> equation_text((0, (TIME, (0, (TIME,)))), 1)
    'b·(t A(t)) = 1/8'
    """
    root, branches = tree
    names = ("",) if parts == 1 else ("_p", "_q")
    inner = _product(branches, names)
    left = f"b{names[root]}·({inner})" if " " in inner else f"b{names[root]}·{inner}"
    return f"{left} = 1/{density(tree)}" if branches else f"{left} = 1"


def _product(branches: Sequence[Tree], names: Sequence[str]) -> str:
    def text(tree: Tree) -> str:
        root, inner = tree
        if tree == TIME:
            return "t"
        return f"A{names[root]}({_product(inner, names)})" if inner else f"c{names[root]}"

    powers = sorted(((text(tree), n) for tree, n in Counter(branches).items()), reverse=True)
    return " ".join(x if n == 1 else f"{x}^{n}" for x, n in powers) or "1"


# -- differentials --------------------------------------------------------------------------------


class TreeJets:
    """∂_pⁱ ∂_q^j ∂_t^k H, i + j + k at most `order` + 1, free but for those of a quadratic T.

    `kinetic`: of H = T + V(q, t) with T of that class; None for every H(p, q, t). `timed`: whether
    there are derivatives by t at all.
    """

    def __init__(self, order: int, kinetic: Kinetic | None, timed: bool = True) -> None:
        indices = [
            (i, j, k)
            for i, j, k in product(range(order + 1), repeat=3)
            if 1 <= i + j <= order + 1 - k and (timed or k == 0) and _occurs(kinetic, i, j, k)
        ]
        names = ["p", *(f"H_{'p' * i}{'q' * j}{'t' * k}" for i, j, k in indices)]
        self.context = flint.fmpq_mpoly_ctx.get(names, flint.Ordering.degrevlex)
        self.zero = self.context.constant(0)
        p, *functions = self.context.gens()
        self._known = dict(zip(indices, functions, strict=True))
        if kinetic is not None and kinetic.quadratic:
            # Of p² m(t)/2 the derivative by p is p times the second one, at every t.
            second = {k: x for (i, _, k), x in self._known.items() if i == 2}
            self._known |= {(1, 0, k): p * x for k, x in second.items()}

    def h(self, i: int, j: int, k: int) -> flint.fmpq_mpoly:
        """H_ijk."""
        return self._known.get((i, j, k), self.zero)


def _occurs(kinetic: Kinetic | None, i: int, j: int, k: int) -> bool:
    if kinetic is None or i == 0:
        return True
    of_time = k == 0 or "D" in kinetic.timed
    return j == 0 and of_time and (i <= 2 or not kinetic.quadratic)


class Differentials:
    """F(t) of f = (−H_q, H_p), or of its two parts (−H_q, 0) and (0, H_p), over the jets."""

    def __init__(self, jets: TreeJets, parts: int) -> None:
        self.jets, self.parts = jets, parts
        self._known: dict[Tree, Vector] = {}

    def of(self, tree: Tree) -> Vector:
        """F(t), what it is in p' and in q'."""
        if tree not in self._known:
            root, branches = tree
            times = branches.count(TIME)
            inner = [self.of(branch) for branch in branches if branch != TIME]
            p, q = -self._derived(0, 1, times, inner), self._derived(1, 0, times, inner)
            if self.parts == 2:
                p, q = (p, self.jets.zero) if root == 0 else (self.jets.zero, q)
            self._known[tree] = p, q
        return self._known[tree]

    def _derived(self, i: int, j: int, k: int, along: Sequence[Vector]) -> flint.fmpq_mpoly:
        """The derivative of H_ijk along these vectors."""
        total = self.jets.zero
        for parts in product((0, 1), repeat=len(along)):
            term = self.jets.h(i + parts.count(0), j + parts.count(1), k)
            for vector, part in zip(along, parts, strict=True):
                if term.is_zero():
                    break
                term = term * vector[part]
            total += term
        return total
