"""The chain W₀ … W₄ in n degrees of freedom: mpmath at 80 digits, derivatives by hand.

Shares with `verify` the float64 step alone, whose operations are what is examined; they are done
one by one in Python here, and products of float64 matrices are exact Fractions.

The scheme is lie2 for H = Σ p²/2 + V(q, t): with F = −V_q, q' = q + h p + h² F/2 and
p' = p + h F + h² (F_t + F_q p)/2.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, pairwise
from typing import Any

import mpmath

from verify import arithmetic as number_systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.studies.separation.matrix_products import Matrices

MP = mpmath.MPContext()
MP.dps = 80
Vector = list[Any]
Matrix = list[list[Any]]
LINKS = ("exact", "rounded", "clock", "trajectory")


@dataclass(frozen=True)
class Potential:
    """F, F_t, F_q and Σ_k p_k ∂F_q/∂q_k, and F_qt, as functions of (q, p, t)."""

    force: Callable[..., Vector]
    by_time: Callable[..., Vector]
    slope: Callable[..., Matrix]
    along: Callable[..., Matrix]
    slope_by_time: Callable[..., Matrix]


def henon_heiles(epsilon: Any = 0, omega: Any = 0) -> Potential:
    """V = (q1² + q2²)/2 + q1² q2 − q2³/3 − ε q1 cos ωt."""

    def force(q: Vector, _: Vector, t: Any) -> Vector:
        x, y = q
        return [-x - 2 * x * y + epsilon * MP.cos(omega * t), -y - x * x + y * y]

    return Potential(
        force,
        lambda q, p, t: [-epsilon * omega * MP.sin(omega * t), MP.mpf(0)],
        lambda q, p, t: [[-1 - 2 * q[1], -2 * q[0]], [-2 * q[0], -1 + 2 * q[1]]],
        lambda q, p, t: [[-2 * p[1], -2 * p[0]], [-2 * p[0], 2 * p[1]]],
        lambda q, p, t: [[MP.mpf(0)] * 2] * 2,
    )


def chain(alpha: Any, beta: Any, n: int) -> Potential:
    """V = Σ φ(q_(i+1) − q_i) with fixed ends, φ(d) = d²/2 + α d³/3 + β d⁴/4."""

    def springs(q: Vector, of: Callable[[Any], Any]) -> Vector:
        ends = [MP.mpf(0), *q, MP.mpf(0)]
        return [of(b - a) for a, b in pairwise(ends)]

    def tridiagonal(s: Vector) -> Matrix:
        made = [[MP.mpf(0)] * n for _ in range(n)]
        for i in range(n):
            made[i][i] = -s[i] - s[i + 1]
            if i + 1 < n:
                made[i][i + 1] = made[i + 1][i] = s[i + 1]
        return made

    def force(q: Vector, _: Vector, t: Any) -> Vector:
        s = springs(q, lambda d: d + alpha * d**2 + beta * d**3)
        return [s[i + 1] - s[i] for i in range(n)]

    def along(q: Vector, p: Vector, t: Any) -> Matrix:
        third = springs(q, lambda d: 2 * alpha + 6 * beta * d)
        moved = springs(p, lambda d: d)
        return tridiagonal([a * b for a, b in zip(third, moved, strict=True)])

    return Potential(
        force,
        lambda q, p, t: [MP.mpf(0)] * n,
        lambda q, p, t: tridiagonal(springs(q, lambda d: 1 + 2 * alpha * d + 3 * beta * d**2)),
        along,
        lambda q, p, t: [[MP.mpf(0)] * n] * n,
    )


def lie2(v: Potential, z: Vector, h: Any, t: Any) -> tuple[Vector, Matrix]:
    """z' and J of one step; z is p1 … pn, q1 … qn."""
    n = len(z) // 2
    p, q, every = z[:n], z[n:], range(n)
    f, df = v.force(q, p, t), v.slope(q, p, t)
    change = [a + sum(df[i][k] * p[k] for k in every) for i, a in enumerate(v.by_time(q, p, t))]
    along, by_time = v.along(q, p, t), v.slope_by_time(q, p, t)
    z_next = [p[i] + h * f[i] + h * h * change[i] / 2 for i in every]
    z_next += [q[i] + h * p[i] + h * h * f[i] / 2 for i in every]
    one = [[int(i == j) for j in every] for i in every]
    top = [
        [one[i][j] + h * h * df[i][j] / 2 for j in every]
        + [h * df[i][j] + h * h * (along[i][j] + by_time[i][j]) / 2 for j in every]
        for i in every
    ]
    low = [
        [h * one[i][j] for j in every] + [one[i][j] + h * h * df[i][j] / 2 for j in every]
        for i in every
    ]
    return z_next, [*top, *low]


def product(a: Matrix, b: Matrix) -> Matrix:
    columns = list(zip(*b, strict=True))
    return [[sum(x * y for x, y in zip(r, c, strict=True)) for c in columns] for r in a]


def identity(size: int) -> Matrix:
    return [[int(a == b) for b in range(size)] for a in range(size)]


def pulled_back(m: Matrix) -> dict[tuple[int, int], Any]:
    """MᵀΩM − Ω above the diagonal, Ω = Σ dp_i∧dq_i."""
    n, found = len(m) // 2, {}
    for a, b in combinations(range(2 * n), 2):
        areas = (m[i][a] * m[n + i][b] - m[n + i][a] * m[i][b] for i in range(n))
        found[a, b] = sum(areas) - (1 if b == a + n else 0)
    return found


def exact_w(
    v: Potential, z: Sequence[Any], h: Any, times: Sequence[Any], states: Sequence[Vector] = ()
) -> dict[tuple[int, int], Any]:
    """W after a step at each of the times, from z; or with the Jacobians at these states."""
    m, z = identity(len(z)), list(z)
    for k, t in enumerate(times):
        at = list(map(MP.mpf, states[k])) if states else z
        z, j = lie2(v, at, h, t)
        m = product(j, m)
    return pulled_back(m)


# -- float64 ----------------------------------------------------------------------------------


class Float64Step:
    """The float64 step of a scheme, its operations done one by one in Python."""

    def __init__(self, exact: Hamiltonian, scheme: str, h: float) -> None:
        self.exact, self.h = exact.with_symbols(), h
        self.given = {name: float(value) for name, value in exact.values}
        step_map, size = step_map_of(self.exact, scheme), len(exact.coordinates)
        working = number_systems.get("float64", 17)
        self.step = Matrices(size).step(step_map, working, exactly=False)

    def values(self, inputs: dict[str, float]) -> list[float]:
        import math

        found: list[Any] = []
        for op in self.step.program.ops:
            x = [found[a] for a in op.args]
            match op.kind:
                case "input":
                    found.append(inputs.get(op.name, 0.0))
                case "const":
                    found.append(float(op.value))
                case "add":
                    found.append(x[0] + x[1])
                case "sub":
                    found.append(x[0] - x[1])
                case "mul":
                    found.append(x[0] * x[1])
                case "neg":
                    found.append(-x[0])
                case "call" if op.function.name in ("sin", "cos"):
                    found.append(getattr(math, op.function.name)(x[0]))
                case _:
                    raise NotImplementedError(op.kind)
        return found

    def run(self, z: Sequence[float], t0: float, steps: int) -> "Float64Run":
        step, size = self.step, len(z)
        given = {"h": self.h} | {f"x{k}": self.given[n] for k, n in enumerate(step.parameters)}
        state, t, run = list(z), t0, Float64Run([], [], [], [], [], {})
        m = [[float(a == b) for b in range(size)] for a in range(size)]
        w = dict.fromkeys(combinations(range(size), 2), 0.0)
        for _ in range(steps):
            carried = {f"m_{a}_{b}": m[a][b] for a in range(size) for b in range(size)}
            found = self.values(
                {**given, **carried, "t": t, **dict(zip(step.coordinates, state, strict=True))}
            )
            k = [[found[at] for at in row] for row in step.slopes]
            run.states.append(state)
            run.times.append(t)
            run.slopes.append(k)
            run.defects.append(
                {tuple(map(int, n.split("_")[1:])): found[at] for n, at in step.defect.items()}
            )
            j = [[1.0 + x if a == b else x for b, x in enumerate(row)] for a, row in enumerate(k)]
            run.jacobians.append(j)
            if step.defect:
                for a, b in w:
                    w[a, b] += found[step.outputs[f"dw_{a}_{b}"]]
                m = [
                    [m[a][b] + found[step.outputs[f"dm_{a}_{b}"]] for b in range(size)]
                    for a in range(size)
                ]
            change = [found[step.outputs[f"d{n}"]] for n in step.coordinates]
            state, t = [a + b for a, b in zip(state, change, strict=True)], t + self.h
        run.closed.update(w)
        return run


@dataclass(frozen=True)
class Float64Run:
    """What float64 had at every step, and its W of the closed form at the end."""

    states: list[Vector]
    times: list[float]
    slopes: list[Matrix]
    jacobians: list[Matrix]
    defects: list[dict[tuple[int, ...], float]]
    closed: dict[tuple[int, int], float]

    def plain(self, exactly: bool) -> dict[tuple[int, int], Any]:
        """MᵀΩM − Ω of float64's Jacobians, exactly or in float64 throughout."""
        of = Fraction if exactly else float
        m = [[of(x) for x in row] for row in identity(len(self.states[0]))]
        for j in self.jacobians:
            m = product([[of(x) for x in row] for row in j], m)
        return pulled_back_in_order(m) if not exactly else pulled_back(m)

    def closed_exactly(self) -> dict[tuple[int, int], Fraction]:
        """Σ MᵀSM of float64's S and K, exactly."""
        size = len(self.states[0])
        m = [[Fraction(x) for x in row] for row in identity(size)]
        w = dict.fromkeys(combinations(range(size), 2), Fraction(0))
        for k, s in zip(self.slopes, self.defects, strict=True):
            for a, b in w:
                for (c, d), x in s.items():
                    w[a, b] += Fraction(x) * (m[c][a] * m[d][b] - m[d][a] * m[c][b])
            j = [[Fraction(x) + int(a == b) for b, x in enumerate(r)] for a, r in enumerate(k)]
            m = product(j, m)
        return w


def pulled_back_in_order(m: Matrix) -> dict[tuple[int, int], float]:
    """The same in float64: 2n products from the left, and 1 taken off last."""
    n, found = len(m) // 2, {}
    for a, b in combinations(range(2 * n), 2):
        total = m[0][a] * m[n][b] - m[n][a] * m[0][b]
        for i in range(1, n):
            total = total + m[i][a] * m[n + i][b]
            total = total - m[n + i][a] * m[i][b]
        found[a, b] = total - 1.0 if b == a + n else total
    return found
