"""How far rounding is carried in n degrees of freedom, in doubles.

A run is repeated in float64 from points that are off by a little in one coordinate each. What that
becomes is how far a rounding at the start is carried; those on the way are carried no farther than
the farthest so far, in any row up to here. A program that finds S, W or Λ from the entries of a
Jacobian rounds their products, however small they are: the columns of these runs are its entries.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.systems import float64
from verify.errors import InputError
from verify.hamiltonians.start import point_of
from verify.kernels.orbit import Orbit
from verify.reference.compare.findings import DOUBLE, Spread, Spreads
from verify.runs.run import run

_OFF = Fraction(1, 2**24)  # of the orbit's size: what is carried has 20 digits of bits beside it
_AT_WORST = 4  # times what is carried, for each step
_LARGE = Fraction(1, 1000)  # of the orbit's size: beyond it errors do not just add up
_MOST_STEPS = 20_000
_OBSERVED = ("symplectic_defect_max", "symplectic_defect", "lambda")
_ZERO = Fraction(0)


@dataclass(frozen=True)
class _Row:
    """The orbit's size by then, what a rounding of that size at the start has become, by column,
    and the greatest of a Jacobian's entries."""

    size: Fraction
    carried: Mapping[str, Fraction]
    entry: Fraction


class Carried:
    """That of one orbit."""

    def __init__(self, orbit: Orbit) -> None:
        self._orbit = orbit
        self._rows: dict[int, _Row | None] = {}

    def at(self, step: int) -> Spreads | None:
        """After so many steps; None where rounding may have taken every digit of the state, or
        where that is not known."""
        if step not in self._rows:
            self._rows[step] = self._row(step)
        row, names = self._rows[step], self._orbit.hamiltonian.coordinates
        if row is None:
            return None
        rows = [x for n, x in self._rows.items() if n <= step and x is not None]
        carried = {n: max(x.carried.get(n, _ZERO) for x in rows) for n in (*names, *_OBSERVED)}
        if any(DOUBLE * step * carried[name] > _LARGE * row.size for name in names):
            return None
        near_one = Fraction(4 * self._orbit.hamiltonian.degrees)  # a step's Jacobian
        of_all = max(x.entry for x in rows) ** 2
        products = dict.fromkeys(names, _ZERO) | {
            "symplectic_defect_max": near_one, "symplectic_defect": of_all, "lambda": of_all,
        }  # fmt: skip
        many = 1 + math.isqrt(step)
        return {
            name: Spread(
                many * (by + products[name]),
                _AT_WORST * (step + 1) * by + many**2 * products[name] / 2,
            )
            for name, by in carried.items()
        }

    def _row(self, step: int) -> _Row | None:
        orbit = self._orbit
        start = point_of(orbit.hamiltonian, orbit.q, orbit.p)
        if step == 0:
            return _Row(max(map(abs, start.values())), {}, Fraction(1))
        middle = self._after(start, step) if step <= _MOST_STEPS else None
        if middle is None:
            return None
        size = max(abs(x) for name in start for x in (start[name], middle[name]))
        off = _OFF * (size or 1)
        carried, entry = dict.fromkeys(middle, _ZERO), Fraction(1)
        for name in start:
            aside = self._after(start | {name: start[name] + off}, step)
            if aside is None:
                return None
            slopes = {n: abs(aside[n] - middle[n]) / off for n in middle}
            entry = max(entry, *(slopes[n] for n in start))
            carried = {n: x + slopes[n] * size for n, x in carried.items()}
        return _Row(size, carried, entry)

    def _after(self, point: Mapping[str, Fraction], steps: int) -> dict[str, Fraction] | None:
        """The numbers after so many steps from a point; None where they cannot be had."""
        orbit, each = self._orbit, list(point.values())
        half = len(each) // 2
        try:
            done = run(
                orbit.hamiltonian, orbit.scheme, p=each[:half], q=each[half:],
                step_size=orbit.step_size, steps=steps, t0=orbit.t0,
                arithmetic=float64.NAME, observables=_OBSERVED,
            )  # fmt: skip
        except (InputError, ArithmeticError):
            return None
        if done.status != "finished":
            return None
        return {name: Fraction(value.value) for name, value in done.values.items()}
