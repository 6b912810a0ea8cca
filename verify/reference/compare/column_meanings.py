"""Other meanings that a column may have than ΔJ, MSE, Λ, … as they are defined here.

Each is another reading of numbers of the same run. Adding one is adding an entry at the end.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.arithmetic.arb import is_representable, midpoint_and_radius, rational_ball
from verify.reference.compare.setting import Setting

_NEAR = Fraction(1, 10**9)


@dataclass(frozen=True)
class Prediction:
    """The value that a column is foretold to hold, with its radius; `factor`: how many times
    more than the right value of that column it changes with the numbers it is made of."""

    value: Fraction
    radius: Fraction
    factor: Fraction = Fraction(1)


Reading = Callable[[Setting, int, int], Prediction | None]  # the setting, digits, the row's step


def readings(name: str) -> Iterator[tuple[str, str, Reading]]:
    """Yield what else a column may hold: a name, a sentence, and the function that computes it."""
    for late, says in ((1, "later"), (-1, "earlier")):
        yield f"{name}{late:+d}", f"your {name} is that of one step {says}", _shift(name, late)
    yield from _OF_COLUMN.get(name, ())


def _shift(name: str, late: int) -> Reading:
    """Return the reading "the column so many steps later"."""

    def read(setting: Setting, digits: int, step: int) -> Prediction | None:
        bounded = replace(setting, late=setting.late + late).numbers(step, digits).get(name)
        return bounded and Prediction(*bounded)

    return read


def _transform(name: str, change: Callable[[Fraction, int], Fraction | None]) -> Reading:
    """Return the reading "a function of the right value and N"; three times its radius is used,
    for safety."""

    def read(setting: Setting, digits: int, step: int) -> Prediction | None:
        bounded = setting.numbers(step, digits).get(name)
        if bounded is None:
            return None
        (x, radius), n = bounded, step + setting.late
        near = abs(x) * _NEAR
        middle, aside = change(x, n), change(x + near, n)
        if middle is None or aside is None:
            return None
        # A difference quotient: how strongly the function passes on errors of its argument.
        factor = abs(aside - middle) / near if near else Fraction(1)
        return Prediction(middle, 3 * factor * radius, max(factor, Fraction(1)))

    return read


def _shift_start(name: str) -> Reading:
    """Return the reading "over k = 1 … N and not 0 … N−1"."""

    def read(setting: Setting, digits: int, step: int) -> Prediction | None:
        n = step + setting.late
        whole = replace(setting, late=setting.late + 1).numbers(step, digits).get(name)
        first = setting.numbers(-setting.late, digits).get("delta_j")
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
    n = step + setting.late
    if lam is None or (mse is None and n > 0):
        return None
    mse = mse or (Fraction(0), Fraction(0))
    with flint.ctx.workprec(4 * digits + 64):
        squares = rational_ball(n * mse[0])
        total = (1 + rational_ball(lam[0])).log() + squares / 2
        if not is_representable(total):
            return None
        value, radius = midpoint_and_radius(total)
        rest = midpoint_and_radius(squares * squares.sqrt())  # Σ|x|³ ≤ (Σ x²)^(3/2)
    return Prediction(value, radius + sum(rest) + 2 * lam[1] + n * mse[1])


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
