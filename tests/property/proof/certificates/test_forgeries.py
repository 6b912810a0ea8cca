"""Certificates of drawn proofs are accepted; what is made of them, only where it is true."""

from collections.abc import Iterator
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.campaigns.certificates import SLOWEST, campaign
from tests.examples import drawn
from tests.helpers.sampled.certificates import Data, certificates, true
from verify.proof.certificates.checker import check


def accepted(data: Data) -> bool:
    try:
        check(data)
    except ValueError:
        return False
    return True


@drawn(9)
@given(certificates)
def test_a_certificate_is_accepted_and_says_the_truth(data: Data) -> None:
    assert true(data)


@pytest.mark.left_to_ci
def test_of_a_sample_of_the_campaigns_mutants_none_is_accepted_that_is_false() -> None:
    answers, slowest, wrong = campaign(60, seed=20)
    assert not wrong
    assert slowest < SLOWEST
    assert answers["true"] >= 3
    assert answers["refused"] >= 30


@drawn(12)
@given(certificates, st.data())
def test_a_cofactor_or_a_number_that_is_needed_cannot_be_another(
    data: Data, drawn: st.DataObject
) -> None:
    """Of the leading coefficient, the flow's part of the map, the potential, a cofactor."""
    if "leading" not in data:
        return
    needed = [data["leading"], *data["p_next"][:2], *data["q_next"][:2], data.get("potential")]
    needed += [x for each in data.get("cofactors", {}).values() for x in each.values()]
    terms = [t for x in needed if x for t in x]
    term = drawn.draw(st.sampled_from(terms))
    term[0] = str(Fraction(term[0]) * drawn.draw(st.sampled_from([2, -1, Fraction(1, 3)])))
    assert not accepted(data)


rows = st.lists(
    st.tuples(*[st.sampled_from(["0", "1", "1/2", "-1", "2"])] * 4).map(list),
    min_size=1,
    max_size=2,
)


@drawn(80)
@given(rows, st.booleans())
def test_stages_are_accepted_exactly_where_their_determinants_are_one_polynomial(
    stages: list[list[str]], separable: bool
) -> None:
    data = {"hamiltonian": "every", "separable": separable, "stages": stages}
    kept = [all(preserved(*map(Fraction, row), separable)) for row in stages]
    assert accepted(data) == all(kept)
    assert not accepted(data) or true(data)


def preserved(
    k: Fraction, d: Fraction, s: Fraction, t: Fraction, separable: bool
) -> Iterator[bool]:
    """Whether det A = det B of a stage, for some H_pp, H_pq, H_qq and h."""
    h = Fraction(1, 7)
    for a, b, c in ((2, 3, 5), (-3, 7, 2), (1, -4, 9)):
        b *= not separable
        one, two = (
            (1 + h * k * b * x) * (1 - h * d * b * y) + h * h * k * d * a * c * x * y
            for x, y in ((s, t), (s - 1, t - 1))
        )
        yield one == two
