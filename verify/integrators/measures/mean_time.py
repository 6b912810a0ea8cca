"""At which time a measured step reads H in the mean, where that is why its order is 1.

A step that reads H(p, q, t) at t + c_i h, in parts b_i of it, has p' − p(t + h) =
−(Σ b_i c_i − 1/2) H_qt h² + O(h³) where nothing else is wrong, and so for q with H_pt. Where that
quotient is the same at every point, Σ b_i c_i is the mean; where something else is wrong it is not.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.order import Probe, flow_of, goal
from verify.integrators.places.place import Place
from verify.integrators.tracing.misread import moment

_SIZES = {"duals": Fraction(1, 2**20), "floats": Fraction(1, 2**9)}
_NEAR = {"duals": Fraction(1, 10**6), "floats": Fraction(1, 200)}  # of each other, in parts of h
_LARGEST_PART = 12  # the denominator of a mean that is read off what is so near
_FEWEST, _LEAST, _NOTHING = 2, 0.01, 1e-6  # points, and the size of H_qt or H_pt


def mean_time(probe: Probe, hamiltonian: Hamiltonian, places: Sequence[Place]) -> list[str]:
    """One sentence, where the mean is seen and is not the right one. Raises what the user's code
    raises."""
    means = [x for place in places for x in _means(probe, hamiltonian, place)]
    near = _NEAR[probe.how]
    if (
        len(means) < _FEWEST
        or max(means) - min(means) > near
        or abs(means[0] - Fraction(1, 2)) < near
    ):
        return []
    mean = sum(means, Fraction(0)) / len(means)
    read = mean.limit_denominator(_LARGEST_PART)
    told = moment(read) if abs(read - mean) <= near else f"about t {float(mean):+.3f} h"
    return [f"H is read at {told} in the mean: it can be of order 2 where that is t + h/2"]


def _means(probe: Probe, hamiltonian: Hamiltonian, place: Place) -> Iterator[Fraction]:
    """Of p' and of q', where H's derivative is large enough."""
    h = _SIZES[probe.how] * place.step
    gaps = [_gap(probe, hamiltonian, place, x) for x in (h, h / 2)]
    at = dict(zip("pqt", (*place.z, place.t), strict=True))
    values = {symbol(name): sympy.Rational(x.numerator, x.denominator) for name, x in at.items()}
    for k, (by, sign) in enumerate((("q", -1), ("p", 1))):
        slope = sign * hamiltonian.exact.diff(symbol(by), symbol("t")).subs(values)
        size = Fraction(float(slope))
        one, two = gaps[0][k] / h**2, gaps[1][k] / (h / 2) ** 2
        if abs(size) > _LEAST:
            yield Fraction(1, 2) + (2 * two - one) / size
        elif (
            abs(size) < _NOTHING and abs(2 * two - one) > _LEAST
        ):  # it is wrong where time has no part in it
            yield from (Fraction(0), Fraction(1))


def _gap(probe: Probe, hamiltonian: Hamiltonian, place: Place, h: Fraction) -> list[Fraction]:
    """p' and q' less the exact flow's."""
    flow = flow_of(hamiltonian, probe)
    ends = zip(probe.end(place, h), goal(flow, probe, place, h), strict=True)
    return [x - y for x, y in ends]
