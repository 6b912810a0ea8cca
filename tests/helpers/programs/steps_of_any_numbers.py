"""One-step methods for z' = f(z), of floats and of mpmath's numbers alike."""

import math
from collections.abc import Callable, Sequence
from typing import Any

Vector = list[Any]
Field = Callable[[Vector], Vector]
Method = Callable[[Any, Field, Vector, Any], Vector]  # of math or mpmath's context, f, z, h


def plus(z: Vector, c: Any, k: Vector, places: Sequence[int] | None = None) -> Vector:
    return [x + c * y if places is None or i in places else x
            for i, (x, y) in enumerate(zip(z, k, strict=True))]  # fmt: skip


def split(*parts: tuple[str, int, int]) -> Method:
    """Kicks of the first half and drifts of the second, each by a ratio of h."""

    def step(_: Any, f: Field, z: Vector, h: Any) -> Vector:
        n = len(z) // 2
        for kind, above, below in parts:
            z = plus(z, h * above / below, f(z), range(n) if kind == "k" else range(n, 2 * n))
        return z

    return step


def euler(_: Any, f: Field, z: Vector, h: Any) -> Vector:
    return plus(z, h, f(z))


def rk4(_: Any, f: Field, z: Vector, h: Any) -> Vector:
    a = f(z)
    b = f(plus(z, h / 2, a))
    c = f(plus(z, h / 2, b))
    d = f(plus(z, h, c))
    return plus(plus(plus(plus(z, h / 6, a), h / 3, b), h / 3, c), h / 6, d)


def midpoint(numbers: Any, f: Field, z: Vector, h: Any) -> Vector:
    """To the last digit, or 100 turns of floats."""
    end, turns = z, 100 if numbers is math else 2000
    for _ in range(turns):
        last, end = end, plus(z, h, f([(x + y) / 2 for x, y in zip(z, end, strict=True)]))
        if all(abs(x - y) <= abs(x) * (0 if numbers is math else numbers.mpf(10) ** -245)
               for x, y in zip(last, end, strict=True)):  # fmt: skip
            break
    return end


def lotka(_: Any, f: Field, z: Vector, h: Any) -> Vector:
    u, v = z
    u = u / (1 - h * (v - 2))
    return [u, v + h * v * (1 - u)]


def body(_: Any, f: Field, z: Vector, h: Any) -> Vector:
    """Turns about the axes, in turn, each by an angle of its own coordinate."""
    z = list(z)
    for a, b, c in ((1, 2, 0), (2, 0, 1), (1, 2, 0)):
        t = -h * z[c] / 24
        cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
        z[a], z[b] = cosine * z[a] - sine * z[b], sine * z[a] + cosine * z[b]
    return z


def damped(numbers: Any, f: Field, z: Vector, h: Any) -> Vector:
    v, x = z
    x = x + h / 2 * v
    v = (v - h * (x + x * x * x)) * numbers.exp(-h / 8)
    return [v, x + h / 2 * v]


SPLIT = {
    name: split(*[(part[0], *map(int, part[1:].split("/"))) for part in parts.split()])
    for name, parts in {
        "verlet": "k1/2 d1/1 k1/2",
        "position-verlet": "d1/2 k1/1 d1/2",
        "symplectic-euler": "k1/1 d1/1",
        "ruth3": "k7/24 d2/3 k3/4 d-2/3 k-1/24 d1/1",
        "uneven": "k501/1000 d1/1 k499/1000",
    }.items()
}
PLAIN = {"euler": euler, "rk4": rk4, "implicit-midpoint": midpoint}
