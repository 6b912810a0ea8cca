"""Steps that keep something from call to call, or whose numbers are coarse, and right ones."""

import functools
import itertools
import math
import random
from collections.abc import Iterator
from typing import Any

import numpy as np

from tests.helpers.programs.user_steps import euler_a, force, verlet

CALLS = 0
NEARBY: dict[float, float] = {}
EXACTLY: dict[float, float] = {}
NUMBERS = itertools.count()
TURN = [False]
HALF = np.float32(0.5)


def spoiling(period: int, error: float = 1e-9) -> Any:
    """Every so many calls spoil q."""

    def step(p: Any, q: Any, h: Any) -> Any:
        global CALLS
        CALLS += 1
        p, q = euler_a(p, q, h)
        return p, q + (error if CALLS % period == 0 else 0)

    return step


def kicked(q: Any, force_at: Any, p: Any, h: Any) -> Any:
    """Verlet by kicks and a drift."""
    p = p + h / 2 * force_at(q)
    q = q + h * p
    return p + h / 2 * force_at(q), q


def kept_nearby(p: Any, q: Any, h: Any) -> Any:
    """It takes the force that it has found at a point nearby."""

    def found(q: Any) -> Any:
        key = round(q, 6)
        if key not in NEARBY:
            NEARBY[key] = force(q)
        return NEARBY[key]

    return kicked(q, found, p, h)


def kept_for_a_while(p: Any, q: Any, h: Any) -> Any:
    """As `kept_nearby`, and what was found long ago is forgotten, so that calls differ."""
    new = kept_nearby(p, q, h)
    while len(NEARBY) > 20:
        NEARBY.pop(next(iter(NEARBY)))
    return new


def rounding(p: Any, q: Any, h: Any) -> Any:
    return kicked(q, lambda q: round(force(q), 7), p, h)


def single(p: Any, q: Any, h: Any) -> Any:
    return kicked(q, lambda q: -float(np.sin(np.float32(q))), p, h)


def single_throughout(p: Any, q: Any, h: Any) -> Any:
    """Python's floats are weak beside numpy's: p and q are of single precision, too."""
    return kicked(q, lambda q: -np.sin(np.float32(q)), p, h)


def single_by_a_coefficient(p: Any, q: Any, h: Any) -> Any:
    p = p + HALF * h * force(q)
    q = q + h * p
    return p + HALF * h * force(q), q


def unlike_symbols(p: Any, q: Any, h: Any) -> Any:
    """An error of 10⁻¹¹ that only floats see."""
    p, q = euler_a(p, q, h)
    return p, q + (1e-11 if type(q) is float else 0)


RAISED = [0]


def raising_at_times(p: Any, q: Any, h: Any) -> Any:
    RAISED[0] += 1
    if RAISED[0] % 100 == 0:
        raise OSError("busy")
    return euler_a(p, q, h)


def by_a_method(period: int) -> Any:
    return _Spoiler(period).step


class _Spoiler:
    made = 0

    def __init__(self, period: int) -> None:
        self.period = period

    def step(self, p: Any, q: Any, h: Any) -> Any:
        _Spoiler.made += 1
        p, q = euler_a(p, q, h)
        return p, q + (1e-9 if _Spoiler.made % self.period == 0 else 0)


# -- which keep something, and are right ----------------------------------------------------------


def counted(p: Any, q: Any, h: Any) -> Any:
    counted.calls = getattr(counted, "calls", 0) + 1  # type: ignore[attr-defined]
    return euler_a(p, q, h)


def counted_in_a_default(p: Any, q: Any, h: Any, *, calls: Any = [0]) -> Any:  # noqa: B006
    calls[0] += 1
    return euler_a(p, q, h)


def numbered(p: Any, q: Any, h: Any) -> Any:
    next(NUMBERS)
    return euler_a(p, q, h)


def _turns() -> Iterator[int]:
    for k in itertools.count():
        yield 0 * k


TURNS = _turns()


def generated(p: Any, q: Any, h: Any) -> Any:
    return euler_a(p + next(TURNS), q, h)


def turning(p: Any, q: Any, h: Any) -> Any:
    TURN[0] = not TURN[0]
    return euler_a(p, q, h)


def drawing(p: Any, q: Any, h: Any) -> Any:
    """An error once in a million calls, by chance."""
    p, q = euler_a(p, q, h)
    return p, q + (1e-3 if random.random() < 1e-6 else 0)  # noqa: S311


def kept_exactly(p: Any, q: Any, h: Any) -> Any:
    def found(q: Any) -> Any:
        if q not in EXACTLY:
            EXACTLY[q] = -math.sin(q)
        return EXACTLY[q]

    return kicked(q, found, p, h)


# -- which keep nothing ---------------------------------------------------------------------------


@functools.lru_cache(maxsize=7)
def cached(p: Any, q: Any, h: Any) -> Any:
    return verlet(p, q, h)


class _Pendulum:
    def __init__(self, strength: float) -> None:
        self.strength = strength

    def force(self, q: Any) -> Any:
        return -self.strength * math.sin(q)

    def step(self, p: Any, q: Any, h: Any) -> Any:
        return kicked(q, self.force, p, h)


of_an_object = _Pendulum(1.0).step


def by_kicks(p: Any, q: Any, h: Any) -> Any:
    return kicked(q, force, p, h)


# -- of the right area and the wrong order --------------------------------------------------------


def nearly_the_force(p: Any, q: Any, h: Any) -> Any:
    p = p - h * (1 + 1e-11) * math.sin(q)
    return p, q + h * p
