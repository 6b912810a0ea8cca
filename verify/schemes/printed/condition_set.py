"""The conditions on a table's entries, as polynomials that can be evaluated at any numbers."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any, Protocol

import flint
import sympy

from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose_defined
from verify.arithmetic.arb import Ball
from verify.arithmetic.number_system import E

BITS = 320  # the precision of the balls that decide about printed numbers


class Equation(Protocol):
    """One condition: its name, and the power of h that needs it."""

    @property
    def name(self) -> str: ...

    @property
    def order(self) -> int: ...


@dataclass(frozen=True)
class NamedEquation:
    """A condition of which only the name and the order are known."""

    name: str
    order: int


class Residuals(Protocol):
    """The residuals, left side − right side, of every condition at given entries.

    `one`: the number 1 of their kind. `bound`: every minus becomes a plus, so that at |entries| the
    value is a bound of the residual.
    """

    def __call__(self, entries: Sequence[E], one: E, bound: bool = False) -> list[E]: ...


@dataclass(frozen=True)
class ConditionSet:
    """Conditions on the entries of a table, referred to by their indices.

    - `entries`: polynomials in the rounded numbers.
    - `residuals`: those of all `equations`, in the same order.
    - `held_by_form`: the number of further conditions that hold by the form of the table.
    - `error_weights`: the factor of each residual in an error constant, such as 1/σ(t) of a tree;
      empty if all are 1.
    - `entry_names`: the names of entries, for the search of a misprint; empty if there is no
    search.
    - `select_residuals`: from indices to the residuals of these conditions alone, if that takes
    less
      work than all of them.
    """

    entries: tuple[sympy.Expr, ...]
    equations: tuple[Equation, ...]
    residuals: Residuals
    held_by_form: int = 0
    error_weights: tuple[Fraction, ...] = ()
    entry_names: tuple[str, ...] = ()
    select_residuals: Callable[[Sequence[int]], Residuals] | None = None

    def residuals_by_index(
        self, indices: Sequence[int], entries: Sequence[E], one: E
    ) -> dict[int, E]:
        """Return the residuals of the conditions with these indices, by index."""
        if self.select_residuals is not None:
            return dict(zip(indices, self.select_residuals(indices)(entries, one), strict=True))
        residuals = self.residuals(entries, one)
        return {k: residuals[k] for k in indices}

    def up_to(self, order: int) -> list[int]:
        """Return the indices of the conditions of that order, and of lower ones."""
        return [k for k, equation in enumerate(self.equations) if equation.order <= order]


# From the entries, the ring's one, and what a minus is (−1, or 1 for a bound) to pairs: the left
# side and the right side of each condition.
EquationSides = Callable[[Sequence[Any], Any, int], Iterable[tuple[Any, Any]]]


def conditions_of_pairs(
    entries: tuple[sympy.Expr, ...], names: Iterable[str], sides_of: EquationSides,
    entry_names: tuple[str, ...] = (), held_by_form: int = 0,
) -> ConditionSet:  # fmt: skip
    """Return the conditions that both sides of each equation are equal, with the names in the same
    order."""

    def residuals(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        minus = 1 if bound else -1
        return [left + right * minus for left, right in sides_of(entries, one, minus)]

    equations = tuple(NamedEquation(name, 1) for name in names)
    return ConditionSet(entries, equations, residuals, held_by_form, entry_names=entry_names)


def prepend_conditions(first: ConditionSet, second: ConditionSet) -> ConditionSet:
    """Return both sets as one on the second's entries, of which the first set reads the first ones.

    The second set has no `select_residuals`, and no conditions that its form fulfils.
    """
    count = len(first.entries)

    def residuals(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        first_residuals = first.residuals(entries[:count], one, bound)
        return [*first_residuals, *second.residuals(entries, one, bound)]

    equations = (*first.equations, *second.equations)
    return replace(
        second, equations=equations, residuals=residuals, held_by_form=first.held_by_form
    )


@lru_cache(maxsize=4096)
def ball_of(x: sympy.Expr) -> Ball:
    """Return a constant as a ball; flint's precision must be `BITS`, as the ball is cached."""
    if x.is_Rational:
        return flint.arb(flint.fmpq(int(x.p), int(x.q)))
    ring, (element,) = embed([x], ())
    return enclose_defined(ring, element, {}, 2 * BITS)


def size_of(x: sympy.Expr) -> Ball:
    """Return the absolute value of a constant as a ball."""
    return abs(ball_of(x))
