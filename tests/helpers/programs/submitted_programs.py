"""Programs of other people in doubles, as they would write them; and mistakes.

One is of Duffing's oscillator, one of Hénon and Heiles' two degrees of freedom. Nothing here is
taken from the toolkit: schemes are written out by hand, J is made of their derivatives, and areas
are a d − b c.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

STEPS = (0, 1, 10, 100)
State = tuple[Any, Any]
Entries = tuple[Any, Any, Any, Any]  # ∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q


def lie2(p: Any, q: Any, h: Any, d: Any) -> tuple[State, Entries]:
    f, g = -q - d * q * q * q, -1 - 3 * d * q * q
    state = p + h * f + h * h / 2 * g * p, q + h * p + h * h / 2 * f
    return state, (1 + h * h / 2 * g, h * g - 3 * d * h * h * q * p, h, 1 + h * h / 2 * g)


def lie1(p: Any, q: Any, h: Any, d: Any) -> tuple[State, Entries]:
    return (p - h * (q + d * q**3), q + h * p), (1, -h * (1 + 3 * d * q * q), h, 1)


def lie3(p: Any, q: Any, h: Any, d: Any) -> tuple[State, Entries]:
    f, g = -q - d * q**3, -1 - 3 * d * q * q
    (p2, q2), entries = lie2(p, q, h, d)
    return (p2 + h**3 / 6 * (g * f - 6 * d * q * p * p), q2 + h**3 / 6 * g * p), entries


def kick_first(p: Any, q: Any, h: Any, d: Any) -> tuple[State, Entries]:
    p = p - h * (q + d * q**3)
    g = -1 - 3 * d * q * q
    return (p, q + h * p), (1, h * g, h, 1 + h * h * g)


def drift_first(p: Any, q: Any, h: Any, d: Any) -> tuple[State, Entries]:
    q = q + h * p
    g = -1 - 3 * d * q * q
    return (p - h * (q + d * q**3), q), (1 + h * h * g, h * g, h, 1)


def drift_kick_drift(p: Any, q: Any, h: Any, d: Any) -> tuple[State, Entries]:
    q = q + h / 2 * p
    p = p - h * (q + d * q**3)
    return (p, q + h / 2 * p), (1, 0, 0, 1)


def kick_drift_kick(p: Any, q: Any, h: Any, d: Any) -> tuple[State, Entries]:
    p = p - h / 2 * (q + d * q**3)
    q = q + h * p
    return (p - h / 2 * (q + d * q**3), q), (1, 0, 0, 1)


@dataclass(frozen=True)
class Areas:
    """What a program has summed up before step `n`, and det J of it and of those beside it."""

    n: int
    product: Any
    squares: Any
    total: Any
    now: Any
    before: Any
    first: Any
    after: Any


@dataclass(frozen=True)
class Program:
    """Steps from (q, p), and prints a table with what it holds for each number."""

    step: Callable[..., tuple[State, Entries]] = lie2
    h: Any = 0.01
    q: Any = 1.5
    p: Any = 0.0
    d: Any = 1.0
    late: int = 0
    shown: Callable[[State], State] = lambda z: z
    number: Callable[[Any], str] = repr
    delta_j: Callable[[Areas], Any] | None = None
    mse: Callable[[Areas], Any] | None = None
    lam: Callable[[Areas], Any] | None = None

    def changed(self, **what: Any) -> "Program":
        return replace(self, **what)

    def rows(self, steps: Sequence[int] = STEPS) -> Iterator[str]:
        """The table's lines, the header first; row N is of the step N + `late`."""
        asked = [(n, f) for n, f in self._asked().items() if f]
        yield ",".join(["step", "p", "q", *(n for n, _ in asked)])
        z, product, squares, total, before, first = (self.p, self.q), 1.0, 0.0, 0.0, 1.0, 1.0
        for n in range(max(steps) + max(self.late, 0) + 1):
            after, (a, b, c, d) = self.step(*z, self.h, self.d)
            now = a * d - b * c
            first = now if n == 0 else first
            if n - self.late in steps:
                e, f, g, i = self.step(*after, self.h, self.d)[1]
                areas = Areas(n, product, squares, total, now, before, first, e * i - f * g)
                values = [*self.shown(z), *(f(areas) for _, f in asked)]
                cells = ("" if x is None else self.number(x) for x in values)
                yield ",".join([str(n - self.late), *cells])
            product, squares, total = product * now, squares + (now - 1) ** 2, total + (now - 1)
            z, before = after, now

    def _asked(self) -> dict[str, Callable[[Areas], Any] | None]:
        return {"delta_j": self.delta_j, "mse": self.mse, "lambda": self.lam}

    def table(self, steps: Sequence[int] = STEPS) -> str:
        return "\n".join(self.rows(steps)) + "\n"


OMEGA = np.kron([[0, 1], [-1, 0]], np.eye(2))


@dataclass(frozen=True)
class HeilesProgram:
    """lie2 for Hénon and Heiles, with W and Λ from the entries of its Jacobians.

    `sign`: of p as it is printed. `off`: by what share the state is. `less`: what is taken away
    from the product of the determinants.
    """

    columns: str = "p1,p2,q1,q2"
    sign: int = 1
    late: int = 0
    off: float = 0.0
    eta: int = 2
    less: float = 1.0

    def changed(self, **what: Any) -> "HeilesProgram":
        return replace(self, **what)

    def table(self, steps: Sequence[int] = range(22)) -> str:
        z, m, largest, volume = np.array([0, 1 / 3, 0.3, 0.1]), np.eye(4), 0.0, 1.0
        lines = [f"step,{self.columns},energy,symplectic_defect_max,symplectic_defect,lambda"]
        for n in range(max(steps) + self.late + 1):
            p1, p2, q1, q2 = z
            energy = (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3
            state = z * [self.sign, self.sign, 1, 1] * (1 + self.off)
            shown = [*state, energy, largest, defect(m), volume - self.less]
            cells = [f"{x:.17g}" for x in shown]
            cells[5] = cells[5] if n else ""
            if n - self.late in steps:
                lines.append(",".join([str(n - self.late), *cells]))
            z, j = self._step(z)
            largest = max(largest, defect(j))
            m, volume = j @ m, volume * np.linalg.det(j)
        return "\n".join(lines) + "\n"

    def _step(self, z: Any) -> tuple[Any, Any]:
        h, (p1, p2, q1, q2) = 0.05, z
        f = np.array([-(q1 + 2 * q1 * q2), -(q2 + q1**2 - q2**2), p1, p2])
        a = np.array([[0, 0, -(1 + 2 * q2), -2 * q1], [0, 0, -2 * q1, -(1 - 2 * q2)],
                      [1, 0, 0, 0], [0, 1, 0, 0]])  # fmt: skip
        b = np.array([[0, 0, -2 * p2, -2 * p1], [0, 0, -2 * p1, 2 * p2],
                      [0, 0, 0, 0], [0, 0, 0, 0]])  # fmt: skip
        second = h * h / 2 if self.eta == 2 else 0.0
        return z + h * f + second * (a @ f), np.eye(4) + h * a + second * (a @ a + b)


def defect(j: Any) -> Any:
    """The greatest |entry| of JᵀΩJ − Ω."""
    return np.abs(j.T @ OMEGA @ j - OMEGA).max()
