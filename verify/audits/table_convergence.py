"""A second look at a printed table: its steps in high precision, against the solution by mpmath.

It shares no code with the conditions that tables are judged by: the step is carried out as its
library does, and the solution is Taylor's, by `mpmath.odefun`.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, singledispatch
from itertools import pairwise
from typing import Any

import mpmath as mp
import sympy

from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.kinds import composition
from verify.integrators.tables.splitting_claims import AlternatingEntry, parts_of
from verify.integrators.tables.tableau_claims import BlocksEntry, block_of
from verify.schemes.printed.naming import Naming

_DIGITS = 60
_SIZES = tuple(mp.mpf(1) / 2**k for k in range(4, 8))
_LARGE = tuple(
    mp.mpf(k) / 16 for k in (16, 12, 8, 6, 4, 3, 2)
)  # where rounded numbers allow no less
_SMALL = tuple(mp.mpf(1) / 2**k for k in (14, 16, 18, 20))  # where a small residue is seen
_TURNS = 80  # of a fixed point: with h ≤ 1/16 each gains more than a digit
_ABOVE = 20  # times the unit of the last digits an error must be, in parts of h
_SHORT = 1e-7  # the unit of decimals that are taken for exact
_WITHIN = 0.3  # of a whole power
Vector = list[Any]


@dataclass(frozen=True)
class SeparableSystem:
    """H = T(p) + b(t) V(q), by T', V' and b."""

    formula: str
    speed: Callable[[Any], Any]
    slope: Callable[[Any], Any]
    b: Callable[[Any], Any]

    def kick(self, t: Any, p: Any, q: Any) -> Any:
        """Return p' at that time."""
        return -self.b(t) * self.slope(q)

    def drift(self, t: Any, p: Any, q: Any) -> Any:
        """Return q' at that time."""
        return self.speed(p)


def _cubic(p: Any) -> Any:
    return p + p**3


_QUADRATIC = "p²/2"
_QUARTIC = "p²/2 + p⁴/4"


@cache
def systems(timed: bool, quadratic: bool) -> tuple[SeparableSystem, SeparableSystem]:
    """Return a pendulum, and an oscillator of degree 4; with a kinetic energy of degree 4 for
    methods of any T(p); driven, where a time is judged."""
    speed = mp.mpf if quadratic else _cubic
    kinetic = _QUADRATIC if quadratic else _QUARTIC
    rate = (lambda t: 1 + mp.cos(2 * t) / 2) if timed else (lambda t: mp.mpf(1))
    factor = "(1 + cos(2t)/2) " if timed else ""
    return (
        SeparableSystem(f"H = {kinetic} − {factor}cos q", speed, mp.sin, rate),
        SeparableSystem(f"H = {kinetic} + {factor}(q²/2 + q⁴/4)", speed, _cubic, rate),
    )


Step = Callable[[SeparableSystem, Any, Any, Any, Any], Vector]  # of t, p, q, h


@dataclass(frozen=True)
class SystemConvergence:
    """The convergence on one system: step sizes with the errors of one step, and the order that
    those show which are above what rounded numbers leave; None if no whole power is seen."""

    formula: str
    rows: tuple[tuple[float, float], ...]
    order: int | None
    last: tuple[float, ...] = ()

    def below(self, claimed: int) -> bool:
        """Return True if the order is seen to be lower: a whole power, or slopes that stay below
        it."""
        if self.order is not None:
            return self.order < claimed
        return len(self.last) > 1 and max(self.last) < claimed + 1 - _WITHIN


def slopes_of(
    entry: TableEntry, timed: bool, embedded: bool = False, small: bool = False
) -> tuple[SystemConvergence, SystemConvergence]:
    """Measure the table as it is printed, at both systems.

    `embedded`: with its embedded weights; `small`: of steps so small that a small residual of a low
    order is seen.
    """
    with mp.workdps(_DIGITS):
        step, naming = _step(entry, embedded)
        units = [float(x) for x in naming.printed_numbers.units.values() if x < _SHORT]
        noise = _ABOVE * max(units, default=0.0)  # what they leave in a step, in parts of h
        pair = systems(timed, entry.kind == "nystrom")
        by_system = [
            _measure_slopes(system, step, noise, _SMALL if small else _SIZES) for system in pair
        ]
        # Where the rounded numbers hide the power, larger steps show it above their error.
        if not small and any(slopes.order is None for slopes in by_system):
            by_system = [_measure_slopes(system, step, noise, _LARGE) for system in pair]
    return by_system[0], by_system[1]


def _measure_slopes(
    system: SeparableSystem, step: Step, noise: float, sizes: Sequence[Any]
) -> SystemConvergence:
    (t, p, q), flow = _solution(system)
    errors = []
    for h in sizes:
        end = step(system, t, p, q, h)
        errors.append(max(abs(x - y) for x, y in zip(end, flow(t + h), strict=True)))
    rows = tuple((float(h), float(error)) for h, error in zip(sizes, errors, strict=True))
    # Rounded digits leave an error of about noise · h in one step: below it no power is seen.
    clear_rows = [row for row in rows if row[1] > noise * row[0]]
    powers = [math.log(x / y) / math.log(h / k) for (h, x), (k, y) in pairwise(clear_rows)]
    last = tuple(powers[-2:])
    return SystemConvergence(system.formula, rows, _order(last), last)


@cache
def _solution(system: SeparableSystem) -> tuple[Vector, Callable[[Any], Vector]]:
    """Return t, p and q at the start, and the solution from there: the same for all tables."""
    t, p, q = mp.mpf(3) / 4, mp.mpf(1) / 3, mp.mpf(3) / 5
    return [t, p, q], mp.odefun(
        lambda s, z: [system.kick(s, *z), system.drift(s, *z)], t, [p, q], tol=mp.mpf(10) ** -45
    )


def _order(powers: Sequence[float]) -> int | None:
    """Return the order of two slopes that agree, at the smallest steps above the noise."""
    if len(powers) < 2 or any(abs(x - round(powers[-1])) > _WITHIN for x in powers):
        return None
    return round(powers[-1]) - 1


# -- one step, by the kind of its table -----------------------------------------------------------


@singledispatch
def _step(entry: TableEntry, embedded: bool) -> tuple[Step, Naming]:
    raise TypeError(f"{entry.name}: no step is made of a {entry.kind}")


def _numbers(naming: Naming, texts: Sequence[str]) -> Vector:
    printed = naming.printed_numbers
    values = (printed.at_print(printed.entry(text)) for text in texts)
    return [mp.mpf(str(sympy.N(x, _DIGITS + 10))) for x in values]


@_step.register
def _(entry: AlternatingEntry, embedded: bool) -> tuple[Step, Naming]:
    naming = Naming(entry.numbers)
    kinds, sizes, times = parts_of(entry, naming)
    parts = _numbers(naming, sizes)
    moments = _numbers(naming, [x or "0" for x in times or ["0"] * len(parts)])

    def step(system: SeparableSystem, t: Any, p: Any, q: Any, h: Any) -> Vector:
        for kind, size, moment in zip(kinds, parts, moments, strict=True):
            if kind == "kick":
                p += size * h * system.kick(t + moment * h, p, q)
            else:
                q += size * h * system.drift(t + moment * h, p, q)
        return [p, q]

    return step, naming


@_step.register
def _(entry: composition.CompositionEntry, embedded: bool) -> tuple[Step, Naming]:
    naming = Naming(entry.numbers)
    weights = _numbers(naming, composition.weights_of(entry, naming))

    def step(system: SeparableSystem, t: Any, p: Any, q: Any, h: Any) -> Vector:
        for w in weights:
            p += w * h / 2 * system.kick(t, p, q)
            q += w * h * system.drift(t, p, q)
            t += w * h
            p += w * h / 2 * system.kick(t, p, q)
        return [p, q]

    return step, naming


@_step.register
def _(entry: BlocksEntry, embedded: bool) -> tuple[Step, Naming]:
    """Step z' = f_1 + f_2 + …: of one part all of the field; of two the kicks and the drifts."""
    naming, blocks = Naming(entry.numbers), []
    for number, block in enumerate(entry.blocks):
        named_block = block_of(block, naming, f"_{number}" if number else "", entry.folder)
        rows = [_numbers(naming, row) for row in named_block.printed.matrix]
        weights = (
            named_block.embedded
            if embedded and named_block.embedded
            else named_block.printed.weights
        )
        times = named_block.printed.times
        nodes = [sum(row) for row in rows] if times is None else _numbers(naming, times)
        blocks.append((rows, _numbers(naming, weights), nodes))
    stages = range(len(blocks[0][1]))

    def step(system: SeparableSystem, t: Any, p: Any, q: Any, h: Any) -> Vector:
        def fields(k: int, i: int, z: Vector) -> Vector:
            moment = t + blocks[k][2][i] * h
            kick = system.kick(moment, *z) if k == 0 else mp.mpf(0)
            drift = system.drift(moment, *z) if k == len(blocks) - 1 else mp.mpf(0)
            return [kick, drift]

        slopes = [[fields(k, i, [p, q]) for i in stages] for k in range(len(blocks))]
        # Explicit stages are exact after as many sweeps as there are stages; implicit ones are
        # iterated to a fixed point.
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

    return step, naming
