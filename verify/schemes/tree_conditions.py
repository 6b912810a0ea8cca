"""Order conditions of Runge–Kutta methods by rooted trees, from exact coefficients.

The method's map and the exact flow agree up to h^p for every smooth vector field exactly where
Σ_i b_i Φ_i(t) = 1/γ(t) for every rooted tree t of at most p vertices (Butcher 1963; Hairer,
Nørsett, Wanner, Solving Ordinary Differential Equations I, theorem II.2.13). With t = [t_1 … t_m],
the trees that are left where the root is taken away,

    Φ_i(t) = Π_k Σ_j a_ij Φ_j(t_k),   γ(t) = |t| γ(t_1) … γ(t_m).

That each of them is needed is shown there with vector fields of high dimension. Of Hamiltonian
fields in the plane fewer are, from five vertices on: f'f' is −det Hess H there, so that f''(f,
f'f'f) is f'f'f''(f, f), and of the conditions of two trees only one combination counts. So where
conditions of n vertices fail, the difference of the two maps' terms with hⁿ, Σ (b·Φ(t) − 1/γ(t))
F(t)/σ(t), is looked at as a polynomial in the derivatives of H (`verify.algebra.series.jets`);
where it vanishes that is one condition, which holds, in place of those that fail.

A condition is written with the vectors c = A 1 and b, products of vectors by component: that of
[τ, [τ]] is b·(c A(c)) = 1/8.
"""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import ClassVar, Generic, Protocol, TypeVar

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly, Ring
from verify.algebra.series.jets import Jets
from verify.arithmetic.number import E
from verify.errors import InputError
from verify.prose import count
from verify.schemes.conditions import Condition
from verify.schemes.implicit_tableau import ImplicitTableau, Numbers

Tree = tuple["Tree", ...]  # the trees that are left without the root, in descending order
Vector = tuple[Poly, ...]
E_co = TypeVar("E_co", covariant=True)
MOST_ORDER = 10


@lru_cache(maxsize=32)
def trees(order: int) -> tuple[Tree, ...]:
    """All rooted trees of so many vertices: 1, 1, 2, 4, 9, 20, 48, 115, …"""
    return tuple(_forests(order - 1, order - 1, None))


def _forests(vertices: int, largest: int, last: Tree | None) -> Iterator[tuple[Tree, ...]]:
    """Trees of so many vertices together, each not after `last` in the order they are listed in."""
    if vertices == 0:
        yield ()
        return
    for size in range(min(vertices, largest), 0, -1):
        known = trees(size)
        first = known.index(last) if last is not None and size == largest and last in known else 0
        for tree in known[first:]:
            for rest in _forests(vertices - size, size, tree):
                yield (tree, *rest)


def vertices(tree: Tree) -> int:
    """|t|.

    >>> vertices(((), ((),)))
    4
    """
    return 1 + sum(map(vertices, tree))


def density(tree: Tree) -> int:
    """γ(t).

    >>> density(((), ((),)))
    8
    """
    product = vertices(tree)
    for child in tree:
        product *= density(child)
    return product


def symmetry(tree: Tree) -> int:
    """σ(t).

    >>> symmetry(((), ()))
    2
    """
    product = 1
    for child, n in Counter(tree).items():
        product *= math.factorial(n) * symmetry(child) ** n
    return product


def condition_text(tree: Tree) -> str:
    """The left side of the tree's condition.

    >>> condition_text(((), ((),)))
    'b·(c A(c))'
    """
    inner = _vector(tree) if tree else "1"
    return f"b·({inner})" if " " in inner else f"b·{inner}"


def equation_text(tree: Tree) -> str:
    """The tree's condition."""
    return f"{condition_text(tree)} = 1/{density(tree)}" if tree else "b·1 = 1"


def _vector(tree: Tree) -> str:
    counts = Counter(tree)
    powers = [(f"A({_vector(child)})" if child else "c", n) for child, n in counts.items()]
    return " ".join(x if n == 1 else f"{x}^{n}" for x, n in sorted(powers, reverse=True))


@dataclass(frozen=True)
class TreeConditions:
    """A Runge–Kutta method for every H, by conditions on its coefficients; `separable`: for every
    H = T(p) + V(q), of which fewer may count."""

    tableau: ImplicitTableau
    separable: bool = False
    most_order: ClassVar[int] = MOST_ORDER  # the highest of which there are conditions

    @property
    def a_step(self) -> str:
        """What it costs, in words."""
        stages = count(self.tableau.stages, "stage")
        return f"{stages} together, solved by Newton's method"

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Those that the trees of 1 … `order` vertices give; see the module's text.

        InputError beyond order 10, of which there are 1205.
        """
        if order > MOST_ORDER:
            raise InputError(
                "order", order, f"of a Runge–Kutta method is proved up to {MOST_ORDER}"
            )
        orders = range(1, order + 1)
        return tuple(c for n in orders for c in _of_order(self.tableau, n, self.separable))

    def area_conditions(self) -> tuple[Condition, ...]:
        """See `ImplicitTableau.area_conditions`."""
        return self.tableau.area_conditions()

    def symmetry_conditions(self) -> tuple[Condition, ...]:
        """See `ImplicitTableau.symmetry_conditions`."""
        return self.tableau.symmetry_conditions()


@lru_cache(maxsize=256)
def _of_order(tableau: ImplicitTableau, order: int, separable: bool) -> tuple[Condition, ...]:
    gaps, weights = gaps_of(tableau, order), Weights(tableau.numbers)
    found = {tree: weights.condition(tree, gap) for tree, gap in gaps.items()}
    wrong = [tree for tree in gaps if found[tree].holds is False]
    if not wrong:
        return tuple(found.values())
    jets = Jets(order, separable=separable)
    cancel = _cancels(weights.ring, {tree: gaps[tree] for tree in wrong}, jets)
    if cancel is False:
        return tuple(found.values())
    left = tuple(c for tree, c in found.items() if tree not in wrong)
    name = f"Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t) = 0 over the {len(wrong)} other trees"
    return *left, Condition(name, order, "0", cancel)


@lru_cache(maxsize=256)
def gaps_of(tableau: ImplicitTableau, order: int) -> Mapping[Tree, Poly]:
    """b·Φ(t) − 1/γ(t) for the trees of so many vertices, in the ring of the tableau's numbers."""
    weights = Weights(tableau.numbers)
    return {tree: weights.gap(tree) for tree in trees(order)}


def all_trees_hold(tableau: ImplicitTableau, order: int) -> bool:
    """Whether the condition of every tree of up to so many vertices holds exactly.

    In the plane fewer do, as the module says; in n degrees of freedom, for every n, all.
    """
    ring = tableau.numbers.ring
    gaps = (gap for n in range(1, order + 1) for gap in gaps_of(tableau, n).values())
    return all(ring.vanishes(gap) is True for gap in gaps)


def _cancels(ring: Ring, gaps: Mapping[Tree, Poly], jets: Jets) -> bool | None:
    """Whether Σ gap F(t)/σ(t), trees of one size, is 0 for every H; None where it is not decided.

    The gaps are numbers, the differentials polynomials in the jets, of which the monomials are
    independent: each of them has to have the coefficient 0.
    """
    differentials = Differentials(jets)
    found: dict[tuple[int, tuple[int, ...]], Poly] = {}
    for tree, gap in gaps.items():
        share = gap / symmetry(tree)
        for part, x in enumerate(differentials.of(tree)):
            for monomial, coefficient in terms_of(x):
                at = part, monomial
                found[at] = found.get(at, ring.zero) + share * coefficient
    zeros = {ring.decide(x).zero for x in found.values()}
    return False if False in zeros else None if None in zeros else True


class Derivatives(Protocol[E_co]):
    """H_ij, and 0, in some ring."""

    @property
    def zero(self) -> E_co: ...

    def h(self, i: int, j: int) -> E_co: ...


class Differentials(Generic[E]):
    """Elementary differentials F(t) of f = (−H_q, H_p), over the jets or what stands for them:
    F(τ) = f, and F([t_1 … t_m]) = f⁽ᵐ⁾(F(t_1), …, F(t_m))."""

    def __init__(self, jets: Derivatives[E]) -> None:
        self.jets = jets
        self._known: dict[Tree, tuple[E, E]] = {}

    def of(self, tree: Tree) -> tuple[E, E]:
        """F(t), its parts in p' and in q'."""
        if tree not in self._known:
            inner = [self.of(child) for child in tree]
            self._known[tree] = -self._derived(0, 1, inner), self._derived(1, 0, inner)
        return self._known[tree]

    def _derived(self, i: int, j: int, along: Sequence[tuple[E, E]]) -> E:
        """The derivative of H_ij along these vectors."""
        total = self.jets.zero
        for parts in product((0, 1), repeat=len(along)):
            term = self.jets.h(i + parts.count(0), j + parts.count(1))
            for vector, part in zip(along, parts, strict=True):
                term = term * vector[part]
            total += term
        return total


class Weights:
    """Φ(t) of trees, each made once."""

    def __init__(self, numbers: Numbers) -> None:
        self.numbers, self.ring = numbers, numbers.ring
        self._summed: dict[Tree, Vector] = {}

    def weight(self, tree: Tree) -> Poly:
        """b·Φ(t)."""
        return self._dot(self.numbers.b, self.vector(tree))

    def gap(self, tree: Tree) -> Poly:
        """b·Φ(t) − 1/γ(t)."""
        return self.weight(tree) - self.ring.one / density(tree)

    def condition(self, tree: Tree, gap: Poly) -> Condition:
        """The tree's condition, of which `gap` is left side − right side."""
        return self.numbers.condition(equation_text(tree), vertices(tree), gap)

    def vector(self, tree: Tree) -> Vector:
        """Φ_i(t)."""
        product = (self.ring.one,) * len(self.numbers.b)
        for child in tree:
            pairs = zip(product, self._sums(child), strict=True)
            product = tuple(self.ring.multiply(x, y) for x, y in pairs)
        return product

    def _sums(self, tree: Tree) -> Vector:
        """Σ_j a_ij Φ_j(t)."""
        if tree not in self._summed:
            inner = self.vector(tree)
            self._summed[tree] = tuple(self._dot(row, inner) for row in self.numbers.a)
        return self._summed[tree]

    def _dot(self, x: Sequence[Poly], y: Sequence[Poly]) -> Poly:
        pairs = zip(x, y, strict=True)
        return self.ring.reduce(sum((a * b for a, b in pairs), self.ring.zero))
