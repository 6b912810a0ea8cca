"""Orbits of every shape, drawn by a seed, and their values by sympy and mpmath alone.

The maps are lieη, z' = Σ hⁿ Dⁿz/n! with D = X + ∂_t, derived by sympy and stepped with 120 digits;
J, S, W and Λ are those of its derivatives. Nothing of the toolkit is in it but the names of what is
asked.
"""

import random
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import combinations
from typing import Any

import sympy
from mpmath import mp

from verify.arithmetic.exact import of_mpf

DIGITS = 120
H, T = sympy.Symbol("h"), sympy.Symbol("t")


@dataclass(frozen=True)
class Shape:
    """H and lieη, from where, and how far; coordinates p1 … pn, q1 … qn, or p and q."""

    formula: str
    order: int
    start: tuple[tuple[str, Fraction], ...]
    h: Fraction
    t0: Fraction
    steps: int

    @property
    def names(self) -> list[str]:
        return [name for name, _ in self.start]


def increments(draw: random.Random) -> Shape:
    """A step is far larger than the state that it begins at."""
    c, d = draw.randint(1, 9), draw.randint(2, 9)
    text = f"{c}*p + {d}*q + p**2*q**2/{10 * d}"
    tiny = Fraction(draw.randint(-99, 99), 10**10)
    return Shape(text, draw.choice([1, 2]), (("p", tiny), ("q", tiny / 7)),
                 Fraction(draw.randint(1, 5), 4), Fraction(0), draw.randint(1, 3))  # fmt: skip


def small_denominators(draw: random.Random) -> Shape:
    """Denominators below 1, where slopes of 1/x are steep."""
    if draw.random() < 0.5:
        text, q = "p**2/2 + 1/(50*(2 - q**2))", Fraction(draw.randint(1350, 1400), 1000)
    else:
        text, q = "p**2/2 + p*log(q)/9 + 1/(90*q)", Fraction(draw.randint(60, 200), 1000)
    return Shape(text, 2, (("p", Fraction(draw.randint(-9, 9), 50)), ("q", q)),
                 Fraction(1, draw.randint(500, 900)), Fraction(0), draw.randint(5, 30))  # fmt: skip


def several(degrees: int) -> Callable[[random.Random], Shape]:
    """A chain of so many bodies, with a coupling that is no sum."""

    def drawn(draw: random.Random) -> Shape:
        bodies = range(1, degrees + 1)
        kinetic = " + ".join(f"p{k}**2/{draw.randint(1, 4)}" for k in bodies)
        pairs = [(k, k % degrees + 1) for k in bodies]
        bonds = " + ".join(f"q{a}*q{b}**2/{draw.randint(3, 9)}" for a, b in pairs)
        mixed = f"p1*q{degrees}*q1/{draw.randint(5, 9)}"
        place = [(f"{x}{k}", Fraction(draw.randint(-9, 9), 17)) for x in "pq" for k in bodies]
        return Shape(f"{kinetic} + {bonds} + {mixed}", draw.choice([1, 2]), tuple(place),
                     Fraction(1, draw.randint(8, 30)), Fraction(0), draw.randint(2, 8))  # fmt: skip

    return drawn


def one_step(draw: random.Random) -> Shape:
    a, b = draw.randint(2, 9), draw.randint(2, 9)
    return Shape(f"p**2/{a} - cos({b}*q)/{b} + p*q**2/{a}", draw.choice([1, 2, 3]),
                 (("p", Fraction(draw.randint(-30, 30), 7)),
                  ("q", Fraction(draw.randint(-30, 30), 9))),
                 Fraction(draw.randint(1, 60), 40), Fraction(0), 1)  # fmt: skip


def near_0(draw: random.Random) -> Shape:
    tiny = Fraction(draw.randint(1, 99), 10 ** draw.randint(13, 18))
    sign = draw.choice([1, -1])
    return Shape(f"p**2/2 + {sign}*q**2/2 + q**3 + p**2*q", draw.choice([1, 2]),
                 (("p", tiny), ("q", -tiny / 3)), Fraction(1, draw.randint(9, 40)), Fraction(0),
                 draw.randint(5, 40))  # fmt: skip


def late(draw: random.Random) -> Shape:
    """From a t that is large, of either sign."""
    form = draw.choice(["p**2/2 - q*cos(t)/2 + q**4/9", "p**2/2 - cos(q)*(1 + sin(2*t)/3)",
                        "p**2/2 + q**2*t/10000 + q**3/5"])  # fmt: skip
    t0 = Fraction(draw.randint(-(10**5), 10**5), 7)
    return Shape(form, draw.choice([1, 2]), (("p", Fraction(1, 3)), ("q", Fraction(-2, 9))),
                 Fraction(1, draw.randint(9, 40)), t0, draw.randint(5, 30))  # fmt: skip


def late_in_two_degrees(draw: random.Random) -> Shape:
    t0 = Fraction(draw.randint(-(10**4), 10**4), 3)
    drive = f"cos(q1)*(1 + cos(t)/{draw.randint(2, 5)})"
    text = f"p1**2/2 + p2**2/2 - {drive} + (q1 - q2)**2/2 + q2**3*t/100000"
    place = [(f"{x}{k}", Fraction(draw.randint(-9, 9), 17)) for x in "pq" for k in (1, 2)]
    return Shape(text, draw.choice([1, 2]), tuple(place),
                 Fraction(1, draw.randint(9, 30)), t0, draw.randint(3, 15))  # fmt: skip


SHAPES: dict[str, Callable[[random.Random], Shape]] = {
    "increments": increments, "small denominators": small_denominators, "three": several(3),
    "four": several(4), "one step": one_step, "near 0": near_0, "late": late,
    "late in two degrees": late_in_two_degrees,
}  # fmt: skip


@cache
def _map(formula: str, order: int, names: tuple[str, ...]) -> Callable[..., Any]:
    """(z, h, t) ↦ z' and its derivatives, row by row."""
    symbols = [sympy.Symbol(n) for n in names]
    n = len(symbols) // 2
    energy = sympy.sympify(formula, locals={x.name: x for x in (*symbols, T)}, rational=True)
    slopes = [*(-energy.diff(q) for q in symbols[n:]), *(energy.diff(p) for p in symbols[:n])]
    after, terms = list(symbols), list(symbols)
    for k in range(1, order + 1):
        terms = [x.diff(T) + sum(x.diff(z) * f for z, f in zip(symbols, slopes, strict=True))
                 for x in terms]  # fmt: skip
        after = [x + H**k * y / sympy.factorial(k) for x, y in zip(after, terms, strict=True)]
    rows = [x.diff(z) for x in after for z in symbols]
    return sympy.lambdify([*symbols, H, T], [*after, *rows], modules="mpmath", cse=True)  # type: ignore[no-any-return]


def number(x: Fraction) -> Any:
    return mp.mpf(x.numerator) / x.denominator


def values(shape: Shape) -> dict[str, Fraction]:
    """Everything that may be asked of the run, right to 80 digits and more."""
    with mp.workdps(DIGITS):
        return _values(shape)


def _values(shape: Shape) -> dict[str, Fraction]:
    size, n = len(shape.start), len(shape.start) // 2
    step, h = _map(shape.formula, shape.order, tuple(shape.names)), number(shape.h)
    z = [number(x) for _, x in shape.start]
    tangent = mp.eye(size)
    product, squares, top, highest, defects = mp.mpf(1), mp.mpf(0), mp.mpf(0), mp.mpf(0), mp.mpf(0)
    for k in range(shape.steps):
        found = step(*z, h, number(shape.t0) + k * h)
        z, jacobian = list(found[:size]), mp.matrix(size, size)
        for place, x in enumerate(found[size:]):
            jacobian[place // size, place % size] = x
        change = mp.det(jacobian) - 1
        product, squares = product * (1 + change), squares + change**2
        top, highest = max(top, abs(change)), max(highest, abs(product - 1))
        defects = max(defects, *_defect(jacobian, n))
        tangent = jacobian * tangent
    made = dict(zip(shape.names, z, strict=True))
    made |= {"delta_j_max": top, "mse": squares / shape.steps, "lambda": product - 1,
             "lambda_max": highest, "symplectic_defect_max": defects,
             "symplectic_defect": max(_defect(tangent, n))}  # fmt: skip
    return {name: of_mpf(x) for name, x in made.items()}


def _defect(m: Any, n: int) -> list[Any]:
    """|MᵀΩM − Ω| above the diagonal."""
    found = []
    for a, b in combinations(range(2 * n), 2):
        total = sum((m[i, a] * m[n + i, b] - m[n + i, a] * m[i, b] for i in range(n)), mp.mpf(0))
        found.append(abs(total - (1 if b == n + a else 0)))
    return found
