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
from fractions import Fraction
from functools import cache
from math import gcd

import flint

from verify.schemes.conditions.words.equations import WordEquation
from verify.schemes.conditions.words.words import STEPS, Word, bracket, lyndon, text

KINDS = {"splitting": "", "nystrom": "", "composition": STEPS}  # with their letters
# Of nystrom steps fewer conditions would do from weight 8 on: forces of two kinds commute too.
MOST_ORDER = {"splitting": 8, "nystrom": 7, "composition": 10}


@cache
def conditions(kind: str, order: int) -> tuple[WordEquation, ...]:
    """Return all conditions of orders 1 … `order` for the kind; `order` at most
    `MOST_ORDER[kind]`."""
    equations = []
    for weight in range(1, order + 1):
        words = lyndon(KINDS[kind], weight)
        # [K, [K, [K, D]]] has weight 4: below that the conditions are those of any splitting.
        if kind == "nystrom" and weight > 3:
            equations += [_combination(row, words, weight) for row in _modulo_ideal(words, weight)]
            continue
        equations += [_single(kind, word, weight) for word in words]
    return tuple(equations)


def _single(kind: str, word: Word, weight: int) -> WordEquation:
    value, kinds = int(weight == 1), [letter for letter, _ in word]
    names = {"K": "Σ kicks = 1", "D": "Σ drifts = 1", "1": "Σ w = 1", "3": "Σ w³ = 0"}
    spelling = "Y" + " Y".join(kinds) if kind == "composition" else text(word)
    name = names.get("".join(kinds), f"coefficient of {spelling} in log S = {value}")
    return WordEquation(name, weight, ((1, word),), Fraction(value), "logarithm")


def _combination(row: Sequence[int], words: Sequence[Word], weight: int) -> WordEquation:
    terms = tuple((n, word) for n, word in zip(row, words, strict=True) if n)
    left_side = " + ".join(text(word) if n == 1 else f"({n}) {text(word)}" for n, word in terms)
    return WordEquation(f"{left_side} in log S = 0", weight, terms, Fraction(0), "logarithm")


# -- quadratic kinetic energy ---------------------------------------------------------------------


def _modulo_ideal(words: Sequence[Word], weight: int) -> Iterator[tuple[int, ...]]:
    """Yield a basis of the combinations of Lyndon words that vanish on the ideal's elements."""
    rows = [[element.get(word, 0) for word in words] for element in _ideal(weight)]
    # flint's nullspace is over ℤ but not primitive: each column is divided by its gcd.
    space, count = flint.fmpz_mat(rows).nullspace()
    for k in range(count):
        column = [int(space[i, k]) for i in range(len(words))]
        yield tuple(x // gcd(*column) for x in column)


@cache
def _ideal(weight: int) -> tuple[Mapping[Word, int], ...]:
    """Return elements that span the ideal's part of that weight: brackets of letters with [K, [K,
    [K, D]]]."""
    if weight == 4:
        nested: Mapping[Word, int] = {(("D", 0),): 1}
        for _ in range(3):
            nested = bracket(("K", 0), nested)
        return (nested,)
    return tuple(bracket((x, 0), element) for element in _ideal(weight - 1) for x in "DK")
