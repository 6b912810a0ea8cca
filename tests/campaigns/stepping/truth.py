"""The order of a program and whether it is symplectic, by mpmath and sympy alone.

The program itself is run in numbers of 60 digits, its literals as the numbers that they are written
for, and held against Gauss's collocation of order 12 for the gradient of H that sympy makes.
"""

import builtins
import io
import tokenize
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath
import sympy

from tests.campaigns.stepping.systems import InUnits

DIGITS = 60
_STAGES, _ENOUGH = 6, 45  # of Gauss's method; digits to which its stages are iterated
_HALVINGS = 15, 12, 10, 9, 8, 7, 6, 5, 4  # of the larger of two step sizes
_ROUNDED = 2.0**-49  # of a step's length: what coefficients in doubles do to it
_STEP = Fraction(1, 32)  # at which the structure is looked at
_KEPT = 1e-25  # and what is left of it where it is kept
_CLEAR = 0.15  # off a whole number, which a slope may be
_TIME = Fraction(3, 10)
Vector = list[Any]
Flow = Callable[[Vector, Any, Any], Vector]


@dataclass(frozen=True)
class Truth:
    """`order`: the least one of the places. `defect`: the largest entry of JᵀΩJ − Ω in units of
    the motion."""

    order: int
    defect: float

    @property
    def symplectic(self) -> bool:
        return self.defect < _KEPT


class UnclearError(AssertionError):
    """The generator is to be mended: a slope that is no whole number."""


def truth_of(units: InUnits, source: str) -> Truth:
    """Of the program, in these units."""
    with mpmath.workdps(DIGITS):
        scale = [mpmath.mpf(x) for x in [units.p] * units.system.degrees]
        scale += [mpmath.mpf(x) for x in [units.q] * units.system.degrees]
        step, flow = stepped(units, source, scale), _flow(units, scale)
        places = [[mpmath.mpf(repr(x)) for x in place] for place in units.system.places]
        order = min(_order(step, flow, place) for place in places)
        return Truth(order, max(float(_defect(step, place)) for place in places))


def stepped(units: InUnits, source: str, scale: Sequence[Any]) -> Flow:
    """z, h, t → z' of the program, all in units of the motion."""
    namespace = in_mpmath(source)
    n, unit = units.system.degrees, mpmath.mpf(units.t)

    def step(z: Vector, h: Any, t: Any) -> Vector:
        real = [x * y for x, y in zip(z, scale, strict=True)]
        p, q = (real[0], real[1]) if n == 1 else (real[:n], real[n:])
        clock = (t * unit,) if units.system.timed else ()
        after = namespace["step"](p, q, *clock, h * unit)
        flat = after if n == 1 else (*after[0], *after[1])
        return [x / y for x, y in zip(flat, scale, strict=True)]

    return step


def in_mpmath(source: str) -> dict[str, Any]:
    """What the program defines, its numbers those of mpmath."""
    tokens = []
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        text = f"mpf('{token.string}')" if token.type == tokenize.NUMBER else token.string
        tokens.append((token.type, text))
    names = {name: getattr(mpmath, name) for name in ("cos", "exp", "log", "sin", "sqrt", "mpf")}
    namespace: dict[str, Any] = {**names, "range": lambda n: builtins.range(int(n))}
    text = tokenize.untokenize(tokens).replace("from math import", "from mpmath import")
    exec(text, namespace)  # noqa: S102 - it is written here
    return namespace


def _flow(units: InUnits, scale: Sequence[Any]) -> Flow:
    """The exact motion over h, in units of the motion, to some 35 digits."""
    field = _field(units, scale)
    nodes, weights, ends = _gauss()

    def flow(z: Vector, h: Any, t: Any) -> Vector:
        slopes = [field(z, t)] * _STAGES
        while True:
            inner = [
                [x + h * sum(a * k[i] for a, k in zip(row, slopes, strict=True))
                 for i, x in enumerate(z)]
                for row in weights
            ]  # fmt: skip
            new = [field(y, t + c * h) for y, c in zip(inner, nodes, strict=True)]
            moved = max(abs(x - y) for a, b in zip(new, slopes, strict=True)
                        for x, y in zip(a, b, strict=True))  # fmt: skip
            slopes = new
            if moved < mpmath.mpf(10) ** -_ENOUGH * (1 + max(map(abs, new[0]))):
                break
        return [
            x + h * sum(b * k[i] for b, k in zip(ends, slopes, strict=True))
            for i, x in enumerate(z)
        ]

    return flow


def _field(units: InUnits, scale: Sequence[Any]) -> Callable[[Vector, Any], Vector]:
    system, n = units.system, units.system.degrees
    names = {x: sympy.Symbol(x, real=True) for x in (*system.constants, "t")}
    numbers = [""] if n == 1 else [str(k + 1) for k in range(n)]
    p, q = ([sympy.Symbol(f"{z}{k}", real=True) for k in numbers] for z in "pq")
    known = {**names, **{str(x): x for x in (*p, *q)}}
    energy = sympy.sympify(f"{system.kinetic} + {system.potential}", locals=known)
    slopes = [*(-energy.diff(x) for x in q), *(energy.diff(x) for x in p)]
    constants = [mpmath.mpf(units.constants[x]) for x in system.constants]
    order = [names[x] for x in system.constants]
    function = sympy.lambdify([*order, names["t"], *p, *q], slopes, "mpmath")
    unit = mpmath.mpf(units.t)

    def field(z: Vector, t: Any) -> Vector:
        real = [x * y for x, y in zip(z, scale, strict=True)]
        after = function(*constants, t * unit, *real)
        return [mpmath.mpf(x) * unit / y for x, y in zip(after, scale, strict=True)]

    return field


@cache
def _gauss() -> tuple[Vector, list[Vector], Vector]:
    """Nodes, weights of the stages, and of the end."""
    with mpmath.workdps(DIGITS + 10):
        x = sympy.Symbol("x")
        roots = sympy.Poly(sympy.legendre(_STAGES, x), x).nroots(n=DIGITS + 10, maxsteps=200)
        nodes = sorted((1 + mpmath.mpf(str(root))) / 2 for root in roots)
        powers = mpmath.matrix([[c**k for c in nodes] for k in range(_STAGES)])

        def weights(end: Any) -> Vector:
            wanted = mpmath.matrix([end ** (k + 1) / (k + 1) for k in range(_STAGES)])
            return list(mpmath.lu_solve(powers, wanted))

        return nodes, [weights(c) for c in nodes], weights(mpmath.mpf(1))


def _order(step: Flow, flow: Flow, place: Vector) -> int:
    """By the least step sizes at which rounded coefficients do not count."""
    t, unclear = mpmath.mpf(_TIME.numerator) / _TIME.denominator, 0.0
    for halvings in _HALVINGS:
        apart = []
        for h in (mpmath.ldexp(1, -halvings), mpmath.ldexp(1, -halvings - 1)):
            ends = zip(step(place, h, t), flow(place, h, t), strict=True)
            apart.append(max(abs(x - y) for x, y in ends))
            if apart[-1] < _ROUNDED * h:
                break
        else:
            slope = float(mpmath.log(apart[0] / apart[1], 2))
            if abs(slope - round(slope)) < _CLEAR:
                return round(slope) - 1
            unclear = slope
    raise UnclearError(f"the error falls with h^{unclear:.3f}")


def _defect(step: Flow, place: Vector) -> Any:
    """The largest entry of JᵀΩJ − Ω, J by central differences far below it."""
    t, h = (mpmath.mpf(x.numerator) / x.denominator for x in (_TIME, _STEP))
    size, n, width = len(place), len(place) // 2, mpmath.mpf(10) ** -20
    columns = []
    for k in range(size):
        ends = [
            step([x + s * width * (i == k) for i, x in enumerate(place)], h, t) for s in (1, -1)
        ]
        columns.append([(x - y) / (2 * width) for x, y in zip(*ends, strict=True)])

    def form(x: Vector, y: Vector) -> Any:
        return sum(x[k] * y[n + k] - x[n + k] * y[k] for k in range(n))

    pairs = [(i, j) for i in range(size) for j in range(i)]
    return max(abs(form(columns[i], columns[j]) + (i == j + n)) for i, j in pairs)
