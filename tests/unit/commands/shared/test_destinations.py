"""What the commands are given, checked at the edge."""

from pathlib import Path

import pytest

from tests.paths import ROOT
from verify.commands.shared.destinations import ensure_keepable
from verify.errors import InputError


@pytest.mark.parametrize("folder", ["reports/mine", "reference/../reference/kept", "verify/kept"])
def test_nothing_is_kept_in_what_the_names_of_results_are_made_of(folder: str) -> None:
    with pytest.raises(InputError, match=r"--keep=.* lies in what verify ships"):
        ensure_keepable(ROOT / folder)
    assert not (ROOT / folder).exists()


def test_elsewhere_a_folder_is_made_for_it_in_one_that_is_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"there is no folder .*reports; make it first"):
        ensure_keepable(tmp_path / "reports" / "kept")
    (tmp_path / "reports").mkdir()
    ensure_keepable(tmp_path / "reports" / "kept")
    assert (tmp_path / "reports" / "kept").is_dir()
