"""Order conditions of a step as equations between its coefficients of words, over any numbers.

The coefficients are those of the step itself, or if T is quadratic those of its generator; without
time also those of its logarithm. `verify.schemes.conditions.splitting_conditions` decides the
equations in a ring.

If T = p²/(2m), D_n is m_n p²/2 with 1/m = Σ m_n tⁿ, and a bracket of letters is a polynomial in p,
the m_n and the derivatives of the functions V_n(q), all of which are free. Some brackets are 0, as
{V, {V', {V'', p²}}}, and some are equal. A Lie polynomial is Σ y_b b over brackets b whose leading
words are the Lyndon words, and its Hamiltonian is Σ y_b H_b. If the H_b have rank r, the
Hamiltonian vanishes if and only if r combinations of the coefficients of Lyndon words do. Only
words of the same letters combine: a letter D_n is seen in H_b as a factor m_n, and K_n as a
function V_n.

Without time, a step S = Π exp(Σ c_l X_l) is a product of exponentials of letters that do not
commute. Then log S is a Lie series, and S agrees with the flow up to h^r if log S is that of the
flow up to weight r. A Lie element of the free algebra is determined by its coefficients of the
Lyndon words (Reutenauer, Free Lie Algebras, 1993, theorem 5.1). There are three kinds of steps:

- `splitting`: kicks and drifts, letters K and D of weight 1, for H = T(p) + V(q);
- `nystrom`: the same for H = p·M⁻¹p/2 + V(q), where [K, [K, [K, D]]] = 0. The ideal that
  this bracket generates is divided out: a condition is a combination of Lyndon words that vanishes
  on the ideal;
- `composition`: steps of sizes w of any symmetric method, exp(wY₁ + w³Y₃ + w⁵Y₅ + …), letters 1, 3,
  5, … of those weights (Yoshida 1990; McLachlan 1995).

A step that is the same read backwards has no even weights in log S, since S(h) S(−h) = 1: if its
conditions of lower orders hold, so do those of even order (Hairer, Lubich, Wanner, V.3 and III.5).
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from math import gcd, lcm
from typing import Any, Literal

import flint

from verify.algebra.jets import JetsInDegrees, Poly
from verify.schemes.conditions.words.step_words import StepWords, factors
from verify.schemes.conditions.words.words import (
    STEPS,
    Kinetic,
    Letter,
    Word,
    bracket,
    flow_coefficient,
    lyndon,
    text,
    weight,
)

Combination = tuple[tuple[int, Word], ...]
# The `kinds` of letters that `lyndon` takes, for each kind of table.
LETTERS_BY_KIND = {"splitting": "", "nystrom": "", "composition": STEPS}
# For nystrom steps fewer conditions suffice from weight 8 on, as more brackets vanish.
MOST_ORDER_BY_KIND = {"splitting": 8, "nystrom": 7, "composition": 10}
_MOST_GENERAL_WEIGHT = 3  # up to it a quadratic T needs the same conditions as any T
_MOST_WEIGHT = 8  # limit of the weight of words


@dataclass(frozen=True)
class WordEquation:
    """A condition: the combination `terms` of words' coefficients has the value `value`.

    The coefficients are those in the `operator`: the step, its generator or its logarithm.
    """

    name: str
    order: int
    terms: Combination
    value: Fraction
    operator: Literal["step", "generator", "logarithm"] = "step"

    @property
    def words_to_prepare(self) -> frozenset[Word]:
        """The words whose coefficients are to be prepared."""
        if self.operator == "step":
            return frozenset(word for _, word in self.terms)
        return frozenset(x for _, word in self.terms for x in factors(word))

    def residual(self, words: StepWords) -> Any:
        """Return left side − right side; if `words.bound`, a bound with every sign plus."""
        one = words.ring.one * self.value.numerator / self.value.denominator
        # A bound adds absolute values: left side plus right side.
        total = one if words.bound else -one
        coefficient_functions = {"generator": words.generator, "logarithm": words.logarithm}
        coefficient = coefficient_functions.get(self.operator, words.coefficient)
        for n, word in self.terms:
            total += coefficient(word) * (abs(n) if words.bound else n)
        return total


def residuals_of(equations: Sequence[WordEquation], words: StepWords) -> list[Any]:
    """Return the residuals of all equations; their words are computed together."""
    words.prepare(_words_to_prepare(tuple(equations)))
    return [equation.residual(words) for equation in equations]


@lru_cache(maxsize=256)
def _words_to_prepare(equations: tuple[WordEquation, ...]) -> frozenset[Word]:
    return frozenset(word for equation in equations for word in equation.words_to_prepare)


@cache
def equations_of_weight(kinetic: Kinetic | None, n: int) -> tuple[WordEquation, ...]:
    """Return the conditions of weight n for every V and every T of the class; None: no time."""
    if kinetic is not None and kinetic.quadratic and n > _MOST_GENERAL_WEIGHT:
        return tuple(map(_equation_in_generator, combinations(kinetic.timed_letters, n)))
    return tuple(map(_equation_of_word, lyndon(kinetic.timed_letters if kinetic else "", n)))


def _equation_of_word(word: Word) -> WordEquation:
    flow = flow_coefficient(word)
    return WordEquation(_equation_text(word, flow), weight(word), ((1, word),), flow)


def _equation_in_generator(row: Combination) -> WordEquation:
    # The exact flow's generator is the sum of the letters.
    value = sum(n for n, word in row if len(word) == 1)
    name = f"coefficient of {_sum_text(row)} in the generator = {value}"
    return WordEquation(name, weight(row[0][1]), row, Fraction(value), "generator")


def _sum_text(terms: Combination) -> str:
    return " + ".join(text(word) if n == 1 else f"({n}) {text(word)}" for n, word in terms)


def _equation_text(word: Word, flow: Fraction) -> str:
    """Return the text of a word's condition; for one letter also as a sum over the parts.

    >>> _equation_text((("K", 1),), Fraction(1, 2))
    'Σ kicks·time = 1/2, coefficient of K1 = 1/2'
    """
    name = f"coefficient of {text(word)} = {flow}"
    if len(word) > 1:
        return name
    ((kind, n),) = word
    parts = {"K": "kicks", "D": "drifts"}[kind]
    time = "" if n == 0 else "·time" if n == 1 else f"·time^{n}"
    return f"Σ {parts}{time} = {flow}, {name}"


# -- combinations for a quadratic T --------------------------------------------------------------


@cache
def combinations(kinds: str, n: int) -> tuple[Combination, ...]:
    """Return combinations of weight n that all vanish if and only if the Hamiltonian does.

    It is the Hamiltonian of the Lie polynomial with these coefficients. `kinds`: the letters whose
    time counts: "KD" if m depends on t, else "K".
    """
    by_letters: dict[Word, list[Word]] = defaultdict(list)
    for word in lyndon(kinds, n):
        by_letters[tuple(sorted(word))].append(word)
    return tuple(x for item in by_letters.items() for x in _combinations_of_letters(*item))


def _combinations_of_letters(letters: Word, leading: list[Word]) -> Iterator[Combination]:
    brackets = _brackets(letters)
    hamiltonians = [dict(b.hamiltonian.to_dict()) for b in brackets]
    monomials = sorted({m for h in hamiltonians for m in h})
    if not monomials:
        return
    # With C the brackets' coefficients of the words, c = y C are those of the Lie polynomial; with
    # M the brackets' Hamiltonians by monomials, y M = c C⁻¹ M must vanish.
    coefficients = flint.fmpq_mat([[b.words.get(w, 0) for w in leading] for b in brackets])
    values = flint.fmpq_mat([[h.get(m, 0) for m in monomials] for h in hamiltonians])
    echelon, rank = (coefficients.inv() * values).transpose().rref()
    for i in range(rank):
        row = [echelon[i, j] for j in range(len(leading))]
        denominator = lcm(*(int(x.q) for x in row))
        yield tuple(
            (int(x.p) * (denominator // int(x.q)), w)
            for x, w in zip(row, leading, strict=True)
            if x
        )


@dataclass(frozen=True)
class _Bracket:
    """A bracket of letters: its words, each with its coefficient, and its Hamiltonian."""

    words: Mapping[Word, int]
    hamiltonian: Poly

    def with_letter(self, letter: Letter) -> "_Bracket":
        """Return the bracket [letter, self]."""
        return _Bracket(bracket(letter, self.words), _poisson(letter, self.hamiltonian))


@cache
def _brackets(letters: Word) -> tuple[_Bracket, ...]:
    """Return a basis of the brackets of these letters, each used as often as it occurs."""
    if len(letters) == 1:
        return (_Bracket({letters: 1}, _hamiltonian_of_letter(letters[0])),)
    spanning = []
    for letter in dict.fromkeys(letters):
        others = list(letters)
        others.remove(letter)
        # Brackets nested to the right span all brackets, with each letter in turn as the outermost.
        spanning += [b.with_letter(letter) for b in _brackets(tuple(others))]
    words = sorted({w for b in spanning for w in b.words})
    if not words:
        return ()
    matrix = flint.fmpq_mat([[b.words.get(w, 0) for b in spanning] for w in words])
    # The pivot columns are the first independent brackets.
    echelon, rank = matrix.rref()
    columns = range(len(spanning))
    return tuple(spanning[next(j for j in columns if echelon[i, j])] for i in range(rank))


def _hamiltonian_of_letter(letter: Letter) -> Poly:
    """Return the Hamiltonian of a letter, in jets: ∂_q ∂_tⁿ V, as free as V_n, stands for it."""
    kind, n = letter
    return _jets().variable("p") ** 2 / 2 if kind == "D" else _jets().derivative((0, 1, n))


def _poisson(letter: Letter, x: Poly) -> Poly:
    """Return {letter, x} with {a, b} = a_p b_q − a_q b_p."""
    kind, n = letter
    if kind == "K":
        return -_jets().derivative((0, 2, n)) * x.derivative(0)
    return _jets().variable("p") * _jets().diff(x, "q")


@cache
def _jets() -> JetsInDegrees:
    return JetsInDegrees(("p", "q"), _MOST_WEIGHT, separable=True, timed=True)


# -- in the logarithm of the step -----------------------------------------------------------------


@cache
def logarithm_equations(kind: str, order: int) -> tuple[WordEquation, ...]:
    """Return all conditions of orders 1 … `order` ≤ `MOST_ORDER_BY_KIND[kind]` for the kind."""
    equations = []
    for n in range(1, order + 1):
        words = lyndon(LETTERS_BY_KIND[kind], n)
        # [K, [K, [K, D]]] has weight 4: below that the conditions are those of any splitting.
        if kind == "nystrom" and n > 3:
            equations += [
                _equation_of_combination(row, words, n) for row in _modulo_ideal(words, n)
            ]
        else:
            equations += [_equation_in_logarithm(kind, word, n) for word in words]
    return tuple(equations)


def _equation_in_logarithm(kind: str, word: Word, n: int) -> WordEquation:
    value, kinds = int(n == 1), [letter for letter, _ in word]
    names = {"K": "Σ kicks = 1", "D": "Σ drifts = 1", "1": "Σ w = 1", "3": "Σ w³ = 0"}
    spelling = "Y" + " Y".join(kinds) if kind == "composition" else text(word)
    name = names.get("".join(kinds), f"coefficient of {spelling} in log S = {value}")
    return WordEquation(name, n, ((1, word),), Fraction(value), "logarithm")


def _equation_of_combination(row: Sequence[int], words: Sequence[Word], n: int) -> WordEquation:
    terms = tuple((factor, word) for factor, word in zip(row, words, strict=True) if factor)
    return WordEquation(f"{_sum_text(terms)} in log S = 0", n, terms, Fraction(0), "logarithm")


def _modulo_ideal(words: Sequence[Word], n: int) -> Iterator[tuple[int, ...]]:
    """Yield a basis of the combinations of these Lyndon words that vanish on the ideal."""
    rows = [[element.get(word, 0) for word in words] for element in _ideal(n)]
    # flint's nullspace over ℤ is not primitive: each column is divided by its gcd.
    space, count = flint.fmpz_mat(rows).nullspace()
    for k in range(count):
        column = [int(space[i, k]) for i in range(len(words))]
        yield tuple(x // gcd(*column) for x in column)


@cache
def _ideal(n: int) -> tuple[Mapping[Word, int], ...]:
    """Return elements that span the ideal of [K, [K, [K, D]]] in weight n ≥ 4."""
    if n == 4:
        nested: Mapping[Word, int] = {(("D", 0),): 1}
        for _ in range(3):
            nested = bracket(("K", 0), nested)
        return (nested,)
    return tuple(bracket((x, 0), element) for element in _ideal(n - 1) for x in "DK")
