"""Bounds of the effect of rounding on each number of a run, for programs with one unit roundoff.

A few roundings of the state in each step are unavoidable. If a difference is larger than these
explain, the effect of rounding in earlier steps is measured (`verify.reference.compare.scatter`). A
program that computes ΔJ as a d − b c − 1 rounds the products, however small ΔJ is, and so each
factor of Λ.

Doubles may overflow on a run on which the reference data do not. They may if the toolkit's own step
in doubles does, or if a number of the run, or a product of its Jacobians' entries, is not far from
the largest double.
"""

import math
from fractions import Fraction
from functools import lru_cache

import flint

from verify.algebra.enclosure import enclose_all
from verify.arithmetic.arb import is_representable, make_ball, midpoint_and_radius, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.systems import float64
from verify.kernels.step.computation import step_map_of
from verify.reference.compare.scatter import Scatters, Spread, run_of
from verify.reference.compare.table_agreement import DOUBLE, SINGLE
from verify.reference.make.orbit_computation import Bounded
from verify.runs.run_start import Start
from verify.schemes.maps.parts import parts_of
from verify.structures import AREA, SYMPLECTIC

# Factors of the copies' usual and worst spread: a program's operations differ from the copies'.
USUAL, WORST = 8, 16
_NO_SPREAD = Spread(0, 0)
_STATE_ROUNDINGS = {AREA: 4, SYMPLECTIC: 8}  # units of roundoff that a step adds to the state
_DETERMINANT_ROUNDINGS = 8
_BITS = 200
_LARGE = Fraction(10) ** 250  # the way to such a number may lead beyond the largest double
_MAX_STEPS = 20_000  # steps of a run in doubles
_DOUBLE_DIGITS = 17
_UNDERFLOWS = (  # a format's unit roundoff, and its least normal number
    (SINGLE, Fraction(1, 2**126)),
    (DOUBLE, Fraction(1, 2**1022)),
)


class Allowance:
    """A bound of what rounding may do to the numbers of one orbit, for one unit roundoff."""

    def __init__(self, orbit: Start, unit: Fraction, scatters: Scatters) -> None:
        self.orbit, self.unit, self._scatters = orbit, unit, scatters
        self._few = _STATE_ROUNDINGS[orbit.hamiltonian.structure]
        self._of_matrices = not orbit.hamiltonian.planar  # S and W, entries that are carried
        self._entries: dict[int, Fraction] = {}
        self._smallest = next(
            (x for unit_of_format, x in _UNDERFLOWS if unit >= unit_of_format), Fraction(0)
        )

    def unavoidable_rounding(self, name: str, step: int, bounded: dict[str, Bounded]) -> Fraction:
        """Return a bound of the rounding that no program avoids.

        `bounded`: the run's numbers after the step, the state among them if `name` is a
        coordinate. In n degrees of freedom the rounding of products of a Jacobian's entries is no
        part of it, but of the spread.
        """
        # Independent roundings of N steps add up like a random walk, by √N.
        many, coordinates = Fraction(1 + math.isqrt(step)), self.orbit.hamiltonian.coordinates
        if name in coordinates:
            size = max(abs(bounded[n][0]) for n in coordinates)
            return (self._few * self.unit * size + self._smallest) * many
        size = abs(bounded[name][0])
        if self._of_matrices:
            return self._few * self.unit * size * many
        determinant = self._bound_determinant(step, bounded)
        if name == "lambda":
            return determinant * (1 + size) * many
        if name == "delta_j":
            return determinant * (1 + size)
        return 2 * determinant * (_square_root(size) + determinant)

    def accumulated_rounding(
        self, name: str, step: int, bounded: dict[str, Bounded]
    ) -> Spread | None:
        """Return the rounding that may have accumulated over the steps.

        None if that may be every digit.
        """
        least = self.unavoidable_rounding(name, step, bounded)
        spreads = self._scatters.spreads_at(self.orbit, step)
        if spreads is None:
            return None
        spread = spreads.get(name, _NO_SPREAD)
        adds_up = name == "lambda" or self._of_matrices
        # Λ and the entries of matrices keep the rounding of every step; the state keeps it only as
        # far as the flow carries it, which the spread contains.
        long = least * (1 + math.isqrt(step)) if adds_up else least
        return Spread(
            least + USUAL * Fraction(spread.usual) * self.unit,
            long + WORST * Fraction(spread.worst) * self.unit,
        )

    def _bound_determinant(self, step: int, bounded: dict[str, Bounded]) -> Fraction:
        """Bound the rounding of one determinant, at the largest entries so far."""
        if step not in self._entries and "p" in bounded and "q" in bounded:
            self._entries[step] = products(self.orbit, step, bounded)
        most = max((x for n, x in self._entries.items() if n <= step), default=Fraction(1))
        return _DETERMINANT_ROUNDINGS * self.unit * most


def products(orbit: Start, done: int, bounded: dict[str, Bounded]) -> Fraction:
    """Bound |a d| + |b c| over the substeps of the step after `done` steps; at least 1.

    det J is the difference of these products, so its rounding is relative to them. Returns 1 if
    no bound is computed, as in n degrees of freedom.
    """
    if not orbit.hamiltonian.planar:
        return Fraction(1)
    step_map = step_map_of(orbit.hamiltonian, orbit.scheme)
    parts = parts_of(step_map) or (step_map.closed,)
    with working_precision(_BITS):
        box = {name: make_ball(*bounded[name]) for name in ("p", "q")}
        box |= {"h": rational_ball(orbit.step_size)}
        if orbit.hamiltonian.time_dependent:
            box["t"] = rational_ball(orbit.t0 + done * orbit.step_size)
        sizes = flint.arb_mat(2, 2, [1, 0, 0, 1])  # bounds of the entries, over all substeps so far
        for step in parts:
            rows = (*step.jacobian, step.elements) if step else ()
            values = enclose_all(step.ring, [x for row in rows for x in row], box) if step else None
            if values is None:
                return Fraction(1)
            *entries, box["p"], box["q"] = values
            # Products of absolute values bound the sizes that occur when a program multiplies the
            # substeps' Jacobians.
            sizes = flint.arb_mat(2, 2, [abs(x) for x in entries]) * sizes
        a, b, c, d = sizes.entries()
        total = a * d + b * c
        if not is_representable(total):
            return Fraction(1)
        return max(Fraction(1), sum(midpoint_and_radius(total), Fraction(0)))


def _square_root(x: Fraction) -> Fraction:
    """Return √x to some digits."""
    return Fraction(math.isqrt(x.numerator * x.denominator << 80), x.denominator << 40)


# -- overflow -------------------------------------------------------------------------------------


def may_overflow(orbit: Start, step: int, bounded: dict[str, Bounded]) -> bool:
    """Return True if doubles may overflow within `step` steps or in the next one.

    `bounded`: the run's numbers then, the state among them unless it has left the range of the
    reference data, too.
    """
    # Without a state in the reference data a run in doubles alone decides.
    if any(name not in bounded for name in orbit.hamiltonian.coordinates):
        return _overflows(orbit, step)
    if any(abs(value) > _LARGE for value, _ in bounded.values()):
        return True
    return products(orbit, step, bounded) > _LARGE or _overflows(orbit, step)


@lru_cache(maxsize=4096)
def _overflows(orbit: Start, step: int) -> bool:
    run = run_of(orbit, min(step, _MAX_STEPS) + 1)
    try:
        return not run.implicit and run.run(float64.make(_DOUBLE_DIGITS)).done < run.steps
    except OverflowError:  # an input is beyond the largest double
        return True
