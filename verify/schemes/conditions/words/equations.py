"""Conditions on a step's coefficients of words, which can be evaluated over any numbers.

See `verify.schemes.conditions.splitting_conditions`, which decides them in a ring.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any, Literal

from verify.schemes.conditions.words.kinetic import Kinetic
from verify.schemes.conditions.words.quadratic import Combination, combinations
from verify.schemes.conditions.words.step_words import StepWords, factors
from verify.schemes.conditions.words.words import Word, flow_coefficient, lyndon, text, weight

_PLAIN = 3  # the weight up to which a quadratic T asks for as much as any T


@dataclass(frozen=True)
class WordEquation:
    """A condition on a combination of words' coefficients in the `operator`: the step, its
    generator or its logarithm."""

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

    def residue(self, words: StepWords) -> Any:
        """Return left side − right side; with every sign plus where the step's numbers are
        bounds."""
        one = words.ring.one * self.value.numerator / self.value.denominator
        # A bound adds absolute values: left side plus right side.
        total = one if words.bound else -one
        coefficient_functions = {"generator": words.generator, "logarithm": words.logarithm}
        coefficient = coefficient_functions.get(self.operator, words.coefficient)
        for n, word in self.terms:
            total += coefficient(word) * (abs(n) if words.bound else n)
        return total


def residues_of(equations: Sequence[WordEquation], words: StepWords) -> list[Any]:
    """Return the residuals of all equations, their words computed together."""
    words.prepare(_words_to_prepare(tuple(equations)))
    return [each.residue(words) for each in equations]


@lru_cache(maxsize=256)
def _words_to_prepare(equations: tuple[WordEquation, ...]) -> frozenset[Word]:
    return frozenset(word for each in equations for word in each.words_to_prepare)


@cache
def equations_of(kinetic: Kinetic | None, n: int) -> tuple[WordEquation, ...]:
    """Return the conditions of weight n for every V and every T of the class; None: without
    time."""
    if kinetic is not None and kinetic.quadratic and n > _PLAIN:
        return tuple(map(_of_generator, combinations(kinetic.timed_letters, n)))
    return tuple(map(_of_word, lyndon(kinetic.timed_letters if kinetic else "", n)))


def _of_word(word: Word) -> WordEquation:
    flow = flow_coefficient(word)
    return WordEquation(_equation(word, flow), weight(word), ((1, word),), flow)


def _of_generator(row: Combination) -> WordEquation:
    # Of the exact flow the generator has each letter once, and no longer word.
    value = sum(n for n, word in row if len(word) == 1)
    name = " + ".join(text(w) if n == 1 else f"({n}) {text(w)}" for n, w in row)
    name = f"coefficient of {name} in the generator = {value}"
    return WordEquation(name, weight(row[0][1]), row, Fraction(value), "generator")


def _equation(word: Word, flow: Fraction) -> str:
    """Return the word's condition; of one letter also as a sum over the parts.

    >>> _equation((("K", 1),), Fraction(1, 2))
    'Σ kicks·time = 1/2, coefficient of K1 = 1/2'
    """
    name = f"coefficient of {text(word)} = {flow}"
    if len(word) > 1:
        return name
    ((kind, n),) = word
    parts = {"K": "kicks", "D": "drifts"}[kind]
    time = "" if n == 0 else "·time" if n == 1 else f"·time^{n}"
    return f"Σ {parts}{time} = {flow}, {name}"
