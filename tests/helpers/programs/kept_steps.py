"""Steps and maps that keep some structure, and the same with a planted error; in any units."""

import math
import struct
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

Step = Callable[..., Any]

PENDULUM = "p**2/2 - cos(q)"
LOTKA = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
LOTKA_FORM = "du^dv/(u*v)"
LOTKA_INTEGRAL = "u - log(u) + v - 2*log(v)"
DAMPED = "v_dot = -sin(x) - v/10; x_dot = v"
PUSH = (
    "v1_dot = -x1 + v2*(1 + x1**2/10) - v3*x2/5; v2_dot = -2*x2 - v1*(1 + x1**2/10);"
    "v3_dot = x3/2 + v1*x2/5; x1_dot = v1; x2_dot = v2; x3_dot = v3"
)
MONTE_CARLO = "v1_dot = -x1 - x1*x2**2/10; v2_dot = -2*x2 - x1**2*x2/10; x1_dot = v1; x2_dot = v2"
BODY = "x_dot = -y*w/6; y_dot = 2*w*x/3; w_dot = -x*y/2"
BODY_BRACKET = "0, -w, y; w, 0, -x; -y, x, 0"
MASSES = np.array([1.0, 3.0])


def verlet(p, q, h):
    p = p - h / 2 * math.sin(q)
    q = q + h * p
    return p - h / 2 * math.sin(q), q


def verlet_with_friction(p, q, h):
    p, q = verlet(p, q, h)
    return p * (1 - 1e-7 * h), q


def verlet_without_sign(p, q, h):
    h = abs(h)
    return verlet(p, q, h)


def verlet_uneven(p, q, h):
    p = p - 0.6 * h * math.sin(q)
    q = q + h * p
    return p - 0.4 * h * math.sin(q), q


def midpoint(p, q, h, tolerance=1e-9):
    a, b = p, q
    for _ in range(200):
        c, d = p - h * math.sin((q + b) / 2), q + h * (p + a) / 2
        if abs(c - a) + abs(d - b) < tolerance:
            break
        a, b = c, d
    return c, d


def lotka(u, v, h):
    u = u / (1 - h * (v - 2))
    return u, v + h * v * (1 - u)


def lotka_wrong(u, v, h):
    u, v = lotka(u, v, h)
    return u, v + 1e-5 * h * v * v


def damped(v, x, h):
    v = v - h / 2 * math.sin(x)
    x = x + h / 2 * v
    v = v * math.exp(-h / 10)
    x = x + h / 2 * v
    return v - h / 2 * math.sin(x), x


def damped_wrong(v, x, h):
    v, x = damped(v, x, h)
    return v * (1 + 1e-6 * h * h), x


def push(v, x, h, mistake=0.0):
    x = x + h / 2 * v
    t = h / 2 * np.array([0 * x[0], 0.2 * x[1], 1 + 0.1 * x[0] ** 2])
    v = v + h / 2 * np.array([-x[0], -2 * x[1], 0.5 * x[2]])
    w = v + np.cross(v, t)
    v = v + np.cross(w, 2 * t / (1 + np.dot(t, t) * (1 + mistake)))
    v = v + h / 2 * np.array([-x[0], -2 * x[1], 0.5 * x[2]])
    return v, x + h / 2 * v


def push_wrong(v, x, h):
    return push(v, x, h, 1e-3)


def leapfrog(v, x, h):
    """Of Hamiltonian Monte Carlo."""

    def slope(x):
        return np.array([x[0] + x[0] * x[1] ** 2 / 10, 2 * x[1] + x[0] ** 2 * x[1] / 10])

    v = v - h / 2 * slope(x)
    x = x + h * v
    return v - h / 2 * slope(x), x


def leapfrog_wrong(v, x, h):
    v, x = leapfrog(v, x, h)
    return v, x * (1 + 1e-7 * h)


def body(z, h):
    x, y, w = z

    def turned(a, b, angle):
        c, s = np.cos(angle), np.sin(angle)
        return c * a - s * b, s * a + c * b

    y, w = turned(y, w, -h * x / 2)
    w, x = turned(w, x, -h * y / 4)
    x, y = turned(x, y, -h * w / 3)
    w, x = turned(w, x, -h * y / 4)
    y, w = turned(y, w, -h * x / 2)
    return np.array([x, y, w])


def body_wrong(z, h):
    x, y, w = body(z, h)
    return np.array([x, y, w * (1 + 1e-6 * h)])


def two(v, x, h=0.1):
    def slope(x):
        f = np.sin(x[1] - x[0])
        return np.array([f, -f]) / MASSES

    v = v + h / 2 * slope(x)
    x = x + h * v
    return v + h / 2 * slope(x), x


def flow_of_abc(z, h=0.1):
    x, y, w = z
    x = x + h * (np.sin(w) + np.cos(y))
    y = y + h * (np.sin(x) + np.cos(w))
    return np.array([x, y, w + h * (np.sin(y) + np.cos(x))])


def compared(step: Step) -> Step:
    """The same step, which compares numbers, so that it is measured with dual numbers."""

    def comparing(z: Sequence[Any], h: Any) -> Any:
        return step(z, h) if z[0] < 1e300 else z

    return comparing


def packed(step: Step) -> Step:
    """The same step, which takes floats alone."""

    def packing(z: Sequence[Any], h: Any) -> Any:
        code = f"{len(z)}d"
        return step(list(struct.unpack(code, struct.pack(code, *z))), h)

    return packing


def in_units(step: Step, halves: int, unit: float) -> Step:
    """Return z, h ↦ z' of a step that takes `halves` arguments beside h, in other units."""

    def scaled(z: Sequence[Any], h: Any) -> Any:
        parts = np.array([x / unit for x in z])
        if halves == 1:
            end = step(parts, h)
        elif len(z) == halves:
            end = step(*parts, h)
        else:
            end = step(*parts.reshape(halves, -1), h)
        return [x * unit for part in end for x in np.atleast_1d(part)]

    return scaled
