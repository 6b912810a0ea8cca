"""What a column may hold other than ΔJ, MSE, Λ, … as they are defined here, beside the state.

Each is another reading of numbers of the same run. Adding one is adding an entry at the end.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

import flint

from verify.arithmetic.arb import in_reach, middle_and_radius, rational_ball
from verify.reference.compare.setting import Setting

_NEAR = Fraction(1, 10**9)


@dataclass(frozen=True)
class Foretold:
    """What a column is foretold to hold, and how many times more than the right value of that
    column it changes with what that is made of."""

    value: Fraction
    radius: Fraction
    factor: Fraction = Fraction(1)


Reading = Callable[[Setting, int, int], Foretold | None]  # the setting, digits, the row's step


def readings(name: str) -> Iterator[tuple[str, str, Reading]]:
    """For a column, what else it may hold: a name, in words, and how it is had."""
    for late, says in ((1, "later"), (-1, "earlier")):
        yield f"{name}{late:+d}", f"your {name} is that of one step {says}", _shifted(name, late)
    yield from _OF_COLUMN.get(name, ())


def _shifted(name: str, late: int) -> Reading:
    """What that column holds so many steps later."""

    def read(setting: Setting, digits: int, step: int) -> Foretold | None:
        known = replace(setting, late=setting.late + late).numbers(step, digits).get(name)
        return known and Foretold(*known)

    return read


def _changed(name: str, change: Callable[[Fraction, int], Fraction | None]) -> Reading:
    """A function of the right value and N; thrice its radius is taken along, for good measure."""

    def read(setting: Setting, digits: int, step: int) -> Foretold | None:
        known = setting.numbers(step, digits).get(name)
        if known is None:
            return None
        (x, radius), n = known, step + setting.late
        near = abs(x) * _NEAR
        middle, aside = change(x, n), change(x + near, n)
        if middle is None or aside is None:
            return None
        factor = abs(aside - middle) / near if near else Fraction(1)
        return Foretold(middle, 3 * factor * radius, max(factor, Fraction(1)))

    return read


def _from_second(name: str) -> Reading:
    """Over k = 1 … N and not 0 … N−1."""

    def read(setting: Setting, digits: int, step: int) -> Foretold | None:
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
        return Foretold(value, radius, Fraction(2))

    return read


def _sum(setting: Setting, digits: int, step: int) -> Foretold | None:
    """Σ ΔJ_k = log(1 + Λ) + ½ Σ ΔJ_k² − …, what is left out being at most ⅓ Σ |ΔJ_k|³."""
    known = setting.numbers(step, digits)
    lam, mse = known.get("lambda"), known.get("mse")
    n = step + setting.late
    if lam is None or (mse is None and n > 0):
        return None
    mse = mse or (Fraction(0), Fraction(0))
    with flint.ctx.workprec(4 * digits + 64):
        squares = rational_ball(n * mse[0])
        total = (1 + rational_ball(lam[0])).log() + squares / 2
        if not in_reach(total):
            return None
        value, radius = middle_and_radius(total)
        rest = middle_and_radius(squares * squares.sqrt())  # Σ|x|³ ≤ (Σ x²)^(3/2)
    return Foretold(value, radius + sum(rest) + 2 * lam[1] + n * mse[1])


def _root(x: Fraction, _: int) -> Fraction | None:
    scale = 10**80
    return Fraction(math.isqrt(int(x * scale**2)), scale) if x >= 0 else None


_LAMBDA: tuple[tuple[str, str, Reading], ...] = (
    ("product", "your lambda is the product of det J, without − 1",
     _changed("lambda", lambda x, _: 1 + x)),
    ("sum", "your lambda is the sum of ΔJ_k, not the product of 1 + ΔJ_k, less 1", _sum),
    ("negated-lambda", "your lambda has the other sign", _changed("lambda", lambda x, _: -x)),
    ("inverse", "your lambda is that of the inverse map: 1/Π det J_k − 1",
     _changed("lambda", lambda x, _: 1 / (1 + x) - 1 if x != -1 else None)),
    ("second-first", "your lambda is over k = 1 … N, not 0 … N−1", _from_second("lambda")),
)  # fmt: skip
_MSE: tuple[tuple[str, str, Reading], ...] = (
    ("root", "your mse is its square root", _changed("mse", _root)),
    ("whole-sum", "your mse is the sum, not divided by N", _changed("mse", lambda x, n: n * x)),
    ("one-more", "your mse is divided by N + 1", _changed("mse", lambda x, n: n * x / (n + 1))),
    ("one-less", "your mse is divided by N − 1",
     _changed("mse", lambda x, n: n * x / (n - 1) if n > 1 else None)),
    ("second-first", "your mse is over k = 1 … N, not 0 … N−1", _from_second("mse")),
)  # fmt: skip
_DELTA_J: tuple[tuple[str, str, Reading], ...] = (
    ("determinant", "your delta_j is det J, without − 1",
     _changed("delta_j", lambda x, _: 1 + x)),
    ("negated", "your delta_j has the other sign", _changed("delta_j", lambda x, _: -x)),
    ("inverse", "your delta_j is that of the inverse map: 1/det J − 1",
     _changed("delta_j", lambda x, _: 1 / (1 + x) - 1 if x != -1 else None)),
)  # fmt: skip
_DEFECT: tuple[tuple[str, str, Reading], ...] = (
    ("defects", "your symplectic_defect is that of one step, the greatest, and not that of N",
     _shifted("symplectic_defect_max", 0)),
)  # fmt: skip
_OF_COLUMN = {"lambda": _LAMBDA, "mse": _MSE, "delta_j": _DELTA_J, "symplectic_defect": _DEFECT}
