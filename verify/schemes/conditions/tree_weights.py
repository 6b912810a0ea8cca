"""The factors that a tableau's entries contribute to the conditions of trees, over any numbers.

k_i = f(z + h Σ a_ij k_j), where each colour has its own matrix, weights and times. Φ_i(t) is the
product of Σ_j a_ij Φ_j over the root's branches, with c_i for a leaf of time; the condition is
Σ b_i Φ_i(t) = 1/γ(t). In a Nyström method, Q_i = q + c_i h p + h² Σ ā_ij k_j, a vertex of q' = p is
no stage: as a leaf it contributes c_i, and with its one branch Σ ā_ij Φ_j of that branch. Entries
that are 0 by the form of the tableau are None, so that products with them are left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeAlias, TypeVar

from verify.arithmetic.number_system import E
from verify.schemes.conditions.coloured_trees import TIME, Tree, density

S = TypeVar("S")
T_co = TypeVar("T_co", covariant=True)
Vector: TypeAlias = tuple[E | None, ...]


@dataclass(frozen=True)
class Tableau(Generic[T_co]):
    """The tableau of one colour: a_ij, b_i, and the stages' times c_i, None without time."""

    matrix: tuple[tuple[T_co, ...], ...]
    weights: tuple[T_co, ...]
    times: tuple[T_co, ...] | None = None

    @property
    def entries(self) -> list[T_co]:
        """All entries, one after the other: rows, weights, and times if there are any."""
        return [*(x for row in self.matrix for x in row), *self.weights, *(self.times or ())]

    def map_entries(self, transform: Callable[[T_co, str], S]) -> "Tableau[S]":
        """Return the tableau with each entry transformed; `transform` also gets "a", "b" or "c"."""
        rows = tuple(tuple(transform(x, "a") for x in row) for row in self.matrix)
        weights = tuple(transform(x, "b") for x in self.weights)
        times = None if self.times is None else tuple(transform(x, "c") for x in self.times)
        return Tableau(rows, weights, times)


Block: TypeAlias = Tableau[E | None]


class TreeWeights(Generic[E]):
    """The weights b·Φ(t) of trees, each vector computed once.

    `nystrom`: True if colour 1 is q' = p, with ā and b̄ as its matrix and weights and c as its
    times. `reduce`: is applied to sums and products, as a ring needs it.
    """

    def __init__(
        self,
        blocks: Sequence[Block[E]],
        one: E,
        nystrom: bool = False,
        reduce: Callable[[E], E] | None = None,
    ) -> None:
        self.blocks, self.one, self.nystrom, self.reduce = tuple(blocks), one, nystrom, reduce
        self.stages = len(blocks[0].weights)
        self._vectors: dict[Tree, Vector[E]] = {}
        self._branch_sums: dict[tuple[int, Tree], Vector[E]] = {}

    def weight(self, tree: Tree) -> E:
        """Return b·Φ(t)."""
        root, branches = tree
        if self.nystrom and root == 1:
            if not branches:
                return self.one
            # A root of q' = p is no stage: its one branch is weighted with b̄.
            ((root, branches),) = branches
            return self._or_zero(self.dot(self.blocks[1].weights, self.vector((root, branches))))
        return self._or_zero(self.dot(self.blocks[root].weights, self.vector(tree)))

    def gap(self, tree: Tree) -> E:
        """Return b·Φ(t) − 1/γ(t)."""
        return self.weight(tree) - self.one / density(tree)

    def bound(self, tree: Tree) -> E:
        """Return b·Φ(t) + 1/γ(t): with |coefficients| a bound of |gap|."""
        return self.weight(tree) + self.one / density(tree)

    def _or_zero(self, x: E | None) -> E:
        return self.one * 0 if x is None else x

    def vector(self, tree: Tree) -> Vector[E]:
        """Return Φ_i(t) for all stages."""
        if tree not in self._vectors:
            self._vectors[tree] = self._product(tree)
        return self._vectors[tree]

    def _product(self, tree: Tree) -> Vector[E]:
        """Return the product over the branches, from that of the tree without its last branch."""
        root, branches = tree
        if not branches:
            return (self.one,) * self.stages
        sums = self._sums(root, branches[-1])
        return sums if len(branches) == 1 else self.times(self.vector((root, branches[:-1])), sums)

    def _sums(self, root: int, tree: Tree) -> Vector[E]:
        """Return the factor of a branch of a root of that colour, for all stages."""
        # A leaf of time depends on the root's colour, the sums of a tree on its own colour alone.
        key = (root, tree) if tree == TIME else (0, tree)
        if key not in self._branch_sums:
            self._branch_sums[key] = self._make_sums(root, tree)
        return self._branch_sums[key]

    def _make_sums(self, root: int, tree: Tree) -> Vector[E]:
        clock = self.blocks[root].times
        if tree == TIME and clock is not None:
            return clock
        colour, branches = tree
        block = self.blocks[colour]
        if self.nystrom and colour == 1:
            if not branches:
                return block.times or ()
            (tree,) = branches
        inner = self.vector(tree)
        return tuple(self.dot(row, inner) for row in block.matrix)

    def dot(self, x: Vector[E], y: Vector[E]) -> E | None:
        """Return Σ x_i y_i; None where there is no product."""
        (value,) = self._reduce((dot(x, y),))
        return value

    def times(self, x: Vector[E], y: Vector[E]) -> Vector[E]:
        """Return the product by component."""
        return self._reduce(times(x, y))

    def _reduce(self, vector: Vector[E]) -> Vector[E]:
        if self.reduce is None:
            return vector
        return tuple(None if x is None else self.reduce(x) for x in vector)


def dot(x: Vector[E], y: Vector[E]) -> E | None:
    """Return Σ x_i y_i; None where there is no product."""
    total: E | None = None
    for a, b in zip(x, y, strict=True):
        if a is not None and b is not None:
            term = a * b
            total = term if total is None else total + term
    return total


def times(x: Vector[E], y: Vector[E]) -> Vector[E]:
    """Return the product by component."""
    pairs = zip(x, y, strict=True)
    return tuple(None if a is None or b is None else a * b for a, b in pairs)
