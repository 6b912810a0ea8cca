"""Step maps at rational points, in Fractions: images, Jacobians, and ΔJ along an orbit."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import prod

import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.exact import text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.maps.formula_map import step_map_from_formulas
from verify.schemes.maps.step_map import StepMap


@dataclass(frozen=True)
class RationalPoint:
    """A point of the plane with rational coordinates."""

    p: Fraction
    q: Fraction

    def __str__(self) -> str:
        """Format the point with quoted numbers, in the syntax of `read_prose`."""
        return f"(`{text(self.p)}`, `{text(self.q)}`)"


@dataclass(frozen=True)
class Areas:
    """ΔJ along an orbit of N steps, with the three numbers that the criteria are about."""

    delta_j: tuple[Fraction, ...]

    @property
    def largest(self) -> Fraction:
        """The greatest |ΔJ_k|."""
        return max(map(abs, self.delta_j))

    @property
    def mse(self) -> Fraction:
        """The mean of ΔJ_k²."""
        return sum((x * x for x in self.delta_j), Fraction(0)) / len(self.delta_j)

    @property
    def lam(self) -> Fraction:
        """Λ = Π (1 + ΔJ_k) − 1."""
        return prod((1 + x for x in self.delta_j), start=Fraction(1)) - 1


def squared_distance(point: RationalPoint, other_point: RationalPoint) -> Fraction:
    """Return the square of the distance of two points."""
    return (point.p - other_point.p) ** 2 + (point.q - other_point.q) ** 2


def value(expression: sympy.Expr, point: RationalPoint, h: Fraction) -> Fraction:
    """Evaluate the expression at a rational point; ValueError if its value is not rational."""
    substitution = {P: point.p, Q: point.q, H_STEP: h}
    # sympy's Rational and not a float: one rounded digit would spoil an exact counterexample.
    number = expression.subs(
        {s: sympy.Rational(v.numerator, v.denominator) for s, v in substitution.items()}
    )
    if not number.is_Rational:
        raise ValueError(f"{number} is not rational")
    return Fraction(int(number.p), int(number.q))


def next_point(step: StepMap, point: RationalPoint, h: Fraction) -> RationalPoint:
    """Return the image of the point by one step; ValueError if it is not rational."""
    return RationalPoint(value(step.p_next, point, h), value(step.q_next, point, h))


def run_symbolically(
    step: StepMap, start: Sequence[sympy.Expr], steps: int
) -> tuple[sympy.Expr, ...]:
    """Return p and q after so many steps, as expressions."""
    state = tuple(start)
    for _ in range(steps):
        substitution = dict(zip((P, Q), state, strict=True))
        state = tuple(x.subs(substitution, simultaneous=True) for x in (step.p_next, step.q_next))
    return state


def jacobian(step: StepMap, point: RationalPoint, h: Fraction) -> tuple[Fraction, ...]:
    """Return ∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q."""
    return tuple(value(x, point, h) for x in step.jacobian)


def areas(step: StepMap, start: RationalPoint, h: Fraction, steps: int) -> Areas:
    """Return ΔJ_k at z_k, k = 0 … steps − 1, exactly."""
    values, point, delta_j = [], start, step.delta_j
    for _ in range(steps):
        # ΔJ_k belongs to the point before the step: J is taken at z_k.
        values.append(value(delta_j, point, h))
        point = next_point(step, point, h)
    return Areas(tuple(values))


def map_from_texts(p_next: str, q_next: str) -> StepMap:
    """Build a map from formulas in p, q and h; the H that `StepMap` requires has no meaning."""
    formulas = {"p_next": p_next, "q_next": q_next}
    return step_map_from_formulas(Hamiltonian.parse("p**2/2 + q**2/2"), formulas)
