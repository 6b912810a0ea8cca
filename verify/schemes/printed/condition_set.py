"""The conditions on a table's entries, as polynomials that any numbers can be put into."""

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
from verify.arithmetic.number import E

BITS = 320  # of the balls in which all is decided


class Equation(Protocol):
    """One condition: its name, and the power of h that needs it."""

    @property
    def name(self) -> str: ...

    @property
    def order(self) -> int: ...


@dataclass(frozen=True)
class NamedEquation:
    """A condition that is known by its name alone."""

    name: str
    order: int


class Residues(Protocol):
    """The residuals, left side − right side, of every condition from the entries; `one` is the
    ring's.

    `bound`: with every sign plus, so that at |entries| it is a bound of all of them.
    """

    def __call__(self, entries: Sequence[E], one: E, bound: bool = False) -> list[E]: ...


@dataclass(frozen=True)
class ConditionSet:
    """Conditions on a table. `entries`: polynomials in the numbers that are rounded. `by_form`: the
    number of further conditions that hold by the form of the table alone. `shares`: the factors of
    the conditions in an error constant, as 1/σ(t) of a tree; 1 where there are none. `labels`:
    names of the entries, for the search of one that alone is wrong. `some`: the residuals of the
    conditions at these places alone, where they take less work than all of them."""

    entries: tuple[sympy.Expr, ...]
    equations: tuple[Equation, ...]
    residues: Residues
    by_form: int = 0
    shares: tuple[Fraction, ...] = ()
    labels: tuple[str, ...] = ()
    some: Callable[[Sequence[int]], Residues] | None = None

    def residues_of(self, rows: Sequence[int], entries: Sequence[E], one: E) -> dict[int, E]:
        """Return the residuals of the conditions at these places, by place."""
        if self.some is not None:
            return dict(zip(rows, self.some(rows)(entries, one), strict=True))
        residues = self.residues(entries, one)
        return {k: residues[k] for k in rows}

    def up_to(self, order: int) -> list[int]:
        """Return the places of the conditions of that order, and of lower ones."""
        return [k for k, each in enumerate(self.equations) if each.order <= order]


# Of entries, the ring's one and what a minus is, −1 or for a bound 1: left sides, and right sides.
Pairs = Callable[[Sequence[Any], Any, int], Iterable[tuple[Any, Any]]]


def conditions_of_pairs(
    entries: tuple[sympy.Expr, ...], names: Iterable[str], pairs: Pairs,
    labels: tuple[str, ...] = (), by_form: int = 0,
) -> ConditionSet:  # fmt: skip
    """Return the conditions that the sides of each pair are equal, with the names in the same
    order."""

    def residues(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        minus = 1 if bound else -1
        return [x + y * minus for x, y in pairs(entries, one, minus)]

    equations = tuple(NamedEquation(name, 1) for name in names)
    return ConditionSet(entries, equations, residues, by_form, labels=labels)


def prepend_conditions(first: ConditionSet, second: ConditionSet) -> ConditionSet:
    """Return both sets as one on the second's entries, of which the first set reads the first ones.

    The second set has no `some`, and no conditions that its form fulfils.
    """
    count = len(first.entries)

    def residues(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        return [
            *first.residues(entries[:count], one, bound), *second.residues(entries, one, bound)
        ]  # fmt: skip

    equations = (*first.equations, *second.equations)
    return replace(second, equations=equations, residues=residues, by_form=first.by_form)


Number = Callable[[sympy.Expr], E]


@lru_cache(maxsize=4096)
def ball_of(x: sympy.Expr) -> Ball:
    """Return a constant, at flint's present precision, which is `BITS` wherever this is called."""
    if x.is_Rational:
        return flint.arb(flint.fmpq(int(x.p), int(x.q)))
    ring, (element,) = embed([x], ())
    return enclose_defined(ring, element, {}, 2 * BITS)


def size_of(x: sympy.Expr) -> Ball:
    """Return the absolute value of a constant."""
    return abs(ball_of(x))
