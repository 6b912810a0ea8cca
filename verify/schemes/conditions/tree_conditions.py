"""Order conditions of Runge–Kutta methods by rooted trees, from exact coefficients and stage times.

The method's map and the exact flow agree up to h^p for every smooth vector field if and only if
Σ_i b_i Φ_i(t) = 1/γ(t) for every rooted tree t of at most p vertices (Butcher 1963; Hairer,
Nørsett, Wanner, Solving Ordinary Differential Equations I, theorem II.2.13). With t = [t_1 … t_m],
the tree whose root has the branches t_1 … t_m,

    Φ_i(t) = Π_k Σ_j a_ij Φ_j(t_k),   γ(t) = |t| γ(t_1) … γ(t_m).

All trees are needed, as is shown there with vector fields of high dimension. For Hamiltonian fields
in the plane fewer conditions suffice from five vertices on: f'f' is −det Hess H times the identity
there, so that f''(f, f'f'f) = f'f'f''(f, f), and of the conditions of these two trees only one
combination counts. So if conditions of n vertices fail, the difference of the two maps' terms with
hⁿ, Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t), is expanded as a polynomial in the derivatives of H
(`verify.algebra.jets`). If it vanishes, one condition that holds stands in place of those that
fail.

A condition is written with the vectors c = A 1 and b, and products by component: that of [τ, [τ]]
is b·(c A(c)) = 1/8.

For z' = f(z, t) some leaves are of time: that is Butcher's theorem for the system with t' = 1 as
one more equation (`verify.schemes.conditions.coloured_trees`). A leaf of time puts the stage's time
c_i into Φ_i(t). If c = A 1, that is the factor of any leaf, and densities do not depend on colours:
the conditions are those without time. The combinations of the plane do not carry over, as with time
the field's derivative has one more column, f_t: so the difference is expanded first for H without
time, which are a special case, and then for every H.

The elementary differentials of f = (−H_q, H_p) are F(τ) = f and F([t_1 … t_m]) =
f⁽ᵐ⁾(F(t_1), …, F(t_m)); a leaf of time differentiates by t. The trees have one colour for f, or
two for its parts (−H_q, 0) and (0, H_p).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import ClassVar, Generic, Protocol, TypeVar

from verify.algebra.identities.polynomials import terms_of
from verify.algebra.jets import JetsInDegrees
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.number_system import E
from verify.errors import InputError
from verify.lazy_sympy import sympy
from verify.prose import count
from verify.schemes.conditions.coloured_trees import (
    PLAIN,
    TIME,
    Tree,
    all_trees,
    equation_text,
    symmetry,
    unrestricted_grammar,
)
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.words.words import Kinetic

MOST_ORDER = 10
_MOST_ORDER_IN_TIME = 8  # there are 1042 trees of 8 vertices with leaves of time
E_co = TypeVar("E_co", covariant=True)


def trees(order: int) -> tuple[Tree, ...]:
    """Return all rooted trees of `order` vertices: 1, 1, 2, 4, 9, 20, 48, 115, …"""
    return all_trees(PLAIN, order)


@dataclass(frozen=True)
class TreeConditions:
    """A Runge–Kutta method for every H, by conditions on its coefficients.

    If the tableau has a clock, the conditions include its times. `kinetic`: conditions are for
    every H = T + V with T of that class, which may need fewer; None for every H. It is a
    `verify.schemes.conditions.condition.ByConditions`.
    """

    tableau: ImplicitTableau
    kinetic: Kinetic | None = None
    kind: ClassVar[str] = "implicit-runge-kutta"  # the file of `verify.schemes.maps.kinds`

    @property
    def separable(self) -> bool:
        """True if the conditions are for H = T + V only."""
        return self.kinetic is not None

    @property
    def has_clock(self) -> bool:
        """True if the conditions are for H that depend on time."""
        return self.tableau.clock is not None

    @property
    def most_order(self) -> int:
        """The highest order with conditions."""
        return MOST_ORDER if self.tableau.numbers.right else _MOST_ORDER_IN_TIME

    @property
    def clock(self) -> list[sympy.Expr]:
        """The time of each stage, in parts of h."""
        numbers = self.tableau.numbers
        return [numbers.ring.expression(time) for time in numbers.clock]

    @property
    def a_step(self) -> str:
        """The cost of a step, in words."""
        stages = count(self.tableau.stages, "stage")
        return f"{stages} together, solved by Newton's method"

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Return the conditions of the trees of 1 … `order` vertices; see the module's text.

        Raises InputError beyond order 10, up to which there are 1205 trees, and beyond order 8 for
        a clock that is not right.
        """
        if order > self.most_order:
            these = " with these times" * self.has_clock
            problem = f"of a Runge–Kutta method{these} is proved up to {self.most_order}"
            raise InputError("order", order, problem)
        return tuple(c for n in range(1, order + 1) for c in _conditions_of_order(self, n))

    def area_conditions(self) -> tuple[Condition, ...]:
        """Return the conditions of `ImplicitTableau.area_conditions`."""
        return self.tableau.area_conditions()


@lru_cache(maxsize=256)
def _conditions_of_order(method: TreeConditions, order: int) -> tuple[Condition, ...]:
    """Return the condition of each tree.

    If those that fail cancel for every H, that one condition stands in their place.
    """
    numbers = method.tableau.numbers
    weights, parts = numbers.tree_weights, len(numbers.blocks)
    names = ("",) if parts == 1 else ("_p", "_q")
    # With a right clock a leaf of time contributes what any leaf does.
    rooted_trees = all_trees(
        unrestricted_grammar(parts, method.has_clock and not numbers.right), order
    )
    conditions = {
        tree: numbers.condition(equation_text(tree, names), order, weights.gap(tree))
        for tree in rooted_trees
    }
    wrong = [tree for tree, condition in conditions.items() if condition.holds is False]
    # H without time come first, as they are cheaper: if the sum does not cancel for these, it does
    # not for every H.
    vanishes = _cancel(method, order, timed=False) if wrong else False
    if vanishes is not False and method.has_clock:
        if order > _MOST_ORDER_IN_TIME:
            name = f"b·Φ(t) = 1/γ(t) over trees of {order}"
            return (Condition(name, order, "unknown", None),)
        vanishes = _cancel(method, order, timed=True)
    if vanishes is False:
        return tuple(conditions.values())
    right = tuple(c for tree, c in conditions.items() if tree not in wrong)
    name = f"Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t) = 0 over the {len(wrong)} other trees"
    return *right, Condition(name, order, "0", vanishes)


def _cancel(method: TreeConditions, order: int, *, timed: bool) -> bool | None:
    """Return True if the trees of `order` vertices cancel for every H, None if undecided.

    `timed`: every H may depend on time.
    """
    numbers = method.tableau.numbers
    weights, parts = numbers.tree_weights, len(numbers.blocks)
    gaps = {
        tree: weights.gap(tree) for tree in all_trees(unrestricted_grammar(parts, timed), order)
    }
    jets = _JetsOfClass(order, method.kinetic, timed=timed)
    return cancels(numbers.ring, gaps, Differentials(jets, parts))


class _JetsOfClass:
    """The jets ∂_pⁱ ∂_q^j ∂_t^k H in the plane, free variables but for what a class of T implies.

    `kinetic`: the class of T in H = T + V; None for every H.
    """

    def __init__(self, order: int, kinetic: Kinetic | None, *, timed: bool) -> None:
        self.kinetic, self.quadratic = kinetic, kinetic is not None and kinetic.quadratic
        # For a quadratic T the second derivative by p stands for the first.
        max_order = order + self.quadratic
        separable, self.timed = kinetic is not None, timed
        self.jets = JetsInDegrees(("p", "q"), max_order, separable=separable, timed=timed)
        self.zero = self.jets.zero

    def h(self, i: int, j: int, k: int = 0) -> Poly:
        """Return H_ijk."""
        if i and k and self.kinetic is not None and "D" not in self.kinetic.timed_letters:
            return self.zero
        by_t = (k,) if self.timed else ()
        if i and self.quadratic:  # the derivative of p² m(t)/2 by p is p times the second one
            second = self.jets.derivative((2, j, *by_t))
            return self.zero if i > 2 else second if i == 2 else self.jets.variable("p") * second
        return self.jets.derivative((i, j, *by_t))


@lru_cache(maxsize=256)
def gaps_of(tableau: ImplicitTableau, order: int) -> Mapping[Tree, Poly]:
    """Return b·Φ(t) − 1/γ(t) for the trees of `order` vertices, in the ring of the numbers."""
    numbers = tableau.numbers
    grammar = unrestricted_grammar(len(numbers.blocks))
    return {tree: numbers.tree_weights.gap(tree) for tree in all_trees(grammar, order)}


def holds_for_all_trees(tableau: ImplicitTableau, order: int) -> bool:
    """Return True if the condition of every tree of up to `order` vertices holds exactly.

    In the plane fewer suffice, as the module says; for every number of degrees of freedom, all are
    needed. Those of a partitioned method have two colours.
    """
    ring = tableau.numbers.ring
    gaps = (gap for n in range(1, order + 1) for gap in gaps_of(tableau, n).values())
    return all(ring.vanishes(gap) is True for gap in gaps)


# -- elementary differentials -------------------------------------------------------------------


class HamiltonianDerivatives(Protocol[E_co]):
    """The derivatives H_ijk = ∂_pⁱ ∂_q^j ∂_t^k H, and 0, in some ring."""

    @property
    def zero(self) -> E_co: ...

    def h(self, i: int, j: int, k: int = 0) -> E_co: ...


class Differentials(Generic[E]):
    """The elementary differentials F(t) over the jets or their values.

    `parts`: the number of colours, 1 or 2.
    """

    def __init__(self, jets: HamiltonianDerivatives[E], parts: int = 1) -> None:
        self.jets, self.parts = jets, parts
        self._cache: dict[Tree, tuple[E, E]] = {}

    def differential(self, tree: Tree) -> tuple[E, E]:
        """Return the components of F(t) in p' and in q'."""
        if tree not in self._cache:
            root, branches = tree
            times = branches.count(TIME)
            inner = [self.differential(branch) for branch in branches if branch != TIME]
            # f = (−H_q, H_p) is differentiated by t once for each leaf of time, and along the
            # differential of each branch.
            p, q = -self._derivative(0, 1, times, inner), self._derivative(1, 0, times, inner)
            if self.parts == 2:
                p, q = (p, self.jets.zero) if root == 0 else (self.jets.zero, q)
            self._cache[tree] = p, q
        return self._cache[tree]

    def _derivative(self, i: int, j: int, k: int, along: Sequence[tuple[E, E]]) -> E:
        """Return the derivative of H_ijk in the directions `along`."""
        total, zero = self.jets.zero, self.jets.zero
        # Each vector has a part in p and one in q, which pick ∂_p or ∂_q of H.
        for parts in product((0, 1), repeat=len(along)):
            term = self.jets.h(i + parts.count(0), j + parts.count(1), k)
            for vector, part in zip(along, parts, strict=True):
                if term == zero:
                    break
                term = term * vector[part]
            total += term
        return total


def cancels(
    ring: Ring, gaps: Mapping[Tree, Poly], differentials: Differentials[Poly]
) -> bool | None:
    """Return True if Σ gap F(t)/σ(t) is 0 for every H; None if that is not decided.

    The gaps are numbers, and the differentials polynomials in the jets, which are free variables:
    so every monomial must have the coefficient 0.
    """
    totals: dict[tuple[int, tuple[int, ...]], Poly] = {}
    for tree, gap in gaps.items():
        if gap.is_zero():
            continue
        share = gap / symmetry(tree)
        for part, x in enumerate(differentials.differential(tree)):
            for monomial, coefficient in terms_of(x):
                key = part, monomial
                totals[key] = totals.get(key, ring.zero) + share * coefficient
    zeros = {ring.decide(x).zero for x in totals.values()}
    return False if False in zeros else None if None in zeros else True
