"""A basis for the arguments of sines or exponentials, over which they are expanded."""

import math
from collections.abc import Sequence

import flint

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly, Ring

MAX_MULTIPLE = 16  # sin(k b) is expanded in sin b, cos b up to this k
_FEW = 2


def lattice(ring: Ring, arguments: Sequence[Poly]) -> tuple[list[Poly], list[list[int]]]:
    """Return a basis of the lattice the arguments span, and each argument as integers over it.

    Arguments are vectors of rational coefficients over their monomials; the basis is the Hermite
    normal form of their integer multiples. Where a multiple would be large (sin(100 q) and
    sin(q)) each argument is a basis element of its own: that is correct, only an identity may
    remain hidden.
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
        if all(row[k] <= 0 for row in multiples):  # exp(−q²) by itself, not by 1/exp(q²)
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
    """Return a basis as `lattice`, with multiples of π as elements where that is simpler.

    For 3 p − q + 9π/5, q + π/3 and 3 p any basis without them needs large multiples.
    """
    basis, multiples = lattice(ring, arguments)
    pi = ring.find("pi", None)
    if pi is None or max(abs(k) for row in multiples for k in row) <= _FEW:
        return basis, multiples
    turns = [pi * a[pi.monoms()[0]] for a in arguments]
    # The multiple of π is split off each argument, and the rest is expanded over a basis of its
    # own.
    rests = [a - turn for a, turn in zip(arguments, turns, strict=True)]
    moving = [rest for rest in rests if not rest.is_zero()]
    if not moving:
        return basis, multiples
    basis, coordinates = lattice(ring, moving)
    rows = iter(coordinates)
    fixed = [turn for k, turn in enumerate(turns) if turn not in [*turns[:k], ring.zero]]
    return [*basis, *fixed], [
        [*([0] * len(basis) if rest.is_zero() else next(rows)), *(int(turn == x) for x in fixed)]
        for rest, turn in zip(rests, turns, strict=True)
    ]


def _coordinates(row: list[int], basis: list[list[int]]) -> list[int]:
    """Return integers k with Σ kᵢ basisᵢ = row, for a basis in echelon form that spans it."""
    rest, result = list(row), []
    for vector in basis:
        pivot = next(j for j, v in enumerate(vector) if v)
        k = rest[pivot] // vector[pivot]
        rest = [r - k * v for r, v in zip(rest, vector, strict=True)]
        result.append(k)
    return result
