"""What is kept on disk, so that an interruption loses little: atomically, one file a thing."""

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
from verify.execution.machine import versions
from verify.files import check_replaceable, read_text, write_atomically

_DRAWING = ("hypothesis",)  # what a seed draws depends on it, and no digit does
KEPT, CHECKPOINT = "areaproof kept result 2", "areaproof checkpoint 2"  # formats
_SECONDS = 5.0  # between two checkpoints of a run


@cache
def fingerprint() -> str:
    """A name for this package, its content and its libraries: no result of others is taken up."""
    drawing = {name: version(name) for name in _DRAWING}
    return digest_of(shipped_files(), json.dumps(versions() | drawing))[:12]


def name_of(asked: object) -> str:
    """A file's name for what is asked."""
    return hashlib.sha256(repr(asked).encode()).hexdigest()[:24]


def fraction_text(x: Fraction) -> str:
    """An exact text of any length."""
    return f"{x.numerator:x}/{x.denominator:x}"  # decimal texts end at 4300 digits


def fraction_of(x: str) -> Fraction:
    """What `fraction_text` has written."""
    numerator, denominator = (int(part, 16) for part in x.split("/"))
    return Fraction(numerator, denominator)


def sealed(form: str, name: str, content: str) -> str:
    """An object with the JSON `content` in it, beside its format, its name and a digest of both."""
    digest = hashlib.sha256(f"{name}\n{content}".encode()).hexdigest()
    return f'{{"format": "{form}", "name": "{name}", "sha256": "{digest}", "data":\n{content}\n}}\n'


def unsealed(form: str, name: str, text: str) -> str | None:
    """The content that was sealed in that format and under that name; None for any other text.

    >>> unsealed(KEPT, "7f", sealed(KEPT, "7f", "[1, 2]"))
    '[1, 2]'
    >>> unsealed(KEPT, "7f", sealed(KEPT, "7f", "[1, 2]").replace("1, 2", "1, 3"))
    >>> unsealed(KEPT, "8a", sealed(KEPT, "7f", "[1, 2]"))
    """
    content = text.partition("\n")[2].removesuffix("\n}\n")
    return content if sealed(form, name, content) == text else None


def kept_text(form: str, path: Path) -> str | None:
    """What was sealed under the file's own name; None for what is damaged or that of another."""
    if not path.exists():  # most often, and to say what is there instead would take long
        return None
    try:
        return unsealed(form, path.stem, read_text(path, most=None))
    except InputError:
        return None


def tasks_with_checkpoints(folder: Path) -> frozenset[str]:
    """The names of the tasks of which checkpoints are kept there."""
    return frozenset(path.name.rsplit("-", 2)[0] for path in folder.glob("*.checkpoint"))


class Keeper:
    """The checkpoints of one task's runs, each under a label; a folder of None keeps nothing.

    A checkpoint is written every few seconds and where the run is interrupted, and is of use to the
    same task and the same code only. `prepared`: what the task's `prepare` has found in a worker of
    this process; it is in memory alone.
    """

    def __init__(self, folder: Path | None, name: str) -> None:
        self._folder, self._name = folder, name
        self._written: dict[str, float] = {}
        self.saved = False  # whether it has kept a checkpoint
        self.prepared: Any = None

    def _path(self, label: str) -> Path | None:
        if self._folder is None:
            return None
        short = hashlib.sha256(label.encode()).hexdigest()[:12]
        return self._folder / f"{self._name}-{fingerprint()}-{short}.checkpoint"

    def load(self, label: str) -> dict[str, Any] | None:
        """What was kept under the label; None where that is nothing, damaged, of another format.

        Raises InputError where what is there instead could not be replaced.
        """
        path = self._path(label)
        if path is None:
            return None
        content = kept_text(CHECKPOINT, path)
        found = json.loads(content) if content else {}
        data: dict[str, Any] | None = found["data"] if found.get("label") == label else None
        if data is None:
            check_replaceable(path)
        return data

    def due(self, label: str) -> bool:
        """Whether some seconds have passed since the last checkpoint under the label."""
        if self._folder is None:
            return False
        last = self._written.setdefault(label, time.monotonic())
        return time.monotonic() - last >= _SECONDS

    def save(self, label: str, data: dict[str, Any]) -> None:
        """Keeps the run under the label, in place of what was kept before."""
        path = self._path(label)
        if path is not None:
            content = json.dumps({"label": label, "data": data})
            write_atomically(path, sealed(CHECKPOINT, path.stem, content))
            self._written[label] = time.monotonic()
            self.saved = True

    def clear(self) -> None:
        """Forgets all checkpoints of the task, which is done."""
        if self._folder is not None:
            for path in self._folder.glob(f"{self._name}-*.checkpoint"):
                with contextlib.suppress(OSError):
                    path.unlink()


NOTHING = Keeper(None, "")
