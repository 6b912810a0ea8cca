"""Files that keep results and checkpoints on disk, so that an interruption loses little.

Each is one file, which is written atomically.
"""

import contextlib
import hashlib
import json
import time
from fractions import Fraction
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from verify.content import digest_of, shipped_files
from verify.errors import InputError
from verify.execution.provenance import versions
from verify.files import check_replaceable, read_text, write_atomically

# The scenes that a seed draws depend on these libraries; no digit of a result does.
_DRAWING_LIBRARIES = ("hypothesis",)
KEPT, CHECKPOINT = "areaproof kept result 2", "areaproof checkpoint 2"  # the names of the formats
_CHECKPOINT_SECONDS = 5.0  # the interval between two checkpoints of a run


@cache
def fingerprint() -> str:
    """Return a hash of this package's files and of the versions of its libraries.

    Only results with the same fingerprint are reused.
    """
    drawing = {name: version(name) for name in _DRAWING_LIBRARIES}
    return digest_of(shipped_files(), json.dumps(versions() | drawing))[:12]


def name_of(request: object) -> str:
    """Return the name of a file for a request."""
    return hashlib.sha256(repr(request).encode()).hexdigest()[:24]


def fraction_text(x: Fraction) -> str:
    """Return an exact text of any length."""
    return f"{x.numerator:x}/{x.denominator:x}"  # decimal texts end at 4300 digits


def fraction_of(x: str) -> Fraction:
    """Parse the text that `fraction_text` returns."""
    numerator, denominator = (int(part, 16) for part in x.split("/"))
    return Fraction(numerator, denominator)


def seal(form: str, name: str, content: str) -> str:
    """Return an object with the JSON `content` in it, its format, its name and a digest of both."""
    # The name is part of the digest: a file that was renamed or copied to another task's name is
    # not accepted.
    digest = hashlib.sha256(f"{name}\n{content}".encode()).hexdigest()
    return f'{{"format": "{form}", "name": "{name}", "sha256": "{digest}", "data":\n{content}\n}}\n'


def unseal(form: str, name: str, text: str) -> str | None:
    """Return the content that was sealed in that format and under that name; None for any other
    text.

    >>> unseal(KEPT, "7f", seal(KEPT, "7f", "[1, 2]"))
    '[1, 2]'
    >>> unseal(KEPT, "7f", seal(KEPT, "7f", "[1, 2]").replace("1, 2", "1, 3"))
    >>> unseal(KEPT, "8a", seal(KEPT, "7f", "[1, 2]"))
    """
    content = text.partition("\n")[2].removesuffix("\n}\n")
    return content if seal(form, name, content) == text else None


def read_kept_text(form: str, path: Path) -> str | None:
    """Return the content sealed under the file's own name; None for a damaged or renamed file, or
    for none."""
    if not path.exists():  # the most frequent case, which `read_text` would report slowly
        return None
    try:
        return unseal(form, path.stem, read_text(path, most=None))
    except InputError:
        return None


def tasks_with_checkpoints(folder: Path) -> frozenset[str]:
    """Return the names of the tasks of which the folder has checkpoints."""
    return frozenset(path.name.rsplit("-", 2)[0] for path in folder.glob("*.checkpoint"))


class Keeper:
    """The checkpoints of one task's runs, each under a label; a folder of None keeps nothing.

    A checkpoint is written every few seconds and when the run is interrupted. Only the same task
    and the same code can use it. `prepared`: the result of the task's `prepare` in a worker of this
    process; it is kept in memory alone.
    """

    def __init__(self, folder: Path | None, name: str) -> None:
        self._folder, self._name = folder, name
        self._last_write: dict[str, float] = {}
        self.saved = False  # True once it has written a checkpoint
        self.prepared: Any = None

    def _path(self, label: str) -> Path | None:
        if self._folder is None:
            return None
        short = hashlib.sha256(label.encode()).hexdigest()[:12]
        return self._folder / f"{self._name}-{fingerprint()}-{short}.checkpoint"

    def load(self, label: str) -> dict[str, Any] | None:
        """Return the data kept under the label; None if there are none, or if they are damaged or
        of another format.

        Raises InputError if something occupies the path that could not be replaced.
        """
        path = self._path(label)
        if path is None:
            return None
        content = read_kept_text(CHECKPOINT, path)
        record = json.loads(content) if content else {}
        data: dict[str, Any] | None = record["data"] if record.get("label") == label else None
        if data is None:
            check_replaceable(path)
        return data

    def due(self, label: str) -> bool:
        """Return True if some seconds have passed since the last checkpoint under the label."""
        if self._folder is None:
            return False
        last = self._last_write.setdefault(label, time.monotonic())
        return time.monotonic() - last >= _CHECKPOINT_SECONDS

    def save(self, label: str, data: dict[str, Any]) -> None:
        """Keep the run under the label, in place of the previous checkpoint."""
        path = self._path(label)
        if path is not None:
            content = json.dumps({"label": label, "data": data})
            write_atomically(path, seal(CHECKPOINT, path.stem, content))
            self._last_write[label] = time.monotonic()
            self.saved = True

    def clear(self) -> None:
        """Remove all checkpoints of the task, which is done."""
        if self._folder is not None:
            for path in self._folder.glob(f"{self._name}-*.checkpoint"):
                with contextlib.suppress(OSError):
                    path.unlink()


NOTHING = Keeper(None, "")
