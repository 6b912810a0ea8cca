"""Order, area and symmetry of a splitting, by conditions on its coefficients, evaluated exactly.

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
from functools import cached_property
from math import factorial
from typing import ClassVar, TypeAlias

import flint

from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.late import sympy
from verify.prose import count
from verify.schemes.conditions import Condition, NearbyOrder
from verify.schemes.every_hamiltonian import StageEquations
from verify.schemes.free_lie_words import lyndon
from verify.schemes.residue import condition_of

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
    `times` that are. It is a `verify.schemes.conditions.ByConditions`.
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
        if order > MOST_ORDER:
            raise InputError("order", order, f"of a splitting is proved up to {MOST_ORDER}")
        lengths = range(1, order + 1)
        return tuple(self._of_word(word) for n in lengths for word in lyndon("splitting", n))

    def _of_word(self, word: str) -> Condition:
        if word not in self._known:
            ring, parts = self.numbers
            flow = Fraction(1, factorial(len(word)))
            residue = coefficient(ring, parts, word) - ring.constant(flow)
            self._known[word] = condition_of(
                ring, _equation(word, flow), len(word), residue, _DIGITS
            )
        return self._known[word]

    @cached_property
    def _known(self) -> dict[str, Condition]:
        return {}

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

    def symmetry_conditions(self) -> tuple[Condition, ...]:
        """That it is a palindrome; neighbours of one kind are one part, and none is 0.

        Then the step of −h undoes that of h: its parts are those of h, in reverse and negative.
        Conversely, parts that alternate and are not 0 are determined by the product of their
        exponentials.
        """
        ring, parts = self.numbers
        merged = _alternating(ring, parts)
        found = []
        if merged and merged[0][0] != merged[-1][0]:
            name = (
                f"the first and the last part are of one kind, not {merged[0][0]}, {merged[-1][0]}"
            )
            found.append(Condition(name, 0, "1", False))
        for k in range(len(merged) // 2):
            residue = merged[k][1] - merged[-1 - k][1]
            name = f"part {k + 1} = part {len(merged) - k}"
            found.append(condition_of(ring, name, 0, residue, _DIGITS))
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


def coefficient(ring: Ring, parts: Sequence[tuple[str, Poly]], word: str) -> Poly:
    """The coefficient of the word in Π exp(a_i X_i), X_i the letters of the parts.

    `reached[n]` is that of its first n letters; a part with the letters that follow takes it on,
    with a^m/m! for m of them.
    """
    reached = [ring.one, *[ring.zero] * len(word)]
    for letter, size in parts:
        for end in range(len(word), 0, -1):
            share = ring.one
            for length in range(1, end + 1):
                if word[end - length] != letter:
                    break
                share = ring.multiply(share, size) / length
                reached[end] += ring.multiply(share, reached[end - length])
    return reached[-1]


def _equation(word: str, flow: Fraction) -> str:
    name = f"coefficient of {word} = {flow}"
    return {"K": f"Σ kicks = 1, {name}", "D": f"Σ drifts = 1, {name}"}.get(word, name)


def _alternating(ring: Ring, parts: Sequence[tuple[str, Poly]]) -> list[tuple[str, Poly]]:
    """The same product with no part 0, and no two neighbours of one letter."""
    found: list[tuple[str, Poly]] = []
    for letter, size in parts:
        if found and found[-1][0] == letter:
            size = ring.reduce(found.pop()[1] + size)
        if ring.decide(size).zero is not True:
            found.append((letter, size))
    return found
