"""Words in the letters of a splitting with time, of which those of one kind commute.

A kick of a h at t + s h is the flow of a h V(q, t + s h). With K_n = ∂_tⁿ V/n! at t, as a Lie
derivative, it is exp(a Σ sⁿ h^(n+1) K_n); so K_n has the weight n + 1 in h, and D_n of the drift
likewise. All K_n are functions of q alone and commute, all D_n are of p alone; between the two
kinds there is no relation. So a kick may be parted into neighbours at several times, in any order.
Products of such letters are words in which a run of letters of one kind has no order (Cartier and
Foata). It is written with falling indices, the last in the dictionary.

Those of them that are smaller than each of their proper ends, the Lyndon words, lead the Lie
polynomials of a basis (Lalonde, Bases de Lyndon des algèbres de Lie libres partiellement
commutatives, Theor. Comput. Sci. 117 (1993)). So a Lie polynomial is known by its coefficients of
them; a test has the ranks. Without letters of time they are words as all are.

Which letters have a time depends on T in H = T + V(q, t): see `Kinetic`.
"""

from collections import Counter
from collections.abc import Iterator, Mapping
from enum import Enum
from fractions import Fraction
from functools import cache

STEPS = "13579"  # the kinds of letters of a composition of symmetric steps
Letter = tuple[str, int]  # "K" or "D", or one of `STEPS`, and its weight less 1, the power of time
Word = tuple[Letter, ...]


class Kinetic(Enum):
    """A class of kinetic energies T; V(q, t) is any smooth function in each of them, H = T + V."""

    GENERAL = "T(p, t)"
    AUTONOMOUS = "T(p)"
    MASS = "p²/(2m(t))"
    QUADRATIC = "p²/(2m)"

    @property
    def timed_letters(self) -> str:
        """The letters whose time counts: a drift's does where T depends on t."""
        return "KD" if self in (Kinetic.GENERAL, Kinetic.MASS) else "K"

    @property
    def quadratic(self) -> bool:
        """True if fewer conditions suffice than for every T."""
        return self in (Kinetic.MASS, Kinetic.QUADRATIC)


def weight(word: Word) -> int:
    """Return the power of h that the word comes with.

    >>> weight((("K", 1), ("D", 0)))
    3
    """
    return sum(n + 1 for _, n in word)


def text(word: Word) -> str:
    """Return the word as it is written; without indices where none depends on time.

    >>> text((("D", 0), ("K", 1))), text((("D", 0), ("K", 0)))
    ('D0 K1', 'DK')
    """
    if any(n for _, n in word):
        return " ".join(f"{kind}{n}" for kind, n in word)
    return "".join(kind for kind, _ in word)


def concatenate(head: Word, tail: Word) -> Word:
    """Return the product of two words."""
    if head and tail and head[-1][0] == tail[0][0]:
        cut = len(head) - len(last_run(head))
        end = next((k for k, x in enumerate(tail) if x[0] != tail[0][0]), len(tail))
        # Letters of one kind commute: where two runs meet they are merged in falling order.
        run = sorted(head[cut:] + tail[:end], reverse=True)
        return (*head[:cut], *run, *tail[end:])
    return head + tail


def last_run(word: Word) -> Word:
    """Return the letters at its end that are of one kind."""
    cut = len(word)
    while cut and word[cut - 1][0] == word[-1][0]:
        cut -= 1
    return word[cut:]


@cache
def endings(word: Word) -> tuple[tuple[Word, Word], ...]:
    """Return (head, tail) for each tail, not empty, that its last run contains: head · tail is the
    word.

    >>> [text(tail) for _, tail in endings((("D", 0), ("K", 1), ("K", 0)))]
    ['K', 'K1', 'K1 K0']
    """
    run = last_run(word)
    before = word[: len(word) - len(run)]
    counts = sorted(Counter(run).items(), reverse=True)
    pairs: list[tuple[Word, Word]] = [((), ())]
    for letter, many in counts:
        shares = range(many + 1)
        pairs = [(a + (letter,) * (many - k), b + (letter,) * k) for a, b in pairs for k in shares]
    return tuple((before + a, b) for a, b in pairs if b)


@cache
def cuts(word: Word) -> tuple[tuple[Word, Word], ...]:
    """Return (head, tail) with head · tail the word, each pair once; neither is empty."""
    pairs = dict.fromkeys(_cuts(word))
    return tuple((head, tail) for head, tail in pairs if head and tail)


def _cuts(word: Word) -> Iterator[tuple[Word, Word]]:
    yield word, ()
    if word:
        for head, tail in endings(word):
            yield head, tail
        run = last_run(word)
        # A cut before the last run takes that run whole into the tail, where letters may commute
        # with it.
        for head, tail in _cuts(word[: len(word) - len(run)]):
            yield head, concatenate(tail, run)


def letters(kinds: str, most: int) -> list[Letter]:
    """Return the letters of weights up to `most`: K_n and D_n, n > 0 of the kinds whose time
    counts, as "K" where only V depends on t; or, of `STEPS`, Y_1, Y_3, …, each a kind by itself."""
    if kinds == STEPS:
        return [(kind, int(kind) - 1) for kind in kinds if int(kind) <= most]
    return [(kind, n) for kind in "DK" for n in range(most) if n == 0 or kind in kinds]


@cache
def words(kinds: str, most: int) -> tuple[Word, ...]:
    """Return all words of that weight in these letters."""
    if most == 0:
        return ((),)
    all_words = {
        concatenate(w, (x,)) for x in letters(kinds, most) for w in words(kinds, most - 1 - x[1])
    }
    return tuple(sorted(sorted(all_words), key=len) if kinds == STEPS else sorted(all_words))


@cache
def lyndon(kinds: str, most: int) -> tuple[Word, ...]:
    """Return the Lyndon words of that weight.

    >>> [text(word) for word in lyndon("KD", 2)]
    ['DK', 'D1', 'K1']
    """
    return tuple(w for w in words(kinds, most) if all(w < w[k:] for k in range(1, len(w))))


def bracket(letter: Letter, element: Mapping[Word, int]) -> dict[Word, int]:
    """Return [letter, element], numbers by words."""
    coefficients = Counter[Word]()
    for word, n in element.items():
        coefficients[concatenate((letter,), word)] += n
        coefficients[concatenate(word, (letter,))] -= n
    return {word: n for word, n in coefficients.items() if n}


@cache
def flow_coefficient(word: Word) -> Fraction:
    """Return the word's coefficient in the exact flow over a step of 1.

    That of letters in an order is ∫ τ_1^n_1 … τ_m^n_m over 0 < τ_1 < … < τ_m < 1, which is
    Π 1/(weight of the first k letters); of a run all orders are added up.
    """
    if not word:
        return Fraction(1)
    heads = [head for head, tail in endings(word) if len(tail) == 1]
    return sum(map(flow_coefficient, heads), Fraction(0)) / weight(word)
