"""Tasks that are alone and prepare, and others: a log says when each begins and ends, and where."""

import os
import time
from pathlib import Path
from typing import ClassVar, NamedTuple

from tests.helpers.processes.worker_functions import killed_once
from verify.errors import InputError
from verify.execution.keeper import Keeper
from verify.execution.task import Task
from verify.scenes.frozen import Frozen


class Noted(Frozen):
    """What the keeper had."""

    prepared: str | None


class Other(Task):
    """Any task."""

    result = Noted
    kind: str = "other"
    log: str
    number: int
    worth: int = 1

    @property
    def cost(self) -> int:
        return self.worth

    def compute(self, keeper: Keeper) -> Noted:
        self.note("compute")
        return Noted(prepared=keeper.prepared)

    def note(self, what: str) -> None:
        """Says that it begins, and after some time that it ends."""
        for when in ("begins", "ends"):
            with Path(self.log).open("a") as file:
                file.write(f"{self.kind} {self.number} {what} {when} {os.getpid()}\n")
            time.sleep(0.1 if when == "begins" else 0)


class Timed(Other):
    """One that is alone; `bad`: its input is; `flag`: its first worker is killed."""

    alone: ClassVar[bool] = True
    kind: str = "timed"
    bad: bool = False
    flag: str = ""

    def prepare(self) -> str:
        self._check()
        if self.flag:
            killed_once(self.flag)
        self.note("prepare")
        return f"of {self.number}"

    def compute(self, keeper: Keeper) -> Noted:
        self._check()
        return super().compute(keeper)

    def _check(self) -> None:
        if self.bad:
            raise InputError("number", self.number, "is bad")


class Line(NamedTuple):
    """What a log says."""

    kind: str
    number: int
    what: str
    when: str
    process: int


def lines_of(log: Path) -> list[Line]:
    found = (text.split() for text in log.read_text().splitlines())
    return [Line(kind, int(k), what, when, int(pid)) for kind, k, what, when, pid in found]
