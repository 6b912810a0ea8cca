"""Schemes at equal run time: made lines whose ratio is known."""

from decimal import Decimal
from typing import Any

import pytest

from tests.helpers.constructed.work import line, point
from verify.scenes.results.work_precision import ComparisonResult, WorkLine
from verify.studies.work_precision.work_lines import compare_all
from verify.studies.work_precision.work_lines import compare_lines as compare_within

ALL = "1e40"  # an orbit so large that no error is left out


def compare(one: WorkLine, other: WorkLine, scale: str = ALL) -> ComparisonResult:
    return compare_within(one, other, scale)


def power(
    name: str, factor: float, order: float = -2, first: float = 1e-5, **more: Any
) -> WorkLine:
    """Errors factor · seconds^order at three run times."""
    seconds = [first, 10 * first, 100 * first]
    return line(
        *(point(error=repr(factor * s**order), lam=repr(5 * factor * s**order), seconds=s,
                step_size=repr(1e-6 / s)) for s in seconds), name=name, **more,
    )  # fmt: skip


def test_the_ratio_of_parallel_lines_is_the_same_everywhere() -> None:
    found = compare(power("one", 1), power("other", 3.2))
    assert found.error is not None
    assert found.area is not None
    for ratio in (found.error, found.area):
        assert [ratio.at, ratio.least, ratio.most] == ["3.2", "3.2", "3.2"]
    assert found.sentence == (
        "At equal run time (0.0001 s) the solution error of one is 3.2 times smaller than that of "
        "other (3.2 to 3.2 times over 1e-05 to 0.001 s). In area, |Λ| of one is 3.2 times smaller "
        "than that of other (3.2 to 3.2 times)."
    )


def test_the_order_in_which_two_are_named_changes_no_sentence() -> None:
    one, other = power("one", 1), power("other", 3.2)
    assert compare(one, other).sentence == compare(other, one).sentence
    back = compare(other, one).error
    assert back is not None
    assert Decimal(back.at) == Decimal("0.31")


def test_between_points_a_scheme_is_followed_on_the_logarithmic_line() -> None:
    found = compare(power("one", 1), power("other", 4, first=2e-5))
    assert found.error is not None
    assert (found.error.at, found.error.least, found.error.most) == ("4", "4", "4")
    assert (found.first, found.last) == ("2e-05", "0.001")


def test_where_the_lines_cross_the_sentence_says_so() -> None:
    found = compare(power("one", 1, order=-1), power("other", 0.5, order=-1.1))
    assert found.error is not None
    assert float(found.error.least) < float(found.error.most)
    found = compare(power("one", 1, order=-2), power("other", 1e4, order=-1))
    assert "but which of the two is smaller changes" in found.sentence


def test_lines_without_a_common_run_time_are_not_compared() -> None:
    found = compare(power("one", 1), power("other", 1, first=1))
    assert found.error is found.area is found.seconds is None
    assert "no run time in common" in found.sentence


def test_failed_points_take_no_part() -> None:
    gone = point(error=None, seconds=None, limited_by="failed")
    with_it = power("one", 1).model_copy(update={"points": (gone, *power("one", 1).points)})
    assert compare(with_it, power("other", 3)) == compare(power("one", 1), power("other", 3))
    lost = line(gone, name="lost")
    assert compare(lost, power("other", 3)).error is None


def test_area_that_is_preserved_by_proof_is_no_ratio() -> None:
    kept = line(
        *(point(error=repr(s**-2), lam="0", lam_plain="2e-15", seconds=s,
                step_size=repr(1e-6 / s), lambda_limited_by="rounding") for s in (1e-5, 1e-3)),
        name="kept", area_preserving=True,
    )  # fmt: skip
    found = compare(power("one", 1), kept)
    assert found.area is None
    assert "In area kept makes no error (ΔJ ≡ 0 is proved), where one has |Λ| of" in found.sentence
    assert "rounding shows of it is 2e-15" in found.sentence
    both = compare(kept, kept.model_copy(update={"name": "too"}))
    assert "Both preserve area exactly" in both.sentence


@pytest.mark.parametrize(("orders", "count"), [((2, 2, 2), 3), ((1, 2, 2), 1), ((1, 2, 3), 0)])
def test_schemes_of_one_order_are_compared_and_peers_never(
    orders: tuple[int, ...], count: int
) -> None:
    lines = [power(f"s{k}", k + 1, order=-2, claimed=n) for k, n in enumerate(orders)]
    peer = power("peer", 1, claimed=None, peer=True)
    found = compare_all([*lines, peer, peer], ALL)
    assert len(found) == count
    assert "peer" not in {name for each in found for name in (each.one, each.other)}


def test_runs_whose_error_is_larger_than_the_orbit_take_no_part() -> None:
    one, other = power("one", 1), power("other", 3.2)
    assert compare(one, other, "1e9").first == "0.0001"
    assert compare(one, other).first == "1e-05"
    assert compare(one, other, "1e-9").error is None


def test_two_that_are_alike_are_not_ranked() -> None:
    assert (
        "error of one is that of other (both within 10% of each other"
        in compare(power("one", 1), power("other", 1.02)).sentence
    )
