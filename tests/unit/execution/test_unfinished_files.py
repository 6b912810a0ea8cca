"""A process that is ended while it writes leaves nothing half written."""

import os
import time
from pathlib import Path

import pytest

from verify.execution.execute import Store
from verify.execution.executors import Placement, open_place
from verify.files import clear_unfinished, write_atomically


def write_slowly(path: Path) -> None:
    """It is written, but never on the disk."""
    os.fsync = lambda _: time.sleep(60)  # type: ignore[assignment]
    write_atomically(path, "half")


def test_what_an_ended_process_was_writing_is_cleared(tmp_path: Path) -> None:
    def begun() -> list[str]:
        return [path.name for path in tmp_path.iterdir()]

    def interrupted() -> None:
        with open_place(Placement(workers=2), (), Store(tmp_path).tidy) as place:
            place.submit(write_slowly, tmp_path / "result.json")
            until = time.monotonic() + 60
            while not begun():
                assert time.monotonic() < until
                time.sleep(0.01)
            assert begun()[0].startswith(".result.json.")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert begun() == []


def test_what_others_are_writing_is_left(tmp_path: Path) -> None:
    """The control: another process's, whose number begins with that of one that is ended."""
    other, ours = tmp_path / ".a.json.of-123.x7", tmp_path / ".a.json.of-12.x7"
    for path in (other, ours, tmp_path / "a.json"):
        path.write_text("{}")
    clear_unfinished(tmp_path, [12])
    assert {path.name for path in tmp_path.iterdir()} == {other.name, "a.json"}
