"""Claims that values have no pattern, which one order of the initial values refutes."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.constructed.runs import CLAIM, FLAT, Given, check, growing
from verify.claims.kinds.comparisons.no_pattern import NoPatternClaim
from verify.verdict import Verdict

ENCLOSED, REFUTED, UNDECIDED = Verdict.ENCLOSED, Verdict.REFUTED, Verdict.UNDECIDED
NONE = NoPatternClaim(**CLAIM, kind="no_pattern")


def turned(h: Fraction, k: int) -> dict[str, Given]:
    """As `growing`, but that the first two initial values change places at the last step size."""
    return growing(h, 1 - k if h == Fraction(1, 100) and k < 2 else k)


def test_one_order_at_every_step_size_is_a_pattern() -> None:
    found = check(NONE, growing)
    assert found.verdict is REFUTED
    assert "at all 6 step sizes the initial values stand in one order by |Λ|: (q₀ = 0.1" in (
        found.evidence
    )


@pytest.mark.parametrize(
    ("starts", "said"),
    [
        ([("0.1", "0"), ("0.5", "0"), ("1", "0")], True),
        ([("0.5", "0"), ("0.1", "0"), ("1", "0")], False),
    ],
)
def test_that_it_is_the_order_of_h_is_said_where_it_is(starts: Any, said: bool) -> None:
    assert (
        "which is also their order by H" in check(NONE, growing, starts=starts).evidence
    ) is said


def test_two_orders_at_two_step_sizes_are_none() -> None:
    found = check(NONE, turned)
    assert found.verdict in (Verdict.MEASURED, ENCLOSED)
    assert (
        "in the order 1, 2, 3 with h = 0.008 and in the order 2, 1, 3 with h = 0.01"
        in found.evidence
    )


def test_a_claim_of_one_order_has_the_contrary_verdicts() -> None:
    one = NoPatternClaim(**CLAIM, kind="no_pattern", same_order=True)
    for values, verdicts in ((growing, (Verdict.MEASURED, ENCLOSED)), (turned, (REFUTED,))):
        found = check(one, values)
        assert found.verdict in verdicts
        assert found.verdict.holds is not check(NONE, values).verdict.holds
    assert check(one, growing, starts=[("0.1", "0")]).verdict is UNDECIDED


def test_values_that_are_not_told_apart_have_no_known_order() -> None:
    def flat(h: Fraction, k: int) -> dict[str, Given]:
        return FLAT

    def wide(h: Fraction, k: int) -> dict[str, Given]:
        return {**growing(h, k), "lambda": (growing(h, k)["lambda"], h**3)}

    assert check(NONE, flat).verdict is UNDECIDED
    assert check(NONE, wide).verdict is UNDECIDED


def test_one_initial_value_shows_no_pattern() -> None:
    assert check(NONE, growing, starts=[("0.1", "0")]).verdict is UNDECIDED


def test_an_unknown_order_between_two_that_differ_hides_neither() -> None:
    def between(h: Fraction, k: int) -> dict[str, Given]:
        values = turned(h, k)
        return {**values, "lambda": (values["lambda"], 1)} if h == Fraction(8, 1000) else values

    assert check(NONE, between).verdict in (Verdict.MEASURED, ENCLOSED)
