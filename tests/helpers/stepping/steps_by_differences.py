"""Steps in mpmath, all derivatives by differences; nothing of the toolkit.

z = (p1 … pn, q1 … qn), with n = 1 in the plane. With 400 digits a difference over 10⁻⁶⁰ is right to
10⁻¹²⁰ of its size, and four of them in one another are to 10⁻¹⁰⁰.
"""

from collections.abc import Callable, Sequence
from itertools import combinations
from typing import Any

import sympy
from mpmath.ctx_mp import MPContext

from tests.helpers.sampled.formulas import plain

mp = MPContext()
mp.dps = 400
EPSILON = mp.mpf(10) ** -60
State = list[Any]
Field = Callable[[State], State]
Step = Callable[[Field, State, Any], State]
Energy = Callable[..., Any]


def function_of(expression: str | sympy.Expr, names: Sequence[str]) -> Callable[..., Any]:
    """A formula by sympy's own reader as a function of these names, with all digits."""
    read = plain(expression) if isinstance(expression, str) else expression
    symbols = {x.name: x for x in read.free_symbols}
    digits = {name: getattr(mp, name) for name in dir(mp) if not name.startswith("_")}
    arguments = [symbols.get(name, sympy.Symbol(name)) for name in names]
    function: Callable[..., Any] = sympy.lambdify(arguments, read, [digits, "mpmath"])
    return function


def along(g: Callable[[State], State], z: State, v: State) -> State:
    """The derivative of g at z along v."""
    ends = [g([x + sign * EPSILON * y for x, y in zip(z, v, strict=True)]) for sign in (1, -1)]
    return [(a - b) / (2 * EPSILON) for a, b in zip(*ends, strict=True)]


def field(energy: Energy) -> Field:
    """f of H(p, q)."""

    def slopes(z: State) -> State:
        n = len(z) // 2
        unit = [[mp.mpf(i == k) for i in range(2 * n)] for k in range(2 * n)]
        gradient = [along(lambda y: [energy(*y)], z, unit[k])[0] for k in range(2 * n)]
        return [*(-x for x in gradient[n:]), *gradient[:n]]

    return slopes


def moved(z: State, *terms: tuple[Any, State]) -> State:
    return [x + sum(c * v[k] for c, v in terms) for k, x in enumerate(z)]


def lie(eta: int) -> Step:
    def step(f: Field, z: State, h: Any) -> State:
        powers: list[Field] = [f]
        for _ in range(eta - 1):
            powers.append(lambda y, g=powers[-1]: along(g, y, f(y)))  # type: ignore[misc]
        return moved(z, *((h**n / mp.factorial(n), g(z)) for n, g in enumerate(powers, start=1)))

    return step


def rk4(f: Field, z: State, h: Any) -> State:
    a = f(z)
    b = f(moved(z, (h / 2, a)))
    c = f(moved(z, (h / 2, b)))
    d = f(moved(z, (h, c)))
    return moved(z, (h / 6, a), (h / 3, b), (h / 3, c), (h / 6, d))


def explicit_midpoint(f: Field, z: State, h: Any) -> State:
    return moved(z, (h, f(moved(z, (h / 2, f(z))))))


def implicit_midpoint(f: Field, z: State, h: Any) -> State:
    after = z
    for _ in range(40):  # each time h smaller
        after = moved(z, (h, f([(x + y) / 2 for x, y in zip(z, after, strict=True)])))
    return after


def shear(kind: str, size: Any) -> Step:
    def step(f: Field, z: State, h: Any) -> State:
        n, v = len(z) // 2, f(z)
        kept = [x if (k < n) == (kind == "kick") else mp.mpf(0) for k, x in enumerate(v)]
        return moved(z, (size * h, kept))

    return step


def composed(*steps: Step) -> Step:
    def step(f: Field, z: State, h: Any) -> State:
        for each in steps:
            z = each(f, z, h)
        return z

    return step


HALF = mp.mpf(1) / 2
verlet = composed(shear("kick", HALF), shear("drift", mp.mpf(1)), shear("kick", HALF))
symplectic_euler = composed(shear("kick", mp.mpf(1)), shear("drift", mp.mpf(1)))


def columns_of(g: Callable[[State], State], z: State) -> list[State]:
    """The Jacobian of g at z, by columns."""
    unit = [[mp.mpf(i == k) for i in range(len(z))] for k in range(len(z))]
    return [along(g, z, each) for each in unit]


def jacobian(step: Step, energy: Energy, z: State, h: Any) -> list[State]:
    """By columns."""
    f = field(energy)
    return columns_of(lambda y: step(f, y, h), z)


def form_of(columns: Sequence[State]) -> dict[tuple[int, int], Any]:
    """JᵀΩJ − Ω, its entries a < b."""
    n, entries = len(columns) // 2, {}
    for a, b in combinations(range(2 * n), 2):
        u, v = columns[a], columns[b]
        areas = sum(u[i] * v[n + i] - u[n + i] * v[i] for i in range(n))
        entries[a, b] = areas - (b == a + n)
    return entries


def defect(step: Step, energy: Energy, z: State, h: Any) -> dict[tuple[int, int], Any]:
    """S = JᵀΩJ − Ω, its entries a < b."""
    return form_of(jacobian(step, energy, z, h))


def change_of_volume(step: Step, energy: Energy, z: State, h: Any) -> Any:
    """det J − 1."""
    return mp.det(mp.matrix(jacobian(step, energy, z, h))) - 1
