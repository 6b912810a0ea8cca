"""What an export proves is of use where it should be: its theorem applied to Kepler's problem."""

from pathlib import Path

import pytest

from tests.helpers.rocq.assumptions import ASKED
from tests.helpers.rocq.coqc import accepted, beside, changed, in_module
from tests.helpers.rocq.exports import export
from tests.helpers.rocq.session import Session

pytestmark = pytest.mark.left_to_ci

USED = "stormer_verlet"
KEPLER = Path(__file__).with_name("kepler.v").read_text(encoding="utf-8")


def test_the_theorem_of_kicks_and_drifts_speaks_of_a_v_that_is_singular(
    theory: Path, tmp_path: Path
) -> None:
    """As a user has both: two files, each for `coqc`."""
    accepted(tmp_path / f"{USED}.v", ASKED.sub("", export(USED).text), beside(theory))
    accepted(tmp_path / "kepler.v", KEPLER, {**beside(theory), "": tmp_path})


def test_it_does_not_where_the_step_takes_a_slope_at_the_singularity(rocq: Session) -> None:
    used = in_module(USED, ASKED.sub("", export(USED).text))
    text = changed(KEPLER, f"Require Import {USED}.", f"{used}Import {USED}.\n")
    wrong = changed(text, "Theorem kepler : forall h x, 0 < x 1%nat ->",
                    "Theorem kepler : forall h x, 0 <= x 1%nat ->")  # fmt: skip
    assert rocq.stops_at(wrong) == "kepler"
