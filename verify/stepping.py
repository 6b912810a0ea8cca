"""Stepping: a job of N steps, in chunks, in whatever arithmetic it is given."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.errors import InputError
from verify.exact import decimal
from verify.hamiltonian import Hamiltonian
from verify.kernel import Kernel, kernel_for
from verify.number_system import Arithmetic
from verify.results import SeriesPoint
from verify.schemes import get

Progress = Callable[[int], None]  # called with the number of steps done
State = tuple[Any, ...]
_CHECKPOINTS = 16
ACCUMULATORS = {"lambda": "lam", "mse": "mse", "delta_j_max": "top", "lambda_plain": "plain"}


@dataclass(frozen=True)
class Outcome:
    """A run's numbers as exact rationals, at checkpoints on its way and at the last step done."""

    done: int
    trail: tuple[dict[str, Fraction], ...]
    series: tuple[SeriesPoint, ...]
    seconds: float

    @property
    def values(self) -> dict[str, Fraction]:
        return self.trail[-1]


def _compilable(hamiltonian: Hamiltonian, scheme: str) -> Hamiltonian:
    """H with its parameters as the kernel's arguments, where the scheme takes it so.

    A scheme may take H for the given values only, as symplectic Euler does (a − 1) p q + … at
    a = 1; then the values are put in.
    """
    generic = hamiltonian.generic()
    try:
        get(scheme).step_map(generic)
    except InputError:
        return Hamiltonian(hamiltonian.exact)
    return generic


class Job:
    """What is run, apart from the arithmetic it is run in."""

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        start: dict[str, Fraction],
        steps: int,
        observables: frozenset[str],
        points: int,
    ) -> None:
        self.generic, self.scheme = _compilable(hamiltonian, scheme), scheme
        self.parameters, self.start = dict(hamiltonian.values), start
        self.steps, self.observables, self.points = steps, observables, points

    def go(
        self,
        arithmetic: Arithmetic,
        *,
        compensated: bool = False,
        progress: Progress | None = None,
    ) -> Outcome:
        """All steps in this arithmetic; the series only where the kernel collects extremes."""
        observables = self.observables if not compensated else self.observables - {"extremes"}
        kernel = kernel_for(self.generic, self.scheme, arithmetic, observables, compensated)
        number = arithmetic.number
        fixed = [number(self.start["h"]), *(number(self.parameters[n]) for n in kernel.parameters)]
        state: State = tuple(number(self.start[n]) for n in ("p", "q"))
        state += tuple(number(Fraction(x)) for x in kernel.start)
        advance(kernel, arithmetic, fixed, state, 0)  # compiles: `seconds` is the stepping alone
        sections = -(-self.steps // (self.points or _CHECKPOINTS))  # steps of a section
        series: list[SeriesPoint] = []
        trail: list[dict[str, Fraction]] = []
        extremes: list[State] = []
        begun, done = time.perf_counter(), 0
        while done < self.steps:
            count = min(arithmetic.chunk, sections - done % sections, self.steps - done)
            after = advance(kernel, arithmetic, fixed, state, count)
            if after is None:
                done += last_good(kernel, arithmetic, fixed, state, count)
                break
            state = after
            extremes.append(state)
            done += count
            if done % sections == 0 or done == self.steps:
                trail.append(self.finals(kernel, arithmetic, state, done))
                if "extremes" in observables:
                    first = (len(trail) - 1) * sections + 1
                    series.append(_point(kernel, arithmetic, extremes, first, done))
                extremes.clear()
            if progress:
                progress(done)
        seconds = time.perf_counter() - begun
        return Outcome(done, tuple(trail), tuple(series), seconds)

    def finals(
        self, kernel: Kernel, arithmetic: Arithmetic, state: State, done: int
    ) -> dict[str, Fraction]:
        """p, q and the observables after `done` steps, as the exact rationals that they are."""
        raw = {n: arithmetic.exact(x) for n, x in zip(kernel.carried, state, strict=True)}
        total = {n: x + raw.get(f"{n}_rest", 0) for n, x in raw.items()}
        result = {"p": total["p"], "q": total["q"]}
        for name in self.observables & set(ACCUMULATORS):
            result[name] = total[ACCUMULATORS[name]]
        if "mse" in result:
            result["mse"] /= done
        if "lambda_plain" in result:
            result["lambda_plain"] -= 1
        return result


def advance(
    kernel: Kernel, arithmetic: Arithmetic, fixed: Sequence[Any], state: State, count: int
) -> State | None:
    """The state after `count` steps, or None where a number left the arithmetic's range."""
    try:
        with arithmetic.context():
            done, *after = kernel.function(count, *fixed, *state)
    except (ArithmeticError, ValueError):  # not float64: a pole, or the log or root of a negative
        return None
    if done < count or not all(arithmetic.finite(x) for x in after):
        return None
    return tuple(after)


def last_good(
    kernel: Kernel, arithmetic: Arithmetic, fixed: Sequence[Any], state: State, count: int
) -> int:
    """The greatest number of steps below `count` that stays in range, by bisection."""
    good, bad = 0, count
    while bad - good > 1:
        middle = (good + bad) // 2
        if advance(kernel, arithmetic, fixed, state, middle) is None:
            bad = middle
        else:
            good = middle
    return good


def _point(
    kernel: Kernel, arithmetic: Arithmetic, states: Sequence[State], first: int, last: int
) -> SeriesPoint:
    """The extremes over the kernel calls that ended in these states."""
    at = [dict(zip(kernel.carried, state, strict=True)) for state in states]

    def pair(name: str) -> tuple[str, str]:
        low = min(arithmetic.exact(x[f"{name}_low"]) for x in at)
        high = max(arithmetic.exact(x[f"{name}_high"]) for x in at)
        return decimal(low, 7), decimal(high, 7)

    return SeriesPoint(first=first, last=last, delta_j=pair("dj"), lam=pair("lam"))
