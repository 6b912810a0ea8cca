"""What rounding may do to each number of a run in n degrees of freedom, in doubles.

The run is repeated in float64 from points that are off by a little in one coordinate each. What
that becomes is how far a rounding at the start is carried; those on the way are carried no farther
than the farthest so far, in any row up to here. A program that finds S or W from the entries of a
Jacobian rounds their products, however small S is: the columns of these runs are its entries.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.systems import float64
from verify.errors import InputError
from verify.reference.compare.findings import DOUBLE
from verify.reference.compare.published_in_degrees import RunOfDegrees
from verify.runs.run import run

_OFF = Fraction(1, 2**24)  # of the orbit's size: what is carried has 20 digits of bits beside it
_FEW, _USUAL, _WORST = 8, 8, 64  # roundings of a step; times what is carried, as operations differ
_LARGE = Fraction(1, 1000)  # of the orbit's size: beyond it errors do not just add up
_MOST_STEPS = 20_000
OBSERVED = ("symplectic_defect_max", "symplectic_defect", "lambda")
Values = Mapping[str, Fraction]


@dataclass(frozen=True)
class AllowedInDegrees:
    """How far a number may be off: as it usually is, and at worst."""

    usual: Fraction
    worst: Fraction


class AllowanceInDegrees:
    """Of one run; asked for its rows in the order of steps."""

    def __init__(self, ours: RunOfDegrees, unit: Fraction = DOUBLE) -> None:
        self.ours, self.unit = ours, unit
        self._carried: dict[str, Fraction] = {}
        self._entries = Fraction(1)

    def at(self, step: int, known: Values) -> dict[str, AllowedInDegrees] | None:
        """By the column's name; None where rounding may have taken every digit of the state, or
        where that is not known. `known`: the row's numbers."""
        names = self.ours.hamiltonian.coordinates
        state = [abs(known[n]) for n in names if n in known]
        size = max(*state, *map(abs, self._start().values()))
        if step > 0 and not self._carry(step, size):
            return None
        many = Fraction(math.isqrt(step) + 1)
        if any(self.unit * step * self._carried.get(n, Fraction(0)) > _LARGE * size for n in names):
            return None
        found = {}
        for name, x in known.items():
            own, by = self._size(name, abs(x), size), self._carried.get(name, Fraction(0))
            found[name] = AllowedInDegrees(
                self.unit * (_FEW * own * many + _USUAL * many * by),
                self.unit * (_FEW * own * many**2 + _WORST * (step + 1) * by),
            )
        return found

    def _size(self, name: str, x: Fraction, size: Fraction) -> Fraction:
        """What is rounded on the way to a number x of that name."""
        if name in self.ours.hamiltonian.coordinates:
            return size
        if name == "symplectic_defect_max":  # products of a step, whose Jacobian is near 1
            return x + 4 * self.ours.hamiltonian.degrees
        return x + (self._entries**2 if name in OBSERVED else 0)

    def _start(self) -> dict[str, Fraction]:
        return {n: x for n, x in self.ours.run.start.items() if n != "t"}

    def _carry(self, step: int, size: Fraction) -> bool:
        """Takes up what runs of so many steps say; whether they could be had."""
        if step > _MOST_STEPS:
            return False
        start = self._start()
        middle = self._run(start, step)
        if middle is None:
            return False
        off = _OFF * (size or 1)
        total: dict[str, Fraction] = dict.fromkeys(middle, Fraction(0))
        for name in start:
            aside = self._run(start | {name: start[name] + off}, step)
            if aside is None:
                return False
            slopes = {n: abs(aside[n] - middle[n]) / off for n in middle}
            self._entries = max(self._entries, *(slopes[n] for n in start))
            for n, x in slopes.items():
                total[n] += x * size
        for n, x in total.items():
            self._carried[n] = max(self._carried.get(n, Fraction(0)), x)
        return True

    def _run(self, start: Values, steps: int) -> dict[str, Fraction] | None:
        ours, names = self.ours, self.ours.hamiltonian.coordinates
        half = len(names) // 2
        point: Sequence[Fraction] = [start[name] for name in names]
        try:
            found = run(
                ours.hamiltonian, ours.run.scheme, p=point[:half], q=point[half:],
                step_size=ours.run.step_size, steps=steps, t0=ours.run.t0 or 0,
                arithmetic=float64.NAME, observables=OBSERVED,
            )  # fmt: skip
        except (InputError, ArithmeticError):
            return None
        if found.status != "finished":
            return None
        return {name: Fraction(value.value) for name, value in found.values.items()}
