"""What is said of an interruption, whenever it comes."""

from pathlib import Path
from typing import Any

import pytest

from verify.commands.shared import execution_options


def test_an_interruption_as_the_folder_is_made_says_what_is_kept(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Somebody who sees the folder may interrupt what has not begun."""
    folder = tmp_path / "kept"

    def made_and_interrupted(path: Path, *_: Any) -> None:
        path.mkdir()
        raise KeyboardInterrupt

    monkeypatch.setattr(execution_options, "ensure_keepable", made_and_interrupted)
    with pytest.raises(KeyboardInterrupt), execution_options.kept_tasks({}, folder):
        pytest.fail("it has begun")
    said = f"interrupted: 0 of 0 tasks are kept in {folder}; the same command goes on from there\n"
    assert capsys.readouterr() == ("", said)
