"""What a step keeps, in mpmath, and to which order in h; nothing of the toolkit.

The defect of one step is taken at two small h and at a large one, with 250 digits; derivatives by
differences over 10⁻⁹⁰. A defect that is 0 to 120 digits at all of them is 0; else its order is the
slope between the small ones, which at h = 2⁻²⁰ is a whole number to six digits. Where it is none
the leading coefficient is nearly 0 at the point, and smaller h are taken.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

import sympy
from mpmath.ctx_mp import MPContext

mp = MPContext()
mp.dps = 250
EPSILON = mp.mpf(10) ** -90
NOTHING = mp.mpf(10) ** -120
SMALL = tuple(mp.mpf(2) ** -n for n in (20, 30, 40, 50))
LARGE = mp.mpf(2) ** -5
State = list[Any]
Step = Callable[[State, Any, Any], State]  # of z, t, h
Formula = sympy.Expr

h, t = sympy.symbols("h t")


def function_of(expressions: Sequence[Formula], names: Sequence[str]) -> Callable[..., list[Any]]:
    """Formulas as one function of z and t, or of z, t and h."""
    digits = {name: getattr(mp, name) for name in dir(mp) if not name.startswith("_")}
    # Numbers of sympy would be made floats.
    exact = [sympy.sympify(x).replace(lambda y: y.is_Rational and not y.is_Integer, _as_mp)
             for x in expressions]  # fmt: skip
    digits["_ratio"] = lambda p, q: mp.mpf(p) / q
    symbols = [*(sympy.Symbol(name) for name in names), t, h]
    return sympy.lambdify(symbols, exact, [digits, "mpmath"])


_RATIO = sympy.Function("_ratio")


def _as_mp(x: sympy.Rational) -> Formula:
    return _RATIO(x.p, x.q)


@dataclass(frozen=True)
class Field:
    """z' = f(z, t), by formulas."""

    names: tuple[str, ...]
    slopes: tuple[Formula, ...]

    def terms(self, eta: int) -> list[list[Formula]]:
        """D z … D^η z, D = ∂_t + X."""
        symbols = [sympy.Symbol(name) for name in self.names]
        rows = [list(self.slopes)]
        while len(rows) < eta:
            rows.append(
                [
                    sympy.expand(
                        x.diff(t)
                        + sum(f * x.diff(z) for f, z in zip(self.slopes, symbols, strict=True))
                    )
                    for x in rows[-1]
                ]
            )
        return rows


def _moved(z: State, *terms: tuple[Any, State]) -> State:
    return [x + sum(c * v[k] for c, v in terms) for k, x in enumerate(z)]


def lie(f: Field, eta: int) -> Step:
    rows = [function_of(row, f.names) for row in f.terms(eta)]
    return lambda z, t0, s: _moved(
        z, *((s**n / mp.factorial(n), row(*z, t0, s)) for n, row in enumerate(rows, start=1))
    )


def runge_kutta(f: Field, rows: Sequence[Sequence[Any]], weights: Sequence[Any]) -> Step:
    """Of any tableau: the stages of an implicit one by iteration."""
    slopes, count = function_of(f.slopes, f.names), len(weights)
    clock = [sum(row) for row in rows]

    def step(z: State, t0: Any, s: Any) -> State:
        stages = [slopes(*z, t0 + c * s, s) for c in clock]
        for _ in range(2000):
            points = [_moved(z, *((s * a, k) for a, k in zip(row, stages, strict=True)))
                      for row in rows]  # fmt: skip
            after = [slopes(*y, t0 + c * s, s) for y, c in zip(points, clock, strict=True)]
            apart = max(abs(a - b) for x, y in zip(after, stages, strict=True)
                        for a, b in zip(x, y, strict=True))  # fmt: skip
            stages = after
            if apart < mp.mpf(10) ** -240:
                return _moved(z, *((s * b, k) for b, k in zip(weights, stages, strict=True)))
        raise ArithmeticError("the stages do not settle")

    assert len(clock) == count
    return step


def _ratio(text: str) -> Any:
    above, _, below = text.partition("/")
    return mp.mpf(above) / int(below or 1)


def _explicit(*rows: Sequence[str]) -> Callable[[Field], Step]:
    """The last row is of the weights."""
    count = len(rows) - 1
    numbers = [list(map(_ratio, row)) for row in rows]
    padded = [[*row, *[mp.mpf(0)] * (count - len(row))] for row in numbers]
    return lambda f: runge_kutta(f, padded[:-1], padded[-1])


def _gauss4(f: Field) -> Step:
    q, r = mp.mpf(1) / 4, mp.sqrt(3) / 6
    return runge_kutta(f, [[q, q - r], [q + r, q]], [mp.mpf(1) / 2] * 2)


def splitting(f: Field, parts: Sequence[tuple[str, Any]]) -> Step:
    """Kicks and drifts of H = T(p, t) + V(q, t)."""
    slopes, n = function_of(f.slopes, f.names), len(f.names) // 2

    def step(z: State, t0: Any, s: Any) -> State:
        clocks = {"kick": mp.mpf(0), "drift": mp.mpf(0)}
        for kind, size in parts:
            other = "drift" if kind == "kick" else "kick"
            slope = slopes(*z, t0 + clocks[other] * s, s)
            moves = range(n) if kind == "kick" else range(n, 2 * n)
            z = [x + s * size * slope[k] if k in moves else x for k, x in enumerate(z)]
            clocks[kind] += size
        return z

    return step


def _in_turn(*parts: tuple[str, str]) -> Callable[[Field], Step]:
    sized = [(kind, _ratio(size)) for kind, size in parts]
    return lambda f: splitting(f, sized)


SCHEMES: Mapping[str, Callable[[Field], Step]] = {
    "euler": _explicit((), ("1",)),
    "explicit-midpoint": _explicit((), ("1/2",), ("0", "1")),
    "rk4": _explicit((), ("1/2",), ("0", "1/2"), ("0", "0", "1"), ("1/6", "1/3", "1/3", "1/6")),
    "lie2": lambda f: lie(f, 2),
    "lie3": lambda f: lie(f, 3),
    "implicit-midpoint": lambda f: runge_kutta(f, [[mp.mpf(1) / 2]], [mp.mpf(1)]),
    "gauss4": _gauss4,
    "symplectic-euler": _in_turn(("kick", "1"), ("drift", "1")),
    "stormer-verlet": _in_turn(("kick", "1/2"), ("drift", "1"), ("kick", "1/2")),
    "position-verlet": _in_turn(("drift", "1/2"), ("kick", "1"), ("drift", "1/2")),
    "ruth3": _in_turn(
        ("kick", "7/24"), ("drift", "2/3"), ("kick", "3/4"), ("drift", "-2/3"),
        ("kick", "-1/24"), ("drift", "1"),
    ),
}  # fmt: skip
SPLITTINGS = ("symplectic-euler", "stormer-verlet", "position-verlet", "ruth3")


def by_formulas(names: Sequence[str], ends: Mapping[str, Formula]) -> Step:
    """z' by formulas, each of which may have those before it, by their names with `_next`."""
    images: dict[sympy.Symbol, Formula] = {}
    for name, x in ends.items():
        images[sympy.Symbol(f"{name}_next")] = sympy.sympify(x).xreplace(images)
    function = function_of([images[sympy.Symbol(f"{n}_next")] for n in names], names)
    return lambda z, t0, s: function(*z, t0, s)


@dataclass(frozen=True)
class Kept:
    """A structure by its formulas; `kind` names what they are."""

    kind: str  # integral volume form poisson reversible symmetric
    formulas: tuple[Formula, ...] = ()
    places: tuple[tuple[int, int], ...] = ()
    factor: Formula = field(default_factory=lambda: sympy.Integer(1))


def jacobian(step: Step, z: State, t0: Any, s: Any) -> Any:
    columns = []
    for k in range(len(z)):
        ends = [step([x + sign * EPSILON * (i == k) for i, x in enumerate(z)], t0, s)
                for sign in (1, -1)]  # fmt: skip
        columns.append([(a - b) / (2 * EPSILON) for a, b in zip(*ends, strict=True)])
    return mp.matrix(columns).T


def _two_form(kept: Kept, names: Sequence[str]) -> Callable[[State, Any, Any], Any]:
    values = function_of(kept.formulas, names)

    def matrix(z: State, t0: Any, s: Any) -> Any:
        result = mp.zeros(len(z), len(z))
        for (a, b), x in zip(kept.places, values(*z, t0, s), strict=True):
            result[a, b] += x
            result[b, a] -= x
        return result

    return matrix


def components(kept: Kept, names: Sequence[str], step: Step, z: State, t0: Any, s: Any) -> State:
    """The entries of the defect."""
    after = step(z, t0, s)
    if kept.kind == "symmetric":
        return [x - y for x, y in zip(step(after, t0 + s, -s), z, strict=True)]
    values = function_of(kept.formulas, names)
    if kept.kind == "reversible":
        turned = step(values(*after, t0, s), t0, s)
        return [x - y for x, y in zip(values(*turned, t0, s), z, strict=True)]
    if kept.kind == "integral":
        return [values(*after, t0 + s, s)[0] - values(*z, t0, s)[0]]
    j = jacobian(step, z, t0, s)
    if kept.kind == "volume":
        return [values(*after, t0 + s, s)[0] * mp.det(j) - values(*z, t0, s)[0]]
    matrix = _two_form(kept, names)
    old, new = matrix(z, t0, s), matrix(after, t0 + s, s)
    if kept.kind == "form":
        (c,) = function_of([kept.factor], names)(*z, t0, s)
        gap = j.T * new * j - c * old
    else:
        gap = j * old * j.T - new
    return [gap[a, b] for a, b in combinations(range(len(z)), 2)]


def leading_of(
    kept: Kept, names: Sequence[str], step: Step, z: State, t0: Any
) -> tuple[int | None, State]:
    """The order of the defect at a point, and the leading coefficients there, to eight digits."""
    order = order_of(kept, names, step, z, t0)
    s = mp.mpf(10) ** -11
    if order is None:
        return None, []
    return order, [x / s**order for x in components(kept, names, step, z, t0, s)]


def order_of(kept: Kept, names: Sequence[str], step: Step, z: State, t0: Any) -> int | None:
    """The power of h with which the defect begins at this point; None if it is 0."""

    def size(s: Any) -> Any:
        return max(map(abs, components(kept, names, step, z, t0, s)))

    large = size(LARGE)
    for s in SMALL:
        first, second = size(s), size(s / 2)
        if max(first, second, large) < NOTHING:
            return None
        if min(first, second) < NOTHING:
            text = f"the defect is 0 at small h, and {mp.nstr(large, 5)} at a large one"
            raise ArithmeticError(text)
        slope = mp.log(first / second, 2)
        if abs(slope - mp.nint(slope)) < 1e-4:
            return int(mp.nint(slope))
    raise ArithmeticError(f"the slope is {mp.nstr(slope, 8)}")
