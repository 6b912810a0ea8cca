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

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

from verify.algebra.ring import Poly
from verify.algebra.series.jets import Jets
from verify.errors import InputError
from verify.prose import count
from verify.schemes.conditions.coloured_trees import PLAIN, Tree, all_trees, equation_text
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.elementary_differentials import Differentials, cancel
from verify.schemes.conditions.implicit_tableau import SHOWN, ImplicitTableau
from verify.schemes.conditions.residue import condition_of
from verify.schemes.conditions.tree_weights import RingWeights

MOST_ORDER = 10


def trees(order: int) -> tuple[Tree, ...]:
    """All rooted trees of so many vertices: 1, 1, 2, 4, 9, 20, 48, 115, …"""
    return all_trees(PLAIN, order)


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


@lru_cache(maxsize=256)
def _of_order(tableau: ImplicitTableau, order: int, separable: bool) -> tuple[Condition, ...]:
    weights = tableau.numbers.tree_weights

    def cancels(wrong: Sequence[Tree]) -> bool | None:
        gaps = {tree: weights.gap(tree) for tree in wrong}
        return cancel(weights.ring, gaps, Differentials(Jets(order, separable=separable)))

    return conditions_of_trees(weights, trees(order), order, cancels)


def conditions_of_trees(
    weights: RingWeights,
    asked: Iterable[Tree],
    order: int,
    cancels: Callable[[Sequence[Tree]], bool | None],
    names: tuple[str, ...] = ("",),
) -> tuple[Condition, ...]:
    """Each tree's condition; or, in place of those that fail, the one that their trees cancel for
    every H.

    `names`: see `verify.schemes.conditions.coloured_trees.equation_text`.
    """
    found = {
        tree: condition_of(
            weights.ring, equation_text(tree, names), order, weights.gap(tree), SHOWN
        )
        for tree in asked
    }
    wrong = [tree for tree, condition in found.items() if condition.holds is False]
    cancelled = cancels(wrong) if wrong else False
    if cancelled is False:
        return tuple(found.values())
    left = tuple(c for tree, c in found.items() if tree not in wrong)
    name = f"Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t) = 0 over the {len(wrong)} other trees"
    return *left, Condition(name, order, "0", cancelled)


@lru_cache(maxsize=256)
def gaps_of(tableau: ImplicitTableau, order: int) -> Mapping[Tree, Poly]:
    """b·Φ(t) − 1/γ(t) for the trees of so many vertices, in the ring of the tableau's numbers."""
    weights = tableau.numbers.tree_weights
    return {tree: weights.gap(tree) for tree in trees(order)}


def all_trees_hold(tableau: ImplicitTableau, order: int) -> bool:
    """Whether the condition of every tree of up to so many vertices holds exactly.

    In the plane fewer do, as the module says; in n degrees of freedom, for every n, all.
    """
    ring = tableau.numbers.ring
    gaps = (gap for n in range(1, order + 1) for gap in gaps_of(tableau, n).values())
    return all(ring.vanishes(gap) is True for gap in gaps)
