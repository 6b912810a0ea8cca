"""Work in a child process that starts with the libraries imported, but nothing of `verify`.

So a mutant costs the import of `verify` alone. A child has limits of processor time, of time and
of memory, and is ended with all that it started.
"""

import contextlib
import ctypes
import importlib
import json
import os
import resource
import select
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

LIBRARIES = ("sympy", "flint", "numpy", "gmpy2", "mpmath", "pydantic", "hypothesis",
             "llvmlite.binding", "pytest", "_pytest.assertion", "click", "rich")  # fmt: skip
MEMORY = 6 << 30
_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of Linux
_SLACK = 4  # times the processor time that a child may wait, as others work beside it
_SAID = 300  # characters of a child's last words


@dataclass(frozen=True)
class Ended:
    """How a child ended: `how` is "done", "timeout" or "died", `said` its last words.

    `seconds` are those of the processor.
    """

    how: str
    value: dict[str, Any] = field(default_factory=dict)
    seconds: float = 0
    said: str = ""


def warm_up() -> None:
    """Imports the libraries; to be called once, before the first child.

    hypothesis calls what packages have registered with it when it is imported, `verify` too: here
    it must not, and `register` does so in the child.
    """
    os.environ["HYPOTHESIS_NO_PLUGINS"] = "1"
    for name in LIBRARIES:
        importlib.import_module(name)
    del os.environ["HYPOTHESIS_NO_PLUGINS"]
    assert not [n for n in sys.modules if n.partition(".")[0] == "verify"]


def register() -> None:
    """Calls what is registered with hypothesis: imports `verify`, with what is planted in it."""
    from hypothesis.entry_points import run

    run()


def forked(work: Callable[[], dict[str, Any]], seconds: float) -> Ended:
    """What `work` gives in a child; "died" where it raises or is ended by a signal.

    `seconds` limit its processor time, so that a busy machine makes no hang of slow work.
    """
    sys.stdout.flush()
    receiver, sender = os.pipe()
    deadline = time.monotonic() + _SLACK * seconds
    with tempfile.TemporaryDirectory(prefix="mutant-") as folder:
        child = os.fork()
        if child == 0:
            os.close(receiver)
            _in_child(work, sender, Path(folder), seconds)
        os.close(sender)
        try:
            text, late = _received(receiver, deadline)
        finally:
            os.close(receiver)
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(child, signal.SIGKILL)
            with contextlib.suppress(ProcessLookupError):
                os.kill(child, signal.SIGKILL)  # where it has no group of its own yet
            _, status, used = os.wait4(child, 0)
        spent = used.ru_utime + used.ru_stime
        said = _last_words(Path(folder) / "said")
    if text:
        value = json.loads(text)
        return Ended("died" if "died" in value else "done", value, spent, value.get("died", said))
    hung = late or (os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU)
    return Ended("timeout" if hung else "died", {}, spent, said)


def end_with_parent() -> None:
    """This process is ended when its parent is, where the system can do that."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_DEATH_SIGNAL, signal.SIGKILL)


def _in_child(
    work: Callable[[], dict[str, Any]], sender: int, folder: Path, seconds: float
) -> None:
    """Does the work and ends the process."""
    try:
        os.setsid()
        end_with_parent()
        # What is kept between runs of the same tests is kept for this child alone.
        os.environ["HYPOTHESIS_STORAGE_DIRECTORY"] = str(folder / "hypothesis")
        os.environ["VERIFY_CACHE"] = str(folder.absolute() / "verify")
        os.environ["TMPDIR"] = tempfile.tempdir = str(folder)
        said = os.open(folder / "said", os.O_WRONLY | os.O_CREAT)
        os.dup2(said, 1)
        os.dup2(said, 2)
        limit = max(1, round(seconds))
        signal.signal(signal.SIGXCPU, signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        try:
            value = work()
        except BaseException as error:  # also a SystemExit: a mutant's work must come to its end
            traceback.print_exc()
            value = {"died": f"{type(error).__name__}: {error}"[:_SAID]}
        sys.stdout.flush()
        with os.fdopen(sender, "w", encoding="utf-8") as pipe:
            json.dump(value, pipe)
    finally:
        os._exit(0)


def _received(pipe: int, deadline: float) -> tuple[str, bool]:
    """All that comes until the other end is closed, and whether it came too late."""
    parts: list[bytes] = []
    while True:
        ready, _, _ = select.select([pipe], [], [], max(0, deadline - time.monotonic()))
        if not ready:
            return "", True
        part = os.read(pipe, 1 << 16)
        if not part:
            return b"".join(parts).decode(), False
        parts.append(part)


def _last_words(path: Path) -> str:
    if not path.exists():
        return ""
    return " ".join(path.read_text(errors="replace").split())[-_SAID:]
