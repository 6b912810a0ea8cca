"""Identities of every sort, as people print them, and twins that are false."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.campaigns.identities import decided
from tests.examples import drawn
from tests.helpers.sampled.identities.drawn import SORTS, identities


@pytest.mark.parametrize("sort", SORTS)
@drawn(15)
@given(st.integers(0, 10**6))
def test_an_identity_is_decided_and_its_twin_refuted(sort: str, seed: int) -> None:
    (identity,) = identities(sort, 1, seed)
    assert decided(identity.false) is False, identity.false
    assert decided(identity.true) is not False, identity.true


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize("sort", SORTS)
def test_of_a_sample_no_more_than_one_is_left_undecided(sort: str) -> None:
    drawn_ones = identities(sort, 25, 1)
    assert sum(decided(identity.true) is not True for identity in drawn_ones) <= 1
