"""Order conditions of Runge–Kutta methods by rooted trees, from exact coefficients and stage times.

The method's map and the exact flow agree up to h^p for every smooth vector field exactly where
Σ_i b_i Φ_i(t) = 1/γ(t) for every rooted tree t of at most p vertices (Butcher 1963; Hairer,
Nørsett, Wanner, Solving Ordinary Differential Equations I, theorem II.2.13). With t = [t_1 … t_m],
the trees that are left where the root is taken away,

    Φ_i(t) = Π_k Σ_j a_ij Φ_j(t_k),   γ(t) = |t| γ(t_1) … γ(t_m).

All of them are needed, as is shown there with vector fields of high dimension. Of Hamiltonian
fields in the plane fewer are, from five vertices on: f'f is −det Hess H there, so that f''(f,
f'f'f) is f'f'f''(f, f), and of the conditions of two trees only one combination counts. So where
conditions of n vertices fail, the difference of the two maps' terms with hⁿ, Σ (b·Φ(t) − 1/γ(t))
F(t)/σ(t), is looked at as a polynomial in the derivatives of H (`verify.algebra.jets`);
where it vanishes that is one condition, which holds, in place of those that fail.

A condition is written with the vectors c = A 1 and b, products of vectors by component: that of
[τ, [τ]] is b·(c A(c)) = 1/8.

For z' = f(z, t) some leaves are of time: that is Butcher's theorem for the system with t' = 1
beside it (`verify.schemes.conditions.coloured_trees`). A leaf of time puts the stage's time c_i
into Φ_i(t). Where c = A 1, it has the factor of any leaf, and the densities know no colours: each
condition is one without time, and these are used. Combinations that count in the plane alone do
not carry over, as with time the field's derivative has a column f_t more: so the difference is
looked at for H without time first, which are among all, and then for every one.

The elementary differentials of f = (−H_q, H_p) are F(τ) = f and F([t_1 … t_m]) =
f⁽ᵐ⁾(F(t_1), …, F(t_m)); a leaf of time differentiates by t. The trees are of one colour for f, or
of two for its parts (−H_q, 0) and (0, H_p).
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
_MOST_TIMED = 8  # vertices: of which there are 1042 trees with leaves of time
E_co = TypeVar("E_co", covariant=True)


def trees(order: int) -> tuple[Tree, ...]:
    """Return all rooted trees of so many vertices: 1, 1, 2, 4, 9, 20, 48, 115, …"""
    return all_trees(PLAIN, order)


@dataclass(frozen=True)
class TreeConditions:
    """A Runge–Kutta method for every H, by conditions on its coefficients, and on its times where
    the tableau has a clock; `kinetic`: for every H = T + V with T of that class, of which fewer may
    count. It is a `verify.schemes.conditions.condition.ByConditions`."""

    tableau: ImplicitTableau
    kinetic: Kinetic | None = None
    kind: ClassVar[str] = "implicit-runge-kutta"  # the file of `verify.schemes.maps.kinds`

    @property
    def separable(self) -> bool:
        """True if it is for H = T + V alone."""
        return self.kinetic is not None

    @property
    def has_clock(self) -> bool:
        """True if it is for H that depend on time."""
        return self.tableau.clock is not None

    @property
    def most_order(self) -> int:
        """The highest order of which there are conditions."""
        return MOST_ORDER if self.tableau.numbers.right else _MOST_TIMED

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

        InputError beyond order 10, of which there are 1205, or 8 where a clock is not right.
        """
        if order > self.most_order:
            these = " with these times" * self.has_clock
            problem = f"of a Runge–Kutta method{these} is proved up to {self.most_order}"
            raise InputError("order", order, problem)
        return tuple(c for n in range(1, order + 1) for c in _of_order(self, n))

    def area_conditions(self) -> tuple[Condition, ...]:
        """Return the conditions of `ImplicitTableau.area_conditions`."""
        return self.tableau.area_conditions()


@lru_cache(maxsize=256)
def _of_order(method: TreeConditions, order: int) -> tuple[Condition, ...]:
    """Return each tree's condition; or, in place of those that fail, the one that their trees
    cancel for every H."""
    numbers = method.tableau.numbers
    weights, parts = numbers.tree_weights, len(numbers.blocks)
    names = ("",) if parts == 1 else ("_p", "_q")
    # With right clocks a leaf of time is as any other.
    rooted_trees = all_trees(
        unrestricted_grammar(parts, method.has_clock and not numbers.right), order
    )
    conditions = {
        tree: numbers.condition(equation_text(tree, names), order, weights.gap(tree))
        for tree in rooted_trees
    }
    wrong = [tree for tree, condition in conditions.items() if condition.holds is False]
    # H without time come first, as they are cheaper: if the sum does not cancel there, it never
    # does.
    vanishes = _cancel(method, order, timed=False) if wrong else False
    if vanishes is not False and method.has_clock:
        if order > _MOST_TIMED:
            name = f"b·Φ(t) = 1/γ(t) over trees of {order}"
            return (Condition(name, order, "unknown", None),)
        vanishes = _cancel(method, order, timed=True)
    if vanishes is False:
        return tuple(conditions.values())
    right = tuple(c for tree, c in conditions.items() if tree not in wrong)
    name = f"Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t) = 0 over the {len(wrong)} other trees"
    return *right, Condition(name, order, "0", vanishes)


def _cancel(method: TreeConditions, order: int, *, timed: bool) -> bool | None:
    """Return True if the trees of so many vertices cancel, for every H; `timed`: that depends on
    time."""
    numbers = method.tableau.numbers
    weights, parts = numbers.tree_weights, len(numbers.blocks)
    gaps = {
        tree: weights.gap(tree) for tree in all_trees(unrestricted_grammar(parts, timed), order)
    }
    jets = _JetsOfClass(order, method.kinetic, timed=timed)
    return cancels(numbers.ring, gaps, Differentials(jets, parts))


class _JetsOfClass:
    """The jets ∂_pⁱ ∂_q^j ∂_t^k H in the plane, free except for those of H = T + V with T of a
    class; None: of every H."""

    def __init__(self, order: int, kinetic: Kinetic | None, *, timed: bool) -> None:
        self.kinetic, self.quadratic = kinetic, kinetic is not None and kinetic.quadratic
        max_order = order + self.quadratic  # where the second derivative by p stands for the first
        separable, self.timed = kinetic is not None, timed
        self.jets = JetsInDegrees(("p", "q"), max_order, separable=separable, timed=timed)
        self.zero = self.jets.zero

    def h(self, i: int, j: int, k: int = 0) -> Poly:
        """Return H_ijk."""
        if i and k and self.kinetic is not None and "D" not in self.kinetic.timed_letters:
            return self.zero
        by_t = (k,) if self.timed else ()
        if i and self.quadratic:  # of p² m(t)/2 the derivative by p is p times the second one
            second = self.jets.derivative((2, j, *by_t))
            return self.zero if i > 2 else second if i == 2 else self.jets.variable("p") * second
        return self.jets.derivative((i, j, *by_t))


@lru_cache(maxsize=256)
def gaps_of(tableau: ImplicitTableau, order: int) -> Mapping[Tree, Poly]:
    """Return b·Φ(t) − 1/γ(t) for the trees of so many vertices, in the ring of the tableau's
    numbers."""
    weights = tableau.numbers.tree_weights
    return {tree: weights.gap(tree) for tree in trees(order)}


def holds_for_all_trees(tableau: ImplicitTableau, order: int) -> bool:
    """Return True if the condition of every tree of up to so many vertices holds exactly.

    In the plane fewer do, as the module says; in n degrees of freedom, for every n, all.
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
    """The elementary differentials F(t) over the jets or their values; `parts`: 2 for trees of two
    colours."""

    def __init__(self, jets: HamiltonianDerivatives[E], parts: int = 1) -> None:
        self.jets, self.parts = jets, parts
        self._cache: dict[Tree, tuple[E, E]] = {}

    def differential(self, tree: Tree) -> tuple[E, E]:
        """Return F(t), its parts in p' and in q'."""
        if tree not in self._cache:
            root, branches = tree
            times = branches.count(TIME)
            inner = [self.differential(branch) for branch in branches if branch != TIME]
            # f = (−H_q, H_p); the leaves of time raise the derivative by t, the branches are its
            # directions.
            p, q = -self._derivative(0, 1, times, inner), self._derivative(1, 0, times, inner)
            if self.parts == 2:
                p, q = (p, self.jets.zero) if root == 0 else (self.jets.zero, q)
            self._cache[tree] = p, q
        return self._cache[tree]

    def _derivative(self, i: int, j: int, k: int, along: Sequence[tuple[E, E]]) -> E:
        """Return the derivative of H_ijk along these vectors."""
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
    """Return True if Σ gap F(t)/σ(t) is 0 for every H; None where it is not decided.

    The gaps are numbers, the differentials polynomials in the jets, of which the monomials are
    independent: each of them has to have the coefficient 0.
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
