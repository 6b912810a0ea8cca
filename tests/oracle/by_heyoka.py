"""heyoka's Taylor integrator, held at one order and one step size: it is the scheme lieη.

A Taylor step of order η is z' = Σ hⁿ/n! Xⁿz, n = 0 … η (Eq. 2); and since d/dt commutes with
∂/∂z, the same step of the variational equations is the exact Jacobian of that map. heyoka
differentiates H and the Taylor coefficients by itself and compiles them by itself: it shares no
code with us.

How heyoka is held. The tolerance selects the order, max(2, ⌈1 − ln(tol)/2⌉) after Jorba and Zou:
every η ≥ 2 can be had, and lie1 cannot. `max_delta_t` limits the step; the outcome `time_limit`
says that the limit was the step. Every number here is a dyadic rational, so that no input is
rounded in any precision.

How far the two may be apart. heyoka computes z' = z + h s: one rounding of z', and a few dozen in
s, each smaller by h = 1/128. Together they are at most ROUNDINGS u max(1, |z'|), with the unit
roundoff u.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian

hy = pytest.importorskip("heyoka")

STEP_SIZE = Fraction(1, 128)
TIME = Fraction(3, 8)  # for an H that depends on it
ZERO = Fraction(0)
ROUNDINGS = 2
MPFR_BITS = 237
State = list[Fraction]  # z = (p1 …, q1 …), and ∂z/∂z₀ by rows
Point = tuple[Fraction, ...]  # p1 …, q1 …
Form = dict[tuple[int, int], Fraction]  # the entries of a 2-form, dz_a∧dz_b with a < b


@dataclass(frozen=True)
class System:
    """H for us and H for heyoka, and the highest η whose exact map we have in a few seconds."""

    formula: str
    theirs: Callable[..., Any]
    highest: int = 10

    @property
    def hamiltonian(self) -> Hamiltonian:
        return Hamiltonian.parse(self.formula)


SYSTEMS = {
    "duffing": System(
        "p**2/2 + q**2/2 + (3/4)*q**4/4",
        lambda p, q: p**2 / 2 + q**2 / 2 + 0.75 * q**4 / 4,
    ),
    "pendulum": System("p**2/2 - cos(q)", lambda p, q: p**2 / 2 - hy.cos(q)),
    "polynomial, not separable": System(
        "p**2/2 + q**2/2 + p**2*q/4 + p*q**3/8",
        lambda p, q: p**2 / 2 + q**2 / 2 + p**2 * q / 4 + p * q**3 / 8,
    ),
    "transcendental, not separable": System(
        "sqrt(1 + p**2)*exp(q/4) + cos(p*q)/2",
        lambda p, q: hy.sqrt(1 + p**2) * hy.exp(q / 4) + hy.cos(p * q) / 2,
        highest=6,
    ),
}
IN_TWO_DEGREES = {
    "cubic": System(  # as Hénon–Heiles, with no third, which heyoka rounds
        "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/4",
        lambda p, q, r, s: (p**2 + q**2 + r**2 + s**2) / 2 + r**2 * s - s**3 / 4,
        highest=4,
    ),
    "kepler": System(
        "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)",
        lambda p, q, r, s: (p**2 + q**2) / 2 - 1 / hy.sqrt(r**2 + s**2),
        highest=4,
    ),
    "mixed": System(
        "(p1*q2 + p2)**2/2 + q1*q2*exp(p1/2)",
        lambda p, q, r, s: (p * s + q) ** 2 / 2 + r * s * hy.exp(p / 2),
        highest=4,
    ),
    "driven": System(
        "(p1**2 + p2**2)/2 + q1**2*q2 - q1*cos(t)",
        lambda p, q, r, s: (p**2 + q**2) / 2 + r**2 * s - r * hy.cos(hy.time),
        highest=4,
    ),
}


@dataclass(frozen=True)
class Precision:
    """A number type of heyoka's, and the orders whose neighbours it can tell apart at h = 1/128."""

    name: str
    number: Callable[[float], Any]
    type: Any
    bits: int
    etas: tuple[int, ...]

    def rational(self, x: Any) -> Fraction:
        if self.type in (float, np.longdouble):
            return Fraction(*x.as_integer_ratio())
        scaled = x * self.number(2.0) ** 600  # a whole number wherever |x| > 2^−363
        return Fraction(int(scaled), 2**600)

    def rounding(self, x: Fraction) -> Fraction:
        """How far a component of one step may be off."""
        return Fraction(ROUNDINGS, 2**self.bits) * max(Fraction(1), abs(x))

    def defect_bounds(self, state: State) -> Form:
        """How far each entry of S is off where each entry of J is as far as one step may be."""
        rows = jacobian(state)
        n = len(rows) // 2
        sizes = [[abs(x) for x in row] for row in rows]
        errors = [[self.rounding(x) for x in row] for row in rows]

        def product(i: int, a: int, j: int, b: int) -> Fraction:
            e, f = errors[i][a], errors[j][b]
            return sizes[i][a] * f + sizes[j][b] * e + e * f

        return {
            (a, b): sum((product(i, a, n + i, b) + product(n + i, a, i, b) for i in range(n)), ZERO)
            for a, b in combinations(range(2 * n), 2)
        }


def _mpfr(x: float) -> Any:
    return hy.real(x, MPFR_BITS)


def _precisions() -> list[Precision]:
    found = [Precision("double", float, float, 53, (2, 3, 4))]
    if np.finfo(np.longdouble).nmant == 63:  # x87's; elsewhere long double is something else
        found.append(Precision("extended", np.longdouble, np.longdouble, 64, (2, 3, 4, 5)))
    if hasattr(hy, "real128"):
        found.append(Precision("quad", hy.real128, hy.real128, 113, (2, 3, 4, 5, 6, 8, 10)))
    if hasattr(hy, "real"):
        # Few steps, since arrays of this type leak memory; low orders, since they compile slowly.
        found.append(Precision("mpfr", _mpfr, hy.real, MPFR_BITS, (2, 3)))
    return found


PRECISIONS = {x.name: x for x in _precisions()}


class Oracle:
    """heyoka's Taylor integrator of one order, with the tangent map carried along."""

    def __init__(self, system: str, precision: Precision, eta: int) -> None:
        chosen = (SYSTEMS | IN_TWO_DEGREES)[system]
        variables = hy.make_vars(*chosen.hamiltonian.coordinates)
        h, n = chosen.theirs(*variables), len(variables) // 2
        slopes = [*(-hy.diff(h, x) for x in variables[n:]), *(hy.diff(h, x) for x in variables[:n])]
        equations = list(zip(variables, slopes, strict=True))
        self.precision, number = precision, precision.number
        self.taylor = hy.taylor_adaptive(
            hy.var_ode_sys(equations, hy.var_args.vars, order=1),
            [number(0.5)] * (2 * n),
            tol=number(math.exp(3 - 2 * eta)),  # 1 − ln(tol)/2 = η − 1/2
            fp_type=precision.type,
            **({"prec": precision.bits} if precision.name == "mpfr" else {}),
        )
        assert self.taylor.order == eta
        # Which component, and how often by each of z₀: the order that `State` names.
        unit = np.eye(2 * n, dtype=int).tolist()
        indices = [[i, *[0] * (2 * n)] for i in range(2 * n)]
        indices += [[i, *by] for i in range(2 * n) for by in unit]
        assert [list(self.taylor.get_mindex(k)) for k in range(len(indices))] == indices

    def start(self, at: Point) -> None:
        """The point at TIME, with the identity as its tangent map."""
        self.taylor.time = self.precision.number(float(TIME))
        for k, x in enumerate((*at, *np.eye(len(at)).flat)):
            assert Fraction(float(x)) == x
            self.taylor.state[k] = self.precision.number(float(x))

    def step(self, sign: int = 1) -> State:
        """The state after exactly one step of size h, or −h."""
        h = self.precision.number(float(sign * STEP_SIZE))
        outcome, taken = self.taylor.step(max_delta_t=h)
        assert outcome == hy.taylor_outcome.time_limit, "heyoka took a shorter step"
        assert taken == h
        return [self.precision.rational(x) for x in self.taylor.state]


oracle = cache(Oracle)


def jacobian(state: State) -> list[list[Fraction]]:
    """Its rows, those of the momenta first."""
    size = math.isqrt(len(state))  # (2n)² + 2n numbers
    return [state[size * (1 + i) : size * (2 + i)] for i in range(size)]


def defect(state: State) -> Form:
    """S = JᵀΩJ − Ω above its diagonal; in the plane det J − 1."""
    rows = jacobian(state)
    n = len(rows) // 2
    return {
        (a, b): sum(
            (rows[i][a] * rows[n + i][b] - rows[n + i][a] * rows[i][b] for i in range(n)), ZERO
        )
        - (b == a + n)
        for a, b in combinations(range(2 * n), 2)
    }
