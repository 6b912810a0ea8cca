"""Maps of the plane in any arithmetic, their derivatives by dual numbers, and runs of them.

Nothing here is taken from the toolkit: formulas are those that the paper prints.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

Pair = tuple[Any, Any]  # p, q
Map = Callable[[Any, Any], Pair]


@dataclass(frozen=True)
class Dual:
    """a + b ε + c η, ε² = η² = εη = 0: a value with its derivatives by p and by q."""

    value: Any
    by_p: Any = 0
    by_q: Any = 0

    def __add__(self, other: Any) -> "Dual":
        o = _dual(other)
        return Dual(self.value + o.value, self.by_p + o.by_p, self.by_q + o.by_q)

    def __mul__(self, other: Any) -> "Dual":
        o, a = _dual(other), self.value
        return Dual(a * o.value, a * o.by_p + self.by_p * o.value, a * o.by_q + self.by_q * o.value)

    def __neg__(self) -> "Dual":
        return self * -1

    def __sub__(self, other: Any) -> "Dual":
        return self + -_dual(other)

    def __rsub__(self, other: Any) -> "Dual":
        return _dual(other) - self

    def __pow__(self, power: int) -> "Dual":
        return math.prod((self for _ in range(power)), start=Dual(1))

    __radd__ = __add__
    __rmul__ = __mul__


def _dual(x: Any) -> Dual:
    return x if isinstance(x, Dual) else Dual(x)


def sin_cos(x: Any) -> tuple[Any, Any]:
    """Of a float, or a dual number of floats."""
    if not isinstance(x, Dual):
        return math.sin(x), math.cos(x)
    s, c = math.sin(x.value), math.cos(x.value)
    return Dual(s, c * x.by_p, c * x.by_q), Dual(c, -s * x.by_p, -s * x.by_q)


def jacobian(step: Map, p: Any, q: Any) -> tuple[Pair, Pair]:
    """Rows of p' and q'."""
    new_p, new_q = step(Dual(p, 1, 0), Dual(q, 0, 1))
    return (new_p.by_p, new_p.by_q), (new_q.by_p, new_q.by_q)


def determinant(step: Map, p: Any, q: Any) -> Any:
    (a, b), (c, d) = jacobian(step, p, q)
    return a * d - b * c


# -- the paper's schemes ---------------------------------------------------------------------------


def duffing(h: Any, delta: Any = 1) -> Map:
    """Eq. 19."""

    def step(p: Any, q: Any) -> Pair:
        force = q + delta * q**3
        return p - h * force - h * h / 2 * p * (1 + 3 * delta * q**2), q + h * p - h * h / 2 * force

    return step


def pendulum(h: float) -> Map:
    """Eq. 27."""

    def step(p: Any, q: Any) -> Pair:
        s, c = sin_cos(q)
        return p - h * s - h * h / 2 * p * c, q + h * p - h * h / 2 * s

    return step


def symplectic_euler(h: Any, delta: Any = 1) -> Map:
    """Eq. 24."""

    def step(p: Any, q: Any) -> Pair:
        p = p - h * (q + delta * q**3)
        return p, q + h * p

    return step


def level_map(h: Any) -> Map:
    """lie2 of H = −u + u²/2, u = q − p³: p moves by v = 1 − u, and q by 3p²v and 6pv² of X²."""

    def step(p: Any, q: Any) -> Pair:
        v = 1 - q + p**3
        return p + h * v, q + 3 * h * p**2 * v + 3 * h * h * p * v**2

    return step


# -- runs ------------------------------------------------------------------------------------------


def states(step: Map, p: Any, q: Any, steps: int) -> list[Pair]:
    """Of all steps, the first included."""
    orbit = [(p, q)]
    for _ in range(steps):
        orbit.append(step(*orbit[-1]))
    return orbit


def defects(step: Map, p: Any, q: Any, steps: int) -> list[Any]:
    """ΔJ of every step."""
    return [determinant(step, *z) - 1 for z in states(step, p, q, steps)[:-1]]


def mse(changes: list[Any]) -> Any:
    return sum(x * x for x in changes) / len(changes)


def total(changes: list[Any]) -> Any:
    """Λ."""
    return math.prod((1 + x for x in changes), start=Fraction(1)) - 1
