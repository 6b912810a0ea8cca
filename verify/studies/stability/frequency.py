"""The greatest frequency along an exact motion: that of the linearised flow where it is stiffest.

In the plane ω² is the greatest det Hess H on the orbit; in n degrees of freedom ω is the greatest
imaginary part of an eigenvalue of the field's Jacobian, in float64, at the places at which the
motion was looked at.
"""

from fractions import Fraction

from verify.arithmetic.systems import mpfr
from verify.flows.functions import functions_at
from verify.flows.orbit import ExactOrbit
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.exact_motion import ExactMotion

_DIGITS = 20
_NOISE = 1e-6  # of the matrix's size: a double eigenvalue 0 is found so far from it, and more


def frequency(orbit: ExactOrbit) -> Fraction:
    """The greatest ω on the orbit, to some 20 digits; 0 where nothing oscillates."""
    if orbit.stiffness <= 0:
        return Fraction(0)
    arithmetic = mpfr.make(_DIGITS)
    with arithmetic.context():
        omega = arithmetic.functions["sqrt"](arithmetic.number(orbit.stiffness))
    return arithmetic.exact(omega)


def frequency_in_degrees(hamiltonian: Hamiltonian, motion: ExactMotion) -> Fraction:
    """The same in n degrees of freedom, to some three digits; 0 where nothing oscillates."""
    import numpy as np

    field, _ = canonical_field(hamiltonian)
    size, ring = len(field.names), field.ring
    names = (*field.names, "t") if field.timed else field.names
    entries = [(ring, ring.diff(slope, name)) for slope in field.slopes for name in field.names]
    arithmetic = mpfr.make(_DIGITS)
    at = functions_at(arithmetic, entries, names)
    greatest = 0.0
    for time, state in zip(motion.times, motion.states, strict=True):
        given = (*state, time) if field.timed else state
        with arithmetic.context():
            found = at(*map(arithmetic.number, given))
        jacobian = np.array([float(arithmetic.exact(x)) for x in found]).reshape(size, size)
        turning = float(np.abs(np.linalg.eigvals(jacobian).imag).max())
        if turning > _NOISE * float(np.abs(jacobian).max()):
            greatest = max(greatest, turning)
    return Fraction(greatest)
