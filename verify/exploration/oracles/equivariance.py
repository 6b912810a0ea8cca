"""Equivariance: steps in other coordinates, or in another time, are the same steps.

Let MᵀΩM = cΩ and K = c·H∘M⁻¹. Then M maps the flow of H to that of K. For a scheme that does not
depend on the coordinates, M also maps the steps: Φ_K∘M = M∘Φ_H, J becomes M J M⁻¹, and with A = M⁻¹
the defect S becomes c AᵀSA. If H depends on time, K at c t + s is H at t.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import flint
import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.oracles.ball_steps import (
    BITS,
    BallState,
    Matrix,
    ball_steps,
    defect,
    must_overlap,
    omega,
    overlap,
)
from verify.exploration.oracles.symplectic_matrices import Exact, exact
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.every_hamiltonian import RungeKutta, TaylorSeries
from verify.structures import AREA, SYMPLECTIC

_MOST_STEPS = {AREA: 1, SYMPLECTIC: 3}


@dataclass(frozen=True)
class Change:
    """A change of coordinates and time: K = `factor` · H in M z, at the time `pace` · t + `shift`.

    MᵀΩM = cΩ with c = `factor` · `pace`.
    """

    matrix: Exact
    factor: Fraction = Fraction(1)
    pace: Fraction = Fraction(1)
    shift: Fraction = Fraction(0)

    @cached_property
    def inverse(self) -> Exact:
        """M⁻¹."""
        return self.matrix.inv()


def knows_no_coordinates(sample: Sample) -> bool:
    """Return True if the scheme treats all coordinates alike, and so commutes with linear maps."""
    return isinstance(sample.scheme.every_h, TaylorSeries | RungeKutta)


def transformed_hamiltonian(sample: Sample, change: Change) -> Hamiltonian:
    """Return K(z, t) = factor · H(M⁻¹ z, (t − shift)/pace)."""
    names = sample.hamiltonian.coordinates
    symbols = [symbol(name) for name in names]
    substitution = {
        x: sympy.Add(*(_rational(change.inverse[a, b]) * y for b, y in enumerate(symbols)))
        for a, x in enumerate(symbols)
    }
    # t is replaced as well: K at pace·t + shift is H at t.
    t = symbol("t")
    substitution[t] = (t - sympy.Rational(change.shift)) / sympy.Rational(change.pace)
    expression = sample.hamiltonian.exact.xreplace(substitution)
    return Hamiltonian(sympy.Rational(change.factor) * expression)


def must_be_same_steps(sample: Sample, change: Change) -> None:
    """Raise Violation unless the run of K from M z, with its S, is the image of that of H.

    Raises Silent if one is not known sharply. In the plane a single step is compared, for the maps
    may be long.
    """
    only_if(sample.brief)
    steps = min(sample.steps, _MOST_STEPS[sample.hamiltonian.structure])
    ours = [state.sharp() for state in ball_steps(sample.step_map, sample.start, steps)]
    other = replace(
        sample,
        hamiltonian=transformed_hamiltonian(sample, change),
        step_size=sample.step_size * change.pace,
        steps=steps,
        t0=sample.t0 * change.pace + change.shift,
    ).with_place(transform_point(change, sample.point))
    # A part of H may have vanished with a coordinate: K is of fewer degrees then.
    only_if(other.hamiltonian.coordinates == sample.hamiltonian.coordinates)
    only_if(other.light)
    theirs = [state.sharp() for state in ball_steps(other.step_map, other.start, steps)]
    with working_precision(BITS):
        for mine, image in zip(ours[1:], theirs[1:], strict=True):
            _must_be_image(change, sample.hamiltonian.coordinates, mine, image)


def transform_point(change: Change, point: Mapping[str, Fraction]) -> list[Fraction]:
    """Return M z for a point's coordinates, in their order."""
    column = change.matrix * Exact([[exact(x)] for x in point.values()])
    return [Fraction(int(x.p), int(x.q)) for x in column.entries()]


def _must_be_image(
    change: Change, names: tuple[str, ...], mine: BallState, image: BallState
) -> None:
    matrix, inverse = Matrix(change.matrix), Matrix(change.inverse)
    expected = matrix * Matrix([[mine.point[name]] for name in names])
    for k, name in enumerate(names):
        must_overlap(f"{name}' is", image.point[name], expected[k, 0])
    # The tangent map of all steps so far is compared; S below is that of the last step.
    if not overlap(image.matrix, matrix * mine.matrix * inverse):
        raise Violation("J is not M J M⁻¹")
    # Of c AᵀSA, A = M⁻¹, c by AᵀΩA = Ω/c.
    canonical = omega(len(names))
    scale = (inverse.transpose() * canonical * inverse)[0, len(names) // 2]
    if not overlap(
        defect(image.step_jacobian) * scale,
        inverse.transpose() * defect(mine.step_jacobian) * inverse,
    ):
        raise Violation("S is not c AᵀSA, A = M⁻¹")


def _rational(x: flint.fmpq) -> sympy.Rational:
    return sympy.Rational(int(x.p), int(x.q))
