"""A cache on disk, for later processes: machine code of kernels, and parsed Hamiltonians.

Contract: `load(key)` returns the very bytes that this user passed to `keep(key, code)`, or None.
Loaded code is run. So the folder and each file in it must belong to this user, nobody else may have
the right to write to them, and neither may be a link. Each file has a digest of its key and code,
so that a damaged or renamed file counts as none. Apart from a wrong VERIFY_CACHE, which is an
InputError, nothing here fails: if the disk is full, the home is read-only or the folder belongs to
somebody else, code is compiled anew and not kept.

The folder is `areaproof/kernels` in XDG_CACHE_HOME, or else in ~/.cache; `VERIFY_CACHE` names
another folder in place of `areaproof`, or is `off`. If the files have more than 256 MB, those that
were not used for the longest time are deleted.

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
# The limit of the whole folder, and of a single file that is read.
MOST_BYTES = 256 * 2**20
_HAS_OWNERS = hasattr(os, "geteuid") and os.open in os.supports_dir_fd
_FOLDER, _SUFFIX = "kernels", ".kernel"
# The name of an entry; a dot begins the names of files that are still being written.
_ENTRY_NAME = re.compile(r"\.?[0-9a-f]{64}\.kernel")
_DIGEST_SIZE = hashlib.sha256().digest_size  # bytes, at the beginning of each entry


def key_of(*parts: str) -> str:
    """Return a digest of these texts in this order, to name an entry."""
    digest = hashlib.sha256()
    for part in parts:
        raw = part.encode(errors="surrogatepass")  # a typed text may be no valid Unicode
        digest.update(b"%d\n" % len(raw) + raw)
    return digest.hexdigest()


def folder() -> Path | None:
    """Return the folder where code is kept; None if none is to be kept.

    Raises InputError if VERIFY_CACHE is neither a folder's absolute path nor `off`.
    """
    setting = os.environ.get(VARIABLE, "")
    # If files have no owners, nobody can tell whose code a file holds.
    if setting == OFF or not _HAS_OWNERS:
        return None
    if setting:
        if not Path(setting).is_absolute():
            raise InputError(VARIABLE, setting, f"give a folder's absolute path, or {OFF}")
        if Path(setting).exists() and not Path(setting).is_dir():
            raise InputError(VARIABLE, setting, f"is no folder; give one, or {OFF}")
        return Path(setting, _FOLDER)
    cache_home = os.environ.get("XDG_CACHE_HOME", "")
    try:
        # The convention says that a relative path is ignored.
        root = Path(cache_home) if Path(cache_home).is_absolute() else Path.home() / ".cache"
    except RuntimeError:  # this user has no home
        return None
    return root / "areaproof" / _FOLDER


def load(key: str) -> bytes | None:
    """Return the code that was kept under the key; None if no trustworthy file has it."""
    with _open_folder(folder()) as directory:
        content = b"" if directory is None else _read_entry(directory, key + _SUFFIX)
    code = content[_DIGEST_SIZE:]
    # The key is part of the digest, so that a file renamed to another key does not match.
    return code if content[:_DIGEST_SIZE] == _digest(key, code) else None


def _read_entry(directory: int, name: str) -> bytes:
    """Return the content of the file; b"" if it is not this user's alone, or cannot be read."""
    # O_NOFOLLOW: a link could lead to code that somebody else may write. O_NONBLOCK: to open a pipe
    # would wait for a writer.
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
            os.utime(file)  # the time of its last use, by which `_drop_oldest` sorts
        with open(file, "rb", closefd=False) as opened:
            return opened.read(MOST_BYTES)
    except OSError:
        return b""
    finally:
        os.close(file)


def keep(key: str, code: bytes) -> None:
    """Keep the code under the key, in place of an older entry, if that is possible."""
    path = folder()
    if path is None:
        return
    with suppress(OSError):
        for parent in (path.parent, path):
            # Private from the beginning, as `_is_ours` refuses a folder that others may write to.
            parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    with _open_folder(path) as directory:
        if directory is not None:
            with suppress(OSError, InputError):
                write_atomically(path / f"{key}{_SUFFIX}", _digest(key, code) + code)
            _drop_oldest(directory)


def _digest(key: str, code: bytes) -> bytes:
    return hashlib.sha256(f"areaproof kernel 1\n{key}\n".encode() + code).digest()


def _is_ours(status: os.stat_result) -> bool:
    """Return True if the file is this user's and nobody else may write to it."""
    return status.st_uid == os.geteuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


@contextmanager
def _open_folder(path: Path | None) -> Iterator[int | None]:
    """Yield the descriptor of the folder, open within the context; None for an untrusted one."""
    # Files are opened relative to this descriptor, so that nobody can put another folder in its
    # place between the check and the use.
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
    """Delete entries, those not used for the longest time first, until the limit is kept."""
    files = []
    with suppress(OSError), os.scandir(directory) as entries:
        for entry in entries:
            if _ENTRY_NAME.match(entry.name):
                with suppress(OSError):  # another process has deleted it
                    status = entry.stat(follow_symlinks=False)
                    files.append((status.st_mtime_ns, entry.name, status.st_size))
    total = sum(size for _, _, size in files)
    for _, name, size in sorted(files):
        if total <= MOST_BYTES:
            return
        with suppress(OSError):
            os.unlink(name, dir_fd=directory)
        total -= size
