"""Equivariance: steps in other coordinates, or in another time, are the same steps.

Let MᵀΩM = cΩ and K = c·H∘M⁻¹. Then M maps the flow of H to that of K. For a scheme that does not
depend on the coordinates, M also maps the steps: Φ_K∘M = M∘Φ_H, J becomes M J M⁻¹, and with A = M⁻¹
the defect S becomes c AᵀSA. If H depends on time, K at c t + s is H at t.

M is a permutation, or a symplectic matrix with rational entries, as a product of elementary ones.
These move z = (p1 … pn, q1 … qn) by a shear of p by q, or of q by p, with a symmetric matrix; by
q ← A q, p ← A⁻ᵀ p; or exchange a pair, p ← q, q ← −p.
"""

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import flint
import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Violation, only_if
from verify.exploration.reference_steps import (
    BITS,
    BallState,
    Matrix,
    ball_steps,
    defect,
    must_overlap,
    omega,
    overlap,
)
from verify.exploration.sample import Sample
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.every_hamiltonian import RungeKutta, TaylorSeries
from verify.structures import AREA, SYMPLECTIC

RationalMatrix = flint.fmpq_mat
_MOST_STEPS = {AREA: 1, SYMPLECTIC: 3}
# Numbers of few digits keep the coefficients of the transformed H short.
_NUMBERS = tuple(Fraction(n, d) for n, d in ((1, 2), (-1, 1), (2, 1), (-2, 3), (1, 3), (3, 2)))


# -- matrices -------------------------------------------------------------------------------------


def to_flint(x: Fraction) -> flint.fmpq:
    """Convert a rational to flint's."""
    return flint.fmpq(x.numerator, x.denominator)


def identity(size: int) -> RationalMatrix:
    """Return the identity matrix."""
    return diagonal([Fraction(1)] * size)


def diagonal(values: Sequence[Fraction]) -> RationalMatrix:
    """Return the matrix with these values on its diagonal."""
    size = range(len(values))
    return RationalMatrix([[to_flint(values[a]) if a == b else 0 for b in size] for a in size])


def symplectic(seed: int, degrees: int) -> RationalMatrix:
    """Return a product of two elementary matrices of different kinds, chosen by the seed.

    In the plane it is a product of two shears, which mix q and p.
    """
    chance = random.Random(seed)  # noqa: S311 - no secret
    if degrees == 1:
        return _shear_of_p(chance, degrees) * _shear_of_q(chance, degrees)
    # In n degrees a product of two kinds is general enough, and keeps H short.
    first, second = chance.sample([_shear_of_p, _shear_of_q, _coordinate_shear, _scaling, _pair], 2)
    return first(chance, degrees) * second(chance, degrees)


def coordinate_change(seed: int, degrees: int) -> RationalMatrix:
    """Return a matrix that does not mix q and p: q ← A q, p ← A⁻ᵀ p."""
    chance = random.Random(seed)  # noqa: S311 - no secret
    if degrees == 1:
        return _scaling(chance, degrees)
    return _coordinate_shear(chance, degrees) * _scaling(chance, degrees)


def cyclic_shift(degrees: int) -> RationalMatrix:
    """Return the permutation that moves each degree of freedom to the next one, cyclically."""
    before = [(k - 1) % degrees for k in range(degrees)]
    return _permutation([*before, *(degrees + k for k in before)])


def exchange_of_p_and_q(degrees: int) -> RationalMatrix:
    """Return the exchange of q and p, for which MᵀΩM = −Ω."""
    return _permutation([*range(degrees, 2 * degrees), *range(degrees)])


def _permutation(places: Sequence[int]) -> RationalMatrix:
    """Return the matrix that takes each coordinate from one of these places."""
    return RationalMatrix([[int(a == place) for a in range(len(places))] for place in places])


def _identity_with(
    degrees: int, entries: Mapping[tuple[int, int], Fraction | int]
) -> RationalMatrix:
    """Return the identity matrix with these entries replaced."""
    matrix = identity(2 * degrees)
    for place, x in entries.items():
        matrix[place] = to_flint(Fraction(x))
    return matrix


def _pair_and_number(chance: random.Random, degrees: int) -> tuple[int, int, Fraction]:
    """Choose two degrees of freedom (the same one twice in the plane) and a number."""
    i, j = chance.sample(range(degrees), 2) if degrees > 1 else (0, 0)
    return i, j, chance.choice(_NUMBERS)


def _shear_of_p(chance: random.Random, n: int) -> RationalMatrix:
    i, j, x = _pair_and_number(chance, n)
    return _identity_with(n, {(i, n + j): x, (j, n + i): x})


def _shear_of_q(chance: random.Random, n: int) -> RationalMatrix:
    i, j, x = _pair_and_number(chance, n)
    return _identity_with(n, {(n + i, j): x, (n + j, i): x})


def _coordinate_shear(chance: random.Random, n: int) -> RationalMatrix:
    i, j, x = _pair_and_number(chance, n)
    return _identity_with(n, {(n + i, n + j): x, (j, i): -x})


def _scaling(chance: random.Random, degrees: int) -> RationalMatrix:
    factors = [chance.choice(_NUMBERS) for _ in range(degrees)]
    return diagonal([*(1 / x for x in factors), *factors])


def _pair(chance: random.Random, n: int) -> RationalMatrix:
    """Return the exchange p_k ← q_k, q_k ← −p_k in one degree of freedom."""
    k = chance.randrange(n)
    return _identity_with(n, {(k, k): 0, (n + k, n + k): 0, (k, n + k): 1, (n + k, k): -1})


# -- the same steps -------------------------------------------------------------------------------


@dataclass(frozen=True)
class CoordinateChange:
    """A change of coordinates and time: K = `factor` · H in M z, at the time `pace` · t + `shift`.

    MᵀΩM = cΩ with c = `factor` · `pace`.
    """

    matrix: RationalMatrix
    factor: Fraction = Fraction(1)
    pace: Fraction = Fraction(1)
    shift: Fraction = Fraction(0)

    @cached_property
    def inverse(self) -> RationalMatrix:
        """M⁻¹."""
        return self.matrix.inv()


def knows_no_coordinates(sample: Sample) -> bool:
    """Return True if the scheme treats all coordinates alike, and so commutes with linear maps."""
    return isinstance(sample.scheme.every_h, TaylorSeries | RungeKutta)


def transformed_hamiltonian(sample: Sample, change: CoordinateChange) -> Hamiltonian:
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


def must_be_same_steps(sample: Sample, change: CoordinateChange) -> None:
    """Raise Violation unless the run of K from M z, with its S, is the image of that of H.

    Raises Silent if one is not known sharply. In the plane a single step is compared, for the maps
    may be long.
    """
    only_if(sample.brief)
    steps = min(sample.steps, _MOST_STEPS[sample.hamiltonian.structure])
    ours = [state.sharp() for state in ball_steps(sample.step_map, sample.start, steps)]
    transformed = replace(
        sample,
        hamiltonian=transformed_hamiltonian(sample, change),
        step_size=sample.step_size * change.pace,
        steps=steps,
        t0=sample.t0 * change.pace + change.shift,
    ).with_place(transform_point(change, sample.point))
    # A part of H may have vanished with a coordinate: K is of fewer degrees then.
    only_if(transformed.hamiltonian.coordinates == sample.hamiltonian.coordinates)
    only_if(transformed.light)
    theirs = [state.sharp() for state in ball_steps(transformed.step_map, transformed.start, steps)]
    with working_precision(BITS):
        for original, image in zip(ours[1:], theirs[1:], strict=True):
            _must_be_image(change, sample.hamiltonian.coordinates, original, image)


def transform_point(change: CoordinateChange, point: Mapping[str, Fraction]) -> list[Fraction]:
    """Return M z for a point's coordinates, in their order."""
    column = change.matrix * RationalMatrix([[to_flint(x)] for x in point.values()])
    return [Fraction(int(x.p), int(x.q)) for x in column.entries()]


def _must_be_image(
    change: CoordinateChange, names: tuple[str, ...], original: BallState, image: BallState
) -> None:
    matrix, inverse = Matrix(change.matrix), Matrix(change.inverse)
    expected = matrix * Matrix([[original.point[name]] for name in names])
    for k, name in enumerate(names):
        must_overlap(f"{name}' is", image.point[name], expected[k, 0])
    # The tangent map of all steps so far is compared; S below is that of the last step.
    if not overlap(image.matrix, matrix * original.matrix * inverse):
        raise Violation("J is not M J M⁻¹")
    # Of c AᵀSA, A = M⁻¹, c by AᵀΩA = Ω/c.
    canonical = omega(len(names))
    scale = (inverse.transpose() * canonical * inverse)[0, len(names) // 2]
    if not overlap(
        defect(image.step_jacobian) * scale,
        inverse.transpose() * defect(original.step_jacobian) * inverse,
    ):
        raise Violation("S is not c AᵀSA, A = M⁻¹")


def _rational(x: flint.fmpq) -> sympy.Rational:
    return sympy.Rational(int(x.p), int(x.q))
