"""Step functions as users write them, for the pendulum: right ones, and ones with errors."""

import math
import os
import random
import sys
from math import sin
from typing import Any

import numpy as np

A = 1 / (2 - 2 ** (1 / 3))
YOSHIDA = (A, 1 - 2 * A, A)  # floats, as anybody's code has them


def force(q: Any) -> Any:
    return -math.sin(q)


def euler_a(p: Any, q: Any, h: Any) -> Any:
    p = p - h * math.sin(q)
    return p, q + h * p


def euler_b(q: Any, p: Any, dt: Any) -> Any:
    q = q + dt * p
    return q, p - dt * np.sin(q)


def verlet(p: Any, q: Any, h: Any) -> Any:
    new = q + h * p + 0.5 * h**2 * force(q)
    return p + 0.5 * h * (force(q) + force(new)), new


def lie2(p: Any, q: Any, h: Any) -> Any:
    return p - h * sin(q) - h**2 / 2 * p * math.cos(q), q + h * p - h**2 / 2 * sin(q)


def rk4(p: Any, q: Any, h: Any) -> Any:
    def slope(z: Any) -> Any:
        return np.array([-np.sin(z[1]), z[0]])

    z = np.array([p, q])
    a = slope(z)
    b = slope(z + h / 2 * a)
    c = slope(z + h / 2 * b)
    d = slope(z + h * c)
    return z + h * (a + 2 * b + 2 * c + d) * (1 / 6)


def midpoint_iterated(p: Any, q: Any, h: Any) -> Any:
    new = p, q
    for _ in range(20):
        new = p + h * force((q + new[1]) / 2), q + h * (p + new[0]) / 2
    return new


def midpoint_until(p: Any, q: Any, h: Any, tolerance: float = 1e-13) -> Any:
    x, y = p, q
    for _ in range(200):
        before = x, y
        x, y = p + h * force((q + y) / 2), q + h * (p + x) / 2
        if max(abs(x - before[0]), abs(y - before[1])) < tolerance:
            break
    return x, y


def midpoint_loosely(p: Any, q: Any, h: Any) -> Any:
    return midpoint_until(p, q, h, 1e-10)


def midpoint_to(tolerance: float, change: float = 0.0) -> Any:
    """The implicit midpoint rule by iteration, opaque to symbols; `change`: a planted friction."""

    def step(p: Any, q: Any, h: Any) -> Any:
        p, q, h = math.fmod(p, 99), math.fmod(q, 99), math.fmod(h, 99)
        p *= 1 - change * h
        return midpoint_until(p, q, h, tolerance)

    return step


def newton_thrice(p: Any, q: Any, h: Any) -> Any:
    y = q + h * p
    for _ in range(3):
        gap = y - q - h * p + h * h / 2 * math.sin((q + y) / 2)
        y = y - gap / (1 + h * h / 4 * math.cos((q + y) / 2))
    return p + h * force((q + y) / 2), y


def midpoint_by_newton(p: Any, q: Any, h: Any) -> Any:
    """It stops before the last correction is made, so that derivatives lag behind."""
    y = q + h * p
    for _ in range(50):
        gap = y - q - h * p + h * h / 2 * math.sin((q + y) / 2)
        new = y - gap / (1 + h * h / 4 * math.cos((q + y) / 2))
        if math.isclose(new, y, rel_tol=1e-15, abs_tol=1e-15):
            break
        y = new
    return p + h * force((q + y) / 2), y


def yoshida(p: Any, q: Any, h: Any) -> Any:
    for w in YOSHIDA:
        p = p + w * h / 2 * force(q)
        q = q + w * h * p
        p = p + w * h / 2 * force(q)
    return p, q


def vectorised(p: Any, q: Any, h: Any) -> Any:
    new = p.copy()
    new[:] = p - h * np.sin(q)
    return new, q + h * new


def branching(p: Any, q: Any, h: Any) -> Any:
    p = p - h * math.sin(q) if q > 0 else p + h * math.sin(-q)
    return p, q + h * p


def substeps(p: Any, q: Any, h: Any) -> Any:
    """As many as their size wants."""
    count = max(1, math.ceil(h / 0.05))
    for _ in range(count):
        p, q = verlet(p, q, h / count)
    return p, q


def only_floats(p: Any, q: Any, h: Any) -> Any:
    p = p - h * math.remainder(math.sin(q), 7)
    return p, q + h * p


# -- wrong ones -----------------------------------------------------------------------------------


def flipped(p: Any, q: Any, h: Any) -> Any:
    p = p + h * math.sin(q)
    return p, q + h * p


def explicit(p: Any, q: Any, h: Any) -> Any:
    return p - h * math.sin(q), q + h * p


def nearly_verlet(p: Any, q: Any, h: Any) -> Any:
    new = q + h * p + 0.5001 * h**2 * force(q)
    return p + 0.5 * h * (force(q) + force(new)), new


def nearly_yoshida(p: Any, q: Any, h: Any) -> Any:
    for w in (1.3512071, -1.7024142, 1.3512071):
        p = p + w * h / 2 * force(q)
        q = q + w * h * p
        p = p + w * h / 2 * force(q)
    return p, q


def frozen(p: Any, q: Any, h: Any) -> Any:
    return p, q


def without_h(p: Any, q: Any, h: Any) -> Any:
    return p - 0.1 * math.sin(q), q + 0.1 * p


def in_place(p: Any, q: Any, h: Any) -> Any:
    p -= h * np.sin(q)
    q += h * p
    return p, q


def not_a_number(p: Any, q: Any, h: Any) -> Any:
    return math.nan, q


def raising(p: Any, q: Any, h: Any) -> Any:
    raise ValueError("no luck\nat all")


def nothing(p: Any, q: Any, h: Any) -> Any:
    return None


def texts(p: Any, q: Any, h: Any) -> Any:
    return "p", "q"


def three(p: Any, q: Any, h: Any) -> Any:
    return p, q, h


def drawn(p: Any, q: Any, h: Any) -> Any:
    return p - h * math.sin(q) + 1e-9 * random.random(), q + h * p  # noqa: S311


CALLS = [0]


def counting(p: Any, q: Any, h: Any) -> Any:
    CALLS[0] += 1
    return p - h * math.sin(q) + 1e-9 * CALLS[0], q + h * p


def endless(p: Any, q: Any, h: Any) -> Any:
    while True:
        pass


def quitting(p: Any, q: Any, h: Any) -> Any:
    sys.exit(3)


def leaving(p: Any, q: Any, h: Any) -> Any:
    os._exit(0)


def printing(p: Any, q: Any, h: Any) -> Any:
    print("a step")
    return euler_a(p, q, h)


def of_two(p: Any, q: Any) -> Any:
    return p, q


def with_another(p: Any, q: Any, h: Any, gamma: Any) -> Any:
    return p, q
