"""Orders of steps of H(p, q, t) by their series in h, in fractions at points, without the toolkit.

A step and the exact flow are made as truncated power series in h; the flow by Picard's iteration.
"""

import random
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

F = Fraction
Series = list[Fraction]
Polynomial = dict[tuple[int, int, int], Fraction]  # of powers of p, q and t
_ONE = F(1)


def times(x: Series, y: Series) -> Series:
    total = [F(0)] * len(x)
    for i, a in enumerate(x):
        if a:
            for j, b in enumerate(y[: len(x) - i]):
                if b:
                    total[i + j] += a * b
    return total


def derivative(h: Polynomial, by: int) -> Polynomial:
    found = {}
    for powers, c in h.items():
        if powers[by]:
            lower = tuple(n - (k == by) for k, n in enumerate(powers))
            found[lower] = c * powers[by]
    return found


def value(h: Polynomial, at: Sequence[Series]) -> Series:
    most = len(at[0])
    one = [F(1), *[F(0)] * (most - 1)]
    tables = []
    for by, x in enumerate(at):
        table = [one]
        for _ in range(max((powers[by] for powers in h), default=0)):
            table.append(times(table[-1], x))
        tables.append(table)
    of_time: dict[tuple[int, int], Series] = {}  # what stands before each pⁱ qʲ
    for (i, j, k), c in h.items():
        before = of_time.setdefault((i, j), [F(0)] * most)
        of_time[i, j] = [a + c * b if b else a for a, b in zip(before, tables[2][k], strict=True)]
    total = [F(0)] * most
    for (i, j), term in of_time.items():
        for table, n in zip(tables, (i, j), strict=False):
            if n:
                term = times(term, table[n])
        total = [a + b for a, b in zip(total, term, strict=True)]
    return total


@dataclass(frozen=True)
class Problem:
    """H with its gradient, and a point (p, q, t)."""

    h_p: Polynomial
    h_q: Polynomial
    start: tuple[Fraction, Fraction, Fraction]

    def slope(self, at: Sequence[Series]) -> tuple[Series, Series]:
        return [-x for x in value(self.h_q, at)], value(self.h_p, at)


def problem(seed: int, kind: str) -> Problem:
    """A random polynomial H: "general" T(p, t) + V(q, t), "autonomous" T(p) + V, "mass" m(t) p²
    + V, "quadratic" 3 p²/2 + V, or "any" H(p, q, t)."""
    drawn = random.Random(seed)  # noqa: S311

    def some(powers: Sequence[tuple[int, int, int]]) -> Polynomial:
        return {x: F(drawn.choice((-5, -3, -2, -1, 1, 2, 3, 4))) for x in powers}

    h = some([(0, j, k) for j in range(1, 6) for k in range(4)])
    h |= {
        "general": lambda: some([(i, 0, k) for i in range(1, 6) for k in range(4)]),
        "autonomous": lambda: some([(i, 0, 0) for i in range(1, 6)]),
        "mass": lambda: some([(2, 0, k) for k in range(5)]),
        "quadratic": lambda: {(2, 0, 0): F(3, 2)},
        "any": lambda: some([(i, j, k) for i in range(4) for j in range(4) for k in range(3)
                             if 1 <= i + j <= 4 and i]),
    }[kind]()  # fmt: skip
    start = tuple(F(drawn.randint(-9, 9), 7) + F(1, 11) for _ in range(3))
    return Problem(derivative(h, 0), derivative(h, 1), (start[0], start[1], start[2]))


def constant(x: Fraction, most: int) -> Series:
    return [x, *[F(0)] * most]


def moved(x: Series, slope: Series, share: Fraction = _ONE) -> Series:
    """x + share h slope."""
    return [a + share * b for a, b in zip(x, [F(0), *slope[:-1]], strict=True)]


def clock(at: Problem, share: Fraction, most: int) -> Series:
    """t + share h."""
    return moved(constant(at.start[2], most), constant(F(1), most), share)


def flow(at: Problem, most: int) -> tuple[Series, Series]:
    p, q = (constant(x, most) for x in at.start[:2])
    t = clock(at, F(1), most)
    for _ in range(most):
        u, v = at.slope((p, q, t))
        p, q = (
            [x, *(c / (n + 1) for n, c in enumerate(slope[:-1]))]
            for x, slope in zip(at.start[:2], (u, v), strict=True)
        )
    return p, q


def splitting_step(
    at: Problem, parts: Sequence[tuple[str, Fraction, Fraction]], most: int
) -> tuple[Series, Series]:
    """Of (kick or drift, size, time)."""
    p, q = (constant(x, most) for x in at.start[:2])
    for kind, size, time in parts:
        force, speed = at.slope((p, q, clock(at, time, most)))
        p, q = (moved(p, force, size), q) if kind == "kick" else (p, moved(q, speed, size))
    return p, q


def runge_kutta_step(
    at: Problem,
    rows: Sequence[Sequence[Fraction]],
    weights: Sequence[Fraction],
    stage_times: Sequence[Fraction],
    most: int,
) -> tuple[Series, Series]:
    """Implicit ones as well, by iteration."""

    def sums(row: Sequence[Fraction], slopes: Sequence[tuple[Series, Series]]):
        p, q = (constant(x, most) for x in at.start[:2])
        for a, (u, v) in zip(row, slopes, strict=True):
            p, q = moved(p, u, a), moved(q, v, a)
        return p, q

    slopes = [(constant(F(0), most), constant(F(0), most))] * len(weights)
    for _ in range(most):
        slopes = [
            at.slope((*sums(row, slopes), clock(at, c, most)))
            for row, c in zip(rows, stage_times, strict=True)
        ]
    return sums(weights, slopes)


def agreement(step: tuple[Series, Series], exact: tuple[Series, Series]) -> int:
    """The power of h up to which both are the same."""
    most = len(exact[0])
    differ = (n for n in range(most) if any(x[n] != y[n] for x, y in zip(step, exact, strict=True)))
    return next(differ, most) - 1
