"""Runs of lie2 over long times by a program in C, which this folder alone uses."""

import fcntl
import json
import subprocess
from functools import cache
from pathlib import Path
from typing import NamedTuple

import mpmath

from tests.helpers.programs.compilers import executable

STEP_SIZES = ("0.001", "0.002", "0.004", "0.006", "0.008", "0.01")
STARTS = ((0.1, 0.0), (0.5, 0.0), (1.5, 0.0), (1.5, 1.5), (0.0, 1.5))  # q, p
PRINTED = ("-7.3010", "-7.0000", "-6.6990", "-6.5229", "-6.3979", "-6.3010")  # Tables 1 and 2
LONG = 20000

Start = tuple[float, float]


class Run(NamedTuple):
    """Of N steps; errors in parts of the orbit's reach."""

    steps: int
    mse: float
    largest: float  # |ΔJ|
    area: float  # Λ
    worst: float  # error, over the last period
    end: float  # error, at the end


class Orbit(NamedTuple):
    """A closed orbit, or of the pendulum that goes round one turn; reaches are half the ways."""

    period: float
    reach_q: float
    reach_p: float


def energy(system: str, start: Start, delta: float = 1.0) -> float:
    q, p = start
    if system == "pendulum":
        return float(p * p / 2 - mpmath.cos(q))
    return p * p / 2 + q * q / 2 + delta * q**4 / 4


def orbit(system: str, start: Start, delta: float = 1.0) -> Orbit:
    """By complete elliptic integrals."""
    level = mpmath.mpf(energy(system, start, delta))
    high = mpmath.sqrt(2 * (level + (system == "pendulum")))
    if system == "duffing":
        square = (mpmath.sqrt(1 + 4 * delta * level) - 1) / delta
        stiff = 1 + delta * square
        period = 4 * mpmath.ellipk(delta * square / (2 * stiff)) / mpmath.sqrt(stiff)
        return Orbit(float(period), float(mpmath.sqrt(square)), float(high))
    if level < 1:
        return Orbit(
            float(4 * mpmath.ellipk((level + 1) / 2)), float(mpmath.acos(-level)), float(high)
        )
    period = 4 / high * mpmath.ellipk(2 / (level + 1))
    low = mpmath.sqrt(2 * (level - 1))
    return Orbit(float(period), float(mpmath.pi), float((high - low) / 2))


class LongRuns:
    """The program and what it has computed, which all processes of a session share."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def exact(self, system: str, start: Start, time: float) -> tuple[float, float]:
        """q and p at that time."""
        q, p = self._lines(system, start, repr(time), (), 1.0)[0]
        return q, p

    def of(
        self,
        system: str,
        start: Start,
        sizes: tuple[str, ...] = STEP_SIZES,
        time: int = LONG,
        delta: float = 1.0,
        real: str = "long double",
    ) -> list[Run]:
        """`real` is C's type of the numbers."""
        rows = self._lines(system, start, str(time), sizes, delta, real)
        return [Run(int(steps), *numbers) for steps, *numbers in rows]

    def grid(self, system: str, time: int = LONG, delta: float = 1.0) -> list[list[Run]]:
        """A row for each initial value."""
        return [self.of(system, start, time=time, delta=delta) for start in STARTS]

    def at(self, system: str, size: str) -> list[Run]:
        """From each initial value, over the long time."""
        index = STEP_SIZES.index(size)
        return [row[index] for row in self.grid(system)]

    @cache  # noqa: B019 - there is one of it
    def _lines(
        self,
        system: str,
        start: Start,
        time: str,
        sizes: tuple[str, ...],
        delta: float,
        real: str = "long double",
    ) -> list[list[float]]:
        numbers = (*start, *orbit(system, start, delta))
        words = [system, repr(delta), time, *(repr(float(x)) for x in numbers), *sizes]
        with (self.folder / "lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            name = real.replace(" ", "_")
            kept = self.folder / ("_".join([name, *words]) + ".json")
            if not kept.exists():
                source = Path(__file__).with_suffix(".c").read_text(encoding="utf-8")
                program = executable(self.folder, f"{name}.c", source, "-lm", f"-DREAL={real}")
                lines = _output(program, *words).splitlines()
                kept.write_text(json.dumps([[float(x) for x in line.split()] for line in lines]))
        rows: list[list[float]] = json.loads(kept.read_text())
        return rows


def _output(program: str, *words: str) -> str:
    done = subprocess.run([program, *words], check=True, capture_output=True, text=True)
    return done.stdout
