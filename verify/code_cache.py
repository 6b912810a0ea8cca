"""Machine code of kernels, and what was read of a Hamiltonian, on disk for the processes to come.

Contract: `load(key)` gives the very bytes that `keep(key, code)` was given, by this user, or None.
What is loaded will be run. So the folder and each file in it must be this user's own and nobody
else's to write, and no link is followed to them; a digest of key and code stands in the file, so
that what is damaged, or was renamed, is nothing. Nothing here fails: a full disk, a home that is
read-only or a folder of somebody else's mean that code is compiled anew and not kept.

The folder is `areaproof/kernels` in XDG_CACHE_HOME, else in ~/.cache; `VERIFY_CACHE` names another
one in place of `areaproof`, or is `off`. Beyond 256 MB what was used the longest time ago goes.

Not promised: a system without owners of files (Windows) keeps nothing.
"""

import hashlib
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from verify.errors import InputError
from verify.files import write_atomically

VARIABLE, OFF = "VERIFY_CACHE", "off"
MOST_BYTES = 256 * 2**20
_OWNED = hasattr(os, "geteuid") and os.open in os.supports_dir_fd
_FOLDER, _SUFFIX = "kernels", ".kernel"
_ENTRY = re.compile(r"\.?[0-9a-f]{64}\.kernel")  # with a dot, one that is being written
_DIGEST = hashlib.sha256().digest_size


def key_of(*parts: str) -> str:
    """A name for these texts, in this order."""
    digest = hashlib.sha256()
    for part in parts:
        raw = part.encode(errors="surrogatepass")  # what is typed may be no Unicode
        digest.update(b"%d\n" % len(raw) + raw)
    return digest.hexdigest()


def folder() -> Path | None:
    """Where code is kept; None where nothing is.

    Raises InputError where VERIFY_CACHE is neither a folder's absolute path nor `off`.
    """
    given = os.environ.get(VARIABLE, "")
    if given == OFF or not _OWNED:
        return None
    if given:
        if not Path(given).is_absolute():
            raise InputError(VARIABLE, given, f"give a folder's absolute path, or {OFF}")
        if Path(given).exists() and not Path(given).is_dir():
            raise InputError(VARIABLE, given, f"is no folder; give one, or {OFF}")
        return Path(given, _FOLDER)
    general = os.environ.get("XDG_CACHE_HOME", "")
    try:
        # The convention has a relative one ignored.
        root = Path(general) if Path(general).is_absolute() else Path.home() / ".cache"
    except RuntimeError:  # this user has no home
        return None
    return root / "areaproof" / _FOLDER


def load(key: str) -> bytes | None:
    """The code that was kept under the key; None where there is none to be trusted."""
    with _opened(folder()) as directory:
        content = b"" if directory is None else _read(directory, key + _SUFFIX)
    code = content[_DIGEST:]
    return code if content[:_DIGEST] == _digest(key, code) else None


def _read(directory: int, name: str) -> bytes:
    """What is in the file; nothing where it is not this user's own, or cannot be read."""
    flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
    try:
        file = os.open(name, flags, dir_fd=directory)
    except OSError:
        return b""
    try:
        status = os.fstat(file)
        if not stat.S_ISREG(status.st_mode) or not _is_ours(status):
            return b""
        with suppress(OSError):
            os.utime(file)  # it is used, and others go first
        with open(file, "rb", closefd=False) as opened:
            return opened.read(MOST_BYTES)
    except OSError:
        return b""
    finally:
        os.close(file)


def keep(key: str, code: bytes) -> None:
    """Keeps the code under the key, in place of what was kept before, where that can be done."""
    path = folder()
    if path is None:
        return
    with suppress(OSError):
        for each in (path.parent, path):
            each.mkdir(mode=0o700, parents=True, exist_ok=True)
    with _opened(path) as directory:
        if directory is not None:
            with suppress(OSError, InputError):
                write_atomically(path / f"{key}{_SUFFIX}", _digest(key, code) + code)
            _drop_oldest(directory)


def _digest(key: str, code: bytes) -> bytes:
    return hashlib.sha256(f"areaproof kernel 1\n{key}\n".encode() + code).digest()


def _is_ours(status: os.stat_result) -> bool:
    """Whether it is this user's, and nobody else may write there."""
    return status.st_uid == os.geteuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


@contextmanager
def _opened(path: Path | None) -> Iterator[int | None]:
    """The folder, held while it is looked at; None where it is not to be trusted."""
    directory = None
    if path is not None:
        with suppress(OSError):
            flags = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
            directory = os.open(path, flags)
    try:
        yield directory if directory is not None and _is_ours(os.fstat(directory)) else None
    finally:
        if directory is not None:
            os.close(directory)


def _drop_oldest(directory: int) -> None:
    """Deletes what was used the longest time ago, until the rest is within the bound."""
    found = []
    with suppress(OSError), os.scandir(directory) as entries:
        for entry in entries:
            if _ENTRY.match(entry.name):
                with suppress(OSError):  # gone meanwhile, by another process
                    status = entry.stat(follow_symlinks=False)
                    found.append((status.st_mtime_ns, entry.name, status.st_size))
    size = sum(each for _, _, each in found)
    for _, name, each in sorted(found):
        if size <= MOST_BYTES:
            return
        with suppress(OSError):
            os.unlink(name, dir_fd=directory)
        size -= each
