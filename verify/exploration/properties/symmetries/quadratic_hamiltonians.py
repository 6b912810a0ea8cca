"""For quadratic H, det J = R(x)·R(−x) with x² = −h² det Hess H, R the scheme's stability function.

It is |R(iωh)|² if the orbits are ellipses, and R(λh)·R(−λh) if they are hyperbolas. All entries of
J are tested, for the quadratic part of H at the initial value with rounded coefficients.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from math import factorial

import sympy

from verify.algebra.enclosure import enclose
from verify.algebra.formula import symbol
from verify.arithmetic.arb import midpoint_and_radius
from verify.arithmetic.exact import short
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.equivariance import RationalMatrix, identity, to_flint
from verify.exploration.property import Silent, Violation, only_if, require_value
from verify.exploration.reference_steps import BITS, Matrix, ball_steps, overlap
from verify.exploration.sample import Sample
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.every_hamiltonian import RungeKutta, TaylorSeries

_COEFFICIENT_DENOMINATOR = 100


def holds(sample: Sample) -> None:
    """Check J = R(hL), where z' = Lz are the equations of motion.

    det R(hL) is the product of R(hλ) R(−hλ) over the pairs ±λ of eigenvalues.
    """
    generic = sample.scheme.every_h
    if not isinstance(generic, TaylorSeries | RungeKutta):
        raise Silent
    form = _form(sample)
    quadratic = replace(sample, hamiltonian=_quadratic(sample, form))
    only_if(quadratic.hamiltonian.coordinates == sample.hamiltonian.coordinates)
    expected = _stability_matrix(_stability_function(generic), form, sample.step_size)
    state = ball_steps(quadratic.step_map, quadratic.start, 1)[-1].sharp()
    with working_precision(BITS):
        if not overlap(state.step_jacobian, expected):
            raise Violation(f"J is not R(hL) for Hess H = {[[short(x) for x in r] for r in form]}")


@lru_cache(maxsize=64)
def _stability_function(generic: TaylorSeries | RungeKutta) -> Sequence[Fraction]:
    """Return the coefficients of R(z) = Σ cₙ zⁿ: 1/n!, or 1, b·1, b·A1, b·A²1, …"""
    if isinstance(generic, TaylorSeries):
        return [Fraction(1, factorial(n)) for n in range(generic.eta + 1)]
    stages = len(generic.weights)
    rows = [[*row, *[Fraction(0)] * (stages - len(row))] for row in generic.rows]
    # Aᵏ·1 by repeated products: R(z) = 1 + Σ b·Aᵏ1 z^(k+1).
    vector, coefficients = [Fraction(1)] * stages, [Fraction(1)]
    for _ in range(stages):
        coefficients.append(
            sum((b * x for b, x in zip(generic.weights, vector, strict=True)), Fraction())
        )
        vector = [sum((a * x for a, x in zip(r, vector, strict=True)), Fraction()) for r in rows]
    return coefficients


def _quadratic(sample: Sample, form: list[list[Fraction]]) -> Hamiltonian:
    """Return the quadratic H with that Hessian."""
    symbols = list(map(symbol, sample.hamiltonian.coordinates))
    terms = (
        sympy.Rational(form[a][b]) * x * y / 2
        for a, x in enumerate(symbols)
        for b, y in enumerate(symbols)
    )
    return Hamiltonian(sympy.Add(*terms))


def _form(sample: Sample) -> list[list[Fraction]]:
    """Return the Hessian of H at the initial value, rounded; Silent if its entries are unusual."""
    field, _ = canonical_field(sample.hamiltonian)
    rows = []
    for a in field.gradient(field.energy):
        values = [
            require_value(enclose(field.ring, x, sample.start, 128)) for x in field.gradient(a)
        ]
        only_if(all(abs(x) < 10**6 for x in values))
        rows.append(
            [
                Fraction(
                    round(midpoint_and_radius(x)[0] * _COEFFICIENT_DENOMINATOR),
                    _COEFFICIENT_DENOMINATOR,
                )
                for x in values
            ]
        )
    return rows


def _stability_matrix(
    coefficients: Sequence[Fraction], form: list[list[Fraction]], h: Fraction
) -> Matrix:
    """Return R(hL), where L has −∂²H/∂q∂z in its upper half and ∂²H/∂p∂z in its lower."""
    n = len(form) // 2
    slopes = [[-h * x for x in row] for row in form[n:]] + [[h * x for x in r] for r in form[:n]]
    matrix = RationalMatrix([[to_flint(x) for x in row] for row in slopes])
    total, power = matrix * 0, identity(2 * n)
    for c in coefficients:
        total, power = total + power * to_flint(c), power * matrix
    with working_precision(BITS):
        return Matrix(total)
