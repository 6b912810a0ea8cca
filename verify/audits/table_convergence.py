"""A second look at a printed table: its steps with 60 digits, against the solution by mpmath.

The first look tests algebraic conditions on the table. This module shares with it only the reading
of the table: it carries out steps as a program that uses the table would, and compares them with
the Taylor series solution of `mpmath.odefun`. The order is read off the errors of one step: with a
method of order r they shrink as h^(r+1).
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
_STEP_SIZES = tuple(mp.mpf(1) / 2**k for k in range(4, 8))
# For tables whose rounded numbers hide the errors of smaller steps.
_LARGE_STEP_SIZES = tuple(mp.mpf(k) / 16 for k in (16, 12, 8, 6, 4, 3, 2))
# For errors of a low order whose coefficient is small.
_SMALL_STEP_SIZES = tuple(mp.mpf(1) / 2**k for k in (14, 16, 18, 20))
# With h ≤ 1/16 each sweep of the fixed-point iteration gains more than a digit; with the large step
# sizes convergence is not certain.
_SWEEPS_OF_IMPLICIT_STAGES = 80
# An error counts if it is larger than this number times h times the unit of the last printed digit.
_NOISE_FACTOR = 20
_SHORT_UNIT = 1e-7  # decimals whose last digit has at least this unit are taken as exact
_ORDER_TOLERANCE = 0.3  # the largest distance of a slope from a whole number that passes for it
Vector = list[Any]


@dataclass(frozen=True)
class SeparableSystem:
    """H = T(p) + b(t) V(q): `speed` is T', `slope_of_potential` is V', and `b` the factor."""

    formula: str
    speed: Callable[[Any], Any]
    slope_of_potential: Callable[[Any], Any]
    b: Callable[[Any], Any]

    def kick(self, t: Any, p: Any, q: Any) -> Any:
        """Return p', the derivative of p by t."""
        return -self.b(t) * self.slope_of_potential(q)

    def drift(self, t: Any, p: Any, q: Any) -> Any:
        """Return q', the derivative of q by t."""
        return self.speed(p)


def _cubic(p: Any) -> Any:
    return p + p**3


_QUADRATIC = "p²/2"
_QUARTIC = "p²/2 + p⁴/4"


@cache
def systems(driven: bool, quadratic: bool) -> tuple[SeparableSystem, SeparableSystem]:
    """Return a pendulum, and an oscillator with a potential of degree 4.

    `driven`: the potential has a factor that depends on t, to judge times. `quadratic`: T = p²/2,
    for methods that need this; otherwise T has the degree 4.
    """
    speed = mp.mpf if quadratic else _cubic
    kinetic = _QUADRATIC if quadratic else _QUARTIC
    b = (lambda t: 1 + mp.cos(2 * t) / 2) if driven else (lambda t: mp.mpf(1))
    factor = "(1 + cos(2t)/2) " if driven else ""
    return (
        SeparableSystem(f"H = {kinetic} − {factor}cos q", speed, mp.sin, b),
        SeparableSystem(f"H = {kinetic} + {factor}(q²/2 + q⁴/4)", speed, _cubic, b),
    )


# A function of the system, t, p, q and h that returns p and q after one step.
Step = Callable[[SeparableSystem, Any, Any, Any, Any], Vector]


@dataclass(frozen=True)
class SystemConvergence:
    """The convergence on one system.

    `rows`: step sizes with the errors of one step. `order`: that of the method by those errors that
    are above the effect of rounded numbers; None if they follow no whole power. `last_powers`: the
    last two slopes of ln(error) over ln(h), or fewer.
    """

    formula: str
    rows: tuple[tuple[float, float], ...]
    order: int | None
    last_powers: tuple[float, ...] = ()

    def is_below(self, claimed: int) -> bool:
        """Return True if the order is lower than claimed, or if both last slopes are too low."""
        if self.order is not None:
            return self.order < claimed
        if len(self.last_powers) < 2:
            return False
        return max(self.last_powers) < claimed + 1 - _ORDER_TOLERANCE


def measure_convergence(
    entry: TableEntry, driven: bool, embedded: bool = False, small: bool = False
) -> tuple[SystemConvergence, SystemConvergence]:
    """Measure the convergence of the table as it is printed, on both systems.

    `driven`: on systems that depend on t. `embedded`: with the embedded weights. `small`: with very
    small steps, at which an error of a low order and a small coefficient shows.
    """
    with mp.workdps(_DIGITS):
        step, naming = _step(entry, embedded)
        units = [float(x) for x in naming.printed_numbers.units.values() if x < _SHORT_UNIT]
        # The rounding of the printed numbers changes one step by about noise · h.
        noise = _NOISE_FACTOR * max(units, default=0.0)
        pair = systems(driven, entry.kind == "nystrom")
        step_sizes = _SMALL_STEP_SIZES if small else _STEP_SIZES
        by_system = [_measure_system(system, step, noise, step_sizes) for system in pair]
        # If rounding hides the power, the errors of larger steps show it.
        if not small and any(convergence.order is None for convergence in by_system):
            by_system = [_measure_system(system, step, noise, _LARGE_STEP_SIZES) for system in pair]
    return by_system[0], by_system[1]


def _measure_system(
    system: SeparableSystem, step: Step, noise: float, step_sizes: Sequence[Any]
) -> SystemConvergence:
    """Measure the convergence on one system; `step_sizes` fall."""
    (t, p, q), flow = _start_and_flow(system)
    errors = []
    for h in step_sizes:
        end = step(system, t, p, q, h)
        errors.append(max(abs(x - y) for x, y in zip(end, flow(t + h), strict=True)))
    rows = tuple((float(h), float(error)) for h, error in zip(step_sizes, errors, strict=True))
    clear_rows = [(h, error) for h, error in rows if error > noise * h]
    powers = [
        math.log(large_error / small_error) / math.log(large / small)
        for (large, large_error), (small, small_error) in pairwise(clear_rows)
    ]
    last_powers = tuple(powers[-2:])
    return SystemConvergence(system.formula, rows, _estimate_order(last_powers), last_powers)


@cache
def _start_and_flow(system: SeparableSystem) -> tuple[Vector, Callable[[Any], Vector]]:
    """Return t, p and q at the start, and the solution from there, a function of t."""
    t, p, q = mp.mpf(3) / 4, mp.mpf(1) / 3, mp.mpf(3) / 5
    return [t, p, q], mp.odefun(
        lambda s, z: [system.kick(s, *z), system.drift(s, *z)], t, [p, q], tol=mp.mpf(10) ** -45
    )


def _estimate_order(powers: Sequence[float]) -> int | None:
    """Return the order of the method if two slopes agree on a whole power; None otherwise."""
    if len(powers) < 2 or any(abs(x - round(powers[-1])) > _ORDER_TOLERANCE for x in powers):
        return None
    # The error of one step is O(h^(r+1)).
    return round(powers[-1]) - 1


# -- one step, by the kind of its table -----------------------------------------------------------


@singledispatch
def _step(entry: TableEntry, embedded: bool) -> tuple[Step, Naming]:
    """Return the step of a table, and the naming, which has all its printed numbers afterwards.

    Raises TypeError for a kind of table whose steps are not implemented here.
    """
    raise TypeError(f"{entry.name}: no step is made of a {entry.kind}")


def _values(naming: Naming, texts: Sequence[str]) -> Vector:
    """Return the values of formulas in the named numbers, each number as it is printed."""
    printed = naming.printed_numbers
    values = (printed.at_print(printed.entry(text)) for text in texts)
    return [mp.mpf(str(sympy.N(x, _DIGITS + 10))) for x in values]


@_step.register
def _(entry: AlternatingEntry, embedded: bool) -> tuple[Step, Naming]:
    naming = Naming(entry.numbers)
    kinds, sizes, times = parts_of(entry, naming)
    coefficients = _values(naming, sizes)
    abscissas = _values(naming, [x or "0" for x in times or ["0"] * len(coefficients)])

    def step(system: SeparableSystem, t: Any, p: Any, q: Any, h: Any) -> Vector:
        for kind, size, abscissa in zip(kinds, coefficients, abscissas, strict=True):
            if kind == "kick":
                p += size * h * system.kick(t + abscissa * h, p, q)
            else:
                q += size * h * system.drift(t + abscissa * h, p, q)
        return [p, q]

    return step, naming


@_step.register
def _(entry: composition.CompositionEntry, embedded: bool) -> tuple[Step, Naming]:
    naming = Naming(entry.numbers)
    weights = _values(naming, composition.weights_of(entry, naming))

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
    """Return the step of one tableau for the whole field, or of one for p' and one for q'.

    Of more tableaus, those between the first and the last would get a field of 0.
    """
    naming, blocks = Naming(entry.numbers), []
    for number, block in enumerate(entry.blocks):
        named_block = block_of(block, naming, f"_{number}" if number else "", entry.folder)
        rows = [_values(naming, row) for row in named_block.printed.matrix]
        weights = (
            named_block.embedded
            if embedded and named_block.embedded
            else named_block.printed.weights
        )
        times = named_block.printed.times
        abscissas = [sum(row) for row in rows] if times is None else _values(naming, times)
        blocks.append((rows, _values(naming, weights), abscissas))
    stages = range(len(blocks[0][1]))

    def step(system: SeparableSystem, t: Any, p: Any, q: Any, h: Any) -> Vector:
        def stage_slope(k: int, i: int, z: Vector) -> Vector:
            """Return the part of the field that tableau k has, at its stage i."""
            stage_time = t + blocks[k][2][i] * h
            kick = system.kick(stage_time, *z) if k == 0 else mp.mpf(0)
            drift = system.drift(stage_time, *z) if k == len(blocks) - 1 else mp.mpf(0)
            return [kick, drift]

        # slopes[k][i][n]: of tableau k at stage i, for p (n = 0) or q (n = 1).
        slopes = [[stage_slope(k, i, [p, q]) for i in stages] for k in range(len(blocks))]
        # Explicit stages are exact after as many sweeps as there are stages; implicit ones are
        # iterated to a fixed point.
        explicit = all(row[j] == 0 for rows, _, _ in blocks
                       for i, row in enumerate(rows) for j in stages if j >= i)  # fmt: skip
        for _ in range(len(stages) if explicit else _SWEEPS_OF_IMPLICIT_STAGES):
            for i in stages:
                z = [x + h * sum(rows[i][j] * slopes[k][j][n] for k, (rows, _, _) in
                                 enumerate(blocks) for j in stages)
                     for n, x in enumerate((p, q))]  # fmt: skip
                for k in range(len(blocks)):
                    slopes[k][i] = stage_slope(k, i, z)
        return [x + h * sum(b * slopes[k][j][n] for k, (_, bs, _) in enumerate(blocks)
                            for j, b in enumerate(bs))
                for n, x in enumerate((p, q))]  # fmt: skip

    return step, naming
