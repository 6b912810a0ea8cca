"""Drawn claims that a step keeps a structure, true and false, with the structure in sympy's terms.

Nothing of the toolkit: a claim is texts, as a user writes them, and beside them the field, the step
and the structure for `tests.helpers.stepping.kept_structures`. Every seed has its own claims.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from random import Random
from typing import Any

import sympy

from tests.helpers.stepping.kept_structures import (
    SCHEMES,
    SPLITTINGS,
    Field,
    Kept,
    Step,
    by_formulas,
    h,
    mp,
    order_of,
    t,
)

Formula = sympy.Expr
_COEFFICIENTS = ("1", "-1", "2", "1/2", "-1/3", "3/2")
_ANY = ("euler", "explicit-midpoint", "rk4", "lie2", "lie3", "implicit-midpoint", "gauss4")


@dataclass(frozen=True)
class Drawn:
    """A system with a structure, before a scheme is chosen. `separable`: H = T(p, t) + V(q, t)."""

    system: str
    field: Field
    request: Mapping[str, Any]
    kept: Kept
    of_flow: bool = True
    separable: bool = False
    formulas: Mapping[str, Formula] | None = None  # the step's own


@dataclass(frozen=True)
class KeptClaim:
    """A claim: `claimed` is the order behind the colon, None for a defect that is 0."""

    drawn: Drawn
    scheme: str
    claimed: int | None
    points: tuple[tuple[str, ...], ...] = field(repr=False)

    @property
    def request(self) -> dict[str, Any]:
        """The arguments of a KeepsRequest."""
        request = dict(self.drawn.request)
        order = "" if self.claimed is None else f": {self.claimed}"
        return {**request, "keeps": (request["keeps"] + order,)}

    @property
    def step(self) -> Step:
        if self.drawn.formulas is not None:
            return by_formulas(self.drawn.field.names, self.drawn.formulas)
        return SCHEMES[self.scheme](self.drawn.field)

    def order(self) -> int | None:
        """The order of the defect by the oracle; None if it is 0."""
        names = self.drawn.field.names
        orders = [
            order_of(self.drawn.kept, names, self.step, list(map(mp.mpf, z)), mp.mpf("0.3"))
            for z in self.points
        ]
        return min((x for x in orders if x is not None), default=None)

    def holds(self, order: int | None) -> bool:
        """Whether the claim is true of a defect of that order."""
        return order is None or (self.claimed is not None and order >= self.claimed)


def polynomial(rng: Random, symbols: Sequence[Formula], degree: int, terms: int) -> Formula:
    total = sympy.Integer(0)
    for _ in range(terms):
        powers = rng.choices(symbols, k=rng.randint(1, degree))
        total += sympy.Rational(rng.choice(_COEFFICIENTS)) * sympy.Mul(*powers)
    return sympy.expand(total)


def text(x: Formula) -> str:
    return sympy.sstr(x)


def _symbols(*names: str) -> list[Formula]:
    return [sympy.Symbol(name) for name in names]


def _equations(names: Sequence[str], slopes: Sequence[Formula]) -> str:
    return "; ".join(f"{n}_dot = {text(x)}" for n, x in zip(names, slopes, strict=True))


def _of_energy(
    energy: Formula, names: Sequence[str], request: Mapping[str, Any], kept: Kept, **more: Any
) -> Drawn:
    symbols, n = _symbols(*names), len(names) // 2
    slopes = (*(-energy.diff(x) for x in symbols[n:]), *(energy.diff(x) for x in symbols[:n]))
    mixed = [energy.diff(x, y) for x in symbols[:n] for y in symbols[n:]]
    separable = all(sympy.expand(x) == 0 for x in mixed)
    return Drawn(text(energy), Field(tuple(names), tuple(map(sympy.expand, slopes))), request, kept,
                 separable=separable, **more)  # fmt: skip


def _canonical(n: int) -> Kept:
    one = sympy.Integer(1)
    return Kept("form", (one,) * n, tuple((k, n + k) for k in range(n)))


def _of_any_energy(rng: Random, energy: Formula, names: Sequence[str]) -> Drawn:
    """With what any H has; reversibility only if it is even in p."""
    n, one = len(names) // 2, sympy.Integer(1)
    symbols = _symbols(*names)
    even = sympy.expand(energy.subs({p: -p for p in symbols[:n]}, simultaneous=True) - energy) == 0
    kinds = ["energy", "symplectic", "volume", "symmetric", *["reversible"] * (2 * even)]
    turned = (*(-p for p in symbols[:n]), *symbols[n:])
    kept = {
        "energy": Kept("integral", (energy,)), "symplectic": _canonical(n),
        "volume": Kept("volume", (one,)), "symmetric": Kept("symmetric"),
        "reversible": Kept("reversible", turned),
    }  # fmt: skip
    kind = rng.choice(kinds)
    return _of_energy(energy, names, {"keeps": kind}, kept[kind])


def planar(rng: Random) -> Drawn:
    p, q = symbols = _symbols("p", "q")
    if rng.random() < 0.6:
        kinetic = rng.choice([p**2 / 2, p**2 + p**4 / 4, p**3 / 3 + p**2])
        energy = kinetic + q**2 * rng.choice([0, 1]) + polynomial(rng, [q], 4, 2)
    else:
        energy = p**2 + q**2 + polynomial(rng, symbols, 3, 2)
    return _of_any_energy(rng, sympy.expand(energy), ("p", "q"))


def two_degrees(rng: Random) -> Drawn:
    names = ("p1", "p2", "q1", "q2")
    p1, p2, q1, q2 = symbols = _symbols(*names)
    square = sympy.Rational(1, 2) * (p1**2 + p2**2)
    angular = q1 * p2 - q2 * p1
    sort = rng.randrange(4)
    if sort == 0:
        energy = square + polynomial(rng, [q1, q2], 3, 3)
        return _of_any_energy(rng, sympy.expand(energy), names)
    if sort == 1:
        energy = square + polynomial(rng, symbols, 3, 2)
        return _of_any_energy(rng, sympy.expand(energy), names)
    if sort == 2:
        u = q1 - q2
        energy = square + polynomial(rng, [u], 4, 2) + rng.choice([0, 1]) * p1 * p2 * u
        total = Kept("integral", (p1 + p2,))
        return _of_energy(sympy.expand(energy), names, {"keeps": "momentum"}, total)
    r = q1**2 + q2**2
    parts = [r, r**2 / 4, angular, 2 * square * r, angular**2, (p1 * q1 + p2 * q2) ** 2]
    energy = square + sum(rng.sample(parts, rng.randint(1, 2)))
    return _of_energy(
        sympy.expand(energy), names, {"keeps": "angular-momentum"}, Kept("integral", (angular,))
    )


def in_time(rng: Random) -> Drawn:
    p, q = symbols = _symbols("p", "q")
    drive = rng.choice([t, t**2, sympy.cos(t), 1 + t])
    energy = p**2 / 2 + q**2 / 2 + drive * polynomial(rng, [q], 3, 1)
    if rng.random() < 0.4:
        energy += polynomial(rng, symbols, 2, 1) * t
    kind, kept = rng.choice(
        [("volume", Kept("volume", (sympy.Integer(1),))), ("area", _canonical(1)),
         ("symmetric", Kept("symmetric"))]
    )  # fmt: skip
    return _of_energy(sympy.expand(energy), ("p", "q"), {"keeps": kind}, kept)


def nambu(rng: Random) -> Drawn:
    """x' = ∇C × ∇I: two integrals, volume, and the bracket with the Casimir C."""
    names = ("x", "y", "z")
    symbols = _symbols(*names)
    x, y, z = symbols
    casimir = rng.choice([x**2 + y**2 + z**2, x + y * z, x**2 / 2 - z, x * y + z**2])
    integral = polynomial(rng, symbols, 2, 3)
    b, c = ([f.diff(w) for w in symbols] for f in (integral, casimir))
    # {z_a, z_b} = ε_abc ∂_c C, and z' = B ∇I.
    entries = (c[2], -c[1], c[0])
    matrix = sympy.zeros(3, 3)
    for (i, j), e in zip(((0, 1), (0, 2), (1, 2)), entries, strict=True):
        matrix[i, j], matrix[j, i] = e, -e
    slopes = tuple(map(sympy.expand, matrix * sympy.Matrix(b)))
    rows = "; ".join(", ".join(text(e) for e in matrix.row(k)) for k in range(3))
    request: Mapping[str, Any]
    request, kept = rng.choice([
        ({"keeps": text(integral)}, Kept("integral", (integral,))),
        ({"keeps": text(casimir)}, Kept("integral", (casimir,))),
        ({"keeps": "volume"}, Kept("volume", (sympy.Integer(1),))),
        ({"keeps": "poisson", "poisson": rows},
         Kept("poisson", entries, ((0, 1), (0, 2), (1, 2)))),
        ({"keeps": "symmetric"}, Kept("symmetric")),
    ])  # fmt: skip
    return Drawn(_equations(names, slopes), Field(names, slopes), request, kept)


def with_density(rng: Random) -> Drawn:
    """u' = g H_v, v' = −g H_u: the density 1/g, the form du∧dv/g and the bracket g."""
    names = ("u", "v")
    u, v = symbols = _symbols(*names)
    g = rng.choice([u * v, u, 1 + u**2, v**2 + 1])
    energy = polynomial(rng, symbols, 2, 3)
    slopes = (sympy.expand(g * energy.diff(v)), sympy.expand(-g * energy.diff(u)))
    dense = f"1/({text(g)})"
    request, kept = rng.choice([
        ({"keeps": "volume", "density": dense}, Kept("volume", (1 / g,))),
        ({"keeps": "symplectic", "form": f"du^dv/({text(g)})"}, Kept("form", (1 / g,), ((0, 1),))),
        ({"keeps": "symplectic", "form": f"2*dv^du*{dense}"}, Kept("form", (-2 / g,), ((0, 1),))),
        ({"keeps": "poisson", "poisson": f"0, {text(g)}; {text(-g)}, 0"},
         Kept("poisson", (g,), ((0, 1),))),
        ({"keeps": text(energy)}, Kept("integral", (energy,))),
    ])  # fmt: skip
    return Drawn(_equations(names, slopes), Field(names, slopes), request, kept)


def damped(rng: Random) -> Drawn:
    """Damping by −κ v: conformal, by schemes of fields and by a step that is meant for it."""
    names = ("v", "x")
    v, x = _symbols(*names)
    kappa = sympy.Rational(rng.choice(["1", "1/2", "2"]))
    slopes = (sympy.expand(-polynomial(rng, [x], 3, 2) - kappa * v), v)
    factor = f"exp(-{kappa}*h)"
    kept = Kept("form", (sympy.Integer(1),), ((0, 1),), sympy.exp(-kappa * h))
    formulas = None
    if rng.random() < 0.5:
        kick = (slopes[0] + kappa * v).subs(x, sympy.Symbol("x_next"))
        formulas = {"x": x + h * v, "v": sympy.exp(-kappa * h) * (v + h * kick)}
    request = {"keeps": "conformal", "form": "dv^dx", "factor": factor}
    return Drawn(_equations(names, slopes), Field(names, slopes), request, kept, formulas=formulas)


def masses(rng: Random) -> Drawn:
    """Two bodies on a line in positions and velocities, by a field and by a Verlet step."""
    names = ("v1", "v2", "x1", "x2")
    v1, v2, x1, x2 = _symbols(*names)
    m1, m2 = (sympy.Rational(rng.choice(["1", "2", "3", "1/2"])) for _ in range(2))
    potential = polynomial(rng, [x1 - x2], 4, 2)
    slopes = (*(sympy.expand(-potential.diff(x) / m) for x, m in ((x1, m1), (x2, m2))), v1, v2)
    energy = m1 * v1**2 / 2 + m2 * v2**2 / 2 + potential
    form = f"{m1}*dv1^dx1 + {m2}*dv2^dx2"
    request, kept = rng.choice([
        ({"keeps": "symplectic", "form": form}, Kept("form", (m1, m2), ((0, 2), (1, 3)))),
        ({"keeps": text(sympy.expand(energy))}, Kept("integral", (energy,))),
        ({"keeps": f"{m1}*v1 + {m2}*v2"}, Kept("integral", (m1 * v1 + m2 * v2,))),
        ({"keeps": "reversible", "reverses": "-v1, -v2, x1, x2"},
         Kept("reversible", (-v1, -v2, x1, x2))),
    ])  # fmt: skip
    formulas = None
    if rng.random() < 0.5:
        ends = {f"x{k}": sympy.Symbol(f"x{k}_next") for k in (1, 2)}
        late = {sympy.Symbol(k): x for k, x in ends.items()}
        formulas = {"x1": x1 + h * v1 + h**2 / 2 * slopes[0],
                    "x2": x2 + h * v2 + h**2 / 2 * slopes[1]}  # fmt: skip
        for k, v in ((1, v1), (2, v2)):
            formulas[f"v{k}"] = v + h / 2 * (slopes[k - 1] + slopes[k - 1].subs(late))
    return Drawn(_equations(names, slopes), Field(names, slopes), request, kept, formulas=formulas)


def turned(rng: Random) -> Drawn:
    """f = g − ρ g∘ρ for any g, so that ρ turns the flow round."""
    names = ("x", "y", "z")[: rng.choice([2, 3])]
    symbols = _symbols(*names)
    x, y = symbols[:2]
    reflection = (*rng.choice([(-x, y), (y, x), (x, -y), (-y, -x)]), *symbols[2:])
    g = [polynomial(rng, symbols, 2, 2) for _ in symbols]
    images = dict(zip(symbols, reflection, strict=True))
    after = [w.xreplace(images) for w in g]
    back = [w.xreplace(dict(zip(symbols, after, strict=True))) for w in reflection]
    slopes = tuple(sympy.expand(a - b) for a, b in zip(g, back, strict=True))
    request = {"keeps": "reversible", "reverses": ", ".join(map(text, reflection))}
    return Drawn(_equations(names, slopes), Field(names, slopes), request,
                 Kept("reversible", reflection))  # fmt: skip


def written(rng: Random) -> Drawn:
    """Shears one after the other, which keep volume, some with a term of a high power of h."""
    names = ("x", "y", "z")[: rng.choice([2, 3])]
    symbols = _symbols(*names)
    slopes, formulas, images = [], {}, {}
    for name, x in zip(names, symbols, strict=True):
        slope = polynomial(rng, [y for y in symbols if y is not x], 2, 2)
        slopes.append(slope)
        formulas[name] = x + h * slope.xreplace(images)
        images[x] = sympy.Symbol(f"{name}_next")
    if rng.random() < 0.6:
        name = rng.choice(names)
        power = rng.randint(2, 14)
        formulas[name] += h**power * polynomial(rng, symbols, 2, 1)
    kept = Kept("volume", (sympy.Integer(1),))
    return Drawn(_equations(names, slopes), Field(names, tuple(slopes)), {"keeps": "volume"}, kept,
                 formulas=formulas)  # fmt: skip


def not_kept(rng: Random) -> Drawn:
    """A structure that is not one of the flow: an integral or a density with a term too much."""
    drawn = rng.choice([nambu, with_density, masses])(rng)
    symbols = _symbols(*drawn.field.names)
    extra = rng.choice(symbols) ** rng.randint(1, 2)
    if rng.random() < 0.5:
        integral = polynomial(rng, symbols, 2, 2) + extra
        request, kept = {"keeps": text(integral)}, Kept("integral", (integral,))
    else:
        density = 3 + extra
        request = {"keeps": "volume", "density": text(density)}
        kept = Kept("volume", (density,))
    return replace(drawn, request=request, kept=kept, of_flow=False)


FAMILIES: Sequence[Callable[[Random], Drawn]] = (
    planar, two_degrees, in_time, nambu, with_density, damped, masses, turned, written, not_kept,
)  # fmt: skip


def _is_kept_by_flow(drawn: Drawn) -> bool:
    """By the oracle: the defect of Euler's step begins with h², or later."""
    points = _points(Random(1), drawn)  # noqa: S311 - no secret
    order = KeptClaim(replace(drawn, formulas=None), "euler", None, points).order()
    return order is None or order > 1


def _points(rng: Random, drawn: Drawn) -> tuple[tuple[str, ...], ...]:
    count = len(drawn.field.names)
    return tuple(tuple(f"{rng.randint(300, 1300)}e-3" for _ in range(count)) for _ in range(2))


def kept_claim(seed: int, number: int) -> KeptClaim:
    """The claim of this number; its claimed order is 0, the true one, one too high or one too low,
    by the oracle."""
    rng = Random(f"{seed}/{number}")  # noqa: S311 - no secret
    drawn = FAMILIES[number % len(FAMILIES)](rng)
    if drawn.request["keeps"] in ("0", "") or all(x == 0 for x in drawn.field.slopes):
        return kept_claim(seed + 1000, number)
    if not drawn.of_flow:
        drawn = replace(drawn, of_flow=_is_kept_by_flow(drawn))
    schemes = (*_ANY, *SPLITTINGS * 2) if drawn.separable else _ANY
    if drawn.separable and drawn.field.names[0][0] != "p":
        schemes = _ANY
    scheme = rng.choice(schemes)
    if drawn.formulas is not None:
        scheme = "; ".join(f"{n}_next = {text(x)}" for n, x in drawn.formulas.items())
    claim = KeptClaim(drawn, scheme, None, _points(rng, drawn))
    order, sort = claim.order(), rng.randrange(4)
    if sort == 0 or (order is None and sort < 3):
        return claim
    return replace(claim, claimed=max(1, (order or 4) + (sort - 2)))
