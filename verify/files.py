"""Reading and writing of whole regular files.

A file to be read may be anybody's: a device, a pipe and a file larger than a limit are refused
before they are read. A written file replaces a regular file or nothing, and never in part.
"""

import os
import platform
import re
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from itertools import islice
from pathlib import Path
from typing import BinaryIO

from verify.errors import InputError

MOST_BYTES = 64 * 2**20
MOST_TEXT = 4 * 2**20  # bytes, the limit for files that people write by hand
_MACHINE_MARK = f"@{platform.node()}"  # ends the name of a temporary file: folders may be shared
_MAX_CANDIDATES = 1000  # the limit on names in a folder among which a similar one is sought


@contextmanager
def open_regular_file(path: Path) -> Iterator[BinaryIO]:
    """Open a regular file for reading, as a context manager.

    Raises InputError, which names the path, if it leads to no regular file, or to an unreadable
    one.
    """
    if "\0" in str(path):
        raise InputError("file", str(path), "is no name of a file: it holds a null character")
    try:
        # Without O_NONBLOCK the opening of a pipe would wait for a writer.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        with os.fdopen(handle, "rb") as file:
            if not stat.S_ISREG(os.fstat(handle).st_mode):
                raise InputError("file", str(path), "is no regular file")
            yield file
    except OSError as error:
        problem = error.strerror or "cannot be read"
        raise InputError("file", str(path), problem + _suggest_instead(path, error)) from None


def _suggest_instead(path: Path, error: OSError) -> str:
    """Return advice for a file that cannot be opened; empty if there is none."""
    if isinstance(error, IsADirectoryError):
        return "; give a file"
    if not isinstance(error, FileNotFoundError):
        return ""
    if "://" in str(path) or str(path).startswith(("http:/", "https:/")):
        return "; an address is not fetched: save it as a file"
    if "\\" in str(path) and os.sep == "/":
        return "; write / for \\ in a path"
    from difflib import get_close_matches

    by_stem: dict[str, Path] = {}
    with suppress(OSError):
        # If several files have one stem, the last one stays; that with the right suffix sorts last.
        entries = islice(path.parent.iterdir(), _MAX_CANDIDATES)
        candidates = sorted(entries, key=lambda file: (file.suffix == path.suffix, file))
        by_stem = {file.stem.lower(): file for file in candidates}
    nearest = get_close_matches(path.stem.strip().lower(), by_stem, n=1, cutoff=0.7)
    return f"; is {by_stem[nearest[0]]} meant?" if nearest else "; give a file that is there"


def read_bytes(path: Path, most: int | None = MOST_BYTES) -> bytes:
    """Return a regular file's content, of at most `most` bytes; errors as `open_regular_file`."""
    with open_regular_file(path) as file:
        size = os.fstat(file.fileno()).st_size
        if most is not None and size > most:
            raise InputError("file", str(path), f"has {size} bytes; allowed: {most}")
        # The limit holds even if the file has grown since its size was read.
        return file.read() if most is None else file.read(most)


def read_text(path: Path, most: int | None = MOST_TEXT) -> str:
    """Return the text of a regular file in UTF-8; errors as `read_bytes` and `text_of`."""
    return text_of(read_bytes(path, most), str(path))


def text_of(content: bytes, name: str) -> str:
    """Decode the content as text. Raises InputError if it is not UTF-8."""
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        raise InputError(
            "file", name, f"is not UTF-8 text, at byte {error.start}; save it as UTF-8"
        ) from None


def check_replaceable(path: Path, name: str = "file") -> None:
    """Raise InputError if the path is a folder, a link, a device or read-only."""
    try:
        mode = path.lstat().st_mode
    except OSError:
        return
    problem = "is a folder" if stat.S_ISDIR(mode) else "is no regular file, and is left as it is"
    if not stat.S_ISREG(mode):
        raise InputError(name, str(path), "is a link" if stat.S_ISLNK(mode) else problem)
    if not mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
        raise InputError(name, str(path), "is read-only")


def _process_mark(process: int) -> str:
    """Return the part of a temporary file's name that identifies the process writing it."""
    return f".of-{process}."


def clear_unfinished(folder: Path, processes: Iterable[int]) -> None:
    """Remove the temporary files of these processes, which have ended, from the folder."""
    for process in processes:
        for path in folder.glob(f".*{_process_mark(process)}*"):
            with suppress(OSError):
                path.unlink()


def clear_abandoned(folder: Path) -> None:
    """Remove the temporary files of ended processes of this machine from the folder."""
    pattern = re.compile(rf"\..+\.of-(\d+)\.[0-9a-f]+{re.escape(_MACHINE_MARK)}")
    # Only files of this machine: it cannot be known whether a process of another machine is alive.
    for path in folder.glob(".*"):
        match = pattern.fullmatch(path.name)
        if match and not _is_running(int(match[1])):
            with suppress(OSError):
                path.unlink()


def _is_running(process: int) -> bool:
    try:
        if os.name == "posix":  # other systems have no signal that does nothing
            # Signal 0 is not sent; the call only fails if the process does not exist.
            os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:  # the process runs, as another user
        pass
    return True


def write_atomically(path: Path, content: str | bytes) -> None:
    """Write the file whole or not at all: write a temporary one beside it, and rename that.

    Raises InputError if the path is a folder, a link, a device, a pipe or a read-only file, and
    OSError, which names the file, if it cannot be written.
    """
    check_replaceable(path)
    raw = content.encode() if isinstance(content, str) else content
    path.parent.mkdir(parents=True, exist_ok=True)
    # The name is hidden from listings of results, and tells `clear_abandoned` the process and the
    # machine.
    name = f".{path.name[:100]}{_process_mark(os.getpid())}{os.urandom(8).hex()}{_MACHINE_MARK}"
    temporary = path.with_name(name)  # set before the file exists, for the removal below
    try:
        # O_EXCL refuses an existing file or link. Others may read the file only when it is whole,
        # so it begins with the mode 0o600.
        handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(handle, "wb") as file:
            file.write(raw)
            file.flush()
            os.fsync(file.fileno())  # otherwise a crash after the renaming may leave an empty file
        temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        if isinstance(error, OSError):  # the error of a full disk names no file
            error.filename = str(path)
        raise
