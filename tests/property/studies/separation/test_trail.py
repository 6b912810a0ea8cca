"""Rationals over one denominator, against the same rationals each by itself."""

from fractions import Fraction
from itertools import accumulate

from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.studies.separation.chain import Trail

quick = drawn(60)
dyadic = st.builds(lambda n, k: Fraction(n, 2**k), st.integers(), st.integers(0, 300))
values = st.one_of(dyadic, st.builds(Fraction, st.integers(-50, 50), st.integers(1, 10**6)))
trails = st.lists(values, max_size=12)


@quick
@given(trails)
def test_it_is_the_sequence_of_its_values(given_: list[Fraction]) -> None:
    trail = Trail.from_values(given_)
    assert list(trail) == given_
    assert [trail[k] for k in range(-len(given_), len(given_))] == given_ + given_
    assert list(trail[1:4]) == given_[1:4]
    assert Trail.from_values(trail) is trail


@quick
@given(st.lists(st.tuples(values, values), max_size=12))
def test_differences_and_equality_are_those_of_the_values(
    pairs: list[tuple[Fraction, ...]],
) -> None:
    a, b = ([pair[k] for pair in pairs] for k in (0, 1))
    assert list(Trail.from_values(a) - Trail.from_values(b)) == [x - y for x, y in pairs]
    assert (Trail.from_values(a) == Trail.from_values(b)) == (a == b)
    again = Trail(
        [3 * n for n in Trail.from_values(a).numerators], 3 * Trail.from_values(a).denominator
    )
    assert again == Trail.from_values(a)
    assert hash(again) == hash(Trail.from_values(a))


@quick
@given(trails)
def test_the_envelope_is_the_greatest_size_so_far(given_: list[Fraction]) -> None:
    tops = list(accumulate(map(abs, given_), max))
    assert list(Trail.from_values(given_).envelope()) == tops
    assert not tops or Trail.from_values(given_).largest == tops[-1]


@quick
@given(trails, st.one_of(values, st.just(Fraction(0))))
def test_above_are_the_places_of_what_is_greater_and_not_of_what_is_equal(
    given_: list[Fraction], least: Fraction
) -> None:
    for bound in (least, *given_):
        expected = [k for k, x in enumerate(given_) if x > bound]
        assert Trail.from_values(given_).above(bound) == expected


def test_of_none_there_is_nothing() -> None:
    assert list(Trail.from_values([]).envelope()) == []
