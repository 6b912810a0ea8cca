"""Order of a splitting whose parts have times, for every H = T(p, t) + V(q, t), by conditions.

A kick by a h at time t + s h is the flow of a h V(q, t + s h). With K_n and D_n the Lie derivatives
of ∂_t^n V/n! and ∂_t^n T/n! at t, the step is Π exp(a h Σ s^n h^n X_n), in the order in which it is
made. The exact flow is the ordered exponential of Σ τ^n h^n (K_n + D_n) over 0 ≤ τ ≤ 1: its
coefficient of the word X_{n_1} … X_{n_m} is the integral of Π τ_j^{n_j} over 0 < τ_1 < … < τ_m < 1,
which is Π_k 1/(n_1 + 1 + … + n_k + 1). A letter with index n counts n + 1 powers of h.

Both are group-like in the free algebra of these letters, so that, as for a splitting without time
(`verify.schemes.splitting_conditions`), the Lyndon words of up to that many powers of h suffice for
an order. They are needed, too: at one t the functions ∂_t^n V of q are free for each n, and so are
those of p, and among brackets of free functions of q and of p there is no other relation up to the
orders that are looked at there.

Where T does not depend on time, D_n = 0 for n > 0, and a drift's time is of no matter.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import ClassVar

import sympy

from verify.algebra.conditions import Condition
from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.schemes.residue import condition_of
from verify.schemes.splitting_conditions import LETTERS, Part, Splitting

Letter = tuple[str, int]  # K or D, and the n of the time derivative
Word = tuple[Letter, ...]
MOST_ORDER = 8
_DIGITS = 12  # of a residue
_PLURAL = {"K": "kicks", "D": "drifts"}


@dataclass(frozen=True)
class ClockedSplitting:
    """Kicks and drifts by these parts of h, each at its time, in parts of h from the step's start.

    `drifts_too`: for H = T(p, t) + V(q, t), else T does not depend on time. It is a
    `verify.algebra.conditions.ByConditions`.
    """

    parts: tuple[Part, ...]
    times: tuple[sympy.Expr, ...]
    drifts_too: bool = True
    separable: bool = True
    most_order: ClassVar[int] = MOST_ORDER

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """One for each Lyndon word of at most `order` powers of h; InputError beyond order 8."""
        if order > MOST_ORDER:
            raise InputError("order", order, f"of a splitting in time is proved up to {MOST_ORDER}")
        words = (word for weight in range(1, order + 1) for word in lyndon(weight))
        return tuple(self._of_word(word) for word in words if self._counts(word))

    def _counts(self, word: Word) -> bool:
        """Whether there is an H for which the word's derivative is not 0."""
        return self.drifts_too or all(n == 0 for kind, n in word if kind == "D")

    def area_conditions(self) -> tuple[Condition, ...]:
        """That every kick and every drift has determinant 1, at whatever time it is made."""
        return Splitting(self.parts).area_conditions()

    @cached_property
    def _numbers(self) -> tuple[Ring, list[tuple[str, Poly, Poly]]]:
        """Letters with sizes and times in one ring."""
        count = len(self.parts)
        ring, found = embed([*(size for _, size in self.parts), *self.times], ())
        kinds = (LETTERS[kind] for kind, _ in self.parts)
        return ring, list(zip(kinds, found[:count], found[count:], strict=True))

    @cached_property
    def _known(self) -> dict[Word, Condition]:
        return {}

    def _of_word(self, word: Word) -> Condition:
        if word not in self._known:
            ring, parts = self._numbers
            flow = of_flow(word)
            residue = coefficient(ring, parts, word) - ring.constant(flow)
            self._known[word] = condition_of(
                ring, _equation(word, flow), weight_of(word), residue, _DIGITS
            )
        return self._known[word]


def weight_of(word: Word) -> int:
    """The power of h that the word has."""
    return sum(n + 1 for _, n in word)


def of_flow(word: Word) -> Fraction:
    """The exact flow's coefficient of the word.

    >>> of_flow((("K", 1),)), of_flow((("D", 0), ("K", 0))), of_flow((("K", 0), ("K", 1)))
    (Fraction(1, 2), Fraction(1, 2), Fraction(1, 3))
    """
    product, reached = Fraction(1), 0
    for _, n in word:
        reached += n + 1
        product /= reached
    return product


def coefficient(ring: Ring, parts: Sequence[tuple[str, Poly, Poly]], word: Word) -> Poly:
    """The coefficient of the word in Π exp(a Σ s^n X_n), X the letters of the parts.

    `reached[n]` is that of its first n letters; a part with the letters that follow takes it on,
    with a^m Π s^n / m! for m of them.
    """
    reached = [ring.one, *[ring.zero] * len(word)]
    for letter, size, time in parts:
        for end in range(len(word), 0, -1):
            share = ring.one
            for length in range(1, end + 1):
                kind, n = word[end - length]
                if kind != letter:
                    break
                share = ring.multiply(share, ring.reduce(size * time**n)) / length
                reached[end] += ring.multiply(share, reached[end - length])
    return ring.reduce(reached[-1])


@cache
def lyndon(weight: int) -> tuple[Word, ...]:
    """The Lyndon words of that weight: smaller than each of their proper ends, D before K, and the
    lower derivative first.

    >>> [len(lyndon(n)) for n in range(1, 7)]
    [2, 3, 8, 18, 48, 116]
    """
    found = (word for word in _words(weight) if all(word < word[k:] for k in range(1, len(word))))
    return tuple(found)


def _words(weight: int) -> Iterator[Word]:
    if weight == 0:
        yield ()
        return
    for n in range(weight):
        for rest in _words(weight - n - 1):
            for kind in "DK":
                yield ((kind, n), *rest)


def _equation(word: Word, flow: Fraction) -> str:
    if len(word) == 1:
        ((kind, n),) = word
        times = "" if n == 0 else "·time" if n == 1 else f"·time^{n}"
        return f"Σ {_PLURAL[kind]}{times} = {flow}"
    between = " " if any(n for _, n in word) else ""
    letters = between.join(kind if n == 0 else f"{kind}_{n}" for kind, n in word)
    return f"coefficient of {letters} = {flow}"
