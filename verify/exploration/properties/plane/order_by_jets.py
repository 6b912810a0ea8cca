"""ΔJ's order and leading coefficient are those that the proof for every H gives, put in this H.

For every H the partial derivatives of H are free variables (jets); for this H, ΔJ itself is
expanded. The two share no code except the polynomials. If H depends on time there are many jets,
and only the Lie-derivative schemes `lieη` are tested.
"""

from collections.abc import Iterator, Sequence
from functools import cache, lru_cache

import flint

from verify.algebra.enclosure import enclose
from verify.algebra.identities.polynomials import terms_of
from verify.algebra.jets import Jets, Poly, Series
from verify.arithmetic.arb import Ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import only_if, require_value
from verify.exploration.reference_steps import BITS, is_narrow, must_overlap
from verify.exploration.sample import Sample
from verify.schemes.conditions.every_hamiltonian import (
    BySeries,
    RungeKutta,
    StageEquations,
    TaylorSeries,
)
from verify.schemes.scheme import Scheme

_MAX_ORDER = 5  # schemes of a higher order need too many jets


def holds(sample: Sample) -> None:
    scheme = sample.scheme
    only_if(_has_series_in_jets(sample))
    only_if(scheme.order <= _MAX_ORDER and sample.ordinary)
    proof = sample.proof
    only_if(proof.area_preserving is not None)
    jets, coefficients = _coefficients_for_every_hamiltonian(
        scheme, scheme.order + 2, sample.depends_on_time
    )
    derivatives = _derivatives(sample, jets)
    for n, x in enumerate(coefficients, start=1):
        expected = _value(x, derivatives)
        coefficient = _leading(sample) if n == proof.order else flint.arb(0)
        only_if(is_narrow(coefficient) and is_narrow(expected))
        quantity = f"the coefficient of h^{n} in ΔJ is at the initial value"
        must_overlap(quantity, coefficient, expected, ", by jets")
        if n == proof.order:
            return


def _has_series_in_jets(sample: Sample) -> bool:
    """Return True if the scheme is a pair of series in the jets, not only order conditions."""
    kinds = TaylorSeries if sample.depends_on_time else TaylorSeries | RungeKutta | StageEquations
    return isinstance(sample.scheme.every_h, kinds)


@lru_cache(maxsize=64)
def _coefficients_for_every_hamiltonian(
    scheme: Scheme, highest: int, timed: bool
) -> tuple[Jets, tuple[Poly, ...]]:
    """Return the coefficients of h¹ … h^highest in ΔJ of the scheme for every H."""
    generic = scheme.every_h
    assert isinstance(generic, BySeries)  # noqa: S101 - the caller looks
    size = highest + 2
    jets = Jets(size, separable=generic.separable and not timed, timed=timed)
    p_next, q_next = generic.taylor(jets, highest)
    return jets, tuple(delta_j(jets, p_next, q_next))


def delta_j(jets: Jets, p_next: Series, q_next: Series) -> Iterator[Poly]:
    """Yield the coefficients of h¹, h², … in det ∂(p', q')/∂(p, q), as far as the series reach."""
    gradients = [[(jets.diff(x, "p"), jets.diff(x, "q")) for x in s] for s in (p_next, q_next)]
    for n in range(1, len(p_next)):
        # The Cauchy product of the determinant ∂p'/∂p ∂q'/∂q − ∂p'/∂q ∂q'/∂p, power by power of h.
        pairs = [(gradients[0][k], gradients[1][n - k]) for k in range(n + 1)]
        yield sum((a * d - b * c for (a, b), (c, d) in pairs), jets.zero)


def _leading(sample: Sample) -> Ball:
    """Return the leading coefficient of ΔJ for this H, at the initial value."""
    element = sample.proof.first.element
    assert element is not None  # noqa: S101 - ΔJ has an order
    return require_value(enclose(*element, sample.start, BITS))


def _derivatives(sample: Sample, jets: Jets) -> list[Ball]:
    """Return the derivatives H_ij, or H_ijk, at the initial value; Silent if one is undefined."""
    field = sample.field
    ring, start = field.ring, sample.start

    @cache
    def derivative(index: tuple[int, ...]) -> Poly:
        if sum(index) == 1:
            return field.slopes[1] if index[0] else -field.slopes[0]
        place = max(k for k, n in enumerate(index) if n)
        lower = tuple(n - (k == place) for k, n in enumerate(index))
        return ring.diff(derivative(lower), "pqt"[place])

    return [require_value(enclose(ring, derivative(index), start, BITS)) for index in jets.indices]


def _value(x: Poly, derivatives: Sequence[Ball]) -> Ball:
    with working_precision(BITS):
        total, variables = flint.arb(0), x.context().nvars() - len(derivatives)
        values = [flint.arb(0)] * variables + list(derivatives)
        for monomial, coefficient in terms_of(x):
            term = flint.arb(coefficient)
            for value, power in zip(values, monomial, strict=True):
                for _ in range(int(power)):
                    term *= value
            total += term
    return total
