"""Order conditions as numbers in the logarithm of a step, over any number system.

A step S = Π exp(Σ c_l X_l) is a product of exponentials of letters that do not commute; log S is a
Lie series, and S agrees with the flow up to h^r where log S is that of the flow up to weight r. A
Lie element of the free algebra is known by its coefficients of the Lyndon words (Reutenauer, Free
Lie Algebras, 1993, theorem 5.1). Three kinds of steps are written so:

- `splitting`: kicks and drifts, letters K and D of weight 1, for H = T(p) + V(q);
- `nystrom`: the same for H = p·M⁻¹p/2 + V(q), where [K, [K, [K, D]]] = 0. The ideal that it
  generates is divided out: a condition is a combination of Lyndon words that vanishes on it;
- `composition`: steps of sizes w of any symmetric method, exp(wY₁ + w³Y₃ + w⁵Y₅ + …), letters 1, 3,
  5, … of those weights (Yoshida 1990; McLachlan 1995).

A step that is the same read backwards has no even weights in log S, since S(h) S(−h) = 1; so its
conditions of even order hold where those below do (Hairer, Lubich, Wanner, V.3 and III.5).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import gcd

import flint

from verify.arithmetic.number import E

KINDS = ("splitting", "nystrom", "composition")
# Of nystrom steps fewer conditions would do from weight 8 on: forces of two kinds commute too.
MOST_ORDER = {"splitting": 8, "nystrom": 7, "composition": 10}
_ODD = "13579"


@dataclass(frozen=True)
class LogCondition:
    """Σ weight · (coefficient of the word in log S) = `value`; `order`: the power of h."""

    name: str
    order: int
    terms: tuple[tuple[int, str], ...]
    value: int


@cache
def conditions(kind: str, order: int) -> tuple[LogCondition, ...]:
    """All of orders 1 … `order` for the kind; `order` at most `MOST_ORDER[kind]`."""
    found = []
    for weight in range(1, order + 1):
        words = lyndon(kind, weight)
        if kind == "nystrom" and weight > 3:
            found += [_combined(row, words, weight) for row in _modulo_ideal(words, weight)]
            continue
        found += [_single(kind, word, weight) for word in words]
    return tuple(found)


def _single(kind: str, word: str, weight: int) -> LogCondition:
    value = int(weight == 1)
    names = {"K": "Σ kicks = 1", "D": "Σ drifts = 1", "1": "Σ w = 1", "3": "Σ w³ = 0"}
    spelled = "Y" + " Y".join(word) if kind == "composition" else word
    return LogCondition(
        names.get(word, f"coefficient of {spelled} in log S = {value}"), weight, ((1, word),), value
    )


def _combined(row: Sequence[int], words: Sequence[str], weight: int) -> LogCondition:
    terms = tuple((n, word) for n, word in zip(row, words, strict=True) if n)
    text = " + ".join(word if n == 1 else f"({n}) {word}" for n, word in terms)
    return LogCondition(f"{text} in log S = 0", weight, terms, 0)


def weight_of(word: str) -> int:
    return sum(int(letter) if letter in _ODD else 1 for letter in word)


@cache
def words(kind: str, most: int) -> tuple[str, ...]:
    """All words of weights 0 … most, shorter prefixes first."""
    letters = _ODD if kind == "composition" else "DK"
    found = [""]
    for word in found:  # it grows while it is walked
        found += [word + x for x in letters if weight_of(word + x) <= most]
    return tuple(found)


@cache
def lyndon(kind: str, weight: int) -> tuple[str, ...]:
    """The Lyndon words of that weight: smaller than each of their proper ends.

    >>> lyndon("splitting", 3)
    ('DDK', 'DKK')
    """
    own = (word for word in words(kind, weight) if weight_of(word) == weight)
    return tuple(w for w in own if all(w < w[k:] for k in range(1, len(w))))


# -- the step -------------------------------------------------------------------------------------


def step(kind: str, parts: Sequence[Mapping[str, E]], most: int, one: E) -> dict[str, E]:
    """The coefficients of all words up to weight `most` in Π exp(part), in the ring of `one`."""
    all_words = words(kind, most)
    shares = [one / n for n in range(1, most + 1)]
    # By the words' places: tables are judged by many hundred steps.
    series: list[E | None] = [None if word else one for word in all_words]
    for part in parts:
        letters = frozenset(part)
        factor = _exponential(part, _words_of(kind, most, letters), shares)
        for place, cuts in _cuts(kind, most, letters):
            total = series[place]
            for head, end in cuts:
                before = series[head]
                if before is not None:
                    term = before * factor[end]
                    total = term if total is None else total + term
            series[place] = total
    zero = one * 0
    return {w: zero if x is None else x for w, x in zip(all_words, series, strict=True)}


@cache
def _words_of(kind: str, most: int, letters: frozenset[str]) -> tuple[str, ...]:
    """The words of such letters alone, but for that of none; shorter ones first."""
    return tuple(word for word in words(kind, most) if word and letters.issuperset(word))


@cache
def _cuts(
    kind: str, most: int, letters: frozenset[str]
) -> tuple[tuple[int, tuple[tuple[int, str], ...]], ...]:
    """The places of the words that end in such letters, with those of heads and with such ends, the
    shortest first; the longest words first, so that heads are still as they were before."""
    own = words(kind, most)
    places = {word: k for k, word in enumerate(own)}
    found = []
    for word in sorted(own, key=len, reverse=True):
        ends = len(word) - len(word.rstrip("".join(letters)))
        cuts = tuple((places[word[:-n]], word[-n:]) for n in range(1, ends + 1))
        found += [(places[word], cuts)] if cuts else []
    return tuple(found)


def _exponential(
    part: Mapping[str, E], own_words: Sequence[str], shares: Sequence[E]
) -> dict[str, E]:
    """The coefficients of exp(part) but for that of no letter, 1: Π c_l / n! of n letters."""
    found: dict[str, E] = {}
    for word in own_words:
        last = part[word[-1]]
        found[word] = last if len(word) == 1 else found[word[:-1]] * last * shares[len(word) - 1]
    return found


def of_logarithm(series: Mapping[str, E], word: str, sign: int = -1) -> E:
    """The word's coefficient in log S: Σ (−1)^(k+1)/k over its cuts into k pieces.

    With `sign` 1 all signs are plus, as of a bound.
    """
    size = len(word)
    reached: list[E | None] = [series[""], *[None] * size]
    total = series[""] * 0
    for pieces in range(1, size + 1):
        after: list[E | None] = [None] * (size + 1)
        for end in range(pieces, size + 1):
            cuts = [
                before * series[word[begin:end]]
                for begin, before in enumerate(reached[:end])
                if before is not None
            ]
            after[end] = sum(cuts[1:], cuts[0]) if cuts else None
        reached = after
        if reached[size] is not None:
            total = total + reached[size] * (series[""] * sign ** (pieces + 1) / pieces)
    return total


def residue(series: Mapping[str, E], condition: LogCondition, bound: bool = False) -> E:
    """Left side − right side of the condition. With `bound` every sign is plus: of a step with all
    sizes positive, a bound of all of them."""
    sign = 1 if bound else -1
    total = series[""] * (1 if bound else -condition.value)
    for n, word in condition.terms:
        total = total + of_logarithm(series, word, sign) * (abs(n) if bound else n)
    return total


# -- quadratic kinetic energy ---------------------------------------------------------------------


def _modulo_ideal(words: Sequence[str], weight: int) -> Iterator[tuple[int, ...]]:
    """A basis of the combinations of Lyndon words that vanish on the ideal's elements."""
    rows = [[element.get(word, 0) for word in words] for element in _ideal(weight)]
    space, count = flint.fmpz_mat(rows).nullspace()
    for k in range(count):
        column = [int(space[i, k]) for i in range(len(words))]
        yield tuple(x // gcd(*column) for x in column)


@cache
def _ideal(weight: int) -> tuple[dict[str, int], ...]:
    """Spans its part of that weight: brackets of letters with [K, [K, [K, D]]]."""
    if weight == 4:
        found = {"D": 1}
        for _ in range(3):
            found = _bracket("K", found)
        return (found,)
    return tuple(_bracket(x, element) for element in _ideal(weight - 1) for x in "DK")


def _bracket(letter: str, element: Mapping[str, int]) -> dict[str, int]:
    found: dict[str, int] = {}
    for word, n in element.items():
        for other, sign in ((letter + word, n), (word + letter, -n)):
            found[other] = found.get(other, 0) + sign
    return found
