"""Splittings with drawn coefficients against series in two letters, multiplied out by dicts.

A series is {word: coefficient}. Numbers of the form a + b √2 are pairs, so that irrational
coefficients have an oracle, too.
"""

from fractions import Fraction
from itertools import product
from math import factorial

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.planted.splittings import coefficient
from tests.helpers.symmetry import prove_symmetry, symmetry_conditions
from verify.algebra.embedding import embed
from verify.errors import InputError
from verify.proof.order_conditions import first_wrong, prove_by_conditions
from verify.schemes import get
from verify.schemes.conditions.splitting_conditions import MOST_ORDER, Splitting
from verify.schemes.methods.user import splitting as own_splitting
from verify.schemes.splitting import splitting
from verify.verdict import Verdict

Surd = tuple[Fraction, Fraction]  # a + b √2
Parts = list[tuple[str, Surd]]
LETTER = {"kick": "K", "drift": "D"}
NOUGHT, ONE = (Fraction(0), Fraction(0)), (Fraction(1), Fraction(0))
COUNTS = (2, 1, 2, 3, 6, 9, 18, 30)  # of Lyndon words of two letters
ROOT = 2**0.5
quick = drawn(30)

sizes = st.builds(Fraction, st.integers(-4, 4), st.integers(1, 4))
surds = st.tuples(sizes, st.one_of(st.just(Fraction(0)), sizes))


def times(x: Surd, y: Surd) -> Surd:
    return x[0] * y[0] + 2 * x[1] * y[1], x[0] * y[1] + x[1] * y[0]


def plus(x: Surd, y: Surd) -> Surd:
    return x[0] + y[0], x[1] + y[1]


def exact(x: Surd) -> sympy.Expr:
    a, b = (sympy.Rational(y.numerator, y.denominator) for y in x)
    return a + b * sympy.sqrt(2)


def splitting_of(parts: Parts) -> Splitting:
    return Splitting(tuple((kind, exact(size)) for kind, size in parts))


def series(parts: Parts, most: int) -> dict[str, Surd]:
    """Π exp(a X), to words of so many letters."""
    total = {"": ONE}
    for kind, size in parts:
        powers = [ONE]
        for n in range(1, most + 1):
            powers.append(times(powers[-1], (size[0] / n, size[1] / n)))
        made: dict[str, Surd] = {}
        for word, c in total.items():
            for n in range(most + 1 - len(word)):
                longer = word + LETTER[kind] * n
                made[longer] = plus(made.get(longer, NOUGHT), times(c, powers[n]))
        total = made
    return total


def order_of(parts: Parts, most: int) -> int:
    """Up to how many letters the step has the flow's coefficients, of all words."""
    own = series(parts, most)
    for n in range(1, most + 1):
        words = map("".join, product("DK", repeat=n))
        if any(own.get(word, NOUGHT) != (Fraction(1, factorial(n)), 0) for word in words):
            return n - 1
    return most


@st.composite
def drawn_parts(draw: st.DrawFn) -> Parts:
    kinds = draw(st.lists(st.sampled_from(["kick", "drift"]), min_size=1, max_size=5))
    return [(kind, draw(surds)) for kind in kinds]


@st.composite
def consistent(draw: st.DrawFn) -> Parts:
    """Kicks that add up to 1, and drifts; often there and back again, so that the order is 2."""
    half = draw(drawn_parts())
    parts = half + half[::-1] if draw(st.booleans()) else half
    for kind in ("kick", "drift"):
        rest = plus(ONE, (-total(parts, kind)[0], -total(parts, kind)[1]))
        if draw(st.booleans()):
            parts = [(kind, (rest[0] / 2, rest[1] / 2)), *parts]
            parts.append(parts[0])
        else:
            parts = [*parts, (kind, rest)]
    return parts


def total(parts: Parts, kind: str) -> Surd:
    found = NOUGHT
    for own, size in parts:
        found = plus(found, size) if own == kind else found
    return found


@quick
@given(drawn_parts(), st.text("DK", min_size=1, max_size=5))
def test_the_coefficient_of_a_word_is_that_of_the_product_of_exponentials(
    parts: Parts, word: str
) -> None:
    ring, found = embed([exact(size) for _, size in parts], ())
    named = [(LETTER[kind], x) for (kind, _), x in zip(parts, found, strict=True)]
    gap = coefficient(ring, named, word)
    ring, (gap,) = embed(
        [ring.expression(gap) - exact(series(parts, len(word)).get(word, NOUGHT))], ()
    )
    assert ring.decide(gap).zero is True


@quick
@given(consistent(), st.integers(1, 4))
def test_the_order_by_conditions_is_that_of_all_words(parts: Parts, claimed: int) -> None:
    own = splitting_of(parts)
    scheme = splitting("drawn", own.parts, order=claimed, symmetric=False, source="drawn")
    proof, order = prove_by_conditions(scheme, own), order_of(parts, claimed + 2)
    assert proof.convergence_order == order
    assert proof.verdict is (Verdict.PROVED if order >= claimed else Verdict.REFUTED)
    assert (proof.order, proof.area_preserving, proof.separable) == (None, True, True)
    count = sum(COUNTS[:order])
    assert proof.checked[0] == f"order {order}, {count} conditions on the coefficients"
    assert len(proof.checked) == 1 + (order < claimed + 2)
    of_area = len({kind for kind, _ in parts})
    assert [c.order for c in proof.conditions][-of_area:] == [0] * of_area
    assert len(proof.conditions) == sum(COUNTS[:claimed]) + of_area
    if order < claimed:
        assert f"of h^{order + 1}," in proof.reason


@quick
@given(consistent(), st.integers(1, 4))
def test_a_residue_is_the_gap_to_the_flows_coefficient_to_its_last_digit(
    parts: Parts, most: int
) -> None:
    true = series(parts, most)
    conditions = splitting_of(parts).order_conditions(most)
    assert [c.order for c in conditions] == [n + 1 for n in range(most) for _ in range(COUNTS[n])]
    for condition in conditions:
        word = condition.name.split("coefficient of ")[1].split(" =")[0]
        gap = plus(true.get(word, NOUGHT), (-Fraction(1, factorial(len(word))), Fraction(0)))
        assert condition.order == len(word)
        assert condition.holds is (gap == NOUGHT)
        size = float(gap[0] + gap[1] * Fraction(ROOT))
        if condition.holds:
            assert condition.residue == "0"
        else:
            assert abs(float(condition.residue) - size) < 2e-11 * abs(size) + 1e-15
            assert len(condition.residue.strip("-0.").replace(".", "").split("e")[0]) <= 13
    wrong = first_wrong(conditions)
    assert (wrong is None) == all(c.holds for c in conditions)
    if wrong is not None:
        assert wrong.holds is False
        assert wrong.order == min(c.order for c in conditions if not c.holds)


def merged(parts: Parts) -> Parts:
    """No part 0, and no two neighbours of one kind; one change at a time."""
    for k, (kind, size) in enumerate(parts):
        if size == NOUGHT:
            return merged(parts[:k] + parts[k + 1 :])
        if k and parts[k - 1][0] == kind:
            both = kind, plus(parts[k - 1][1], size)
            return merged([*parts[: k - 1], both, *parts[k + 1 :]])
    return parts


def mirrored(parts: Parts) -> Parts:
    return parts + parts[-2::-1]


@quick
@given(st.one_of(drawn_parts(), drawn_parts().map(mirrored)))
def test_a_splitting_is_symmetric_where_what_is_left_of_it_is_a_palindrome(parts: Parts) -> None:
    own, left = splitting_of(parts), merged(parts)
    conditions = symmetry_conditions(own)
    if left:
        assert all(c.holds for c in conditions) == (left == left[::-1])
        assert len(conditions) == len(left) // 2 + (left[0][0] != left[-1][0])
    assert {c.order for c in conditions} <= {0}
    rational = all(size[1] == 0 for _, size in parts)
    stages = own.stages
    assert (stages is not None) == rational
    if stages is not None:
        assert [(s.kick, s.drift) for s in stages.stages] == [
            (size[0], 0) if kind == "kick" else (0, size[0]) for kind, size in parts
        ]


@drawn(12)
@given(st.one_of(consistent(), drawn_parts().map(mirrored)))
def test_symmetry_is_proved_of_palindromes_and_refuted_of_what_a_step_back_does_not_undo(
    parts: Parts,
) -> None:
    own, left = splitting_of(parts), merged(parts)
    order = order_of(parts, 1)
    scheme = splitting("drawn", own.parts, order=1, symmetric=False, source="drawn")
    found = prove_symmetry(scheme)
    if left == left[::-1] and len(left) > 1:
        assert (found.verdict, found.power) == (Verdict.PROVED, None)
    elif left != left[::-1] and found.verdict is not Verdict.UNDECIDED:
        assert found.verdict is Verdict.REFUTED
        # The step of −h after that of h, in letters: all of one letter cancel.
        back = [(kind, (-size[0], -size[1])) for kind, size in parts]
        gaps = series(parts + back, 4)
        first = min(len(w) for w, c in gaps.items() if w and c != NOUGHT)
        assert found.power == first
        assert f"O(h^{first})" in found.reason
    assert order <= 1


@quick
@given(drawn_parts(), st.one_of(st.none(), st.integers(1, MOST_ORDER)))
def test_a_users_splitting_has_the_parts_the_order_and_the_symmetry_that_were_written(
    parts: Parts, order: int | None
) -> None:
    words = [f"{kind}  {exact(size)}" for kind, size in parts]
    claim = [] if order is None else [f"order {order}"]
    scheme = get(" ;".join([*words, *claim, " "]))
    assert scheme.name == "; ".join([*(" ".join(w.split()) for w in words), *claim])
    assert scheme.every_h == splitting_of(parts)
    assert scheme.order == (order or 1)
    assert (scheme.symmetric, scheme.explicit, scheme.area_preserving) == (
        parts == parts[::-1],
        True,
        True,
    )
    assert own_splitting.make("lie2") is own_splitting.make(" ; ") is None
    bad = ["order 0", f"order {MOST_ORDER + 1}", "order -1", "order two", "push 1", "kick", "drift"]
    for word in bad:
        with pytest.raises(InputError):
            get("; ".join([*words, word]))


def test_a_users_splitting_has_200_parts_at_most() -> None:
    parts = ["kick 1/200"] * 200
    assert len(getattr(get("; ".join(parts)).every_h, "parts", ())) == 200
    with pytest.raises(InputError):
        get("; ".join([*parts, "kick 1"]))


def test_conditions_end_with_order_8() -> None:
    own = splitting_of([("kick", ONE), ("drift", ONE)])
    assert len(own.order_conditions(MOST_ORDER)) == sum(COUNTS)
    with pytest.raises(InputError):
        own.order_conditions(MOST_ORDER + 1)
