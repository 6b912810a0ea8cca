"""A reader's folder leaves nothing behind, and takes nothing away that is not its own."""

import sys
from pathlib import Path
from types import ModuleType

import pytest

from tests.helpers.pages import session


def module_at(path: Path) -> ModuleType:
    found = ModuleType("made_up_for_this_test")
    found.__file__ = str(path)
    return found


@pytest.mark.parametrize(
    ("place", "kept"),
    [("reader/mine.py", False), ("venv/lib/click.py", True), ("base/lib/os.py", True),
     ("venvs/other.py", False), ("checkout/tests/mine.py", True)],
)  # fmt: skip
def test_modules_of_the_environment_and_of_the_checkout_are_spared(
    place: str, kept: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where they lie in the folder for temporary files, as the reader's folder does."""
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "venv"))
    monkeypatch.setattr(sys, "base_prefix", str(tmp_path / "base"))
    monkeypatch.setattr(session, "ROOT", tmp_path / "checkout")
    monkeypatch.setitem(sys.modules, "made_up_for_this_test", module_at(tmp_path / place))
    session._forget(tmp_path)
    assert ("made_up_for_this_test" in sys.modules) is kept
