"""Initial values and step sizes that are drawn are exact, and as far apart as was asked for."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.sampled.drawing import fuzzed
from verify import strategies as s


def test_initial_values_are_exact_and_within_reach() -> None:
    drawn = fuzzed(s.initial_values(most="3/2"), 200)
    numbers = [x for value in drawn for x in (value.q, value.p)]
    assert all(type(x) is Fraction and abs(x) <= Fraction(3, 2) for x in numbers)
    assert any(x < 0 for x in numbers)
    assert any(x.denominator == 3 for x in numbers), "one that no float holds"
    assert all(abs(x.q) <= Fraction(1, 10**9) for x in fuzzed(s.initial_values(most="1e-9"), 20))


def test_extreme_initial_values_are_so() -> None:
    numbers = [x for value in fuzzed(s.initial_values(extreme=True), 400)
               for x in (value.q, value.p)]  # fmt: skip
    for sign in (1, -1):
        assert any(0 < sign * x < Fraction(1, 10**100) for x in numbers)
        assert any(sign * x > 10**100 for x in numbers)
        near = (x for x in numbers if 0 < sign * (x - round(x)) < Fraction(1, 10**20))
        assert any(round(x) for x in near)
    assert 0 in numbers
    assert any(0 < abs(x - round(x)) < Fraction(1, 10**50) and round(x) for x in numbers)
    assert any(x.denominator > 10**30 and abs(x) <= 2 for x in numbers)


@pytest.mark.parametrize(
    ("least", "most"),
    [("1/1000", "1/10"), ("1e-300", "1e300"), ("0.02", "0.05"), ("1/7", "1/7"), (2, 3)],
)
def test_step_sizes_keep_to_their_ends(least: Any, most: Any) -> None:
    drawn = fuzzed(s.step_sizes(least=least, most=most), 200)
    assert len(drawn) == 200
    assert all(type(h) is Fraction and Fraction(least) <= h <= Fraction(most) for h in drawn)


def test_step_sizes_have_several_forms() -> None:
    denominators = {h.denominator for h in fuzzed(s.step_sizes(), 200)}
    assert 100 in denominators
    assert 128 in denominators
    assert any(d % 3 == 0 for d in denominators)
