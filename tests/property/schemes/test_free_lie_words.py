"""Order conditions in the logarithm of a step, against series of words in plain Fractions."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import factorial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import rationals
from verify.schemes.conditions.words.equations import (
    LETTERS_BY_KIND,
    MOST_ORDER_BY_KIND,
    logarithm_equations,
)
from verify.schemes.conditions.words.step_words import PlainNumbers, StepWords
from verify.schemes.conditions.words.words import (
    STEPS,
    Word,
    concatenate,
    letters,
    lyndon,
    weight,
    words,
)

Series = Mapping[Word, Fraction]
COUNTS = {"splitting": 71, "nystrom": 26, "composition": 35}  # of all conditions that are known
sizes = st.lists(rationals(4), min_size=1, max_size=4)


def times(x: Series, y: Series, most: int) -> dict[Word, Fraction]:
    """The product of two series of words, up to a weight."""
    found: dict[Word, Fraction] = {}
    for a, m in x.items():
        for b, n in y.items():
            if weight(a + b) <= most:
                word = concatenate(a, b)
                found[word] = found.get(word, Fraction(0)) + m * n
    return found


def exponential(part: Series, most: int) -> dict[Word, Fraction]:
    term: dict[Word, Fraction] = {(): Fraction(1)}
    total = dict(term)
    for n in range(1, most + 1):
        term = {word: x / n for word, x in times(term, part, most).items()}
        total = {w: total.get(w, Fraction(0)) + term.get(w, Fraction(0)) for w in total | term}
    return total


def product(parts: Sequence[Series], most: int) -> dict[Word, Fraction]:
    found: dict[Word, Fraction] = {(): Fraction(1)}
    for part in parts:
        found = times(found, exponential(part, most), most)
    return found


def logarithm(series: Series, most: int) -> dict[Word, Fraction]:
    rest = {word: x for word, x in series.items() if word}
    power: dict[Word, Fraction] = {(): Fraction(1)}
    found: dict[Word, Fraction] = {}
    for k in range(1, most + 1):
        power = times(power, rest, most)
        for word, x in power.items():
            found[word] = found.get(word, Fraction(0)) + x * Fraction((-1) ** (k + 1), k)
    return found


def kinds_of(kind: str, count: int) -> list[str]:
    return [STEPS if kind == "composition" else "KD"[k % 2] for k in range(count)]


def parts_of(kind: str, given_: Sequence[Fraction]) -> list[dict[Word, Fraction]]:
    """What is exponentiated, by words of one letter."""
    pairs = zip(kinds_of(kind, len(given_)), given_, strict=True)
    return [{((k, n),): w ** (n + 1) for k, n in letters(LETTERS_BY_KIND[kind], 9) if k in own}
            for own, w in pairs]  # fmt: skip


def step(kind: str, given_: Sequence[Fraction], bound: bool = False) -> StepWords:
    parts = zip(kinds_of(kind, len(given_)), given_, given_, strict=True)
    return StepWords(PlainNumbers(Fraction(1)), list(parts), bound)


def every(kind: str, most: int) -> list[Word]:
    return [word for n in range(most + 1) for word in words(LETTERS_BY_KIND[kind], n)]


@drawn(20)
@given(st.sampled_from([*LETTERS_BY_KIND]), sizes)
def test_a_steps_words_are_those_of_the_product_of_exponentials(
    kind: str, given_: list[Fraction]
) -> None:
    found, wanted = step(kind, given_), product(parts_of(kind, given_), 5)
    found.prepare(every(kind, 5))
    assert all(found.coefficient(word) == wanted.get(word, 0) for word in every(kind, 5))


@drawn(20)
@given(st.sampled_from([*LETTERS_BY_KIND]), sizes)
def test_the_logarithms_words_are_those_of_the_logarithm(kind: str, given_: list[Fraction]) -> None:
    found, wanted = step(kind, given_), logarithm(product(parts_of(kind, given_), 5), 5)
    for word in every(kind, 5)[1:]:
        assert found.logarithm(word) == wanted.get(word, 0), word


@drawn(10)
@given(st.sampled_from([*LETTERS_BY_KIND]), st.lists(rationals(4), min_size=1, max_size=3))
def test_a_residue_is_the_combination_of_the_logarithms_words_less_its_value(
    kind: str, given_: list[Fraction]
) -> None:
    found, wanted = step(kind, given_), logarithm(product(parts_of(kind, given_), 6), 6)
    for condition in logarithm_equations(kind, 6):
        total = sum(n * wanted.get(word, Fraction(0)) for n, word in condition.terms)
        assert condition.residual(found) == total - condition.value


@drawn(20)
@given(st.sampled_from([*LETTERS_BY_KIND]), st.lists(rationals(4), min_size=3, max_size=5))
def test_no_residue_is_larger_than_its_majorant_at_the_sizes_of_the_parts(
    kind: str, given_: list[Fraction]
) -> None:
    """Of a combination with signs all of its words count, whatever theirs are."""
    most = MOST_ORDER_BY_KIND["nystrom"]
    own, large = step(kind, given_), step(kind, [*map(abs, given_)], bound=True)
    for condition in logarithm_equations(kind, most):
        bound = condition.residual(large)
        assert abs(condition.residual(own)) <= bound, condition.name
        alone = (abs(n) * large.logarithm(word) for n, word in condition.terms)
        assert bound == condition.value + sum(alone)


@pytest.mark.parametrize("kind", LETTERS_BY_KIND)
@pytest.mark.parametrize("most", range(1, 8))
def test_lyndon_words_are_smaller_than_all_their_turns(kind: str, most: int) -> None:
    own = words(LETTERS_BY_KIND[kind], most)
    turned = [w for w in own if all(w < w[k:] + w[:k] for k in range(1, len(w)))]
    assert sorted(lyndon(LETTERS_BY_KIND[kind], most)) == sorted(turned)


@pytest.mark.parametrize("kind", LETTERS_BY_KIND)
def test_there_are_as_many_conditions_as_are_known(kind: str) -> None:
    found = logarithm_equations(kind, MOST_ORDER_BY_KIND[kind])
    assert len(found) == COUNTS[kind]
    assert {x.order for x in found} <= set(range(1, MOST_ORDER_BY_KIND[kind] + 1))
    assert [x.value for x in found] == [int(x.order == 1) for x in found]
    assert len({x.name for x in found}) == len(found)
    spelled = [x.name for x in found if x.order > 3]
    assert all(("Y" in name) == (kind == "composition") for name in spelled)


@drawn(20)
@given(st.sampled_from([*LETTERS_BY_KIND]), st.integers(1, 6))
def test_the_flow_satisfies_all_conditions(kind: str, most: int) -> None:
    """exp(K + D), and exp(Y₁): each coefficient of a word of n letters is 1/n!."""

    class Flow(StepWords):
        def coefficient(self, word: Word) -> Fraction:
            plain = all(kind in "KD1" for kind, _ in word)
            return Fraction(plain, factorial(len(word)))

    flow = Flow(PlainNumbers(Fraction(1)), [])
    assert all(x.residual(flow) == 0 for x in logarithm_equations(kind, most))
