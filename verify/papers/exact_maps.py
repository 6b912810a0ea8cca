"""Step maps at rational points, in Fractions: points, Jacobians, and the areas along an orbit."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import prod

import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.exact import text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.maps.by_formulas import map_by_formulas
from verify.schemes.maps.step_map import StepMap


@dataclass(frozen=True)
class Point:
    p: Fraction
    q: Fraction

    def __str__(self) -> str:
        """With its numbers quoted, as `read_prose` takes them."""
        return f"(`{text(self.p)}`, `{text(self.q)}`)"


@dataclass(frozen=True)
class Areas:
    """ΔJ along an orbit of N steps, with the three numbers that the criteria speak of."""

    delta_j: tuple[Fraction, ...]

    @property
    def largest(self) -> Fraction:
        return max(map(abs, self.delta_j))

    @property
    def mse(self) -> Fraction:
        return sum((x * x for x in self.delta_j), Fraction(0)) / len(self.delta_j)

    @property
    def lam(self) -> Fraction:
        return prod((1 + x for x in self.delta_j), start=Fraction(1)) - 1


def squared(one: Point, other: Point) -> Fraction:
    """The square of their distance."""
    return (one.p - other.p) ** 2 + (one.q - other.q) ** 2


def value(expression: sympy.Expr, point: Point, h: Fraction) -> Fraction:
    """The expression at a rational point; ValueError where its value is not rational."""
    put = {P: point.p, Q: point.q, H_STEP: h}
    found = expression.subs({s: sympy.Rational(v.numerator, v.denominator) for s, v in put.items()})
    if not found.is_Rational:
        raise ValueError(f"{found} is not rational")
    return Fraction(int(found.p), int(found.q))


def next_point(step: StepMap, point: Point, h: Fraction) -> Point:
    return Point(value(step.p_next, point, h), value(step.q_next, point, h))


def run_of(step: StepMap, start: Sequence[sympy.Expr], steps: int) -> tuple[sympy.Expr, ...]:
    """p and q after so many steps, as expressions."""
    found = tuple(start)
    for _ in range(steps):
        put = dict(zip((P, Q), found, strict=True))
        found = tuple(x.subs(put, simultaneous=True) for x in (step.p_next, step.q_next))
    return found


def jacobian(step: StepMap, point: Point, h: Fraction) -> tuple[Fraction, ...]:
    """∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q."""
    return tuple(value(x, point, h) for x in step.jacobian)


def areas(step: StepMap, start: Point, h: Fraction, steps: int) -> Areas:
    """ΔJ_k at z_k, k = 0 … steps − 1, exactly."""
    found, point, delta_j = [], start, step.delta_j
    for _ in range(steps):
        found.append(value(delta_j, point, h))
        point = next_point(step, point, h)
    return Areas(tuple(found))


def map_from_formulas(p_next: str, q_next: str) -> StepMap:
    """A map by formulas in p, q and h; the H that it is made with says nothing of it."""
    formulas = {"p_next": p_next, "q_next": q_next}
    return map_by_formulas(Hamiltonian.parse("p**2/2 + q**2/2"), formulas)
