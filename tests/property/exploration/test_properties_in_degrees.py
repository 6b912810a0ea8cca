"""A sample of `tests.campaigns.drawn_in_degrees`: scenes of a fixed seed, every property."""

import pytest

from tests.campaigns.drawn_in_degrees import KINDS, looked

COUNT, SEED = 5, 20


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("degrees", "timed"), KINDS)
def test_no_property_fails_of_drawn_scenes(
    degrees: int, timed: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    failed = looked(degrees, timed, COUNT, SEED)
    said = capsys.readouterr().out
    assert not failed, said
    assert f"{COUNT} scenes of {degrees} degrees of freedom" in said
    assert "results-read-back: of 5" in said
