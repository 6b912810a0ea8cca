"""Along a closed orbit the time average of H + X(p q) is H: what is a derivative averages to 0.

Only one sample in 16 is tested, as its orbit has to be followed until it closes, and none with an H
that depends on time, whose orbits close by chance only.
"""

from fractions import Fraction

from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import midpoint_and_radius
from verify.arithmetic.exact import decimal
from verify.exploration.property import Violation, only_if, require_value, silent_at
from verify.exploration.sample import Sample
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit_average import average

_DIGITS = 12
# Relative to the averaged values: it is added to the bound of the average, which is an estimate.
_BOUND_TOLERANCE = Fraction(1, 10**9)


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=16) and not sample.depends_on_time)
    only_if(sample.polynomial and sample.ordinary)
    field = sample.field
    ring = field.ring
    mixed = field.derive(ring.variable("p") * ring.variable("q"))
    p, q = sample.place
    with silent_at(NoFlowError):  # the orbit is open
        mean = average(sample.hamiltonian, (ring, field.energy + mixed), (p, q), _DIGITS)
    at_start = require_value(enclose(ring, field.energy, sample.start, 200))
    expected = midpoint_and_radius(at_start)[0]
    size = 1 + abs(expected) + Fraction(max(map(abs, mean.values), default=0.0))
    if abs(mean.value - expected) > mean.bound + _BOUND_TOLERANCE * size:
        message = f"{decimal(mean.value, 12)} ± {decimal(mean.bound, 3)}"
        raise Violation(f"the average is {message}, and H is {decimal(expected, 12)}")
