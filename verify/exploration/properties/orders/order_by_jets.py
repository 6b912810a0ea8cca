"""ΔJ's order and leading coefficient are those that the proof for every H gives, put in this H.

For every H the partial derivatives of H are free variables (jets); for this one ΔJ is expanded
itself. The two share no code but the polynomials' own.
"""

from functools import lru_cache

import flint

from verify.algebra.enclosure import enclose
from verify.algebra.generator import terms_of
from verify.algebra.series.jets import Jets, Poly
from verify.arithmetic.arb import Ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import BITS, sharp, unlike
from verify.exploration.property import Violation, known, only_if
from verify.exploration.sample import Sample
from verify.schemes.every_hamiltonian import BySeries, RungeKutta, StageEquations, TaylorSeries
from verify.schemes.scheme import Scheme

_MOST_ORDER = 5  # of a scheme: with more there are too many jets


def holds(sample: Sample) -> None:
    scheme = sample.scheme
    only_if(_has_series_in_jets(scheme) and scheme.order <= _MOST_ORDER and sample.ordinary)
    proof = sample.proof
    only_if(proof.area_preserving is not None)
    jets, coefficients = _of_every(scheme, scheme.order + 2)
    derivatives = _derivatives(sample, jets)
    for n, x in enumerate(coefficients, start=1):
        wanted = _value(x, derivatives)
        found = _leading(sample) if n == proof.order else flint.arb(0)
        only_if(sharp(found) and sharp(wanted))
        if not found.overlaps(wanted):
            at_point = f"at the initial value {unlike(found, wanted)}, by jets"
            raise Violation(f"the coefficient of h^{n} in ΔJ is {at_point}")
        if n == proof.order:
            return


def _has_series_in_jets(scheme: Scheme) -> bool:
    """Whether the scheme is a pair of series in the jets, and not only conditions on numbers."""
    return isinstance(scheme.every_h, TaylorSeries | RungeKutta | StageEquations)


@lru_cache(maxsize=64)
def _of_every(scheme: Scheme, most: int) -> tuple[Jets, tuple[Poly, ...]]:
    """The coefficients of h¹ … h^most in ΔJ of the scheme for every H."""
    generic = scheme.every_h
    assert isinstance(generic, BySeries)  # noqa: S101 - the caller looks
    jets = Jets(most + 2, separable=generic.separable)
    return jets, tuple(jets.delta_j(*generic.taylor(jets, most)))


def _leading(sample: Sample) -> Ball:
    """The leading coefficient of this H's own ΔJ, at the initial value."""
    element = sample.proof.first.element
    assert element is not None  # noqa: S101 - ΔJ has an order
    return known(enclose(*element, sample.start, BITS))


def _derivatives(sample: Sample, jets: Jets) -> dict[tuple[int, int], Ball]:
    """H_ij at the initial value; Silent where one of them is not defined there."""
    field = sample.field
    ring, found = field.ring, {(1, 0): field.h_p, (0, 1): field.h_q}
    for i, j in sorted(jets.indices, key=sum):
        if (i, j) not in found:
            lower, name = ((i, j - 1), "q") if j else ((i - 1, 0), "p")
            found[i, j] = ring.diff(found[lower], name)
    return {ij: known(enclose(ring, found[ij], sample.start, BITS)) for ij in jets.indices}


def _value(x: Poly, derivatives: dict[tuple[int, int], Ball]) -> Ball:
    with working_precision(BITS):
        total, values = flint.arb(0), [flint.arb(0)] * 2 + list(derivatives.values())
        for monomial, coefficient in terms_of(x):
            term = flint.arb(coefficient)
            for value, power in zip(values, monomial, strict=True):
                for _ in range(int(power)):
                    term *= value
            total += term
    return total
