"""Order conditions of Runge–Kutta methods for z' = f(z, t), from coefficients and stage times.

Map and exact flow agree up to h^p for every smooth f exactly where Σ_i b_i Φ_i(t) = 1/γ(t) for
every tree t of at most p vertices, some of whose leaves are of time: Butcher's theorem for the
system with t' = 1 beside it (`verify.schemes.conditions.coloured_trees`). A branch puts into Φ_i(t)
the factor Σ_j a_ij Φ_j, a leaf of time the stage's time c_i. Where c = A 1, a leaf of time has the
factor of any leaf, and the densities know no colours: each condition is one without time.

So with right clocks the conditions are those of `verify.schemes.conditions.tree_conditions`, as
long as each tree's own holds. Combinations that count in the plane alone do not carry over: f'f' is
−det Hess H there, but with time the field's derivative has a column f_t more. So where conditions
of n vertices fail, what is left at hⁿ, Σ (b·Φ(t) − 1/γ(t)) F(t)/σ(t) over all trees, is looked at
as a polynomial in the derivatives of H by p, q and t; first for H without time, which are among
them.

The derivatives of H(p, q, t) in the plane that differentials of trees are made of.

See `verify.schemes.conditions.elementary_differentials`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import flint
import sympy

from verify.errors import InputError
from verify.schemes.conditions.coloured_trees import PLAIN, Tree, all_trees, has_time, of_all
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.elementary_differentials import Differentials, cancel
from verify.schemes.conditions.implicit_tableau import SHOWN
from verify.schemes.conditions.residue import condition_of
from verify.schemes.conditions.timed.tableau import TimedNumbers, TimedTableau
from verify.schemes.conditions.tree_conditions import (
    MOST_ORDER,
    TreeConditions,
    conditions_of_trees,
)
from verify.schemes.conditions.words.kinetic import Kinetic


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

    def h(self, i: int, j: int, k: int = 0) -> flint.fmpq_mpoly:
        """H_ijk."""
        return self._known.get((i, j, k), self.zero)


def _occurs(kinetic: Kinetic | None, i: int, j: int, k: int) -> bool:
    if kinetic is None or i == 0:
        return True
    of_time = k == 0 or "D" in kinetic.timed
    return j == 0 and of_time and (i <= 2 or not kinetic.quadratic)


_MOST_TIMED = 8  # vertices: of which there are 1042 trees with leaves of time


@dataclass(frozen=True)
class TimedTrees:
    """A Runge–Kutta method for every H(p, q, t) (`kinetic`: for every H = T + V(q, t) with T of
    that class). It is a `verify.schemes.conditions.condition.ByConditions`."""

    tableau: TimedTableau
    kinetic: Kinetic | None = None

    @property
    def most_order(self) -> int:
        """The highest of which there are conditions."""
        return MOST_ORDER if self.clocks_are_right else _MOST_TIMED

    @property
    def separable(self) -> bool:
        """Whether it is for H = T + V alone."""
        return self.kinetic is not None

    @property
    def clocks_are_right(self) -> bool:
        """Whether every stage has the time that is right for it, exactly."""
        return self.tableau.numbers.right

    @property
    def clock(self) -> list[sympy.Expr]:
        """The time of each stage, in parts of h."""
        numbers = self.tableau.numbers
        return [numbers.ring.expression(time) for time in numbers.clock]

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Those of trees of 1 … `order` vertices.

        InputError beyond order 10, or 8 where a clock is not right.
        """
        if order > self.most_order:
            problem = f"of a Runge–Kutta method with these times is proved up to {self.most_order}"
            raise InputError("order", order, problem)
        orders = range(1, order + 1)
        return tuple(c for n in orders for c in _of_order(self.tableau, n, self.kinetic))

    def area_conditions(self) -> tuple[Condition, ...]:
        """At each stage's time those of one part without time; of two parts
        b_p,i a_q,ij + b_q,j a_p,ji = b_p,i b_q,j and b_p = b_q, which suffice (Hairer, Lubich,
        Wanner, theorem VI.4.6)."""
        if len(self.tableau.parts) == 1:
            return self.tableau.parts[0].area_conditions()
        return tuple(_area_of_two(self.tableau.numbers))


@lru_cache(maxsize=256)
def _of_order(tableau: TimedTableau, order: int, kinetic: Kinetic | None) -> tuple[Condition, ...]:
    plain = _without_time(tableau, order, kinetic)
    if plain is not None:
        return plain
    if order > _MOST_TIMED:
        return (Condition(f"b·Φ(t) = 1/γ(t) over trees of {order}", order, "unknown", None),)
    numbers, parts = tableau.numbers, len(tableau.parts)
    weights, every = numbers.tree_weights, all_trees(of_all(parts, timed=True), order)

    def cancels(_: Sequence[Tree]) -> bool | None:
        """For H without time first, which are among all."""
        gaps = {tree: weights.gap(tree) for tree in every}
        plain = {tree: gap for tree, gap in gaps.items() if not has_time(tree)}
        still = Differentials(TreeJets(order, kinetic, timed=False), parts)
        if cancel(numbers.ring, plain, still) is False:
            return False
        return cancel(numbers.ring, gaps, Differentials(TreeJets(order, kinetic), parts))

    # With right clocks a leaf of time is as any other.
    asked = [tree for tree in every if not (numbers.right and has_time(tree))]
    names = ("",) if parts == 1 else ("_p", "_q")
    return conditions_of_trees(weights, asked, order, cancels, names)


def _without_time(
    tableau: TimedTableau, order: int, kinetic: Kinetic | None
) -> tuple[Condition, ...] | None:
    """Those without time, where they are all that is asked: each holds with right clocks, or one
    fails for an H without time. None where that is not known of them."""
    if not tableau.numbers.right or len(tableau.parts) == 2:
        return None
    generic = TreeConditions(tableau.parts[0], kinetic is not None)
    plain = tuple(c for c in generic.order_conditions(order) if c.order == order)
    if len(plain) < len(all_trees(PLAIN, order)):  # a combination, in the plane, in place of some
        return None
    fewer = kinetic is not None and kinetic.quadratic  # than for every T
    return plain if not fewer or all(c.holds for c in plain) else None


def _area_of_two(numbers: TimedNumbers) -> Iterator[Condition]:
    (a, b), (u, v) = numbers.matrices, numbers.weights
    stages = range(len(numbers.clock))
    for i, j in product(stages, repeat=2):
        m, n = i + 1, j + 1
        name = f"b_p{m} a_q{m}{n} + b_q{n} a_p{n}{m} = b_p{m} b_q{n}"
        gap = u[i] * b[i][j] + v[j] * a[j][i] - u[i] * v[j]
        yield condition_of(numbers.ring, name, 0, gap, SHOWN)
    for i in stages:
        name = f"b_p{i + 1} = b_q{i + 1}"
        yield condition_of(numbers.ring, name, 0, u[i] - v[i], SHOWN)
