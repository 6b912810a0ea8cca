"""Drawn steps in floats, right ones and ones with a planted error, in drawn units.

Nothing of the toolkit. A system has its field and its structures in units in which all is near 1;
the user's step, and the texts that a user would write, are in others, which are powers of two. What
is true of a step is what `tests.helpers.stepping.kept_structures` says of it in mpmath.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from random import Random
from typing import Any

import sympy

from tests.helpers.programs.kept_steps import compared, packed
from tests.helpers.programs.steps_of_any_numbers import (
    PLAIN,
    SPLIT,
    Field,
    Method,
    Vector,
    body,
    damped,
    lotka,
    midpoint,
    rk4,
)
from tests.helpers.stepping.kept_structures import (
    Formula,
    Kept,
    components,
    function_of,
    h,
    mp,
    order_of,
)

ONE = sympy.Integer(1)

# -- systems ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Structure:
    """`name` in --keeps, "" for a formula; `refinement`: the argument beside it."""

    name: str
    kept: Kept
    refinement: str = ""


@dataclass(frozen=True)
class System:
    """`energy`: None for equations."""

    names: tuple[str, ...]
    slopes: tuple[Formula, ...]
    structures: tuple[Structure, ...]
    methods: Mapping[str, Method]
    energy: Formula | None = None


def _symbols(text: str) -> tuple[Formula, ...]:
    return sympy.symbols(text)


def of_energy(text: str, names: str, *structures: Structure) -> System:
    symbols = _symbols(names)
    n, energy = len(symbols) // 2, sympy.sympify(text)
    slopes = (*(-energy.diff(x) for x in symbols[n:]), *(energy.diff(x) for x in symbols[:n]))
    usual = (
        Structure("symplectic", Kept("form", (ONE,) * n, tuple((k, n + k) for k in range(n)))),
        Structure("volume", Kept("volume", (ONE,))),
        Structure("energy", Kept("integral", (energy,))),
        Structure("reversible", Kept("reversible", (*(-x for x in symbols[:n]), *symbols[n:]))),
        Structure("symmetric", Kept("symmetric")),
    )
    return System(tuple(map(str, symbols)), slopes, usual + structures, {**SPLIT, **PLAIN}, energy)


p1, p2, q1, q2 = _symbols("p1 p2 q1 q2")
u, v, w, x, y, v1, v2, x1, x2 = _symbols("u v w x y v1 v2 x1 x2")
_ANGULAR = Structure("angular-momentum", Kept("integral", (q1 * p2 - q2 * p1,)))
_SQUARES = "p1**2 + p2**2 + q1**2 + q2**2"
_FORCE = x1 - x2 + (x1 - x2) ** 3
SYSTEMS: Mapping[str, System] = {
    "pendulum": of_energy("p**2/2 - cos(q)", "p q"),
    "duffing": of_energy("p**2/2 + q**2/2 + q**4/4", "p q"),
    "henon-heiles": of_energy(f"({_SQUARES})/2 + q1**2*q2 - q2**3/3", "p1 p2 q1 q2"),
    "kepler": of_energy("(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)", "p1 p2 q1 q2", _ANGULAR),
    "central": of_energy(f"({_SQUARES})/2 + (q1**2 + q2**2)**2/4", "p1 p2 q1 q2", _ANGULAR),
    "lotka": System(("u", "v"), (u * (v - 2), v * (1 - u)), (
        Structure("symplectic", Kept("form", (1 / (u * v),), ((0, 1),)), "form"),
        Structure("volume", Kept("volume", (1 / (u * v),)), "density"),
        Structure("poisson", Kept("poisson", (u * v,), ((0, 1),)), "poisson"),
        Structure("", Kept("integral", (u - sympy.log(u) + v - 2 * sympy.log(v),))),
        Structure("symmetric", Kept("symmetric")),
    ), {"lotka": lotka, "lotka again": lotka, "rk4": rk4, "implicit-midpoint": midpoint}),
    "body": System(("x", "y", "w"), (-y * w / 12, x * w / 6, -x * y / 12), (
        Structure("volume", Kept("volume", (ONE,))),
        Structure("poisson", Kept("poisson", (-w, y, -x), ((0, 1), (0, 2), (1, 2))), "poisson"),
        Structure("", Kept("integral", (x**2 + y**2 + w**2,))),
        Structure("symmetric", Kept("symmetric")),
        Structure("reversible", Kept("reversible", (-x, -y, -w)), "reverses"),
    ), {"body": body, "body again": body, **PLAIN}),
    "damped": System(("v", "x"), (-x - x**3 - v / 8, v), (
        Structure("conformal", Kept("form", (ONE,), ((0, 1),), sympy.exp(-h / 8)), "factor"),
        Structure("symmetric", Kept("symmetric")),
    ), {"damped": damped, "damped again": damped, "rk4": rk4}),
    "masses": System(("v1", "v2", "x1", "x2"), (-_FORCE, _FORCE / 3, v1, v2), (
        Structure("symplectic", Kept("form", (ONE, 3 * ONE), ((0, 2), (1, 3))), "form"),
        Structure("volume", Kept("volume", (ONE,))),
        Structure("", Kept("integral", (v1 + 3 * v2,))),
        Structure("", Kept("integral", (v1**2 / 2 + 3 * v2**2 / 2 + (x1 - x2) ** 2 / 2
                                        + (x1 - x2) ** 4 / 4,))),
        Structure("reversible", Kept("reversible", (-v1, -v2, x1, x2)), "reverses"),
    ), {**SPLIT, **PLAIN}),
}  # fmt: skip

# -- planted errors --------------------------------------------------------------------------------

MAP_EXPONENT = 2
Mistake = Callable[[Vector, Vector, Any, Any], Vector]  # of z, z', h and its size


def _first(end: Vector, x: Any) -> Vector:
    return [end[0] + x, *end[1:]]


MISTAKES: Mapping[str, Mistake] = {
    "friction": lambda z, end, h, size: _first(end, -size * h * end[0]),
    "push": lambda z, end, h, size: _first(end, size * h),
    "twist": lambda z, end, h, size: _first(end, size * h * end[0] * end[-1]),
    "late": lambda z, end, h, size: _first(end, size * h**3 * z[0] * z[-1]),
    "raw push": lambda z, end, h, size: _first(end, size * h),  # of that size in the user's units
}


@dataclass(frozen=True)
class DrawnStep:
    """A step of a system: its method, its mistake, "" for none, and its units.

    `units`: of the coordinates and of time; `probe`: how the code may be read; `size`: of the
    mistake, in the units in which all is near 1. `is_map`: True if h is 2^−MAP_EXPONENT alone.
    """

    system: System
    method: str
    mistake: str
    size: float
    units: tuple[float, ...]
    time: float
    probe: str
    is_map: bool = False

    def _step(self, numbers: Any, f: Field) -> Callable[[Vector, Any], Vector]:
        method, mistake = self.system.methods[self.method], MISTAKES.get(self.mistake)
        size = self.size if numbers is math else mp.mpf(self.size)

        def step(z: Vector, h: Any) -> Vector:
            end = method(numbers, f, z, h)
            return mistake(z, end, h, size) if mistake else end

        return step

    @property
    def function(self) -> Callable[..., Any]:
        """The user's step of p, q and h, or of z and h; or the map of z."""
        symbols, units, time = _symbols(" ".join(self.system.names)), self.units, self.time
        f = sympy.lambdify(symbols, self.system.slopes, "math")
        plain, n = self._step(math, lambda z: f(*z)), len(units) // 2

        def scaled(z: Vector, h: Any) -> Vector:
            parts = [x / unit for x, unit in zip(z, units, strict=True)]
            return [x * unit for x, unit in zip(plain(parts, h / time), units, strict=True)]

        step = {"as it is": lambda x: x, "duals": compared, "floats": packed}[self.probe](scaled)
        if self.is_map:
            return lambda z: step([*z], time / 2**MAP_EXPONENT)
        if self.system.energy is None:
            return lambda z, h: step([*z], h)
        if n == 1:
            return lambda p, q, h: step([p, q], h)

        def halves(p: Any, q: Any, h: Any) -> tuple[Vector, Vector]:
            end = step([*p, *q], h)
            return end[:n], end[n:]

        return halves

    # -- what is true, by mpmath -------------------------------------------------------------------

    @cached_property
    def in_mpmath(self) -> Callable[[Vector, Any, Any], Vector]:
        f = function_of(self.system.slopes, self.system.names)
        plain = self._step(mp, lambda z: f(*z, 0, 0))
        return lambda z, t, s: plain(z, s)

    @cached_property
    def points(self) -> tuple[Vector, ...]:
        count, rng = len(self.units), Random(str(self.units))  # noqa: S311 - no secret
        return tuple([mp.mpf(rng.randint(300, 1300)) / 1000 for _ in range(count)] for _ in "ab")

    @property
    def point(self) -> tuple[float, ...] | None:
        """A state that the user gives; None where the system has a scale that tells where to look,
        or the error of the step has none either. A map has nothing that tells."""
        scaled = self.system is not SYSTEMS["kepler"] or self.mistake in ("", "friction")
        scaled = scaled and not self.is_map
        state = zip(self.points[0], self.units, strict=True)
        return None if scaled else tuple(float(x) * unit for x, unit in state)

    def order(self, kept: Kept) -> int | None:
        """The order of the defect; None if it is 0."""
        names = self.system.names
        orders = [order_of(kept, names, self.in_mpmath, z, mp.mpf(0)) for z in self.points]
        return min((n for n in orders if n is not None), default=None)

    def defect(self, kept: Kept, exponent: int) -> float:
        """The largest entry of the defect at h = 2^−exponent, in units in which all is near 1."""
        s, names = mp.mpf(2) ** -exponent, self.system.names
        return max(float(abs(x)) for z in self.points
                   for x in components(kept, names, self.in_mpmath, z, mp.mpf(0), s))  # fmt: skip

    # -- what a user writes ------------------------------------------------------------------------

    def formula(self, x: Formula) -> Formula:
        """A formula in the user's units; its value is as before."""
        images = zip(_symbols(" ".join(self.system.names)), self._exact, strict=True)
        return x.xreplace({z: z / unit for z, unit in images} | {h: h / self._ratio(self.time)})

    @staticmethod
    def _ratio(x: float) -> sympy.Rational:
        return sympy.Rational(*x.as_integer_ratio())

    @property
    def _exact(self) -> list[sympy.Rational]:
        return list(map(self._ratio, self.units))

    @property
    def system_text(self) -> str:
        exact, time, system = self._exact, self._ratio(self.time), self.system
        if system.energy is not None:
            return str(exact[0] * exact[-1] / time * self.formula(system.energy))
        return "; ".join(
            f"{name}_dot = {unit / time * self.formula(x)}"
            for name, unit, x in zip(system.names, exact, system.slopes, strict=True)
        )

    def request(self, structure: Structure) -> tuple[str, dict[str, str]]:
        """What is in --keeps, and the refinement beside it."""
        kept, names, exact = structure.kept, self.system.names, self._exact
        x = [self.formula(y) for y in kept.formulas]
        if not structure.name or (self.is_map and kept.kind == "integral"):
            return str(x[0]), {}
        form = " + ".join(f"({y / exact[a] / exact[b]})*d{names[a]}^d{names[b]}"
                          for y, (a, b) in zip(x, kept.places, strict=False))  # fmt: skip
        matrix = sympy.zeros(len(names), len(names))
        for y, (a, b) in zip(x, kept.places, strict=False):
            matrix[a, b], matrix[b, a] = y * exact[a] * exact[b], -y * exact[a] * exact[b]
        rows = "; ".join(", ".join(map(str, matrix.row(k))) for k in range(len(names)))
        texts = {
            "": {}, "form": {"form": form}, "density": {"density": str(x[0]) if x else ""},
            "poisson": {"poisson": rows},
            "reverses": {"reverses": ", ".join(str(y * e) for y, e in zip(x, exact, strict=False))},
            "factor": {"form": form, "factor": str(self.formula(kept.factor))},
        }  # fmt: skip
        if self.is_map and structure.refinement == "factor":
            rate = kept.factor.subs(h, sympy.Integer(2) ** -MAP_EXPONENT)
            return structure.name, {"form": form, "factor": str(rate)}
        return structure.name, texts[structure.refinement]


def drawn_step(seed: int, number: int) -> tuple[DrawnStep, list[tuple[Structure, int | None]]]:
    """The step of that number, and claims on it: its structures, each with an order that is claimed
    of its defect, or None if that is claimed to be 0."""
    rng = Random(f"{seed}/{number}")  # noqa: S311 - no secret
    system = list(SYSTEMS.values())[number % len(SYSTEMS)]
    by_letter = {name[0]: 2.0 ** rng.randint(-20, 20) for name in system.names}
    units = tuple(by_letter[name[0]] for name in system.names)
    mistake = rng.choice(["", "", *MISTAKES])
    time, size = 2.0 ** rng.randint(-20, 20), 10.0 ** -rng.randint(1, 9)
    if mistake == "raw push":
        size = size * time / units[0]
    step = DrawnStep(system, rng.choice(list(system.methods)), mistake, size, units, time,
                     rng.choice(["as it is", "duals", "floats"]))  # fmt: skip
    structures = rng.sample(system.structures, min(len(system.structures), rng.randint(3, 5)))
    claims = []
    for structure in structures:
        order, sort = step.order(structure.kept), rng.randrange(4)
        exact = sort == 0 or (order is None and sort < 3)
        claims.append((structure, None if exact else max(1, (order or 4) + sort - 2)))
    return step, claims
