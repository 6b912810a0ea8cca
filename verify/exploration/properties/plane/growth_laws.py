"""Λ of a run grows as its growth law says: h^η [G] and the two terms after it, or h^(r−1) T c_r.

A few steps of a tiny size are enclosed by balls, so that the terms that the law leaves out are far
smaller than its smallest term. Λ is the cumulative area error of the run.
"""

from fractions import Fraction

from verify.algebra.enclosure import enclose_over
from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.exploration.property import Violation, only_if, require_value, silent_at
from verify.exploration.reference_steps import BallState, ball_steps, is_narrow, unlike
from verify.exploration.sample import Sample
from verify.proof.plane.growth_law import Element, GrowthLaw, NoLawError, growth_law
from verify.schemes.conditions.every_hamiltonian import TaylorSeries

_STEP, _STEPS = Fraction(1, 2**256), 3
_BITS_PER_POWER, _SPARE_BITS = 256, 320
# Relative to 1 + |g|: the terms left out are 2⁻²⁵⁶ times products of derivatives of H.
_TOLERANCE = Fraction(1, 2**64)
_MAX_ORDER = 4


def holds(sample: Sample) -> None:
    only_if(sample.scheme.order <= _MAX_ORDER and sample.in_closed_form)
    # The law needs ΔJ in closed form, which may be long.
    only_if(sample.polynomial or isinstance(sample.scheme.every_h, TaylorSeries))
    with silent_at(NoLawError, InputError):  # ΔJ ≡ 0, or too large a closed form
        law = growth_law(sample.hamiltonian, sample.scheme.name)
    bits = _BITS_PER_POWER * (law.power + 3) + _SPARE_BITS
    start = sample.start | {"h": _STEP}
    states = ball_steps(sample.step_map, start, _STEPS, bits)
    with working_precision(bits):
        _must_obey_law(law, states[0], states[-1])


def _must_obey_law(law: GrowthLaw, *ends: BallState) -> None:
    h = rational_ball(_STEP)
    measured_rate, rate = ends[-1].product.log(), _evaluate(law.g, ends[0])
    if law.potential and law.leading:
        potential, leading = _change(law.potential, *ends), _change(law.leading, *ends)
        # The two known terms are subtracted; what is left is g, up to terms of higher order in h.
        measured_rate -= h ** (law.power - 1) * potential - h**law.power * leading / 2
    measured_rate /= h ** (law.power + 1) * _STEPS
    only_if(is_narrow(measured_rate) and is_narrow(rate))
    if abs(measured_rate - rate) > (1 + abs(rate)) * rational_ball(_TOLERANCE):
        raise Violation(f"Λ/(h^{law.power + 1} T) is {unlike(measured_rate, rate)}, by the law")


def _change(element: Element, first: BallState, last: BallState) -> Ball:
    """Return [F], the change of F from the first state to the last."""
    return _evaluate(element, last) - _evaluate(element, first)


def _evaluate(element: Element, state: BallState) -> Ball:
    ring, x = element
    return require_value(enclose_over(ring, x, state.point))
