"""What rounding may do to each number of a run, for programs that work with a given unit roundoff.

A few roundings of the state in each step are there in any case. What comes from earlier steps is
followed where a difference is larger (`verify.reference.compare.scatter`). A program that finds ΔJ
as a d − b c − 1 rounds the products, however small ΔJ is; and so each factor of Λ.
"""

import math
from fractions import Fraction

import flint

from verify.algebra.enclosure import enclose_all
from verify.arithmetic.arb import around, in_reach, middle_and_radius, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.kernels.step.computation import step_map_of
from verify.reference.compare.findings import DOUBLE, SINGLE, Spread
from verify.reference.compare.scatter import Scatters
from verify.reference.make.orbit_points import Bounded
from verify.runs.start import Start
from verify.schemes.maps.parts import parts_of
from verify.structures import AREA, SYMPLECTIC

USUAL, WORST = 8, 16  # times what the copies show, since operations differ
_NOT_AT_ALL = Spread(0, 0)
_FEW = {AREA: 4, SYMPLECTIC: 8}  # roundings of the state in a step
_PRODUCTS = 8  # roundings of a determinant
_BITS = 200
_UNDERFLOWS = (  # units of roundoff, and what all numbers of that format are lost below
    (SINGLE, Fraction(1, 2**126)),
    (DOUBLE, Fraction(1, 2**1022)),
)


class Allowance:
    """Of one orbit, for one unit roundoff."""

    def __init__(self, orbit: Start, unit: Fraction, scatters: Scatters) -> None:
        self.orbit, self.unit, self._scatters = orbit, unit, scatters
        self._few = _FEW[orbit.hamiltonian.structure]
        self._of_matrices = not orbit.hamiltonian.planar  # S and W, entries that are carried
        self._entries: dict[int, Fraction] = {}
        self._smallest = next((x for of, x in _UNDERFLOWS if unit >= of), Fraction(0))

    def at_once(self, name: str, step: int, known: dict[str, Bounded]) -> Fraction:
        """What may be in any case; `known` are the run's numbers after the step, the state among
        them where `name` is of it. Products of a Jacobian's entries in n degrees of freedom are
        followed with what is carried."""
        many, exact = Fraction(1 + math.isqrt(step)), self.orbit.hamiltonian
        if name in exact.coordinates:
            size = max(abs(known[n][0]) for n in exact.coordinates)
            return (self._few * self.unit * size + self._smallest) * many
        size = abs(known[name][0])
        if self._of_matrices:
            return self._few * self.unit * size * many
        one = self._one(step, known)
        if name == "lambda":
            return one * (1 + size) * many
        if name == "delta_j":
            return one * (1 + size)
        return 2 * one * (_root(size) + one)

    def of(self, name: str, step: int, known: dict[str, Bounded]) -> Spread | None:
        """What may be with all that earlier steps have left; None where that may be everything."""
        least = self.at_once(name, step, known)
        spreads = self._scatters.at(self.orbit, step)
        if spreads is None:
            return None
        moved = spreads.get(name, _NOT_AT_ALL)
        adds_up = name == "lambda" or self._of_matrices
        long = least * (1 + math.isqrt(step)) if adds_up else least
        return Spread(
            least + USUAL * Fraction(moved.usual) * self.unit,
            long + WORST * Fraction(moved.worst) * self.unit,
        )

    def _one(self, step: int, known: dict[str, Bounded]) -> Fraction:
        """The rounding of one determinant, at the largest entries that were met so far."""
        if step not in self._entries and "p" in known and "q" in known:
            self._entries[step] = products(self.orbit, step, known)
        most = max((x for n, x in self._entries.items() if n <= step), default=Fraction(1))
        return _PRODUCTS * self.unit * most


def products(orbit: Start, done: int, known: dict[str, Bounded]) -> Fraction:
    """A bound of |a d| + |b c| over the substeps of the step after so many, at least 1: what det J
    is the rest of. 1 where that is not looked at, as in n degrees of freedom."""
    if not orbit.hamiltonian.planar:
        return Fraction(1)
    step_map = step_map_of(orbit.hamiltonian, orbit.scheme)
    parts = parts_of(step_map) or (step_map.closed,)
    with working_precision(_BITS):
        box = {name: around(*known[name]) for name in ("p", "q")}
        box |= {"h": rational_ball(orbit.step_size)}
        if orbit.hamiltonian.time_dependent:
            box["t"] = rational_ball(orbit.t0 + done * orbit.step_size)
        whole = flint.arb_mat(2, 2, [1, 0, 0, 1])  # the entries' sizes, of all substeps so far
        for step in parts:
            rows = (*step.jacobian, step.elements) if step else ()
            own = enclose_all(step.ring, [x for row in rows for x in row], box) if step else None
            if own is None:
                return Fraction(1)
            *entries, box["p"], box["q"] = own
            whole = flint.arb_mat(2, 2, [abs(x) for x in entries]) * whole
        a, b, c, d = whole.entries()
        total = a * d + b * c
        if not in_reach(total):
            return Fraction(1)
        return max(Fraction(1), sum(middle_and_radius(total), Fraction(0)))


def _root(x: Fraction) -> Fraction:
    """√x to some digits."""
    return Fraction(math.isqrt(x.numerator * x.denominator << 80), x.denominator << 40)
