"""A second look at a printed table: its steps in high precision, against the solution by mpmath.

It shares no code with the conditions that tables are judged by: the step is carried out as its
library does, and the solution is Taylor's, by `mpmath.odefun`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import singledispatch
from itertools import pairwise
from typing import Any

import mpmath as mp
import sympy

from verify.integrators.tables.entry import Naming, TableEntry
from verify.integrators.tables.kinds import additive, composition, partitioned, runge_kutta
from verify.integrators.tables.splittings.claims import AlternatingEntry, parts_of
from verify.integrators.tables.tableaux.blocks import Block, block_of

_DIGITS = 60
_SIZES = tuple(mp.mpf(1) / 2**k for k in range(4, 8))
_TURNS = 80  # of a fixed point: with h ≤ 1/16 each gains more than a digit
_WITHIN = 0.25  # of a whole power
Vector = list[Any]
Field = Callable[[Any, Any], Any]


@dataclass(frozen=True)
class System:
    """H = a(t) T(p) + b(t) V(q), by T', V' and the two factors."""

    said: str
    speed: Callable[[Any], Any]
    slope: Callable[[Any], Any]
    a: Callable[[Any], Any] = lambda t: mp.mpf(1)
    b: Callable[[Any], Any] = lambda t: mp.mpf(1)

    def kick(self, t: Any, p: Any, q: Any) -> Any:
        """p' at that time."""
        return -self.b(t) * self.slope(q)

    def drift(self, t: Any, p: Any, q: Any) -> Any:
        """q' at that time."""
        return self.a(t) * self.speed(p)


def _cubic(p: Any) -> Any:
    return p + p**3


_QUADRATIC = "p²/2"
_QUARTIC = "p²/2 + p⁴/4"


def systems(timed: bool, quadratic: bool) -> tuple[System, System]:
    """A pendulum, and an oscillator of degree 4; with a kinetic energy of degree 4 for methods of
    any T(p); driven, where a time is judged."""
    speed = mp.mpf if quadratic else _cubic
    kinetic = _QUADRATIC if quadratic else _QUARTIC
    rate = (lambda t: 1 + mp.cos(2 * t) / 2) if timed else (lambda t: mp.mpf(1))
    said = "(1 + cos(2t)/2) " if timed else ""
    return (
        System(f"H = {kinetic} − {said}cos q", speed, mp.sin, b=rate),
        System(f"H = {kinetic} + {said}(q²/2 + q⁴/4)", speed, _cubic, b=rate),
    )


@dataclass(frozen=True)
class Slopes:
    """Of one system: the errors of one step of these sizes, and the order that they show, or None
    where no whole power is seen."""

    said: str
    sizes: tuple[float, ...]
    errors: tuple[float, ...]
    order: int | None


def slopes_of(entry: TableEntry, timed: bool, embedded: bool = False) -> tuple[Slopes, Slopes]:
    """Of the table as it is printed, at both systems. `embedded`: with its embedded weights."""
    with mp.workdps(_DIGITS):
        step = _step(entry, embedded)
        found = tuple(_of(system, step) for system in systems(timed, entry.kind == "nystrom"))
    return found[0], found[1]


def _of(system: System, step: Callable[[System, Any, Any, Any, Any], Vector]) -> Slopes:
    t, p, q = mp.mpf(3) / 4, mp.mpf(1) / 3, mp.mpf(3) / 5
    flow = mp.odefun(
        lambda s, z: [system.kick(s, *z), system.drift(s, *z)], t, [p, q], tol=mp.mpf(10) ** -45
    )
    errors = []
    for h in _SIZES:
        there = step(system, t, p, q, h)
        errors.append(max(abs(x - y) for x, y in zip(there, flow(t + h), strict=True)))
    powers = [float(mp.log(x / y, 2)) for x, y in pairwise(errors) if x and y]
    return Slopes(system.said, tuple(map(float, _SIZES)), tuple(map(float, errors)), _order(powers))


def _order(powers: Sequence[float]) -> int | None:
    if len(powers) < 2 or any(abs(x - round(powers[-1])) > _WITHIN for x in powers[-2:]):
        return None
    return round(powers[-1]) - 1


# -- one step, by the kind of its table -----------------------------------------------------------

Step = Callable[[System, Any, Any, Any, Any], Vector]


@singledispatch
def _step(entry: TableEntry, embedded: bool) -> Step:
    raise TypeError(f"{entry.name}: no step is made of a {entry.kind}")


def _numbers(naming: Naming, texts: Sequence[str]) -> Vector:
    printed = naming.printed
    exact = (printed.at_print(printed.entry(text)) for text in texts)
    return [mp.mpf(str(sympy.N(x, _DIGITS + 10))) for x in exact]


@_step.register
def _(entry: AlternatingEntry, embedded: bool) -> Step:
    naming = Naming(entry.numbers)
    kinds, sizes, times = parts_of(entry, naming)
    own = _numbers(naming, sizes)
    told = _numbers(naming, [x or "0" for x in times or ["0"] * len(own)])

    def step(system: System, t: Any, p: Any, q: Any, h: Any) -> Vector:
        for kind, size, moment in zip(kinds, own, told, strict=True):
            if kind == "kick":
                p += size * h * system.kick(t + moment * h, p, q)
            else:
                q += size * h * system.drift(t + moment * h, p, q)
        return [p, q]

    return step


@_step.register
def _(entry: composition.Entry, embedded: bool) -> Step:
    naming = Naming(entry.numbers)
    half = entry.half is not None
    sizes = [*(entry.sizes or entry.half or ())]
    named = naming.entries([*sizes, *sizes[-2::-1]] if half else sizes, "w")
    weights = _numbers(naming, named)

    def step(system: System, t: Any, p: Any, q: Any, h: Any) -> Vector:
        for w in weights:
            p += w * h / 2 * system.kick(t, p, q)
            q += w * h * system.drift(t, p, q)
            t += w * h
            p += w * h / 2 * system.kick(t, p, q)
        return [p, q]

    return step


@_step.register
def _(entry: runge_kutta.Entry, embedded: bool) -> Step:
    block = Block(a=entry.a, b=entry.b, c=entry.c, embedded=entry.embedded,
                  tableau=entry.tableau, csv=entry.csv)  # fmt: skip
    return _of_blocks(entry, (block,), embedded)


@_step.register
def _(entry: additive.Entry, embedded: bool) -> Step:
    return _of_blocks(entry, entry.parts, embedded)


@_step.register
def _(entry: partitioned.Entry, embedded: bool) -> Step:
    return _of_blocks(entry, (entry.p, entry.q), embedded)


def _of_blocks(entry: TableEntry, given: Sequence[Block], embedded: bool) -> Step:
    """z' = f_1 + f_2 + …: of one part all of the field; of two the kicks and the drifts."""
    naming = Naming(entry.numbers)
    named = [block_of(x, naming, f"_{k}" if k else "", entry.folder) for k, x in enumerate(given)]
    blocks = []
    for own in named:
        rows = [_numbers(naming, row) for row in own.printed.rows]
        weights = own.embedded if embedded and own.embedded else own.printed.weights
        times = own.printed.times
        nodes = [sum(row) for row in rows] if times is None else _numbers(naming, times)
        blocks.append((rows, _numbers(naming, weights), nodes))
    stages = range(len(blocks[0][1]))

    def step(system: System, t: Any, p: Any, q: Any, h: Any) -> Vector:
        def fields(k: int, i: int, z: Vector) -> Vector:
            moment = t + blocks[k][2][i] * h
            kick = system.kick(moment, *z) if k == 0 else mp.mpf(0)
            drift = system.drift(moment, *z) if k == len(blocks) - 1 else mp.mpf(0)
            return [kick, drift]

        slopes = [[fields(k, i, [p, q]) for i in stages] for k in range(len(blocks))]
        explicit = all(row[j] == 0 for rows, _, _ in blocks
                       for i, row in enumerate(rows) for j in stages if j >= i)  # fmt: skip
        for _ in range(len(stages) if explicit else _TURNS):
            for i in stages:
                z = [x + h * sum(rows[i][j] * slopes[k][j][n] for k, (rows, _, _) in
                                 enumerate(blocks) for j in stages)
                     for n, x in enumerate((p, q))]  # fmt: skip
                for k in range(len(blocks)):
                    slopes[k][i] = fields(k, i, z)
        return [x + h * sum(b * slopes[k][j][n] for k, (_, bs, _) in enumerate(blocks)
                            for j, b in enumerate(bs))
                for n, x in enumerate((p, q))]  # fmt: skip

    return step
