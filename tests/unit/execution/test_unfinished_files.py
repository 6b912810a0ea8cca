"""A process that is ended while it writes leaves nothing half written."""

import multiprocessing
import os
import platform
import time
from pathlib import Path

import pytest

from verify.commands.shared.destinations import ensure_keepable
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


def killed_while_it_writes(path: Path) -> None:
    """A process that is killed there, as by kill -9, whose parent knows nothing of it."""
    process = multiprocessing.get_context("fork").Process(target=write_slowly, args=(path,))
    process.start()
    until = time.monotonic() + 60
    while not list(path.parent.glob(f".{path.name}.*")):
        assert time.monotonic() < until
        time.sleep(0.01)
    process.kill()
    process.join()


def test_what_a_killed_process_was_writing_is_cleared_by_the_next_command(tmp_path: Path) -> None:
    killed_while_it_writes(tmp_path / "result.json")
    assert [path.name[:13] for path in tmp_path.iterdir()] == [".result.json."]
    ensure_keepable(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_a_process_is_writing_and_what_is_no_such_file_is_left(tmp_path: Path) -> None:
    """The control, to which a process of another machine belongs, whatever its number."""
    killed_while_it_writes(tmp_path / "result.json")
    (left,) = tmp_path.iterdir()
    gone = left.name.split(".of-")[1].split(".")[0]
    names = [
        left.name.replace(f".of-{gone}.", f".of-{os.getppid()}."),
        left.name.replace(f"@{platform.node()}", "@elsewhere"),
        left.name[1:],
        f".my.of-{gone}.txt",
    ]
    for name in names:
        (tmp_path / name).write_text("{}")
    ensure_keepable(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == set(names)
