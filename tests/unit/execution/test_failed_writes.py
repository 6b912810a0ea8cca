"""A write that fails leaves the old content, and nothing else."""

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from verify.files import write_atomically


class FullDisk:
    """An open file on which every write fails."""

    def __init__(self, handle: int, *_: Any, **__: Any) -> None:
        self.handle = handle

    def __enter__(self) -> "FullDisk":
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self.handle)

    def write(self, _: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")


def fail(error: BaseException) -> Callable[..., None]:
    def failing(*_: Any, **__: Any) -> None:
        raise error

    return failing


def made_and_interrupted(*arguments: Any, open_it: Callable[..., int] = os.open) -> int:
    """The file is there, and nobody has heard of it."""
    os.close(open_it(*arguments))
    raise KeyboardInterrupt


FAILURES: dict[str, tuple[str, Any]] = {
    "disk-full-at-write": ("fdopen", FullDisk),
    "disk-full-at-sync": ("fsync", fail(OSError(errno.ENOSPC, "No space left on device"))),
    "replace-fails": ("replace", fail(OSError(errno.EACCES, "Permission denied"))),
    "interrupted-as-it-is-made": ("open", made_and_interrupted),
    "interrupted-at-sync": ("fsync", fail(KeyboardInterrupt())),
    "interrupted-at-replace": ("replace", fail(KeyboardInterrupt())),
}


@pytest.mark.parametrize(("function", "failure"), FAILURES.values(), ids=FAILURES)
@pytest.mark.parametrize("old", ["the old content", None], ids=["over-a-file", "a-new-file"])
def test_a_failed_write_leaves_the_old_content_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, old: str | None, function: str, failure: Any
) -> None:
    path = tmp_path / "results.json"
    if old is not None:
        write_atomically(path, old)
    with monkeypatch.context() as patch:
        patch.setattr(os, function, failure)
        with pytest.raises((OSError, KeyboardInterrupt)):
            write_atomically(path, "the new content")
    assert [f.name for f in tmp_path.iterdir()] == ([path.name] if old is not None else [])
    assert old is None or path.read_text() == old
    write_atomically(path, "δ the new content")
    assert path.read_text(encoding="utf-8") == "δ the new content"
