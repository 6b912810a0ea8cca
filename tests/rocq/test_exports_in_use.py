"""What an export proves is of use where it should be: its theorem applied to Kepler's problem."""

from pathlib import Path

import pytest

from tests.helpers.rocq import accepted, beside, changed, stops_at

pytestmark = pytest.mark.left_to_ci

KEPLER = Path(__file__).with_name("kepler.v").read_text(encoding="utf-8")


def test_the_theorem_of_kicks_and_drifts_speaks_of_a_v_that_is_singular(
    theory: Path, exports: Path, tmp_path: Path
) -> None:
    accepted(tmp_path / "kepler.v", KEPLER, {**beside(theory), "": exports})


def test_it_does_not_where_the_step_takes_a_slope_at_the_singularity(
    theory: Path, exports: Path, tmp_path: Path
) -> None:
    text = changed(KEPLER, "Theorem kepler : forall h x, 0 < x 1%nat ->",
                   "Theorem kepler : forall h x, 0 <= x 1%nat ->")  # fmt: skip
    folders = {**beside(theory), "": exports}
    assert stops_at(tmp_path / "kepler.v", text, folders) == "kepler"
