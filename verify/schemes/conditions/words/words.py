"""Words in the letters of a splitting with time, of which those of one kind commute.

A kick of size a at t + s h is the flow of a h V(q, t + s h). With K_n the Lie derivative of
∂_tⁿ V/n! at t, it is exp(a Σ sⁿ h^(n+1) K_n); so K_n has the weight n + 1 in h, and likewise D_n of
the drift. All K_n belong to functions of q alone and commute, all D_n to functions of p alone;
between the two kinds there is no relation. Products of such letters are words in which the order
within a run of letters of one kind does not matter (Cartier and Foata). A run is written with
falling indices, which is its last order in the dictionary.

The Lyndon words, which are smaller than each of their proper ends, are the leading words of a basis
of the Lie polynomials (Lalonde, Bases de Lyndon des algèbres de Lie libres partiellement
commutatives, Theor. Comput. Sci. 117 (1993)). So a Lie polynomial is determined by its
coefficients of them; a test computes the ranks. Without letters of time they are ordinary words.

`Kinetic` says which letters have a time, by the class of T in H = T + V(q, t).
"""

from collections import Counter
from collections.abc import Iterator, Mapping
from enum import Enum
from fractions import Fraction
from functools import cache

STEPS = "13579"  # the letters of a composition of symmetric steps, each a kind
Letter = tuple[str, int]  # its kind, "K", "D" or one of `STEPS`, and the power of time, weight − 1
Word = tuple[Letter, ...]


class Kinetic(Enum):
    """A class of kinetic energies T in H = T + V(q, t), V any smooth function."""

    GENERAL = "T(p, t)"
    AUTONOMOUS = "T(p)"
    MASS = "p²/(2m(t))"
    QUADRATIC = "p²/(2m)"

    @property
    def timed_letters(self) -> str:
        """The letters whose time counts: D only if T depends on t."""
        return "KD" if self in (Kinetic.GENERAL, Kinetic.MASS) else "K"

    @property
    def quadratic(self) -> bool:
        """True if fewer conditions suffice than for every T."""
        return self in (Kinetic.MASS, Kinetic.QUADRATIC)


def weight(word: Word) -> int:
    """Return the power of h of the word.

    >>> weight((("K", 1), ("D", 0)))
    3
    """
    return sum(n + 1 for _, n in word)


def text(word: Word) -> str:
    """Return the word as text; without indices if no letter depends on time.

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
    """Return the longest end of the word in letters of one kind."""
    cut = len(word)
    while cut and word[cut - 1][0] == word[-1][0]:
        cut -= 1
    return word[cut:]


@cache
def endings(word: Word) -> tuple[tuple[Word, Word], ...]:
    """Return (head, tail) for each nonempty tail in the last run, with head · tail the word.

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
    """Return the letters of weights up to `most`.

    For `STEPS` they are Y_1, Y_3, …. Otherwise they are K_0 and D_0, and K_n and D_n with n > 0 of
    the `kinds` whose time counts, as "K" if only V depends on t.
    """
    if kinds == STEPS:
        return [(kind, int(kind) - 1) for kind in kinds if int(kind) <= most]
    return [(kind, n) for kind in "DK" for n in range(most) if n == 0 or kind in kinds]


@cache
def words(kinds: str, most: int) -> tuple[Word, ...]:
    """Return all words of the weight `most` in these letters."""
    if most == 0:
        return ((),)
    all_words = {
        concatenate(w, (x,)) for x in letters(kinds, most) for w in words(kinds, most - 1 - x[1])
    }
    return tuple(sorted(sorted(all_words), key=len) if kinds == STEPS else sorted(all_words))


@cache
def lyndon(kinds: str, most: int) -> tuple[Word, ...]:
    """Return the Lyndon words of the weight `most`.

    >>> [text(word) for word in lyndon("KD", 2)]
    ['DK', 'D1', 'K1']
    """
    return tuple(w for w in words(kinds, most) if all(w < w[k:] for k in range(1, len(w))))


def bracket(letter: Letter, element: Mapping[Word, int]) -> dict[Word, int]:
    """Return [letter, element], both as coefficients by word."""
    coefficients = Counter[Word]()
    for word, n in element.items():
        coefficients[concatenate((letter,), word)] += n
        coefficients[concatenate(word, (letter,))] -= n
    return {word: n for word, n in coefficients.items() if n}


@cache
def flow_coefficient(word: Word) -> Fraction:
    """Return the word's coefficient in the exact flow over a step of 1.

    For letters in one order it is ∫ τ_1^n_1 … τ_m^n_m over 0 < τ_1 < … < τ_m < 1, which is
    Π_k 1/(weight of the first k letters); all orders of a run are added up.
    """
    if not word:
        return Fraction(1)
    heads = [head for head, tail in endings(word) if len(tail) == 1]
    return sum(map(flow_coefficient, heads), Fraction(0)) / weight(word)
