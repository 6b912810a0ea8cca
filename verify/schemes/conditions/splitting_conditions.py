"""Order and area of a splitting, by conditions on its coefficients, evaluated exactly.

With K and D the Lie derivatives of kick and drift, the step is S = exp(k₁hK) exp(d₁hD) …, in the
order in which it is made, and the exact flow is exp(h(K + D)). Both are power series in two letters
that do not commute. The flow's coefficient of every word of n letters is 1/n!; where the step's are
the same up to n letters, the map agrees with the flow up to hⁿ, for every H = T(p) + V(q).

Not every word is needed. An exponential of letters is group-like: products of its coefficients are
their shuffles (Ree). In the shuffle algebra every word is a polynomial in Lyndon words, those that
are smaller than each of their proper ends (Radford, J. Algebra 58 (1979); Reutenauer, Free Lie
Algebras, 1993, Theorem 6.1). So where the coefficients of the Lyndon words up to n letters are
right, all are: 2, 1, 2, 3, 6, 9, 18, 30 conditions of order 1 … 8 (compare Hairer, Lubich, Wanner,
Geometric Numerical Integration, III.5).

They are needed, too. Where all of less than n letters are right, the difference at n letters is a
Lie polynomial, and vanishes exactly where its coefficients of the Lyndon words do (Reutenauer,
Theorem 5.1). In the plane its K and D are Poisson brackets with V(q) and T(p). The brackets of n
letters are independent over all V and T up to n = 8 (a test has their rank; of the 56 with nine
letters there are 54), so that some H has another map.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, partial
from typing import ClassVar, TypeAlias

import flint

from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.late import sympy
from verify.prose import count
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.conditions.every_hamiltonian import StageEquations
from verify.schemes.conditions.residue import condition_of
from verify.schemes.conditions.words.equations import TimedEquation, equations_of_words
from verify.schemes.conditions.words.step_words import StepWords

# "kick" or "drift", and what part of h it takes: what needs no root may be a Fraction, whose scheme
# then needs no sympy.
Part: TypeAlias = "tuple[str, sympy.Expr | Fraction]"
Parts: TypeAlias = "tuple[tuple[str, sympy.Expr], ...]"
Nearby: TypeAlias = Callable[[int], NearbyOrder | None]  # of the highest order to look at
MOST_ORDER = 8  # beyond which fewer conditions would do in the plane
LETTERS = {"kick": "K", "drift": "D"}
_DIGITS = 12  # of a residue


@dataclass(frozen=True)
class Splitting:
    """Kicks p − a h V'(q) and drifts q + a h T'(p) of these parts of h, for H = T(p) + V(q).

    The sizes that are given are rational or algebraic numbers; those of `parts` are sympy's.
    `times`: of an H that depends on time, when each
    part is made, in parts of h from the step's start, where that is given. `nearby`: of sizes that
    are printed decimals, the order that exact ones near them have; `nearby_in_time`: of sizes or
    `times` that are. It is a `verify.schemes.conditions.condition.ByConditions`.
    """

    given: tuple[Part, ...]
    separable: bool = True
    times: tuple[sympy.Expr | None, ...] = ()
    nearby: Nearby | None = field(default=None, compare=False, repr=False)
    nearby_in_time: Nearby | None = field(default=None, compare=False, repr=False)
    most_order: ClassVar[int] = MOST_ORDER  # the highest of which there are conditions

    @cached_property
    def parts(self) -> Parts:
        """The parts, each with its size as an expression."""
        return expressed(self.given)

    def nearby_at(self, times: Sequence[sympy.Expr | None]) -> Nearby | None:
        """That of the parts at these times, None for the right ones."""
        if all(time is None for time in times):
            return self.nearby
        return self.nearby_in_time if tuple(times) == self.times else None

    @property
    def evaluations(self) -> dict[str, int]:
        """Those of H_p and of H_q in a step."""
        kinds = Counter(kind for kind, _ in self.given)
        return {"H_p": kinds["drift"], "H_q": kinds["kick"]}

    @property
    def a_step(self) -> str:
        """What it costs, in words."""
        found = self.evaluations
        return f"{count(found['H_q'], 'kick')}, {count(found['H_p'], 'drift')}"

    @cached_property
    def numbers(self) -> tuple[Ring, list[tuple[str, Poly]]]:
        """The parts, letters with sizes in one ring."""
        ring, sizes = embed([size for _, size in self.parts], ())
        kinds = (LETTERS[kind] for kind, _ in self.parts)
        return ring, list(zip(kinds, sizes, strict=True))

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """One for each Lyndon word of at most `order` letters; InputError beyond order 8."""
        return self._conditions.up_to(order)

    @cached_property
    def words(self) -> StepWords:
        """The step's coefficients of words."""
        ring, parts = self.numbers
        return StepWords(ring, [(letter, size, ring.zero) for letter, size in parts])

    @cached_property
    def _conditions(self) -> WordConditions:
        return WordConditions(self.numbers[0], self.words, partial(equations_of_words, ""))

    def area_conditions(self) -> tuple[Condition, ...]:
        """That every kick and every drift has determinant 1, whatever its size, T and V."""
        context = flint.fmpq_mpoly_ctx.get(("x",), flint.Ordering.lex)
        (x,), one, zero = context.gens(), context.constant(1), context.constant(0)
        # x = a h V'' or a h T'', any number
        shears = {"kick": ((one, -x), (zero, one)), "drift": ((one, zero), (x, one))}
        kinds = dict.fromkeys(kind for kind, _ in self.parts)
        found = []
        for kind in kinds:
            (a, b), (c, d) = shears[kind]
            residue = a * d - b * c - 1
            found.append(
                Condition(f"det of every {kind} = 1", 0, str(residue), bool(residue == zero))
            )
        return tuple(found)

    @property
    def stages(self) -> StageEquations | None:
        """The same scheme in stages; None where a coefficient is irrational."""
        if all(size.is_Rational for _, size in self.parts):
            return StageEquations.of_shears(self.parts)
        return None


def expressed(parts: Sequence[Part]) -> Parts:
    """The same parts, their sizes as expressions."""
    return tuple((kind, sympy.sympify(size)) for kind, size in parts)


class WordConditions:
    """Conditions on a step's coefficients of words, those of each weight made once."""

    def __init__(
        self, ring: Ring, words: StepWords, equations: Callable[[int], Sequence[TimedEquation]]
    ) -> None:
        self.ring, self.words, self.equations = ring, words, equations
        self._known: dict[int, tuple[Condition, ...]] = {}

    def up_to(self, order: int) -> tuple[Condition, ...]:
        """Those of weights 1 … `order`; InputError beyond order 8."""
        if order > MOST_ORDER:
            raise InputError("order", order, f"of a splitting is proved up to {MOST_ORDER}")
        return tuple(c for n in range(1, order + 1) for c in self._of_weight(n))

    def _of_weight(self, n: int) -> tuple[Condition, ...]:
        if n not in self._known:
            equations = self.equations(n)
            self.words.prepare({word for each in equations for word in each.needed})
            self._known[n] = tuple(
                condition_of(self.ring, each.name, n, each.residue(self.words), _DIGITS)
                for each in equations
            )
        return self._known[n]
