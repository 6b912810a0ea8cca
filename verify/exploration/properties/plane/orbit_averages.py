"""Along a closed orbit the time average of H + X(p q) is H: what is a derivative averages to 0.

One sample in many is looked at, as an orbit is followed for that until it closes; none of an H that
depends on time, whose orbits close by chance.
"""

from fractions import Fraction

from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import middle_and_radius
from verify.arithmetic.exact import decimal
from verify.exploration.property import Violation, known, only_if, silent_at
from verify.exploration.sample import Sample
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit_average import average

_DIGITS = 12
_SPARE = Fraction(1, 10**9)  # of the values averaged, whose estimated bound is not rigorous


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=16) and not sample.timed)
    only_if(sample.polynomial and sample.ordinary)
    field = sample.field
    ring = field.ring
    mixed = field.derive(ring.variable("p") * ring.variable("q"))
    p, q = sample.place
    with silent_at(NoFlowError):  # the orbit is open
        found = average(sample.hamiltonian, (ring, field.energy + mixed), (p, q), _DIGITS)
    at_start = known(enclose(ring, field.energy, sample.start, 200))
    wanted = middle_and_radius(at_start)[0]
    size = 1 + abs(wanted) + Fraction(max(map(abs, found.values), default=0.0))
    if abs(found.value - wanted) > found.bound + _SPARE * size:
        told = f"{decimal(found.value, 12)} ± {decimal(found.bound, 3)}"
        raise Violation(f"the average is {told}, and H is {decimal(wanted, 12)}")
