"""Polynomials as vectors over their monomials: linear combinations, and bases of lattices.

A polynomial is written as a combination of others by solving equations over the rationals. The
arguments of sines, or of exponentials, span a lattice; the functions are expanded over a basis of
it.
"""

import math
from collections.abc import Sequence

import flint

from verify.algebra.identities.polynomials import terms_of
from verify.algebra.ring import Poly, Ring

_PRIME = 2_305_843_009_213_693_951  # 2⁶¹ − 1
MAX_MULTIPLE = 16  # sin(k b) is expanded in sin b and cos b up to this k
_SMALL_MULTIPLE = 2  # with multiples up to this, no multiples of π are split off


def solve_combination(
    columns: Sequence[Poly], target: Poly
) -> tuple[dict[int, flint.fmpq] | None, int]:
    """Solve Σ coefficient·column = target. Return {index: coefficient}, or None if there is no
    solution; and the columns' rank."""
    rows, entries = _entries((*columns, target))
    matrix = flint.fmpq_mat(rows, len(columns) + 1)
    for place, coefficient in entries:
        matrix[place] = coefficient
    reduced, rank = matrix.rref()
    last = len(columns)
    pivots = [next(c for c in range(last + 1) if reduced[r, c] != 0) for r in range(rank)]
    # A pivot in the last column means that the target is independent of the columns.
    if last in pivots:
        return None, rank - 1
    return {c: reduced[r, last] for r, c in enumerate(pivots)}, rank


def may_combine(columns: Sequence[Poly], target: Poly) -> bool:
    """Return True if `target` is a combination of the columns modulo a prime: a cheap test.

    If it is not, it is none over the rationals either, unless the prime divides a denominator of
    every such combination: a reason to give up a search, but no proof.
    """
    rows, entries = _entries((*columns, target))
    matrix = flint.nmod_mat(rows, len(columns) + 1, _PRIME)
    for place, coefficient in entries:
        if coefficient.q % _PRIME == 0:
            return True
        matrix[place] = int(coefficient.p * pow(int(coefficient.q), -1, _PRIME))
    reduced, rank = matrix.rref()
    return rank == 0 or any(int(reduced[rank - 1, c]) for c in range(len(columns)))


def _entries(elements: Sequence[Poly]) -> tuple[int, list[tuple[tuple[int, int], flint.fmpq]]]:
    """Return the number of rows, and [((row, column), coefficient), …], of the matrix that has a
    row for each monomial and a column for each element."""
    rows: dict[tuple[int, ...], int] = {}
    entries = []
    for column, x in enumerate(elements):
        for monomial, coefficient in terms_of(x):
            row = rows.setdefault(monomial, len(rows))
            entries.append(((row, column), coefficient))
    return len(rows), entries


# -- the lattice of arguments ---------------------------------------------------------------------


def lattice(ring: Ring, arguments: Sequence[Poly]) -> tuple[list[Poly], list[list[int]]]:
    """Return a basis of the lattice that the arguments span, and the integer coordinates of each
    argument.

    Arguments are vectors of rational coefficients over their monomials; the basis is the Hermite
    normal form of their integer multiples. If a coordinate would be large, as for sin(100 q) and
    sin(q), the distinct arguments are the basis: this is correct, but may hide an identity.
    """
    terms = [dict(terms_of(a)) for a in arguments]
    monomials = sorted({m for t in terms for m in t}, reverse=True)
    common = math.lcm(*(int(value.q) for t in terms for value in t.values()))
    rows = [[int(t.get(m, 0) * common) for m in monomials] for t in terms]
    # The nonzero rows of the Hermite normal form are a basis of the lattice that the rows span.
    hermite = flint.fmpz_mat(rows).hnf().tolist()
    basis = [[int(v) for v in row] for row in hermite if any(row)]
    multiples = [_coordinates(row, basis) for row in rows]
    if any(abs(k) > MAX_MULTIPLE for row in multiples for k in row):
        distinct = [a for k, a in enumerate(arguments) if a not in arguments[:k]]
        return distinct, [[int(a == b) for b in distinct] for a in arguments]
    for k, vector in enumerate(basis):
        if all(row[k] <= 0 for row in multiples):  # exp(−q²) is a generator, and not 1/exp(q²)
            basis[k] = [-v for v in vector]
            multiples = [[*row[:k], -row[k], *row[k + 1 :]] for row in multiples]
    elements = [
        ring.context.from_dict(
            {m: flint.fmpq(v, common) for m, v in zip(monomials, vector, strict=True) if v}
        )
        for vector in basis
    ]
    return elements, multiples


def lattice_and_turns(ring: Ring, arguments: Sequence[Poly]) -> tuple[list[Poly], list[list[int]]]:
    """Return the same as `lattice`, but with multiples of π in the basis if that is simpler.

    For 3 p − q + 9π/5, q + π/3 and 3 p a basis without these needs large multiples.
    """
    basis, multiples = lattice(ring, arguments)
    pi = ring.find("pi", None)
    if pi is None or max(abs(k) for row in multiples for k in row) <= _SMALL_MULTIPLE:
        return basis, multiples
    turns = [pi * a[pi.monoms()[0]] for a in arguments]
    # The multiple of π is split off each argument; the remainders have their own basis.
    remainders = [a - turn for a, turn in zip(arguments, turns, strict=True)]
    moving = [remainder for remainder in remainders if not remainder.is_zero()]
    if not moving:
        return basis, multiples
    basis, coordinates = lattice(ring, moving)
    rows = iter(coordinates)
    fixed = [turn for k, turn in enumerate(turns) if turn not in [*turns[:k], ring.zero]]
    return [*basis, *fixed], [
        [
            *([0] * len(basis) if remainder.is_zero() else next(rows)),
            *(int(turn == x) for x in fixed),
        ]
        for remainder, turn in zip(remainders, turns, strict=True)
    ]


def _coordinates(row: list[int], basis: list[list[int]]) -> list[int]:
    """Return integers k with Σ kᵢ basisᵢ = row; the basis is in echelon form."""
    remainder, result = list(row), []
    for vector in basis:
        pivot = next(j for j, v in enumerate(vector) if v)
        k = remainder[pivot] // vector[pivot]
        remainder = [r - k * v for r, v in zip(remainder, vector, strict=True)]
        result.append(k)
    return result
