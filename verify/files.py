"""Files as they are read and written: whole ones, regular ones, and never a part of one.

What is read may be anybody's: a device, a pipe and a file beyond a limit are refused before they
are read. What is written replaces a regular file or nothing.
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
MOST_TEXT = 4 * 2**20  # of what people write by hand
_HERE = f"@{platform.node()}"  # of several machines that share a folder
_MOST_NAMES = 1000  # of a folder, among which one is looked for that may be meant


@contextmanager
def opened(path: Path) -> Iterator[BinaryIO]:
    """A regular file, to be read while this is open.

    Raises InputError, which names it, for what is not there, is no regular file or cannot be read.
    """
    if "\0" in str(path):
        raise InputError("file", str(path), "is no name of a file: it holds a null character")
    try:
        # A pipe that nobody writes to would be waited for.
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        with os.fdopen(handle, "rb") as file:
            if not stat.S_ISREG(os.fstat(handle).st_mode):
                raise InputError("file", str(path), "is no regular file")
            yield file
    except OSError as error:
        problem = error.strerror or "cannot be read"
        raise InputError("file", str(path), problem + _instead(path, error)) from None


def _instead(path: Path, error: OSError) -> str:
    """What to give for a file that cannot be opened, where that can be told."""
    if isinstance(error, IsADirectoryError):
        return "; give a file"
    if not isinstance(error, FileNotFoundError):
        return ""
    if "://" in str(path) or str(path).startswith(("http:/", "https:/")):
        return "; an address is not fetched: save it as a file"
    if "\\" in str(path) and os.sep == "/":
        return "; write / for \\ in a path"
    from difflib import get_close_matches

    here: dict[str, Path] = {}
    with suppress(OSError):
        # Of two with one stem the last is taken: that of the same kind.
        some = islice(path.parent.iterdir(), _MOST_NAMES)
        there = sorted(some, key=lambda each: (each.suffix == path.suffix, each))
        here = {each.stem.lower(): each for each in there}
    near = get_close_matches(path.stem.strip().lower(), here, n=1, cutoff=0.7)
    return f"; is {here[near[0]]} meant?" if near else "; give a file that is there"


def read_bytes(path: Path, most: int | None = MOST_BYTES) -> bytes:
    """A regular file's content; `most`: how many bytes are allowed. InputError as `opened`."""
    with opened(path) as file:
        size = os.fstat(file.fileno()).st_size
        if most is not None and size > most:
            raise InputError("file", str(path), f"has {size} bytes; allowed: {most}")
        return file.read() if most is None else file.read(most)


def read_text(path: Path, most: int | None = MOST_TEXT) -> str:
    """As `read_bytes`, in UTF-8. Raises InputError where it is not."""
    return text_of(read_bytes(path, most), str(path))


def text_of(content: bytes, name: str) -> str:
    """The content as text. Raises InputError where it is not UTF-8."""
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        raise InputError(
            "file", name, f"is not UTF-8 text, at byte {error.start}; save it as UTF-8"
        ) from None


def check_replaceable(path: Path, name: str = "file") -> None:
    """InputError where something stands there that is not ours to replace, which stays as it is."""
    try:
        mode = path.lstat().st_mode
    except OSError:
        return
    what = "is a folder" if stat.S_ISDIR(mode) else "is no regular file, and is left as it is"
    if not stat.S_ISREG(mode):
        raise InputError(name, str(path), "is a link" if stat.S_ISLNK(mode) else what)
    if not mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
        raise InputError(name, str(path), "is read-only")


def _by(process: int) -> str:
    """What stands in the name of a file that the process is writing."""
    return f".of-{process}."


def clear_unfinished(folder: Path, processes: Iterable[int]) -> None:
    """Removes what these processes, which are no more, were writing there as they were ended."""
    for process in processes:
        for path in folder.glob(f".*{_by(process)}*"):
            with suppress(OSError):
                path.unlink()


def clear_abandoned(folder: Path) -> None:
    """Removes what processes of this machine that were killed had begun to write there."""
    here = re.compile(rf"\..+\.of-(\d+)\.[0-9a-f]+{re.escape(_HERE)}")
    for path in folder.glob(".*"):
        begun = here.fullmatch(path.name)
        if begun and not _is_there(int(begun[1])):
            with suppress(OSError):
                path.unlink()


def _is_there(process: int) -> bool:
    try:
        if os.name == "posix":  # elsewhere there is no signal that does nothing
            os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:  # it is somebody else's
        pass
    return True


def write_atomically(path: Path, content: str | bytes) -> None:
    """The whole content or the old one, never a part: written beside it, then renamed.

    Raises InputError where a link, a device, a pipe or a read-only file stands there, and OSError,
    which names the file, where it cannot be written.
    """
    check_replaceable(path)
    raw = content.encode() if isinstance(content, str) else content
    path.parent.mkdir(parents=True, exist_ok=True)
    name = f".{path.name[:100]}{_by(os.getpid())}{os.urandom(8).hex()}{_HERE}"
    temporary = path.with_name(name)  # known before it is made: an interruption may come at once
    try:
        handle = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(handle, "wb") as file:
            file.write(raw)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        if isinstance(error, OSError):  # a full disk names no file
            error.filename = str(path)
        raise
