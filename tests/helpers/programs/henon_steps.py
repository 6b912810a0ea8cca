"""Step functions of arrays in two degrees of freedom, for Hénon–Heiles and a few others."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

Step = Callable[..., Any]
HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
DRIVEN = f"{HENON} - q1*cos(t)"
KEPLER = "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)"
ROTATING = "(p1**2 + p2**2)/2 + p1*q2 - p2*q1 + q1**2*q2"  # not separable
ROOTS = "(p1**2 + p2**2)/2 + sqrt(q1 - 5) + q2"
W1 = 1 / (2 - 2 ** (1 / 3))


def force(q: Any) -> Any:
    return -np.array([q[0] + 2 * q[0] * q[1], q[1] + q[0] ** 2 - q[1] ** 2])


def pushed(q: Any, t: Any) -> Any:
    return force(q) + np.array([math.cos(t), 0])


def verlet_by(first: Step, last: Step | None = None) -> Step:
    """Störmer–Verlet, with the force of its first kick, and of its last one."""

    def step(p: Any, q: Any, h: Any) -> Any:
        p = p + h / 2 * first(q)
        q = q + h * p
        return p + h / 2 * (last or first)(q), q

    return step


verlet = verlet_by(force)
kepler = verlet_by(lambda q: -q / np.sqrt(q @ q) ** 3)
verlet_of_roots = verlet_by(lambda q: -np.array([1 / (2 * math.sqrt(q[0] - 5)), 1]))


def q_first(x: Any, v: Any, dt: Any) -> Any:
    v, x = verlet(v, x, dt)
    return x, v


def taking_lists(p: Any, q: Any, h: Any) -> Any:
    """It asks of q what lists alone answer."""
    if not q:
        return p, q
    p, q = verlet(np.array(p), np.array(q), h)
    return list(p), list(q)


def euler(p: Any, q: Any, h: Any) -> Any:
    return p + h * force(q), q + h * p


def rk4(p: Any, q: Any, h: Any) -> Any:
    k1, v1 = force(q), p
    k2, v2 = force(q + h / 2 * v1), p + h / 2 * k1
    k3, v3 = force(q + h / 2 * v2), p + h / 2 * k2
    k4, v4 = force(q + h * v3), p + h * k3
    return p + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), q + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)


def explicit_midpoint_of_rotating(p: Any, q: Any, h: Any) -> Any:
    def slope(p: Any, q: Any) -> Any:
        f = np.array([p[1] - 2 * q[0] * q[1], -p[0] - q[0] ** 2])
        return f, np.array([p[0] + q[1], p[1] - q[0]])

    f, v = slope(p, q)
    f, v = slope(p + h / 2 * f, q + h / 2 * v)
    return p + h * f, q + h * v


def composed(*weights: float) -> Step:
    def step(p: Any, q: Any, h: Any) -> Any:
        for w in weights:
            p, q = verlet(p, q, w * h)
        return p, q

    return step


yoshida = composed(W1, 1 - 2 * W1, W1)


def iterated(mean_force: Callable[[Any, Any], Any]) -> Step:
    """Solved by a loop that compares numbers, with a force of q before and after the step."""

    def step(p: Any, q: Any, h: Any) -> Any:
        p1, q1 = p, q
        for _ in range(60):
            a, b = p + h * mean_force(q, q1), q + h * (p + p1) / 2
            near = max(abs(a - p1)) + max(abs(b - q1)) < 1e-15
            p1, q1 = a, b
            if near:
                break
        return p1, q1

    return step


midpoint = iterated(lambda q, q1: force((q + q1) / 2))
trapezoid = iterated(lambda q, q1: (force(q) + force(q1)) / 2)


def driven_at(first: float, last: float) -> Step:
    """Störmer–Verlet that reads its clock at these parts of the step."""

    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        p = p + h / 2 * pushed(q, t + first * h)
        q = q + h * p
        return p + h / 2 * pushed(q, t + last * h), q

    return step


def one_kick_at(moment: float) -> Step:
    """Half a drift, a kick that reads its clock at this part of the step, and half a drift."""

    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        q = q + h / 2 * p
        p = p + h * pushed(q, t + moment * h)
        return p, q + h / 2 * p

    return step


# -- wrong ones -----------------------------------------------------------------------------------


def skewed(p: Any, q: Any, h: Any) -> Any:
    """It preserves volume and is not symplectic."""
    p, q = verlet(p, q, h)
    return p + h**3 * np.array([q[1], 0 * q[0]]), q


# The sign of one term of the force is wrong, so that it is no gradient any more.
no_potential = verlet_by(lambda q: force(q) + np.array([0, 2 * q[0] ** 2]))
one_exchanged = verlet_by(force, lambda q: force(q)[::-1])
wrong_weights = composed(W1, 2 * W1 - 1, W1)
