"""Order conditions in the logarithm of a step, against series of words in plain Fractions."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import factorial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import rationals
from verify.schemes.conditions.free_lie_words import (
    KINDS,
    MOST_ORDER,
    conditions,
    lyndon,
    of_logarithm,
    residue,
    step,
    weight_of,
    words,
)

Series = Mapping[str, Fraction]
COUNTS = {"splitting": 71, "nystrom": 26, "composition": 35}  # of all conditions that are known
sizes = st.lists(rationals(4), min_size=1, max_size=4)


def times(x: Series, y: Series, most: int) -> dict[str, Fraction]:
    """The product of two series of words, up to a weight."""
    found: dict[str, Fraction] = {}
    for a, m in x.items():
        for b, n in y.items():
            if weight_of(a + b) <= most:
                found[a + b] = found.get(a + b, Fraction(0)) + m * n
    return found


def exponential(part: Series, most: int) -> dict[str, Fraction]:
    term: dict[str, Fraction] = {"": Fraction(1)}
    total = dict(term)
    for n in range(1, most + 1):
        term = {word: x / n for word, x in times(term, part, most).items()}
        total = {w: total.get(w, Fraction(0)) + term.get(w, Fraction(0)) for w in total | term}
    return total


def product(parts: Sequence[Series], most: int) -> dict[str, Fraction]:
    found = {"": Fraction(1)}
    for part in parts:
        found = times(found, exponential(part, most), most)
    return found


def logarithm(series: Series, most: int) -> dict[str, Fraction]:
    rest = {word: x for word, x in series.items() if word}
    power: dict[str, Fraction] = {"": Fraction(1)}
    found: dict[str, Fraction] = {}
    for k in range(1, most + 1):
        power = times(power, rest, most)
        for word, x in power.items():
            found[word] = found.get(word, Fraction(0)) + x * Fraction((-1) ** (k + 1), k)
    return found


def parts_of(kind: str, given_: Sequence[Fraction]) -> list[dict[str, Fraction]]:
    if kind == "composition":
        return [{letter: w ** int(letter) for letter in "13579"} for w in given_]
    return [{"KD"[k % 2]: w} for k, w in enumerate(given_)]


@drawn(20)
@given(st.sampled_from(KINDS), sizes)
def test_a_steps_words_are_those_of_the_product_of_exponentials(
    kind: str, given_: list[Fraction]
) -> None:
    found = step(kind, parts_of(kind, given_), 5, Fraction(1))
    assert found.keys() == set(words(kind, 5))
    wanted = product(parts_of(kind, given_), 5)
    assert all(x == wanted.get(word, 0) for word, x in found.items())


@drawn(20)
@given(st.sampled_from(KINDS), sizes)
def test_the_logarithms_words_are_those_of_the_logarithm(kind: str, given_: list[Fraction]) -> None:
    series = step(kind, parts_of(kind, given_), 5, Fraction(1))
    wanted = logarithm(series, 5)
    for word in words(kind, 5)[1:]:
        assert of_logarithm(series, word) == wanted.get(word, 0), word


@drawn(10)
@given(st.sampled_from(KINDS), st.lists(rationals(4), min_size=1, max_size=3))
def test_a_residue_is_the_combination_of_the_logarithms_words_less_its_value(
    kind: str, given_: list[Fraction]
) -> None:
    series = step(kind, parts_of(kind, given_), 6, Fraction(1))
    wanted = logarithm(series, 6)
    for condition in conditions(kind, 6):
        total = sum(n * wanted.get(word, Fraction(0)) for n, word in condition.terms)
        assert residue(series, condition) == total - condition.value


@drawn(20)
@given(st.sampled_from(KINDS), st.lists(rationals(4), min_size=3, max_size=5))
def test_no_residue_is_larger_than_its_majorant_at_the_sizes_of_the_parts(
    kind: str, given_: list[Fraction]
) -> None:
    """Of a combination with signs all of its words count, whatever theirs are."""
    most = MOST_ORDER["nystrom"]
    series = step(kind, parts_of(kind, given_), most, Fraction(1))
    large = step(kind, parts_of(kind, [*map(abs, given_)]), most, Fraction(1))
    for condition in conditions(kind, most):
        bound = residue(large, condition, bound=True)
        assert abs(residue(series, condition)) <= bound, condition.name
        alone = (abs(n) * of_logarithm(large, word, 1) for n, word in condition.terms)
        assert bound == 1 + sum(alone)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("weight", range(1, 8))
def test_lyndon_words_are_smaller_than_all_their_turns(kind: str, weight: int) -> None:
    own = [word for word in words(kind, weight) if weight_of(word) == weight]
    turned = [w for w in own if all(w < w[k:] + w[:k] for k in range(1, len(w)))]
    assert sorted(lyndon(kind, weight)) == sorted(turned)


@pytest.mark.parametrize("kind", KINDS)
def test_there_are_as_many_conditions_as_are_known(kind: str) -> None:
    found = conditions(kind, MOST_ORDER[kind])
    assert len(found) == COUNTS[kind]
    assert {x.order for x in found} <= set(range(1, MOST_ORDER[kind] + 1))
    assert [x.value for x in found] == [int(x.order == 1) for x in found]
    assert len({x.name for x in found}) == len(found)
    spelled = [x.name for x in found if x.order > 3]
    assert all(("Y" in name) == (kind == "composition") for name in spelled)


@drawn(20)
@given(st.sampled_from(KINDS), st.integers(1, 6))
def test_the_flow_satisfies_all_conditions(kind: str, most: int) -> None:
    """exp(K + D), and exp(Y₁): each coefficient of a word of n letters is 1/n!."""
    letters = "1" if kind == "composition" else "KD"
    series = {
        word: Fraction(set(word) <= set(letters), factorial(len(word)))
        for word in words(kind, most)
    }
    assert all(residue(series, x) == 0 for x in conditions(kind, most))


@drawn(20)
@given(st.sampled_from(KINDS), sizes, st.booleans())
def test_a_step_that_is_the_same_backwards_has_nothing_of_even_weight(
    kind: str, half: list[Fraction], odd: bool
) -> None:
    whole = [*half, *half[::-1][odd or kind != "composition" :]]
    series = step(kind, parts_of(kind, whole), 4, Fraction(1))
    for condition in conditions(kind, 4):
        if condition.order % 2 == 0:
            assert residue(series, condition) == 0


def bracket(x: Series, y: Series) -> dict[str, Fraction]:
    forth, back = times(x, y, 7), times(y, x, 7)
    return {w: forth.get(w, Fraction(0)) - back.get(w, Fraction(0)) for w in forth | back}


@drawn(20)
@given(st.text("DK", max_size=3))
def test_with_quadratic_t_nothing_is_asked_of_what_vanishes(beside: str) -> None:
    """[K, [K, [K, D]]] = 0, and so are its brackets with letters."""
    element: dict[str, Fraction] = {"D": Fraction(1)}
    for letter in "KKK" + beside:
        element = bracket({letter: Fraction(1)}, element)
    weight = 4 + len(beside)
    for condition in conditions("nystrom", weight):
        if condition.order == weight:
            assert sum(n * element.get(word, Fraction(0)) for n, word in condition.terms) == 0


@drawn(10)
@given(st.integers(4, 7))
def test_with_quadratic_t_more_is_asked_of_what_does_not_vanish(weight: int) -> None:
    """[D, [D, … [D, K]]] is no bracket with [K, [K, [K, D]]]."""
    element: dict[str, Fraction] = {"K": Fraction(1)}
    for _ in range(weight - 1):
        element = bracket({"D": Fraction(1)}, element)
    own = [x for x in conditions("nystrom", weight) if x.order == weight]
    assert any(sum(n * element.get(w, Fraction(0)) for n, w in x.terms) for x in own)
