"""A setting: a run, and how its columns are read. Ours; and what others may have run.

Each mistake of `verify.reference.compare.run_mistakes` makes another setting of the reference
data's. A column of a setting may also have another meaning than ΔJ, MSE, Λ, … as they are defined
here: another reading of numbers of the same run. Adding one is adding an entry at the end.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache
from itertools import starmap
from typing import NamedTuple

import flint

from verify.arithmetic.arb import is_representable, midpoint_and_radius, rational_ball
from verify.arithmetic.number_system import UnsupportedError
from verify.errors import InputError
from verify.lockstep import run_alone
from verify.reference.make.orbit_computation import Bounded, orbit_points
from verify.reference.make.row_values import values_of
from verify.runs.run_start import Start
from verify.scenes.results.reference import OrbitRow
from verify.structures import AREA, SYMPLECTIC

_MOST_STEPS = {AREA: 2_000_000, SYMPLECTIC: 20_000}  # run; what is farther is not known


def numbers_of(point: OrbitRow, degrees: int) -> dict[str, Bounded]:
    """Return the numbers that a point has, by their columns' names."""
    values = values_of(point, degrees).items()
    return {name: (Fraction(x.value), Fraction(x.radius)) for name, x in values if x}


class OrbitPoints:
    """Orbits after some steps: from the reference data if they have them, otherwise by a run."""

    def __init__(self, cache: Mapping[Start, tuple[int, Mapping[int, OrbitRow]]]) -> None:
        """`cache`: the digits of an orbit, and its points by step."""
        self._cache = cache

    def point_at(self, orbit: Start, step: int, digits: int) -> OrbitRow | None:
        """Return the point after so many steps, to `digits` digits at least; None if there is
        no such state."""
        have, rows = self._cache.get(orbit, (0, {}))
        # Published points are exact to their digits and cost nothing; a run is made only for more
        # digits or other steps.
        if have >= digits and step in rows:
            point = rows[step]
            return point if point.status == "finished" else None
        return _run_to(orbit, step, digits)

    def of_other_schemes(self, orbit: Start) -> Iterator[Start]:
        """Yield the orbits of the reference data that differ from `orbit` in the scheme alone."""
        for other in self._cache:
            if other != orbit and replace(other, scheme=orbit.scheme) == orbit:
                yield other


@dataclass(frozen=True)
class Setting:
    """A run and a reading of it: row N holds the point after N + `delay` steps, with `swaps` of
    columns, pair by pair, and the other sign of every p if it `negates_p`. `points` supplies the
    numbers."""

    orbit: Start
    points: OrbitPoints = field(compare=False)
    delay: int = 0
    swaps: tuple[tuple[str, str], ...] = ()
    negates_p: bool = False

    def numbers(self, step: int, digits: int) -> dict[str, Bounded]:
        """Return the numbers of row `step` of such a table; without the state if there is
        none."""
        after = step + self.delay
        point = None if after < 0 else self.points.point_at(self.orbit, after, digits)
        values = numbers_of(point, self.orbit.hamiltonian.degrees) if point else {}
        if self.negates_p:
            momenta = [n for n in self.orbit.hamiltonian.coordinates if n[0] == "p" and n in values]
            values |= {name: (-values[name][0], values[name][1]) for name in momenta}
        return {self.inner(name): values[name] for name in values}

    def inner(self, name: str) -> str:
        """Return the name of the number that stands in a column of that name."""
        for first, second in self.swaps:
            if name in (first, second):
                return second if name == first else first
        return name


@lru_cache(maxsize=4096)
def _run_to(orbit: Start, step: int, digits: int) -> OrbitRow | None:
    if step > _MOST_STEPS[orbit.hamiltonian.structure]:
        return None
    try:
        (point,) = run_alone(orbit_points(orbit, steps=(step,), digits=digits))
    except (InputError, UnsupportedError, ArithmeticError):
        return None
    return point if point.status == "finished" else None


# -- other meanings of a column -------------------------------------------------------------------

_NEAR = Fraction(1, 10**9)


@dataclass(frozen=True)
class Prediction:
    """The value that a column is foretold to hold, with its radius; `factor`: how many times
    more than the right value of that column it changes with the numbers it is made of."""

    value: Fraction
    radius: Fraction
    factor: Fraction = Fraction(1)


Reading = Callable[[Setting, int, int], Prediction | None]  # the setting, digits, the row's step


class ColumnMeaning(NamedTuple):
    """Another meaning of a column; `says` tells it to the author of the numbers."""

    name: str
    says: str
    read: Reading


def readings(name: str) -> Iterator[ColumnMeaning]:
    """Yield what else a column may hold: first the numbers of the row before, or after, it."""
    for delay, when in ((1, "later"), (-1, "earlier")):
        says = f"your {name} is that of one step {when}"
        yield ColumnMeaning(f"{name}{delay:+d}", says, _shift(name, delay))
    yield from starmap(ColumnMeaning, _OF_COLUMN.get(name, ()))


def _shift(name: str, delay: int) -> Reading:
    """Return the reading "the column so many steps later"."""

    def read(setting: Setting, digits: int, step: int) -> Prediction | None:
        bounded = replace(setting, delay=setting.delay + delay).numbers(step, digits).get(name)
        return bounded and Prediction(*bounded)

    return read


def _transform(name: str, change: Callable[[Fraction, int], Fraction | None]) -> Reading:
    """Return the reading "a function of the right value and N"; three times its radius is used,
    for safety."""

    def read(setting: Setting, digits: int, step: int) -> Prediction | None:
        bounded = setting.numbers(step, digits).get(name)
        if bounded is None:
            return None
        (x, radius), n = bounded, step + setting.delay
        near = abs(x) * _NEAR
        middle, shifted_middle = change(x, n), change(x + near, n)
        if middle is None or shifted_middle is None:
            return None
        # A difference quotient: how strongly the function passes on errors of its argument.
        factor = abs(shifted_middle - middle) / near if near else Fraction(1)
        return Prediction(middle, 3 * factor * radius, max(factor, Fraction(1)))

    return read


def _shift_start(name: str) -> Reading:
    """Return the reading "over k = 1 … N and not 0 … N−1"."""

    def read(setting: Setting, digits: int, step: int) -> Prediction | None:
        n = step + setting.delay
        whole = replace(setting, delay=setting.delay + 1).numbers(step, digits).get(name)
        first = setting.numbers(-setting.delay, digits).get("delta_j")
        if whole is None or first is None or first[0] == -1 or (name == "mse" and n < 1):
            return None
        if name == "lambda":
            value = (1 + whole[0]) / (1 + first[0]) - 1
        else:
            value = ((n + 1) * whole[0] - first[0] ** 2) / n
        radius = 4 * (whole[1] * (n + 1) + first[1] * (1 + abs(whole[0])))
        return Prediction(value, radius, Fraction(2))

    return read


def _predict_sum(setting: Setting, digits: int, step: int) -> Prediction | None:
    """Compute Σ ΔJ_k = log(1 + Λ) + ½ Σ ΔJ_k² − …, where the omitted terms are at most ⅓ Σ
    |ΔJ_k|³."""
    bounded = setting.numbers(step, digits)
    lam, mse = bounded.get("lambda"), bounded.get("mse")
    n = step + setting.delay
    if lam is None or (mse is None and n > 0):
        return None
    mse = mse or (Fraction(0), Fraction(0))
    with flint.ctx.workprec(4 * digits + 64):
        squares = rational_ball(n * mse[0])
        total = (1 + rational_ball(lam[0])).log() + squares / 2
        if not is_representable(total):
            return None
        value, radius = midpoint_and_radius(total)
        left_out = midpoint_and_radius(squares * squares.sqrt())  # Σ|x|³ ≤ (Σ x²)^(3/2)
    return Prediction(value, radius + sum(left_out) + 2 * lam[1] + n * mse[1])


def _square_root(x: Fraction, _: int) -> Fraction | None:
    scale = 10**80
    return Fraction(math.isqrt(int(x * scale**2)), scale) if x >= 0 else None


_LAMBDA: tuple[tuple[str, str, Reading], ...] = (
    ("product", "your lambda is the product of det J, without − 1",
     _transform("lambda", lambda x, _: 1 + x)),
    ("sum", "your lambda is the sum of ΔJ_k, not the product of 1 + ΔJ_k, less 1", _predict_sum),
    ("negated-lambda", "your lambda has the other sign", _transform("lambda", lambda x, _: -x)),
    ("inverse", "your lambda is that of the inverse map: 1/Π det J_k − 1",
     _transform("lambda", lambda x, _: 1 / (1 + x) - 1 if x != -1 else None)),
    ("second-first", "your lambda is over k = 1 … N, not 0 … N−1", _shift_start("lambda")),
)  # fmt: skip
_MSE: tuple[tuple[str, str, Reading], ...] = (
    ("root", "your mse is its square root", _transform("mse", _square_root)),
    ("whole-sum", "your mse is the sum, not divided by N", _transform("mse", lambda x, n: n * x)),
    ("one-more", "your mse is divided by N + 1", _transform("mse", lambda x, n: n * x / (n + 1))),
    ("one-less", "your mse is divided by N − 1",
     _transform("mse", lambda x, n: n * x / (n - 1) if n > 1 else None)),
    ("second-first", "your mse is over k = 1 … N, not 0 … N−1", _shift_start("mse")),
)  # fmt: skip
_DELTA_J: tuple[tuple[str, str, Reading], ...] = (
    ("determinant", "your delta_j is det J, without − 1",
     _transform("delta_j", lambda x, _: 1 + x)),
    ("negated", "your delta_j has the other sign", _transform("delta_j", lambda x, _: -x)),
    ("inverse", "your delta_j is that of the inverse map: 1/det J − 1",
     _transform("delta_j", lambda x, _: 1 / (1 + x) - 1 if x != -1 else None)),
)  # fmt: skip
_DEFECT: tuple[tuple[str, str, Reading], ...] = (
    ("defects", "your symplectic_defect is that of one step, the greatest, and not that of N",
     _shift("symplectic_defect_max", 0)),
)  # fmt: skip
_OF_COLUMN = {"lambda": _LAMBDA, "mse": _MSE, "delta_j": _DELTA_J, "symplectic_defect": _DEFECT}
