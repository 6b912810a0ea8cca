"""A step's coefficients of words, and those of its generator.

The step is S = Π exp(a Σ sⁿ X_n) over its parts, in the order in which they are applied: a is the
size and s the time of a part, and X_n is K_n or D_n. As a function of h it is the flow of a field
that depends on time: h dS/dh = S G, and the generator G = S⁻¹ h dS/dh is a Lie series. For the
exact flow it is the sum of the letters, K_0 + K_1 + … + D_0 + …. So the step agrees with the flow
up to h^r if G has no other terms of weights up to r. If some brackets of letters vanish, only the
coefficients of the others in G must be 0. The coefficient of a word w in G is

    G(w) = weight(w) S(w) − Σ S(u) G(v), over all w = u v with neither u nor v empty.

A composition of symmetric steps of sizes a is Π exp(a Y_1 + a³ Y_3 + …): the same form with s = a,
and with letters that do not commute.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any, Protocol

from verify.schemes.conditions.words.words import Word, cuts, endings, weight

# A part: the kind of its letters, "K" or "D", its size a and its time s. A step of a composition:
# `STEPS`, and its size as both.
TimedPart = tuple[str, Any, Any]
Heads = tuple[tuple[int, int], ...]  # the indices of heads and of their tails


class WordNumbers(Protocol):
    """The numbers of a step's coefficients: a ring, or numbers that need no reduction."""

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
        """The number 0."""
        return self.one * 0

    def reduce(self, x: Any) -> Any:
        """Return x itself."""
        return x

    def multiply(self, x: Any, y: Any) -> Any:
        """Return the product."""
        return x * y


class StepWords:
    """The coefficients of words in a step, each computed once.

    `bound`: every minus becomes a plus, so that with |sizes| and |times| the values are bounds.
    """

    def __init__(self, ring: WordNumbers, parts: Sequence[TimedPart], bound: bool = False) -> None:
        self.ring, self.parts, self.bound = ring, parts, bound
        self._coefficients: dict[Word, Any] = {}
        self._generators: dict[Word, Any] = {}

    def coefficient(self, word: Word) -> Any:
        """Return the word's coefficient in the step; `prepare` computes many together faster."""
        if word not in self._coefficients:
            self.prepare([word])
        return self._coefficients[word]

    def prepare(self, words: Iterable[Word]) -> None:
        """Compute the coefficients of these words and their heads in one pass over the parts."""
        requested = frozenset(words)
        if requested <= self._coefficients.keys():
            return
        ring, plan = self.ring, _make_plan(requested, frozenset(kinds for kinds, *_ in self.parts))
        totals: list[Any] = [None if word else ring.one for word in plan.words]
        for kinds, size, time in self.parts:
            shares = _shares(ring, plan.tails[kinds], len(kinds) == 1, size, time)
            # Longer words come first: their heads do not yet include this part.
            for place, heads in plan.heads[kinds]:
                total = totals[place]
                for head, tail in heads:
                    before = totals[head]
                    if before is not None:
                        term = shares[tail] * before
                        total = term if total is None else total + term
                totals[place] = None if total is None else ring.reduce(total)
        values = (ring.zero if x is None else x for x in totals)
        self._coefficients |= dict(zip(plan.words, values, strict=True))

    def generator(self, word: Word) -> Any:
        """Return the word's coefficient in G."""
        if word not in self._generators:
            total = self.coefficient(word) * weight(word)
            # The recursion of the module's text, over all cuts with neither piece empty.
            for head, tail in cuts(word):
                share = self.coefficient(head) * self.generator(tail)
                total = total + share if self.bound else total - share
            self._generators[word] = self.ring.reduce(total)
        return self._generators[word]

    def logarithm(self, word: Word) -> Any:
        """Return the word's coefficient in log S, for letters without time.

        It is Σ (−1)^(k+1)/k times the product of the coefficients of the pieces, over all cuts of
        the word into k pieces.
        """
        size, sign = len(word), 1 if self.bound else -1
        totals: list[Any] = [self.ring.one, *[None] * size]
        total = self.ring.zero
        # totals[end] is the sum over the cuts of the first `end` letters into that many pieces.
        for pieces in range(1, size + 1):
            after: list[Any] = [None] * (size + 1)
            for end in range(pieces, size + 1):
                products = [
                    before * self.coefficient(word[begin:end])
                    for begin, before in enumerate(totals[:end])
                    if before is not None
                ]
                after[end] = sum(products[1:], products[0]) if products else None
            totals = after
            if totals[size] is not None:
                total = total + totals[size] * (self.ring.one * sign ** (pieces + 1) / pieces)
        return self.ring.reduce(total)


@cache
def factors(word: Word) -> frozenset[Word]:
    """Return the words whose coefficients `StepWords.generator` reads: tails, and their heads."""
    tails = [word, *(tail for _, tail in cuts(word))]
    return frozenset(x for tail in tails for x in (tail, *(head for head, _ in cuts(tail))))


# -- one pass over the parts ----------------------------------------------------------------------


@dataclass(frozen=True)
class _PassPlan:
    """A plan for one pass over the parts.

    `words`: the requested words and their heads, the longest first. By the kind of a part's
    letters: `tails` in these letters, each after its own beginnings; and `heads`, which for each
    word that ends in such letters has its index, and the indices of head and tail of each of its
    splits.
    """

    words: tuple[Word, ...]
    tails: dict[str, tuple[Word, ...]]
    heads: dict[str, tuple[tuple[int, Heads], ...]]


@lru_cache(maxsize=256)
def _make_plan(requested: frozenset[Word], kinds: frozenset[str]) -> _PassPlan:
    needed_words, pending = {(), *requested}, list(requested)
    while pending:
        word = pending.pop()
        heads_needed = {
            head for letter_kinds in kinds for head, _ in _head_tail_pairs(word, letter_kinds)
        } - needed_words
        needed_words |= heads_needed
        pending += heads_needed
    words = tuple(sorted(needed_words, key=len, reverse=True))
    places = {word: k for k, word in enumerate(words)}
    tails, heads = {}, {}
    for letter_kinds in kinds:
        splits = {word: _head_tail_pairs(word, letter_kinds) for word in words}
        tail_prefixes = {
            tail[:n]
            for pairs in splits.values()
            for _, tail in pairs
            for n in range(1, len(tail) + 1)
        }
        tails[letter_kinds] = tuple(sorted(tail_prefixes, key=len))
        tail_places = {tail: k for k, tail in enumerate(tails[letter_kinds])}
        heads[letter_kinds] = tuple(
            (places[word], tuple((places[head], tail_places[tail]) for head, tail in pairs))
            for word, pairs in splits.items()
            if pairs
        )
    return _PassPlan(words, tails, heads)


@cache
def _head_tail_pairs(word: Word, kinds: str) -> tuple[tuple[Word, Word], ...]:
    """Return (head, tail) for each nonempty tail in letters of these kinds."""
    if len(kinds) == 1:
        return endings(word) if word and word[-1][0] == kinds else ()
    return tuple((word[:k], word[k:]) for k in reversed(range(len(word))))


def _shares(
    ring: WordNumbers, tails: Sequence[Word], commute: bool, size: Any, time: Any
) -> list[Any]:
    """Return the coefficients of the tails in exp(a Σ sⁿ X_n).

    That of a tail of m letters is Π a sⁿ divided by m!; if letters commute, by the product of m!
    over its distinct letters, each of which occurs m times.
    """
    powers = [size]
    for _ in range(max((n for tail in tails for _, n in tail), default=0)):
        powers.append(ring.multiply(powers[-1], time))
    coefficients: dict[Word, Any] = {}
    for tail in tails:
        share = powers[tail[-1][1]]
        if len(tail) > 1:
            orders = tail.count(tail[-1]) if commute else len(tail)
            share = ring.multiply(coefficients[tail[:-1]], share) / orders
        coefficients[tail] = share
    return list(coefficients.values())
