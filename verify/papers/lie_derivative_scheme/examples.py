"""The examples in arguments: the paper's two systems, the oscillator, and maps of the criteria.

The oscillator H = (p² + q²)/2 from (q, p) = (1, 0) has an exact solution. With ζ = q + ip a step of
lieη is ζ' = R ζ, R = Σ (−ih)ⁿ/n!, n = 0 … η, and the exact solution is exp(−it). Balls (flint)
enclose the error; everything else is exact.

The maps separate the criteria. T is fixed, N = T/h steps; each has closed forms of its ΔJ, MSE and
Λ, which are held against the map itself, run in Fractions.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from math import prod

import flint
import sympy

from verify.algebra.formula import parse
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import NUMBERS, Check, same
from verify.papers.exact_maps import Areas, RationalPoint, areas, map_from_texts
from verify.schemes.maps.step_map import StepMap
from verify.schemes.methods.taylor.lie import lie_map

SYSTEMS = ("duffing", "pendulum")


def with_symbols(name: str) -> Hamiltonian:
    """Return the H of that system, its parameters symbols."""
    return Hamiltonian(systems.get(name).hamiltonian().expression)


def duffing() -> Hamiltonian:
    """Return the Duffing oscillator with δ = 1."""
    return systems.get("duffing").hamiltonian().with_values({"delta": 1})


def duffing_step() -> StepMap:
    """Return the map of lie2 for the Duffing oscillator with δ = 1."""
    return lie_map(duffing(), 2)


# -- the oscillator -------------------------------------------------------------------------------


def oscillator() -> Hamiltonian:
    """Return H = (p² + q²)/2."""
    return systems.get("harmonic").hamiltonian().with_values({"omega": 1})


def enclosures() -> AbstractContextManager[None]:
    """Return the context in which balls have 256 bits."""
    return working_precision(256)


def factor(eta: int, h: Fraction) -> flint.acb:
    """Return R as a complex ball, in the caller's precision."""
    # z = −ih, and R is the exponential series of it up to zⁿ/n!.
    z = flint.acb(0, -rational_ball(h))
    total = term = flint.acb(1)
    for n in range(1, eta + 1):
        term = term * z / n
        total += term
    return total


def errors(eta: int, h: Fraction, steps: int) -> list[flint.acb]:
    """Return the errors exp(−ikh) − Rᵏ, k = 0 … steps, of the run from the exact solution.

    To be called in `enclosures()`.
    """
    # The exact solution turns by exp(−ih) in each step, the scheme multiplies by R.
    exact = flint.acb(0, -rational_ball(h)).exp()
    scheme = factor(eta, h)
    differences, rotation, image = [], flint.acb(1), flint.acb(1)
    for _ in range(steps + 1):
        differences.append(rotation - image)
        rotation, image = rotation * exact, image * scheme
    return differences


def final_error(eta: int, steps: int) -> flint.arb:
    """Return the norm of the error at T = 1 after `steps` steps, a real ball."""
    with enclosures():
        return abs(errors(eta, Fraction(1, steps), steps)[-1])


# -- maps that separate the criteria --------------------------------------------------------------

Numbers = tuple[Fraction, Fraction, Fraction]  # max |ΔJ|, MSE, Λ


@dataclass(frozen=True)
class ExampleMap:
    """A map from `start`, run over T = 1 with N steps for each N in `steps`.

    `delta_j`: its ΔJ as a formula in p, q and h. `closed(h)`: what max |ΔJ|, MSE and Λ are; `says`:
    the same in words, and what follows.
    """

    name: str
    p_next: str
    q_next: str
    start: RationalPoint
    steps: tuple[int, ...]
    closed: Callable[[Fraction], Numbers]
    says: str
    delta_j: str

    def run(self, steps: int) -> Areas:
        """Return ΔJ along the run of so many steps over T = 1."""
        return _run(self.p_next, self.q_next, self.start, steps)

    def check(self) -> Check:
        """Check that the map has the stated numbers, exactly, for each N."""
        holds, texts = True, []
        for n in self.steps:
            run_areas = self.run(n)
            holds = holds and (run_areas.largest, run_areas.mse, run_areas.lam) == self.closed(
                Fraction(1, n)
            )
            texts.append(
                f"N = {n}: max |ΔJ| = {_short(run_areas.largest)}, MSE = {_short(run_areas.mse)}, "
                f"Λ = {_short(run_areas.lam)}"
            )
        setting = (
            f"{self.name}: p' = `{self.p_next}`, q' = `{self.q_next}`, from {self.start}, T = 1"
        )
        return Check(f"{setting}: {self.says}", holds, "; ".join(texts), NUMBERS)

    def changes(self) -> Check:
        """Check that its ΔJ is the stated formula, at every point and for every h."""
        names = ("p", "q", "h")
        printed = parse(self.delta_j, names, source=self.name)
        computed = map_from_texts(self.p_next, self.q_next).delta_j
        return same(f"{self.name}: ΔJ − (`{self.delta_j}`)", [computed - printed], names)


# Runs are cached, as several arguments use the same maps.
@cache
def _run(p_next: str, q_next: str, start: RationalPoint, steps: int) -> Areas:
    return areas(map_from_texts(p_next, q_next), start, Fraction(1, steps), steps)


def _short(x: Fraction) -> str:
    return f"`{decimal(x, 3)}`"


def shrinks_to(limit: sympy.Expr = -sympy.S.One) -> Check:
    """Check log(1 − h + h²)/h → −1: with friction every area shrinks to 1/e over [0, 1]."""
    h = sympy.Symbol("h", positive=True)
    computed = sympy.limit(sympy.log(1 - h + h**2) / h, h, 0)
    return Check("friction: log(1 − h + h²)/h for h → 0", computed == limit, f"`{computed}`")


def turns_to_and_fro(sign: int = 1) -> Check:
    """Check two successive steps, e = √h: det J multiplies to 1, and the sizes of their ΔJ."""
    e = sympy.Symbol("e", positive=True)
    down, up = -2 * e / (1 + e), sign * 2 * e / (1 - e)
    gaps = [
        (1 + down) * (1 + up) - 1,
        (down**2 + up**2) / 2 - 4 * e**2 * (1 + e**2) / (1 - e**2) ** 2,
        -down - e - e * (1 - e) / (1 + e),
    ]
    statement = (
        "to and fro, e = √h: the product of two factors less 1, the MSE less 4e²(1 + e²)/(1 − "
        "e²)², and |`ΔJ_0`| − e less e(1 − e)/(1 + e)"
    )
    return same(statement, gaps, ("e",))


def _root(h: Fraction) -> Fraction:
    """Return √h for h = 1/n²."""
    # The root is rational only if h = 1/n², so that the map with √h stays within Fractions.
    n = round(h.denominator**0.5)
    if n * n * h != 1:
        raise ValueError("h is not 1/n²")
    return Fraction(1, n)


def _friction(h: Fraction) -> Numbers:
    x = -h + h * h
    return abs(x), x * x, (1 + x) ** int(1 / h) - 1


def _to_and_fro(h: Fraction) -> Numbers:
    """Return the numbers where ΔJ alternates between −2ε/(1 + ε) and 2ε/(1 − ε), ε = √h.

    For odd N there is one contraction
    more than expansions."""
    # A contraction and the expansion after it multiply to 1, so that Λ = 0 after even N.
    e, n = _root(h), int(1 / h)
    down, up, odd = -2 * e / (1 + e), 2 * e / (1 - e), n % 2
    return up, ((n + odd) * down**2 + (n - odd) * up**2) / (2 * n), odd * down


def _compensating(h: Fraction) -> Numbers:
    """Return the numbers of ΔJ_k = h(1/2 − kh), whose sum is h/2; Λ stays as the product."""
    n = int(1 / h)
    values = [h * (Fraction(1, 2) - k * h) for k in range(n)]
    mse = h * h * (1 + 2 * h * h) / 12  # Σ (1/2 − kh)² h = (1 + 2h²)/12
    assert sum(values) == h / 2  # noqa: S101 - the sum that the argument uses
    return h / 2, mse, prod((1 + x for x in values), start=Fraction(1)) - 1


def _not_uniform(h: Fraction) -> Numbers:
    """Return the numbers of ΔJ_k = (kh)², with Σ k⁴ in closed form."""
    n = int(1 / h)
    # Σ k⁴ for k = 0 … N − 1.
    fourth = Fraction((n - 1) * n * (2 * n - 1) * (3 * n * n - 3 * n - 1), 30)
    product = prod((1 + (k * h) ** 2 for k in range(n)), start=Fraction(1))
    return ((n - 1) * h) ** 2, fourth * h**4 / n, product - 1


_ORIGIN = RationalPoint(p=Fraction(0), q=Fraction(0))
_UNIT = RationalPoint(p=Fraction(0), q=Fraction(1))

FRICTION = ExampleMap(
    "friction",
    "p - h*(q + p)",
    "q + h*p",
    _UNIT,
    (4, 16, 64),
    _friction,
    "ΔJ = −h + h², so MSE = o(h) while Λ → 1/e − 1",
    "-h + h**2",
)
TO_AND_FRO = ExampleMap(
    "to and fro",
    "-p*(1 - sqrt(h)*q)/(1 + sqrt(h)*q)",
    "-q",
    _UNIT,
    (4, 16, 64),
    _to_and_fro,
    "max |ΔJ| > 2√h and MSE > 4h, while Λ = 0 for even N",
    "-2*sqrt(h)*q/(1 + sqrt(h)*q)",
)
TO_AND_FRO_ODD = replace(
    TO_AND_FRO, name="to and fro, odd N", steps=(9, 25, 81), says="Λ = −2√h/(1 + √h) → 0 for odd N"
)
COMPENSATED = ExampleMap(
    "near the identity, compensated",
    "p*(1 + h*(1/2 - q))",
    "q + h",
    _ORIGIN,
    (4, 16, 64),
    _compensating,
    "max |ΔJ| = h/2, Σ ΔJ = h/2 and 0 < Λ < h, so that Λ → 0",
    "h*(1/2 - q)",
)
NOT_UNIFORM = ExampleMap(
    "small for each k, not uniformly",
    "p*(1 + q**2)",
    "q + h",
    _ORIGIN,
    (4, 16, 64),
    _not_uniform,
    "`ΔJ_k` = (kh)², which is O(h²) for each fixed k, while MSE → 1/5",
    "q**2",
)
