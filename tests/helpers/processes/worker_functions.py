"""Functions that tests send to workers, which import them from here; and how they are sent."""

import os
import signal
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from verify.execution.executors import FunctionCall, Placement, open_place, results_of


def square(k: int, seconds: float = 0.0, log: str = "") -> int:
    """k², after some time; every time it is begun, a line says so in the log."""
    if log:
        with Path(log).open("a") as file:
            file.write(f"{k} {os.getpid()}\n")
    time.sleep(seconds)
    return k * k


def killed(flag: str = "") -> None:
    """Never returns: its process is gone as by the system's hand, once that file is there."""
    _await(flag)
    os.kill(os.getpid(), signal.SIGKILL)


def killed_once(flag: str) -> str:
    """The first time its process is gone; the second time it is well."""
    try:
        Path(flag).touch(exist_ok=False)
    except FileExistsError:
        return "well"
    killed()
    return "never"


def wrong(flag: str = "") -> None:
    """Raises an error, once that file is there."""
    _await(flag)
    raise ValueError("wrong input")


def _await(flag: str) -> None:
    until = time.monotonic() + 60
    while flag and not Path(flag).exists():
        assert time.monotonic() < until, f"no {flag}"
        time.sleep(0.01)


def process() -> int:
    time.sleep(0.05)
    return os.getpid()


def loaded(name: str) -> bool:
    """Whether the module is there, before anything here needs it."""
    return name in sys.modules


# -- in the test's own process --------------------------------------------------------------------


def squares(count: int, seconds: float = 0.0, log: str = "") -> list[FunctionCall]:
    return [FunctionCall(str(k), square, (k, seconds, log)) for k in range(count)]


def right(found: list[tuple[str, int]], count: int) -> bool:
    """All squares are there, each once, and each is that of its own call."""
    return sorted(found) == sorted((str(k), k * k) for k in range(count))


def collect(
    found: list[tuple[str, Any]],
    where: Placement,
    calls: Iterable[FunctionCall],
    flag: Path | None = None,
    after: int = 0,
) -> None:
    """Puts the results into `found` as they come; makes the flag after so many."""
    with open_place(where) as place:
        for each in results_of(place, calls):
            found.append(each)
            if flag is not None and len(found) == after:
                flag.touch()
