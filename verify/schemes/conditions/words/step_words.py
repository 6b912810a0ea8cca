"""A step's coefficients of words, and those of its generator.

The step is S = Π exp(a Σ sⁿ X_n) over its parts, in the order in which they are made. As a function
of h it is the flow of some field that depends on time: h dS/dh = S G, and G = S⁻¹ h dS/dh is a Lie
series, of the exact flow the letters themselves, K_0 + K_1 + … + D_0 + …. So the step agrees with
the flow up to h^r where G has no other terms of weights up to r; and where some brackets of letters
vanish, where the others' coefficients in G do. Of a word G has

    G(w) = weight(w) S(w) − Σ S(u) G(v), over w = u v with neither empty.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any, Protocol

from verify.schemes.conditions.words.words import Letter, Word, cuts, endings, weight

TimedPart = tuple[str, Any, Any]  # "K" or "D", what part of h it takes, and at what part its time


class Numbers(Protocol):
    """What a step's coefficients are made in: a ring, or numbers that need no reduction."""

    @property
    def zero(self) -> Any: ...
    @property
    def one(self) -> Any: ...
    def reduce(self, x: Any) -> Any: ...
    def multiply(self, x: Any, y: Any) -> Any: ...


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
        ring, needed = self.ring, sorted(_with_heads(words), key=len, reverse=True)
        if all(word in self._known for word in needed):
            return
        reached = dict.fromkeys(needed, ring.zero)
        reached[()] = ring.one
        for kind, size, time in self.parts:
            shares = _Shares(ring, size, time)
            for word in needed:  # a head is shorter, and is not yet this part's
                if word and word[-1][0] == kind:
                    total = reached[word]
                    for head, tail in endings(word):
                        before = reached[head]
                        if not _is_zero(before):
                            total += shares.of(tail) * before
                    reached[word] = ring.reduce(total)
        self._known |= reached

    def generator(self, word: Word) -> Any:
        """The word's in G."""
        if word not in self._generated:
            total = self.coefficient(word) * weight(word)
            for head, tail in cuts(word):
                share = self.coefficient(head) * self.generator(tail)
                total = total + share if self.bound else total - share
            self._generated[word] = self.ring.reduce(total)
        return self._generated[word]


def _is_zero(x: Any) -> bool:
    """Of a ball around 0 it is not known, and neither x == 0 nor x != 0 holds."""
    return bool(x == 0)


def _with_heads(words: Iterable[Word]) -> set[Word]:
    found = {(), *words}
    left = list(found)
    while left:
        word = left.pop()
        more = {head for head, _ in endings(word)} - found if word else set()
        found |= more
        left += more
    return found


@cache
def factors(word: Word) -> frozenset[Word]:
    """The heads of its tails, of which `StepWords.generator` takes the coefficients."""
    tails = [word, *(tail for _, tail in cuts(word))]
    return frozenset(x for tail in tails for x in (tail, *(head for head, _ in cuts(tail))))


class _Shares:
    """The coefficients of exp(a Σ sⁿ X_n): Π aᵐ s^(n m)/m! of letters X_n, m times each."""

    def __init__(self, ring: Numbers, size: Any, time: Any) -> None:
        self.ring, self.size, self.time = ring, size, time
        self._known: dict[tuple[Letter, ...], Any] = {}

    def of(self, run: Word) -> Any:
        if run not in self._known:
            total = self.ring.one
            for (_, n), many in Counter(run).items():
                one = self.size if n == 0 else self.ring.multiply(self.size, self._power(n))
                for k in range(1, many + 1):
                    total = self.ring.multiply(total, one) / k
            self._known[run] = total
        return self._known[run]

    def _power(self, n: int) -> Any:
        """By products: of a ball with 0 in it powers may be undefined."""
        total = self.time
        for _ in range(n - 1):
            total = self.ring.multiply(total, self.time)
        return total
