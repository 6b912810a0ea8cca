"""The run of H = H1(p1, q1) + H2(p2, q2) + … is that of each plane by itself, and so is S.

H is taken without its couplings. J consists of the blocks of the planes' maps: S has the entry ΔJ
of each plane for its pair (p_k, q_k), and 0 elsewhere; det J is the product of their determinants;
W, the defect of the run, has the Λ of each plane. Balls decide, or runs if the step is implicit.
"""

from collections.abc import Sequence
from dataclasses import replace

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
    end_of,
    must_agree,
    must_overlap,
    overlap,
)
from verify.exploration.sample import Sample
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian

_MOST_STEPS = 3


def holds(sample: Sample) -> None:
    parts = [_terms_of_degree(sample, k) for k in range(sample.hamiltonian.degrees)]
    together = Hamiltonian(sympy.Add(*parts))
    only_if(together.coordinates == sample.hamiltonian.coordinates and sample.brief)
    only_if(sample.is_turn(one_in=2 if sample.scheme.explicit else 4))
    whole = replace(sample, hamiltonian=together)
    planes = [_plane(sample, k, part) for k, part in enumerate(parts)]
    if not sample.scheme.explicit:
        only_if(sample.short)
        _must_end_alike(whole, planes)
        return
    last, *plane_states = (_last_state(run) for run in (whole, *planes))
    with working_precision(BITS):
        # Without couplings each slope depends on its own plane alone, so that J consists of blocks.
        _must_be_product(last, plane_states)


def _terms_of_degree(sample: Sample, k: int) -> sympy.Expr:
    """Return the terms of H in the coordinates of degree k alone; Silent if there are none."""
    symbols = list(map(symbol, sample.hamiltonian.coordinates))
    coordinates = {symbols[k], symbols[sample.hamiltonian.degrees + k]}
    outer = set(symbols) - coordinates
    terms = sympy.Add.make_args(sample.hamiltonian.exact)
    own_terms = [x for x in terms if x.free_symbols & coordinates and not x.free_symbols & outer]
    only_if(bool(own_terms))
    return sympy.Add(*own_terms)


def _plane(sample: Sample, k: int, part: sympy.Expr) -> Sample:
    """Return the sample of degree of freedom k alone, in the plane."""
    places = k, sample.hamiltonian.degrees + k
    names = [symbol(sample.hamiltonian.coordinates[place]) for place in places]
    substitution = dict(zip(names, map(symbol, PLANE), strict=True))
    plane = replace(sample, hamiltonian=Hamiltonian(part.xreplace(substitution)))
    return plane.with_place(sample.place[place] for place in places)


def _last_state(sample: Sample) -> BallState:
    steps = min(sample.steps, _MOST_STEPS)
    return ball_steps(sample.step_map, sample.start, steps)[-1].sharp()


def _must_be_product(whole: BallState, planes: Sequence[BallState]) -> None:
    n, blocks = len(planes), Matrix(2 * len(planes), 2 * len(planes))
    for k, plane in enumerate(planes):
        for a, letter in enumerate(PLANE):
            name = f"{letter}{k + 1}"
            must_overlap(f"{name} is", whole.point[name], plane.point[letter], ", in its plane")
            for b in range(2):
                blocks[n * a + k, n * b + k] = plane.matrix[a, b]
        entry, area = defect(whole.matrix)[k, n + k], plane.product - 1
        must_overlap(f"W's entry dp{k + 1}∧dq{k + 1} is", entry, area, ", Λ of its plane")
    if not overlap(whole.matrix, blocks):
        raise Violation("J of the run does not have the planes' as its blocks")


def _must_end_alike(whole: Sample, planes: Sequence[Sample]) -> None:
    end = end_of(whole)
    for k, plane in enumerate(planes, start=1):
        must_agree({letter: end[f"{letter}{k}"] for letter in "pq"}, end_of(plane))
