"""Functions that tests send to workers, which import them from here."""

import os
import signal
import sys
import time
from pathlib import Path


def square(k: int, seconds: float = 0.0, log: str = "") -> int:
    """k², after some time; every time it is begun, a line says so in the log."""
    if log:
        with Path(log).open("a") as file:
            file.write(f"{k} {os.getpid()}\n")
    time.sleep(seconds)
    return k * k


def killed() -> None:
    """Never returns: its process is gone as by the system's hand."""
    os.kill(os.getpid(), signal.SIGKILL)


def killed_once(flag: str) -> str:
    """The first time its process is gone; the second time it is well."""
    try:
        Path(flag).touch(exist_ok=False)
    except FileExistsError:
        return "well"
    killed()
    return "never"


def wrong(seconds: float = 0.0) -> None:
    time.sleep(seconds)
    raise ValueError("wrong input")


def process() -> int:
    time.sleep(0.05)
    return os.getpid()


def loaded(name: str) -> bool:
    """Whether the module is there, before anything here needs it."""
    return name in sys.modules
