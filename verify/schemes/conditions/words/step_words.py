"""A step's coefficients of words, and those of its generator.

The step is S = Π exp(a Σ sⁿ X_n) over its parts, in the order in which they are made. As a function
of h it is the flow of some field that depends on time: h dS/dh = S G, and G = S⁻¹ h dS/dh is a Lie
series, of the exact flow the letters themselves, K_0 + K_1 + … + D_0 + …. So the step agrees with
the flow up to h^r where G has no other terms of weights up to r; and where some brackets of letters
vanish, where the others' coefficients in G do. Of a word G has

    G(w) = weight(w) S(w) − Σ S(u) G(v), over w = u v with neither empty.

A composition of symmetric steps of sizes a is Π exp(a Y_1 + a³ Y_3 + …): the same with s = a, and
with letters that do not commute.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any, Protocol

from verify.schemes.conditions.words.words import Word, cuts, endings, weight

# The kinds of its letters, "K" or "D", what part of h it takes, and at what part its time; of steps
# `STEPS`, and the size twice.
TimedPart = tuple[str, Any, Any]
Heads = tuple[tuple[int, int], ...]  # places of heads and of their tails


class Numbers(Protocol):
    """What a step's coefficients are made in: a ring, or numbers that need no reduction."""

    @property
    def zero(self) -> Any: ...
    @property
    def one(self) -> Any: ...
    def reduce(self, x: Any) -> Any: ...
    def multiply(self, x: Any, y: Any) -> Any: ...


@dataclass(frozen=True)
class PlainNumbers:
    """Numbers that need no reduction."""

    one: Any

    @property
    def zero(self) -> Any:
        """0."""
        return self.one * 0

    def reduce(self, x: Any) -> Any:
        """x itself."""
        return x

    def multiply(self, x: Any, y: Any) -> Any:
        """The product."""
        return x * y


class StepWords:
    """The coefficients of a step, each made once. `bound`: with every sign plus."""

    def __init__(self, ring: Numbers, parts: Sequence[TimedPart], bound: bool = False) -> None:
        self.ring, self.parts, self.bound = ring, parts, bound
        self._known: dict[Word, Any] = {}
        self._generated: dict[Word, Any] = {}

    def coefficient(self, word: Word) -> Any:
        """The word's in the step; `prepare` makes those of many together."""
        if word not in self._known:
            self.prepare([word])
        return self._known[word]

    def prepare(self, words: Iterable[Word]) -> None:
        """All of their heads are found in one passage over the parts."""
        asked = frozenset(words)
        if asked <= self._known.keys():
            return
        ring, plan = self.ring, _planned(asked, frozenset(kinds for kinds, *_ in self.parts))
        reached: list[Any] = [None if word else ring.one for word in plan.words]
        for kinds, size, time in self.parts:
            shares = _shares(ring, plan.tails[kinds], len(kinds) == 1, size, time)
            for place, heads in plan.heads[kinds]:  # a head is shorter, and is not yet this part's
                total = reached[place]
                for head, tail in heads:
                    before = reached[head]
                    if before is not None:
                        term = shares[tail] * before
                        total = term if total is None else total + term
                reached[place] = None if total is None else ring.reduce(total)
        values = (ring.zero if x is None else x for x in reached)
        self._known |= dict(zip(plan.words, values, strict=True))

    def generator(self, word: Word) -> Any:
        """The word's in G."""
        if word not in self._generated:
            total = self.coefficient(word) * weight(word)
            for head, tail in cuts(word):
                share = self.coefficient(head) * self.generator(tail)
                total = total + share if self.bound else total - share
            self._generated[word] = self.ring.reduce(total)
        return self._generated[word]

    def logarithm(self, word: Word) -> Any:
        """The word's in log S, of letters without time: Σ (−1)^(k+1)/k over its cuts into k
        pieces."""
        size, sign = len(word), 1 if self.bound else -1
        reached: list[Any] = [self.ring.one, *[None] * size]
        total = self.ring.zero
        for pieces in range(1, size + 1):
            after: list[Any] = [None] * (size + 1)
            for end in range(pieces, size + 1):
                made = [
                    before * self.coefficient(word[begin:end])
                    for begin, before in enumerate(reached[:end])
                    if before is not None
                ]
                after[end] = sum(made[1:], made[0]) if made else None
            reached = after
            if reached[size] is not None:
                total = total + reached[size] * (self.ring.one * sign ** (pieces + 1) / pieces)
        return self.ring.reduce(total)


@cache
def factors(word: Word) -> frozenset[Word]:
    """The heads of its tails, of which `StepWords.generator` takes the coefficients."""
    tails = [word, *(tail for _, tail in cuts(word))]
    return frozenset(x for tail in tails for x in (tail, *(head for head, _ in cuts(tail))))


# -- one passage over the parts -------------------------------------------------------------------


@dataclass(frozen=True)
class _Plan:
    """`words`: those asked for and their heads, the longest first; by the kinds of a part's letters
    `tails`, each after its own head, and `heads`: the places of words that end in such letters,
    with those of heads and of tails."""

    words: tuple[Word, ...]
    tails: dict[str, tuple[Word, ...]]
    heads: dict[str, tuple[tuple[int, Heads], ...]]


@lru_cache(maxsize=256)
def _planned(asked: frozenset[Word], kinds: frozenset[str]) -> _Plan:
    needed, left = {(), *asked}, list(asked)
    while left:
        word = left.pop()
        more = {head for own in kinds for head, _ in _ended(word, own)} - needed
        needed |= more
        left += more
    words = tuple(sorted(needed, key=len, reverse=True))
    places = {word: k for k, word in enumerate(words)}
    tails, heads = {}, {}
    for own in kinds:
        ended = {word: _ended(word, own) for word in words}
        found = {
            tail[:n] for each in ended.values() for _, tail in each for n in range(1, len(tail) + 1)
        }
        tails[own] = tuple(sorted(found, key=len))
        at = {tail: k for k, tail in enumerate(tails[own])}
        heads[own] = tuple(
            (places[word], tuple((places[head], at[tail]) for head, tail in each))
            for word, each in ended.items()
            if each
        )
    return _Plan(words, tails, heads)


@cache
def _ended(word: Word, kinds: str) -> tuple[tuple[Word, Word], ...]:
    """(head, tail) for each tail, not empty, in letters of these kinds."""
    if len(kinds) == 1:
        return endings(word) if word and word[-1][0] == kinds else ()
    return tuple((word[:k], word[k:]) for k in reversed(range(len(word))))


def _shares(ring: Numbers, tails: Sequence[Word], commute: bool, size: Any, time: Any) -> list[Any]:
    """The coefficients of exp(a Σ sⁿ X_n): Π a sⁿ, less what its orders count, m! of m letters; of
    those that commute m! of each alone."""
    powers = [size]
    for _ in range(max((n for tail in tails for _, n in tail), default=0)):
        powers.append(ring.multiply(powers[-1], time))
    found: dict[Word, Any] = {}
    for tail in tails:
        share = powers[tail[-1][1]]
        if len(tail) > 1:
            orders = tail.count(tail[-1]) if commute else len(tail)
            share = ring.multiply(found[tail[:-1]], share) / orders
        found[tail] = share
    return list(found.values())
