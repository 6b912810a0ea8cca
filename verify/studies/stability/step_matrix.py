"""The exact matrix of a scheme's step on a linear system, and a test if its powers stay bounded.

A scheme's step is made of few operations (`verify.schemes.steps.step_algebra`). Here each value is
a row: a linear function of z, and, inside of equations, of their unknowns too. So a step of
rational size h is a 2n × 2n matrix M of rationals.

Powers of M stay bounded exactly if no eigenvalue is greater than 1 in size and those of size 1 have
no Jordan block. Let c be the characteristic polynomial and c* that of the inverses. The inverse of
an eigenvalue of size 1 is its conjugate, so that it is a root of both, and of r = gcd(c, c*). The
rest of c has no root of size 1: balls decide if each of its roots is inside the unit circle. The
roots of r come in pairs x, 1/x, apart from ±1; a pair is of size 1 exactly if x + 1/x is real and
in [−2, 2], which is decided by the real roots of a polynomial with integer coefficients.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import flint

from verify.algebra.ring import Poly
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.steps.step_algebra import Number, StepAlgebra
from verify.studies.stability.positive_roots import positive_roots

_BITS, _MOST_BITS = 128, 4096
Row = flint.fmpq_mat  # 1 × (2n + unknowns)


class _IrrationalError(Exception):
    """A coefficient of the scheme is no rational."""


class LinearAlgebra(StepAlgebra[Row]):
    """A step of size h of z' = A z: values are rows, changes of z as functions of it."""

    def __init__(self, matrix: flint.fmpq_mat, h: flint.fmpq, unknowns: int = 0) -> None:
        self.matrix, self.h, self.unknowns = matrix, h, unknowns

    @property
    def size(self) -> int:
        """The number 2n of coordinates."""
        return self.matrix.nrows()

    @property
    def _width(self) -> int:
        return self.size + self.unknowns

    @property
    def nothing(self) -> Row:
        """The row of the function 0."""
        return flint.fmpq_mat(1, self._width)

    def unit(self, k: int) -> Row:
        """Return the row of the k-th coordinate, or unknown."""
        return flint.fmpq_mat(1, self._width, [int(k == j) for j in range(self._width)])

    def along_flow(self, eta: int) -> list[Row]:
        total, power = flint.fmpq_mat(self.size, self.size), self.matrix * self.h
        for n in range(1, eta + 1):
            total += power
            power = power * self.matrix * (self.h / (n + 1))
        return [self._wide(row) for row in total.tolist()]

    def slopes(self, changes: Sequence[Row], clock: Number, places: Sequence[int]) -> list[Row]:
        states = [self.unit(k) + self._fit(change) for k, change in enumerate(changes)]
        return [self._sum([self.matrix[k, j] for j in range(self.size)], states) for k in places]

    def move(self, change: Row, weights: Sequence[Number], slopes: Sequence[Row]) -> Row:
        return self._fit(change) + self._sum(list(map(_rational, weights)), slopes) * self.h

    def add_share(self, x: Row, y: Row, share: Fraction) -> Row:
        return self._fit(x) + self._fit(y) * _rational(share)

    def solve(
        self, count: int, right: Callable[[StepAlgebra[Any], Sequence[Row]], list[Row]]
    ) -> list[Row]:
        """Solve Z = R + L Z with the unknowns as further columns. Equations are not nested."""
        inner = LinearAlgebra(self.matrix, self.h, count)
        rows = right(inner, [inner.unit(self.size + k) for k in range(count)])
        entries = [r[0, j] for r in rows for j in range(self.size)]
        constants = flint.fmpq_mat(count, self.size, entries)
        coefficients = [r[0, self.size + j] for r in rows for j in range(count)]
        equations = flint.fmpq_mat(count, count, [-x for x in coefficients])
        for k in range(count):
            equations[k, k] += 1
        try:
            solution = equations.solve(constants)
        except ZeroDivisionError:
            raise InputError("step_size", str(self.h), "its equations have no solution") from None
        return [self._wide(row) for row in solution.tolist()]

    def _wide(self, row: Sequence[flint.fmpq]) -> Row:
        return flint.fmpq_mat(1, self._width, [*row, *[0] * (self._width - len(row))])

    def _fit(self, row: Row) -> Row:
        """Extend a row of the algebra around the equations by 0 for their unknowns."""
        return row if row.ncols() == self._width else self._wide(row.entries())

    def _sum(self, weights: Sequence[flint.fmpq], rows: Sequence[Row]) -> Row:
        total = self.nothing
        for weight, row in zip(weights, rows, strict=True):
            if weight:
                total += row * weight
        return total


def step_matrix(
    scheme: str, hamiltonian: Hamiltonian, matrix: flint.fmpq_mat, h: Fraction
) -> flint.fmpq_mat | None:
    """Return M of a step of z' = `matrix` z, the field of a quadratic H.

    None if the scheme has irrational coefficients. Raises InputError for a scheme given by
    formulas, and if the scheme does not take H.
    """
    chosen = get(scheme)
    step = chosen.step_map(hamiltonian).step or getattr(chosen.every_h, "changes", None)
    if step is None:
        raise InputError("scheme", scheme, "is a formula; linear theory takes a named scheme")
    algebra = LinearAlgebra(matrix, _rational(h))
    try:
        changes = step(algebra)
    except _IrrationalError:
        return None
    size = algebra.size
    rows = [algebra.unit(k) + change for k, change in enumerate(changes)]
    return flint.fmpq_mat(size, size, [row[0, j] for row in rows for j in range(size)])


def stays_bounded(matrix: flint.fmpq_mat) -> bool | None:
    """Return True if all powers of M stay bounded, exactly.

    None if balls do not decide a size.
    """
    c = matrix.charpoly()
    # The roots of the reversed polynomial are the inverses.
    on_circle = c.gcd(flint.fmpq_poly(list(reversed(c.coeffs()))))
    off_circle = c
    while (common := off_circle.gcd(on_circle)).degree() > 0:  # again for multiple roots
        off_circle = off_circle // common
    inside = _all_inside(off_circle)
    if inside is False or not _all_of_size_one(on_circle):
        return False
    return inside and _is_root(_squarefree(on_circle) * off_circle, matrix)


def _is_root(polynomial: flint.fmpq_poly, matrix: flint.fmpq_mat) -> bool:
    """Return True if the polynomial is 0 at the matrix: a simple root then has no Jordan block."""
    identity = matrix * 0
    for k in range(matrix.nrows()):
        identity[k, k] = flint.fmpq(1)
    total = matrix * 0
    for coefficient in reversed(polynomial.coeffs()):
        total = total * matrix + identity * coefficient
    return bool(total == matrix * 0)


def _squarefree(polynomial: flint.fmpq_poly) -> flint.fmpq_poly:
    return polynomial // polynomial.gcd(polynomial.derivative())


def _all_inside(polynomial: flint.fmpq_poly) -> bool | None:
    """Return True if all roots, none of which is of size 1, are smaller; None if undecided."""
    if polynomial.degree() < 1:
        return True
    integral, bits = _squarefree(polynomial).numer(), _BITS
    while bits <= _MOST_BITS:
        with working_precision(bits):
            roots: Any = integral.complex_roots()  # pairs; the stubs say otherwise
            sizes = [abs(root) for root, _ in roots]
            if any(size > 1 for size in sizes):
                return False
            if all(size < 1 for size in sizes):
                return True
        bits *= 2
    return None


def _all_of_size_one(polynomial: flint.fmpq_poly) -> bool:
    """Return True if all roots of a polynomial with root pairs x, 1/x are of size 1."""
    quotient = _squarefree(polynomial)
    for root in (1, -1):
        if quotient.degree() > 0 and quotient(flint.fmpq(root)) == 0:
            quotient = quotient // flint.fmpq_poly([-root, 1])
    if quotient.degree() < 1:
        return True
    # A pair is of size 1 exactly if s = x + 1/x is real and in [−2, 2]: if all are, g(2 − s) and
    # g(s − 2) have as many positive roots as g, which is squarefree, has roots.
    sums = _polynomial_of_sums(quotient)
    below, above = (sums(flint.fmpq_poly(line)).numer() for line in ([2, -1], [-2, 1]))
    return len(positive_roots([below])) == len(positive_roots([above])) == sums.degree()


def _polynomial_of_sums(polynomial: flint.fmpq_poly) -> flint.fmpq_poly:
    """Return g with x^m g(x + 1/x) = the polynomial, a palindromic one of degree 2m."""
    m = polynomial.degree() // 2
    y = flint.fmpq_poly([0, 1])
    powers = [flint.fmpq_poly([2]), y]  # x^k + x^−k as polynomials in x + 1/x
    while len(powers) <= m:
        powers.append(y * powers[-1] - powers[-2])
    coefficients = polynomial.coeffs()
    total = flint.fmpq_poly([coefficients[m]])
    for k in range(1, m + 1):
        total += powers[k] * coefficients[m + k]
    return total


def _rational(x: Number) -> flint.fmpq:
    return flint.fmpq(x.numerator, x.denominator) if isinstance(x, Fraction) else _constant(x)


def _constant(x: Poly) -> flint.fmpq:
    if x.is_zero():
        return flint.fmpq(0)
    if not x.is_constant():
        raise _IrrationalError
    value: flint.fmpq = x.leading_coefficient()
    return value
